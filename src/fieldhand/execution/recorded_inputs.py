"""Record and replay every external input, so that an interrupted mission resumes deterministically.

Execution is deterministic given the answers of the driver, the guard, the clock and the operator. Each answer is
recorded. An interrupted mission is carried out again with the recorded answers until they are used up; it is then in
its former state and continues with the robot itself. What the robot has already done is not repeated.

    observation ──▶ one instant: time, position, charge, goal, command ──▶ answers all questions until something is done

An :class:`~fieldhand.execution.journal.records.Observation` covers one instant: after a goal starts or is cancelled,
after a decision of the guard, and after time passes, the next question makes a new observation.

The log is synced before a goal starts, when it ends, and once a second in between; drives of a simulation whose time
jumps are not synced separately.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, TypeVar

from fieldhand.clock import WallClock
from fieldhand.errors import FieldhandError, JournalError
from fieldhand.execution.drivers.protocol import (
    ActionGoal,
    DriveGoal,
    Driver,
    EventSource,
    Odometer,
    Progress,
    SharedNavigation,
)
from fieldhand.execution.guard import Failsafe, Guard
from fieldhand.execution.images.course import Course
from fieldhand.execution.images.folder import ImageFolder, save_image
from fieldhand.execution.images.metadata import ImageFacts
from fieldhand.execution.journal.records import (
    InputLog,
    Observation,
    Record,
    RecordKind,
    answer_record,
    choice_of,
    divergence,
    foresight_of,
    foresight_record,
    goal_record,
    observation_of,
    verdict_of,
)
from fieldhand.execution.mission_clock import LOOK_EVERY_S, MissionClock, StopTimeout
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.execution.robot_text import robot_text, robot_text_or_none
from fieldhand.execution.unobserved_drive import UnobservedDrive, drive_since
from fieldhand.forecast.failsafe_state import FailsafeForecast, FailsafeState
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice
from fieldhand.language import message
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Event, ImageFile

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

#: Seconds of the wall clock after which observations are committed even if nothing began or ended.
COMMIT_EVERY_S = 1.0

GuardAnswer = TypeVar("GuardAnswer", Verdict, VisitChoice)


class RecordedInputs:
    """All inputs of one mission: a clock and a guard that record and replay, and observations of the robot.

    Implements :class:`~fieldhand.clock.Clock` and :class:`~fieldhand.execution.guard.Guard`.
    :class:`~fieldhand.execution.drive_controller.DriveController` starts the goals.

    Args:
        driver, guard, failsafe: Used once the recorded answers are used up.
        clock: Mission clock.
        wall: Time of day; None if there is none.
        log: Earlier answers; new ones are appended. None records nothing.
        emit: Receives each event if there is no log; a log forwards events itself.
        asked: Returns the current operator command.
        simulated: True if the driver is a newly created simulation, to which replay repeats all goals. A real robot
            stays
            where it is.
        watched: Names of the events that the mission watches.
        images: Saves the images of captures; None to save none.

    Attributes:
        cuts: Number of power cuts so far.
        unobserved: What the robot drove on during the last one; None for nothing.
        absent_s: Seconds for which nobody looked at the robot during all of them, as far as they are known.
    """

    def __init__(
        self,
        *,
        driver: Driver,
        guard: Guard,
        failsafe: Failsafe,
        clock: MissionClock,
        emit: Callable[[Event], None],
        current_command: Callable[[], OperatorCommand | None],
        wall: WallClock | None = None,
        log: InputLog | None = None,
        simulated: bool = False,
        watched: Collection[str] = (),
        images: ImageFolder | None = None,
    ) -> None:
        self.cuts = 0
        self._images, self._files = images, tuple[ImageFile, ...]()
        self._goals = 0
        self._course = Course()
        self.unobserved: UnobservedDrive | None = None
        self.absent_s, self._is_back = 0.0, False
        self._watched = tuple(watched)
        self._driver, self._guard, self._failsafe = driver, guard, failsafe
        self._clock, self._wall, self._log = clock, wall, log
        self._emit, self._current_command, self._simulated = emit, current_command, simulated
        self._live = log is None
        self._wall_seen: float | None = None
        self._away_s: float | None = 0.0
        self._last_command: OperatorCommand | None = None
        self._now: Observation | None = None
        self._ahead: Record | None = None
        self._goal: DriveGoal | ActionGoal | None = None
        #: The last look at the goal under way, or at the robot before it started.
        self._last: Observation | None = None
        self._goal_progress = Progress(state="running")
        self._goal_cut_off = False
        self._replayed = 0
        self._committed_s = time.monotonic()

    @property
    def seed(self) -> int | None:
        """The seed of a simulated robot, or None for a real one."""
        return self._driver.seed

    @property
    def observation(self) -> Observation:
        """The current observation."""
        if self._now is None:
            record = self._recorded("sight")
            self._now = self._observe() if record is None else self._observe_again(observation_of(record))
        return self._now

    def order(self) -> OperatorCommand | None:
        """Return the current operator command."""
        order = self.observation.order
        return None if order is None or order.wanted == "continue" else order

    def event(self, event: Event) -> None:
        """Record an event. The log forwards it once it is synced; without a log it is emitted at once."""
        if self._log is None:
            self._emit(event)
        else:
            self._log.event(to_json(event))

    # --- goals -----------------------------------------------------------------------------------------------------

    def start(self, goal: DriveGoal | ActionGoal) -> None:
        """Start a goal, once its record is synced."""
        self._last, self._goal_progress = self.observation, Progress(state="running")
        record, before = goal_record(goal), self._recorded("begun")
        if before is not None and before.body != record.body:
            raise divergence(f"it began {before.body}, now it would begin {record.body}")
        if before is None:
            self._record(record, commit=self._must_commit(goal))
        if before is None or self._simulated:
            if isinstance(goal, DriveGoal):
                self._driver.start_drive(goal)
            else:
                self._driver.start_action(goal)
        self._goal, self._now, self._files = goal, None, ()
        self._goals += 1

    def cancel(self) -> None:
        """Ask the driver to cancel the current goal."""
        if self._recorded("cancel") is None:
            self._driver.cancel()
            self._record(Record(kind="cancel", body="{}"))
        elif self._simulated:
            self._driver.cancel()
        self._now = None

    # --- clock -----------------------------------------------------------------------------------------------------

    def now(self) -> float:
        """Return the mission's time of the current observation."""
        return self.observation.t

    def advance(self, seconds: float) -> None:
        """Let time pass, in real time at most until the next poll is due; the next question makes a new observation."""
        self._now = None
        if self._live:
            self._commit_events()
            self._clock.advance(min(seconds, LOOK_EVERY_S * self._clock.speed))

    def wait(self, noteworthy: Callable[[float, float], bool]) -> None:
        """Wait until the operator command changes, the robot is stopped, or time and charge are noteworthy."""
        before, self._now = self.observation, None
        record = self._recorded("sight")
        if record is not None:
            self._now = self._observe_again(observation_of(record))
            return
        self._commit_events()
        while True:
            self._clock.rest()
            # A real robot, including its emergency stop, is only heard while it is polled.
            self._driver.poll()
            stopped = robot_text_or_none(self._driver.stopped())
            news = self._current_command() != before.order or stopped != before.stopped
            if news or noteworthy(self._clock.look(), self._driver.charge_percent()):
                self._now = self._observe()
                return

    # --- guard and failsafe ----------------------------------------------------------------------------------------

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
    ) -> VisitChoice:
        """Return the guard's choice, recorded or new."""
        return self._decide(
            "choose",
            state.node,
            lambda: self._guard.choose(state, candidates, at_most=at_most, still_to_come=still_to_come),
            choice_of,
        )

    def update_drives(self, drives: Drives) -> None:
        """Inform the guard that drives have changed."""
        self._guard.update_drives(drives)

    def foresee(self, now: FailsafeState) -> FailsafeForecast:
        """Return the failsafe's answer, recorded or new. Only alarms are recorded: no record means no alarm."""
        if not self._live:
            self._failsafe.learn(now)
            record = self._recorded_if("foresee")
            return FailsafeForecast() if record is None else foresight_of(record)
        answer = self._failsafe.foresee(now)
        if answer.alarm != "none":
            self._record(foresight_record(answer))
        return answer

    def _decide(
        self,
        kind: RecordKind,
        node: str,
        ask: Callable[[], GuardAnswer],
        answer_of: Callable[[Record, str], GuardAnswer],
    ) -> GuardAnswer:
        """Return the guard's answer about a node.

        In a replay the guard is asked again, so that its own state is restored; the recorded answer counts.
        """
        record = self._recorded(kind)
        answer: GuardAnswer | FieldhandError
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

    # --- end -------------------------------------------------------------------------------------------------------

    def interrupted(self) -> None:
        """Record a second Ctrl-C, which does not follow from the other inputs."""
        if self._live:
            self._record(Record(kind="interrupt", body="{}"))
            self._now = None

    def abandon(self) -> None:
        """Stop recording after an error that ends the mission; the robot can still be stopped."""
        if self._log is not None:
            self._emit = _discard
        self._log, self._live, self._now = None, True, None

    def finish(self) -> None:
        """Sync what is left when the mission is over."""
        if self._log is not None:
            self._commit()

    # --- log -------------------------------------------------------------------------------------------------------

    def _recorded(self, kind: RecordKind) -> Record | None:
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
                raise divergence(f"the next answer is one to '{record.kind}', the mission asks for '{kind}'")
            else:
                self._replayed += 1
                return record
        return None

    def _recorded_if(self, kind: RecordKind) -> Record | None:
        """Return the next record if it is of a kind; otherwise leave it for the next question."""
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
        """Continue with the robot itself: the recorded answers are used up."""
        self._live, self._away_s = True, None
        if self._replayed:
            self._record(Record(kind="cut", body="{}"))
            self._cut()

    def _cut(self) -> None:
        """Count a power cut; it interrupted the current goal."""
        self.cuts += 1
        self.unobserved, self._is_back = None, self._live and not self._simulated
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
        self._log.commit(order=0 if self._last_command is None else self._last_command.number)
        self._committed_s = time.monotonic()

    def _commit_events(self) -> None:
        """Sync if there are new events: they are forwarded only then, and nothing else is due while time passes."""
        if self._log is not None and self._log.has_new_events:
            self._commit()

    # --- observations ----------------------------------------------------------------------------------------------

    def _observe(self) -> Observation:
        """Observe the robot as it is at this instant."""
        t = self._clock.look()
        progress, unobserved = self._driver.poll(), None
        if self._goal_cut_off:
            progress, unobserved = self._cut_off(progress)
            t = self._clock.now()
        progress = self._with_files(progress)
        if progress.what:
            progress = dataclasses.replace(progress, what=robot_text(progress.what))
        shared = self._driver if isinstance(self._driver, SharedNavigation) else None
        observation = Observation(
            t=t,
            position=self._driver.position(),
            charge_percent=self._driver.charge_percent(),
            progress=progress,
            stopped=robot_text_or_none(self._driver.stopped()),
            lost=robot_text_or_none(self._driver.lost()),
            wall=self._time_of_day(),
            next_in=self._driver.next_event_in(),
            order=self._current_command(),
            events=self._events(),
            away=robot_text_or_none(shared.away()) if shared is not None else None,
            taken=robot_text_or_none(shared.taken()) if shared is not None else None,
            odometer_m=self._driver.odometer_m() if isinstance(self._driver, Odometer) else None,
            unobserved=unobserved,
            absent_s=self._stood_s() if self._is_back else 0.0,
        )
        self._is_back = False
        self._keep(observation)
        goal, changed = self._goal, observation.order != self._last_command
        self._last_command = observation.order
        self._record(observation.record(), commit=changed or (self._ends_goal(progress) and self._must_commit(goal)))
        return observation

    def _observe_again(self, observation: Observation) -> Observation:
        """Restore a recorded observation."""
        self._clock.set(observation.t)
        self._last_command, self._wall_seen = observation.order, observation.wall
        if self._simulated:
            self._driver.poll()
        if observation.progress.state == "cut_off":
            self._goal_cut_off = False
        self._keep(observation)
        self._ends_goal(observation.progress)
        return observation

    def _keep(self, observation: Observation) -> None:
        """Keep what is needed to find out what the robot drives on during a power cut."""
        self._last = observation
        self._course.add(observation.position)
        position, goal = observation.position, self._goal
        if position.heading_deg is None and isinstance(goal, DriveGoal) and observation.progress.state == "succeeded":
            self._course.turned(goal.heading_deg, position)
        self._files = observation.progress.files
        self.absent_s += observation.absent_s
        if observation.progress.state == "running":
            self._goal_progress = observation.progress
        if observation.unobserved is not None:
            self.unobserved = observation.unobserved

    def _with_files(self, progress: Progress) -> Progress:
        """Save the images of a capture that has just ended; its progress then names their files."""
        if not progress.over or not (progress.images or self._files):
            return progress
        if isinstance(self._goal, ActionGoal) and progress.images:
            facts = ImageFacts(
                number=self._goals,
                node=self._goal.node,
                attempt=self._goal.attempt,
                action=self._goal.action,
                place=self._goal.place,
                position=self._driver.position(),
                heading_deg=self._course.heading_deg,
                taken_s=None if self._wall is None else self._wall.now(),
            )
            self._files = tuple(save_image(self._images, image, facts) for image in progress.images)
        return dataclasses.replace(progress, images=(), files=self._files)

    def _events(self) -> Mapping[str, float | None]:
        """Return the values of the watched events; those that the driver does not report are unknown."""
        known = self._driver.events() if self._watched and isinstance(self._driver, EventSource) else {}
        return {name: known.get(name) for name in self._watched}

    def _time_of_day(self) -> float | None:
        """Return the time of day minus the time without power, which is no change of the clock."""
        if self._wall is None:
            return None
        now = self._wall.now()
        if self._away_s is None:
            driven_s = 0.0 if self.unobserved is None else self.unobserved.seconds
            self._away_s = 0.0 if self._wall_seen is None else now - self._wall_seen - driven_s
        return now - self._away_s

    def _ends_goal(self, progress: Progress) -> bool:
        """Return True if the current goal has ended since the last observation."""
        if self._goal is None or not progress.over:
            return False
        self._goal = None
        return True

    def _must_commit(self, goal: DriveGoal | ActionGoal | None) -> bool:
        """Return True if the start and end of a goal must be synced before anything else is done.

        A drive of a simulation whose time jumps need not be: it can be repeated.
        """
        return isinstance(goal, ActionGoal) or not self._simulated or math.isfinite(self._clock.speed)

    def _cut_off(self, progress: Progress) -> tuple[Progress, UnobservedDrive | None]:
        """Return the state of a goal that a power cut interrupted, once the robot stands still, and what it drove on.

        A simulation has driven nothing meanwhile. A real robot drove on to the end of its goal, which a new driver has
        not seen. The time of driving on counts.
        """
        timeout = StopTimeout(self._clock)
        while not progress.over:
            if timeout.expired():
                raise JournalError("the robot does not stop when told to", advice="use its emergency stop")
            self._clock.advance(self._driver.next_event_in() or LOOK_EVERY_S)
            self._clock.look()
            progress = self._driver.poll()
        self._goal_cut_off = False
        cut_off = dataclasses.replace(
            progress,
            state="cut_off",
            readings={},
            what=message("the power was cut while it was made", context="log"),
        )
        if self._simulated or self._last is None or not isinstance(self._goal, DriveGoal):
            return (cut_off if self._simulated else dataclasses.replace(cut_off, metres=0.0)), None
        odometer_m = self._driver.odometer_m() if isinstance(self._driver, Odometer) else None
        driven = drive_since(self._last, self._goal, self._driver.position(), odometer_m, within_s=self._absent_s())
        before = self._goal_progress
        self._clock.skip(driven.seconds)
        # Positions that are known to some centimetres are no drive.
        self.unobserved = driven if driven.is_seen else None
        metres, seconds = before.metres + driven.metres, before.seconds + driven.seconds
        return dataclasses.replace(cut_off, metres=metres, seconds=seconds), self.unobserved

    def _stood_s(self) -> float:
        """Return the seconds for which the robot stood while nobody looked; 0 if they are unknown."""
        absent_s = self._absent_s()
        driven_s = 0.0 if self.unobserved is None else self.unobserved.seconds
        return max(0.0, absent_s - driven_s) if math.isfinite(absent_s) else 0.0

    def _absent_s(self) -> float:
        """Return the seconds for which nobody looked at the robot; infinity if that is unknown."""
        if self._wall is None or self._wall_seen is None:
            return math.inf
        passed = self._wall.now() - self._wall_seen
        return passed if passed > 0.0 else math.inf


def _discard(event: Event) -> None:
    """Drop an event of a mission whose log cannot be written any more."""
