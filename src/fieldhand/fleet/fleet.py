"""Missions of simulated robots, each in a process of its own, found by their folders."""

from __future__ import annotations

import logging
import os
import re
import subprocess
import sys
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Literal

from fieldhand import missions
from fieldhand.compatibility import UTC
from fieldhand.errors import ExecutionError, FieldhandError, JournalError
from fieldhand.fleet.mission_feed import MissionFeed
from fieldhand.fleet.worker_folder import WorkerFolder, WorkerSettings
from fieldhand.folders import FolderTaken
from fieldhand.language import counted, message, named

log = logging.getLogger("fieldhand.fleet")

FleetCommand = Literal["pause", "resume", "return", "abort"]

#: Missions that may run at the same time: each is a process of 120 MB and more.
AT_ONCE = 8
#: Feeds that are kept for readers, with the last events of each.
_FEEDS = 64
_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,99}")


@dataclass(frozen=True, kw_only=True)
class CommandAnswer:
    """The answer to a command.

    Attributes:
        confirmed: True once the mission has received it.
        sent: True if it was written to the mission's folder; without a confirmation the mission will still receive it.
        by: Name of the mission that confirmed it; empty if none did.
        why: Reason, in words, if it was not confirmed.
    """

    confirmed: bool
    sent: bool
    by: str = ""
    why: str = ""


class Fleet:
    """The missions of simulated robots below a folder. Thread-safe; several servers may share the folder.

    Args:
        under: Folder of all missions; those without a worker are left alone.
        at_once: Missions that may run at the same time.
    """

    def __init__(self, under: Path, *, at_once: int = AT_ONCE) -> None:
        self._under, self._at_once = under, at_once
        self._lock, self._feeds_lock = threading.Lock(), threading.Lock()
        self._feeds: OrderedDict[str, MissionFeed] = OrderedDict()

    def begin(self, inputs: missions.Inputs, settings: WorkerSettings) -> str:
        """Store a mission, start its worker, and return its name.

        Raises:
            ExecutionError: As many missions as possible are running.
            JournalError: The mission's folder cannot be written.
        """
        with self._lock:
            if len(self.under_way()) >= self._at_once:
                raise ExecutionError(
                    counted(
                        "{count} mission is running, which is as many as can",
                        "{count} missions are running, which is as many as can",
                        self._at_once,
                    ),
                    advice=message("wait until one has ended, or abort one"),
                )
            name = missions.new_id(datetime.now(UTC))
            WorkerFolder(self._under / name).create(settings)
            stored = missions.begin(self._under, name, inputs)
            self._start(stored.folder)
        return name

    def ids(self) -> tuple[str, ...]:
        """Return the names of all missions, in the order in which they were begun.

        Raises:
            JournalError: The folder cannot be read.
        """
        return tuple(f.name for f in missions.all_missions(self._under) if _ID.fullmatch(f.name) and _has_worker(f))

    def under_way(self) -> tuple[str, ...]:
        """Return the names of the missions whose worker is alive."""
        return tuple(name for name in self.ids() if WorkerFolder(self._under / name).is_alive())

    def folder(self, name: str) -> Path | None:
        """Return the folder of a mission; None if there is no mission of that name."""
        folder = self._under / name
        return folder if _ID.fullmatch(name) and missions.exists(folder) and _has_worker(folder) else None

    def feed(self, name: str) -> MissionFeed | None:
        """Return the reader of a mission; None if there is no mission of that name."""
        folder = self.folder(name)
        with self._feeds_lock:
            feed = self._feeds.pop(name, None)
            if folder is None:
                return None
            self._feeds[name] = feed = feed or MissionFeed(folder)
            while len(self._feeds) > _FEEDS:
                self._feeds.popitem(last=False)
            return feed

    def command(self, folder: Path, command: FleetCommand, by: str, *, wait: Callable[[], bool]) -> CommandAnswer:
        """Send a command to a mission, and wait until the mission has received it.

        ``resume``, ``return`` and ``abort`` start the worker of an interrupted mission.

        Args:
            folder: Folder of the mission.
            command: The command.
            by: Name of the person who gives it, for the event log.
            wait: Waits a moment, and returns True to wait longer.
        """
        try:
            return self._command(folder, command, by, wait)
        except (ExecutionError, JournalError) as error:
            return CommandAnswer(confirmed=False, sent=False, why=error.what)

    def continue_interrupted(self) -> tuple[str, ...]:
        """Start the workers of missions that were cut off, and of those without a report; return their names.

        A paused mission stays interrupted, and so does one whose worker failed.
        """
        started = []
        for name in self.ids():
            folder = self._under / name
            try:
                if self._needs_worker(folder):
                    with self._lock:
                        self._start(folder)
                    started.append(name)
            except FieldhandError as error:
                log.warning("mission %s: %s", name, error)
            if len(self.under_way()) >= self._at_once:
                break
        return tuple(started)

    def _needs_worker(self, folder: Path) -> bool:
        worker = WorkerFolder(folder)
        if (folder / "report.html").is_file() or worker.is_alive() or missions.is_running(folder) or worker.fault():
            return False
        return missions.status(folder).now.state == "ended" or missions.last_command(folder) != "pause"

    def _command(self, folder: Path, command: FleetCommand, by: str, wait: Callable[[], bool]) -> CommandAnswer:
        worker = WorkerFolder(folder)
        alive = worker.is_alive() or missions.is_running(folder)
        if missions.status(folder).now.state == "ended":
            raise ExecutionError(message("the mission has ended"), where=folder.name)
        if command == "pause" and not alive:
            still = message("the mission is interrupted: nothing moves the robot; resume it first")
            return CommandAnswer(confirmed=False, sent=False, why=still)
        if command != "resume":
            missions.send_command(folder, command, by)
        elif missions.last_command(folder) in (("pause", "return", "abort") if alive else ("pause",)):
            missions.send_command(folder, "continue", by)
        if not alive:
            with self._lock:
                self._start(folder)
        while not (confirmed := self._has_received(folder)):
            if not worker.is_alive() and not missions.is_running(folder):
                confirmed = self._has_received(folder)
                break
            if not wait():
                break
        if confirmed:
            return CommandAnswer(confirmed=True, sent=True, by=folder.name)
        why = worker.fault() or message("the mission has not confirmed it yet; it will receive it when it can")
        return CommandAnswer(confirmed=False, sent=True, why=why)

    def _has_received(self, folder: Path) -> bool:
        """Return True if the mission has received every command, and is carried out or has ended."""
        return missions.has_received_all(folder) and (
            missions.is_running(folder) or missions.status(folder).now.state == "ended"
        )

    def _start(self, folder: Path) -> None:
        """Start the worker of a mission, unless one is alive.

        Raises:
            JournalError: The process cannot be started.
        """
        worker = WorkerFolder(folder)
        try:
            with worker.lock() as lock, worker.log.open("wb") as output:
                process = subprocess.Popen(  # noqa: S603  this program itself
                    [sys.executable, "-m", "fieldhand.fleet.worker", str(folder.absolute())],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=output,
                    # Ctrl-C at the server's terminal must not reach it; modules next to the server are not for it.
                    start_new_session=True,
                    env={**os.environ, "PYTHONSAFEPATH": "1"},
                    pass_fds=() if lock.descriptor is None else (lock.descriptor,),
                )
        except FolderTaken:
            return
        except OSError as error:
            raise JournalError(
                message("the mission's process cannot be started: {why}", why=named(error.strerror or "", "reason")),
                where=str(folder),
                advice=message("end other programs, then resume the mission"),
            ) from None
        threading.Thread(target=process.wait, name=f"worker of {folder.name}", daemon=True).start()


def _has_worker(folder: Path) -> bool:
    return WorkerFolder(folder).exists()
