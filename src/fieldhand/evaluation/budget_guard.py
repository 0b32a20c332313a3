"""The budget guard: check before every drive that the budget covers the drive, the work that follows and the way home.

Each limit (distance, time, energy, battery reserve) is checked separately; all of them depend on the same random leg
costs (:mod:`fieldhand.forecast.resource_limits`). The accepted failure probability applies to the whole mission, not to
each decision (:mod:`fieldhand.forecast.risk_allowance`). docs/evaluation.md describes the method.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.evaluation.battery_drain import BatteryDrain
from fieldhand.evaluation.mission_budget import MissionBudget
from fieldhand.evaluation.reasons import RoundTrip, running_short
from fieldhand.evaluation.recharge_decision import RechargeDecider, RechargeDecision
from fieldhand.evaluation.visit_chooser import VisitChooser
from fieldhand.evaluation.visit_risk import VisitRisk
from fieldhand.evaluation.work_ahead import WorkAhead, WorkAheadFinder
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice
from fieldhand.forecast.route_cost import RouteCost, cost_model, mean_metres, route_cost
from fieldhand.language import joined, message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]

#: Overrun probability above which accepted mandatory work is abandoned. Mandatory work that was within the accepted
#: probability when first checked continues until the chance of running short reaches 50 %.
_EVEN = 0.5
_LOOK = 1 + 1e-9


@dataclass(frozen=True, kw_only=True)
class _Grant:
    """A visit that was permitted together with all the work inside it.

    Attributes:
        node: Id of the for-each or the optional step.
        xy: Position of the visit, in local metres; None if the drives inside the node were permitted as well.
    """

    node: str
    xy: tuple[float, float] | None


class BudgetGuard:
    """A budget guard (:class:`fieldhand.execution.guard.Guard`) for one mission.

    Before each visit it computes, for each limit of the Task, the probability that the remaining route costs more than
    is left. Optional visits are chosen by stochastic orienteering (:mod:`fieldhand.orienteering`).

    Args:
        task, site, robot: Task, site and robot of the mission.
        drives: Drives between places of the site; each distance is queried once.
        seed: Seed of the missions that are simulated when the mandatory work exceeds the budget; the same seed and the
            same mission give the same decisions. The search for optional visits does not depend on it: it uses the
            forecast's seed.
        charge_percent: Battery charge at the start of the mission, 0 to 100.

    Raises:
        InputError: The Task has optional visits, and the solver that chooses them is not installed.
    """

    def __init__(
        self, task: Task, site: Site, robot: RobotProfile, drives: Drives, seed: int, charge_percent: float = 100.0
    ) -> None:
        if any(node.is_optional for node in walk(task.composition.plan)):
            # Here, so that no robot learns on its way that a package is missing.
            import fieldhand.orienteering.kernels.compiled  # noqa: F401
        self._rng = np.random.default_rng(seed)
        self._budget = MissionBudget(task, site, robot, drives, charge_percent)
        self._optional = VisitChooser(self._budget)
        self._ahead = WorkAheadFinder(self._budget)
        self._recharge = RechargeDecider(self._budget)
        self._threshold: Floats | None = None
        self._granted: tuple[_Grant, ...] = ()

    @property
    def drain(self) -> BatteryDrain:
        """Return the battery drain learned so far."""
        return self._budget.drain

    def choose(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        *,
        at_most: int | None = None,
        still_to_come: Sequence[Visit] = (),
    ) -> VisitChoice:
        """Choose the next of at most ``at_most`` optional visits; called again after every leg.

        The budget for mandatory work and the way home is reserved first. Candidates without a way to them, or no longer
        within the budget, are given up at once; all others are given up together when no visit is worth its risk.
        """
        self._budget.drain.learn(state.spent)
        possible = [k for k, visit in enumerate(candidates) if self._recharge.is_possible(visit)]
        choice = self._optional.next(state, [candidates[k] for k in possible], at_most, still_to_come)
        if len(possible) < len(candidates):
            beyond = set(range(len(candidates))).difference(possible)
            index = None if choice.index is None else possible[choice.index]
            choice = replace(choice, index=index, shed=(*(possible[k] for k in choice.shed), *sorted(beyond)))
        if choice.index is not None:
            decided = self._recharge.decide(state, candidates[choice.index], None)
            if decided.decision == "charge":
                self._optional.withdraw(state, candidates[choice.index])
                return self._charge_or_skip(state, candidates, choice.index, decided, at_most, still_to_come)
            self._grant(state, candidates[choice.index])
        return replace(choice, reason=self._and_the_battery(choice.reason))

    def _charge_or_skip(
        self,
        state: MissionState,
        candidates: Sequence[Visit],
        chosen: int,
        decided: RechargeDecision,
        at_most: int | None,
        still_to_come: Sequence[Visit],
    ) -> VisitChoice:
        """Charge before the chosen visit or, where the budgets do not allow it, leave out what needs charging."""
        if self._recharge.fits_in_time(state, candidates[chosen]):
            return VisitChoice(index=None, reason=self._and_the_battery(decided.why), charge_to=decided.charge_to)
        near = [k for k, visit in enumerate(candidates) if self._recharge.is_within_charge(state, visit)]
        why = message("there is no time to charge for more: {why}", context="log", why=decided.why)
        if not near:
            return VisitChoice(index=None, reason=self._and_the_battery(why))
        found = self._optional.next(state, [candidates[k] for k in near], at_most, still_to_come)
        far = sorted(set(range(len(candidates))).difference(near))
        index = None if found.index is None else near[found.index]
        if index is not None:
            self._grant(state, candidates[index])
        shed = (*(near[k] for k in found.shed), *far)
        return replace(found, index=index, shed=shed, reason=joined("; ", [r for r in (found.reason, why) if r]))

    def update_drives(self, drives: Drives) -> None:
        """Use new drives after a way was blocked or cleared; discard everything computed for the old ones."""
        self._budget.set_drives(drives)
        self._optional.forget()
        self._ahead.forget()
        self._threshold, self._granted = None, ()

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        """Decide whether the robot may make a mandatory visit.

        If all mandatory work was within the accepted probability when it was first checked, it continues until the
        chance of running short reaches 50 %. Beyond that, or if the mandatory work exceeded the budget from the start,
        a visit is made only if driving there and straight home is safe enough, or no riskier than driving home at once.
        """
        self._budget.drain.learn(state.spent)
        if self._is_granted(state, visit.place):
            low = self._recharge.decide(state, visit, None, permitted=True)
            if low.decision == "charge" and (ahead := self._ahead.of(state, visit, still_to_come)) is not None:
                # The end may be nearer than the charger.
                low = self._recharge.decide(state, visit, ahead.way, permitted=True)
            if low.decision == "charge":
                return Verdict(go=False, reason=self._and_the_battery(low.why), charge_to=low.charge_to)
            return Verdict(go=True)
        ahead = self._ahead.of(state, visit, still_to_come)
        after = None if ahead is None else ahead.way
        decided = self._recharge.decide(state, visit, after)
        if decided.decision == "charge":
            return Verdict(go=False, reason=self._and_the_battery(decided.why), charge_to=decided.charge_to)
        if decided.decision == "never":
            return Verdict(go=False, reason=self._and_the_battery(decided.why), chance_short=1.0)
        budget, here = self._budget, state.context.here
        leg = budget.length(here, visit.place)
        way_on = None if ahead is None else route_cost([leg], budget.slower(visit, leg, here)) + ahead.way
        home = budget.length(visit.end, budget.home(visit.end))
        short = route_cost([leg, home], visit.work + budget.slower(visit, leg, here))
        there = budget.chances(short, state)
        on = there if way_on is None else budget.chances(way_on, state)
        lasts = budget.allowance(on).mandatory_fits
        if way_on is not None and lasts and (on <= np.maximum(_EVEN, budget.accepted)).all():
            return self._go(state, visit, on)
        safe = budget.accepted if lasts or ahead is None else self._safe(state, ahead)
        home_now = route_cost([budget.length(here, budget.home(here))])
        # A visit and the way home may be riskier than what is accepted for the whole mission; all that is left may not.
        for way, chances, most in ((way_on, on, np.minimum(safe, budget.accepted)), (short, there, safe)):
            if way is not None and self._may(state, way, chances, most, home_now):
                return self._go(state, visit, chances)
        reason = running_short(budget, state, RoundTrip(way=short, to=visit.place), there)
        return Verdict(go=False, reason=self._and_the_battery(reason), chance_short=float(there.max()))

    def _and_the_battery(self, reason: str) -> str:
        battery = self._budget.drain.words
        return joined("; ", (reason, battery)) if reason and battery else reason

    def _may(self, state: MissionState, way: RouteCost, chances: Floats, safe: Floats, home_now: RouteCost) -> bool:
        """Return True if a route is safe enough or no riskier than going home now."""
        budget, resources = self._budget, self._budget.resources(state)
        left = np.array([r.metres_left(state.spent) for r in resources])
        enough = np.maximum(left, mean_metres(home_now, resources, budget.robot))
        allowed = np.maximum(safe, budget.chances(home_now, state))
        fits = mean_metres(way, resources, budget.robot) <= enough * _LOOK
        return bool((fits & (chances <= allowed * _LOOK + 1e-12)).all())

    def _go(self, state: MissionState, visit: Visit, chances: Floats) -> Verdict:
        self._grant(state, visit)
        return Verdict(go=True, chance_short=float(chances.max()))

    def _safe(self, state: MissionState, ahead: WorkAhead) -> Floats:
        """Return for each limit the accepted overrun probability of one visit if not all mandatory work fits."""
        if self._threshold is None:
            budget, resources = self._budget, self._budget.resources(state)
            threshold = VisitRisk(
                here=state.context.here,
                stops=ahead.stops,
                length=budget.length,
                home=budget.home,
                service=np.array([[r.metres_of(v.work, budget.robot) for r in resources] for v in ahead.stops]),
                left=np.array([r.metres_left(state.spent) for r in resources]),
                costs=cost_model(budget.robot),
            )
            self._threshold = threshold.accepted_chance(budget.accepted, self._rng)
        return self._threshold

    def _grant(self, state: MissionState, visit: Visit) -> None:
        """Record a visit that was permitted with all its work, so that its parts need no further permission."""
        node = state.frames[-1].node
        if node.visits_each or node.is_optional:
            inside = node.is_optional_step or visit.leaves is not None
            around = tuple(g for g in self._granted if g.node in _outer(state))
            self._granted = (*around, _Grant(node=node.id, xy=None if inside else visit.place.xy))

    def _is_granted(self, state: MissionState, place: Place) -> bool:
        """Return True if a place is part of a visit already granted. Work at another place ends the grant."""
        here = state.context.here
        outer = _outer(state)
        self._granted = tuple(
            g for g in self._granted if g.node in outer and (g.xy is None or (here.xy == g.xy and here.covers(place)))
        )  # fmt: skip
        return bool(self._granted)


def _outer(state: MissionState) -> frozenset[str]:
    """Return the ids of the nodes that enclose the current one."""
    return frozenset(frame.node.id for frame in state.frames[:-1])
