"""The command line in a process of its own, as a user runs it."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, kw_only=True)
class Run:
    """What a command printed and how it ended."""

    status: int
    out: str
    err: str


def fieldhand(*words: str, cwd: Path | None = None, env: dict[str, str] | None = None, stdin: str | None = None) -> Run:
    """Run ``fieldhand`` with these words; no terminal is there to ask."""
    done = subprocess.run(
        [sys.executable, "-m", "fieldhand", *words],
        capture_output=True,
        text=True,
        cwd=cwd,
        env=env,
        input=stdin or "",
        timeout=120,
        check=False,
    )
    return Run(status=done.returncode, out=done.stdout, err=done.stderr)
