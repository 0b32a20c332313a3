"""Record and replay every external input, so that an interrupted mission resumes deterministically.

Execution is deterministic given what the driver, the guard, the clock and people answer. Each answer is recorded. A
mission that was cut off is carried out again with the recorded answers until they are used up; it then is in the state
in which it was, and the robot itself is asked. What the robot did meanwhile is not done again.

    observation ──▶ one instant: time, position, charge, goal, orders ──▶ answers every question until something is done

All of it is observed at one instant (:class:`~fieldhand.execution.journal.records.Observation`): after a goal begins or
is cancelled, after an answer of the guard and after time passes, the next question makes a new observation.

The log is on the disk before a goal begins, when it is over, and once a second in between; drives of a simulation whose
time jumps are left to the next of these.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypeVar

from fieldhand.clock import WallClock
from fieldhand.errors import FieldhandError, JournalError
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Driver, Position, Progress
from fieldhand.execution.guard import Failsafe, Guard
from fieldhand.execution.journal.records import (
    InputLog,
    Kind,
    Observation,
    Record,
    answer_record,
    choice_of,
    diverged,
    foresight_of,
    foresight_record,
    goal_record,
    observation_of,
    verdict_of,
)
from fieldhand.execution.mission_clock import LOOK_EVERY_S, MissionClock, StopTimeout
from fieldhand.execution.orders import Order
from fieldhand.forecast.state import Choice, MissionState, Verdict, Visit
from fieldhand.forecast.underway import Foresight, Underway
from fieldhand.language import message
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

#: Seconds of the wall clock after which observations are committed even if nothing began or ended.
COMMIT_EVERY_S = 1.0

Answer = TypeVar("Answer", Verdict, Choice)


class RecordedInputs:
    """All inputs of one mission: a clock and a guard that record and replay, and the robot as observed.

    Implements :class:`~fieldhand.clock.Clock` and :class:`~fieldhand.execution.guard.Guard`.
    :class:`~fieldhand.execution.drive_controller.DriveController` starts the goals.

    Args:
        driver, guard, failsafe: Asked where the log ends.
        clock: The mission's time.
        wall: The time of day, or None if there is none.
        log: Earlier answers; new ones are appended. None records nothing.
        emit: Takes each event if there is no log; a log passes its events on by itself.
        asked: Returns what a person wants now.
        simulated: True if the driver is a simulation that was created anew: replay then repeats to it what it was told.
            A real robot is where it is.

    Attributes:
        cuts: Power cuts so far.
    """

    def __init__(
        self,
        *,
        driver: Driver,
        guard: Guard,
        failsafe: Failsafe,
        clock: MissionClock,
        emit: Callable[[Event], None],
        asked: Callable[[], Order | None],
        wall: WallClock | None = None,
        log: InputLog | None = None,
        simulated: bool = False,
    ) -> None:
        self.cuts = 0
        self._driver, self._guard, self._failsafe = driver, guard, failsafe
        self._clock, self._wall, self._log = clock, wall, log
        self._emit, self._asked, self._simulated = emit, asked, simulated
        self._live = log is None
        self._wall_seen: float | None = None
        self._away_s: float | None = 0.0
        self._heard: Order | None = None
        self._now: Observation | None = None
        self._ahead: Record | None = None
        self._goal: DriveGoal | ActionGoal | None = None
        self._goal_from: Position | None = None
        self._goal_cut_off = False
        self._replayed = 0
        self._committed_s = time.monotonic()

    @property
    def seed(self) -> int | None:
        """The seed of a simulated robot, or None for a real one."""
        return self._driver.seed

    @property
    def seen(self) -> Observation:
        """The current observation."""
        if self._now is None:
            record = self._recorded("sight")
            self._now = self._observe() if record is None else self._observe_again(observation_of(record))
        return self._now

    def order(self) -> Order | None:
        """Return what a person wants now."""
        order = self.seen.order
        return None if order is None or order.wanted == "continue" else order

    def event(self, event: Event) -> None:
        """Take an event: the log passes it on once it is on the disk; without a log it is emitted at once."""
        if self._log is None:
            self._emit(event)
        else:
            self._log.event(to_json(event))

    # --- goals -----------------------------------------------------------------------------------------------------

    def start(self, goal: DriveGoal | ActionGoal) -> None:
        """Let the driver begin a goal, once the disk has the record that it is about to."""
        self._goal_from = self.seen.position
        record, before = goal_record(goal), self._recorded("begun")
        if before is not None and before.body != record.body:
            raise diverged(f"it began {before.body}, now it would begin {record.body}")
        if before is None:
            self._record(record, commit=self._must_commit(goal))
        if before is None or self._simulated:
            if isinstance(goal, DriveGoal):
                self._driver.start_drive(goal)
            else:
                self._driver.start_action(goal)
        self._goal, self._now = goal, None

    def cancel(self) -> None:
        """Ask the driver to end the current goal."""
        if self._recorded("cancel") is None:
            self._driver.cancel()
            self._record(Record(kind="cancel", body="{}"))
        elif self._simulated:
            self._driver.cancel()
        self._now = None

    # --- the clock -------------------------------------------------------------------------------------------------

    def now(self) -> float:
        """Return the mission's time of the current observation."""
        return self.seen.t

    def advance(self, seconds: float) -> None:
        """Let time pass, in real time at most until the next look is due; the next question observes anew."""
        self._now = None
        if self._live:
            self._commit_events()
            self._clock.advance(min(seconds, LOOK_EVERY_S * self._clock.speed))

    def wait(self, noteworthy: Callable[[float, float], bool]) -> None:
        """Wait until a person wants something else, the robot is stopped, or time and charge are noteworthy."""
        before, self._now = self.seen, None
        record = self._recorded("sight")
        if record is not None:
            self._now = self._observe_again(observation_of(record))
            return
        self._commit_events()
        while True:
            self._clock.rest()
            # A real robot is heard only while it is polled, its emergency stop too.
            self._driver.poll()
            news = self._asked() != before.order or self._driver.stopped() != before.stopped
            if news or noteworthy(self._clock.look(), self._driver.charge_percent()):
                self._now = self._observe()
                return

    # --- the guard and the failsafe ---------------------------------------------------------------------------------

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        """Return the guard's verdict, recorded or new."""
        return self._decide("admit", state.node, lambda: self._guard.admit(state, visit, still_to_come), verdict_of)

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> Choice:
        """Return the guard's choice, recorded or new."""
        return self._decide(
            "choose",
            state.node,
            lambda: self._guard.choose(state, candidates, at_most=at_most, still_to_come=still_to_come),
            choice_of,
        )

    def ways_are(self, drives: Drives) -> None:
        """Tell the guard that the ways have changed."""
        self._guard.ways_are(drives)

    def foresee(self, now: Underway) -> Foresight:
        """Return the failsafe's answer, recorded or new. Only alarms are recorded: no record means no alarm."""
        if not self._live:
            self._failsafe.learn(now)
            record = self._recorded_if("foresee")
            return Foresight() if record is None else foresight_of(record)
        answer = self._failsafe.foresee(now)
        if answer.alarm != "none":
            self._record(foresight_record(answer))
        return answer

    def _decide(
        self, kind: Kind, node: str, ask: Callable[[], Answer], answer_of: Callable[[Record, str], Answer]
    ) -> Answer:
        """Return the guard's answer about a node.

        In a replay the guard is asked again, so that it knows what it has granted; the recorded answer counts.
        """
        record = self._recorded(kind)
        answer: Answer | FieldhandError
        try:
            answer = ask()
        except FieldhandError as error:
            answer = error
        self._now = None
        if record is not None:
            return answer_of(record, node)
        self._record(answer_record(kind, node, answer))
        if isinstance(answer, FieldhandError):
            raise answer
        return answer

    # --- the end ---------------------------------------------------------------------------------------------------

    def interrupted(self) -> None:
        """Record a second Ctrl-C: what follows does not follow from the other answers alone."""
        if self._live:
            self._record(Record(kind="interrupt", body="{}"))
            self._now = None

    def abandon(self) -> None:
        """Stop recording, after an error that ends the mission: the robot can still be stopped."""
        if self._log is not None:
            self._emit = _discard
        self._log, self._live, self._now = None, True, None

    def finish(self) -> None:
        """Commit what is left when the mission is over."""
        if self._log is not None:
            self._commit()

    # --- the log ---------------------------------------------------------------------------------------------------

    def _recorded(self, kind: Kind) -> Record | None:
        """Return the recorded answer to a question, or None if the question has to be asked live."""
        while not self._live:
            record = self._next()
            if record is None:
                self._go_live()
            elif record.kind == "cut":
                self._cut()
            elif record.kind == "interrupt":
                raise KeyboardInterrupt
            elif record.kind != kind:
                raise diverged(f"the next answer is one to '{record.kind}', the mission asks for '{kind}'")
            else:
                self._replayed += 1
                return record
        return None

    def _recorded_if(self, kind: Kind) -> Record | None:
        """Return the next record if it is of a kind, and else leave it for the next question."""
        record = self._next()
        if record is not None and record.kind == kind:
            self._replayed += 1
            return record
        self._ahead = record
        return None

    def _next(self) -> Record | None:
        assert self._log is not None  # noqa: S101  without a log it is live from the beginning
        record, self._ahead = self._ahead, None
        return self._log.next() if record is None else record

    def _go_live(self) -> None:
        """Ask the robot itself from here on: the log is used up."""
        self._live, self._away_s = True, None
        if self._replayed:
            self._record(Record(kind="cut", body="{}"))
            self._cut()

    def _cut(self) -> None:
        """Count a power cut; the goal under way was cut off."""
        self.cuts += 1
        self._goal_cut_off = self._goal is not None
        if self._live or self._simulated:
            self._driver.cancel()

    def _record(self, record: Record, *, commit: bool = False) -> None:
        if self._log is None:
            return
        self._log.append(record)
        if commit or time.monotonic() - self._committed_s >= COMMIT_EVERY_S:
            self._commit()

    def _commit(self) -> None:
        assert self._log is not None  # noqa: S101  callers have one
        self._log.commit(order=0 if self._heard is None else self._heard.number)
        self._committed_s = time.monotonic()

    def _commit_events(self) -> None:
        """Commit if there are events: they are passed on only then, and nobody waits for them while time passes."""
        if self._log is not None and self._log.has_new_events:
            self._commit()

    # --- observations ----------------------------------------------------------------------------------------------

    def _observe(self) -> Observation:
        """Observe the robot as it is at this instant."""
        t = self._clock.look()
        progress = self._driver.poll()
        if self._goal_cut_off:
            progress = self._cut_off(progress)
        observation = Observation(
            t=t,
            position=self._driver.position(),
            charge_percent=self._driver.charge_percent(),
            progress=progress,
            stopped=self._driver.stopped(),
            lost=self._driver.lost(),
            wall=self._time_of_day(),
            next_in=self._driver.next_event_in(),
            order=self._asked(),
        )
        goal, changed = self._goal, observation.order != self._heard
        self._heard = observation.order
        self._record(observation.record(), commit=changed or (self._ends_goal(progress) and self._must_commit(goal)))
        return observation

    def _observe_again(self, observation: Observation) -> Observation:
        """Restore a recorded observation."""
        self._clock.set(observation.t)
        self._heard, self._wall_seen = observation.order, observation.wall
        if self._simulated:
            self._driver.poll()
        if observation.progress.state == "cut_off":
            self._goal_cut_off = False
        self._ends_goal(observation.progress)
        return observation

    def _time_of_day(self) -> float | None:
        """Return the time of day without the time that passed without power, which nobody has set."""
        if self._wall is None:
            return None
        now = self._wall.now()
        if self._away_s is None:
            self._away_s = 0.0 if self._wall_seen is None else now - self._wall_seen
        return now - self._away_s

    def _ends_goal(self, progress: Progress) -> bool:
        """Return True if the current goal has ended since the last observation."""
        if self._goal is None or not progress.over:
            return False
        self._goal = None
        return True

    def _must_commit(self, goal: DriveGoal | ActionGoal | None) -> bool:
        """Return True if the beginning and end of a goal must be on the disk before anything else is done.

        In a simulation whose time jumps no wheel has turned for a drive, and it may be driven again.
        """
        return isinstance(goal, ActionGoal) or not self._simulated or math.isfinite(self._clock.speed)

    def _cut_off(self, progress: Progress) -> Progress:
        """Return what is known of a goal that was under way when the power was cut, once the robot stands still.

        The driver may have forgotten how far a drive came: then it is at least the straight line.
        """
        timeout = StopTimeout(self._clock)
        while not progress.over:
            if timeout.expired():
                raise JournalError("the robot does not stop when told to", advice="use its emergency stop")
            self._clock.advance(self._driver.next_event_in() or LOOK_EVERY_S)
            self._clock.look()
            progress = self._driver.poll()
        self._goal_cut_off = False
        metres = 0.0
        if isinstance(self._goal, DriveGoal) and self._goal_from is not None:
            now = self._driver.position()
            metres = max(progress.metres, math.dist((now.x, now.y), (self._goal_from.x, self._goal_from.y)))
        return dataclasses.replace(
            progress,
            state="cut_off",
            metres=metres,
            readings={},
            what=message("the power was cut while it was made", context="log"),
        )


def _discard(event: Event) -> None:
    """Drop an event of a mission whose log cannot be written any more."""
