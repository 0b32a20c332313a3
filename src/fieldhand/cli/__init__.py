"""The command line: thin, one command a file."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fieldhand.language import Language


def main(*others: Callable[..., None]) -> None:
    """Run the command line; what went wrong is one line on standard error and the exit status of its kind.

    Args:
        others: Commands beside those of this room, made of rooms that this one does not know.
    """
    import typer

    from fieldhand.cli.app import assemble
    from fieldhand.errors import FieldhandError
    from fieldhand.language import message

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without "°" or "₂" shows a question mark, no traceback

    misused: type[Exception] = typer.BadParameter.__mro__[1]  # the library hands out its children alone
    try:
        # Left to itself, the library says in a box how a command is called, beside our one line for all else.
        status = assemble(*others)(standalone_mode=False)
        if status == _INTERRUPTED:
            raise KeyboardInterrupt
        sys.exit(status if isinstance(status, int) else 0)
    except FieldhandError as error:
        _say(error.said(_language().say))
        sys.exit(error.exit_status)
    except misused as error:
        line = _usage(error)
        if line:
            _say(line)
        sys.exit(2)
    except typer.Abort:
        sys.stderr.write("\n")  # behind the question
        _say(_language().say(message("no answer was given")))
        sys.exit(1)
    except KeyboardInterrupt:
        _say(_language().say(message("interrupted")))
        sys.exit(_INTERRUPTED)
    except BrokenPipeError:
        # Whoever read our output has gone (a pager, head); say nothing more, not even at exit.
        sys.stderr.close()
        sys.exit(0)
    except Exception:  # noqa: BLE001  a fault of the program; its traceback may quote anyone
        _show_traceback()
        sys.exit(1)


#: Exit status after Ctrl-C, as shells have it.
_INTERRUPTED = 130


def _say(line: str) -> None:
    """Print a failure; whatever it quotes, only its first line begins as ours do."""
    from fieldhand.hidden_characters import print_error

    first, *others = f"fieldhand: {line}".splitlines()
    print_error(first, *(f"  {other}" for other in others))


def _show_traceback() -> None:
    """Print where the program failed, indented, so that no line of what it quotes begins as ours do."""
    import traceback

    from fieldhand.hidden_characters import print_error

    first, *others = traceback.format_exc().rstrip("\n").split("\n")
    print_error(first, *(f"  {other}" for other in others))


def _usage(error: Any) -> str:
    """What is wrong with how a command was called, as any other error; empty where its help was shown instead."""
    from fieldhand.errors import InputError
    from fieldhand.language import message

    what = error.format_message().strip().rstrip(".")
    if not what:
        return ""
    context = error.ctx
    words = context.command_path.removeprefix(context.find_root().command_path).split() if context else []
    help_of = " ".join(["fieldhand", *words, "--help"])
    advice = message("{command} says more", command=help_of)
    return InputError(what[0].lower() + what[1:], where=" ".join(words), advice=advice).said(_language().say)


def _language() -> Language:
    """Return the language that the command line asks for, read as it stands: what failed may be the reading of it."""
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
