"""Resolved places of each plan node on the site, collected from the walks of a forecast."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from fieldhand.forecast.walk_steps import VisitForecast, Walk
from fieldhand.site.model import Place
from fieldhand.site.working.stretch import Stretch
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node


@dataclass(frozen=True, kw_only=True)
class ResolvedPlaces:
    """The resolved places of one node.

    Attributes:
        visits: Places for each execution of the node on the most likely branch that contains it: one for an action or
            drive, all in order for a for-each; for an optional step its starting place, or none if it is skipped.
        shed: Places that the budget is not expected to cover.
        known: True if the places are the same on every branch and for any leg costs; otherwise decided on the way.
        visit_forecast: Forecast of the optional visits in the first execution.
        short: Probability that the mission runs short with them.
        stretches: Stretches of work along a path in the first execution.
    """

    visits: tuple[tuple[Place, ...], ...]
    shed: tuple[Place, ...]
    known: bool
    visit_forecast: VisitForecast | None = None
    short: float = 0.0
    stretches: tuple[Stretch, ...] = ()

    @property
    def places(self) -> tuple[Place, ...]:
        """Return the places of the first execution."""
        return self.visits[0]

    @property
    def one(self) -> Place | None:
        """Return the single place that the node always resolves to, or None."""
        places = {p.xy: p for visit in self.visits for p in visit}
        return next(iter(places.values())) if self.known and len(places) == 1 else None


def gather(task: Task, walks: Sequence[Walk], short: float = 0.0) -> Mapping[str, ResolvedPlaces]:
    """Return the resolved places of each node by its id, without nodes that no walk reached.

    Args:
        task, walks: Task and its simulated branches.
        short: Probability that the mission runs short.
    """
    doubtful = _doubtful(task.composition.plan)
    per_walk = [_of_walk(w) for w in walks]
    found: dict[str, ResolvedPlaces] = {}
    for node_id in {n: None for one in per_walk for n in one}:
        seen = [one[node_id] for one in per_walk if node_id in one]
        first = seen[0]
        same = all(a[0] == b[0] for other in seen for a, b in zip(first, other, strict=False))
        found[node_id] = ResolvedPlaces(
            visits=tuple(places for places, _, _ in first),
            shed=first[0][1],
            known=same and node_id not in doubtful,
            visit_forecast=first[0][2],
            short=short,
            stretches=_stretches(walks, node_id),
        )
    return found


def _stretches(walks: Sequence[Walk], node_id: str) -> tuple[Stretch, ...]:
    """Return the stretches of the first execution of a node, on the first walk that has any."""
    found: list[Stretch] = []
    for walk in walks:
        for step in walk.steps:
            if step.node.id != node_id:
                continue
            if step.kind == "visit-list" and found:
                return tuple(found)
            if step.stretch is not None:
                found.append(step.stretch)
        if found:
            break
    return tuple(found)


_Visit = tuple[tuple[Place, ...], tuple[Place, ...], VisitForecast | None]


def _of_walk(walk: Walk) -> dict[str, list[_Visit]]:
    """Return the places of each node of a walk, for each execution."""
    found: dict[str, list[_Visit]] = {}
    for step in walk.steps:
        listed = step.kind == "visit-list"
        # An action with a drive is counted at the action, a for-each at its visit list.
        driven = step.kind == "drive" and step.node.only_drives
        done = step.kind == "act" or driven
        if listed or (done and step.node.selector is not None):
            found.setdefault(step.node.id, []).append((step.places, step.shed, step.visit_forecast))
    return found


def _doubtful(plan: Node) -> frozenset[str]:
    """Return nodes whose places depend on readings, and those with relative places in or after such nodes, or in or
    after optional visits or steps, which depend on the budget.
    """
    found: set[str] = set()
    after = False

    def visit(node: Node) -> None:
        nonlocal after
        selector = node.selector
        if after and selector is not None and selector.relative:
            found.add(node.id)
        if selector is not None and selector.decided_by_readings:
            found.add(node.id)
            after = True
        after = after or (node.is_optional and node.visits_each)
        for child in node.children:
            visit(child)
        after = after or node.is_optional

    visit(plan)
    return frozenset(found)
