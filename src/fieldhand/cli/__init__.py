"""The command line, one command a file."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fieldhand.language import Language


def main(*others: Callable[..., None]) -> None:
    """Run the command line; an error is printed as one line on standard error, and sets the exit status.

    Args:
        others: Further commands, which need packages that this one must not import.
    """
    import typer

    from fieldhand.cli.app import assemble
    from fieldhand.errors import FieldhandError
    from fieldhand.extras import missing_package
    from fieldhand.language import message

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # "°" becomes a question mark if the terminal cannot show it

    misused: type[Exception] = typer.BadParameter.__mro__[1]  # typer exports only its subclasses
    try:
        # In standalone mode, typer prints usage errors itself, in a box.
        status = assemble(*others, only=next(iter(sys.argv[1:]), None))(standalone_mode=False)
        if status == _INTERRUPTED:
            raise KeyboardInterrupt
        sys.exit(status if isinstance(status, int) else 0)
    except FieldhandError as error:
        _print_failure(error.line(_language().say))
        sys.exit(error.exit_status)
    except misused as error:
        line = _usage(error)
        if line:
            _print_failure(line)
        sys.exit(2)
    except typer.Abort:
        sys.stderr.write("\n")  # after the question
        _print_failure(_language().say(message("no answer was given")))
        sys.exit(1)
    except KeyboardInterrupt:
        _print_failure(_language().say(message("interrupted")))
        sys.exit(_INTERRUPTED)
    except ModuleNotFoundError as error:
        missing = missing_package(error)
        if missing is None:
            _show_traceback()
            sys.exit(1)
        _print_failure(missing.line(_language().say))
        sys.exit(missing.exit_status)
    except BrokenPipeError:
        # The reader of standard output (a pager, head) has exited; print nothing more, not even at exit.
        sys.stderr.close()
        sys.exit(0)
    except Exception:  # noqa: BLE001  fault of the program
        _show_traceback()
        sys.exit(1)


#: Exit status after Ctrl-C, as in shells.
_INTERRUPTED = 130


def _print_failure(line: str) -> None:
    """Print an error; only its first line is not indented, so that quoted text cannot look like another error."""
    from fieldhand.hidden_characters import print_error

    first, *others = f"fieldhand: {line}".splitlines()
    print_error(first, *(f"  {other}" for other in others))


def _show_traceback() -> None:
    """Print the traceback, indented, so that quoted text cannot look like an error of ours."""
    import traceback

    from fieldhand.hidden_characters import print_error

    first, *others = traceback.format_exc().rstrip("\n").split("\n")
    print_error(first, *(f"  {other}" for other in others))


def _usage(error: Any) -> str:
    """Return a usage error in the form of other errors; empty if the help was printed instead."""
    from fieldhand.errors import InputError
    from fieldhand.language import message

    what = error.format_message().strip().rstrip(".")
    if not what:
        return ""
    context = error.ctx
    words = context.command_path.removeprefix(context.find_root().command_path).split() if context else []
    help_of = " ".join(["fieldhand", *words, "--help"])
    advice = message("see {command}", command=help_of)
    return InputError(what[0].lower() + what[1:], where=" ".join(words), advice=advice).line(_language().say)


def _language() -> Language:
    """Return the language of ``--lang``, found without parsing the command line, as the parser may have failed."""
    import os
    from itertools import pairwise

    from fieldhand.errors import InputError
    from fieldhand.language import ENGLISH, spoken

    words = sys.argv[1:]
    asked = [after for word, after in pairwise(words) if word == "--lang"]
    asked += [word.removeprefix("--lang=") for word in words if word.startswith("--lang=")]
    try:
        return spoken(asked[-1] if asked else None, os.environ)
    except InputError:
        return ENGLISH
