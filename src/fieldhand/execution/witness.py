"""What a mission is told by robot, guard, clock and people, kept on a tape and told again after a power cut.

Execution is deterministic given these answers. So each is recorded, and a mission that was cut off is carried out
anew with the recorded answers until they are used up: it then is in the very state in which it was, and the robot
itself is asked. What was the robot's business meanwhile is not done again.

    look ──▶ one instant: time, position, charge, goal, orders ──▶ the same for every question until something is done

All that can be seen is seen at one instant (:class:`~fieldhand.execution.journal.records.Sight`): when a goal begins
or is cancelled, when the guard has decided and when time passes, the next question takes a new look.

The tape is on the disk before a goal begins, when it is over, and once a second in between; drives of a simulation
whose time jumps are left to the next of these.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable
from typing import TypeVar

from fieldhand.clock import Clock, WallClock
from fieldhand.errors import FieldhandError, JournalError
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Driver, Position, Progress
from fieldhand.execution.guard import Guard
from fieldhand.execution.journal.records import (
    Kind,
    Record,
    Sight,
    Tape,
    answer_record,
    diverged,
    foresight_of,
    foresight_record,
    goal_record,
    sight_of,
)
from fieldhand.execution.mission_clock import LOOK_EVERY_S, MissionClock
from fieldhand.execution.orders import Order
from fieldhand.execution.watch import Lookout
from fieldhand.execution.witnessed import (
    WitnessedClock,
    WitnessedDriver,
    WitnessedGuard,
    WitnessedLookout,
    WitnessedWallClock,
)
from fieldhand.forecast.state import Choice, Verdict
from fieldhand.forecast.underway import Foresight
from fieldhand.language import message

#: Seconds of the wall clock after which what was seen is brought to the disk even if nothing began or ended.
SAFE_EVERY_S = 1.0

#: Seconds that a robot is given to stand still after a goal was cancelled, and looks at it: where its time passes
#: faster than ours, messages need more of it.
CANCEL_WITHIN_S, CANCEL_LOOKS = 10.0, 200

Asked = Callable[[], Order | None]
Answer = TypeVar("Answer", Verdict, Choice)


class Patience:
    """How long one waits for a robot to stand still.

    Args:
        clock: The mission's.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock, self._until_s, self._looks = clock, clock.now() + CANCEL_WITHIN_S, 0

    @property
    def over(self) -> bool:
        """Whether that was long enough; asked once at each look."""
        self._looks += 1
        return self._clock.now() >= self._until_s and self._looks > CANCEL_LOOKS


class Witness:
    """The driver, the guard, the clock and the orders of one mission, as the mission asks them.

    Args:
        driver, guard, lookout: Those that are asked where the tape ends.
        clock: The mission's time.
        wall: The time of day, if there is one.
        tape: What was answered before; what is answered now is added. None keeps nothing.
        asked: What a person wants now.
        simulated: The driver is a simulation that was made anew: it is brought to where it was by being told again what
            it was told then. A real robot is where it is.

    Attributes:
        cuts: Power cuts so far.
        driver, guard, lookout, clock, wall: What the mission asks. The time without power is no time of day that anyone
            has set.
    """

    def __init__(
        self,
        *,
        driver: Driver,
        guard: Guard,
        lookout: Lookout,
        clock: MissionClock,
        wall: WallClock | None = None,
        tape: Tape | None,
        asked: Asked,
        simulated: bool,
    ) -> None:
        self.cuts = 0
        self.clock: Clock = WitnessedClock(self)
        self.driver: Driver = WitnessedDriver(self, driver)
        self.guard: Guard = WitnessedGuard(self, guard)
        self.lookout: Lookout = WitnessedLookout(self, lookout)
        self.wall: WallClock | None = None if wall is None else WitnessedWallClock(self)
        self._robot = driver
        self._wall = wall
        self._wall_seen: float | None = None
        self._away_s: float | None = 0.0
        self._clock = clock
        self._tape = tape
        self._asked = asked
        self._shadow = simulated
        self._live = tape is None
        self._heard: Order | None = None
        self._sight: Sight | None = None
        self._ahead: Record | None = None
        self._goal: DriveGoal | ActionGoal | None = None
        self._from: Position | None = None
        self._lost = False
        self._records = 0
        self._safe_s = time.monotonic()

    # --- what the mission asks -----------------------------------------------------------------------------------

    @property
    def seen(self) -> Sight:
        """What is seen now."""
        if self._sight is None:
            record = self._told("sight")
            self._sight = self._look() if record is None else self._seen_again(sight_of(record))
        return self._sight

    def order(self) -> Order | None:
        """What a person wants now."""
        order = self.seen.order
        return None if order is None or order.wanted == "continue" else order

    def start(self, goal: DriveGoal | ActionGoal) -> None:
        """Let the driver begin a goal, once it is on the disk that it is about to."""
        self._from = self.seen.position
        record, told = goal_record(goal), self._told("begun")
        if told is not None and told.body != record.body:
            raise diverged(f"it began {told.body}, now it would begin {record.body}")
        if told is None:
            self._keep(record, safe=self._matters(goal))
        if told is None or self._shadow:
            if isinstance(goal, DriveGoal):
                self._robot.start_drive(goal)
            else:
                self._robot.start_action(goal)
        self._goal, self._sight = goal, None

    def cancel(self) -> None:
        """Ask for the end of the goal in hand."""
        if self._told("cancel") is None:
            self._robot.cancel()
            self._keep(Record(kind="cancel", body="{}"))
        elif self._shadow:
            self._robot.cancel()
        self._sight = None

    def advance(self, seconds: float) -> None:
        """Let time pass, where it takes real time not for long; then what can be seen is seen anew."""
        self._sight = None
        if self._live:
            self._say()
            self._clock.advance(min(seconds, LOOK_EVERY_S * self._clock.speed))

    def wait(self, noteworthy: Callable[[float, float], bool]) -> None:
        """Wait until a person wants something else, or the robot is stopped, or time and charge are noteworthy."""
        before, self._sight = self.seen, None
        record = self._told("sight")
        if record is not None:
            self._sight = self._seen_again(sight_of(record))
            return
        self._say()
        while True:
            self._clock.rest()
            # A real robot is heard only while it is polled, its emergency stop too.
            self._robot.poll()
            news = self._asked() != before.order or self._robot.stopped() != before.stopped
            if news or noteworthy(self._clock.look(), self._robot.charge_percent()):
                self._sight = self._look()
                return

    def decide(self, kind: Kind, node: str, ask: Callable[[], Answer], told: Callable[[Record, str], Answer]) -> Answer:
        """What the guard said of a node, or says now."""
        record = self._told(kind)
        said: Answer | FieldhandError
        try:
            said = ask()
        except FieldhandError as error:
            said = error
        self._sight = None
        if record is not None:
            return told(record, node)
        self._keep(answer_record(kind, node, said))
        if isinstance(said, FieldhandError):
            raise said
        return said

    def foresee(self, ask: Callable[[], Foresight]) -> Foresight:
        """Return the lookout's answer, recorded or new. Only alarms are recorded: no record means no alarm."""
        live, said = self._live, ask()
        if not live:
            record = self._told_if("foresee")
            return Foresight() if record is None else foresight_of(record)
        if said.alarm != "none":
            self._keep(foresight_record(said))
        return said

    def interrupted(self) -> None:
        """Ctrl-C came a second time: what follows is not what the answers alone say."""
        if self._live:
            self._keep(Record(kind="interrupt", body="{}"))
            self._sight = None

    def abandon(self) -> None:
        """An error ends the mission: the robot is to be stopped, and nothing can be kept of it any more."""
        self._tape, self._live, self._sight = None, True, None

    def finish(self) -> None:
        """The mission is over: bring what is left to the disk."""
        if self._tape is not None:
            self._commit()

    # --- the tape ------------------------------------------------------------------------------------------------

    def _told(self, kind: Kind) -> Record | None:
        """The recorded answer to this question; None where the robot itself is to be asked."""
        while not self._live:
            record = self._next()
            if record is None:
                self._hand_over()
            elif record.kind == "cut":
                self._cut()
            elif record.kind == "interrupt":
                raise KeyboardInterrupt
            elif record.kind != kind:
                raise diverged(f"the next answer is one to '{record.kind}', the mission asks for '{kind}'")
            else:
                self._records += 1
                return record
        return None

    def _told_if(self, kind: Kind) -> Record | None:
        """The recorded answer to a question that may have gone unanswered; None where the next answer is to another."""
        record = self._next()
        if record is not None and record.kind == kind:
            self._records += 1
            return record
        self._ahead = record
        return None

    def _next(self) -> Record | None:
        """The next answer on the tape."""
        assert self._tape is not None  # noqa: S101  without a tape it is live from the beginning
        record, self._ahead = self._ahead, None
        return self._tape.next() if record is None else record

    def _hand_over(self) -> None:
        """The tape is used up: from here the robot itself is asked."""
        self._live, self._away_s = True, None
        if self._records:
            self._keep(Record(kind="cut", body="{}"))
            self._cut()

    def _cut(self) -> None:
        """Here the power was cut: whatever the robot was at, it is at it no more."""
        self.cuts += 1
        self._lost = self._goal is not None
        if self._live or self._shadow:
            self._robot.cancel()

    def _keep(self, record: Record, *, safe: bool = False) -> None:
        if self._tape is None:
            return
        self._tape.append(record)
        if safe or time.monotonic() - self._safe_s >= SAFE_EVERY_S:
            self._commit()

    def _commit(self) -> None:
        assert self._tape is not None  # noqa: S101  asked for by those who have one
        self._tape.commit(order=0 if self._heard is None else self._heard.number)
        self._safe_s = time.monotonic()

    def _say(self) -> None:
        """Events are told once they are on the disk; nobody waits for them while time passes."""
        if self._tape is not None and self._tape.unsaid:
            self._commit()

    # --- a look --------------------------------------------------------------------------------------------------

    def _look(self) -> Sight:
        """See the robot as it is at this instant."""
        t = self._clock.look()
        progress = self._robot.poll()
        if self._lost:
            progress = self._cut_off(progress)
        sight = Sight(
            t=t,
            position=self._robot.position(),
            charge_percent=self._robot.charge_percent(),
            progress=progress,
            stopped=self._robot.stopped(),
            lost=self._robot.lost(),
            wall=self._time_of_day(),
            next_in=self._robot.next_event_in(),
            order=self._asked(),
        )
        goal, changed = self._goal, sight.order != self._heard
        self._heard = sight.order
        self._keep(sight.record(), safe=changed or (self._over(progress) and self._matters(goal)))
        return sight

    def _time_of_day(self) -> float | None:
        """Without the time that passed without power."""
        if self._wall is None:
            return None
        now = self._wall.now()
        if self._away_s is None:
            self._away_s = 0.0 if self._wall_seen is None else now - self._wall_seen
        return now - self._away_s

    def _seen_again(self, sight: Sight) -> Sight:
        """See what was seen then."""
        self._clock.set(sight.t)
        self._heard, self._wall_seen = sight.order, sight.wall
        if self._shadow:
            self._robot.poll()
        if sight.progress.state == "cut_off":
            self._lost = False
        self._over(sight.progress)
        return sight

    def _over(self, progress: Progress) -> bool:
        """Whether the goal in hand is over since the last look."""
        if self._goal is None or not progress.over:
            return False
        self._goal = None
        return True

    def _matters(self, goal: DriveGoal | ActionGoal | None) -> bool:
        """Whether beginning and end of a goal must be on the disk before anything else is done.

        In a simulation whose time jumps no wheel has turned for a drive, and it may be driven again.
        """
        return isinstance(goal, ActionGoal) or not self._shadow or math.isfinite(self._clock.speed)

    def _cut_off(self, progress: Progress) -> Progress:
        """What is known of a goal that was under way when the power was cut, once the robot stands still.

        How far a drive came, its driver may have forgotten: then it is at least the straight line.
        """
        patience = Patience(self._clock)
        while not progress.over:
            if patience.over:
                raise JournalError("the robot does not stop when told to", advice="use its emergency stop")
            self._clock.advance(self._robot.next_event_in() or LOOK_EVERY_S)
            self._clock.look()
            progress = self._robot.poll()
        self._lost = False
        metres = 0.0
        if isinstance(self._goal, DriveGoal) and self._from is not None:
            now = self._robot.position()
            metres = max(progress.metres, math.dist((now.x, now.y), (self._from.x, self._from.y)))
        return dataclasses.replace(
            progress,
            state="cut_off",
            metres=metres,
            readings={},
            what=message("the power was cut while it was made", context="log"),
        )
