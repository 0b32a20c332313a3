"""The program: the command line together with the commands ``serve`` and ``agent``."""

from __future__ import annotations

import gc

#: Containers created before Python looks for garbage. Nearly all that is created while a command starts is kept, so
#: that looking for garbage every 700 containers, as is usual, takes a tenth of that time for nothing.
_BETWEEN_COLLECTIONS = 50_000


def main() -> None:
    """Run the command line, with ``serve`` and ``agent`` among its commands."""
    gc.set_threshold(_BETWEEN_COLLECTIONS)
    try:
        from fieldhand.cli import main as run_commands
        from fieldhand.program.agent import agent
        from fieldhand.program.serve import serve

        run_commands(serve, agent)
    finally:
        gc.freeze()  # otherwise Python looks for garbage once more among all modules, just before it exits
