"""Execution of the missions that a robot has received: one at a time, and each at most once.

No mission starts by itself, except the runs of a timetable that a person started; a resumption after a power cut has to
be requested (``--resume``).
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime, tzinfo
from typing import TYPE_CHECKING

from fieldhand import missions
from fieldhand.compatibility import UTC
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.delivery.received_status import LoggedEvent, ReceivedState, ReceivedStatus
from fieldhand.delivery.timetable_keeper import TimetableKeeper
from fieldhand.errors import ExecutionError, FieldhandError, JournalError, NotTrustedError
from fieldhand.task.earlier import together, uses_records, with_earlier

if TYPE_CHECKING:
    from pathlib import Path

    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.operator_commands import AgentCommand, MissionCommand, OperatorCommand, StoppingCommand

log = logging.getLogger("fieldhand.agent")

#: Carries a mission out to its end in the calling thread, in simulation or on a robot.
Carry = Callable[[missions.StoredMission], object]
#: Seconds for which a mission waits for the report of the previous one.
REPORTED_WITHIN_S = 60.0


@dataclass(frozen=True, kw_only=True)
class DirectCommand:
    """A command that was passed in memory."""

    orders: missions.DirectCommands
    order: OperatorCommand
    command: StoppingCommand

    @property
    def heard(self) -> bool:
        """Return True if the mission has received the command."""
        return self.orders.taken(self.order)

    def follow(self, folder: Path, wait: Callable[[], bool]) -> bool:
        """Write the command to the mission's folder, too, so that it survives a power cut.

        Args:
            folder: Folder of the mission.
            wait: As for :meth:`MissionSupervisor.give_command`.

        Returns:
            True if the mission has received the command.

        Raises:
            ExecutionError: The mission has ended, or has to return or to stop already.
            JournalError: The command cannot be written, and the mission has not received it.
        """
        try:
            heard = missions.send_command(
                folder, self.command, self.order.reason, wait=lambda: not self.heard and wait()
            )
        except FieldhandError as error:
            # With a full, slow or locked disk, the command still reaches the mission in memory.
            while not self.heard and isinstance(error, JournalError) and wait():
                pass
            if not self.heard:
                self.orders.drop(self.order)
                raise
            return True
        self.orders.drop(self.order)
        return heard or self.heard


class MissionSupervisor:
    """Supervisor that carries out missions, one at a time, each in a thread of its own. Thread-safe.

    Args:
        mission_store: Missions that were received.
        carry: Carries out a mission.
        world: World of the simulation.
        check: Raises an error if a mission cannot begin; returns the robot on which it begins, None in simulation.
        conclude: Judges and reports a mission that has ended.
        seed: Seed of the simulation and of the budget guard.
        now: Returns the current time, with time zone; the runs of timetables are due by it.
        zone: Time zone of the robot, for timetables that state none.
        lasts: Returns an upper estimate of the seconds that a mission takes.
        simulated: Count simulated missions among the earlier ones, as for an agent that simulates all of them.

    Attributes:
        timetables: Keeper of the timetables of missions.
    """

    def __init__(
        self,
        mission_store: MissionStore,
        *,
        carry: Carry,
        world: World | None = None,
        check: Callable[[Bundle], missions.RobotAtStart | None] = lambda _: None,
        conclude: Callable[[missions.StoredMission], object] = lambda _: None,
        seed: int = 0,
        now: Callable[[], datetime] = lambda: datetime.now(UTC),
        zone: tzinfo = UTC,
        lasts: Callable[[Bundle], float] = lambda _: 0.0,
        simulated: bool = False,
    ) -> None:
        self._mission_store, self._carry, self._world, self._check, self._seed = (
            mission_store,
            carry,
            world,
            check,
            seed,
        )
        self._now, self._zone, self._simulated = now, zone, simulated
        self.timetables = TimetableKeeper(mission_store, self.begin_run, now=now, zone=zone, lasts=lasts)
        self._conclude = conclude
        self._lock = threading.Lock()
        self._active: ReceivedMission | None = None
        self._direct = missions.DirectCommands()
        self._thread: threading.Thread | None = None
        self._faults: dict[str, str] = {}
        #: Status of ended missions, which does not change any more.
        self._ended: dict[str, ReceivedStatus] = {}

    # --- look ----------------------------------------------------------------------------------------------------

    def begin_run(self, run: ReceivedMission) -> None:
        """Begin a run of a mission with a timetable.

        Raises:
            ExecutionError: Another mission is under way, or was interrupted.
            NotApprovedError: The approval has expired, or a check found an error.
            FieldhandError: The robot is not ready, or the mission may not begin.
        """
        with self._lock:
            self._begin(run)

    @property
    def active(self) -> str | None:
        """SHA-256 of the running mission; None if none is running."""
        received = self.under_way
        return None if received is None else received.sha256

    @property
    def under_way(self) -> ReceivedMission | None:
        """The running mission, without reading the disk; None if none is running."""
        return self._active if self._thread is not None and self._thread.is_alive() else None

    @property
    def latest(self) -> ReceivedMission | None:
        """The running mission, else the one that was begun last."""
        return self.under_way or self._mission_store.last_begun()

    def status_of(self, received: ReceivedMission) -> ReceivedStatus:
        """Return the status of a mission."""
        if received.sha256 in self._ended:
            return self._ended[received.sha256]
        folder, fault = self._mission_store.folder_of(received), self._faults.get(received.sha256, "")
        if not missions.exists(folder):
            received = self._mission_store.find(received.sha256) or received
            state, reason = _state_without_folder(received)
            return ReceivedStatus(received=received, state=state, reason=reason, fault=fault)
        try:
            status = missions.status(folder)
        except FieldhandError as error:
            return ReceivedStatus(received=received, state="lost", fault=fault or str(error))
        found = status.now
        state = "running" if found.state == "interrupted" and self.active == received.sha256 else found.state
        standing = ReceivedStatus(
            received=received,
            state=state,
            status=found.status,
            reason=found.reason,
            doing=found.doing,
            lat=found.lat,
            lon=found.lon,
            charge_percent=found.charge_percent,
            travelled_m=found.travelled_m,
            events=found.events,
            fault=fault,
            report=status.report,
        )
        if state == "ended" and self.active != received.sha256:
            self._ended[received.sha256] = standing
        return standing

    def events_after(self, received: ReceivedMission, after: int, most: int) -> tuple[tuple[LoggedEvent, ...], bool]:
        """Return the events after number ``after``, and True if no event follows them for now.

        No event follows while no process carries the mission out: it has ended, waits, or was interrupted.

        Raises:
            JournalError: The journal cannot be read.
        """
        folder = self._mission_store.folder_of(received)
        if not missions.exists(folder):
            return (), True
        # Checked before the events are read: events logged in between are returned by the next call.
        over = self.active != received.sha256 and not missions.is_running(folder)
        found = missions.lines_after(folder, after, most)
        return tuple(LoggedEvent(n=n, at=at, line=line) for n, at, line in found), over and len(found) < most

    # --- tell ----------------------------------------------------------------------------------------------------

    def image_of(self, received: ReceivedMission, name: str) -> bytes | None:
        """Return the bytes of an image of a mission; None if there is no such image."""
        return missions.image_of(self._mission_store.folder_of(received), name)

    def give_command(
        self, received: ReceivedMission, command: AgentCommand, reason: str, *, wait: Callable[[], bool] = lambda: False
    ) -> bool:
        """Send a command to a mission; a command without effect is accepted, so that it may be sent twice.

        Args:
            received: The mission.
            command: The command.
            reason: Reason, or name of the operator, for the event log.
            wait: Waits a moment, and returns True to wait longer for the mission.

        Returns:
            True if the mission has received the command.

        Raises:
            ExecutionError: The command comes too late, or another mission is running.
            BundleError, NotTrustedError, StoreError: The mission may not begin.
            JournalError: Its folder cannot be used.
        """
        folder = self._mission_store.folder_of(received)
        if command == "cancel":
            self.timetables.cancel(received, reason)
            return True
        if command == "start" and received.run is None and self.timetables.timetable_of(received) is not None:
            self.timetables.keep(received)
            return True
        direct = self.give_direct_command(received.sha256, command, reason)
        if direct is not None:
            return self.follow(received, direct, wait=wait)
        with self._lock:
            known = missions.exists(folder)
            if command == "start":
                # A mission never begins twice.
                if not known and self.active != received.sha256:
                    self._begin(received)
                return True
            if not known:
                raise ExecutionError("the mission has not been started", where=received.name, advice="start it first")
            if self.active != received.sha256 and not missions.is_running(folder):
                return self._go_on(received, folder, command, reason)
        if command == "resume":
            self._direct.drop()
            if missions.last_command(folder) != "pause":
                return True
        return missions.send_command(folder, "continue" if command == "resume" else command, reason, wait=wait)

    def follow(self, received: ReceivedMission, direct: DirectCommand, *, wait: Callable[[], bool]) -> bool:
        """Write a command that was given in memory to the mission's folder, too; see :meth:`give_command`."""
        return direct.follow(self._mission_store.folder_of(received), wait)

    def give_direct_command(self, sha256: str, command: AgentCommand, reason: str) -> DirectCommand | None:
        """Send a command to the running mission in memory, without waiting for disk, locks or other commands.

        Returns:
            The command, which has yet to be written to the mission's folder; None if the mission is not running here,
            the command neither stops the robot nor calls it back, or comes too late.
        """
        if self.active != sha256 or command == "start" or command == "resume" or command == "cancel":
            return None
        orders = self._direct
        order = orders.give(command, reason)
        return None if order is None else DirectCommand(orders=orders, order=order, command=command)

    def continue_interrupted(self) -> str | None:
        """Resume the mission that a power cut interrupted, if there is one; a paused mission stays paused.

        Returns:
            Its SHA-256; None if there is none, or if its key was revoked or its folder was changed.
        """
        cut = self._interrupted()
        if cut is None:
            return None
        with self._lock:
            try:
                self._run(cut, self._read(cut))
            except FieldhandError as error:
                log.warning("mission %s: %s", cut.name, error)
                return None
        return cut.sha256

    def write_missing_report(self) -> None:
        """Write the report of the last mission, if it has ended and a power cut prevented its report.

        The report is written in a thread of its own, while the agent responds to requests.
        """
        received = self._mission_store.last_begun()
        standing = None if received is None else self.status_of(received)
        if standing is None or standing.state != "ended" or standing.report:
            return
        self._ended.pop(standing.received.sha256, None)
        try:
            stored = self._read(standing.received)
        except FieldhandError as error:
            log.warning("mission %s: %s", standing.received.name, error)
            return
        self._begin_thread(standing.received, lambda: self._conclude(stored))

    def pause_for_exit(self, wait: Callable[[], bool]) -> None:
        """Pause the running mission because the program ends; ``resume`` continues it."""
        active = self.active
        if active is None:
            return
        received = self._mission_store.get(active)
        try:
            if self.status_of(received).state != "ended":
                self.give_command(received, "pause", "the agent ends", wait=wait)
        except FieldhandError as error:
            log.warning("%s", error)
        # A command is received a moment before the pause is on disk; an ended mission only writes its report.
        while self.active is not None and not self._at_rest(received) and wait():
            pass

    def _at_rest(self, received: ReceivedMission) -> bool:
        """Return True if the mission is paused and the robot has no goal."""
        return self.status_of(received).state == "paused" and missions.stands_still(
            self._mission_store.folder_of(received)
        )

    def join(self, timeout_s: float | None = None) -> None:
        """Wait until no mission is running."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def _begin(self, received: ReceivedMission) -> None:
        self._require_free(received)
        bundle = self._mission_store.open(received.sha256)
        if received.run is not None:
            bundle = self._counted_anew(bundle)
        started_on = self._check(bundle)
        inputs = missions.signed_inputs(bundle, world=self._world, seed=self._seed, started_on=started_on)
        stored = missions.begin(self._mission_store.missions, received.name, inputs)
        self._mission_store.note_begun(received.sha256)
        self._run(received, stored)

    def _counted_anew(self, bundle: Bundle) -> Bundle:
        """Return a standing mission with the missions that the robot has done by now, if its plan depends on them.

        Raises:
            TaskError: They are more than a Task can depend on.
            PlaceError: A period is not a possible one.
        """
        task = bundle.authorized.task
        if not uses_records(task):
            return bundle
        own = missions.earlier_missions(
            bundle.site,
            self._mission_store.missions,
            now=self._now(),
            zone=self._zone,
            simulated=self._simulated,
            notice=lambda text: log.warning("%s", text),
        )
        counted = with_earlier(task, together(task.earlier, own)).earlier
        return replace(bundle, site=bundle.site.with_earlier(counted))

    def _read(self, received: ReceivedMission) -> missions.StoredMission:
        """Read a mission from its folder, and verify its signature, its key and every file again."""
        folder = self._mission_store.folder_of(received)
        try:
            contents = missions.read_folder(folder)
            if contents.signed is None:
                raise NotTrustedError(
                    "its folder lacks the signed mission", where=received.name, advice="have it approved and sent again"
                )
            return contents.mission(self._mission_store.verify)
        except FieldhandError as error:
            # A mission that may not be resumed must not block other missions.
            self._faults[received.sha256] = str(error)
            raise

    def _go_on(self, received: ReceivedMission, folder: Path, command: MissionCommand, reason: str) -> bool:
        """Resume a mission that no process carries out; the command takes effect at its first tick."""
        if missions.status(folder).now.state == "ended":
            raise ExecutionError("the mission has ended", where=received.name)
        if command == "start" or command == "pause":
            return True
        self._require_free(received)
        stored = self._read(received)
        if command != "resume":
            missions.send_command(folder, command, reason)
        elif missions.last_command(folder) == "pause":
            missions.send_command(folder, "continue", reason)
        self._run(received, stored)
        return True

    def _require_free(self, received: ReceivedMission) -> None:
        under_way = self.active
        if under_way is not None and self.status_of(self._mission_store.get(under_way)).state == "ended":
            self.join(REPORTED_WITHIN_S)  # the mission is only writing its report
            under_way = self.active
        other = self._interrupted() if under_way is None else self._mission_store.get(under_way)
        if other is not None and other.sha256 != received.sha256:
            how = "was interrupted" if under_way is None else "is under way"
            raise ExecutionError(
                f"another mission {how}: {other.name}",
                where=received.name,
                advice="wait until it ends, or tell it to return or abort",
            )

    def _interrupted(self) -> ReceivedMission | None:
        # No mission begins while another is interrupted, so it can only be the last one.
        received = self._mission_store.last_begun()
        if (
            received is None
            or received.sha256 in self._faults
            or not missions.exists(self._mission_store.folder_of(received))
        ):
            return None
        try:
            return None if missions.status(self._mission_store.folder_of(received)).now.state == "ended" else received
        except FieldhandError as error:
            # An unreadable mission cannot be resumed, and must not block other missions.
            log.warning("mission %s: %s", received.name, error)
            return None

    def _run(self, received: ReceivedMission, stored: missions.StoredMission) -> None:
        self._faults.pop(received.sha256, None)
        self._direct = missions.DirectCommands(missions.last_command(stored.folder))
        commanded = replace(stored, direct_command=self._direct.standing)

        def carry() -> None:
            self._carry(commanded)
            if missions.status(stored.folder).now.state == "ended":
                self._conclude(stored)

        self._begin_thread(received, carry)

    def _begin_thread(self, received: ReceivedMission, work: Callable[[], object]) -> None:
        def run() -> None:
            try:
                work()
            except FieldhandError as error:
                self._faults[received.sha256] = str(error)
                log.warning("mission %s: %s", received.name, error)
            except Exception as error:
                # A fault of the program: the mission stays as it is, and the agent keeps running.
                self._faults[received.sha256] = f"an internal error: {type(error).__name__}"
                log.exception("mission %s", received.name)

        self._active = received
        self._thread = threading.Thread(target=run, name=f"mission {received.name}", daemon=True)
        self._thread.start()


def _state_without_folder(received: ReceivedMission) -> tuple[ReceivedState, str]:
    """Return the state of a mission that has no folder, and its reason."""
    if received.run is not None and received.run.missed:
        return "missed", received.run.missed
    if received.ended:
        return "ended", received.ended
    if received.kept_from is not None:
        return "scheduled", ""
    return ("waiting" if received.begun_at is None else "lost"), ""
