"""Requests of one scene, or of several steps, whose words stand in an unusual order."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import itertools

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO = open_site("demo")
HUSKY, AMIGA = load_robot("husky"), load_robot("amiga")


def plan_of(request: str, robot: str = "husky") -> str:
    outcome = EnglishPlanner().plan(request, DEMO, AMIGA if robot == "amiga" else HUSKY)
    match outcome:
        case Planned(task=task):
            return outline(task).split(" | ")[0]
        case Clarify(question=question):
            return f"asks {question}"
        case Refused(reasons=reasons):
            return f"refuses {reasons[0].what}"


@pytest.mark.parametrize(
    ("request_", "robot", "plan"),
    [
        ("We only care about the 10 trees with the biggest yield; drive to them and take their pictures.", "husky", "for Top(yield_kg, 10): [picture]"),
        ("Our focus is the northern half. The yellow trees in it are what I want pictures of.", "husky", "for Where(leaf_color, eq, yellow, of Half(north)): [picture]"),
        ("In the east of the orchard the nitrate of the soil matters; four trees will do, measure it there.", "amiga", "for Take(4, of Half(east)): [nitrate]"),
        ("The driving distance must stay at or below 150 m, and pictures of as many trees as possible are the goal.", "husky", "for Trees optional: [picture]"),
        ("Out of a row of six trees that you pass along, two should have their picture taken.", "husky", "for Evenly(2, of Successive(6)): [picture]"),
        ("Separate your soil moisture measurements by 12 metres, and carry out four in all.", "amiga", "for Spaced(12, 4): [moisture]"),
        ("The farm has four corners. No order is required, but a picture of each is.", "husky", "for Corners: [picture]"),
    ],
)  # fmt: skip
def test_one_scene_is_read_whatever_the_order_of_its_words(request_: str, robot: str, plan: str) -> None:
    assert plan_of(request_, robot) == plan


@pytest.mark.parametrize(
    ("clauses", "plan"),
    [
        (("the ten trees with the highest yield", "a picture of each", "any order"), "for Top(yield_kg, 10): [picture]"),
        (("pictures", "the yellow trees", "the northern half"), "for Where(leaf_color, eq, yellow, of Half(north)): [picture]"),
        (("the four corners of the farm", "a picture at each", "any order"), "for Corners: [picture]"),
        (("as many trees as possible", "a picture of each", "at most 100 m of driving"), "for Trees optional: [picture]"),
    ],
)  # fmt: skip
def test_the_order_of_the_clauses_never_makes_another_mission(clauses: tuple[str, ...], plan: str) -> None:
    said = [plan_of(", ".join(order) + ".") for order in itertools.permutations(clauses)]
    assert plan in said
    assert {one for one in said if not one.startswith(("asks", "refuses"))} == {plan}


@pytest.mark.parametrize(
    "request_",
    [
        "Read the CO2 at five trees in the north half, but the robot must stay in the south half the whole time.",
        "Take pictures at every other corner.",
        "Take pictures of the sick trees in the northern half.",
        "The yellow trees in the northern half should not have their picture taken.",
        "Take pictures of as many trees as possible, and drive at least 100 m.",
    ],
)
def test_what_is_left_over_is_never_dropped(request_: str) -> None:
    assert plan_of(request_).startswith(("asks", "refuses"))


@pytest.mark.parametrize(
    "request_",
    [
        "Our focus is the northern half. Pictures of its yellow trees are what I want.",
        "We are only interested in the northern half. The goal is pictures of the yellow trees there.",
        "Focus on the northern half: photograph its yellow trees.",
    ],
)
def test_a_topic_restricts_the_places_of_the_next_sentence(request_: str) -> None:
    assert plan_of(request_) == plan_of("Take pictures of the yellow trees in the northern half.")


def test_a_topic_alone_asks_for_nothing() -> None:
    assert plan_of("Our focus is the northern half. Take a picture of tree 4.").startswith(("asks", "refuses"))
    assert plan_of("Take a picture of tree 4. Our focus is row 3.").startswith(("asks", "refuses"))


def test_where_a_case_ends_is_asked_in_a_text_without_punctuation() -> None:
    asked = EnglishPlanner().plan(
        "take a picture of the first tree if it is below 33 c read the co2 otherwise read the air temperature then go to"
        " another tree and take a picture",
        DEMO,
        HUSKY,
    )
    assert isinstance(asked, Clarify)
    assert len(asked.choices) == 2


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        (
            "Image the first tree. Below 33 degrees? Then I would want the CO2 of it. Once that is done, go to the end.",
            "picture @ First = r1; if r1 < 33 degC: [co2]; go Marker(end)",
        ),
        (
            "go to tree 4 and read the co2 there if it is low go to a nearby tree and take a picture of it from there go to"
            " the farthest tree and read the co2 and when done take the air temperature at the last tree",
            "go TreeIs(4); co2 = r1; if r1 low: [go Nearest(Here, True); picture]; go Farthest(Here); co2; air @ Last",
        ),
    ],
)
def test_steps_are_read_clause_by_clause(request_: str, plan: str) -> None:
    assert plan_of(request_) == plan


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        (
            "Go to the north-east corner, then go to the south-east corner and take a picture.",
            "it does not say what to do at the place before",
        ),
        ("Take a picture of tree 4, a picture there.", "it is not clear whether this is done once more"),
    ],
)
def test_what_nobody_means_is_asked_about(request_: str, why: str) -> None:
    assert why in plan_of(request_)


@pytest.mark.parametrize(
    ("request_", "plain"),
    [
        ("Before you photograph tree 9, measure CO2 at tree 4.", "Measure CO2 at tree 4. Take a picture of tree 9."),
        ("After photographing tree 9 measure CO2 at tree 4.", "Take a picture of tree 9. Measure CO2 at tree 4."),
        ("Finish with a picture of tree 9, start with CO2 at tree 4.", "Measure CO2 at tree 4. Take a picture of tree 9."),
        ("Finish with a picture of tree 9. Begin with CO2 at tree 4. Photograph tree 7.", "Measure CO2 at tree 4. Take a picture of tree 7. Take a picture of tree 9."),
        ("First take CO2 at tree 4, but even before that take a picture of tree 9.", "Take a picture of tree 9. Measure CO2 at tree 4."),
    ],
)  # fmt: skip
def test_steps_told_out_of_order_are_done_in_order(request_: str, plain: str) -> None:
    assert plan_of(request_) == plan_of(plain)


@pytest.mark.parametrize(
    "same",
    [
        "Do the same in row 4.",
        "Do row 4 the same way.",
        "The same for row 4.",
        "Same thing in row 4.",
        "Row 4 likewise.",
        "Treat row 4 the same way.",
    ],
)
def test_another_row_is_treated_the_same_way(same: str) -> None:
    found = plan_of(f"Photograph every second tree in row 2. {same}")
    assert found == "for EveryNth(2, of Rows(2, 2)): [picture]; for EveryNth(2, of Rows(4, 4)): [picture]"


@pytest.mark.parametrize(
    "other", ["In every other case,", "In any other event,", "In the remaining cases,", "Otherwise"]
)
def test_the_other_case_has_many_names(other: str) -> None:
    found = plan_of(f"Take a picture of tree 4. If it is above 35 °C, take CO2. {other} read the air temperature.")
    assert found == "picture @ TreeIs(4) = r1; if r1 > 35 degC: [co2] else [air]"


@pytest.mark.parametrize(
    ("request_", "plain"),
    [
        ("Take a picture of tree 4, no wait, tree 5.", "Take a picture of tree 5."),
        ("Photograph tree 8. Sorry, I mean tree 9.", "Take a picture of tree 9."),
        ("Take CO2 at tree 8 - no, at tree 9.", "Take CO2 at tree 9."),
        ("Photograph every second tree in row 3, no wait, make that row 4.", "Photograph every second tree in row 4."),
        ("Go to tree 4, sorry, tree 9, and take a picture.", "Go to tree 9, and take a picture."),
        ("Take CO2 at trees 3 and 4. Sorry, I mean trees 5 and 6.", "Take CO2 at trees 5 and 6."),
    ],
)
def test_a_correction_takes_the_place_of_what_it_corrects(request_: str, plain: str) -> None:
    assert plan_of(request_) == plan_of(plain)
    outcome = EnglishPlanner().plan(request_, DEMO, HUSKY)
    assert isinstance(outcome, Planned)
    assert outcome.task.command.request == request_
    assert outcome.task.command.read_as == plain.replace("Take a picture of tree 9", "Photograph tree 9")


@pytest.mark.parametrize(
    "request_",
    [
        "Sorry, tree 9.",
        "Photograph tree 4, no tree 5.",
        "Photograph row 2, I mean the yellow trees.",
        "Take CO2 at trees 3 and 4, sorry, tree 5.",
    ],
)
def test_an_unclear_correction_is_refused(request_: str) -> None:
    assert plan_of(request_).startswith("refuses")
