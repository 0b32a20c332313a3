"""Execution of the missions that a robot has received: one at a time, and each at most once.

Nothing here starts by itself, with one exception that has to be asked for: going on with a mission after a power cut.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand import missions
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.delivery.received_status import LoggedEvent, ReceivedStatus, State
from fieldhand.errors import ExecutionError, FieldhandError, JournalError, NotTrustedError

if TYPE_CHECKING:
    from pathlib import Path

    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.operator_commands import AgentCommand, OperatorCommand, StoppingCommand

log = logging.getLogger("fieldhand.agent")

#: Carries a mission out to its end, in the thread that calls it: the simulation, or the driver of a robot.
Carry = Callable[[missions.StoredMission], object]
#: Seconds for which the next mission waits until the report of the one before is written.
REPORTED_WITHIN_S = 60.0


@dataclass(frozen=True, kw_only=True)
class DirectCommand:
    """A command that was passed in memory."""

    orders: missions.DirectCommands
    order: OperatorCommand
    said: StoppingCommand

    @property
    def heard(self) -> bool:
        """Return True if the mission has taken it."""
        return self.orders.taken(self.order)

    def follow(self, folder: Path, wait: Callable[[], bool]) -> bool:
        """Keep the order in the mission's folder, too, so that it stands after a power cut.

        Args:
            folder: The mission's.
            wait: As for :meth:`MissionSupervisor.give_command`.

        Returns:
            Whether the mission has heard it.

        Raises:
            ExecutionError: The mission has ended, or was told otherwise before.
            JournalError: It cannot be kept, and the mission has not heard it.
        """
        try:
            heard = missions.order(folder, self.said, self.order.reason, wait=lambda: not self.heard and wait())
        except FieldhandError as error:
            # A disk that is full, slow or locked keeps the order from nothing but its folder.
            while not self.heard and isinstance(error, JournalError) and wait():
                pass
            if not self.heard:
                self.orders.drop(self.order)
                raise
            return True
        self.orders.drop(self.order)
        return heard or self.heard


class MissionSupervisor:
    """Carries missions out, one at a time, each in a thread of its own. Safe for several threads.

    Args:
        mission_store: Where they have arrived.
        carry: Who carries one out.
        world: Of a simulation.
        check: Refuses a mission that this world, or this robot, does not fit; says on which robot it begins.
        conclude: Judges and reports a mission that has ended.
        seed: Of the simulation and of the guard.
    """

    def __init__(
        self,
        mission_store: MissionStore,
        *,
        carry: Carry,
        world: World | None = None,
        check: Callable[[Bundle], missions.Departure | None] = lambda _: None,
        conclude: Callable[[missions.StoredMission], object] = lambda _: None,
        seed: int = 0,
    ) -> None:
        self._mission_store, self._carry, self._world, self._check, self._seed = (
            mission_store,
            carry,
            world,
            check,
            seed,
        )
        self._conclude = conclude
        self._guard = threading.Lock()
        self._active: ReceivedMission | None = None
        self._direct = missions.DirectCommands()
        self._thread: threading.Thread | None = None
        self._faults: dict[str, str] = {}
        #: What has ended stays as it is, and need not be read again each time somebody looks.
        self._ended: dict[str, ReceivedStatus] = {}

    # --- look ----------------------------------------------------------------------------------------------------

    @property
    def active(self) -> str | None:
        """SHA-256 of the mission that is under way."""
        received = self.under_way
        return None if received is None else received.sha256

    @property
    def under_way(self) -> ReceivedMission | None:
        """The mission that is under way, from memory: no disk is read."""
        return self._active if self._thread is not None and self._thread.is_alive() else None

    @property
    def latest(self) -> ReceivedMission | None:
        """The mission that is under way, else the one that was begun last."""
        return self.under_way or self._mission_store.last_begun()

    def status_of(self, received: ReceivedMission) -> ReceivedStatus:
        """How a mission stands."""
        if received.sha256 in self._ended:
            return self._ended[received.sha256]
        folder, fault = self._mission_store.folder_of(received), self._faults.get(received.sha256, "")
        if not missions.exists(folder):
            return ReceivedStatus(
                received=received, state="waiting" if received.begun_at is None else "lost", fault=fault
            )
        try:
            status = missions.status(folder)
        except FieldhandError as error:
            return ReceivedStatus(received=received, state="lost", fault=fault or str(error))
        found = status.now
        state: State = "running" if found.state == "interrupted" and self.active == received.sha256 else found.state
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
        """The events behind number ``after``, and whether nothing comes behind these for now.

        Nothing comes while nobody carries the mission out, be it that it has ended, waits or was cut off.

        Raises:
            JournalError: Its journal cannot be read.
        """
        folder = self._mission_store.folder_of(received)
        if not missions.exists(folder):
            return (), True
        # Asked before the events are read: what is written in between is told the next time.
        over = self.active != received.sha256 and not missions.is_running(folder)
        found = missions.lines_after(folder, after, most)
        return tuple(LoggedEvent(n=n, at=at, line=line) for n, at, line in found), over and len(found) < most

    # --- tell ----------------------------------------------------------------------------------------------------

    def give_command(
        self, received: ReceivedMission, said: AgentCommand, reason: str, *, wait: Callable[[], bool] = lambda: False
    ) -> bool:
        """Tell a mission something. What is so already stays so: an order may be sent twice.

        Args:
            received: The mission.
            said: What to do.
            reason: Who wants it, or why.
            wait: Waits a moment, and says whether to wait longer for the mission to hear it.

        Returns:
            Whether the mission has heard it.

        Raises:
            ExecutionError: It comes too late, or another mission is under way.
            BundleError, NotTrustedError, StoreError: It may not be begun.
            JournalError: Its folder cannot be used.
        """
        folder = self._mission_store.folder_of(received)
        direct = self.give_direct_command(received.sha256, said, reason)
        if direct is not None:
            return self.follow(received, direct, wait=wait)
        with self._guard:
            known = missions.exists(folder)
            if said == "start":
                # One that was begun is not begun again, whatever became of it.
                if not known and self.active != received.sha256:
                    self._begin(received)
                return True
            if not known:
                raise ExecutionError("the mission was not begun", where=received.name, advice="start it first")
            if self.active != received.sha256 and not missions.is_running(folder):
                return self._go_on(received, folder, said, reason)
        if said == "resume":
            self._direct.drop()
            if missions.last_order(folder) != "pause":
                return True
        return missions.order(folder, "continue" if said == "resume" else said, reason, wait=wait)

    def follow(self, received: ReceivedMission, direct: DirectCommand, *, wait: Callable[[], bool]) -> bool:
        """Keep an order that was given in memory in the mission's folder, too; see :meth:`give_command`."""
        return direct.follow(self._mission_store.folder_of(received), wait)

    def give_direct_command(self, sha256: str, said: AgentCommand, reason: str) -> DirectCommand | None:
        """Give an order to the mission under way in memory: it waits for no disk, no lock and no other order.

        Returns:
            The order, which is still to be kept in the mission's folder; None if this mission is not under way here,
            the order is none that makes a robot stop or come home, or comes too late.
        """
        if self.active != sha256 or said == "start" or said == "resume":
            return None
        orders = self._direct
        order = orders.give(said, reason)
        return None if order is None else DirectCommand(orders=orders, order=order, said=said)

    def continue_interrupted(self) -> str | None:
        """Go on with the mission that a power cut has cut off, if there is one; a paused one stays paused.

        Returns:
            Its SHA-256; None also where it may not go on: its key was revoked since, or its folder was changed.
        """
        cut = self._cut_off()
        if cut is None:
            return None
        with self._guard:
            try:
                self._run(cut, self._read(cut))
            except FieldhandError as error:
                log.warning("mission %s: %s", cut.name, error)
                return None
        return cut.sha256

    def write_missing_report(self) -> None:
        """Report the mission that was begun last, if it has ended and the power went before its report was written.

        It goes on in a thread of its own, as a mission does: the agent answers meanwhile.
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
        """Let the mission under way stand still, because the program ends; ``resume`` goes on with it."""
        active = self.active
        if active is None:
            return
        received = self._mission_store.get(active)
        try:
            if self.status_of(received).state != "ended":
                self.give_command(received, "pause", "the agent ends", wait=wait)
        except FieldhandError as error:
            log.warning("%s", error)
        # An order is heard a moment before the pause is on the disk; and one that has ended only writes its report.
        while self.active is not None and not self._at_rest(received) and wait():
            pass

    def _at_rest(self, received: ReceivedMission) -> bool:
        """Whether it is paused, and the robot has broken off what it was at."""
        return self.status_of(received).state == "paused" and missions.stands_still(
            self._mission_store.folder_of(received)
        )

    def join(self, timeout_s: float | None = None) -> None:
        """Wait until no mission is under way."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def _begin(self, received: ReceivedMission) -> None:
        self._require_free(received)
        bundle = self._mission_store.open(received.sha256)
        departure = self._check(bundle)
        inputs = missions.signed_inputs(bundle, world=self._world, seed=self._seed, departure=departure)
        stored = missions.begin(self._mission_store.missions, received.name, inputs)
        self._mission_store.note_begun(received.sha256)
        self._run(received, stored)

    def _read(self, received: ReceivedMission) -> missions.StoredMission:
        """A mission as it lies in its folder, its signature, the trust in it and every byte verified again."""
        folder = self._mission_store.folder_of(received)
        try:
            contents = missions.read_folder(folder)
            if contents.signed is None:
                raise NotTrustedError(
                    "its folder lacks the signed mission", where=received.name, advice="have it approved and sent again"
                )
            return contents.mission(self._mission_store.verify)
        except FieldhandError as error:
            # What may not go on shall not keep the robot from working.
            self._faults[received.sha256] = str(error)
            raise

    def _go_on(self, received: ReceivedMission, folder: Path, said: AgentCommand, reason: str) -> bool:
        """Go on with a mission that nobody carries out; what it is told holds from its first tick."""
        if missions.status(folder).now.state == "ended":
            raise ExecutionError("the mission has ended", where=received.name)
        if said == "start" or said == "pause":
            return True
        self._require_free(received)
        stored = self._read(received)
        if said != "resume":
            missions.order(folder, said, reason)
        elif missions.last_order(folder) == "pause":
            missions.order(folder, "continue", reason)
        self._run(received, stored)
        return True

    def _require_free(self, received: ReceivedMission) -> None:
        under_way = self.active
        if under_way is not None and self.status_of(self._mission_store.get(under_way)).state == "ended":
            self.join(REPORTED_WITHIN_S)  # it only writes its report
            under_way = self.active
        other = self._cut_off() if under_way is None else self._mission_store.get(under_way)
        if other is not None and other.sha256 != received.sha256:
            how = "was cut off" if under_way is None else "is under way"
            raise ExecutionError(
                f"another mission {how}: {other.name}",
                where=received.name,
                advice="let it end first, or tell it to return or abort",
            )

    def _cut_off(self) -> ReceivedMission | None:
        # No mission begins while another is cut off, so it can only be the last one.
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
            # What cannot be read cannot be gone on with; it shall not keep the robot from working.
            log.warning("mission %s: %s", received.name, error)
            return None

    def _run(self, received: ReceivedMission, stored: missions.StoredMission) -> None:
        self._faults.pop(received.sha256, None)
        self._direct = missions.DirectCommands(missions.last_order(stored.folder))
        told = replace(stored, told=self._direct.standing)

        def carry() -> None:
            self._carry(told)
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
                # A fault of the program: the mission stands as it is, and the agent answers on.
                self._faults[received.sha256] = f"a fault of the program: {type(error).__name__}"
                log.exception("mission %s", received.name)

        self._active = received
        self._thread = threading.Thread(target=run, name=f"mission {received.name}", daemon=True)
        self._thread.start()
