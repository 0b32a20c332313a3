"""``fieldhand serve`` as a process with data of its own, which can be stopped and started again at the same address."""

from __future__ import annotations

import os
import re
import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

from support.processes.patience import LONG_S, until


class PageServer:
    """A server of page and API on a free port of this machine.

    Args:
        folder: Folder for its data, and for what it prints.
    """

    def __init__(self, folder: Path) -> None:
        with socket.socket() as tried:
            tried.bind(("127.0.0.1", 0))
            self._port = int(tried.getsockname()[1])
        self._log = folder / "log"
        self._environment = {**os.environ, "XDG_DATA_HOME": str(folder), "FIELDHAND_MISSIONS": str(folder / "missions")}
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        """Address of the page, without a slash at the end."""
        return f"http://127.0.0.1:{self._port}"

    def start(self) -> None:
        """Start it, and wait until it answers."""
        with self._log.open("ab") as log:
            command = [sys.executable, "-m", "fieldhand", "serve", "--port", str(self._port)]
            self._process = subprocess.Popen(command, stderr=log, env=self._environment)
        until(self._answers)

    @property
    def link(self) -> str:
        """Address that it printed to log in with, once; that of the page if it needs no login."""
        links: list[str] = re.findall(r"http://\S+#code=\S+", self._log.read_text())
        return links[-1] if links else self.url

    def stop(self) -> None:
        """Stop it, and wait until it has ended."""
        if self._process is not None:
            self._process.terminate()
            self._process.wait(LONG_S)
            self._process = None

    def _answers(self) -> bool:
        assert self._process is not None
        assert self._process.poll() is None, self._log.read_text()
        try:
            with urllib.request.urlopen(self.url, timeout=LONG_S) as answer:
                return bool(answer.status == 200)
        except OSError:
            return False
