"""Plants of a kind that are named by their ids, views by other words, and where the robot is met when it is done."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.english.outlines import outline
from planning.grammar.field_requests import name, require_plan, require_question, require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

DEMO, GARDEN, GLASSHOUSE, PASTURE = open_site("demo"), vegetable_garden(), glasshouse(), pasture()
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")
TWO = "for UnionOf(TreeIs(H1-3)+TreeIs(H1-5)): [picture]"
THREE = "for UnionOf(TreeIs(H1-3)+TreeIs(H1-4)+TreeIs(H1-5)): [picture]"
MET = "picture @ TreeIs(H1-3); go PointsIn(seedling table) | stay"
ROW_OR_BESIDE = (
    "co2 @ TreeIs(H1-3) = r1; if r1 > 500 ppm: [for Excluding(TreeIs(H1-3), of RowOf): [co2]]"
    " else [for Nearest(Here, 2, True): [co2]]"
)

PLANNED = [
    (GLASSHOUSE, AMIGA, "photograph aubergine H1-3", "picture @ TreeIs(H1-3)"),
    (GLASSHOUSE, AMIGA, "photograph aubergines H1-3 and H1-5", TWO),
    (GLASSHOUSE, AMIGA, "photograph the aubergines H1-3 and H1-5", TWO),
    (GLASSHOUSE, AMIGA, "photograph the aubergines from H1-3 to H1-5", THREE),
    (GLASSHOUSE, AMIGA, "photograph plants H1-3 to H1-5", THREE),
    (GLASSHOUSE, AMIGA, "photograph plants H1-3, H1-4 and so on up to H1-5", THREE),
    (
        GLASSHOUSE,
        AMIGA,
        "read the moisture at 30 cm by aubergines H1-3 and H1-5",
        TWO.replace("picture", "moisture(depth_cm 30)"),
    ),
    (GLASSHOUSE, AMIGA, "photograph the mint H4-2", "picture @ TreeIs(H4-2)"),
    (GLASSHOUSE, AMIGA, "photograph mint H4-2 and melon H3-1", "for UnionOf(TreeIs(H4-2)+TreeIs(H3-1)): [picture]"),
    (GLASSHOUSE, AMIGA, "photograph the stem of H1-3", "picture(view trunk) @ TreeIs(H1-3)"),
    (GLASSHOUSE, AMIGA, "photograph the stem of H1-3, using the trunk view", "picture(view trunk) @ TreeIs(H1-3)"),
    (
        GLASSHOUSE,
        AMIGA,
        "take pictures of the stems of all melons",
        "for Where(crop, eq, melon): [picture(view trunk)]",
    ),
    (GLASSHOUSE, AMIGA, "stem photos of H1-3", "picture(view trunk) @ TreeIs(H1-3)"),
    (GLASSHOUSE, AMIGA, "photograph the foliage of H1-3", "picture(view canopy) @ TreeIs(H1-3)"),
    (GLASSHOUSE, AMIGA, "photograph H1-3 in the ground view", "picture(view ground) @ TreeIs(H1-3)"),
    (GLASSHOUSE, AMIGA, "photograph H1-3 using the ground view", "picture(view ground) @ TreeIs(H1-3)"),
    (GLASSHOUSE, AMIGA, "take a trunk view of H1-3", "picture(view trunk) @ TreeIs(H1-3)"),
    (GLASSHOUSE, AMIGA, "take two ground views of H1-3", "picture(view ground) x2 @ TreeIs(H1-3)"),
    (GLASSHOUSE, AMIGA, "photograph H1-3 and meet me at the seedling table", MET),
    (GLASSHOUSE, AMIGA, "photograph H1-3, then come and find me at the seedling table", MET),
    (GLASSHOUSE, AMIGA, "photograph H1-3 and wait for me at the seedling table when you are done", MET),
    (GLASSHOUSE, AMIGA, "When you are done photographing H1-3, meet me at the seedling table.", MET),
    (GLASSHOUSE, AMIGA, "photograph H1-3 and finish at the seedling table", MET),
    (GLASSHOUSE, AMIGA, "photograph H1-3 and park at the seedling table", MET),
    (GLASSHOUSE, AMIGA, "photograph H1-3, then drive to the seedling table", MET.removesuffix(" | stay")),
    (GLASSHOUSE, AMIGA, "photograph H1-3 and go to H2-1 at the end", "picture @ TreeIs(H1-3); go TreeIs(H2-1)"),
    (
        PASTURE,
        HUSKY,
        "read CO2 in the middle of the bank and meet me at the farm gate",
        "co2 @ PointsIn(bank); go GateIs(farm gate) | stay",
    ),
    (
        PASTURE,
        HUSKY,
        "read CO2 in the middle of the bank and come to the farm gate",
        "co2 @ PointsIn(bank); go GateIs(farm gate)",
    ),
    (
        PASTURE,
        TRACTOR,
        "mow the bank, then park on the cowslip patch",
        "mow area InZone(bank); go PointsIn(cowslip patch) | stay",
    ),
    (DEMO, HUSKY, "photograph tree 4 and meet me at tree 9", "picture @ TreeIs(4); go TreeIs(9) | stay"),
    (
        GLASSHOUSE,
        HUSKY,
        "Read CO2 at H1-3. If it is above 500 ppm, continue with all the other plants in that row,"
        " otherwise only with its two neighbours.",
        ROW_OR_BESIDE,
    ),
]

ASKED = [
    (PASTURE, HUSKY, "read CO2 in the middle of the bank and meet me at the gate", 2),
    (DEMO, HUSKY, "photograph tree 4, then wait at the charger", 0),
    (DEMO, HUSKY, "photograph tree 4, wait at tree 9", 0),
]

REFUSED = [
    (GLASSHOUSE, AMIGA, "photograph melon H1-3", "not all of these plants are of that kind"),
    (GLASSHOUSE, AMIGA, "meet me at the seedling table, then photograph H1-3", "something follows the end"),
    (DEMO, HUSKY, "photograph tree 4 and meet me", "to follow or lead somebody"),
    (DEMO, HUSKY, "photograph tree 4 and come to me", "to follow or lead somebody"),
    (DEMO, HUSKY, "photograph tree 4 and follow me", "to follow or lead somebody"),
    (DEMO, HUSKY, "photograph tree 5. Meet me at the start, then photograph tree 4.", "something follows the end"),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), PLANNED, ids=name)
def test_named_plants_and_ends_are_planned(site: Site, robot: RobotProfile, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


@pytest.mark.parametrize(("site", "robot", "request_", "ways"), ASKED, ids=name)
def test_open_ends_are_asked_about(site: Site, robot: RobotProfile, request_: str, ways: int) -> None:
    require_question(site, robot, request_, ways)


@pytest.mark.parametrize(("site", "robot", "request_", "why"), REFUSED, ids=name)
def test_other_names_and_ends_are_refused(site: Site, robot: RobotProfile, request_: str, why: str) -> None:
    require_refusal(site, robot, request_, why)


def test_a_correction_is_no_wait() -> None:
    outcome = EnglishPlanner().plan("photograph tree 4, wait, tree 9", DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert outline(outcome.task).startswith("picture @ TreeIs(9)")


VIEWS = [
    (
        PASTURE,
        "photograph the ground every 5 m along the edge of the bank",
        "for Transect(5, edge, bank): [picture(view ground)]",
    ),
    (
        PASTURE,
        "photograph the ground along the edge of the bank, every 5 m",
        "for Transect(5, edge, bank): [picture(view ground)]",
    ),
    (
        PASTURE,
        "every 5 m along the edge of the bank, photograph the ground",
        "for Transect(5, edge, bank): [picture(view ground)]",
    ),
    (PASTURE, "photograph the ground at eight points on the bank", "for PointsIn(bank, 8): [picture(view ground)]"),
    (GLASSHOUSE, "photograph the ground every 2 m along row 4", "for Spaced(2, of Rows(4, 4)): [picture(view ground)]"),
    (GLASSHOUSE, "photograph the trunk of H1-3 twice", "picture(view trunk) x2 @ TreeIs(H1-3)"),
    (GLASSHOUSE, "photograph the trunks in row 4", "for Rows(4, 4): [picture(view trunk)]"),
    (GLASSHOUSE, "at H1-3, photograph the trunk", "go TreeIs(H1-3); picture(view trunk)"),
    (
        GLASSHOUSE,
        "at each melon photograph the ground and take a leaf",
        "for Where(crop, eq, melon): [picture(view ground); sample_leaf]",
    ),
]


@pytest.mark.parametrize(("site", "request_", "plan"), VIEWS, ids=name)
def test_a_part_is_photographed_wherever_pictures_are_taken(site: Site, request_: str, plan: str) -> None:
    require_plan(site, AMIGA, request_, plan)
