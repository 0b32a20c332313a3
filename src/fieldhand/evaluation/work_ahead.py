"""The work that follows a mandatory visit: visits of the loops around it, the rest of the plan, the way home."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from fieldhand.errors import DriveFault
from fieldhand.evaluation.mission_budget import MissionBudget
from fieldhand.forecast.mission_state import MissionState, Visit
from fieldhand.forecast.remaining_work import RemainingWork, arrived
from fieldhand.forecast.route_cost import RouteCost, route_cost


@dataclass(frozen=True, kw_only=True)
class WorkAhead:
    """The work from the arrival at a visit to the end of the mission.

    Attributes:
        way: Cost of the visit's own work, all work that follows, and the way home.
        stops: The visit and all visits known to follow it.
    """

    way: RouteCost
    stops: tuple[Visit, ...]


@dataclass(frozen=True, kw_only=True)
class _Loop:
    """The visits of a loop in order, and for each of them the work ahead on arrival."""

    node: str
    stops: tuple[Visit, ...]
    ways: tuple[RouteCost, ...]

    def position(self, node: str, visit: Visit, later: Sequence[Visit]) -> int | None:
        """Return the index of a visit among the stops, or None if the visits after it differ."""
        k = len(self.stops) - 1 - len(later)
        if node != self.node or k < 0 or self.stops[k] is not visit:
            return None
        same = not later or (self.stops[k + 1] is later[0] and self.stops[-1] is later[-1])
        return k if same else None


class WorkAheadFinder:
    """Computes the work that follows a visit; the result for a loop is cached for its later visits.

    Args:
        budget: Budget of the mission.
    """

    def __init__(self, budget: MissionBudget) -> None:
        self._budget = budget
        self._loop: _Loop | None = None

    def forget(self) -> None:
        """Discard the cached work."""
        self._loop = None

    def of(self, state: MissionState, visit: Visit, later: Sequence[Visit]) -> WorkAhead | None:
        """Return the work that follows on the most demanding branch; None if no way leads there.

        Args:
            state: State of the mission.
            visit: The visit in question.
            later: Later visits of the enclosing loops.
        """
        loop = self._loop
        k = None if loop is None else loop.position(state.node, visit, later)
        if loop is None or k is None:
            try:
                loop, k = self._looked(state, (visit, *later)), 0
            except DriveFault:
                # A later visit without a way is reported in its turn; until then the reachable ones are made.
                return None
        return WorkAhead(way=loop.ways[k], stops=loop.stops[k:])

    def _looked(self, state: MissionState, stops: tuple[Visit, ...]) -> _Loop:
        budget = self._budget
        rest = budget.rest(state.frames, arrived(state.context, stops))
        last = stops[-1].end
        way = route_cost([0.0 if rest.first is None else budget.length(last, rest.first)], stops[-1].work) + rest.way
        ways = [way]
        for stop, following in reversed(list(itertools.pairwise(stops))):
            metres = budget.length(stop.end, following.place)
            way = route_cost([metres], stop.work + budget.slower(following, metres, stop.end)) + way
            ways.append(way)
        known = _Loop(node=state.node, stops=(*stops, *_visits(rest)), ways=tuple(reversed(ways)))
        if rest.fixed:
            self._loop = _Loop(node=state.node, stops=stops, ways=known.ways)
        return known


def _visits(rest: RemainingWork) -> tuple[Visit, ...]:
    """Return the stops of the remaining work except the last, which is home."""
    return tuple(Visit(place=place) for place in rest.stops[:-1])
