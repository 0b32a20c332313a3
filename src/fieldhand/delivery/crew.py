"""What a robot is told to do with the missions that have arrived: one at a time, and each at most once.

Nothing here starts by itself, with one exception that has to be asked for: going on with a mission after a power cut.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand import missions
from fieldhand.delivery.depot import Depot
from fieldhand.delivery.ledger import Held
from fieldhand.delivery.standing import Line, Standing, State
from fieldhand.errors import ExecutionError, FieldhandError, JournalError, NotTrustedError

if TYPE_CHECKING:
    from pathlib import Path

    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.operator_commands import AgentCommand, OperatorCommand, StoppingCommand
    from fieldhand.execution.world import World

log = logging.getLogger("fieldhand.agent")

#: Carries a mission out to its end, in the thread that calls it: the simulation, or the driver of a robot.
Carry = Callable[[missions.Mission], object]
#: Seconds for which the next mission waits until the report of the one before is written.
REPORTED_WITHIN_S = 60.0


@dataclass(frozen=True, kw_only=True)
class Direct:
    """An order that was given in memory."""

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
            wait: As for :meth:`Crew.tell`.

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


class Crew:
    """Carries missions out, one at a time, each in a thread of its own. Safe for several threads.

    Args:
        depot: Where they have arrived.
        carry: Who carries one out.
        world: Of a simulation.
        check: Refuses a mission that this world, or this robot, does not fit; says on which robot it begins.
        conclude: Judges and reports a mission that has ended.
        seed: Of the simulation and of the guard.
    """

    def __init__(
        self,
        depot: Depot,
        *,
        carry: Carry,
        world: World | None = None,
        check: Callable[[Bundle], missions.Departure | None] = lambda _: None,
        conclude: Callable[[missions.Mission], object] = lambda _: None,
        seed: int = 0,
    ) -> None:
        self._depot, self._carry, self._world, self._check, self._seed = depot, carry, world, check, seed
        self._conclude = conclude
        self._guard = threading.Lock()
        self._active: Held | None = None
        self._direct = missions.DirectCommands()
        self._thread: threading.Thread | None = None
        self._faults: dict[str, str] = {}
        #: What has ended stays as it is, and need not be read again each time somebody looks.
        self._ended: dict[str, Standing] = {}

    # --- look ----------------------------------------------------------------------------------------------------

    @property
    def active(self) -> str | None:
        """SHA-256 of the mission that is under way."""
        held = self.under_way
        return None if held is None else held.sha256

    @property
    def under_way(self) -> Held | None:
        """The mission that is under way, from memory: no disk is read."""
        return self._active if self._thread is not None and self._thread.is_alive() else None

    @property
    def latest(self) -> Held | None:
        """The mission that is under way, else the one that was begun last."""
        return self.under_way or self._depot.last_begun()

    def standing(self, held: Held) -> Standing:
        """How a mission stands."""
        if held.sha256 in self._ended:
            return self._ended[held.sha256]
        folder, fault = self._depot.folder_of(held), self._faults.get(held.sha256, "")
        if not missions.exists(folder):
            return Standing(held=held, state="waiting" if held.begun_at is None else "lost", fault=fault)
        try:
            status = missions.status(folder)
        except FieldhandError as error:
            return Standing(held=held, state="lost", fault=fault or str(error))
        found = status.now
        state: State = "running" if found.state == "interrupted" and self.active == held.sha256 else found.state
        standing = Standing(
            held=held,
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
        if state == "ended" and self.active != held.sha256:
            self._ended[held.sha256] = standing
        return standing

    def lines(self, held: Held, after: int, most: int) -> tuple[tuple[Line, ...], bool]:
        """The events behind number ``after``, and whether nothing comes behind these for now.

        Nothing comes while nobody carries the mission out, be it that it has ended, waits or was cut off.

        Raises:
            JournalError: Its journal cannot be read.
        """
        folder = self._depot.folder_of(held)
        if not missions.exists(folder):
            return (), True
        # Asked before the events are read: what is written in between is told the next time.
        over = self.active != held.sha256 and not missions.is_running(folder)
        found = missions.lines_after(folder, after, most)
        return tuple(Line(n=n, at=at, line=line) for n, at, line in found), over and len(found) < most

    # --- tell ----------------------------------------------------------------------------------------------------

    def tell(self, held: Held, said: AgentCommand, reason: str, *, wait: Callable[[], bool] = lambda: False) -> bool:
        """Tell a mission something. What is so already stays so: an order may be sent twice.

        Args:
            held: The mission.
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
        folder = self._depot.folder_of(held)
        direct = self.tell_directly(held.sha256, said, reason)
        if direct is not None:
            return self.follow(held, direct, wait=wait)
        with self._guard:
            known = missions.exists(folder)
            if said == "start":
                # One that was begun is not begun again, whatever became of it.
                if not known and self.active != held.sha256:
                    self._begin(held)
                return True
            if not known:
                raise ExecutionError("the mission was not begun", where=held.name, advice="start it first")
            if self.active != held.sha256 and not missions.is_running(folder):
                return self._go_on(held, folder, said, reason)
        if said == "resume":
            self._direct.drop()
            if missions.last_order(folder) != "pause":
                return True
        return missions.order(folder, "continue" if said == "resume" else said, reason, wait=wait)

    def follow(self, held: Held, direct: Direct, *, wait: Callable[[], bool]) -> bool:
        """Keep an order that was given in memory in the mission's folder, too; see :meth:`tell`."""
        return direct.follow(self._depot.folder_of(held), wait)

    def tell_directly(self, sha256: str, said: AgentCommand, reason: str) -> Direct | None:
        """Give an order to the mission under way in memory: it waits for no disk, no lock and no other order.

        Returns:
            The order, which is still to be kept in the mission's folder; None if this mission is not under way here,
            the order is none that makes a robot stop or come home, or comes too late.
        """
        if self.active != sha256 or said == "start" or said == "resume":
            return None
        orders = self._direct
        order = orders.give(said, reason)
        return None if order is None else Direct(orders=orders, order=order, said=said)

    def go_on(self) -> str | None:
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

    def make_up(self) -> None:
        """Report the mission that was begun last, if it has ended and the power went before its report was written.

        It goes on in a thread of its own, as a mission does: the agent answers meanwhile.
        """
        held = self._depot.last_begun()
        standing = None if held is None else self.standing(held)
        if standing is None or standing.state != "ended" or standing.report:
            return
        self._ended.pop(standing.held.sha256, None)
        try:
            given = self._read(standing.held)
        except FieldhandError as error:
            log.warning("mission %s: %s", standing.held.name, error)
            return
        self._begin_thread(standing.held, lambda: self._conclude(given))

    def rest(self, wait: Callable[[], bool]) -> None:
        """Let the mission under way stand still, because the program ends; ``resume`` goes on with it."""
        active = self.active
        if active is None:
            return
        held = self._depot.get(active)
        try:
            if self.standing(held).state != "ended":
                self.tell(held, "pause", "the agent ends", wait=wait)
        except FieldhandError as error:
            log.warning("%s", error)
        # An order is heard a moment before the pause is on the disk; and one that has ended only writes its report.
        while self.active is not None and not self._at_rest(held) and wait():
            pass

    def _at_rest(self, held: Held) -> bool:
        """Whether it is paused, and the robot has broken off what it was at."""
        return self.standing(held).state == "paused" and missions.stands(self._depot.folder_of(held))

    def join(self, timeout_s: float | None = None) -> None:
        """Wait until no mission is under way."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def _begin(self, held: Held) -> None:
        self._require_free(held)
        bundle = self._depot.open(held.sha256)
        departure = self._check(bundle)
        inputs = missions.signed_inputs(bundle, world=self._world, seed=self._seed, departure=departure)
        given = missions.begin(self._depot.missions, held.name, inputs)
        self._depot.note_begun(held.sha256)
        self._run(held, given)

    def _read(self, held: Held) -> missions.Mission:
        """A mission as it lies in its folder, its signature, the trust in it and every byte verified again."""
        folder = self._depot.folder_of(held)
        try:
            contents = missions.read_folder(folder)
            if contents.signed is None:
                raise NotTrustedError(
                    "its folder lacks the signed mission", where=held.name, advice="have it approved and sent again"
                )
            return contents.mission(self._depot.verify)
        except FieldhandError as error:
            # What may not go on shall not keep the robot from working.
            self._faults[held.sha256] = str(error)
            raise

    def _go_on(self, held: Held, folder: Path, said: AgentCommand, reason: str) -> bool:
        """Go on with a mission that nobody carries out; what it is told holds from its first tick."""
        if missions.status(folder).now.state == "ended":
            raise ExecutionError("the mission has ended", where=held.name)
        if said == "start" or said == "pause":
            return True
        self._require_free(held)
        given = self._read(held)
        if said != "resume":
            missions.order(folder, said, reason)
        elif missions.last_order(folder) == "pause":
            missions.order(folder, "continue", reason)
        self._run(held, given)
        return True

    def _require_free(self, held: Held) -> None:
        under_way = self.active
        if under_way is not None and self.standing(self._depot.get(under_way)).state == "ended":
            self.join(REPORTED_WITHIN_S)  # it only writes its report
            under_way = self.active
        other = self._cut_off() if under_way is None else self._depot.get(under_way)
        if other is not None and other.sha256 != held.sha256:
            how = "was cut off" if under_way is None else "is under way"
            raise ExecutionError(
                f"another mission {how}: {other.name}",
                where=held.name,
                advice="let it end first, or tell it to return or abort",
            )

    def _cut_off(self) -> Held | None:
        # No mission begins while another is cut off, so it can only be the last one.
        held = self._depot.last_begun()
        if held is None or held.sha256 in self._faults or not missions.exists(self._depot.folder_of(held)):
            return None
        try:
            return None if missions.status(self._depot.folder_of(held)).now.state == "ended" else held
        except FieldhandError as error:
            # What cannot be read cannot be gone on with; it shall not keep the robot from working.
            log.warning("mission %s: %s", held.name, error)
            return None

    def _run(self, held: Held, given: missions.Mission) -> None:
        self._faults.pop(held.sha256, None)
        self._direct = missions.DirectCommands(missions.last_order(given.folder))
        told = replace(given, told=self._direct.standing)

        def carry() -> None:
            self._carry(told)
            if missions.status(given.folder).now.state == "ended":
                self._conclude(given)

        self._begin_thread(held, carry)

    def _begin_thread(self, held: Held, work: Callable[[], object]) -> None:
        def run() -> None:
            try:
                work()
            except FieldhandError as error:
                self._faults[held.sha256] = str(error)
                log.warning("mission %s: %s", held.name, error)
            except Exception as error:
                # A fault of the program: the mission stands as it is, and the agent answers on.
                self._faults[held.sha256] = f"a fault of the program: {type(error).__name__}"
                log.exception("mission %s", held.name)

        self._active = held
        self._thread = threading.Thread(target=run, name=f"mission {held.name}", daemon=True)
        self._thread.start()
