"""Commands at a terminal: a pseudo-terminal of a given width, and the rows that its screen shows."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from contextlib import suppress
from pathlib import Path

_LIMIT_S = 300


def screen(*words: str, cwd: Path, columns: int = 80, env: dict[str, str] | None = None) -> tuple[int, list[str]]:
    """Return the exit status of ``fieldhand`` with these words, and what it wrote to its terminal, row by row.

    A line longer than the terminal is wide takes several rows, as on a screen.
    """
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    environment = {**os.environ, "TERM": "xterm", "NO_COLOR": "1", **(env or {})}
    environment.pop("COLUMNS", None)
    process = subprocess.Popen(
        [sys.executable, "-m", "fieldhand", *words], cwd=cwd, env=environment, stdin=theirs, stdout=theirs,
        stderr=theirs, start_new_session=True,
    )  # fmt: skip
    os.close(theirs)
    written = b""
    with suppress(OSError):  # the terminal is gone when the last of its programs is
        while chunk := os.read(ours, 65_536):
            written += chunk
    os.close(ours)
    status = process.wait(_LIMIT_S)
    plain = re.sub("\x1b\\[[0-9;]*m", "", written.decode())  # bold, and back again
    lines = plain.replace("\r\n", "\n").split("\n")
    return status, [line[at : at + columns] for line in lines for at in range(0, max(len(line), 1), columns)]
