"""Large objects have short representations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fieldhand import mission
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.short_repr import short_repr
from fieldhand.site.loader import load_demo, site_files


@dataclass(repr=False)
class Held:
    name: str
    items: tuple[int, ...]
    array: object
    inner: object = None

    __repr__ = short_repr


def test_collections_are_counted_and_parts_named() -> None:
    held = Held("x" * 100, tuple(range(9)), np.zeros(1000), Held("a", (), ()))
    assert repr(held) == f"Held(name='{'x' * 60}'..., items=<9 items>, array=<1000 items>, inner=<Held>)"


def test_no_large_object_fills_a_screen() -> None:
    site, robot = load_demo(), load_robot("husky")
    outcome = mission.plan("Take a picture of every tree.", site, robot, EnglishPlanner())
    assert isinstance(outcome, Planned)
    review = mission.review(outcome.task, site, robot)
    assert review.estimate is not None
    branch = review.estimate.branches[0]
    for large in (
        site, site.planting, robot, outcome.task, outcome, review, review.estimate, branch, branch.walk,
        site_files("demo"),
    ):  # fmt: skip
        assert len(repr(large)) < 1200, type(large)
        assert repr(large).startswith(f"{type(large).__name__}(")
