"""Plants of a crop in several rows, neighbours of plants, and amounts without a number: planned, or asked about."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from planning.grammar.field_requests import name, require_plan, require_question
from support.sites.gardens import glasshouse, vegetable_garden

GLASSHOUSE, GARDEN, DEMO = glasshouse(), vegetable_garden(), open_site("demo")
HUSKY, AMIGA, TRACTOR = load_robot("husky"), load_robot("amiga"), load_robot("tractor")

CODES_BEHIND_THRESHOLDS = [
    (
        "Check the soil moisture 10 cm down at H1-4, and if it is under 18 percent do H1-3 and H1-5 too.",
        "moisture(depth_cm 10) @ TreeIs(H1-4) = r1; "
        "if r1 < 18 percent: [for UnionOf(TreeIs(H1-3)+TreeIs(H1-5)): [moisture(depth_cm 10)]]",
    ),
    (
        "Read the moisture at H3-2. If it's below 20 %, do H3-3 as well.",
        "moisture @ TreeIs(H3-2) = r1; if r1 < 20 percent: [go TreeIs(H3-3); moisture = r2]",
    ),
    (
        "Nitrate at H1-4; if it is less than 20 ppm, also H1-5.",
        "nitrate @ TreeIs(H1-4) = r1; if r1 < 20 ppm: [nitrate @ TreeIs(H1-5)]",
    ),
]

#: Requests with the number of plants that they may mean.
COUNTED_IN_ONE_OF_THEM = [
    (GARDEN, "Take a picture of the third potato.", 2),
    (GARDEN, "Measure the moisture at the last potato.", 2),
    (GARDEN, "Photograph the first three potatoes.", 2),
    (GARDEN, "Leaf sample from the 5th potato, please.", 2),
    (GARDEN, "Take a picture of the second potato from the north.", 2),
    (GARDEN, "Take pictures of the first and the last potato.", 2),
    (GARDEN, "Take a picture of potato 3.", 2),
    (GARDEN, "Photograph potatoes 3 and 5.", 2),
    (GLASSHOUSE, "Photograph the fifth aubergine.", 2),
    (DEMO, "Take a picture of the third Nonpareil.", 4),
    (DEMO, "Measure the moisture at the last Carmel.", 5),
]

COUNTED_IN_THEIR_ROW = [
    (GARDEN, "Take a picture of the third radish.", "picture @ InRow(3, 3, of Where(crop, eq, radish, of Rows(3, 3)))"),
    (GARDEN, "Photograph the 3rd potato of bed 2.", "picture @ InRow(3, 3, of Where(crop, eq, potato, of Rows(2, 2)))"),
    (GARDEN, "Take a picture of radish 3.", "picture @ InRow(3, 3, of Where(crop, eq, radish, of Rows(3, 3)))"),
]  # fmt: skip

_NEXT = "UnionOf(TreeIs(V58)+TreeIs(V56)+TreeIs(V54)+TreeIs(V52))"

NEIGHBOURS = [
    (GARDEN, "Thermal pictures of the plants right beside the ones with frost damage.", f"for {_NEXT}: [picture]"),
    (GARDEN, "Read CO2 at the neighbours of the plants with frost damage.", f"for {_NEXT}: [co2]"),
    (GARDEN, "CO2 at the plants on either side of those with frost damage.", f"for {_NEXT}: [co2]"),
    (GARDEN, "CO2 at the squashes next to the ones with frost damage.", f"for {_NEXT}: [co2]"),
    (
        GARDEN,
        "Thermal picture of the plants next to those with frost damage, not of the ones with frost damage themselves.",
        f"for Excluding(Where(frost_damage, eq, True), of {_NEXT}): [picture]",
    ),
    (
        GARDEN,
        "CO2 at the plants beside those with frost damage, but not at the ones with frost damage themselves.",
        f"for Excluding(Where(frost_damage, eq, True), of {_NEXT}): [co2]",
    ),
    (
        GARDEN,
        "CO2 at the plants next to V53 and V57.",
        "for UnionOf(AlongRow(1, TreeIs(V53))+AlongRow(1, up, TreeIs(V53))"
        "+AlongRow(1, TreeIs(V57))+AlongRow(1, up, TreeIs(V57))): [co2]",
    ),
    (
        DEMO,
        "CO2 at the trees beside trees 40 and 60.",
        "for UnionOf(AlongRow(1, TreeIs(40))+AlongRow(1, up, TreeIs(40))"
        "+AlongRow(1, TreeIs(60))+AlongRow(1, up, TreeIs(60))): [co2]",
    ),
]


@pytest.mark.parametrize(("request_text", "plan"), CODES_BEHIND_THRESHOLDS, ids=name)
def test_codes_behind_thresholds(request_text: str, plan: str) -> None:
    require_plan(GLASSHOUSE, AMIGA, request_text, plan)


@pytest.mark.parametrize(("site", "request_text", "ways"), COUNTED_IN_ONE_OF_THEM, ids=name)
def test_asked_in_which_row(site: Site, request_text: str, ways: int) -> None:
    require_question(site, AMIGA, request_text, ways)


@pytest.mark.parametrize(("site", "request_text", "plan"), COUNTED_IN_THEIR_ROW, ids=name)
def test_counted_in_the_row_of_their_crop(site: Site, request_text: str, plan: str) -> None:
    require_plan(site, AMIGA, request_text, plan)


@pytest.mark.parametrize("request_text", ["Take a picture of the 30th potato.", "Photograph the third netted plant."])
def test_plants_that_no_row_can_count(request_text: str) -> None:
    assert not isinstance(EnglishPlanner().plan(request_text, GARDEN, AMIGA), Planned)


@pytest.mark.parametrize(("site", "request_text", "plan"), NEIGHBOURS, ids=name)
def test_neighbours_of_several(site: Site, request_text: str, plan: str) -> None:
    require_plan(site, HUSKY, request_text, plan)


@pytest.mark.parametrize(
    "request_text", ["CO2 at the trees next to the yellow ones.", "CO2 at the neighbours of the yellow trees."]
)
def test_neighbours_that_are_among_them(request_text: str) -> None:
    require_question(DEMO, HUSKY, request_text, 2)
