"""Keeping of timetables: each run of a mission that is due begins once, or is recorded as missed with a reason.

A run is recorded before it begins, under an id that follows from the mission and the time at which it is due. After a
power cut the next look at the clock therefore finds every run of the time between, and none twice. Runs are recorded up
to the latest one, so a clock that is set back makes none due again.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, tzinfo
from itertools import islice
from typing import TYPE_CHECKING

from fieldhand.compatibility import UTC
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.received_missions import ReceivedMission, RecordedRun
from fieldhand.errors import ExecutionError, FieldhandError, NotApprovedError
from fieldhand.task.timing import Schedule, Timing
from fieldhand.timetable.runs import Calendar, DueRun

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle

log = logging.getLogger("fieldhand.agent")

#: Seconds between two looks at the clock.
LOOK_EVERY_S = 5.0
#: Largest number of runs of a mission that one look records.
MOST_AT_ONCE = 1000
#: Number of the next runs that are listed.
NEXT_LISTED = 10

#: Begins a run; raises an error if it cannot begin now.
Begin = Callable[[ReceivedMission], None]


@dataclass(frozen=True, kw_only=True)
class Timetable:
    """The timetable of a mission that was received."""

    timing: Timing
    calendar: Calendar

    @property
    def makes_up(self) -> bool:
        """Return True if a missed run may begin until the next one is due."""
        return isinstance(self.timing, Schedule) and self.timing.missed == "late"


class TimetableKeeper:
    """Keeper of the timetables of the missions that a robot has received. Thread-safe.

    Args:
        mission_store: Missions that were received.
        begin: Begins a run.
        now: Returns the current time, with time zone.
        zone: Time zone of the robot, for missions that state none.
        lasts: Returns an upper estimate of the seconds that a mission takes.
    """

    def __init__(
        self,
        mission_store: MissionStore,
        begin: Begin,
        *,
        now: Callable[[], datetime],
        zone: tzinfo,
        lasts: Callable[[Bundle], float] = lambda _: 0.0,
    ) -> None:
        self._mission_store, self._begin, self._now, self._zone, self._lasts = mission_store, begin, now, zone, lasts
        self._lock = threading.RLock()
        self._timetables: dict[str, Timetable | None] = {}
        self._why: dict[str, str] = {}
        self._stopped = threading.Event()
        self._thread: threading.Thread | None = None

    def timetable_of(self, received: ReceivedMission) -> Timetable | None:
        """Return the timetable of a mission; None if it begins when it is started.

        Raises:
            BundleError, NotTrustedError, StoreError: The mission cannot be read.
        """
        with self._lock:
            if received.bundle not in self._timetables:
                self._timetables[received.bundle] = self._read(received)
            return self._timetables[received.bundle]

    def keep(self, received: ReceivedMission) -> None:
        """Keep the timetable of a mission from now on.

        Raises:
            ExecutionError: It has no run in the future, or was cancelled.
            StoreError: The database cannot be written.
        """
        if received.ended:
            raise ExecutionError(
                f"its timetable is no longer kept: {received.ended}",
                where=received.name,
                advice="have it approved again",
            )
        now = self._now()
        if not self.next_runs(received, 1, after=now):
            raise ExecutionError(
                "no run of it lies ahead", where=received.name, advice="have it approved again, with other times"
            )
        self._mission_store.keep(received, now)

    def cancel(self, received: ReceivedMission, why: str) -> None:
        """Keep the timetable of a mission no longer; a run that has begun goes on.

        Args:
            received: The mission, or a run that has not begun, which alone is then left out.
            why: Reason, or name of the operator.

        Raises:
            ExecutionError: It has no timetable, or the run has begun.
        """
        with self._lock:
            if received.run is not None:
                if received.begun_at is not None:
                    raise ExecutionError("the run has begun", where=received.name, advice="tell it to return or abort")
                self._mission_store.miss(received, why)
                return
            if self.timetable_of(received) is None:
                raise ExecutionError(
                    "the mission has no timetable", where=received.name, advice="tell it to return or abort"
                )
            self._mission_store.end(received, why)
            for run in self._mission_store.pending():
                if run.bundle == received.sha256:
                    self._mission_store.miss(run, why)

    def skip(self, received: ReceivedMission, due: datetime, why: str) -> ReceivedMission:
        """Leave out one run that lies ahead.

        Raises:
            ExecutionError: No run is due at that time.
        """
        with self._lock:
            runs = self.next_runs(received, MOST_AT_ONCE, after=self._now())
            found = next((run for run in runs if run.due == due), None)
            if found is None:
                raise ExecutionError(
                    f"no run is due at {due.isoformat()}", where=received.name, advice="choose one of the next runs"
                )
            return self._mission_store.add_run(received, _recorded(received, found, found.latest, missed=why))

    def next_runs(self, received: ReceivedMission, most: int, *, after: datetime | None = None) -> tuple[DueRun, ...]:
        """Return the next runs of a mission that are not left out, in order."""
        timetable = self.timetable_of(received)
        if timetable is None or received.ended:
            return ()
        left_out = {
            run.run.due for run in self._mission_store.runs(received, MOST_AT_ONCE) if run.run and run.run.missed
        }
        runs = timetable.calendar.runs(timetable.timing, after or self._now())
        return tuple(islice((run for run in runs if run.due.timestamp() not in left_out), most))

    # --- look at the clock ---------------------------------------------------------------------------------------

    def look(self) -> None:
        """Record the runs that are due, and begin the first that can begin."""
        with self._lock:
            now = self._now()
            for received in self._mission_store.kept():
                try:
                    self._record_due(received, now)
                except FieldhandError as error:
                    # A mission that cannot be read now, such as one whose key was revoked, has no runs.
                    self._explain(received, str(error))
            for run in self._mission_store.pending():
                self._attend(run, now)

    def _record_due(self, received: ReceivedMission, now: datetime) -> None:
        timetable = self.timetable_of(received)
        if timetable is None or received.kept_from is None:
            return
        known = self._mission_store.runs(received, 1)
        since = max(received.kept_from, *(run.run.due for run in known if run.run), received.kept_from)
        runs = timetable.calendar.runs(timetable.timing, datetime.fromtimestamp(since, UTC))
        recorded = 0
        due = next(runs, None)
        while due is not None and due.due <= now and recorded < MOST_AT_ONCE:
            following = next(runs, None)
            latest = due.latest
            if timetable.makes_up:
                latest = max(latest, timetable.calendar.expires if following is None else following.due)
            self._mission_store.add_run(received, _recorded(received, due, latest))
            recorded += 1
            due = following
        if due is None:
            self._mission_store.end(received, "its last run is over")

    def _attend(self, run: ReceivedMission, now: datetime) -> None:
        """Begin a run, leave it out if it is too late, or let it wait."""
        if run.run is None:
            return
        if now.timestamp() > run.run.latest:
            self._mission_store.miss(run, self._why.pop(run.sha256, "") or "the robot was off, or its clock was set")
            log.warning("run %s of %s was missed", run.name, run.bundle[:16])
            return
        try:
            self._begin(run)
        except NotApprovedError as error:
            self._mission_store.miss(run, str(error))
        except FieldhandError as error:
            # Another mission is under way, or the robot is not ready: try again until it is too late.
            self._explain(run, str(error))
        else:
            self._why.pop(run.sha256, None)

    def _explain(self, received: ReceivedMission, why: str) -> None:
        if self._why.get(received.sha256) != why:
            self._why[received.sha256] = why
            log.warning("mission %s: %s", received.name, why)

    def _read(self, received: ReceivedMission) -> Timetable | None:
        bundle = self._mission_store.read(received)
        timing = bundle.authorized.task.timing
        if timing is None:
            return None
        manifest, site = bundle.manifest, bundle.site
        calendar = Calendar(
            approved=manifest.approved_at,
            expires=manifest.until,
            zone=self._zone,
            lat=site.start.lat,
            lon=site.start.lon,
            lasts_s=self._lasts(bundle),
        )
        return Timetable(timing=timing, calendar=calendar)

    # --- in the agent --------------------------------------------------------------------------------------------

    def begin_watch(self, every_s: float = LOOK_EVERY_S) -> None:
        """Look at the clock in a thread of its own, until :meth:`close`."""

        def watch() -> None:
            while not self._stopped.wait(every_s):
                try:
                    self.look()
                except FieldhandError as error:
                    log.warning("timetables: %s", error)
                except Exception:
                    log.exception("timetables")

        self._thread = threading.Thread(target=watch, name="timetables", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Look at the clock no longer."""
        self._stopped.set()
        if self._thread is not None:
            self._thread.join()


def _recorded(received: ReceivedMission, run: DueRun, latest: datetime, missed: str = "") -> RecordedRun:
    return RecordedRun(
        of=received.sha256,
        due=run.due.timestamp(),
        latest=latest.timestamp(),
        done_by=None if run.done_by is None else run.done_by.timestamp(),
        missed=missed,
    )
