"""Missions of simulated robots for tests: small, approved, and each in a process of its own."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

from fieldhand.fleet import Fleet, WorkerSettings
from fieldhand.fleet.worker_folder import WorkerFolder
from support.missions.kept import inputs
from support.processes.patience import LONG_S, until

#: A mission of minutes, slow enough to be commanded.
SLOW = WorkerSettings(speed=2.0, by="Ana")
FAST = WorkerSettings(speed=None, by="Ana")


def begun(fleet: Fleet, settings: WorkerSettings = FAST) -> str:
    """Begin a mission with one reading of CO2 on the built-in orchard."""
    return fleet.begin(inputs(), settings)


def patience() -> Callable[[], bool]:
    """Wait for a mission for as long as it takes."""
    end = time.monotonic() + LONG_S

    def wait() -> bool:
        time.sleep(0.02)
        return time.monotonic() < end

    return wait


def state_of(fleet: Fleet, name: str) -> str:
    """Return the state of a mission."""
    feed = fleet.feed(name)
    assert feed is not None
    return feed.summary().state


def until_state(fleet: Fleet, name: str, *states: str) -> None:
    """Wait until a mission has one of these states."""
    until(lambda: state_of(fleet, name) in states)


def until_over(fleet: Fleet, name: str) -> None:
    """Wait until a mission has ended and its worker has, too."""
    until_state(fleet, name, "ended")
    until(lambda: name not in fleet.under_way())


def worker_pid(folder: Path) -> int:
    """Return the process that has a mission's worker folder locked, which inherited the descriptor."""
    place = WorkerFolder(folder).path.resolve()
    found = [
        int(process.name) for process in Path("/proc").iterdir() if process.name.isdigit() and _has(process, place)
    ]
    (pid,) = [one for one in found if one != os.getpid()]
    return pid


def kill_worker(fleet: Fleet, name: str) -> None:
    """Kill the worker of a mission, as a power cut does."""
    folder = fleet.folder(name)
    assert folder is not None
    os.kill(worker_pid(folder), signal.SIGKILL)
    until(lambda: name not in fleet.under_way())


def _has(process: Path, place: Path) -> bool:
    try:
        return any(link.resolve() == place for link in (process / "fd").iterdir())
    except OSError:
        return False
