"""Work at several times of a day, at intervals, and again later."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

ROUND = "for UnionOf(GateIs(middle gate)+GateIs(farm gate)): [co2]"
AT_TIMES = [
    (GARDEN, HUSKY, "Monday to Friday, measure the air temperature at the rose bed at 7 am and once more at 2 pm.",
     "air @ PointsIn(rose bed) | at=07:00,14:00 weekdays=mon,tue,wed,thu,fri"),
    (PASTURE, HUSKY,
     "Read CO2 on the bank at 7 am and then again at 2 pm, every day.",
     "co2 @ PointsIn(bank) | at=07:00,14:00"),
    (PASTURE, HUSKY,
     "Three times a day, at 7 am, noon and 6 pm, read CO2 on the bank.",
     "co2 @ PointsIn(bank) | at=07:00,12:00,18:00"),
    (PASTURE, HUSKY,
     "Read CO2 on the bank every day at sunrise and once more at sunset.",
     "co2 @ PointsIn(bank) | at=sunrise,sunset"),
    (ORCHARD, HUSKY, "Photograph tree 4 tomorrow at 7 am and again at 2 pm.",
     "picture @ TreeIs(4) | at=07:00,14:00 first_day=tomorrow last_day=today"),
    (ORCHARD, HUSKY, "Photograph tree 4 tomorrow morning at 7 and in the evening at 6.",
     "picture @ TreeIs(4) | at=07:00,18:00 first_day=tomorrow last_day=today"),
    (ORCHARD, HUSKY,
     "Every morning at seven and every evening at six, photograph tree 4.",
     "picture @ TreeIs(4) | at=07:00,18:00"),
    (ORCHARD, HUSKY,
     "Every day at 7 am photograph tree 4, and again at 2 pm.",
     "picture @ TreeIs(4) | at=07:00,14:00"),
    (ORCHARD, HUSKY,
     "Photograph tree 4 daily: once at 7 am and once at 2 pm.",
     "picture @ TreeIs(4) | at=07:00,14:00"),
    (PASTURE, HUSKY,
     "Begin half an hour before sunrise and read CO2 at both gates. Repeat this round every hour until "
     "nine in the morning.",
     f"{ROUND} | at=sunrise-30 every_min=60 until=09:00"),
    (PASTURE, HUSKY, "Start at 6 am and read CO2 at both gates. Do the round again every hour until noon.",
     f"{ROUND} | at=06:00 every_min=60 until=12:00"),
    (PASTURE, HUSKY, "Read CO2 at both gates every hour, starting at six in the morning and ending at noon.",
     f"{ROUND} | at=06:00 every_min=60 until=12:00"),
    (PASTURE, HUSKY, "Tomorrow, read CO2 at both gates every two hours between 8 am and 6 pm.",
     f"{ROUND} | at=08:00 every_min=120 until=18:00 first_day=tomorrow last_day=today"),
    (PASTURE, TRACTOR,
     "Mow the bank tomorrow from ten o'clock and pause while the wind is above 8 metres per second.",
     "mow area InZone(bank) | day=tomorrow not_before=10:00 | return_to_start | at any time wind > 8 "
     "m/s: wait, then return_to_start"),
    (PASTURE, TRACTOR, "Mow the boggy corner on Friday at 7 am and come home if it rains.",
     "mow area InZone(boggy corner) | day=fri not_before=07:00 not_after=07:15 | return_to_start | at "
     "any time rain: return_to_start"),
    (ORCHARD, TRACTOR, "Spray row 4 tonight at ten and stop if someone is in the row.",
     "spray rows Rows(4, 4) | day=today not_before=22:00 not_after=22:15 | at any time person_near: wait, then end"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), AT_TIMES, ids=name)
def test_work_at_several_times(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(
    ("site", "robot", "request_", "why"),
    [
        (ORCHARD, HUSKY, "At 7 am photograph tree 4, and again at 2 pm photograph tree 9.", "not a time"),
        (ORCHARD, HUSKY, "Photograph tree 4 on Mondays at 7 am and on Fridays at 2 pm.", "not exactly enough"),
        (ORCHARD, HUSKY, "At 7 am photograph tree 4 and at 2 pm tree 9.", "not a time"),
    ],
    ids=name,
)
def test_times_of_different_work_are_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


def test_runs_until_a_time_are_asked_for_their_beginning() -> None:
    found = EnglishPlanner().plan("Read CO2 at both gates. Repeat the round every hour until 6 pm.", PASTURE, HUSKY)
    assert isinstance(found, Clarify), found
    assert found.question == "At what time of the day?"
