"""Where each node of a plan leads on this site, gathered from the walks of a forecast."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from fieldhand.forecast.walk_steps import VisitForecast, Walk
from fieldhand.site.model import Place
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node


@dataclass(frozen=True, kw_only=True)
class Found:
    """What a node's selector came to.

    Attributes:
        visits: The places of each time that the node was done on the likeliest branch that has it: one for an action or
            a drive, all in their order for a for-each; for an optional step where it begins, none where it is shed.
        shed: Places for which the budget is not expected to last.
        known: They are the same on every branch and whatever legs cost; else they are decided on the way.
        visit_forecast: What will probably come of optional visits, the first time.
        short: The chance that the mission runs short, with them.
    """

    visits: tuple[tuple[Place, ...], ...]
    shed: tuple[Place, ...]
    known: bool
    visit_forecast: VisitForecast | None = None
    short: float = 0.0

    @property
    def places(self) -> tuple[Place, ...]:
        """The places of the first time."""
        return self.visits[0]

    @property
    def one(self) -> Place | None:
        """The one place that the node always means, if there is one."""
        places = {p.xy: p for visit in self.visits for p in visit}
        return next(iter(places.values())) if self.known and len(places) == 1 else None


def gather(task: Task, walks: Sequence[Walk], short: float = 0.0) -> Mapping[str, Found]:
    """What each selector of a plan came to, by the id of its node; nodes that no walk reached are left out.

    Args:
        task, walks: The Task on its branches.
        short: The chance that the mission runs short.
    """
    doubtful = _doubtful(task.composition.plan)
    per_walk = [_of_walk(w) for w in walks]
    found: dict[str, Found] = {}
    for node_id in {n: None for one in per_walk for n in one}:
        seen = [one[node_id] for one in per_walk if node_id in one]
        first = seen[0]
        same = all(a[0] == b[0] for other in seen for a, b in zip(first, other, strict=False))
        found[node_id] = Found(
            visits=tuple(places for places, _, _ in first),
            shed=first[0][1],
            known=same and node_id not in doubtful,
            visit_forecast=first[0][2],
            short=short,
        )
    return found


_Visit = tuple[tuple[Place, ...], tuple[Place, ...], VisitForecast | None]


def _of_walk(walk: Walk) -> dict[str, list[_Visit]]:
    """The places of each node of a walk, each time that it came up."""
    found: dict[str, list[_Visit]] = {}
    for step in walk.steps:
        listed = step.kind == "visit-list"
        # Of an action with a drive the action counts, of a for-each the list.
        driven = step.kind == "drive" and step.node.only_drives
        done = step.kind == "act" or driven
        if listed or (done and step.node.selector is not None):
            found.setdefault(step.node.id, []).append((step.places, step.shed, step.visit_forecast))
    return found


def _doubtful(plan: Node) -> frozenset[str]:
    """Nodes with relative places in or after optional visits, or after an optional step: they hang on the budget."""
    found: set[str] = set()
    after = False

    def visit(node: Node) -> None:
        nonlocal after
        selector = node.selector
        if after and selector is not None and selector.relative:
            found.add(node.id)
        after = after or (node.is_optional and node.visits_each)
        for child in node.children:
            visit(child)
        after = after or node.is_optional

    visit(plan)
    return frozenset(found)
