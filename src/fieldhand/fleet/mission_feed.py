"""Events, position and state of a mission, read from its folder once for all who follow it.

The journal is read only when it has changed. The last events are kept; readers that are further behind read the journal
themselves, so that none of them makes others wait or lets memory grow.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from fieldhand import missions
from fieldhand.compatibility import UTC
from fieldhand.errors import FieldhandError
from fieldhand.fleet.worker_folder import SeenPosition, WorkerFolder, WorkerSettings
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from fieldhand.evaluation.progress import MissionProgress
    from fieldhand.robot.model import RobotProfile
    from fieldhand.task.frames import Task

#: Events that are kept in memory, and the most that one call returns.
KEPT, MOST = 500, 200
#: Seconds after which a journal is read even if its files look unchanged.
READ_EVERY_S = 1.0
#: Seconds between two evaluations of the state, each of which goes through all events.
STATE_EVERY_S = 0.5

FleetState = Literal["starting", "running", "paused", "interrupted", "ended"]


@dataclass(frozen=True, kw_only=True)
class LoggedLine:
    """An event as the journal has it.

    Attributes:
        n: Number, from 1.
        at: Time at which it was recorded, ISO 8601.
        line: JSON, as in an event log.
        event: The event; None for one of a type that this version does not know.
    """

    n: int
    at: str
    line: str
    event: Event | None


@dataclass(frozen=True, kw_only=True)
class FleetMission:
    """The state of a mission of the fleet.

    Attributes:
        id: Name of the mission.
        request: Request that it was planned from.
        robot, site: Their names.
        begun_at: Time at which it was begun, ISO 8601.
        settings: Settings of its worker.
        state: ``starting`` until its worker has opened the journal; ``interrupted`` without a worker.
        now: Progress.
        report: True once its report was written.
        fault: Reason why its worker ended before the mission did; empty if it did not.
    """

    id: str
    request: str
    robot: str
    site: str
    begun_at: str
    settings: WorkerSettings
    state: FleetState
    now: MissionProgress
    report: bool
    fault: str


@dataclass(frozen=True, kw_only=True)
class _Fixed:
    """Parts of a mission that do not change."""

    task: Task
    robot: RobotProfile
    site: str
    settings: WorkerSettings
    begun_at: str


class MissionFeed:
    """Reader of one mission, shared by all who follow it. Thread-safe.

    Args:
        folder: Folder of the mission.
        now: Monotonic clock, in seconds.
    """

    def __init__(self, folder: Path, *, now: Callable[[], float] = time.monotonic) -> None:
        self.id, self._folder, self._worker, self._now = folder.name, folder, WorkerFolder(folder), now
        self._lock = threading.Lock()
        self._tail: deque[LoggedLine] = deque(maxlen=KEPT)
        self._last = 0
        self._seen: object = None
        self._read_s = -READ_EVERY_S
        self._fixed_parts: _Fixed | None = None
        self._summary: tuple[object, float, FleetMission] | None = None

    @property
    def task(self) -> Task:
        """Task of the mission."""
        return self._fixed().task

    @property
    def robot(self) -> RobotProfile:
        """Profile of the robot."""
        return self._fixed().robot

    def lines_after(self, after: int, most: int = MOST) -> tuple[LoggedLine, ...]:
        """Return the events after number ``after``, in order, at most ``most``.

        Raises:
            JournalError: The journal cannot be read.
        """
        with self._lock:
            self._read_new()
            if after >= self._last:
                return ()
            if self._tail[0].n <= after + 1:
                skipped = after + 1 - self._tail[0].n
                return tuple(line for k, line in enumerate(self._tail) if skipped <= k < skipped + most)
        return self._lines(after, most)

    def position(self) -> SeenPosition | None:
        """Return the last position of the robot while a worker moves it; None before the first, and at the end."""
        return self._worker.position() if self._worker.is_alive() else None

    def summary(self) -> FleetMission:
        """Return the state of the mission, at most half a second old.

        Raises:
            JournalError: Its folder cannot be read.
        """
        with self._lock:
            self._read_new()
            alive, running = self._worker.is_alive(), missions.is_running(self._folder)
            report = (self._folder / "report.html").is_file()
            fault = "" if alive else self._worker.fault()
            now, key = self._now(), (self._last, alive, running, report, fault)
            if self._summary is not None and (self._summary[0] == key or now < self._summary[1] + STATE_EVERY_S):
                return self._summary[2]
            fixed, found = self._fixed(), missions.status(self._folder).now
            state: FleetState = found.state
            if state == "interrupted" and alive:
                state = "starting"
            summary = FleetMission(
                id=self.id,
                request=fixed.task.command.request,
                robot=fixed.robot.name,
                site=fixed.site,
                begun_at=fixed.begun_at,
                settings=fixed.settings,
                state=state,
                now=found,
                report=report,
                fault=fault,
            )
            self._summary = key, now, summary
            return summary

    def _read_new(self) -> None:
        """Read the events that were added to the journal."""
        seen, now = self._files(), self._now()
        if seen == self._seen and now < self._read_s + READ_EVERY_S:
            return
        while new := self._lines(self._last, MOST):
            self._tail.extend(new)
            self._last = new[-1].n
        self._seen, self._read_s = seen, now

    def _lines(self, after: int, most: int) -> tuple[LoggedLine, ...]:
        found = missions.lines_after(self._folder, after, most)
        return tuple(LoggedLine(n=n, at=at, line=line, event=_event(line)) for n, at, line in found)

    def _files(self) -> tuple[Any, ...]:
        """Return sizes and times of the files that change with each event."""
        return tuple(_stat(self._folder / name) for name in ("journal.sqlite", "journal.sqlite-wal", "events.jsonl"))

    def _fixed(self) -> _Fixed:
        if self._fixed_parts is None:
            from fieldhand.robot.loader import parse_profile
            from fieldhand.task.codec import decode

            contents = missions.read_folder(self._folder)
            task = decode(contents.files["task.xml"], source=str(self._folder / "task.xml"))
            robot = parse_profile(contents.files["robot.yaml"], source=str(self._folder / "robot.yaml"))
            site = next((part.name for part in task.resources if part.kind == "site"), "")
            begun = datetime.fromtimestamp((self._folder / "mission.json").stat().st_mtime, UTC)
            self._fixed_parts = _Fixed(
                task=task,
                robot=robot,
                site=site,
                settings=self._worker.settings(),
                begun_at=begun.isoformat(timespec="seconds"),
            )
        return self._fixed_parts


def _event(line: str) -> Event | None:
    try:
        return from_json(line)
    except FieldhandError:
        return None


def _stat(path: Path) -> tuple[int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_size, found.st_mtime_ns
