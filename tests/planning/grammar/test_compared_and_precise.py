"""Questions which of two places has more, with the readings that answer them, and means wanted with a precision."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import require_plan, require_question
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASS, PASTURE = vegetable_garden(), glasshouse(), pasture()
DEMO, VINES = open_site("demo"), open_site("vineyard")
AMIGA, HUSKY = load_robot("amiga"), load_robot("husky")

SPOTS = "for UnionOf(PointsIn(bank, 6, True)+PointsIn(boggy corner, 6, True)): [{}]"
BEDS = "for UnionOf(Evenly(5, of Rows(1, 1))+Evenly(5, of Rows(3, 3))): [air]"
BEANS = (
    "for UnionOf(RandomSample(4, of Where(crop, eq, bean))+RandomSample(4, 1, of Where(crop, eq, kale))): [moisture]"
)
STAKED = (
    "for UnionOf(RandomSample(8, of Where(staked, eq, True))"
    "+RandomSample(8, 1, of Where(staked, eq, False))): [picture]"
)

COMPARED = [
    (
        PASTURE, AMIGA,
        "Is there more nitrate on the bank than in the boggy corner? Check six random "
        "spots in each of them.",
        SPOTS.format("nitrate"),
    ),
    (
        PASTURE, AMIGA, "Has the bank got more nitrate than the boggy corner? Six random spots each.",
        SPOTS.format("nitrate"),
    ),
    (
        PASTURE, AMIGA, "Is the bank drier than the boggy corner? Check six random spots in each.",
        SPOTS.format("moisture"),
    ),
    (
        PASTURE, AMIGA,
        "Find out whether the bank is drier than the boggy corner, using six random "
        "spots in each.",
        SPOTS.format("moisture"),
    ),
    (
        PASTURE, AMIGA, "Which is drier, the bank or the boggy corner? Check six random spots in each.",
        SPOTS.format("moisture"),
    ),
    (GARDEN, HUSKY, "Is it warmer in bed 1 than in bed 3? Take five air temperature readings in each.", BEDS),
    (
        GARDEN, AMIGA,
        "Is the soil drier under the beans than under the kale? Measure four random "
        "plants of each.",
        BEANS,
    ),
    (
        GLASS, HUSKY,
        "Find out whether the staked plants have cooler leaves than the unstaked ones, "
        "using eight random plants of each kind.",
        STAKED,
    ),
    (
        GLASS, HUSKY,
        "Are the staked plants cooler than the unstaked ones? Take a thermal picture of "
        "eight random plants of each kind.",
        STAKED,
    ),
    (
        DEMO, HUSKY, "Does row 3 have warmer leaves than row 5? Take two thermal pictures in each.",
        "for UnionOf(Evenly(2, of Rows(3, 3))+Evenly(2, of Rows(5, 5))): [picture]",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), COMPARED)
def test_a_comparison_is_answered_by_readings(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


def test_either_temperature_may_be_compared() -> None:
    require_question(DEMO, HUSKY, "Is row 3 hotter than row 5? Check five random trees in each.", 2)


UNANSWERED = [
    (PASTURE, AMIGA, "Is the bank drier than the boggy corner?"),
    (PASTURE, AMIGA, "Is the bank steeper than the boggy corner? Check six random spots in each."),
    (PASTURE, HUSKY, "Is there more nitrate on the bank than in the boggy corner? Take six CO2 readings in each."),
]


@pytest.mark.parametrize(("site", "robot", "request_"), UNANSWERED)
def test_a_comparison_without_its_readings_is_no_plan(site: Site, robot: RobotProfile, request_: str) -> None:
    assert not isinstance(EnglishPlanner().plan(request_, site, robot), Planned)


KNOWN = "at most 20 until mean(r1) +- 2 % from 5: [nitrate = r1]"
DRAWN = f"for RandomSample(6, of Where(crop, eq, bean)) at most 6 {KNOWN.partition('20 ')[2]}"

PRECISE = [
    (
        GARDEN, AMIGA,
        "I want the average soil nitrate of the beans to within 2 percent, from "
        "randomly picked plants, with no more than 6 readings.",
        DRAWN,
    ),
    (
        GARDEN, AMIGA,
        "Determine the mean soil nitrate of the beans to within 2 percent, taking at "
        "most 6 readings at random plants.",
        DRAWN,
    ),
    (
        GARDEN, AMIGA,
        "Find the mean soil nitrate of the beans, accurate to 2 percent, from at most 6 "
        "random plants.",
        DRAWN,
    ),
    (
        GARDEN, AMIGA,
        "Get me the average soil nitrate of beds 1 to 4 to within 2 percent, at most 20 "
        "readings.",
        f"for Rows(1, 4) {KNOWN}",
    ),
    (
        PASTURE, AMIGA, "Get me the average soil nitrate of the bank to within 2 percent, at most 20 readings.",
        f"for PointsIn(bank, 20, True) {KNOWN}",
    ),
    (
        PASTURE, AMIGA,
        "I want to know the average soil nitrate of the bank to within 2 percent, with "
        "no more than 20 random readings.",
        f"for PointsIn(bank, 20, True) {KNOWN}",
    ),
    (
        VINES, AMIGA, "Give me the mean soil nitrate of the meadow to within 2 percent; 20 readings at most.",
        f"for PointsIn(meadow, 20, True) {KNOWN}",
    ),
    (
        DEMO, HUSKY, "I need the average CO2 of row 4 to within 5 percent, using no more than 12 trees.",
        "for Rows(4, 4) at most 12 until mean(r1) +- 5 % from 5: [co2 = r1]",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PRECISE)
def test_a_mean_is_wanted_with_a_precision(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)
