"""Expected optional visits, from the robot's own decisions in many simulated missions."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import DriveFault
from fieldhand.forecast.candidates import cheapest
from fieldhand.forecast.charged_visits import ChargedVisits, from_charger
from fieldhand.forecast.mission_state import Spent, Visit, Work
from fieldhand.forecast.orienteering_problem import GONE, left_before, policy_for, visits_problem
from fieldhand.forecast.recharge_rules import mission_limits, recharge_rules
from fieldhand.forecast.remaining_work import RemainingWork, optional_runs, remaining_work_after, whole_mission_work
from fieldhand.forecast.resource_limits import ResourceLimit, resource_limits
from fieldhand.forecast.risk_allowance import RiskAllowance
from fieldhand.forecast.route_cost import RouteCost, cost_model, overrun_chances, route_cost
from fieldhand.forecast.sampled_costs import DRAWS
from fieldhand.forecast.visit_distances import MAX_DOUBLE, visit_distances
from fieldhand.forecast.walk_steps import VisitForecast
from fieldhand.site.model import Place
from fieldhand.task.build import exit_of
from fieldhand.task.plan import ForEach, OptionalStep, WorkAlong

if TYPE_CHECKING:
    from fieldhand.forecast.request_handler import ForecastHandler
    from fieldhand.orienteering.preview import Preview
    from fieldhand.orienteering.problem import Problem

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class ExpectedVisits:
    """The expected outcome of the optional visits of one node.

    Attributes:
        places: The most probable visits, as many as missions make on average, in visiting order.
        shed: All other places, the most probable first; those excluded from the choice (too many candidates) last.
        visit_forecast: Probability of each visit.
        preview: The simulated missions.
        ids: Ids of the candidate places; the preview's vertex ``v`` has index ``v - 1``.
        works: Work at each candidate place.
        allowance: Probability of running short that later optional visits may still add.
        charged: The simulated missions with their charges; None if they do not recharge.
    """

    places: tuple[Place, ...]
    shed: tuple[Place, ...]
    visit_forecast: VisitForecast
    preview: Preview
    ids: tuple[str, ...]
    works: tuple[Work, ...]
    allowance: RiskAllowance
    charged: ChargedVisits | None = None


def expected_visits(
    walker: ForecastHandler,
    node: ForEach | OptionalStep | WorkAlong,
    visits: Sequence[Visit],
    rng: np.random.Generator,
    before: ExpectedVisits | None = None,
) -> ExpectedVisits:
    """Forecast the optional visits from the handler's current place.

    Args:
        walker: Handler of a walk that has reached the node.
        node: An optional for-each, or an optional step.
        visits: Possible visits, whose places have stands; a single one for a step.
        rng: Random generator of the leg costs.
        before: Result for the same node on another walk; its order is the initial one of the search.
    """

    rest = _rest(walker, node, visits)
    visits, beyond = _candidates(walker, visits, rest)
    visits, too_far = _within_charge(walker, visits)
    without, share, allowance = _share(walker, rest)
    samples = walker.samples
    used = np.zeros(DRAWS) if samples is None else samples.metres - walker.spent.metres
    charged = _charged(walker, visits, rest)
    if len(visits) == 1:
        found = _one(walker, visits[0], rest, share, used, rng, charged)
    else:
        ahead = [] if before is None else [before.ids[v - 1] for v in before.preview.orders[0].tolist()]
        number = {v.place.id: k for k, v in enumerate(visits, start=1)}
        warm = [number[i] for i in ahead if i in number]
        found = _several(walker, node, visits, rest, without + share, used, rng, warm, charged)
    chances = np.zeros(len(visits))
    chances[found.vertices - 1] = found.visited.mean(axis=0)
    mean = float(found.visits.mean())
    # If missions differ, one of them is shown, completed with places of the others.
    usual = set(found.orders[0].tolist())
    likely = sorted(range(len(visits)), key=lambda k: (chances[k] > 0.0 and k + 1 not in usual, -chances[k]))
    chosen = set(likely[: round(mean)])
    return ExpectedVisits(
        places=tuple(visits[v - 1].place for v in found.vertices.tolist() if v - 1 in chosen),
        shed=(
            *(visits[k].place for k in sorted(likely[round(mean) :], key=lambda k: -chances[k])),
            *(v.place for v in (*beyond, *too_far)),
        ),
        visit_forecast=VisitForecast(
            visits=mean,
            chances={v.place.id: float(chance) for v, chance in zip(visits, chances, strict=True)}
            | {v.place.id: 0.0 for v in (*beyond, *too_far)},
        ),
        preview=found,
        ids=tuple(v.place.id for v in visits),
        works=tuple(v.work for v in visits),
        allowance=allowance,
        charged=charged,
    )


def _charged(walker: ForecastHandler, visits: Sequence[Visit], rest: RemainingWork) -> ChargedVisits | None:
    """Return the sampled missions at the visits, if they recharge."""
    missions, task, robot = walker.charged(), walker.task, walker.robot
    rules = None if missions is None else recharge_rules(task, walker.site, robot)
    if missions is None or rules is None:
        return None
    then = exit_of(task, "low_budget")
    return ChargedVisits(
        missions,
        rules,
        here=walker.context.here,
        visits=visits,
        rest=rest,
        limits=_limits(walker),
        budgets=resource_limits(task.constraints, robot)[:-1],
        length=partial(_length, walker),
        home=partial(walker.site.home, then),
        slower_s_per_m=walker.choosing_slower_s_per_m,
    )


def _limits(walker: ForecastHandler) -> tuple[ResourceLimit, ...]:
    return mission_limits(
        walker.task, walker.site, walker.robot, walker.drives, walker.charge_percent, pace_m_s=walker.choosing_pace_m_s
    )


def _candidates(
    walker: ForecastHandler, visits: Sequence[Visit], rest: RemainingWork
) -> tuple[Sequence[Visit], Sequence[Visit]]:
    """Return the visits to choose from, and those excluded because there are too many."""
    kept = cheapest(walker.context.here, visits, rest, walker.drives)
    if len(kept) == len(visits):
        return visits, ()
    chosen = set(kept)
    return [visits[k] for k in kept], [v for k, v in enumerate(visits) if k not in chosen]


def _within_charge(walker: ForecastHandler, visits: Sequence[Visit]) -> tuple[Sequence[Visit], Sequence[Visit]]:
    """Return the visits for which a charged battery suffices, and the others; all of them if it suffices for none."""
    rules = recharge_rules(walker.task, walker.site, walker.robot)
    if rules is None:
        return visits, ()
    within = [from_charger(rules, visit, partial(_length, walker)).is_within(rules) for visit in visits]
    if not any(within):
        return visits, ()
    near = [visit for visit, is_within in zip(visits, within, strict=True) if is_within]
    return near, [visit for visit, is_within in zip(visits, within, strict=True) if not is_within]


def _several(
    walker: ForecastHandler,
    node: ForEach | OptionalStep | WorkAlong,
    visits: Sequence[Visit],
    rest: RemainingWork,
    accepted: float,
    used: Floats,
    rng: np.random.Generator,
    warm: Sequence[int],
    charged: ChargedVisits | None,
) -> Preview:
    """Simulate missions that choose among several visits."""
    from fieldhand.orienteering.policy import State
    from fieldhand.orienteering.preview import preview

    robot = walker.robot
    resources = _limits(walker)

    def problem_from(here: Place) -> Problem:
        return visits_problem(
            legs=visit_distances(here, visits, rest, walker.drives),
            rewards=[v.reward for v in visits],
            service=[v.work for v in visits],
            rest=rest,
            resources=resources,
            robot=robot,
            spent=walker.spent,
            accepted=accepted,
            max_visits=node.at_most,
        )

    if charged is not None and len(visits) <= MAX_DOUBLE:
        with suppress(DriveFault):  # no way leads from the charger to some of them
            charged.policy = policy_for(problem_from(charged.charger), warm=warm)
    state = State(vertex=0, left=left_before(resources, robot, walker.spent, rest))
    return preview(policy_for(problem_from(walker.context.here), warm=warm), state, rng, used, charged)


def _one(
    walker: ForecastHandler,
    visit: Visit,
    rest: RemainingWork,
    share: float,
    used: Floats,
    rng: np.random.Generator,
    charged: ChargedVisits | None,
) -> Preview:
    """Simulate missions with a single optional visit, which is made if it adds no more than its share."""
    from fieldhand.orienteering.preview import Preview

    here, costs = walker.context.here, cost_model(walker.robot)
    there = _length(walker, here, visit.place)
    back, home = (0.0 if rest.first is None else _length(walker, at, rest.first) for at in (visit.end, here))
    resources = _limits(walker)
    with_it, without = (
        overrun_chances(way + rest.way, resources, walker.robot, walker.spent, used)
        for way in (route_cost([there, back], visit.work), route_cost([home]))
    )
    fits = (with_it - without <= share * (1 + 1e-9) + 1e-12) & (with_it < GONE)
    goes = np.asarray(fits.all(axis=0)) & (visit.reward > 0.0)
    legs_m = np.full(len(used), there)
    if charged is not None:
        some = np.flatnonzero(goes)
        departs = charged.set_out(some, 1, legs_m[some], rng)
        goes[some], legs_m[some] = departs.makes, departs.legs
    legs = np.where(goes, legs_m * costs.draw(rng, len(used)), 0.0)
    if charged is not None:
        charged.arrive(np.flatnonzero(goes), 1, legs[goes])
    return Preview(
        vertices=np.ones(1, dtype=np.int64),
        visited=goes[:, None],
        legs=legs,
        last=np.where(goes, back, home) * costs.draw(rng, len(used)),
        groups=np.zeros(len(used), dtype=np.int64),
        orders=(np.ones(1, dtype=np.int64),),
    )


def _rest(walker: ForecastHandler, node: ForEach | OptionalStep | WorkAlong, visits: Sequence[Visit]) -> RemainingWork:
    """Return the mandatory work that follows, from the end of a step or the beginning of a for-each."""
    here, to_come = walker.context, walker.to_come()
    if node.is_optional_step:
        here = replace(here, here=visits[0].end)
    return remaining_work_after(
        walker.task,
        walker.site,
        walker.robot,
        walker.drives,
        walker.plan.frames,
        here,
        to_come=to_come,
    )


def _share(walker: ForecastHandler, rest: RemainingWork) -> tuple[float, float, RiskAllowance]:
    """Return the overrun probability without the visits, their share, and the allowance left for later visits."""
    task, robot = walker.task, walker.robot
    resources = mission_limits(task, walker.site, robot, walker.drives, walker.charge_percent)
    allowance = walker.allowance
    if allowance is None:
        whole = whole_mission_work(task, walker.site, robot, walker.drives, walker.beginning)
        way = _way_on(walker, walker.beginning.here, whole)
        allowance = RiskAllowance.at_start(
            [r.failure_probability for r in resources], overrun_chances(way, resources, robot, Spent())
        )
    without = overrun_chances(_way_on(walker, walker.context.here, rest), resources, robot, walker.spent)
    share = allowance.share(optional_runs(walker.plan.frames))
    return float(without.max()), share, allowance.reduced_by(share)


def _way_on(walker: ForecastHandler, here: Place, rest: RemainingWork) -> RouteCost:
    return route_cost([0.0 if rest.first is None else _length(walker, here, rest.first)]) + rest.way


def _length(walker: ForecastHandler, a: Place, b: Place) -> float:
    return 0.0 if a.covers(b) else walker.drives.between(a, b).length_m
