"""Driver, guard and clock as the mission asks them: each question goes to the witness."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Driver, Position, Progress
from fieldhand.execution.guard import Guard
from fieldhand.execution.journal.records import choice_of, verdict_of
from fieldhand.execution.watch import Lookout
from fieldhand.forecast.state import Choice, MissionState, Verdict, Visit
from fieldhand.forecast.underway import Foresight, Underway

if TYPE_CHECKING:
    from fieldhand.execution.witness import Witness
    from fieldhand.site.drives import Drives


class WitnessedClock:
    """The clock as the mission asks it."""

    def __init__(self, witness: Witness) -> None:
        self._witness = witness

    def now(self) -> float:
        return self._witness.seen.t

    def advance(self, seconds: float) -> None:
        self._witness.advance(seconds)


class WitnessedDriver:
    """The driver as the mission asks it."""

    def __init__(self, witness: Witness, robot: Driver) -> None:
        self._witness, self._robot = witness, robot

    @property
    def seed(self) -> int | None:
        return self._robot.seed

    def start_drive(self, goal: DriveGoal) -> None:
        self._witness.start(goal)

    def start_action(self, goal: ActionGoal) -> None:
        self._witness.start(goal)

    def poll(self) -> Progress:
        return self._witness.seen.progress

    def cancel(self) -> None:
        self._witness.cancel()

    def next_event_in(self) -> float | None:
        return self._witness.seen.next_in

    def position(self) -> Position:
        return self._witness.seen.position

    def charge_percent(self) -> float:
        return self._witness.seen.charge_percent

    def stopped(self) -> str | None:
        return self._witness.seen.stopped

    def lost(self) -> str | None:
        return self._witness.seen.lost


class WitnessedLookout:
    """The lookout as the mission asks it. It is asked again what it was asked, so that it learns the same."""

    def __init__(self, witness: Witness, lookout: Lookout) -> None:
        self._witness, self._lookout = witness, lookout

    def foresee(self, now: Underway) -> Foresight:
        return self._witness.foresee(lambda: self._lookout.foresee(now))


class WitnessedWallClock:
    """The time of day as the mission asks it."""

    def __init__(self, witness: Witness) -> None:
        self._witness = witness

    def now(self) -> float:
        return self._witness.seen.wall or 0.0


class WitnessedGuard:
    """The guard as the mission asks it. It is asked again what it was asked, so that it knows what it has granted; what
    counts is what it said then."""

    def __init__(self, witness: Witness, guard: Guard) -> None:
        self._witness, self._guard = witness, guard

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        return self._witness.decide(
            "admit", state.node, lambda: self._guard.admit(state, visit, still_to_come), verdict_of
        )

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> Choice:
        return self._witness.decide(
            "choose",
            state.node,
            lambda: self._guard.choose(state, candidates, at_most=at_most, still_to_come=still_to_come),
            choice_of,
        )

    def ways_are(self, drives: Drives) -> None:
        self._guard.ways_are(drives)
