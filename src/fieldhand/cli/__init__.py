"""The command line: thin, one command a file."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable


def main(*others: Callable[..., None]) -> None:
    """Run the command line; what went wrong is one line on standard error and the exit status of its kind.

    Args:
        others: Commands beside those of this room, made of rooms that this one does not know.
    """
    from fieldhand.cli.app import assemble
    from fieldhand.errors import FieldhandError

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without "°" or "₂" shows a question mark, no traceback

    try:
        assemble(*others)()
    except FieldhandError as error:
        print(f"fieldhand: {error}", file=sys.stderr)  # noqa: T201
        sys.exit(error.exit_status)
    except KeyboardInterrupt:
        print("fieldhand: interrupted", file=sys.stderr)  # noqa: T201
        sys.exit(130)
    except BrokenPipeError:
        # Whoever read our output has gone (a pager, head); say nothing more, not even at exit.
        sys.stderr.close()
        sys.exit(0)
