"""The program: the rooms that meet the user, put together; none of them knows the others."""

from __future__ import annotations


def main() -> None:
    """What ``fieldhand`` runs: the command line, and ``serve``, which needs API and page together."""
    from fieldhand.cli import main as run_commands
    from fieldhand.program.serve import serve

    run_commands(serve)
