"""Commands at a terminal: a pseudo-terminal of a given width, and the rows that its screen shows."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import struct
import termios
import threading
from contextlib import suppress
from pathlib import Path

from support.processes.command import at_terminal


def screen(*words: str, cwd: Path, columns: int = 80, env: dict[str, str] | None = None) -> tuple[int, list[str]]:
    """Return the exit status of ``fieldhand`` with these words, and what it wrote to its terminal, row by row.

    A line longer than the terminal is wide takes several rows, as on a screen.
    """
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    environment = {**os.environ, "TERM": "xterm", "NO_COLOR": "1", **(env or {})}
    environment.pop("COLUMNS", None)
    written = bytearray()

    def read() -> None:
        with suppress(OSError):  # the terminal is gone when the last of its programs is
            while chunk := os.read(ours, 65_536):
                written.extend(chunk)

    reader = threading.Thread(target=read)
    reader.start()
    try:
        status = at_terminal(*words, terminal=os.ttyname(theirs), cwd=cwd, env=environment)
    finally:
        os.close(theirs)
        reader.join()
        os.close(ours)
    plain = re.sub("\x1b\\[[0-9;]*m", "", written.decode())  # bold, and back again
    lines = plain.replace("\r\n", "\n").split("\n")
    return status, [line[at : at + columns] for line in lines for at in range(0, max(len(line), 1), columns)]
