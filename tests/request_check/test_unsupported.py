"""A request for a time, a day, another mission or waiting is doubted, whatever plan is made of it."""

from __future__ import annotations

from functools import cache

import pytest

from fieldhand.places import selectors as s
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.task.build import make_task
from support.sites.points import point, read

HUSKY = load_robot("husky")


@cache
def site() -> Site:
    """Nine trees of two varieties, one of which is called after a day."""
    return read(
        *(
            point(-120.5 + 5e-5 * (k % 3), 37.3 + 5e-5 * (k // 3), variety=("Sunday Gold", "Merlot")[k % 2])
            for k in range(9)
        )
    )


def unheld(request: str) -> list[str]:
    plan = p.ForEach(id="a", select=s.Trees(), body=p.Act(id="b", action="take_thermal_picture"))
    task = make_task(request=request, plan=plan, measures={}, nominal="stay")
    return [found.what for found in mismatches(task, site(), HUSKY) if found.kind == "unheld"]


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        ("Daily, take pictures of all trees.", "'daily'"),
        ("Every morning take a picture of every tree.", "'every morning'"),
        ("Take a picture of every tree tomorrow at 6.", "'tomorrow'"),
        ("Take pictures of all trees at 6 am.", "'6 am'"),
        ("Take pictures of all trees at 18:30.", "'at 18 : 30'"),
        ("Take pictures of all trees at six o'clock.", "'at six o'clock'"),
        ("Take pictures of all trees, but only on weekdays.", "'on weekdays'"),
        ("Take pictures of all trees before sunrise.", "'before sunrise'"),
        ("Take pictures of all trees every 2 hours.", "'every 2 hours'"),
        ("Take pictures of all trees twice a week.", "'twice a week'"),
        ("Photograph every tree. Do that again next Monday.", "'next monday'"),
        ("Skip those you photographed yesterday, and photograph all others.", "'yesterday'"),
    ],
)
def test_what_no_plan_can_hold_is_doubted(request_: str, said: str) -> None:
    assert [said in message for message in unheld(request_)] == [True]


@pytest.mark.parametrize(
    "request_",
    [
        "Good morning, please take a picture of every tree.",
        "We had a leak last week. Take a picture of every tree.",
        "Take a picture of every Sunday Gold tree.",
        "Take as many pictures as you can in 2 hours.",
        "Take pictures of all trees in 20 minutes at most.",
        "Take a picture of every second tree.",
        "Take a picture at 6 trees, and at 12 if the last one is hot.",
    ],
)
def test_what_only_looks_like_it_is_not(request_: str) -> None:
    assert unheld(request_) == []
