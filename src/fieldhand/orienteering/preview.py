"""Simulate many missions of a policy at once, replanned in groups with similar amounts left.

On board the order is replanned after every leg. Here missions with similar amounts left share a plan. They drive a few
stops of a long order and then replan with the amounts left; of a short order each mission skips the stops that it
cannot afford according to the dynamic programme.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.decision import LONG, SearchEffort
from fieldhand.orienteering.policy import Policy, State

if TYPE_CHECKING:
    from fieldhand.orienteering.decision import DecisionSearch, VisitOrder

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Number of stops that a group drives before it replans; if no more than the second number would remain, it drives all.
_STRIDE, _FEW = 8, 4
#: Search effort per plan of a group: as much as the robot spends at all stops of a stride.
_DEPTH = SearchEffort(rounds=20 * _STRIDE, insertions=8, remakes=8)
#: A group is split if the standard deviation of its amounts left exceeds the first value as a fraction of their mean,
#: unless it would fall below the second value as a fraction of all missions.
_SPREAD, _SMALLEST = 0.05, 1 / 8
#: Missions that another limit binds, or that differ in their visits when they are replanned at the place of their
#: detour, are a group of their own if they are at least this fraction of all missions.
_ALIKE = 1 / 32
#: Number that stands for the place of a detour where others are numbers of vertices.
_DETOUR = -1


@dataclass(frozen=True, kw_only=True, eq=False)
class Departures:
    """Decisions of missions about a visit.

    Attributes:
        makes: True for those that make it now.
        waits: True for those that went on a detour first, and are at its place.
        legs: Lengths of the last leg to the visit.
    """

    makes: NDArray[np.bool_]
    waits: NDArray[np.bool_]
    legs: Floats


class Detours(Protocol):
    """A place to which missions drive between visits when they must, such as a charger, and what that costs.

    Attributes:
        policy: Policy of the missions at that place, which is its vertex 0; None if they drive on to the next visit.
    """

    policy: Policy | None

    def left(self, some: Ints) -> Floats:
        """Return what is left of each limit for some missions, shape (missions, limits)."""

    def length(self, stop: int) -> float:
        """Return the length of the leg from the place to a stop."""

    def set_out(self, some: Ints, stop: int, legs: Floats, rng: np.random.Generator) -> Departures:
        """Decide on the visit to a stop; ``legs`` are the lengths from where each mission is."""

    def arrive(self, some: Ints, stop: int, costs: Floats) -> None:
        """Visit a stop at these costs of the last leg."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Preview:
    """Simulated missions, one per row.

    Attributes:
        vertices: Vertices visited by any mission, shape (k,): those of the median group in visiting order, then the
            others.
        visited: True where a mission visits a vertex, shape (missions, k).
        legs: Total cost of the legs to the visited vertices, shape (missions,).
        last: Cost of the leg from the last visited vertex to the end, shape (missions,).
        groups: Index into ``orders`` per mission, shape (missions,).
        orders: Stops of each group in visiting order.
    """

    vertices: Ints
    visited: NDArray[np.bool_]
    legs: Floats
    last: Floats
    groups: Ints
    orders: tuple[Ints, ...]

    @property
    def visits(self) -> Floats:
        """Return the number of visits per mission, shape (missions,)."""
        return np.asarray(self.visited.sum(axis=1), dtype=np.float64)

    def stops(self, mission: int) -> tuple[int, ...]:
        """Return the vertices that a mission visits, in visiting order."""
        made = set(self.vertices[self.visited[mission]].tolist())
        return tuple(v for v in self.orders[self.groups[mission]].tolist() if v in made)


def preview(
    policy: Policy, state: State, rng: np.random.Generator, used: Floats, detours: Detours | None = None
) -> Preview:
    """Simulate the missions of a policy from a given state.

    Args:
        policy: The policy, before its first decision from that state.
        state: Common initial state of the missions.
        rng: Random generator of the leg costs.
        used: Amount that each mission has used in excess of that state, shape (missions,); negative if it has used
            less.
        detours: What missions do besides; it then determines the amounts left.
    """
    missions = _SampledMissions(policy, state, used, detours)
    fewest, alike = (max(1, int(len(used) * part)) for part in (_SMALLEST, _ALIKE))
    waiting = [_Group(policy=policy, vertex=state.vertex, stops=(), members=np.arange(len(used)))]
    while waiting or missions.wait:
        if not waiting:
            waiting += missions.together(alike, rng)
        group = waiting.pop()
        if not len(group.members):
            continue
        left = missions.left[group.members]
        amounts = np.median(left, axis=0)
        binding = left.min(axis=1)
        usual = left.argmin(axis=1) == amounts.argmin()
        if group.warm and alike <= int(usual.sum()) <= len(usual) - alike:
            waiting += group.parts((np.flatnonzero(usual), np.flatnonzero(~usual)), rng)
            continue
        wide = float(binding.std()) > _SPREAD * float(amounts.min()) > 0.0
        if wide and group.warm and len(group.members) >= 2 * fewest:
            waiting += group.divided(binding, rng)
            continue
        collected, others = missions.collected(group)
        now = State(
            vertex=group.vertex,
            left=tuple(amounts.tolist()),
            visited=state.visited | collected,
            given_up=state.given_up | others,
        )
        group.policy.next(now)
        ahead = np.array(group.policy.expectation.vertices[1:-1], dtype=np.int64)
        if group.policy.plan is not None:
            waiting += missions.skip(group, *group.policy.plan, fewest, rng)
        elif len(ahead) and missions.is_uncertain:
            some = max(1, min(_STRIDE, len(ahead) - LONG))
            missions.visit(group, ahead[:some], rng)
            group.warm = tuple(ahead[some:].tolist())
            waiting.append(group)
        else:
            missions.visit(group, ahead, rng)
            missions.end(group.members, group.stops)
    return missions.made(rng)


@dataclass(kw_only=True)
class _Group:
    """Missions with the same visits so far and similar amounts left.

    Attributes:
        policy: Policy that plans for all missions of the group.
        vertex: Their current vertex.
        stops: Stops visited so far.
        members: Indices of the missions.
        warm: Stops of the current plan; empty before the first plan.
        mixed: True if its missions come from several groups, and differ in their visits.
    """

    policy: Policy
    vertex: int
    stops: tuple[int, ...]
    members: Ints
    warm: tuple[int, ...] = ()
    mixed: bool = False

    def divided(self, left: Floats, rng: np.random.Generator) -> list[_Group]:
        """Split the group into missions with less and with more left, each to be planned separately."""
        order, half = np.argsort(left, kind="stable"), len(left) // 2
        return self.parts((order[:half], order[half:]), rng)

    def parts(self, parts: Sequence[Ints], rng: np.random.Generator) -> list[_Group]:
        """Split the group into parts, given by the indices of their members, each to be planned separately."""
        return [
            _Group(
                policy=self.policy.again(int(rng.integers(2**31)), self.policy.price, self.warm, _DEPTH),
                vertex=self.vertex,
                stops=self.stops,
                members=np.sort(self.members[part]),
                warm=self.warm,
                mixed=self.mixed,
            )
            for part in parts
        ]


class _SampledMissions:
    """Missions under way."""

    def __init__(self, policy: Policy, state: State, used: Floats, detours: Detours | None) -> None:
        self._prepared, self._detours, count = policy.prepared, detours, len(used)
        self._at = np.full(count, state.vertex, dtype=np.int64)
        if detours is None:
            self.left: Floats = np.asarray(state.left)[None, :] - used[:, None]
        else:
            self.left = detours.left(np.arange(count))
        self._legs = np.zeros(count)
        self._visited = np.zeros((count, self._prepared.size), dtype=bool)
        self._ended: list[tuple[Ints, tuple[int, ...]]] = []
        self._waits = np.zeros(count, dtype=bool)
        self._refused = np.zeros_like(self._visited)
        self._left_behind: list[tuple[Ints, _Group]] = []

    @property
    def is_uncertain(self) -> bool:
        """Return True if the cost of legs is random."""
        return bool(self._prepared.cumulants[0] > 0.0)

    def visit(self, group: _Group, stops: Ints, rng: np.random.Generator) -> None:
        """Drive every mission of a group to every stop."""
        for stop in stops.tolist():
            self._go(group.members, int(stop), rng)
            group.vertex = int(stop)
        group.stops = (*group.stops, *stops.tolist())
        self._leave_behind(group, stops)
        group.members = group.members[~self._waits[group.members]]

    def skip(
        self,
        group: _Group,
        search: DecisionSearch,
        order: VisitOrder,
        bonus: float,
        fewest: int,
        rng: np.random.Generator,
    ) -> list[_Group]:
        """Drive each mission of a group along the next stops of an order, skipping those that it cannot afford.

        Returns:
            Groups of at least ``fewest`` missions at the same stop, which are to be replanned. All other missions have
            been driven to the end.
        """
        members, last = group.members, len(order.stops) + 1
        choice, step = search.choices(order.stops, bonus, float(self.left[members].min(axis=1).max()))
        position = np.zeros(len(members), dtype=np.int64)

        def drive(going: NDArray[np.bool_], until: int) -> None:
            for i in range(min(last, until)):
                here = np.flatnonzero(going & (position == i) & ~self._waits[members])
                if not len(here):
                    continue
                left = self.left[members[here]].min(axis=1)
                entry = np.clip(np.round(left / step), 0, choice.shape[1] - 1).astype(np.int64)
                goes = np.where(left <= 0.0, last, choice[i, entry])
                position[here] = goes
                for j in np.unique(goes[goes < last]).tolist():
                    self._go(members[here[goes == j]], int(order.stops[j - 1]), rng)

        anew = len(order.stops) > _STRIDE + _FEW and self.is_uncertain
        drive(np.ones(len(members), dtype=bool), _STRIDE if anew else last)
        numbers, counts = np.unique(position[~self._waits[members]], return_counts=True)
        together = [p for p, n in zip(numbers.tolist(), counts.tolist(), strict=True) if n >= fewest and p < last]
        alone = ~np.isin(position, together)
        drive(alone, last)
        group.stops, before = (*group.stops, *order.stops.tolist()), group.stops
        self._leave_behind(group, order.stops)
        waits = self._waits[members]
        self.end(members[alone & ~waits], group.stops)
        return [
            _Group(
                policy=group.policy.again(
                    int(rng.integers(2**31)), group.policy.price, order.stops[p:].tolist(), _DEPTH
                ),
                vertex=int(order.stops[p - 1]),
                stops=(*before, *order.stops[:p].tolist()),
                members=members[(position == p) & ~waits],
                warm=tuple(order.stops[p:].tolist()),
                mixed=group.mixed,
            )
            for p in together
        ]

    def end(self, members: Ints, stops: tuple[int, ...]) -> None:
        """End the visits of missions that followed ``stops``."""
        if len(members):
            self._ended.append((members, tuple(dict.fromkeys(stops))))

    @property
    def wait(self) -> bool:
        """Return True if missions wait at the place of their detour."""
        return bool(self._left_behind)

    def together(self, alike: int, rng: np.random.Generator) -> list[_Group]:
        """Return the missions at the place of their detour, in groups that are to be planned anew from there.

        A plan is for missions that have made the same visits: those that set out earlier have more of them to make.

        Args:
            alike: Minimum number of missions with the same visits that are a group of their own.
            rng: Random generator of the seeds.
        """
        assert self._detours is not None and self._detours.policy is not None  # noqa: S101, PT018  they wait there
        waits = np.flatnonzero(self._waits)
        self._waits[:] = False
        groups = [
            self._from_detour(part, self._detours.policy, rng)
            for part in _with_equal_rows(waits, self._visited[waits], alike)
        ]
        self._left_behind.clear()
        return groups

    def _from_detour(self, members: Ints, policy: Policy, rng: np.random.Generator) -> _Group:
        """Return missions at the place of their detour as one group, with the plan of most of them as its first."""
        counts = [len(np.intersect1d(those, members)) for those, _ in self._left_behind]
        came = [self._left_behind[k][1] for k in np.argsort(counts)[::-1].tolist() if counts[k]]
        visited = self._visited[members].mean(axis=0)
        warm = tuple(v for v in dict.fromkeys(came[0].warm) if visited[v] < 0.5)
        stops = tuple(dict.fromkeys(v for group in came for v in group.stops))
        policy = policy.again(int(rng.integers(2**31)), came[0].policy.price, warm, _DEPTH)
        return _Group(policy=policy, vertex=0, stops=stops, members=members, warm=warm, mixed=True)

    def _leave_behind(self, group: _Group, ahead: Ints) -> None:
        """Note which missions of a group wait, and what it visits."""
        some = group.members[self._waits[group.members]]
        if len(some):
            self._left_behind.append((some, replace(group, warm=(*ahead.tolist(), *group.warm))))

    def collected(self, group: _Group) -> tuple[frozenset[int], frozenset[int]]:
        """Return the vertices that at least half of a group has visited, and those that it will not visit any more.

        The latter are those that fewer have visited, or that half of them have left out.
        """
        part, refused = self._visited[group.members].mean(axis=0), self._refused[group.members].mean(axis=0)
        others = (part < 0.5) & ((refused >= 0.5) | (part > 0.0) & (not group.mixed))
        return tuple(frozenset(np.flatnonzero(x).tolist()) for x in (part >= 0.5, others))  # type: ignore[return-value]

    def made(self, rng: np.random.Generator) -> Preview:
        """Return the simulated missions, including the leg to the end."""
        prepared = self._prepared
        last = self._lengths(prepared.size, self._at) * prepared.problem.model.draw(rng, len(self._at))
        # The median group comes first, because its order is the one drawn on maps.
        visits = self._visited.sum(axis=1)
        typical = np.median(visits)
        ended = sorted(self._ended, key=lambda group: abs(float(np.median(visits[group[0]])) - typical))
        groups = np.zeros(len(self._at), dtype=np.int64)
        for number, (members, _) in enumerate(ended):
            groups[members] = number
        made = self._visited.sum(axis=0)
        vertices = np.array(list(dict.fromkeys(v for _, stops in ended for v in stops if made[v])), dtype=np.int64)
        return Preview(
            vertices=vertices,
            visited=self._visited[:, vertices],
            legs=self._legs,
            last=last,
            groups=groups,
            orders=tuple(np.array(stops, dtype=np.int64) for _, stops in ended),
        )

    def _go(self, some: Ints, stop: int, rng: np.random.Generator) -> None:
        prepared, detours = self._prepared, self._detours
        if detours is not None:
            may = self._may_visit(some, stop)
            self._refused[some[~may], stop] = True
            some = some[may]
        legs = self._lengths(stop, self._at[some])
        if detours is not None:
            departs = detours.set_out(some, stop, legs, rng)
            waits = some[departs.waits]
            self._at[waits], self._waits[waits] = _DETOUR, True
            self.left[waits] = detours.left(waits)
            self._refused[some[~(departs.makes | departs.waits)], stop] = True
            some, legs = some[departs.makes], departs.legs[departs.makes]
        cost = legs * prepared.problem.model.draw(rng, len(some))
        self._legs[some] += cost
        if detours is None:
            self.left[some] -= cost[:, None] + prepared.service[:, stop]
        else:
            detours.arrive(some, stop, cost)
            self.left[some] = detours.left(some)
        self._at[some] = stop
        self._visited[some, stop] = True

    def _may_visit(self, some: Ints, stop: int) -> NDArray[np.bool_]:
        """Return True for missions that have not made a visit, and may: those of a mixed group differ."""
        may: NDArray[np.bool_] = ~self._visited[some, stop]
        most = self._prepared.problem.max_visits
        if most is not None:
            may &= self._visited[some].sum(axis=1) < most
        return may

    def _lengths(self, to: int, vertices: Ints) -> Floats:
        """Return the lengths from vertices, or the place of the detour, to a node."""
        away = vertices == _DETOUR
        if self._detours is not None and away.any():
            found = np.full(len(vertices), self._detours.length(to))
            found[~away] = self._between(to, vertices[~away])
            return found
        return self._between(to, vertices)

    def _between(self, to: int, vertices: Ints) -> Floats:
        prepared = self._prepared
        if len(prepared.lengths.matrix):
            return np.asarray(prepared.lengths.matrix[vertices, to])
        return prepared.row(prepared.problem.end if to == prepared.size else to)[vertices]


def _with_equal_rows(members: Ints, rows: NDArray[np.bool_], fewest: int) -> list[Ints]:
    """Return members in groups with equal rows; those with rarer rows join the group whose row differs least.

    Args:
        members: The members.
        rows: The row of each.
        fewest: Minimum number of members with a row that makes a group.
    """
    different, number, counts = np.unique(rows, axis=0, return_inverse=True, return_counts=True)
    kept = np.flatnonzero(counts >= fewest)
    if len(kept) < 2:
        return [members]
    each = different.astype(np.float64)
    differences = each.sum(axis=1)[:, None] + each[kept].sum(axis=1) - 2.0 * each @ each[kept].T
    group = differences.argmin(axis=1)[number.reshape(-1)]
    return [members[group == k] for k in range(len(kept))]
