"""Stops and legs of a planned mission for a map: what is certain, what hangs on a reading, what on the budget."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from fieldhand.approval.sentences import Line
from fieldhand.forecast.walk_steps import Walk, WalkStep
from fieldhand.site.model import Place
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, walk

Certainty = Literal["certain", "conditional", "budget"]
XY = tuple[float, float]


@dataclass(kw_only=True)
class Stop:
    """A place at which something is done.

    Attributes:
        labels: The numbers of the read-back's steps that are done there, visits of a loop as "2.1", "2.2".
        actions: By name, how certain it is.
    """

    place: Place
    labels: list[str] = field(default_factory=list)
    actions: dict[str, Certainty] = field(default_factory=dict)
    certainty: Certainty = "conditional"


@dataclass(frozen=True, kw_only=True)
class Leg:
    """A way that is driven."""

    points: tuple[XY, ...]
    certainty: Certainty


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What a map shows, in the order in which it is driven on the likeliest branch."""

    stops: tuple[Stop, ...]
    legs: tuple[Leg, ...]


def plan_of(task: Task, walks: Sequence[Walk], lines: Iterable[Line]) -> Plan:
    """The stops and legs of a mission.

    Args:
        task: The Task.
        walks: Its branches; the first is drawn as a whole, of the others what it does not have.
        lines: The read-back, for the numbers.
    """
    numbers: dict[str, int] = {}
    for line in lines:
        if line.number is not None:
            # The exit stands at the root of the plan, which may have a line of its own before.
            numbers.setdefault(line.node, line.number)
    gatherer = _Gatherer(task, walks, numbers)
    for k, walked in enumerate(walks):
        gatherer.add(walked, first=k == 0)
    return Plan(stops=tuple(gatherer.stops.values()), legs=tuple(gatherer.legs.values()))


class _Gatherer:
    def __init__(self, task: Task, walks: Sequence[Walk], numbers: Mapping[str, int]) -> None:
        self.stops: dict[XY, Stop] = {}
        self.legs: dict[tuple[XY, ...], Leg] = {}
        self._numbers = numbers
        self._optional = _of_optional(task.composition.plan)
        seen = [{_key(s) for s in w.steps} for w in walks]
        self._always = frozenset.intersection(*map(frozenset, seen)) if seen else frozenset()

    def add(self, walked: Walk, *, first: bool) -> None:
        """Add a branch; of all but the first only what no budget decides on."""
        visits: dict[str, int] = {}
        after_optional = from_optional = False
        for step in walked.steps:
            after_optional = after_optional or step.node.id in self._optional
            if after_optional and not first:
                return
            if step.kind == "visit-list":
                visits[step.node.id] = 0
            certainty = self._certainty(step, after_optional)
            if step.drive is not None:
                # A way that begins where the budget decides is as uncertain as that, wherever it leads.
                way: Certainty = "budget" if from_optional else certainty
                self.legs.setdefault(step.drive.points, Leg(points=step.drive.points, certainty=way))
                from_optional = step.node.id in self._optional
            if step.kind in ("drive", "act"):
                self._stop(step, certainty, visits)

    def _certainty(self, step: WalkStep, after_optional: bool) -> Certainty:
        if step.node.id in self._optional:
            return "budget"
        if _key(step) in self._always:
            return "certain"
        return "budget" if after_optional else "conditional"

    def _stop(self, step: WalkStep, certainty: Certainty, visits: dict[str, int]) -> None:
        place = step.places[0]
        stop = self.stops.setdefault(place.xy, Stop(place=place))
        number = self._numbers.get(step.node.id)
        label = "" if number is None else str(number)
        act = step.node.act
        if step.node.visits_each:
            visits[step.node.id] = visits.get(step.node.id, 0) + 1
            label = f"{label}.{visits[step.node.id]}"
        elif any(known.partition(".")[2] for known in stop.labels) and act is not None and act.at is None:
            label = ""  # the visit's own number stands for what is done there
        if label and label not in stop.labels:
            stop.labels.append(label)
        if act is not None:
            stop.actions[act.action] = _surest(stop.actions.get(act.action, certainty), certainty)
        stop.certainty = _surest(stop.certainty, certainty)


def _surest(one: Certainty, other: Certainty) -> Certainty:
    order: tuple[Certainty, ...] = ("certain", "budget", "conditional")
    return min(one, other, key=order.index)


def _key(step: WalkStep) -> tuple[str, str, tuple[XY, ...]]:
    points = step.drive.points if step.drive is not None else tuple(p.xy for p in step.places)
    return (step.node.id, step.kind, points)


def _of_optional(plan: Node) -> frozenset[str]:
    """The nodes that the budget decides on, and those inside them."""
    return frozenset(inner.id for node in walk(plan) if node.is_optional for inner in walk(node))
