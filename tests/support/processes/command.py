"""The command line in a process of its own, as a user runs it.

Two thirds of a command's time go into loading libraries. So a first process loads them once and is then copied for each
command; a copy has its own folder, environment, input and output, and ends as any program ends. What the interpreter
itself reads from the environment takes a new process, and so does who asks for ``fresh`` one; who runs several commands
with the same of these variables can have a first process :func:`loaded_with` them.
"""

from __future__ import annotations

import atexit
import itertools
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import IO

#: Read by the interpreter when it starts.
_AT_START = ("PYTHON", "LC_", "LANG")
#: Seconds after which a command has hung, on the busiest machine.
_LIMIT_S = 900


@dataclass(frozen=True, kw_only=True)
class Run:
    """The output and the exit status of a command."""

    status: int
    out: str
    err: str


def fieldhand(
    *words: str,
    cwd: Path | None = None,
    env: dict[str, str] | None = None,
    stdin: str | None = None,
    fresh: bool = False,
) -> Run:
    """Run ``fieldhand`` with these words; no terminal is there to ask."""
    environment = dict(os.environ) if env is None else env
    if fresh or _at_start(environment) != _at_start(dict(os.environ)):
        return _started(words, cwd, environment, stdin)
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / name for name in ("in", "out", "err")]
        files[0].write_text(stdin or "")
        status = _ordered(words, cwd, environment, files)
        return Run(status=status, out=files[1].read_text(), err=files[2].read_text())


@contextmanager
def loaded_with(env: dict[str, str]) -> Iterator[Callable[..., Run]]:
    """Have a first process with an environment; what it yields runs ``fieldhand`` there as :func:`fieldhand` does."""
    first = _loaded(env)

    def command(*words: str, cwd: Path) -> Run:
        with tempfile.TemporaryDirectory() as folder:
            files = [Path(folder) / name for name in ("in", "out", "err")]
            files[0].touch()
            status = _ordered(words, cwd, env, files, first=first)
            return Run(status=status, out=files[1].read_text(), err=files[2].read_text())

    try:
        yield command
    finally:
        first.communicate()


def at_terminal(*words: str, terminal: str, cwd: Path, env: dict[str, str]) -> int:
    """Run ``fieldhand`` with these words at a terminal, a path such as /dev/pts/3, and return its exit status."""
    return _ordered(words, cwd, env, [Path(terminal)] * 3, terminal=True)


@contextmanager
def in_background(*words: str, out: Path) -> Iterator[int]:
    """``fieldhand`` with these words, beside everything else; killed at the end, if it has not ended by then.

    Args:
        out: Where its output goes; its errors go to the same name with ``.err``.

    Yields:
        The number of its process.
    """
    process = _ordered(words, None, dict(os.environ), [Path(os.devnull), out, Path(f"{out}.err")], background=True)
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)


@dataclass(frozen=True, kw_only=True)
class Started:
    """A command in a process of its own, whose output is read as it comes.

    Attributes:
        pid: The number of its process.
        out: What it prints, from a pipe.
    """

    pid: int
    out: IO[str]
    _err: Path

    def send_signal(self, number: int) -> None:
        os.kill(self.pid, number)

    def end(self) -> Run:
        """Read what is left, and wait until it has ended."""
        out = self.out.read()
        self.out.close()
        return Run(status=_answered({"wait": self.pid}, _first()), out=out, err=self._err.read_text())


def started(*words: str, folder: Path, env: dict[str, str] | None = None, deaf: bool = False) -> Started:
    """Start ``fieldhand`` with these words; who starts it ends it.

    Args:
        folder: For its pipe and its errors.
        deaf: As a script starts a program in the background, which does not see the Ctrl-C of the script.
    """
    number = next(_NUMBERS)
    pipe, err = folder / f"out-{number}", folder / f"err-{number}"
    os.mkfifo(pipe)
    environment = dict(os.environ) if env is None else env
    pid = _ordered(words, None, environment, [Path(os.devnull), pipe, err], background=True, deaf=deaf)
    return Started(pid=pid, out=pipe.open(), _err=err)


_NUMBERS = itertools.count(1)


def _ordered(
    words: tuple[str, ...],
    cwd: Path | None,
    env: dict[str, str],
    files: list[Path],
    *,
    background: bool = False,
    terminal: bool = False,
    deaf: bool = False,
    first: subprocess.Popen[str] | None = None,
) -> int:
    """Return the answer of the first process to an order."""
    order = {
        "words": words,
        "cwd": str(cwd or Path.cwd()),
        "env": env,
        "files": [str(file) for file in files],
        "limit_s": _LIMIT_S,
        "background": background,
        "terminal": terminal,
        "deaf": deaf,
    }
    return _answered(order, first or _first())


def _answered(order: dict[str, object], first: subprocess.Popen[str]) -> int:
    assert first.stdin is not None
    assert first.stdout is not None
    first.stdin.write(json.dumps(order) + "\n")
    first.stdin.flush()
    return int(first.stdout.readline())


def _started(words: tuple[str, ...], cwd: Path | None, env: dict[str, str], stdin: str | None) -> Run:
    done = subprocess.run(
        [sys.executable, "-m", "fieldhand", *words],
        capture_output=True,
        text=True,
        cwd=cwd,
        env=env,
        input=stdin or "",
        timeout=_LIMIT_S,
        check=False,
    )
    return Run(status=done.returncode, out=done.stdout, err=done.stderr)


def _at_start(env: dict[str, str]) -> dict[str, str]:
    return {name: value for name, value in env.items() if name.startswith(_AT_START)}


@cache
def _first() -> subprocess.Popen[str]:
    """The process that is copied; it ends when these tests do."""
    made = _loaded(dict(os.environ))
    atexit.register(made.communicate)
    return made


def _loaded(env: dict[str, str]) -> subprocess.Popen[str]:
    """Start a process that loads the libraries and is then copied."""
    return subprocess.Popen(
        [sys.executable, str(Path(__file__).with_name("command_server.py"))],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=env,
    )
