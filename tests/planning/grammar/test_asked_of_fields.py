"""Plants of a crop in several rows, neighbours of plants, and amounts without a number: planned, or asked about."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
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


#: Requests that say little or much and no number, with words of the question.
WITHOUT_A_NUMBER = [
    (GLASSHOUSE, TRACTOR, "Spray the melons, but not too much.", "rate: 50 to 800 l/ha (otherwise 300 l/ha)"),
    (GLASSHOUSE, TRACTOR, "Spray row 3 gently.", "rate: 50 to 800 l/ha"),
    (GLASSHOUSE, TRACTOR, "Gently spray the aubergines.", "rate: 50 to 800 l/ha"),
    (GLASSHOUSE, TRACTOR, "Spray row 3 a little less than usual.", "rate: 50 to 800 l/ha"),
    (GLASSHOUSE, TRACTOR, "Spray rows 1 and 2, a bit more than usual, then film row 4.", "rate: 50 to 800 l/ha"),
    (GARDEN, TRACTOR, "Spray bed 4 lightly.", "rate: 50 to 800 l/ha"),
    (DEMO, TRACTOR, "Spray rows 3 to 5 sparingly.", "rate: 50 to 800 l/ha"),
    (DEMO, TRACTOR, "Spray row 3 at a higher rate than usual.", "rate: 50 to 800 l/ha"),
    (GLASSHOUSE, AMIGA, "Read the moisture in row 3, not too deep.", "depth: 5 to 60 cm (otherwise 20 cm)"),
    (DEMO, AMIGA, "Nitrate at tree 4, a bit deeper than usual.", "depth: 5 to 60 cm"),
]

TAKEN_FROM_A_SIDE = [
    (
        GLASSHOUSE,
        "Trunk photos of the melons in row 3, taken from the south side.",
        "for Beside(south, of Where(crop, eq, melon, of Rows(3, 3))): [picture(view trunk)]",
    ),
    (
        GLASSHOUSE,
        "Photos of the aubergines, all taken from the north side.",
        "for Beside(north, of Where(crop, eq, aubergine)): [picture]",
    ),
    (GLASSHOUSE, "Photograph row 3, shot from the south.", "for Beside(south, of Rows(3, 3)): [picture]"),
    (GLASSHOUSE, "A picture of H3-2, taken from the south.", "picture @ Beside(south, of TreeIs(H3-2))"),
    (GARDEN, "Pictures of bed 4, taken from the east side.", "for Beside(east, of Rows(4, 4)): [picture]"),
    (
        GARDEN,
        "Photograph the squashes, taken from the west.",
        "for Beside(west, of Where(crop, eq, squash)): [picture]",
    ),
    (
        DEMO,
        "Pictures of the yellow trees, taken from the east side.",
        "for Beside(east, of Where(leaf_color, eq, yellow)): [picture]",
    ),
]

EACH_OF_ANOTHER = [
    (
        GLASSHOUSE,
        "Two leaf samples per cultivar, each from a different plant, and skip the Long Tom.",
        "for Quota(cultivar, 2, of Excluding(Where(cultivar, eq, Long Tom))): [sample_leaf]",
    ),
    (
        GLASSHOUSE,
        "Two leaf samples per cultivar, each from a different plant.",
        "for Quota(cultivar, 2): [sample_leaf]",
    ),
    (GLASSHOUSE, "Two leaf samples of each cultivar, from different plants.", "for Quota(cultivar, 2): [sample_leaf]"),
    (
        GLASSHOUSE,
        "Three leaf samples from the melons, no two from the same plant.",
        "for Take(3, of Where(crop, eq, melon)): [sample_leaf]",
    ),
    (
        GARDEN,
        "Take four pictures of the squashes, each of a different plant.",
        "for Take(4, of Where(crop, eq, squash)): [picture]",
    ),
    (GARDEN, "Five moisture readings in bed 2, each at a different plant.", "for Take(5, of Rows(2, 2)): [moisture]"),
    (DEMO, "Take three leaf samples in row 4, each from another tree.", "for Take(3, of Rows(4, 4)): [sample_leaf]"),
    (
        DEMO,
        "Three leaf samples from the yellow trees, each from a different tree.",
        "for Take(3, of Where(leaf_color, eq, yellow)): [sample_leaf]",
    ),
]

WHERE_THE_MAP_SAYS = [
    ("Read the soil moisture again wherever the map says less than 25.", "for Where(moisture, lt, 25): [moisture]"),
    ("Read the soil moisture wherever the map shows below 25 percent.", "for Where(moisture, lt, 25): [moisture]"),
    ("Measure the moisture where our records say under 25.", "for Where(moisture, lt, 25): [moisture]"),
    ("Wherever the map says more than 30, read the soil moisture.", "for Where(moisture, gt, 30): [moisture]"),
    (
        "Soil moisture in row 3 where the map says less than 26.",
        "for Where(moisture, lt, 26, of Rows(3, 3)): [moisture]",
    ),
    (
        "Read the moisture wherever the map says between 24 and 26.",
        "for Where(moisture, le, 26, of Where(moisture, ge, 24)): [moisture]",
    ),
    ("Photograph the plants wherever the map says moisture is below 25.", "for Where(moisture, lt, 25): [picture]"),
]

NOT_RECORDED = [
    (GLASSHOUSE, AMIGA, "Read the nitrate wherever the map says less than 22."),
    (GLASSHOUSE, AMIGA, "Take a picture wherever the map says less than 22."),
    (GARDEN, AMIGA, "Read the soil moisture wherever the map says less than 22."),
    (GLASSHOUSE, AMIGA, "Photograph row 3, taken from the east side."),
    (GLASSHOUSE, AMIGA, "Three leaf samples from H3-2, each from a different plant."),
    (GLASSHOUSE, AMIGA, "Take a picture of H3-2, but not too much."),
    (GLASSHOUSE, TRACTOR, "Film row 3, but not too much."),
    (GLASSHOUSE, TRACTOR, "Spray row 3 at 200 l/ha, but not too much."),
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


@pytest.mark.parametrize(("site", "robot", "request_text", "words"), WITHOUT_A_NUMBER, ids=name)
def test_asked_how_much(site: Site, robot: RobotProfile, request_text: str, words: str) -> None:
    outcome = EnglishPlanner().plan(request_text, site, robot)
    assert isinstance(outcome, Clarify), outcome
    assert words in str(outcome.question)


@pytest.mark.parametrize(
    ("site", "request_text", "plan"),
    [*TAKEN_FROM_A_SIDE, *EACH_OF_ANOTHER, *[(GLASSHOUSE, *one) for one in WHERE_THE_MAP_SAYS]],
    ids=name,
)
def test_sides_other_plants_and_the_map(site: Site, request_text: str, plan: str) -> None:
    require_plan(site, AMIGA, request_text, plan)


@pytest.mark.parametrize(("site", "robot", "request_text"), NOT_RECORDED, ids=name)
def test_not_planned(site: Site, robot: RobotProfile, request_text: str) -> None:
    assert not isinstance(EnglishPlanner().plan(request_text, site, robot), Planned)


@pytest.mark.parametrize(
    "request_text",
    [
        "In the mint do the same as last Tuesday.",
        "Do the same as last Tuesday.",
        "Do the same in row 3 as last week.",
        "Do the same as yesterday in row 3.",
        "In row 3, do the same thing as we did on Monday.",
        "Repeat last week's round.",
        "Do what you did last Tuesday.",
        "Same again as last Friday, please, but only in the melons.",
    ],
)
def test_asked_what_was_done(request_text: str) -> None:
    outcome = EnglishPlanner().plan(request_text, GLASSHOUSE, AMIGA)
    assert isinstance(outcome, Clarify), outcome
    assert "what is to be done?" in str(outcome.question)
    assert "read the soil moisture" in str(outcome.question)


def test_the_same_of_this_request_is_known() -> None:
    require_plan(
        GLASSHOUSE, AMIGA, "Take a picture of H3-2 and do the same at H3-3.",
        "picture @ TreeIs(H3-2); go TreeIs(H3-3); picture",
    )  # fmt: skip
