"""A small mission, approved once, for tests that keep it in a folder."""

from __future__ import annotations

from datetime import datetime
from functools import cache

from fieldhand import mission, missions
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
from fieldhand.execution.drivers.simulation.world_file import decode_world
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.loader import parse_profile, profile_bytes
from fieldhand.site.loader import site_files, site_of
from fieldhand.task.build import make_task
from fieldhand.task.plan import Act

WORLD = b"readings:\n  co2: 380\n"


@cache
def inputs() -> missions.Inputs:
    files, (profile, source) = site_files("demo"), profile_bytes("husky")
    site, robot = site_of(files), parse_profile(profile, source=source)
    plan = Act(id="", action="read_co2", at=TreeIs(tree="5"))
    task = make_task(request="Measure CO2 at tree 5.", plan=plan, measures={"read_co2": ("co2",)})
    at = datetime(2026, 1, 1, tzinfo=UTC)
    approved = mission.authorize(mission.review(task, site, robot), by="tester", at=at, confirmed=EveryWarning())
    return missions.Inputs(
        authorized=approved.authorized,
        site=site,
        robot=robot,
        files=files,
        profile=profile,
        world=decode_world(WORLD, source="world.yaml"),
        seed=3,
    )
