"""A grid of trees and a tractor with implements, whose legs cost what they are long: for tests of work along a path."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Rows, TreeIs, UnionOf
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.nodes.work_along import WorkAlong
from support.missions.rig import orchard

#: Rows run from west to east, 5 m apart; row 1 is the northernmost. Of row r1 one tree is missing in the middle.
MISSING = "r1c2"


@cache
def gappy() -> Site:
    """Return the grid without one tree."""
    whole = orchard()
    kept = [tree for tree in whole.trees if tree.place.id != MISSING]
    return replace(
        whole, trees=tuple(replace(tree, index=k) for k, tree in enumerate(kept)), name="gappy", sha256="gappy-hash"
    )


@cache
def tractor(alpha: float = 1.0, retries: int = 1) -> RobotProfile:
    """Return the built-in tractor, by default with legs that cost what they are long."""
    robot = load_robot("tractor")
    return replace(robot, leg_cost=replace(robot.leg_cost, alpha=alpha), retries=retries)


def row(name: str) -> Selector:
    """Return the trees of one row of the grid, called r0 (the southernmost) to r3."""
    return Rows(first=name, last=name)


def some(*trees: str) -> Selector:
    """Return some trees."""
    return UnionOf(parts=tuple(TreeIs(tree=tree) for tree in trees))


def along(*names: str, action: str = "spray", **more: object) -> WorkAlong:
    """Return work along rows of the grid."""
    select = row(names[0]) if len(names) == 1 else UnionOf(parts=tuple(row(name) for name in names))
    return WorkAlong(action=action, along=select, **more)  # type: ignore[arg-type]
