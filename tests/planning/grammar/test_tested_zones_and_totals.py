"""Tests of readings in a zone, time to settle, limits "in all", and depths said behind what is measured."""

from __future__ import annotations

import pytest

from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture

GLASSHOUSE, PASTURE = glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

HOT, MILD = "Take(1, of InZone(hot bay))", "Take(1, of InZone(mild bay))"
BOTH = f"co2 @ {HOT} = r1; co2 @ {MILD}; if r1 > 900 ppm: [go {HOT}; wait 1800; co2]"
WIDE = "for UnionOf(PointsIn(bank)+PointsIn(boggy corner)): "
SERIES = "; ".join(["co2 @ PointsIn(bank)", *["wait 300; co2"] * 6])

TESTED = [
    ("Read the CO2 in both bays; if the hot bay is above 900 ppm, wait half an hour and read it again.", BOTH),
    ("CO2 in both bays; if the hot one is above 900 ppm, wait half an hour and read it again.", BOTH),
    ("CO2 in both bays. If the CO2 in the hot bay is over 900 ppm, wait half an hour and measure it again.", BOTH),
    (
        "CO2 in both bays. If it's above 900 ppm in the mild bay, wait ten minutes and read it again there.",
        f"co2 @ {HOT}; co2 @ {MILD} = r1; if r1 > 900 ppm: [wait 600; co2]",
    ),
    (
        "CO2 in the hot bay and in the mild bay; if the reading in the hot bay is over 900 ppm, measure it again.",
        "co2 @ PointsIn(hot bay) = r1; co2 @ PointsIn(mild bay); if r1 > 900 ppm: [go PointsIn(hot bay); co2]",
    ),
    (
        "If the air in the hot bay is above 35 degrees photograph all of row 3, otherwise just H3-1 and H3-8.",
        f"air @ {HOT} = r1; if r1 > 35 degC: [for Rows(3, 3): [picture]] else [for UnionOf(TreeIs(H3-1)+TreeIs(H3-8)): "
        "[picture]]",
    ),
    (
        "If the CO2 in the hot bay is below 400 ppm, photograph row 2; if not, only H3-1.",
        f"co2 @ {HOT} = r1; if r1 < 400 ppm: [for Rows(2, 2): [picture]] else [picture @ TreeIs(H3-1)]",
    ),
    (
        "When the air in the hot bay is over 30 degrees, wait ten minutes and measure it again.",
        f"air @ {HOT} = r1; if r1 > 30 degC: [wait 600; air]",
    ),
]
SETTLED = [
    ("Drive to the bank, let it settle for five minutes, read the air temperature.", 300),
    ("Go to the bank. Let the thermometer settle for two minutes. Read the air temperature.", 120),
    ("Go to the bank, give it five minutes to settle and read the air temperature.", 300),
    ("Go to the bank, allow five minutes for the sensor to settle, then read the air temperature.", 300),
    ("At the bank let it cool down for ten minutes, then read the air temperature.", 600),
]
PLANNED = [
    (HUSKY, "Go to the bank. Read the air temperature.", "go PointsIn(bank); air"),
    (HUSKY, "CO2 on the bank and in the boggy corner, a quarter of an hour in all.", f"{WIDE}[co2] | duration_s 900"),
    (HUSKY, "CO2 on the bank and in the boggy corner, half an hour in total.", f"{WIDE}[co2] | duration_s 1800"),
    (
        HUSKY,
        "CO2 on the bank and in the boggy corner. That should take 20 minutes all told.",
        f"{WIDE}[co2] | duration_s 1200",
    ),
    (HUSKY, "Read CO2 on the bank every 5 minutes, half an hour in all.", SERIES),
    (HUSKY, "Read CO2 on the bank every 5 minutes for half an hour in total.", SERIES),
    (
        AMIGA,
        "How wet is it on the bank and in the boggy corner? Probe 15 cm deep, whichever order is shortest.",
        f"{WIDE}[moisture(depth_cm 15)]",
    ),
    (AMIGA, "How dry is the bank? Measure at a depth of 15 cm.", "moisture(depth_cm 15) @ PointsIn(bank)"),
    (
        AMIGA,
        "Measure soil moisture on the bank and in the boggy corner. Take each reading at 30 cm.",
        f"{WIDE}[moisture(depth_cm 30)]",
    ),
    (
        AMIGA,
        "Measure soil moisture on the bank. Measure again 15 cm deep.",
        "moisture @ PointsIn(bank); moisture(depth_cm 15)",
    ),
]
ASKED = [
    (PASTURE, HUSKY, "Go to the bank, let it adjust, then read the air temperature.", 0),
    (PASTURE, AMIGA, "How wet is it on the bank? 15 cm deep.", 2),
]
REFUSED = [
    (
        GLASSHOUSE,
        HUSKY,
        "Read the CO2 at every plant in the hot bay; if the hot bay is above 900 ppm, read it again.",
        "which readings are tested",
    ),
]


@pytest.mark.parametrize(("request_", "plan"), TESTED, ids=name)
def test_the_reading_in_a_zone_is_tested(request_: str, plan: str) -> None:
    require_plan(GLASSHOUSE, HUSKY, request_, plan)


@pytest.mark.parametrize(("request_", "seconds"), SETTLED, ids=name)
def test_time_to_settle_is_a_wait(request_: str, seconds: int) -> None:
    require_plan(PASTURE, HUSKY, request_, f"go PointsIn(bank); wait {seconds}; air")


@pytest.mark.parametrize(("robot", "request_", "plan"), PLANNED, ids=name)
def test_planned(robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(PASTURE, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_asked(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


COMPARED = "co2 @ PointsIn(bank); co2 @ PointsIn(boggy corner)"


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Compare the CO2 in the middle of the bank with the middle of the boggy corner.", COMPARED),
        ("Compare the CO2 in the middle of the bank with that in the middle of the boggy corner.", COMPARED),
        ("Compare the CO2 on the bank with the boggy corner.", COMPARED),
        ("Compare the CO2 on the bank to that in the boggy corner.", COMPARED),
        ("Compare the CO2 between the bank and the boggy corner.", f"{WIDE}[co2]"),
        ("Compare the bank and the boggy corner for CO2.", f"{WIDE}[co2]"),
        (
            "Compare the air temperature at the cowslip patch with the one in the middle of the bank.",
            "air @ PointsIn(cowslip patch); air @ PointsIn(bank)",
        ),
        (
            "Compare the CO2 level at the middle gate with the level on the bank.",
            "co2 @ GateIs(middle gate); co2 @ PointsIn(bank)",
        ),
    ],
    ids=name,
)
def test_readings_are_compared(request_: str, plan: str) -> None:
    require_plan(PASTURE, HUSKY, request_, plan)


def test_several_readings_are_not_compared_with_an_unknown_number() -> None:
    require_refusal(PASTURE, HUSKY, "Compare six random CO2 readings on the bank with the boggy corner.", "compare")


NORTH_HALF = "mow area Half(north, of InZone(cow paddock))"


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Mow the north half of the cow paddock, I'll do the rest on Friday.", NORTH_HALF),
        ("Mow the north half of the cow paddock and I'll do the rest on Friday.", NORTH_HALF),
        ("Mow the north half of the cow paddock. We'll mow the other half on Saturday.", NORTH_HALF),
        ("Mow the north half of the cow paddock, the rest can wait until Friday.", NORTH_HALF),
        ("Mow the north half of the cow paddock; my neighbour will take care of the rest tomorrow.", NORTH_HALF),
        ("Mow the north half of the cow paddock, leave the rest to me.", NORTH_HALF),
        ("Mow the north half of the cow paddock, I will do the remainder by hand.", NORTH_HALF),
        ("Mow the north half of the cow paddock today, I'll do the rest on Friday.", f"{NORTH_HALF} | day=today"),
    ],
    ids=name,
)
def test_what_others_do_with_the_rest_asks_for_nothing(request_: str, plan: str) -> None:
    require_plan(PASTURE, TRACTOR, request_, plan)


def test_which_half_is_asked_beside_what_others_do() -> None:
    require_question(PASTURE, TRACTOR, "Mow half of the cow paddock today, I'll do the rest on Friday.", 4)


@pytest.mark.parametrize(
    "request_",
    [
        "Mow the bank. I'll need the rest mown on Friday.",
        "Mow the north half of the cow paddock, then do the rest on Friday.",
        "Mow the bank. The rest can be done on Friday.",
    ],
)
def test_work_that_the_robot_may_be_asked_for_later_is_refused(request_: str) -> None:
    require_refusal(PASTURE, TRACTOR, request_, "on Friday")
