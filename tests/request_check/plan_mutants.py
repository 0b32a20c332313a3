"""Mistakes planted in a plan, one at a time, by the kind of mistake: for checks that have to catch them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.build import make_task
from fieldhand.task.frames import Budget, Constraints, Task

OPPOSITE = {"north": "south", "south": "north", "east": "west", "west": "east"}
CORNERS = {"nw": "se", "se": "nw", "ne": "sw", "sw": "ne"}
TURNED = {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le"}
LEVELS = {"low": "high", "high": "low"}

Change = Callable[[Any], Iterator[Any]]


def mutants(task: Task, site: Site, robot: RobotProfile) -> Iterator[tuple[str, Task]]:
    """Each way to plant one mistake in a plan: its kind, and the whole Task with it."""
    for kind, change in _changes(site, robot).items():
        for plan in _everywhere(task.composition.plan, change):
            yield kind, _whole(task, plan=plan)
    yield from _frames(task)


def _changes(site: Site, robot: RobotProfile) -> dict[str, Change]:
    """For each kind of mistake: what a part may be replaced by."""

    def count(x: Any) -> Iterator[Any]:
        if isinstance(x, p.Act) or (isinstance(x, s.Selector) and getattr(x, "count", 0) > 1):
            yield replace(x, count=x.count + 3)
        if isinstance(x, p.ForEach) and x.at_most:
            yield replace(x, at_most=x.at_most + 3)

    def sensor(x: Any) -> Iterator[Any]:
        if isinstance(x, p.Act):
            yield from (replace(x, action=a.name, parameters=()) for a in robot.actions if a.name != x.action)

    def threshold(x: Any) -> Iterator[Any]:
        if isinstance(x, c.Compare):
            yield replace(x, value=x.value + 7)
        if isinstance(x, s.Where | c.TreeHas) and isinstance(x.value, float):
            yield replace(x, value=x.value + 7.0)

    def unit(x: Any) -> Iterator[Any]:
        if isinstance(x, c.Compare) and x.unit == "degC":
            yield replace(x, value=x.value * 1.8 + 32)
        if isinstance(x, s.Within):
            yield replace(x, distance_m=x.distance_m * 3.28)
        if isinstance(x, s.Spaced):
            yield replace(x, apart_m=x.apart_m * 3.28)

    def turned(x: Any) -> Iterator[Any]:
        if isinstance(x, c.Compare) and x.test in TURNED:
            yield replace(x, test=TURNED[x.test])

    def level(x: Any) -> Iterator[Any]:
        if isinstance(x, c.Level) and x.level in LEVELS:
            yield replace(x, level=LEVELS[x.level])

    def side(x: Any) -> Iterator[Any]:
        for name in ("side", "counted_from", "towards"):
            if isinstance(x, s.Selector) and getattr(x, name, "") in OPPOSITE:
                yield replace(x, **{name: OPPOSITE[getattr(x, name)]})
        if isinstance(x, s.Corners) and len(x.which) < 4:
            yield replace(x, which=tuple(CORNERS[w] for w in x.which))
        if isinstance(x, s.Quarter):
            yield replace(x, quarter=CORNERS[x.quarter])

    def no_condition(x: Any) -> Iterator[Any]:
        if isinstance(x, p.If):
            yield x.then

    def tree(x: Any) -> Iterator[Any]:
        if isinstance(x, s.TreeIs):
            yield replace(x, tree="137" if x.tree != "137" else "138")

    def row(x: Any) -> Iterator[Any]:
        if isinstance(x, s.Rows) and x.first.isdecimal() and x.first == x.last:
            yield replace(x, first=str(int(x.first) + 2), last=str(int(x.last) + 2))

    def no_attribute(x: Any) -> Iterator[Any]:
        if isinstance(x, s.Where):
            yield x.of

    def attribute(x: Any) -> Iterator[Any]:
        if isinstance(x, s.Where | c.TreeHas) and isinstance(x.value, str):
            known = site.attributes.get(x.attribute, ())
            yield from (replace(x, value=other) for other in known if other != x.value and x.value not in str(other))

    def zone(x: Any) -> Iterator[Any]:
        if isinstance(x, s.InZone | s.Spaced | s.PointsIn) and x.zone:
            yield from (replace(x, zone=z.name) for z in site.zones if z.name and z.name != x.zone)

    def no_zone(x: Any) -> Iterator[Any]:
        if isinstance(x, s.InZone):
            yield x.of

    def marker(x: Any) -> Iterator[Any]:
        if isinstance(x, s.Marker) and x.name == "charger":
            yield replace(x, name="end")

    def no_step(x: Any) -> Iterator[Any]:
        if isinstance(x, p.InOrder) and len(x.steps) > 1:
            yield from (replace(x, steps=x.steps[:k] + x.steps[k + 1 :]) for k in range(len(x.steps)))

    def not_optional(x: Any) -> Iterator[Any]:
        if isinstance(x, p.ForEach) and x.optional:
            yield replace(x, optional=False)

    def distance(x: Any) -> Iterator[Any]:
        if isinstance(x, s.Within):
            yield replace(x, distance_m=x.distance_m + 13)
        if isinstance(x, s.Spaced):
            yield replace(x, apart_m=x.apart_m + 4)

    return {
        "count": count,
        "sensor": sensor,
        "threshold": threshold,
        "unit": unit,
        "test turned around": turned,
        "level": level,
        "side": side,
        "condition dropped": no_condition,
        "tree": tree,
        "row": row,
        "attribute": attribute,
        "attribute dropped": no_attribute,
        "zone": zone,
        "zone dropped": no_zone,
        "marker": marker,
        "step dropped": no_step,
        "as many as possible dropped": not_optional,
        "distance": distance,
    }


def _frames(task: Task) -> Iterator[tuple[str, Task]]:
    """Mistakes in limits and exits."""
    limits = task.constraints
    if limits.budgets:
        yield "budget dropped", _whole(task, constraints=replace(limits, budgets=()))
        wrong = tuple(replace(b, limit=b.limit * 1.37) for b in limits.budgets)
        yield "budget", _whole(task, constraints=replace(limits, budgets=wrong))
    else:
        invented = (Budget(kind="energy_percent", limit=41.0),)
        yield "budget invented", _whole(task, constraints=replace(limits, budgets=invented))
    if limits.reserve_percent is not None:
        yield "reserve dropped", _whole(task, constraints=replace(limits, reserve_percent=None))
    gone = any(isinstance(n, p.GoTo) and n.place == s.Marker(name="start") for n in p.walk(task.composition.plan))
    if task.composition.nominal == "return_to_start" and not gone:
        yield "return dropped", _whole(task, nominal="return_to_end")


def _everywhere(value: Any, change: Change) -> Iterator[Any]:
    """The value with one part of it changed, for every part that can be."""
    yield from change(value)
    for field in fields(value):
        inside = getattr(value, field.name)
        if is_dataclass(inside):
            yield from (replace(value, **{field.name: new}) for new in _everywhere(inside, change))
        elif isinstance(inside, tuple):
            for k, part in enumerate(inside):
                if is_dataclass(part):
                    for new in _everywhere(part, change):
                        yield replace(value, **{field.name: (*inside[:k], new, *inside[k + 1 :])})


def _whole(task: Task, **changed: Any) -> Task:
    plan: p.Node = changed.get("plan", task.composition.plan)
    constraints: Constraints = changed.get("constraints", task.constraints)
    return make_task(
        request=task.command.request,
        plan=plan,
        measures={},
        constraints=constraints,
        nominal=changed.get("nominal", task.composition.nominal),
    )
