"""Requests of growers on the built-in vineyard: what is not said exactly is read as a person would, asked, or refused.

A refusal names what the robot lacks, by the words of the action that it does not have.
"""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

#: Robot, request, and its plan.
PLANNED = [
    (
        "husky",
        "scout every third vine in row 7 of the south block",
        "for EveryNth(3, of Rows(7, 7, of InBlock(South))): [picture]",
    ),
    (
        "husky",
        "inspect vine N30 and the vine next to it on the west",
        "for UnionOf(TreeIs(N30)+Nearest(TreeIs(N30), True, west)): [picture]",
    ),
    (
        "husky",
        "check the first and the last vine of row 4 of the south block",
        "for UnionOf(InRow(1, 1, of Rows(4, 4, of InBlock(South)))+InRow(-1, -1, of Rows(4, 4, of InBlock(South)))): [picture]",
    ),
    ("husky", "examine the corners of the north block", "for Corners(of InBlock(North)): [picture]"),
    (
        "husky",
        "survey row 5 of the north block, every other vine",
        "for EveryNth(2, of Rows(5, 5, of InBlock(North))): [picture]",
    ),
    ("husky", "please check on vine N12", "picture @ TreeIs(N12)"),
    (
        "tractor",
        "scout the first ten vines of row 6 of the north block",
        "for InRow(1, 10, of Rows(6, 6, of InBlock(North))): [picture]",
    ),
    ("tractor", "look at vine N30 and measure the soil moisture there", "picture @ TreeIs(N30); moisture"),
    (
        "amiga",
        "check every tenth vine in row 9 of the south block",
        "for EveryNth(10, of Rows(9, 9, of InBlock(South))): [picture]",
    ),
    ("amiga", "sample 2 vines per variety", "for Quota(variety, 2): [sample_leaf]"),
    (
        "amiga",
        "sample the first vine of every fifth row of the south block",
        "for InRow(1, 1, of Rows(5, of InBlock(South))): [sample_leaf]",
    ),
    ("husky", "check the CO2 at vine N30", "co2 @ TreeIs(N30)"),
    (
        "husky",
        "check whether the CO2 at N30 is above 450 ppm, if so take a picture",
        "co2 @ TreeIs(N30) = r1; if r1 > 450 ppm: [picture]",
    ),
    ("husky", "sample the CO2 at vine N30", "co2 @ TreeIs(N30)"),
    (
        "husky",
        "photograph the 8 worst vines of the south block",
        "for Top(vigor, 8, True, of InBlock(South)): [picture]",
    ),
    (
        "husky",
        "photograph the worst vine in row 3 of the north block",
        "picture @ Top(vigor, 1, True, of Rows(3, 3, of InBlock(North)))",
    ),
    (
        "husky",
        "photograph as many as you can of the 40 weakest vines in 15 minutes",
        "for Top(vigor, 40, True) optional: [picture] | duration_s 900",
    ),
    (
        "husky",
        "photograph as many weak vines as possible in 15 minutes",
        "for Trees optional lowest vigor first: [picture] | duration_s 900",
    ),
    (
        "husky",
        "in 10 minutes take as many pictures of weak Syrah vines as you can",
        "for Where(variety, eq, Syrah) optional lowest vigor first: [picture] | duration_s 600",
    ),
    (
        "husky",
        "measure CO2 at the weakest vines, as many as you can within 12 minutes",
        "for Trees optional lowest vigor first: [co2] | duration_s 720",
    ),
    (
        "husky",
        "photograph as many of the vines with the highest vigor in the south block as you can without driving more than 300 m",
        "for InBlock(South) optional highest vigor first: [picture] | distance_m 300",
    ),
    (
        "husky",
        "take CO2 readings at the most vigorous vines of the north block, as many as possible in half an hour",
        "for InBlock(North) optional highest vigor first: [co2] | duration_s 1800",
    ),
    (
        "husky",
        "photograph vines of low vigor in the south block, as many as you can within 300 m",
        "for InBlock(South) optional lowest vigor first: [picture] | distance_m 300",
    ),
    (
        "husky",
        "photograph the Merlot vines with the lowest vigor, as many as you can in 20 minutes",
        "for Where(variety, eq, Merlot) optional lowest vigor first: [picture] | duration_s 1200",
    ),
    ("husky", "measure CO2 at the 5 best Merlot vines", "for Top(vigor, 5, of Where(variety, eq, Merlot)): [co2]"),
    (
        "husky",
        "photograph the poorest vine of each of rows 2 and 3 of the north block",
        "for UnionOf(Top(vigor, 1, True, of Rows(2, 2, of InBlock(North)))+Top(vigor, 1, True, of Rows(3, 3, of InBlock(North)))): [picture]",
    ),
    (
        "husky",
        "photograph the Cabernet vines except the ones in rows 2 and 4",
        "for Excluding(UnionOf(Rows(2, 2, of InBlock(North))+Rows(4, 4, of InBlock(North))), of Where(variety, eq, Cabernet Sauvignon)): [picture]",
    ),
    (
        "tractor",
        "mow every third aisle between rows 4 and 10 of the north block",
        "mow aisles Rows(4, 10, of InBlock(North)), every 3",
    ),
    ("tractor", "mow the aisles between rows 4 and 7 of the south block", "mow aisles Rows(4, 7, of InBlock(South))"),
    ("tractor", "drive between rows 2 and 5 of the north block", "drive aisles Rows(2, 5, of InBlock(North))"),
    (
        "husky",
        "have a look at the vines with vigor under 0.5 in row 5 of the south block",
        "for Where(vigor, lt, 0.5, of Rows(5, 5, of InBlock(South))): [picture]",
    ),
]

#: Robot, request, and the number of answers to choose from.
ASKED = [
    ("husky", "photograph the weak vines of row 3 of the south block", 3),
    ("husky", "photograph vines with a low vigor", 3),
    ("husky", "measure CO2 at high-vigor vines of the north block", 3),
    ("husky", "photograph the bad vines", 3),
    ("husky", "photograph the vigorous Merlot vines", 3),
    ("husky", "photograph the worst vines", 3),
    ("husky", "take a picture at the highest corner of the north block", 4),
    ("husky", "measure CO2 at the lowest corner", 4),
    ("husky", "test vine N30", 3),
    ("husky", "sample 3 vines per variety", 3),
    ("husky", "photograph every vine except those in row 7", 2),
]

#: Robot, request, and why it is refused.
REFUSED = [
    ("husky", "spray the vines in row 4 of the north block", "husky cannot spray: no action 'spray'"),
    ("husky", "take a picture of N4 and mow rows 2 to 4 of the south block", "husky cannot mow: no action 'mow'"),
    ("husky", "prune the Syrah vines", "husky cannot prune: no action 'prune'"),
    (
        "husky",
        "read the soil moisture at ten random vines",
        "husky cannot read the soil moisture: no action 'read_soil_moisture'",
    ),
    ("husky", "measure the nitrate at N5", "husky cannot read the soil nitrate: no action 'read_soil_nitrate'"),
    ("husky", "take leaf samples of 5 Merlot vines", "husky cannot sample a leaf: no action 'sample_leaf'"),
    ("tractor", "measure CO2 at vine N30", "tractor cannot read CO₂: no action 'read_co2'"),
    (
        "tractor",
        "read the air temperature at N30 and take a picture",
        "tractor cannot read the ambient temperature: no action 'read_ambient_temperature'",
    ),
    ("tractor", "at N30, if it is hotter than 33 degrees, take a picture", "tractor measures nothing in °C"),
    (
        "tractor",
        "take a thermal picture of N30",
        "tractor cannot take a thermal picture: no action 'take_thermal_picture'",
    ),
    ("tractor", "what is the carbon dioxide level at N30", "tractor cannot read CO₂: no action 'read_co2'"),
    ("tractor", "collect leaf samples at 5 random vines", "tractor cannot sample a leaf: no action 'sample_leaf'"),
    ("amiga", "mow between rows 3 and 4 of the north block", "amiga cannot mow: no action 'mow'"),
    (
        "amiga",
        "measure the temperature at N30",
        "amiga cannot read the ambient temperature: no action 'read_ambient_temperature'",
    ),
    (
        "amiga",
        "measure the soil temperature at N30",
        "'measure the soil temperature' asks for something that amiga does not record",
    ),
    ("husky", "count the bunches on the Merlot vines", "'count the bunches' asks to count: husky has no action for it"),
    (
        "tractor",
        "count the dead vines in row 3 of the north block",
        "'count the dead vines' asks to count: tractor has no action for it",
    ),
]


def outcome_of(robot: str, request: str, *answers: Answer) -> Outcome:
    return EnglishPlanner().plan(request, open_site("vineyard"), load_robot(robot), answers)


@pytest.mark.parametrize(("robot", "request_", "plan"), PLANNED, ids=lambda v: str(v)[:60])
def test_what_a_grower_asks_for_is_planned(robot: str, request_: str, plan: str) -> None:
    outcome = outcome_of(robot, request_)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task).removesuffix(" | return_to_start") == plan


@pytest.mark.parametrize(("robot", "request_", "answers"), ASKED, ids=lambda v: str(v)[:60])
def test_what_a_person_would_ask_for_is_asked_and_each_answer_is_a_plan(
    robot: str, request_: str, answers: int
) -> None:
    question = outcome_of(robot, request_)
    assert isinstance(question, Clarify), question
    assert len(question.choices) == answers
    plans = set()
    for choice in question.choices:
        outcome = outcome_of(robot, request_, Answer(question=question.question, answer=choice))
        assert isinstance(outcome, Planned), outcome
        plans.add(outline(outcome.task))
    assert len(plans) == answers


@pytest.mark.parametrize(("robot", "request_", "why"), REFUSED, ids=lambda v: str(v)[:60])
def test_a_refusal_names_what_the_robot_lacks(robot: str, request_: str, why: str) -> None:
    outcome = outcome_of(robot, request_)
    assert isinstance(outcome, Refused), outcome
    assert why in [reason.what for reason in outcome.reasons]
    assert any(f"{robot} can " in reason.advice for reason in outcome.reasons)


@pytest.mark.parametrize("request_", ["check vine N30", "look at vine N30", "scout vine N30"])
def test_who_looks_at_something_takes_pictures_and_the_plan_says_so(request_: str) -> None:
    outcome = outcome_of("husky", request_)
    assert isinstance(outcome, Planned), outcome
    assert (
        f"'{request_}' does not say what is done there: the robot is to take a thermal picture."
        in outcome.task.command.assumptions
    )


def test_by_which_attribute_the_worst_are_chosen_is_said() -> None:
    outcome = outcome_of("husky", "photograph the 4 worst vines")
    assert isinstance(outcome, Planned), outcome
    assert "'worst' is read as: with the lowest vigor." in outcome.task.command.assumptions


def test_a_suggestion_ranks_by_what_says_how_good_a_vine_is() -> None:
    outcome = outcome_of("husky", "photograph the ugly vines")
    assert isinstance(outcome, Refused), outcome
    assert "vigor" in outcome.example
