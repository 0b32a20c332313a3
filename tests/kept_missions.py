"""A small mission, approved once, for tests that keep it in a folder."""

from __future__ import annotations

from datetime import UTC, datetime
from functools import cache

from fieldhand import mission, missions
from fieldhand.approval.authorize import EveryWarning
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.site.geojson import open_site, site_files
from fieldhand.task.build import make_task
from fieldhand.task.codec import encode
from fieldhand.task.plan import Act
from fieldhand.task.selectors import TreeIs

WORLD = b"readings:\n  co2: 380\n"


@cache
def inputs() -> missions.Inputs:
    site, robot = open_site("demo"), load_robot("husky")
    plan = Act(id="", action="read_co2", at=TreeIs(tree="5"))
    task = make_task(request="Measure CO2 at tree 5.", plan=plan, measures={"read_co2": ("co2",)})
    at = datetime(2026, 1, 1, tzinfo=UTC)
    approved = mission.authorize(task, site, robot, by="tester", at=at, confirmed=EveryWarning())
    return missions.Inputs(
        task=encode(approved.task),
        site=site_files("demo").parts,
        robot=profile_bytes("husky")[0],
        authorization=approved.authorization,
        world=WORLD,
        seed=3,
    )
