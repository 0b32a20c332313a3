"""Random plans of seven kinds, which cover the missions that a guard has to keep within their limits."""

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
class RandomChoices:
    """Random choices for plans on one site with one robot."""

    rng: np.random.Generator
    site: Site
    robot: RobotProfile

    def chance(self, probability: float) -> bool:
        """Return True with the given probability."""
        return bool(self.rng.random() < probability)

    def number(self, low: int, high: int) -> int:
        """Return a random integer, both ends included."""
        return int(self.rng.integers(low, high + 1))

    def trees(self, most: int) -> tuple[str, ...]:
        """Return the ids of one to ``most`` different trees."""
        count = self.number(1, max(1, min(most, len(self.site.trees))))
        chosen = self.rng.choice(len(self.site.trees), size=count, replace=False)
        return tuple(self.site.trees[k].place.id for k in chosen.tolist())

    def action(self, *, measuring: bool = False) -> str:
        """Return the name of a random action of the robot; with ``measuring`` one that measures something."""
        names = [a.name for a in self.robot.actions if a.measures or not measuring]
        return str(self.rng.choice(names))


def optional(choices: RandomChoices) -> Node:
    """Return a plan to visit as many trees as fit."""
    return _as_many(choices)


def mandatory_and_optional(choices: RandomChoices) -> Node:
    """Return a plan to visit as many trees as fit, with mandatory visits before or after them."""
    before = [_must(choices, 5)] if choices.chance(0.6) else []
    after = [_must(choices, 5)] if not before or choices.chance(0.5) else []
    return InOrder(id="", steps=(*before, _as_many(choices), *after))


def mandatory(choices: RandomChoices) -> Node:
    """Return a plan of mandatory visits, in the given or in the best order."""
    return _must(choices, 30)


def two_optional(choices: RandomChoices) -> Node:
    """Return a plan to visit as many as fit of two sets of trees in turn; the reward of the first set is the yield."""
    steps: list[Node] = [
        _as_many(choices, reward=WORTH),
        _as_many(choices, reward=WORTH if choices.chance(0.5) else ""),
    ]
    if choices.chance(0.3):
        steps.append(_must(choices, 3))
    return InOrder(id="", steps=tuple(steps))


def loops(choices: RandomChoices) -> Node:
    """Return a plan to visit as many trees as fit: repeatedly, up to a number, or until a reading ends the loop."""
    sort = choices.number(0, 3)
    if sort == 0:
        again = NotVisited() if choices.chance(0.3) else None
        return Repeat(id="", times=choices.number(2, 3), body=_as_many(choices, select=again))
    if sort == 1:
        return _as_many(choices, at_most=choices.number(1, 12))
    if sort == 2:
        read, condition = _reading(choices)
        return ForEach(id="", select=_few(choices, 25), body=read, optional=True, until=condition)
    rounds = Repeat(id="", times=choices.number(2, 4), body=_must(choices, 4))
    return InOrder(id="", steps=(rounds, _as_many(choices)))


def work(choices: RandomChoices) -> Node:
    """Return a plan to visit as many trees as fit with several captures at each, so that work outweighs driving."""
    acts = tuple(Act(id="", action=choices.action(), count=choices.number(1, 4)) for _ in range(choices.number(1, 3)))
    loop = ForEach(id="", select=_some(choices), body=InOrder(id="", steps=acts), optional=True)
    return InOrder(id="", steps=(_must(choices, 4), loop)) if choices.chance(0.4) else loop


def conditions(choices: RandomChoices) -> Node:
    """Return a plan whose readings add mandatory work, after a first measurement or at each optional visit."""
    read, condition = _reading(choices)
    if choices.chance(0.5):
        more = If(id="", condition=condition, then=Act(id="", action=choices.action(), count=choices.number(1, 5)))
        loop = ForEach(id="", select=_few(choices, 6), body=InOrder(id="", steps=(read, more)), optional=True)
        steps: tuple[Node, ...] = (loop, _must(choices, 3)) if choices.chance(0.5) else (loop,)
        return InOrder(id="", steps=steps)
    first = Act(id="", action=read.action, at=TreeIs(tree=choices.trees(1)[0]), reading=read.reading)
    then = If(id="", condition=condition, then=_must(choices, 8), otherwise=None)
    steps = (first, then, _as_many(choices)) if choices.chance(0.5) else (first, _as_many(choices), then)
    return InOrder(id="", steps=steps)


Family = Callable[[RandomChoices], Node]

#: Families by name, in the order in which seeds cycle through them.
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
    choices: RandomChoices, *, reward: str = "", at_most: int | None = None, select: Selector | None = None
) -> ForEach:
    return ForEach(
        id="",
        select=select or _some(choices),
        body=Act(id="", action=choices.action()),
        optional=True,
        reward=reward,
        at_most=at_most,
    )


def _must(choices: RandomChoices, most: int) -> Node:
    """Return mandatory visits to one to ``most`` trees, in one of the forms that a plan allows."""
    trees = choices.trees(most)
    sort = choices.number(0, 4)
    if sort == 0:
        acts = tuple(Act(id="", action=choices.action(), at=TreeIs(tree=t)) for t in trees)
        return InOrder(id="", steps=acts)
    if sort == 1 and len(trees) <= 10:
        acts = tuple(Act(id="", action=choices.action(), at=TreeIs(tree=t)) for t in trees)
        return AnyOrder(id="", steps=acts)
    if sort == 2:
        go = GoTo(id="", place=TreeIs(tree=trees[0]))
        near = Nearest(to=TreeIs(tree=trees[0]), count=len(trees))
        return InOrder(id="", steps=(go, ForEach(id="", select=near, body=Act(id="", action=choices.action()))))
    body: Node = Act(id="", action=choices.action(), count=choices.number(1, 2))
    if choices.chance(0.3):
        body = InOrder(id="", steps=(body, Act(id="", action=choices.action())))
    order: Literal["best", "given"] = "given" if choices.chance(0.3) else "best"
    return ForEach(id="", select=UnionOf(parts=tuple(TreeIs(tree=t) for t in trees)), body=body, order=order)


def _some(choices: RandomChoices) -> Selector:
    """Return a selector of trees to visit: all, one half, every n-th, or those with a high yield."""
    sort = choices.number(0, 5)
    if sort == 0:
        return Half(side=_SIDES[choices.number(0, 3)])
    if sort == 1:
        return EveryNth(nth=choices.number(2, 4))
    if sort == 2:
        return Where(attribute=WORTH, test="gt", value=round(float(choices.rng.uniform(2.0, 12.0)), 1))
    return Trees()


def _few(choices: RandomChoices, most: int) -> Selector:
    """Return a selector of so few trees that approval can examine every combination of their readings."""
    return UnionOf(parts=tuple(TreeIs(tree=t) for t in choices.trees(most)))


def _reading(choices: RandomChoices) -> tuple[Act, Compare]:
    """Return an action that measures, and a condition on its reading that holds with some probability."""
    action = choices.action(measuring=True)
    quantity = choices.robot.quantity[choices.robot.action[action].measures[0]]
    value = round(quantity.typical + quantity.spread * float(choices.rng.uniform(-1.5, 1.0)), 1)
    tested = Compare(reading="r", quantity=quantity.name, test="lt", value=value, unit=quantity.unit)
    return Act(id="", action=action, reading="r"), tested
