"""The program: the command line together with the commands ``serve`` and ``agent``."""

from __future__ import annotations


def main() -> None:
    """Run the command line, with ``serve`` and ``agent`` among its commands."""
    from fieldhand.cli import main as run_commands
    from fieldhand.program.agent import agent
    from fieldhand.program.serve import serve

    run_commands(serve, agent)
