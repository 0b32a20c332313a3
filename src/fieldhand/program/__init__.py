"""The program: the rooms that meet the user, put together; none of them knows the others."""

from __future__ import annotations


def main() -> None:
    """What ``fieldhand`` runs: the command line, ``serve`` with API and page together, and ``agent``."""
    from fieldhand.cli import main as run_commands
    from fieldhand.program.agent import agent
    from fieldhand.program.serve import serve

    run_commands(serve, agent)
