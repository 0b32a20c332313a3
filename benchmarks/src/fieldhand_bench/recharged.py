"""Random missions that recharge: simulated, and compared with their forecasts."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any

import numpy as np

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
from fieldhand.errors import DriveFault, FieldhandError, NotApprovedError, PlaceError, SiteError
from fieldhand.forecast.branch_estimate import BranchEstimate
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import EveryNth, Half, RandomSample, TreeIs, Trees
from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.charging import DOCK, UNDOCK, Charging
from fieldhand.robot.model import Action, RobotProfile
from fieldhand.site.loader import parse_site
from fieldhand.site.model import Site
from fieldhand.site.random_orchards import make_orchard, random_shapes
from fieldhand.task.build import make_task
from fieldhand.task.conditions import TreeHas
from fieldhand.task.frames import Budget, Constraints, Resource, Task
from fieldhand.task.plan import Act, ForEach, If, InOrder, Node, Recharge, Repeat
from fieldhand.task.results import Acted, ChargeEnded, Ended, Faulted, LimitCrossed, MissionStatus, Shed
from fieldhand_bench.draw import needs
from fieldhand_bench.families import RandomChoices
from fieldhand_bench.scenes import WORTH, random_robot

#: Families of plans that are drawn, in turn: visits in one loop, several times, in several loops, with a test at each
#: place, with charges as steps of the plan, and as many as fit a time.
FAMILY_NAMES = ("each", "rounds", "several", "tested", "planned", "as many")

_APPROVED_AT = datetime(2026, 1, 1, tzinfo=UTC)
#: Maximum number of draws of a seed.
_DRAWS = 60
#: Number of charged batteries that a mission needs, and the share of the time that its budget allows.
_BATTERIES, _ALLOWED = (0.8, 6.0), (0.5, 1.6)
#: Share of a charged battery that the way to the farthest tree and back takes at most on average.
_FARTHEST = 0.4


@dataclass(frozen=True, kw_only=True)
class RechargedDraft:
    """A random mission before it is approved."""

    seed: int
    family: str
    site: Site
    robot: RobotProfile
    task: Task
    flight_seed: int


@dataclass(frozen=True, kw_only=True)
class RechargedTrial:
    """A simulated mission beside its forecast.

    Attributes:
        seed, family: As in the draft.
        status: End of the mission.
        stranded: True if its battery stopped it away from home.
        charges: Number of charges.
        least_percent: Lowest charge of the battery in its log.
        captures: Number of successful captures.
        shed: Number of pieces of mandatory work given up.
        seconds, metres, percent: Resources used.
        within: True for each of these if it is not above its forecast p90; None if the forecast has several
            branches, or if the mission did not do its whole plan.
        charges_forecast: Mean number of charges of the forecast.
        below_reserve: True if the reserve was not left at the end.
    """

    seed: int
    family: str
    status: MissionStatus
    stranded: bool
    charges: int
    least_percent: float
    captures: int
    shed: int
    seconds: float
    metres: float
    percent: float
    within: tuple[bool, bool, bool] | None
    charges_forecast: float
    below_reserve: bool


@dataclass(frozen=True, kw_only=True)
class RechargedSummary:
    """Figures of many trials.

    Attributes:
        missions: Number of missions; ``charged`` of them charged, ``charges`` times in all.
        stranded: Seeds of those that were stranded.
        compared: Number of missions that are compared with the p90 of their forecast.
        within: Fraction of these not above it, for seconds, metres and percent of the battery.
        statuses: Number of missions by their end.
    """

    missions: int
    charged: int
    charges: int
    stranded: tuple[int, ...]
    compared: int
    within: tuple[float, float, float]
    statuses: dict[str, int]

    @property
    def passed(self) -> bool:
        """Return True if none was stranded, and each forecast p90 holds for 85 to 95 % of the missions."""
        return not self.stranded and all(0.85 <= share <= 0.95 for share in self.within)


def draw_recharged(seed: int, attempt: int = 0) -> RechargedDraft | None:
    """Return the mission of a seed, or None if this draw requests what the site does not have."""
    rng = np.random.default_rng([4711, seed, attempt])
    try:
        site = _site(rng)
    except SiteError:
        return None
    robot, family = random_robot(rng), FAMILY_NAMES[seed % len(FAMILY_NAMES)]
    plan = _plan(family, RandomChoices(rng, site, robot))
    bare = _task(plan, site, robot, Constraints())
    try:
        needed = needs(bare, site, robot)
    except (PlaceError, DriveFault):
        return None
    until, fixed = float(rng.uniform(75.0, 100.0)), rng.random() < 0.5
    below = rng.random() < 0.3
    reserve = robot.energy.reserve_percent
    farthest_m = float(np.hypot(*(site.xy - np.array(site.markers["charger"].xy)).T).max())
    round_trip = robot.percent(2.0 * farthest_m, 2.0 * farthest_m / robot.speed_m_s)
    share = max(needed.percent / float(rng.uniform(*_BATTERIES)), round_trip / _FARTHEST)
    capacity_j = round(max(robot.energy.capacity_j * share / (until - reserve), 1.0))
    hours = float(rng.uniform(0.3, 3.0))
    charging = _charging(rng, capacity_j / 3600.0 / hours, until)
    robot = replace(robot, energy=replace(robot.energy, capacity_j=capacity_j, charging=charging))
    charge_s = hours * 3600.0 * needed.percent / 100.0
    time_s = (needed.seconds + charge_s) * float(rng.uniform(*_ALLOWED))
    constraints = Constraints(
        budgets=(Budget(kind="duration_s", limit=round(time_s)),) if family == "as many" else (),
        recharge=family != "planned",
        recharge_until_percent=round(until) if fixed and family != "planned" else None,
        recharge_below_percent=round(reserve + float(rng.uniform(5.0, 20.0)))
        if below and family != "planned"
        else None,
    )
    return RechargedDraft(
        seed=seed,
        family=family,
        site=site,
        robot=robot,
        task=_task(plan, site, robot, constraints),
        flight_seed=int(rng.integers(2**31)),
    )


def fly_recharged(seed: int) -> RechargedTrial:
    """Draw the mission of a seed until it is approved and needs to charge, and simulate it.

    Raises:
        FieldhandError: No draw of the seed is approved.
    """
    for attempt in range(_DRAWS):
        draft = draw_recharged(seed, attempt)
        if draft is None:
            continue
        try:
            approved = mission.authorize(
                mission.review(draft.task, draft.site, draft.robot),
                by="the experiment",
                at=_APPROVED_AT,
                confirmed=EveryWarning(),
            )
        except NotApprovedError:
            continue
        if approved.estimate is None or approved.estimate.worst.charges is None:
            continue
        if approved.estimate.worst.charges.mean >= 0.5:
            return _trial(draft, approved)
    raise FieldhandError(f"no mission of seed {seed} is approved", advice="take another seed")


def fly_all_recharged(seeds: Sequence[int], *, jobs: int = 1) -> Iterator[RechargedTrial]:
    """Yield the trials of seeds in order, simulated in so many processes."""
    if jobs == 1:
        yield from map(fly_recharged, seeds)
        return
    from joblib import Parallel, delayed

    yield from Parallel(n_jobs=jobs, return_as="generator")(delayed(fly_recharged)(seed) for seed in seeds)


def summarize_recharged(trials: Sequence[RechargedTrial]) -> RechargedSummary:
    """Return the figures of trials."""
    compared = [t.within for t in trials if t.within is not None]
    shares = [float(np.mean([within[k] for within in compared])) if compared else float("nan") for k in range(3)]
    statuses = [t.status for t in trials]
    return RechargedSummary(
        missions=len(trials),
        charged=sum(t.charges > 0 for t in trials),
        charges=sum(t.charges for t in trials),
        stranded=tuple(t.seed for t in trials if t.stranded),
        compared=len(compared),
        within=(shares[0], shares[1], shares[2]),
        statuses={status: statuses.count(status) for status in sorted(set(statuses))},
    )


def _trial(draft: RechargedDraft, approved: mission.ApprovedMission) -> RechargedTrial:
    run = mission.simulate(approved, seed=draft.flight_seed)
    events, forecast = run.events, approved.estimate
    assert forecast is not None and forecast.worst.charges is not None  # noqa: S101, PT018  fly_recharged checks both
    ended = next(event for event in events if isinstance(event, Ended))
    crossed = any(isinstance(e, LimitCrossed) and e.then == "stop" for e in events)
    empty = any(isinstance(e, Faulted) and "battery is empty" in e.what for e in events)
    spent = run.result.spent
    whole = run.status in ("completed", "exceeded") and len(forecast.branches) == 1
    return RechargedTrial(
        seed=draft.seed,
        family=draft.family,
        status=run.status,
        stranded=crossed or empty,
        charges=sum(isinstance(e, ChargeEnded) for e in events),
        least_percent=min(getattr(e, "charge_percent", 100.0) for e in events),
        captures=sum(isinstance(e, Acted) and e.status == "success" for e in events),
        shed=sum(isinstance(e, Shed) and not e.optional for e in events),
        seconds=spent.seconds,
        metres=spent.metres,
        percent=spent.percent,
        within=_within(forecast.worst, spent.seconds, spent.metres, spent.percent) if whole else None,
        charges_forecast=forecast.worst.charges.mean,
        below_reserve=ended.charge_percent < draft.robot.energy.reserve_percent - 1e-6,
    )


def _within(branch: BranchEstimate, seconds: float, metres: float, percent: float) -> tuple[bool, bool, bool]:
    return seconds <= branch.seconds.p90, metres <= branch.metres.p90, percent <= branch.percent.p90


def _plan(family: str, choices: RandomChoices) -> Node:
    """Return a random plan of a family."""
    match family:
        case "rounds":
            return Repeat(id="", times=choices.number(2, 4), body=_visits(choices))
        case "several":
            return InOrder(id="", steps=(_single(choices), _visits(choices), _single(choices), _visits(choices)))
        case "tested":
            body = (*_work(choices), _tested(choices))
            return _visits(choices, InOrder(id="", steps=body))
        case "planned":
            return InOrder(id="", steps=(_visits(choices), Recharge(), _visits(choices), Recharge(), _single(choices)))
        case "as many":
            return replace(_visits(choices), order="best", optional=True)
        case _:
            return _visits(choices)


def _visits(choices: RandomChoices, body: Node | None = None) -> ForEach:
    some: list[Selector] = [
        Trees(),
        Half(side="north"),
        Half(side="west"),
        EveryNth(nth=2),
        RandomSample(count=min(40, len(choices.site.trees)), seed=choices.number(0, 99)),
    ]
    select = some[choices.number(0, len(some) - 1)]
    work = InOrder(id="", steps=_work(choices)) if body is None else body
    return ForEach(id="", select=select, body=work, order="given" if choices.chance(0.2) else "best")


def _work(choices: RandomChoices) -> tuple[Node, ...]:
    some = range(choices.number(1, 3))
    return tuple(Act(id="", action=choices.action(), count=choices.number(1, 4)) for _ in some)


def _single(choices: RandomChoices) -> Node:
    (tree, *_) = choices.trees(1)
    return Act(id="", action=choices.action(), at=TreeIs(tree=tree), count=choices.number(1, 5))


def _tested(choices: RandomChoices) -> Node:
    """Return further work at the trees of one attribute, so that the site and no reading decides."""
    condition = TreeHas(attribute=WORTH, test="gt", value=8.0)
    return If(id="", condition=condition, then=InOrder(id="", steps=_work(choices)))


def _task(plan: Node, site: Site, robot: RobotProfile, constraints: Constraints) -> Task:
    return make_task(
        request="drawn by chance",
        plan=plan,
        measures=measures_of(robot),
        resources=(
            Resource(kind="robot", name=robot.name, sha256=robot.sha256),
            Resource(kind="site", name=site.name, sha256=site.sha256),
        ),
        constraints=constraints,
    )


def _site(rng: np.random.Generator) -> Site:
    """Return a random orchard of 30 to 250 trees with a start, an end and a charger in the headland."""
    shapes = random_shapes(rng, trees=int(rng.integers(30, 250)), blocks=int(rng.integers(1, 3)))
    made = make_orchard(rng, shapes, markers=True, fenced=bool(rng.random() < 0.3))
    features = made.collection["features"]
    beside = rng.choice(["start", "end"])
    (marker,) = (f for f in features if f["properties"].get("marker-symbol") == beside)
    lon, lat = marker["geometry"]["coordinates"]
    at = [lon + float(rng.uniform(-6e-5, 6e-5)), lat + float(rng.uniform(-2e-5, 2e-5))]
    charger = {"type": "Feature", "geometry": {"type": "Point", "coordinates": at}, "properties": {"kind": "charger"}}
    collection = {**made.collection, "features": [*(_with_worth(f, rng) for f in features), charger]}
    return parse_site(json.dumps(collection).encode(), name="random orchard")


def _with_worth(feature: dict[str, Any], rng: np.random.Generator) -> dict[str, Any]:
    """Return a tree with an attribute that a plan can test; other features unchanged."""
    properties = feature["properties"]
    if "marker-symbol" in properties or feature["geometry"]["type"] != "Point":
        return feature
    return {**feature, "properties": {**properties, WORTH: round(float(rng.gamma(2.0, 4.0)), 1)}}


def _charging(rng: np.random.Generator, power_w: float, until: float) -> Charging:
    """Return a charger of that power, which falls towards a full battery or not."""
    falls = rng.random() < 0.6
    curve = ((0.0, power_w), (80.0, power_w), (100.0, 0.2 * power_w)) if falls else ((0.0, power_w),)
    return Charging(
        dock=_maneuver(DOCK, float(rng.uniform(10.0, 90.0))),
        undock=_maneuver(UNDOCK, float(rng.uniform(5.0, 40.0))) if rng.random() < 0.7 else None,
        curve=curve,
        until_percent=round(until),
    )


def _maneuver(name: str, seconds: float) -> Action:
    return Action(name=name, words=(name,), verbs=(), measures=(), duration_s=seconds, energy_j=round(20.0 * seconds))
