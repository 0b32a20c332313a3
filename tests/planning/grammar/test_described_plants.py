"""Plants by what they have or lack ("under covers"), their neighbours, the best of them, and the ends of rows."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import require_plan, require_question, require_refusal
from support.sites.gardens import box, glasshouse, mark, pasture, vegetable_garden
from support.sites.points import read

GARDEN, GLASS, PASTURE, DEMO = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
AMIGA, HUSKY, TRACTOR = load_robot("amiga"), load_robot("husky"), load_robot("tractor")


def _frame() -> Site:
    """Two rows of six lettuces, of which the second is covered, and of which the third and the last have rust."""
    plants = [
        mark(
            5.0 + 3.0 * row, 8.0 + 2.0 * k, kind="plant", id=f"L{row}{k + 1}", row=row, crop="lettuce",
            covered=row == 2, rust=k in (2, 5) and row == 1,
        )
        for row in (1, 2)
        for k in range(6)
    ]  # fmt: skip
    return read(box(0, 0, 40, 40, kind="boundary", name="plot"), *plants, mark(2, 2, kind="start", name="hut"))


FRAME = _frame()
COVERED = "for Where(covered, eq, True): [picture]"
BARE = "for Where(covered, eq, False): [picture]"
SOUND = "for Where(rust, eq, False): [picture]"
OLDEST = "for UnionOf(Top(age_years, 1)+AlongRow(1, Top(age_years, 1))+AlongRow(1, up, Top(age_years, 1))): [picture]"
ENDS = "for UnionOf(InRow(1, 1, of Rows)+InRow(-1, -1, of Rows)): [picture]"
LEAVES = (
    "sample_leaf @ Top(height_cm, 1, of Where(crop, eq, bean)); for UnionOf(AlongRow(1)+AlongRow(1, up)): [sample_leaf]"
)
RUSTY = "for UnionOf(Where(rust, eq, True, of Where(crop, eq, lettuce))+TreeIs(L12)+TreeIs(L15)): [picture]"

PLANNED = [
    (FRAME, AMIGA, "Photograph every plant that is under covers.", COVERED),
    (FRAME, AMIGA, "Photograph every plant under a cover.", COVERED),
    (FRAME, AMIGA, "Photograph every plant that has a cover on it.", COVERED),
    (FRAME, AMIGA, "Photograph the plants with covers.", COVERED),
    (FRAME, AMIGA, "Photograph the covered ones.", COVERED),
    (FRAME, AMIGA, "Photograph the plants that have no cover.", BARE),
    (FRAME, AMIGA, "Photograph every plant without a cover.", BARE),
    (FRAME, AMIGA, "Photograph every healthy plant.", SOUND),
    (FRAME, AMIGA, "Photograph the plants that have no rust.", SOUND),
    (FRAME, AMIGA, "Photograph each lettuce that has rust and also the nearest healthy plant beside it.", RUSTY),
    (FRAME, AMIGA, "Photograph every diseased lettuce and the nearest one without rust.", RUSTY),
    (
        GARDEN, AMIGA, "Photograph every third bean under a net.",
        "for Where(netted, eq, True, of EveryNth(3, of Where(crop, eq, bean))): [picture]",
    ),
    (GARDEN, AMIGA, "Clip a leaf off the tallest bean and off the one on each side of it in the row.", LEAVES),
    (GARDEN, AMIGA, "Take a leaf sample from the tallest bean and from the ones to the left and right of it.", LEAVES),
    (DEMO, HUSKY, "Photograph the oldest tree and the one on each side of it.", OLDEST),
    (DEMO, HUSKY, "Photograph the oldest tree and the trees directly before and after it.", OLDEST),
    (GARDEN, AMIGA, "Photograph the plants at the two ends of every row.", ENDS),
    (GARDEN, AMIGA, "Photograph the plants at each end of every bed.", ENDS),
    (
        DEMO, HUSKY, "Photograph the trees at the two ends of row 4.",
        "for UnionOf(InRow(1, 1, of Rows(4, 4))+InRow(-1, -1, of Rows(4, 4))): [picture]",
    ),
    (GARDEN, AMIGA, "Photograph every third bean again.", "for EveryNth(3, of Where(crop, eq, bean)): [picture]"),
    (PASTURE, TRACTOR, "Film the fence.", "film perimeter InZone(sheep fence)"),
    (PASTURE, HUSKY, "Patrol the fence twice.", "drive perimeter InZone(sheep fence), 2 laps"),
    (DEMO, HUSKY, "Patrol the fence twice.", "drive perimeter Trees, 2 laps"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED)
def test_plants_are_described(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


ASKED = [
    (GLASS, AMIGA, "Take leaf samples from the best aubergines.", 6),
    (GLASS, AMIGA, "Take leaf samples from the three best aubergines.", 2),
    (FRAME, HUSKY, "Check the covered ones again.", 3),
    (GARDEN, HUSKY, "Measure the beans again.", 3),
]


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED)
def test_what_a_description_leaves_open_is_asked(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


HOW_MANY = [
    (PASTURE, AMIGA, "Take some moisture samples along the fence.", 3),
    (PASTURE, AMIGA, "Take moisture samples on the bank.", 0),
    (PASTURE, AMIGA, "Take some soil moisture readings on the bank.", 3),
    (GLASS, AMIGA, "Bring me some leaf samples from the mild bay.", 3),
    (GLASS, HUSKY, "Read the air temperature in the middle of the bay.", 2),
]


HELD_TO = [
    (PASTURE, "Measure CO2 on the bank and keep off the boggy corner.",
     "co2 @ PointsIn(bank) | avoid InZone(boggy corner)"),
    (PASTURE, "Use the farm gate, not the middle one, and measure CO2 on the bank.",
     "co2 @ PointsIn(bank) | only farm gate"),
    (PASTURE, "Measure CO2 on the bank and keep away from the pond.", "co2 @ PointsIn(bank) | avoid InZone(pond)"),
]  # fmt: skip


@pytest.mark.parametrize(("site", "request_", "plan"), HELD_TO)
def test_ground_and_gates_to_keep_off_are_no_places_of_work(site: Site, request_: str, plan: str) -> None:
    require_plan(site, HUSKY, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), HOW_MANY)
def test_a_number_of_readings_in_a_zone_is_asked_for(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


SHARED_OUT = [
    ("Two thermal pictures of the pond, one from the north side and one from the south.",
     "picture @ Transect(1, edge, pond, north); picture @ Transect(1, edge, pond, south)"),
    ("Take two CO2 readings, one on the bank and one in the boggy corner.",
     "co2 @ PointsIn(bank); co2 @ PointsIn(boggy corner)"),
    ("Take two CO2 readings on the bank, one in the boggy corner and one in the cowslip patch.",
     "for PointsIn(bank, 2): [co2]; co2 @ PointsIn(boggy corner); co2 @ PointsIn(cowslip patch)"),
]  # fmt: skip


@pytest.mark.parametrize(("request_", "plan"), SHARED_OUT)
def test_a_number_is_shared_out_among_the_places_behind_it(request_: str, plan: str) -> None:
    require_plan(PASTURE, HUSKY, request_, plan)


@pytest.mark.parametrize(
    ("request_", "speed"), [("Film the melons at half speed.", 0.4), ("Mow the bank at half speed.", 0.55)]
)
def test_half_speed_is_half_of_the_speed_of_work(request_: str, speed: float) -> None:
    site = GLASS if "melons" in request_ else PASTURE
    planned = EnglishPlanner().plan(request_, site, TRACTOR)
    assert isinstance(planned, Planned)
    assert planned.task.constraints.speed_m_s == speed


def test_healthy_is_unknown_where_no_disease_is_recorded() -> None:
    require_refusal(GARDEN, AMIGA, "Photograph every healthy bean.", "healthy")
    assert not isinstance(EnglishPlanner().plan("Photograph every plant under glass.", FRAME, AMIGA), Planned)
