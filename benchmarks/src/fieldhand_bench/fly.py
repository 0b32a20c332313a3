"""Approve, simulate and judge the random mission of a seed."""

from __future__ import annotations

import time
from collections import defaultdict, deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import cache
from typing import TYPE_CHECKING, Literal

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
from fieldhand.errors import FieldhandError, NotApprovedError
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.guard import Guard
from fieldhand.forecast.estimate import estimate, mandatory_part
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice
from fieldhand.forecast.service import reward_of
from fieldhand.forecast.walk_branch import walk_branch
from fieldhand.forecast.walk_steps import NodeAnswer, WalkStep
from fieldhand.robot.model import LegCost, RobotProfile
from fieldhand.task import plan
from fieldhand.task.frames import Task, Then
from fieldhand.task.plan import Node
from fieldhand.task.results import Decided, Event
from fieldhand_bench.draw import Draft, draw
from fieldhand_bench.referee import Judgement, judge
from fieldhand_bench.scenes import MOST_TREES

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

#: Risk of a mission at approval. ``within``: mandatory work keeps to the accepted probability. ``warned``: it does not,
#: so that the approval carried a warning. ``hopeless``: not even driving home at once does.
Promise = Literal["within", "warned", "hopeless"]

_APPROVED_AT = datetime(2026, 1, 1, tzinfo=UTC)
#: Maximum number of draws of a seed; about one in three is approved.
_DRAWS = 60
_FEW_TREES = 20


@dataclass(frozen=True, kw_only=True)
class Forecast:
    """Optional visits and their reward, as forecast for the branch that the mission took."""

    visits: int
    reward: float


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A simulated and judged mission. It can be sent to another process.

    Attributes:
        seed, family, limited, factor, failure_probability: As in the draft.
        trees: Number of trees of the site.
        alpha: Certain part of a leg's cost, 0 to 1.
        then: Intended end of the mission.
        refused: Reasons why earlier draws of the seed were not approved, one sentence each.
        promise: Risk at approval, computed with the actual charge at the start.
        ruling: Judgement of the mission.
        forecast: Optional visits that were forecast at approval.
        certain: The same forecast with every leg's cost at its mean, which is an optimistic bound.
        first_s: Processor time of the guard's first decision, seconds.
        choices_s: Processor times of the later choices of an optional visit, seconds.
        admissions_s: Processor times of the later decisions on mandatory work, seconds; many of these were already
            made together with the visit before.
    """

    seed: int
    family: str
    limited: str
    factor: float
    failure_probability: float
    trees: int
    alpha: float
    then: Then
    refused: tuple[str, ...]
    promise: Promise
    ruling: Judgement
    forecast: Forecast
    certain: Forecast
    first_s: float
    choices_s: tuple[float, ...]
    admissions_s: tuple[float, ...]

    @property
    def failed(self) -> bool:
        """Return True if a budget or the reserve was exceeded."""
        return bool(self.ruling.exceeded)


@dataclass(frozen=True, kw_only=True)
class Flight:
    """A trial with its draft and its events."""

    trial: Trial
    draft: Draft
    events: tuple[Event, ...]


@dataclass
class TimedGuard:
    """A guard that delegates to another and records the processor time of each decision."""

    guard: Guard
    first_s: list[float] = field(default_factory=list)
    choices_s: list[float] = field(default_factory=list)
    admissions_s: list[float] = field(default_factory=list)

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        began = time.thread_time()
        verdict = self.guard.admit(state, visit, still_to_come)
        (self.admissions_s if self.first_s else self.first_s).append(time.thread_time() - began)
        return verdict

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> VisitChoice:
        began = time.thread_time()
        choice = self.guard.choose(state, candidates, at_most=at_most, still_to_come=still_to_come)
        (self.choices_s if self.first_s else self.first_s).append(time.thread_time() - began)
        return choice

    def update_drives(self, drives: Drives) -> None:
        self.guard.update_drives(drives)


def fly(seed: int, most_trees: int = MOST_TREES) -> Flight:
    """Draw the mission of a seed until it is approved, simulate it and judge it.

    Args:
        seed: Random seed of the whole mission.
        most_trees: Maximum number of trees of its site.

    Raises:
        FieldhandError: No draw of the seed is approved.
    """
    refused: list[str] = []
    for attempt in range(_DRAWS):
        draft = draw(seed, attempt, most_trees)
        if draft is None:
            continue
        try:
            approved = mission.authorize(
                mission.review(draft.task, draft.site, draft.robot),
                by="the experiment",
                at=_APPROVED_AT,
                confirmed=EveryWarning(),
            )
        except NotApprovedError as error:
            refused.append(error.what)
            continue
        return _flown(draft, approved, tuple(refused))
    raise FieldhandError(f"no mission of seed {seed} is approved", advice="take another seed")


def _flown(draft: Draft, approved: mission.ApprovedMission, refused: tuple[str, ...]) -> Flight:
    timed: list[TimedGuard] = []

    def watched(guard: Guard) -> Guard:
        timed.append(TimedGuard(guard))
        return timed[-1]

    events = mission.simulate(
        approved, world=World(charge_percent=draft.charge_percent), seed=draft.flight_seed, watched=watched
    ).events
    return Flight(trial=_trial(draft, refused, events, timed[0]), draft=draft, events=tuple(events))


def fly_all(seeds: Sequence[int], *, most_trees: int = MOST_TREES, jobs: int = 1) -> Iterator[Trial]:
    """Simulate many missions; yield each trial in the order of the seeds as soon as it is available.

    Args:
        seeds: Random seeds of the missions.
        most_trees: Maximum number of trees of each site.
        jobs: Number of processes; -1 for one per processor.
    """
    from joblib import Parallel, delayed

    yield from Parallel(n_jobs=jobs, return_as="generator")(delayed(_fly_one)(seed, most_trees) for seed in seeds)


def _fly_one(seed: int, most_trees: int) -> Trial:
    """Return the trial of a seed; at module level so that other processes can import it."""
    _warm_up()
    return fly(seed, most_trees).trial


@cache
def _warm_up() -> None:
    """Load compiled code once per process, so that no measured decision includes it."""
    for family in range(2):
        fly(family, _FEW_TREES)


def _trial(draft: Draft, refused: tuple[str, ...], events: Sequence[Event], timed: TimedGuard) -> Trial:
    certain = replace(draft.robot, leg_cost=LegCost(alpha=1.0))
    return Trial(
        seed=draft.seed,
        family=draft.family,
        limited=draft.limited,
        factor=draft.factor,
        failure_probability=draft.failure_probability,
        trees=len(draft.site.trees),
        alpha=draft.robot.leg_cost.alpha,
        then=draft.task.composition.nominal,
        refused=refused,
        promise=_promise(draft),
        ruling=judge(draft.task, draft.site, draft.robot, events),
        forecast=_forecast(draft, draft.robot, events),
        certain=_forecast(draft, certain, events),
        first_s=sum(timed.first_s),
        choices_s=tuple(timed.choices_s),
        admissions_s=tuple(timed.admissions_s),
    )


def _promise(draft: Draft) -> Promise:
    """Compare mandatory work, and the drive home alone, with the limits, from the charge at the start."""
    if not _exceeds(draft, mandatory_part(draft.task)):
        return "within"
    nothing = replace(draft.task.composition, plan=plan.InOrder(id=draft.task.composition.plan.id, steps=()))
    return "hopeless" if _exceeds(draft, replace(draft.task, composition=nothing)) else "warned"


def _exceeds(draft: Draft, task: Task) -> bool:
    found = estimate(task, draft.site, draft.robot, charge_percent=draft.charge_percent)
    return any(chance.exceeded for chance in found.worst.chances)


def _forecast(draft: Draft, robot: RobotProfile, events: Sequence[Event]) -> Forecast:
    walked = walk_branch(draft.task, draft.site, robot, holds=_as_it_went(events), charge_percent=draft.charge_percent)
    lists = [
        (step.node, place)
        for number, step in enumerate(walked.steps)
        if step.kind == "visit-list" and step.node.is_optional and step.node.visits_each
        for place in step.places[: _until(walked.steps[number:], step.node)]
    ]
    return Forecast(visits=len(lists), reward=sum(reward_of(node, place, draft.site) for node, place in lists))


def _until(steps: Sequence[WalkStep], node: Node) -> int:
    """Return the number of visits that a loop made until its end condition held."""
    tests = (s.answer for s in steps if s.kind == "decide" and s.node is node)
    return next((number for number, found in enumerate(tests, start=1) if found), len(steps))


def _as_it_went(events: Sequence[Event]) -> NodeAnswer:
    """Return the answers that conditions had in the mission; beyond the tested ones, the last answer again."""
    answers: dict[str, deque[bool]] = defaultdict(deque)
    for event in events:
        if isinstance(event, Decided):
            answers[event.node].append(event.holds)

    def holds(node_id: str) -> bool:
        known = answers[node_id]
        return (known.popleft() if len(known) > 1 else known[0]) if known else False

    return holds
