"""Random plans of seven kinds: what a mission that a guard has to keep within its limits can look like."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fieldhand.places.selector import Selector
from fieldhand.places.selectors import EveryNth, Half, Nearest, NotVisited, TreeIs, Trees, UnionOf, Where
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.conditions import Compare
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, Node, Repeat
from fieldhand.terms import Side
from fieldhand_bench.scenes import WORTH

_SIDES: tuple[Side, ...] = ("north", "east", "south", "west")


@dataclass(frozen=True)
class Ground:
    """Where chance comes from, and what plans are made for."""

    rng: np.random.Generator
    site: Site
    robot: RobotProfile

    def chance(self, probability: float) -> bool:
        """Whether something of that probability happens."""
        return bool(self.rng.random() < probability)

    def number(self, low: int, high: int) -> int:
        """A whole number, both ends included."""
        return int(self.rng.integers(low, high + 1))

    def trees(self, most: int) -> tuple[str, ...]:
        """One to ``most`` different trees, by id."""
        count = self.number(1, max(1, min(most, len(self.site.trees))))
        chosen = self.rng.choice(len(self.site.trees), size=count, replace=False)
        return tuple(self.site.trees[k].place.id for k in chosen.tolist())

    def action(self, *, measuring: bool = False) -> str:
        """An action of the robot, or one that measures something."""
        names = [a.name for a in self.robot.actions if a.measures or not measuring]
        return str(self.rng.choice(names))


def optional(ground: Ground) -> Node:
    """As many trees as fit."""
    return _as_many(ground)


def mandatory_and_optional(ground: Ground) -> Node:
    """As many trees as fit, with visits before or after them that must be made."""
    before = [_must(ground, 5)] if ground.chance(0.6) else []
    after = [_must(ground, 5)] if not before or ground.chance(0.5) else []
    return InOrder(id="", steps=(*before, _as_many(ground), *after))


def mandatory(ground: Ground) -> Node:
    """Visits that must be made, in the order given or in the best one."""
    return _must(ground, 30)


def two_optional(ground: Ground) -> Node:
    """As many as fit of one set of trees, then of another, the first worth what their yield is."""
    steps: list[Node] = [_as_many(ground, reward=WORTH), _as_many(ground, reward=WORTH if ground.chance(0.5) else "")]
    if ground.chance(0.3):
        steps.append(_must(ground, 3))
    return InOrder(id="", steps=tuple(steps))


def loops(ground: Ground) -> Node:
    """As many as fit, in rounds, up to a number, or until a reading says enough."""
    sort = ground.number(0, 3)
    if sort == 0:
        again = NotVisited() if ground.chance(0.3) else None
        return Repeat(id="", times=ground.number(2, 3), body=_as_many(ground, select=again))
    if sort == 1:
        return _as_many(ground, at_most=ground.number(1, 12))
    if sort == 2:
        read, condition = _reading(ground)
        return ForEach(id="", select=_few(ground, 25), body=read, optional=True, until=condition)
    rounds = Repeat(id="", times=ground.number(2, 4), body=_must(ground, 4))
    return InOrder(id="", steps=(rounds, _as_many(ground)))


def work(ground: Ground) -> Node:
    """As many as fit, with several captures at each: time and energy go into work more than into driving."""
    acts = tuple(Act(id="", action=ground.action(), count=ground.number(1, 4)) for _ in range(ground.number(1, 3)))
    loop = ForEach(id="", select=_some(ground), body=InOrder(id="", steps=acts), optional=True)
    return InOrder(id="", steps=(_must(ground, 4), loop)) if ground.chance(0.4) else loop


def conditions(ground: Ground) -> Node:
    """Readings that add work which must be done: after a first look, or at each optional visit."""
    read, condition = _reading(ground)
    if ground.chance(0.5):
        more = If(id="", condition=condition, then=Act(id="", action=ground.action(), count=ground.number(1, 5)))
        loop = ForEach(id="", select=_few(ground, 6), body=InOrder(id="", steps=(read, more)), optional=True)
        steps: tuple[Node, ...] = (loop, _must(ground, 3)) if ground.chance(0.5) else (loop,)
        return InOrder(id="", steps=steps)
    first = Act(id="", action=read.action, at=TreeIs(tree=ground.trees(1)[0]), reading=read.reading)
    then = If(id="", condition=condition, then=_must(ground, 8), otherwise=None)
    steps = (first, then, _as_many(ground)) if ground.chance(0.5) else (first, _as_many(ground), then)
    return InOrder(id="", steps=steps)


Family = Callable[[Ground], Node]

#: By name, in the order in which seeds take them.
FAMILIES: Mapping[str, Family] = {
    "optional": optional,
    "mandatory-and-optional": mandatory_and_optional,
    "mandatory": mandatory,
    "two-optional": two_optional,
    "loops": loops,
    "work": work,
    "conditions": conditions,
}


def _as_many(
    ground: Ground, *, reward: str = "", at_most: int | None = None, select: Selector | None = None
) -> ForEach:
    return ForEach(
        id="",
        select=select or _some(ground),
        body=Act(id="", action=ground.action()),
        optional=True,
        reward=reward,
        at_most=at_most,
    )


def _must(ground: Ground, most: int) -> Node:
    """Visits to one to ``most`` trees, said in one of the ways in which a plan can say them."""
    trees = ground.trees(most)
    sort = ground.number(0, 4)
    if sort == 0:
        acts = tuple(Act(id="", action=ground.action(), at=TreeIs(tree=t)) for t in trees)
        return InOrder(id="", steps=acts)
    if sort == 1 and len(trees) <= 10:
        acts = tuple(Act(id="", action=ground.action(), at=TreeIs(tree=t)) for t in trees)
        return AnyOrder(id="", steps=acts)
    if sort == 2:
        go = GoTo(id="", place=TreeIs(tree=trees[0]))
        near = Nearest(to=TreeIs(tree=trees[0]), count=len(trees))
        return InOrder(id="", steps=(go, ForEach(id="", select=near, body=Act(id="", action=ground.action()))))
    body: Node = Act(id="", action=ground.action(), count=ground.number(1, 2))
    if ground.chance(0.3):
        body = InOrder(id="", steps=(body, Act(id="", action=ground.action())))
    order: Literal["best", "given"] = "given" if ground.chance(0.3) else "best"
    return ForEach(id="", select=UnionOf(parts=tuple(TreeIs(tree=t) for t in trees)), body=body, order=order)


def _some(ground: Ground) -> Selector:
    """Trees that may be visited: all, one side's, every n-th, the good ones."""
    sort = ground.number(0, 5)
    if sort == 0:
        return Half(side=_SIDES[ground.number(0, 3)])
    if sort == 1:
        return EveryNth(nth=ground.number(2, 4))
    if sort == 2:
        return Where(attribute=WORTH, test="gt", value=round(float(ground.rng.uniform(2.0, 12.0)), 1))
    return Trees()


def _few(ground: Ground, most: int) -> Selector:
    """So few trees that approval can look at every way that their readings may turn out."""
    return UnionOf(parts=tuple(TreeIs(tree=t) for t in ground.trees(most)))


def _reading(ground: Ground) -> tuple[Act, Compare]:
    """An action that measures, and a test of its reading that holds with some chance."""
    action = ground.action(measuring=True)
    quantity = ground.robot.quantity[ground.robot.action[action].measures[0]]
    value = round(quantity.typical + quantity.spread * float(ground.rng.uniform(-1.5, 1.0)), 1)
    tested = Compare(reading="r", quantity=quantity.name, test="lt", value=value, unit=quantity.unit)
    return Act(id="", action=action, reading="r"), tested
