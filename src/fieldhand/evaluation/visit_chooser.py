"""Choice of optional visits during a mission: which one is next, and which ones are given up for what reason."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import DriveFault
from fieldhand.evaluation.mission_budget import MissionBudget
from fieldhand.evaluation.reasons import RoundTrip, left_out, no_way, too_many
from fieldhand.forecast.candidates import cheapest
from fieldhand.forecast.mission_state import MissionState, Visit, VisitChoice
from fieldhand.forecast.orienteering_problem import GONE, left_before, policy_for, visits_problem
from fieldhand.forecast.remaining_work import RemainingWork, optional_runs
from fieldhand.forecast.route_cost import cost_model, route_cost
from fieldhand.forecast.visit_distances import MAX_DOUBLE, visit_distances
from fieldhand.language import joined
from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.site.model import Place

if TYPE_CHECKING:
    from fieldhand.orienteering.policy import Policy
    from fieldhand.orienteering.problem import Problem

Floats = NDArray[np.float64]
VisitKey = tuple[tuple[float, float], tuple[float, float] | None]


@dataclass(frozen=True, kw_only=True)
class _Begun:
    """State of a run that is kept when it is planned anew.

    Attributes:
        accepted: Overrun probability of the whole mission with which it was planned.
        collected: Reward of its visits so far, which a failure would lose.
    """

    accepted: float
    collected: float


@dataclass(kw_only=True)
class _Run:
    """A run: the optional visits of one node, from the first decision to the last.

    Attributes:
        problem: Orienteering problem: vertex 0 is the place where the run began, followed by the candidates and the
            place where the remaining work begins.
        vertex: Vertex of each candidate's place in the problem.
        start: Key of the place where the run began.
        rest: Mandatory work that follows the run.
        accepted: Overrun probability of the whole mission with which the run was planned.
        before: Reward of visits made before the run was planned anew.
        beyond: Places of candidates excluded from the choice because there are too many.
        new: True before the first decision of the run.
        done: Vertices already visited.
    """

    problem: Problem
    policy: Policy
    vertex: dict[VisitKey, int]
    start: VisitKey
    rest: RemainingWork
    accepted: float
    before: float
    beyond: frozenset[VisitKey]
    new: bool
    done: set[int] = field(default_factory=set)
    known: dict[int, tuple[Place, int | None]] = field(default_factory=dict)

    @property
    def begun(self) -> _Begun:
        """Return the state that is kept if the run is planned anew."""
        return _Begun(
            accepted=self.accepted, collected=self.before + float(self.problem.rewards[sorted(self.done)].sum())
        )

    def number(self, place: Place) -> int | None:
        """Return the vertex of a candidate's place, or None if it is not in the run. Called very often."""
        found = self.known.get(id(place))
        if found is None or found[0] is not place:
            found = self.known[id(place)] = (place, self.vertex.get(_key(place)))
        return found[1]

    def choosable(self, candidates: Sequence[Visit]) -> list[int]:
        """Return the indices of the candidates from which the run chooses."""
        if not self.beyond:
            return list(range(len(candidates)))
        return [
            i for i, v in enumerate(candidates) if self.number(v.place) is not None or _key(v.place) not in self.beyond
        ]

    def begins(self, candidates: Sequence[Visit]) -> bool:
        """Return True if these are the remaining candidates of the run."""
        numbers = [self.number(candidates[i].place) for i in self.choosable(candidates)]
        return bool(numbers) and None not in numbers and self.done.isdisjoint(numbers)

    def here(self, place: Place) -> int | None:
        """Return the vertex of the robot's place, or None if the run does not contain it."""
        vertex = self.vertex.get(_key(place))
        if vertex in self.done:
            return vertex
        return 0 if _key(place) == self.start else None


class VisitChooser:
    """Chooses optional visits, one run after another.

    Args:
        budget: Budget of the mission.
    """

    def __init__(self, budget: MissionBudget) -> None:
        self._budget = budget
        self._runs: dict[str, _Run] = {}
        self._begun: dict[str, _Begun] = {}

    def forget(self) -> None:
        """Plan current runs anew, with their initial overrun probability."""
        self._begun = {**self._begun, **{node: run.begun for node, run in self._runs.items()}}
        self._runs.clear()

    def withdraw(self, state: MissionState, visit: Visit) -> None:
        """Take the last choice back: the visit is not made now, but can be chosen again."""
        run = self._runs.get(state.node)
        if run is not None:
            run.done.discard(run.vertex.get(_key(visit.place), -1))

    def next(
        self, state: MissionState, candidates: Sequence[Visit], at_most: int | None, to_come: Sequence[Visit]
    ) -> VisitChoice:
        """Return the next visit, as :meth:`BudgetGuard.choose` describes."""
        if not candidates:
            return VisitChoice(index=None)
        run = self._runs.get(state.node)
        if run is not None and not run.begins(candidates):
            # If all were visited, continue with the excluded ones at the same probability.
            if not run.choosable(candidates):
                self._begun[state.node] = run.begun
            run = None
        rest = self._rest(state, run, candidates, to_come)
        cut_off = list[int]()
        if run is None or rest is not run.rest:
            open_, cut_off = self._reachable(state.context.here, candidates, rest.first)
            if not open_:
                return VisitChoice(
                    index=None,
                    shed=tuple(cut_off),
                    reason=no_way(candidates, cut_off),
                    chance_short=1.0,
                    cause="unreachable",
                    names_places=True,
                )
            within = cheapest(state.context.here, [candidates[i] for i in open_], rest, self._budget.drives)
            open_ = [open_[k] for k in within]
        else:
            open_ = run.choosable(candidates)
        beyond = sorted(set(range(len(candidates))).difference(open_, cut_off))
        visits = [candidates[i] for i in open_]
        run = self._run(state, visits, rest, run, at_most, frozenset(_key(candidates[i].place) for i in beyond))
        here, left = run.here(state.context.here) or 0, self._left(state, rest)
        known = [number for v in visits if (number := run.number(v.place)) is not None]
        chances = dict(zip(open_, self._chances(run, here, visits, known, left).tolist(), strict=True))
        near = [v for v, chance in zip(known, chances.values(), strict=True) if chance < GONE]
        if run.problem.end == 2:
            chosen = known[0] if near and self._fits(state, visits[0], rest, run) else run.problem.end
        else:
            chosen = self._ask(run, here, near, left, state) if near else run.problem.end
        if chosen == run.problem.end:
            index, gone, chance = None, open_, min(chances.values())
            del self._runs[state.node]
        else:
            run.done.add(chosen)
            index = open_[known.index(chosen)]
            chance = chances[index] if run.new else 1.0 - run.policy.expectation.success
            gone = [i for i in open_ if chances[i] >= GONE and i != index]
        reasons = [no_way(candidates, cut_off)] if cut_off else []
        if gone:
            safest = min(gone, key=lambda i: chances[i])
            reasons.append(self._skipped(state, candidates, gone, rest, candidates[safest]))
            chance = chances[safest]
        if index is None and beyond:
            gone = [*gone, *beyond]
            reasons.append(too_many(candidates, beyond, len(run.vertex)))
        return VisitChoice(
            index=index,
            shed=(*cut_off, *gone),
            reason=joined("; ", reasons),
            chance_short=chance,
            cause="unreachable" if cut_off and not gone else "budget",
            names_places=bool(reasons),
        )

    # --- a run -------------------------------------------------------------------------------------------------------

    def _run(
        self,
        state: MissionState,
        visits: Sequence[Visit],
        rest: RemainingWork,
        run: _Run | None,
        at_most: int | None,
        beyond: frozenset[VisitKey],
    ) -> _Run:
        """Return the current run, or a new one if a place is unknown or the following work has changed."""
        here = state.context.here
        if run is not None and run.rest is rest and run.here(here) is not None and not _fewer(run, visits, at_most):
            return run
        begun = self._begun.pop(state.node, None) if run is None else run.begun
        accepted = self._accepted(state, rest) if begun is None else begun.accepted
        collected = 0.0 if begun is None else begun.collected
        problem = visits_problem(
            legs=visit_distances(here, visits, rest, self._budget.drives, self._budget.distances.between),
            rewards=[v.reward for v in visits],
            service=[v.work for v in visits],
            rest=rest,
            resources=self._budget.resources(state),
            robot=self._budget.robot,
            spent=state.spent,
            accepted=accepted,
            max_visits=at_most,
        )
        vertex = {_key(visit.place): number for number, visit in enumerate(visits, start=1)}
        warm: list[int] = []
        price = None
        if run is not None:
            price, place_of = run.policy.price, {v: k for k, v in run.vertex.items()}
            ahead = [place_of.get(v) for v in run.policy.expectation.vertices[1:-1]]
            warm = [vertex[key] for key in ahead if key in vertex]
        made = _Run(
            problem=problem,
            policy=policy_for(problem, price=price, warm=warm, collected=collected),
            vertex=vertex,
            start=_key(here),
            rest=rest,
            accepted=accepted,
            before=collected,
            beyond=beyond,
            new=begun is None,
        )
        self._runs[state.node] = made
        return made

    def _accepted(self, state: MissionState, rest: RemainingWork) -> float:
        """Return the overrun probability for which a run is planned: that of the later work plus the run's share."""
        without = self._without(state, rest)
        return float(without.max()) + self._budget.allowance(without).share(optional_runs(state.frames))

    def _without(self, state: MissionState, rest: RemainingWork) -> Floats:
        """Return for each limit the overrun probability of the following work alone."""
        here = state.context.here
        there = 0.0 if rest.first is None else self._budget.length(here, rest.first)
        return self._budget.chances(route_cost([there]) + rest.way, state)

    def _ask(self, run: _Run, here: int, near: Sequence[int], left: tuple[float, ...], state: MissionState) -> int:
        from fieldhand.orienteering.policy import State

        given_up = set(range(1, run.problem.end)) - set(near) - run.done
        state_now = State(vertex=here, left=left, visited=frozenset(run.done), given_up=frozenset(given_up))
        chosen = run.policy.next(state_now)
        if run.new:
            run.new = False
            # A long order is driven as planned at first; its overrun probability is not known yet, so its whole share
            # is charged.
            without = float(self._without(state, run.rest).max())
            priced = run.policy.price is not None
            self._budget.add((1.0 - run.policy.expectation.success if priced else run.accepted) - without)
        return chosen

    def _fits(self, state: MissionState, visit: Visit, rest: RemainingWork, run: _Run) -> bool:
        """Return True if a single candidate adds no more than its share, so that no search is needed."""
        without = self._without(state, rest)
        added = self._budget.chances(self._trip(state, visit, rest).way, state) - without
        share = run.accepted - float(without.max())
        if visit.reward <= 0.0 or not (added <= share * (1 + 1e-9) + 1e-12).all():
            return False
        self._budget.add(float(added.max()))
        return True

    def _left(self, state: MissionState, rest: RemainingWork) -> tuple[float, ...]:
        return left_before(self._budget.resources(state), self._budget.robot, state.spent, rest)

    def _rest(
        self, state: MissionState, run: _Run | None, candidates: Sequence[Visit], to_come: Sequence[Visit]
    ) -> RemainingWork:
        """Return the following work; within a run it is computed again only if it depends on the position."""
        if run is not None and run.rest.fixed:
            return run.rest
        context = state.context
        if len(candidates) == 1 and candidates[0].leaves is not None:
            context = replace(context, here=candidates[0].leaves)
        rest = self._budget.rest(state.frames, context, to_come)
        return run.rest if run is not None and run.rest == rest else rest

    def _reachable(self, here: Place, candidates: Sequence[Visit], first: Place | None) -> tuple[list[int], list[int]]:
        """Return the indices of the candidates that can be reached and left again, and those of the others."""
        if len(candidates) > MAX_DOUBLE:
            # Reachability was checked when the visits were listed.
            return list(range(len(candidates))), []
        distances = self._budget.distances
        ends = [here, *([] if first is None else [first])]
        try:
            distances.between([*ends, *(v.place for v in candidates)])
        except DriveFault:
            fine = [all(distances.connected(end, v.place) for end in ends) for v in candidates]
        else:
            fine = [True] * len(candidates)
        return [i for i, ok in enumerate(fine) if ok], [i for i, ok in enumerate(fine) if not ok]

    # --- what is given up --------------------------------------------------------------------------------------------

    def _chances(
        self, run: _Run, here: int, visits: Sequence[Visit], known: Sequence[int], left: tuple[float, ...]
    ) -> Floats:
        """Return for each candidate the overrun probability of driving straight there and on to the later work."""
        problem, vertices = run.problem, np.array(known)
        there, back = run.policy.lengths(here)[vertices], run.policy.lengths(problem.end)[vertices]
        for k, visit in enumerate(visits):
            if visit.leaves is not None and run.rest.first is not None:
                back[k] = self._budget.length(visit.leaves, run.rest.first)
        after = np.array(problem.legs_after)
        first, squares, cubes = ((there**k + back**k + (after**k).sum()) for k in (1, 2, 3))
        second, third = cost_model(self._budget.robot).cumulants()
        worst = np.zeros(len(vertices))
        for limit, amount in zip(problem.limits, left, strict=True):
            work = 0.0 if limit.service is None else limit.service[vertices]
            worst = np.maximum(worst, overrun_probability(first, second * squares, third * cubes, amount - work))
        return worst

    def _skipped(
        self, state: MissionState, candidates: Sequence[Visit], gone: Sequence[int], rest: RemainingWork, safest: Visit
    ) -> str:
        """Return in words what is given up and why, with the figures of the candidate least likely to run short."""
        trip = self._trip(state, safest, rest)
        return left_out(candidates, gone, self._budget, state, trip, self._budget.chances(trip.way, state))

    def _trip(self, state: MissionState, visit: Visit, rest: RemainingWork) -> RoundTrip:
        """Return the route straight to a visit and on to the remaining work."""
        there = self._budget.length(state.context.here, visit.place)
        back = 0.0 if rest.first is None else self._budget.length(visit.end, rest.first)
        way = route_cost([there, back], visit.work) + rest.way
        return RoundTrip(way=way, to=visit.place, more=rest.mandatory)


def _fewer(run: _Run, visits: Sequence[Visit], at_most: int | None) -> bool:
    """Return True if ``at_most`` would count candidates as visited that were in fact given up."""
    return at_most is not None and len(visits) + len(run.done) < run.problem.end - 1


def _key(place: Place) -> VisitKey:
    return place.xy, place.stand
