"""The read-back: what a person signs."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.approval.readback import read_back
from fieldhand.forecast.estimate import estimate
from fieldhand.places.selectors import (
    Bound,
    Corners,
    Extreme,
    Farthest,
    Here,
    Nearest,
    NotVisited,
    Take,
    TreeIs,
    Trees,
    Where,
)
from fieldhand.task.conditions import Compare, Level
from fieldhand.task.frames import Budget, Constraints, FaultedExit
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, OptionalStep, Repeat, StopMission, Try, walk
from fieldhand.testing.small_orchard import husky, orchard, task_for

PICTURE, CO2 = "take_thermal_picture", "read_co2"
SITE = orchard()


def act(action=PICTURE, at=None, **more):
    return Act(id="", action=action, at=at, **more)


def below(reading, value=33.0):
    return Compare(reading=reading, quantity="canopy_temperature", test="lt", value=value, unit="degC")


def read(plan, site=SITE, **more):
    task = task_for(site, plan, **more)
    return read_back(task, site, husky(), estimate(task, site, husky()))


def steps(plan, **more):
    return [line.text for line in read(plan, **more).lines]


def test_a_step_names_the_tree_and_what_it_was_called():
    words = read(InOrder(id="", steps=(act(at=TreeIs(tree="7")), act(at=Corners(which=("nw",)), count=2))))
    assert [(line.number, line.text) for line in words.lines] == [
        (1, "At tree 7: take a thermal picture."),
        (2, "At tree 16 (north-west corner): take 2 thermal pictures."),
        (3, "Return to the end marker."),
    ]


def test_conditions_are_indented_and_name_the_place_of_their_reading():
    plan = InOrder(
        id="",
        steps=(
            act(at=TreeIs(tree="1"), reading="r"),
            If(id="", condition=below("r"), then=act(CO2), otherwise=StopMission(id="")),
            act(at=TreeIs(tree="2")),
            If(id="", condition=Level(reading="r", quantity="canopy_temperature", level="low"), then=act(CO2)),
        ),
    )
    lines = read(plan).lines
    assert [(line.number, line.indent, line.text) for line in lines] == [
        (1, 0, "At tree 1: take a thermal picture."),
        (None, 0, "If the canopy temperature there is below 33 °C:"),
        (2, 1, "There: read CO₂."),
        (None, 0, "Otherwise:"),
        (3, 1, "End the mission here."),
        (4, 0, "At tree 2: take a thermal picture."),
        (None, 0, "If the canopy temperature of step 1 is low (below 33 °C):"),
        (5, 1, "There: read CO₂."),
        (6, 0, "Return to the end marker."),
    ]


def test_few_places_are_named_and_many_are_counted():
    corner, *_ = steps(ForEach(id="", select=Corners(), body=act()))
    match = re.fullmatch(
        r"At each of the 4 corner trees \((.*)\), in the order with the least driving: take a thermal picture\.", corner
    )
    assert match
    assert set(re.findall(r"\d+", match[1])) == {"1", "5", "16", "20"}
    everything, *_ = steps(ForEach(id="", select=Trees(), body=act()))
    assert everything == "At each of the 20 trees, in the order with the least driving: take a thermal picture."


def test_a_loop_with_more_than_one_action_keeps_them_on_lines_of_their_own():
    body = InOrder(id="", steps=(act(reading="r"), If(id="", condition=below("r"), then=act(CO2))))
    lines = read(ForEach(id="", select=Corners(), body=body)).lines
    assert [(line.number, line.indent) for line in lines] == [(1, 0), (2, 1), (None, 1), (3, 2), (4, 0)]
    assert lines[2].text == "If the canopy temperature there is below 33 °C:"


def test_a_place_that_a_reading_decides_is_said_to_be_decided_on_the_way():
    plan = InOrder(
        id="",
        steps=(
            act(at=TreeIs(tree="1"), reading="r"),
            If(id="", condition=below("r"), then=act(at=TreeIs(tree="20"))),
            act(CO2, at=Farthest(origin=Here())),
        ),
    )
    assert steps(plan)[3] == "At the tree farthest from there (decided on the way; most likely tree 1): read CO₂."


def test_a_relative_place_that_can_be_known_is_named():
    plan = InOrder(id="", steps=(act(at=TreeIs(tree="1"), label="a"), act(CO2, at=Farthest(origin=Bound(label="a")))))
    assert steps(plan)[1] == "At tree 20 (the tree farthest from tree 1): read CO₂."


def test_the_visits_that_go_first_are_named_where_they_are_few():
    plan = ForEach(id="", select=Trees(), body=act(), optional=True)
    ample, tight = (
        read(plan, constraints=Constraints(budgets=(Budget(kind="distance_m", limit=metres),))).lines[0].text
        for metres in (500.0, 110.0)
    )
    assert "(20 of 20 expected, 0 % chance of running short)" in ample
    assert re.search(r"\d+ of 20 expected, \d+ % chance of running short; trees? .* (is|are) left out first\)", tight)


@pytest.mark.parametrize(
    ("reward_by", "said"),
    [
        ("value", ", preferring high age years ("),
        ("lowest", ", those with the lowest age years first (worth most) ("),
        ("highest", ", those with the highest age years first (worth most) ("),
    ],
)
def test_the_visits_that_are_worth_most_are_said(reward_by, said):
    each = ForEach(id="", select=Trees(), body=act(), optional=True, reward="age_years", reward_by=reward_by)
    words = read(each, constraints=Constraints(budgets=(Budget(kind="distance_m", limit=80.0),)))
    assert f"trees as the budget allows{said}" in words.lines[0].text


def test_a_relative_place_after_optional_visits_is_never_promised():
    plan = InOrder(
        id="",
        steps=(
            ForEach(id="", select=Trees(), body=act(), optional=True),
            act(CO2, at=Nearest(to=Here(), fresh=True)),
        ),
    )
    budget = Constraints(budgets=(Budget(kind="distance_m", limit=80.0),))
    words = read(plan, constraints=budget)
    first, second, *_ = (line.text for line in words.lines)
    expected = r"as many of the 20 trees as the budget allows \(\d+ of 20 expected, \d+ % chance of running short"
    assert re.search(expected, first)
    assert "decided on the way" in second
    assert "at most 80 m of driving" in words.limits[0]
    assert "10 %" in words.limits[0]


@pytest.mark.parametrize(
    ("metres", "expected"),
    [(500.0, "according to the estimate, it does"), (40.0, "according to the estimate, it does not")],
)
def test_an_optional_step_is_said_to_hang_on_the_budget_and_whether_it_fits_by_the_estimate(metres, expected):
    plan = InOrder(id="", steps=(act(at=TreeIs(tree="1")), OptionalStep(id="", body=act(CO2, at=TreeIs(tree="20")))))
    words = read(plan, constraints=Constraints(budgets=(Budget(kind="distance_m", limit=metres),)))
    assert [(line.number, line.indent, line.text) for line in words.lines] == [
        (1, 0, "At tree 1: take a thermal picture."),
        (None, 0, f"If the budget allows ({expected}):"),
        (2, 1, "At tree 20: read CO₂."),
        (3, 0, "Return to the end marker."),
    ]


def test_an_optional_step_at_each_place_says_how_often_it_fits():
    loop = ForEach(
        id="", select=Corners(), body=InOrder(id="", steps=(act(), OptionalStep(id="", body=act(CO2, count=9))))
    )
    time = estimate(task_for(SITE, ForEach(id="", select=Corners(), body=act())), SITE, husky()).worst.seconds.p90
    more = 2.5 * 9 * husky().action[CO2].duration_s
    found = steps(loop, constraints=Constraints(budgets=(Budget(kind="duration_s", limit=time + more),)))
    assert "If the budget allows (according to the estimate, about 2 of 4 times):" in found
    assert "If the budget allows (according to the estimate, it does):" in steps(loop)


def test_after_an_optional_step_it_is_not_promised_where_the_robot_is_nor_where_readings_were_taken():
    plan = InOrder(
        id="",
        steps=(
            act(at=TreeIs(tree="1"), reading="r"),
            OptionalStep(id="", body=act(CO2, at=TreeIs(tree="20")), reward=2.0),
            If(id="", condition=below("r"), then=act(at=Nearest(to=Here(), fresh=True))),
        ),
    )
    found = steps(plan)
    assert found[1] == "If the budget allows, worth 2 (according to the estimate, it does):"
    assert found[3] == "If the canopy temperature of step 1 is below 33 °C:"
    assert "decided on the way" in found[4]


@pytest.mark.parametrize(
    ("plan", "text"),
    [
        (AnyOrder(id="", steps=(act(at=TreeIs(tree="1")),)), "In the order with the least driving:"),
        (Repeat(id="", times=3, body=act(at=TreeIs(tree="1"))), "Do this 3 times:"),
        (
            Repeat(id="", times=2, body=act(at=TreeIs(tree="1"), reading="r"), until=below("r")),
            "Leave out the rest once the canopy temperature there is below 33 °C.",
        ),
        (Try(id="", body=act(at=TreeIs(tree="1")), otherwise=act(CO2)), "If that fails:"),
        (GoTo(id="", place=Extreme(side="north")), "Drive to tree 16 (the northernmost tree)."),
        (StopMission(id="", exit="faulted"), "End the mission here, which counts as failed."),
        (act(), "At the start: take a thermal picture."),
        (
            ForEach(id="", select=Extreme(side="east", count=2), body=act(), order="given"),
            "At each of the 2 easternmost trees (5 and 10), in that order: take a thermal picture.",
        ),
        (
            ForEach(id="", select=Where(attribute="leaf_color", test="eq", value="yellow"), at_most=2, body=act()),
            "At no more than 2 of the yellow trees (1 and 7), in the order with the least driving:"
            " take a thermal picture.",
        ),
    ],
)
def test_every_kind_of_node_has_its_line(plan, text):
    assert text in steps(plan)


def test_faults_reserve_assumptions_and_totals_are_said():
    words = read(act(at=TreeIs(tree="1")), assumptions=("“it” is the first tree.",))
    text = "\n".join(words.text_lines())
    assert "at least 20 % charge is left at the end (the robot's own reserve)" in text
    assert "If an action fails for good: return to the start marker." in text
    assert "stop and wait there" in text
    assert "Assumed: “it” is the first tree." in text
    assert re.search(r"In all: 1 capture, about \d+ m, .* % of the battery\.", text)
    assert words.totals.metres.p90 >= words.totals.metres.mean > 0


def test_what_every_plan_has_is_left_out_unless_somebody_consents_to_it():
    words = read(act(at=TreeIs(tree="1")))
    short = words.text_lines(usual=False)
    assert set(words.text_lines()) - set(short) == {f"  {text}" for text in words.faults} | {
        "  Limit: at least 20 % charge is left at the end (the robot's own reserve)."
    }


def test_what_a_task_asks_for_itself_is_in_every_read_back():
    exits = (FaultedExit(fault="action_failed", then="stay"),)
    task = task_for(SITE, act(at=TreeIs(tree="1")), constraints=Constraints(reserve_percent=20.0), faulted=exits)
    words = read_back(task, SITE, husky(), estimate(task, SITE, husky()))
    assert words.text_lines(usual=False) == words.text_lines()


def test_a_site_without_an_end_marker_is_said_to_have_none():
    from dataclasses import replace

    site = replace(SITE, markers={"start": SITE.markers["start"]})
    task = task_for(site, act(at=TreeIs(tree="1")))
    lines = read_back(task, site, husky(), estimate(task, site, husky())).lines
    assert lines[-1].text == "Return to the start marker (the site has no end marker)."


@settings(max_examples=40, deadline=None)
@given(
    order=st.permutations(
        [TreeIs(tree="3"), Corners(which=("se",)), Take(count=1, of=NotVisited()), Farthest(origin=Here())]
    )
)
def test_every_action_and_drive_of_a_plan_has_exactly_one_number(order):
    task = task_for(SITE, InOrder(id="", steps=tuple(act(at=selector) for selector in order)))
    words = read_back(task, SITE, husky(), estimate(task, SITE, husky()))
    nodes = [line.node for line in words.lines if line.number is not None]
    assert [line.number for line in words.lines if line.number] == list(range(1, len(nodes) + 1))
    for node in walk(task.composition.plan):
        if isinstance(node, Act):
            assert nodes.count(node.id) == 1
    assert all("_" not in line.text and "\n" not in line.text for line in words.lines)
