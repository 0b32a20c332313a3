"""How requests are opened, ordered, repeated and corrected, and what depends on readings: plans of everyday wording."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO = open_site("demo")
PICTURE = "picture @ TreeIs(4)"
BOTH = "picture @ TreeIs(4); co2 @ TreeIs(9)"


def plan_of(request: str, robot: str = "husky") -> str | None:
    found = composed(request, DEMO, load_robot(robot))
    return outline(found.task) if isinstance(found, Planned) else None


@pytest.mark.parametrize(
    "request_",
    [
        "I want you to photograph tree 4.",
        "I need you to go ahead and photograph tree 4.",
        "We want the robot to photograph tree 4.",
        "Tell the robot to photograph tree 4.",
        "Your task: photograph tree 4.",
        "Today we photograph tree 4.",
        "Job for today: photograph tree 4.",
        "It is time to photograph tree 4.",
        "Photograph tree 4 please, thank you very much.",
        "Photograph tree 4 asap.",
        "The boss says photograph tree 4.",
        "It would be great if you could photograph tree 4.",
        "Would you mind photographing tree 4?",
        "I was wondering if you could photograph tree 4.",
        "Don't forget to photograph tree 4.",
        "So, uh, photograph tree 4.",
        "Ok robot, let's get started: photograph tree 4.",
        "Good morning! Photograph tree 4.",
        "Oh, and photograph tree 4 too.",
    ],
)
def test_openings_and_closings_ask_for_nothing(request_: str) -> None:
    assert plan_of(request_) == PICTURE


@pytest.mark.parametrize(
    "request_",
    [
        "1) photograph tree 4 2) measure CO2 at tree 9",
        "1. Photograph tree 4.\n2. Measure CO2 at tree 9.",
        "1. Photograph tree 4. 2. Measure CO2 at tree 9.",
        "(1) photograph tree 4, (2) measure CO2 at tree 9",
        "- photo of tree 4\n- CO2 at tree 9",
        "Please do the following:\n* photo of tree 4\n* CO2 at tree 9",
        "Two things: photograph tree 4 and measure CO2 at tree 9.",
        "a) photo of tree 4, b) CO2 at tree 9",
        "1 - photograph tree 4\n2 - measure CO2 at tree 9",
        "First: photograph tree 4. Second: measure CO2 at tree 9.",
    ],
)
def test_marks_of_a_list_say_the_order(request_: str) -> None:
    assert plan_of(request_) == BOTH


@pytest.mark.parametrize("request_", ["Take a picture of trees (1) and (2).", "Photograph row 1. 2. 3."])
def test_numbers_of_places_are_no_marks_of_a_list(request_: str) -> None:
    assert plan_of(request_) is None


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph row 6, every tree. For those above 36, measure CO2.", "for Rows(6, 6): [picture = r1; if r1 > 36 degC: [co2]]"),
        ("Measure CO2 at all trees in row 2 and photograph any that come back over 450.", "for Rows(2, 2): [co2 = r1; if r1 > 450 ppm: [picture]]"),
        ("Measure CO2 at all trees in row 2 and photograph the ones above 450.", "for Rows(2, 2): [co2 = r1; if r1 > 450 ppm: [picture]]"),
        ("Photograph tree 5 if and only if its CO2 is above 450 ppm.", "co2 @ TreeIs(5) = r1; if r1 > 450 ppm: [picture]"),
        ("Measure CO2 at tree 30 only if the canopy temperature is above 36 °C.", "picture @ TreeIs(30) = r1; if r1 > 36 degC: [co2]"),
        ("Photograph every tree in row 3 if its CO2 is above 450 ppm.", "for Rows(3, 3): [co2 = r1; if r1 > 450 ppm: [picture]]"),
        ("Measure CO2 at tree 9. If it is outside 400 to 450 ppm, photograph it.", "co2 @ TreeIs(9) = r1; if not 400 <= r1 <= 450 ppm: [picture]"),
        ("If the air at tree 3 is hotter than 33, go home.", "air @ TreeIs(3) = r1; if r1 > 33 degC: [go Marker(start)] | return_to_start"),
        ("When the canopy temperature of tree 40 is above 36 °C, measure CO2 there.", "picture @ TreeIs(40) = r1; if r1 > 36 degC: [co2]"),
        ("Check whether the CO2 at tree 9 is above 450 ppm. If it is, photograph it.", "co2 @ TreeIs(9) = r1; if r1 > 450 ppm: [picture]"),
        ("Is the CO2 at tree 9 above 450 ppm? If so, photograph the tree.", "co2 @ TreeIs(9) = r1; if r1 > 450 ppm: [picture]"),
        ("Measure CO2 at tree 3. Above 450 take a picture, below that go to tree 9.", "co2 @ TreeIs(3) = r1; if r1 > 450 ppm: [picture] else [go TreeIs(9)]"),
        ("Photograph every tree in row 3. If it is above 36 measure CO2. For the rest, measure the air temperature.", "for Rows(3, 3): [picture = r1; if r1 > 36 degC: [co2] else [air]]"),
        ("Measure CO2 at each tree in row 3; below 400: air temperature. Above 450: photo. In all other cases: a photo and the air temperature.", "for Rows(3, 3): [co2 = r1; if r1 < 400 ppm: [air] else [if r1 > 450 ppm: [picture] else [picture; air]]]"),
        ("Measure CO2 at each tree in row 3. If it's above 450 take a picture, otherwise carry on with the next.", "for Rows(3, 3): [co2 = r1; if r1 > 450 ppm: [picture]]"),
        ("Measure CO2 at each tree in row 3. If it's below 400 skip it, else photograph it.", "for Rows(3, 3): [co2 = r1; if not r1 < 400 ppm: [picture]]"),
        ("Measure CO2 at each tree in row 3; over 450, picture; otherwise go on to the next one.", "for Rows(3, 3): [co2 = r1; if r1 > 450 ppm: [picture]]"),
        ("Walk row 4. If a tree is yellow, photograph it.", "for Rows(4, 4): [if leaf_color = yellow: [picture]]"),
        ("Go along row 4 and if the tree is yellow, photograph it, otherwise measure CO2.", "for Rows(4, 4): [if leaf_color = yellow: [picture] else [co2]]"),
        ("For each tree in row 4: if it is a Nonpareil, photograph it; if it is a Carmel, measure CO2.", "for Rows(4, 4): [if variety = Nonpareil: [picture]; if variety = Carmel: [co2]]"),
        ("Drive along row 4 and take a CO2 reading if the tree is a Carmel.", "for Rows(4, 4): [if variety = Carmel: [co2]]"),
        ("Photograph tree 4 and if it is above 36 go home.", "picture @ TreeIs(4) = r1; if r1 > 36 degC: [go Marker(start)] | return_to_start"),
        ("Photograph tree 40; if it's above 36 measure CO2, if it's above 38 go home.", "picture @ TreeIs(40) = r1; if r1 > 36 degC: [co2]; if r1 > 38 degC: [go Marker(start)] | return_to_start"),
        ("Photograph tree 40. If it is above 36 measure CO2. If it is below 30 measure the air temperature.", "picture @ TreeIs(40) = r1; if r1 > 36 degC: [co2]; if r1 < 30 degC: [air]"),
        ("Go to tree 4. If it is a Carmel, photograph it. If it is yellow, measure CO2.", "go TreeIs(4); if variety = Carmel: [picture]; if leaf_color = yellow: [co2]"),
        ("Go along row 4 photographing each tree, and stop as soon as one is above 38.", "for Rows(4, 4) until r1 > 38 degC: [picture = r1]"),
        ("Work down row 4 measuring CO2 and keep going while it stays below 420.", "for Rows(4, 4) until not r1 < 420 ppm: [co2 = r1]"),
        ("Photograph row 3, every tree, and if the battery allows also row 4, every tree.", "for Rows(3, 3): [picture]; maybe [for Rows(4, 4): [picture]]"),
    ],
)  # fmt: skip
def test_what_depends_on_a_reading_or_on_the_tree(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    "request_",
    [
        "Measure CO2 at tree 4, above 450.",  # what is done then?
        "Measure CO2 at tree 4. If it is lower, take a picture.",  # than what?
        "Take a picture of tree 4. Otherwise carry on with the next.",
        "If tree 40 is hotter than 36 °C, photograph tree 41.",  # its canopy, or the air there?
        "Go to tree 4. If it is a Carmel, photograph tree 5. If it is yellow, measure CO2.",  # tree 4 or tree 5?
    ],
)
def test_a_condition_that_is_left_open_is_not_guessed(request_: str) -> None:
    assert plan_of(request_) is None


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Measure the CO2 at tree 4. If it's above 450 take a picture. Do the same for trees 5 and 6.", "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]; for UnionOf(TreeIs(5)+TreeIs(6)): [co2 = r2; if r2 > 450 ppm: [picture]]"),
        ("Photograph tree 4 twice and tree 5 once.", "picture x2 @ TreeIs(4); picture @ TreeIs(5)"),
        ("Photograph tree 4, then measure CO2, then photograph it again.", "picture @ TreeIs(4); co2; picture"),
        ("Photograph tree 4 and measure CO2 at tree 9. Then do the whole thing again.", f"{BOTH}; {BOTH}"),
        ("Do this three times: photograph tree 4 and measure CO2 at tree 9.", f"3 times: [{BOTH}]"),
        ("Do the following twice: photograph tree 4, measure CO2 at tree 9.", f"2 times: [{BOTH}]"),
        ("Twice: photograph tree 4. Then measure CO2 at tree 9.", "2 times: [picture @ TreeIs(4)]; co2 @ TreeIs(9)"),
        ("Having photographed tree 4, measure CO2 at tree 9.", BOTH),
        ("Once you've photographed tree 4, measure CO2 at tree 9.", BOTH),
    ],
)  # fmt: skip
def test_what_is_done_again_or_before(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph tree 40, no, 4.", PICTURE),
        ("Photograph tree 40, hang on, tree 4.", PICTURE),
        ("Photograph trees 4 and 5, sorry, 4 and 6.", "for UnionOf(TreeIs(4)+TreeIs(6)): [picture]"),
        ("Measure CO2 at tree 4. If it's above 400, sorry, 450 ppm, photograph it.", "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [picture]"),
        ("Photograph five, I mean six, trees in row 3.", "for Take(6, of Rows(3, 3)): [picture]"),
    ],
)  # fmt: skip
def test_a_number_that_is_corrected_is_replaced(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize("request_", ["Photograph 5 trees in row 3, make that 6.", "Photograph trees 4, 5, no, 6."])
def test_a_correction_of_one_of_several_numbers_is_left_open(request_: str) -> None:
    assert plan_of(request_) is None


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Photograph trees 4, 9 and 12. Measure CO2 at the yellow ones.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [picture; if leaf_color = yellow: [co2]]"),
        ("Photograph trees 4, 9 and 12. Measure CO2 at the ones that are yellow.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [picture; if leaf_color = yellow: [co2]]"),
        ("Go to trees 4, 9 and 12. Photograph the yellow ones.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [if leaf_color = yellow: [picture]]"),
        ("Photograph row 3, every tree. Measure CO2 at those that are Carmel. Then go home.", "for Rows(3, 3): [picture; if variety = Carmel: [co2]] | return_to_start"),
    ],
)  # fmt: skip
def test_the_ones_of_a_kind_are_among_those_visited(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


def test_the_ones_of_another_kind_are_not_among_those_visited() -> None:
    plan = plan_of("Photograph the yellow trees. Measure CO2 at the green ones.")
    assert plan == "for Where(leaf_color, eq, yellow): [picture]; for Where(leaf_color, eq, green): [co2]"
