"""The budget guard: before every drive it asks whether what is left lasts for it, for what must follow, and for home.

Each limit (distance, time, energy, the battery's reserve) is checked by itself; all share the legs' one random cost
(:mod:`fieldhand.forecast.limits`). The accepted chance holds for the whole mission, not for each decision anew: a level
for each limit is carried from decision to decision (:mod:`fieldhand.orienteering.policy`).

What that comes to. Mandatory work whose chance is within the accepted one when it is first asked for is carried out,
also after unlucky legs, as long as what is left lasts on average. Over all such missions a limit is exceeded no more
often than was forecast, since turning home early is no riskier than going on. Mandatory work that begins with less
hope, or after optional visits, is allowed the accepted chance at each visit even where less of it was carried over: so
it is promised for each visit, not for the mission as a whole. Nor is it where more is asked for than was set aside:
faults, places not known before, rounds of a repeat.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import DriveFault
from fieldhand.evaluation.reasons import named, running_short
from fieldhand.forecast.distances import Distances
from fieldhand.forecast.limits import Resource, resources_of
from fieldhand.forecast.optional import decide_at_most, only, visits_problem
from fieldhand.forecast.rest import Rest, rest_after
from fieldhand.forecast.routes import way_to
from fieldhand.forecast.state import Choice, MissionState, Spent, Verdict, Visit
from fieldhand.forecast.walk import exit_of
from fieldhand.orienteering.policy import RESOLVE, SOLVE, Decision, decide
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.search import Figures
from fieldhand.orienteering.split import Option, Split, split
from fieldhand.orienteering.tail import chance_over
from fieldhand.robot.model import RobotProfile
from fieldhand.site.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.task.frames import Task, Then
from fieldhand.task.plan import ForEach

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]

_LOOK = 1 + 1e-9


@dataclass(frozen=True, kw_only=True)
class _Way:
    """Legs in metres and the work along them."""

    legs_m: tuple[float, ...]
    seconds: float = 0.0
    joules: float = 0.0


@dataclass(frozen=True, kw_only=True)
class _Grant:
    """A visit of a loop that was allowed with all its work: the for-each's node id, and where."""

    loop: str
    xy: tuple[float, float]


class BudgetGuard:
    """Implements :class:`fieldhand.execution.guard.Guard`. One guard watches one mission.

    Args:
        task, site, robot: The mission.
        drives: The ways of the site; the guard asks for each distance once.
        seed: Of the search for routes; the same seed and the same mission give the same decisions.
        charge_percent: Charge at the beginning.
    """

    def __init__(
        self, task: Task, site: Site, robot: RobotProfile, drives: Drives, seed: int, charge_percent: float = 100.0
    ) -> None:
        self._task, self._site, self._robot, self._drives = task, site, robot, drives
        self._alpha = robot.leg_cost.alpha
        self._rng = np.random.default_rng(seed)
        self._accepted = np.array(
            [r.failure_probability for r in resources_of(task.constraints, robot, charge_percent)]
        )
        self._split: Split | None = None
        self._granted: _Grant | None = None
        self._distances = Distances(drives)
        self._planned: dict[str, tuple[Place, ...]] = {}

    # --- what must be done -------------------------------------------------------------------------------------------

    def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
        """May the robot make this mandatory visit?

        Yes where going there, on to all that must follow, and home is safe enough, or else there and straight home.
        Safe enough is the accepted chance, or what the decisions before left where that is more. Where even straight
        home is not safe enough any more, only what is no riskier than that.
        """
        if self._is_granted(state, visit.place):
            return Verdict(go=True)
        resources = self._resources(state)
        here, then = state.context.here, exit_of(self._task, "low_budget")
        home_now = _Way(legs_m=(self._length(here, self._home(then, here)),))
        straight = self._figures(home_now, resources, state.spent)
        levels = self._levels(resources, state.spent)
        allowed = np.maximum(np.maximum(levels, self._accepted), self._chances(straight))
        short = self._there_and_home(here, visit, self._home(then, visit.place))
        on = self._there_and_on(state, visit, still_to_come) or short
        for way in (on, short):
            chances = self._chances(self._figures(way, resources, state.spent))
            if self._fits(way, chances, allowed, straight, resources, state.spent):
                break
        else:
            return self._refusal(resources, state.spent, visit.place, short)
        # Going on stays an option of the next decision also where only the short way is safe enough now.
        self._split = split(
            np.maximum(levels, chances),
            way.legs_m[0],
            self._alpha,
            self._left(resources, state.spent, visit),
            [self._option(short, visit, resources, 0.0), self._option(on, visit, resources, 1.0 + len(still_to_come))],
        )
        self._grant(state.node, visit.place)
        return Verdict(go=True, chance_short=float(chances.max()))

    def _grant(self, node: str, place: Place) -> None:
        """Remember where a loop's visit was allowed with all its work: that is not asked for again, piece by piece."""
        way = way_to(self._task.composition.plan, node)
        self._granted = _Grant(loop=node, xy=place.xy) if way and isinstance(way[-1], ForEach) else None

    def _is_granted(self, state: MissionState, place: Place) -> bool:
        """Whether work was allowed with the visit it is part of. Work elsewhere or after the loop ends that."""
        granted = self._granted
        if granted is None:
            return False
        outer = way_to(self._task.composition.plan, state.node)[:-1]
        if state.context.here.xy == place.xy == granted.xy and any(n.id == granted.loop for n in outer):
            return True
        self._granted = None
        return False

    def _home(self, then: Then, at: Place) -> Place:
        """Where the robot goes when little is left; it stays where there is no way to that (approval warned of it)."""
        home = self._site.home(then, at)
        return home if self._distances.linked(at, home) else at

    def _there_and_home(self, here: Place, visit: Visit, home: Place) -> _Way:
        legs = (self._length(here, visit.place), self._length(visit.place, home))
        return _Way(legs_m=legs, seconds=visit.service_s, joules=visit.service_j)

    def _there_and_on(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit]) -> _Way | None:
        """To the visit, all that must follow on the branch that takes most, and home; None where there is no way."""
        stops = [visit, *still_to_come]
        there = state.context
        for stop in stops:
            there = _arrived(there, stop.place)
        try:
            rest = rest_after(self._task, self._site, self._robot, self._drives, state.node, there, loops=False)
            places = [state.context.here, *(v.place for v in stops), *([] if rest.first is None else [rest.first])]
            legs = [self._length(a, b) for a, b in itertools.pairwise(places)]
        except DriveFault:
            # Said when it is its turn; until then what can be done is.
            return None
        return _Way(
            legs_m=(*legs, *rest.legs_m),
            seconds=sum(v.service_s for v in stops) + rest.seconds,
            joules=sum(v.service_j for v in stops) + rest.joules,
        )

    def _fits(
        self, way: _Way, chances: Floats, allowed: Floats, home: Figures, resources: Sequence[Resource], spent: Spent
    ) -> bool:
        """Safe enough, and no more to drive than is left; where even home is too far, no detour."""
        figures = self._figures(way, resources, spent)
        enough = figures.length <= np.maximum(figures.left, home.length) * _LOOK
        return bool(enough.all() and (chances <= allowed * _LOOK + 1e-12).all())

    def _refusal(self, resources: Sequence[Resource], spent: Spent, place: Place, way: _Way) -> Verdict:
        chances = self._chances(self._figures(way, resources, spent))
        return Verdict(
            go=False,
            reason=self._reason(resources, spent, place, way, chances),
            chance_short=float(chances.max()),
        )

    # --- what may be left out ----------------------------------------------------------------------------------------

    def choose(self, state: MissionState, candidates: Sequence[Visit], *, at_most: int | None = None) -> Choice:
        """Which optional visit comes next, of ``at_most`` that may still be made. Asked again after every leg.

        What must follow and the way home are set aside first; then the best route over the candidates is planned anew,
        beginning with what was planned before. Candidates that have no way to them are given up at once; all others, in
        one go, when none fits any more.
        """
        if not candidates:
            return Choice(index=None)
        rest = rest_after(self._task, self._site, self._robot, self._drives, state.node, state.context)
        open_, cut_off = self._reachable(state.context.here, candidates, rest.first)
        if not open_:
            return Choice(index=None, shed=tuple(cut_off), reason=f"there is no way to {named(candidates, cut_off)}")
        visits = [candidates[i] for i in open_]
        resources = self._resources(state)
        problem = self._problem(state, visits, rest, resources)
        decision = self._decide(state.node, problem, visits, self._levels(resources, state.spent), at_most)
        chance = max(decision.route.chances)
        if decision.vertex != problem.end:
            self._split = decision.split
            self._grant(state.node, visits[decision.vertex - 1].place)
            reason = f"there is no way to {named(candidates, cut_off)}" if cut_off else ""
            index = open_[decision.vertex - 1]
            return Choice(index=index, shed=tuple(cut_off), reason=reason, chance_short=chance)
        return self._enough(state, problem, visits, rest, resources, len(candidates))

    def _problem(
        self, state: MissionState, visits: Sequence[Visit], rest: Rest, resources: Sequence[Resource]
    ) -> Problem:
        places = [state.context.here, *(v.place for v in visits), *([] if rest.first is None else [rest.first])]
        return visits_problem(
            distances=self._distances.between(places),
            rewards=[v.reward for v in visits],
            service=[(v.service_s, v.service_j) for v in visits],
            rest=rest,
            resources=resources,
            robot=self._robot,
            spent=state.spent,
        )

    def _decide(
        self, node: str, problem: Problem, visits: Sequence[Visit], levels: Floats, at_most: int | None
    ) -> Decision:
        """Plan anew, beginning with the rest of what was planned before for this node.

        Where only so many visits may be made and those planned still fit, it stays with them.
        """
        position = {v.place.xy: i + 1 for i, v in enumerate(visits)}
        planned = self._planned.get(node)
        warm = [position[p.xy] for p in planned or () if p.xy in position]
        way = (problem.start, *warm, problem.end)
        asked = tuple(float(x) for x in levels)
        decision = None
        if warm and len(warm) == at_most:
            decision = decide(only(problem, warm), asked, self._rng, way, RESOLVE)
        if decision is None or len(decision.route.vertices) != len(way):
            effort = SOLVE if planned is None else RESOLVE
            decision = decide_at_most(problem, asked, self._rng, way, effort=effort, at_most=at_most)
        self._planned[node] = tuple(visits[v - 1].place for v in decision.route.vertices[1:-1])
        return decision

    def _reachable(self, here: Place, candidates: Sequence[Visit], first: Place | None) -> tuple[list[int], list[int]]:
        """Positions of the candidates that can be reached and left again, and of the others."""
        ends = [here, *([] if first is None else [first])]
        try:
            self._distances.between([*ends, *(v.place for v in candidates)])
        except DriveFault:
            fine = [all(self._distances.linked(end, v.place) for end in ends) for v in candidates]
        else:
            fine = [True] * len(candidates)
        return [i for i, ok in enumerate(fine) if ok], [i for i, ok in enumerate(fine) if not ok]

    def _enough(
        self,
        state: MissionState,
        problem: Problem,
        visits: Sequence[Visit],
        rest: Rest,
        resources: Sequence[Resource],
        candidates: int,
    ) -> Choice:
        """No candidate comes next: why, told of the one that is nearest to being possible."""
        d = problem.distances
        there, back = d[problem.start, 1 : len(visits) + 1], d[1 : len(visits) + 1, problem.end]
        nearest = int((there + back).argmin())
        visit = visits[nearest]
        way = _Way(
            legs_m=(float(there[nearest]), float(back[nearest]), *rest.legs_m),
            seconds=visit.service_s + rest.seconds,
            joules=visit.service_j + rest.joules,
        )
        chances = self._chances(self._figures(way, resources, state.spent))
        why = self._reason(resources, state.spent, visit.place, way, chances, rest.mandatory)
        allowed = self._levels(resources, state.spent)
        binding = int((chances - allowed).argmax())
        if chances[binding] > allowed[binding]:
            why += f", {100 * allowed[binding]:.0f} % is left to risk on optional visits"
        return Choice(
            index=None,
            shed=tuple(range(candidates)),
            reason=f"{why}; skipped {named(visits, range(len(visits)))}",
            chance_short=float(chances.max()),
        )

    # --- figures -----------------------------------------------------------------------------------------------------

    def _resources(self, state: MissionState) -> tuple[Resource, ...]:
        """The limits as they are now: the battery is asked what is left in it, not what should be."""
        charge = state.charge_percent + state.spent.percent
        return resources_of(self._task.constraints, self._robot, charge)

    def _figures(self, way: _Way, resources: Sequence[Resource], spent: Spent) -> Figures:
        legs = np.asarray(way.legs_m, dtype=np.float64)
        work = [r.of_work(self._robot, way.seconds, way.joules) / r.per_metre for r in resources]
        left = np.array([r.metres_left(spent) for r in resources]) - np.array(work)
        return Figures(length=np.asarray(legs.sum()), squares=np.asarray((legs**2).sum()), left=left)

    def _levels(self, resources: Sequence[Resource], spent: Spent) -> Floats:
        """The chance that this decision may take, for each limit."""
        if self._split is None:
            return self._accepted
        return self._split.levels([r.metres_left(spent) for r in resources])

    def _left(self, resources: Sequence[Resource], spent: Spent, visit: Visit) -> list[float]:
        """Metres left of each limit once the work of a visit is done, the drive to it not counted."""
        work = (visit.service_s, visit.service_j)
        return [r.metres_left(spent) - r.of_work(self._robot, *work) / r.per_metre for r in resources]

    def _option(self, way: _Way, visit: Visit, resources: Sequence[Resource], reward: float) -> Option:
        """What a way looks like once its first leg is driven and the work of the visit there is done."""
        legs = np.asarray(way.legs_m[1:], dtype=np.float64)
        later = (way.seconds - visit.service_s, way.joules - visit.service_j)
        return Option(
            length=float(legs.sum()),
            squares=float((legs**2).sum()),
            service=tuple(r.of_work(self._robot, *later) / r.per_metre for r in resources),
            reward=reward,
        )

    def _chances(self, figures: Figures) -> Floats:
        return chance_over(figures.length, figures.squares, figures.left, self._alpha)

    def _length(self, a: Place, b: Place) -> float:
        return 0.0 if a.xy == b.xy else self._drives.between(a, b).length_m

    def _reason(
        self, resources: Sequence[Resource], spent: Spent, place: Place, way: _Way, chances: Floats, more: bool = False
    ) -> str:
        """The limit that binds, in words."""
        binding = int((chances - self._accepted).argmax())
        resource = resources[binding]
        takes = sum(way.legs_m) * resource.per_metre + resource.of_work(self._robot, way.seconds, way.joules)
        return running_short(resource, spent, place, takes, float(chances[binding]), more=more)


def _arrived(context: Context, place: Place) -> Context:
    fresh = place.kind == "tree" and place.id not in context.visited
    visited = (*context.visited, place.id) if fresh else context.visited
    return Context(here=place, visited=visited, bound=context.bound)
