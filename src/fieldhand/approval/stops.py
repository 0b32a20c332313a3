"""Stops and legs of a planned mission for a map, each certain, conditional on a reading, or subject to the budget."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from fieldhand.forecast.walk_steps import Walk, WalkStep
from fieldhand.site.model import Place
from fieldhand.site.working.stretch import pieces
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, walk
from fieldhand.wording.steps import ReadBackLine

Certainty = Literal["certain", "conditional", "budget"]
XY = tuple[float, float]


@dataclass(kw_only=True)
class MapStop:
    """A place where the mission performs actions.

    Attributes:
        labels: Numbers of the read-back steps performed there; visits of a loop as "2.1", "2.2".
        actions: Certainty of each action, by action name.
        heading_deg: Heading of the robot for a camera, in degrees clockwise from north; None without a camera.
    """

    place: Place
    labels: list[str] = field(default_factory=list)
    actions: dict[str, Certainty] = field(default_factory=dict)
    certainty: Certainty = "conditional"
    heading_deg: float | None = None


@dataclass(frozen=True, kw_only=True)
class Leg:
    """A driven leg of the route; ``worked`` are the parts of it on which an implement is on."""

    points: tuple[XY, ...]
    certainty: Certainty
    worked: tuple[tuple[XY, ...], ...] = ()


@dataclass(frozen=True, kw_only=True)
class DrawnPlan:
    """Stops and legs to draw, in driving order on the most likely branch."""

    stops: tuple[MapStop, ...]
    legs: tuple[Leg, ...]


def plan_of(task: Task, walks: Sequence[Walk], lines: Iterable[ReadBackLine]) -> DrawnPlan:
    """Return the stops and legs of a mission.

    Args:
        task: The Task.
        walks: Simulated branches; the first is drawn completely, the others only where they differ from it.
        lines: Lines of the read-back, which supply the step numbers.
    """
    numbers: dict[str, int] = {}
    for line in lines:
        if line.number is not None:
            # The exit belongs to the root of the plan, which may already have a line.
            numbers.setdefault(line.node, line.number)
    gatherer = _Gatherer(task, walks, numbers)
    for k, walked in enumerate(walks):
        gatherer.add(walked, first=k == 0)
    return DrawnPlan(stops=tuple(gatherer.stops.values()), legs=tuple(gatherer.legs.values()))


class _Gatherer:
    def __init__(self, task: Task, walks: Sequence[Walk], numbers: Mapping[str, int]) -> None:
        self.stops: dict[XY, MapStop] = {}
        self.legs: dict[tuple[XY, ...], Leg] = {}
        self._numbers = numbers
        self._optional = _of_optional(task.composition.plan)
        self._by_readings = _by_readings(task.composition.plan)
        seen = [{_key(s) for s in w.steps} for w in walks]
        self._always = frozenset.intersection(*map(frozenset, seen)) if seen else frozenset()

    def add(self, walked: Walk, *, first: bool) -> None:
        """Add a branch; all but the first only up to the first step that depends on the budget."""
        visits: dict[str, int] = {}
        after_optional = from_optional = from_reading = False
        for step in walked.steps:
            after_optional = after_optional or step.node.id in self._optional
            if after_optional and not first:
                return
            if step.kind == "visit-list":
                visits[step.node.id] = 0
            certainty = self._certainty(step, after_optional)
            if step.drive is not None:
                # A leg that starts at an optional stop is as uncertain as that stop, whatever its destination.
                way: Certainty = "budget" if from_optional else "conditional" if from_reading else certainty
                self.legs.setdefault(step.drive.points, Leg(points=step.drive.points, certainty=way))
                from_optional, from_reading = step.node.id in self._optional, step.node.id in self._by_readings
            if step.stretch is not None:
                points = step.stretch.points
                worked = pieces(points, step.stretch.on) if step.node.work is not None and step.node.work.action else ()
                self.legs.setdefault(points, Leg(points=points, certainty=certainty, worked=worked))
            if step.kind in ("drive", "act", "wait") and step.node.work is None:
                self._stop(step, certainty, visits)

    def _certainty(self, step: WalkStep, after_optional: bool) -> Certainty:
        if step.node.id in self._optional:
            return "budget"
        if step.node.id in self._by_readings:
            return "conditional"
        if _key(step) in self._always:
            return "certain"
        return "budget" if after_optional else "conditional"

    def _stop(self, step: WalkStep, certainty: Certainty, visits: dict[str, int]) -> None:
        place = step.places[0]
        stop = self.stops.setdefault(place.xy, MapStop(place=place))
        number = self._numbers.get(step.node.id)
        label = "" if number is None else str(number)
        act = step.node.act
        if step.node.visits_each:
            visits[step.node.id] = visits.get(step.node.id, 0) + 1
            label = f"{label}.{visits[step.node.id]}"
        elif any(known.partition(".")[2] for known in stop.labels) and act is not None and act.at is None:
            label = ""  # the number of the visit already covers this action
        if label and label not in stop.labels:
            stop.labels.append(label)
        if act is not None:
            stop.heading_deg = step.heading_deg if step.sees is not None else stop.heading_deg
            stop.actions[act.action] = _surest(stop.actions.get(act.action, certainty), certainty)
        stop.certainty = _surest(stop.certainty, certainty)


def _surest(one: Certainty, other: Certainty) -> Certainty:
    order: tuple[Certainty, ...] = ("certain", "budget", "conditional")
    return min(one, other, key=order.index)


def _key(step: WalkStep) -> tuple[str, str, tuple[XY, ...]]:
    points = step.drive.points if step.drive is not None else tuple(p.xy for p in step.places)
    return (step.node.id, step.kind, points)


def _of_optional(plan: Node) -> frozenset[str]:
    """Return the ids of the optional nodes and of all nodes inside them."""
    return frozenset(inner.id for node in walk(plan) if node.is_optional for inner in walk(node))


def _by_readings(plan: Node) -> frozenset[str]:
    """Return the ids of the nodes whose places the mission's readings determine, and of all nodes inside them."""
    decided = (n for n in walk(plan) if n.selector is not None and n.selector.decided_by_readings)
    return frozenset(inner.id for node in decided for inner in walk(node))
