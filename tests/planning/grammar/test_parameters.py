"""Parameters of actions that a robot's profile declares: a depth, a view, and whatever another profile has."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import Parameter
from fieldhand.site.loader import open_site
from fieldhand.task.codec import encode
from fieldhand.task.plan import walk
from fieldhand.task.schema import validate
from planning.english.outlines import outline

DEMO = open_site("demo")
AMIGA, HUSKY = load_robot("amiga"), load_robot("husky")


@pytest.mark.parametrize(
    ("request_", "plan"),
    [
        ("Measure the moisture at tree 5 at a depth of 40 cm.", "moisture(depth_cm 40) @ TreeIs(5)"),
        ("Measure the nitrate with a depth of 0.4 m at tree 5.", "nitrate(depth_cm 40) @ TreeIs(5)"),
        ("Moisture 12 inches deep at tree 5.", "moisture(depth_cm 30.48) @ TreeIs(5)"),
        ("I need soil moisture at 30 cm under every yellow tree.", "for Where(leaf_color, eq, yellow): [moisture(depth_cm 30)]"),
        ("Measure soil moisture every 20 meters down row 1, 25 cm deep.", "for Spaced(20, of Rows(1, 1)): [moisture(depth_cm 25)]"),
        (
            "Soil moisture at 10 cm and at 50 cm for trees 57 and 58.",
            "for UnionOf(TreeIs(57)+TreeIs(58)): [moisture(depth_cm 10); moisture(depth_cm 50)]",
        ),
        ("Trunk photos of trees 4 and 5, please.", "for UnionOf(TreeIs(4)+TreeIs(5)): [picture(view trunk)]"),
        ("Take three pictures of the trunk of tree 4.", "picture(view trunk) x3 @ TreeIs(4)"),
        ("Photograph the ground at tree 4.", "picture(view ground) @ TreeIs(4)"),
        ("Take a ground picture at tree 4. Do the same at tree 9.", "picture(view ground) @ TreeIs(4); go TreeIs(9); picture(view ground)"),
    ],
)  # fmt: skip
def test_a_parameter_is_given_in_words(request_: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request_, DEMO, AMIGA)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    assert validate(encode(outcome.task), capabilities_of(AMIGA)) == ()


@given(st.integers(1, 200))
def test_a_depth_is_planned_if_the_probe_can_go_there_and_refused_with_its_bounds_otherwise(depth: int) -> None:
    outcome = EnglishPlanner(suggests=False).plan(f"Measure the moisture at {depth} cm at tree 5.", DEMO, AMIGA)
    if 5 <= depth <= 60:
        assert isinstance(outcome, Planned)
        assert [node.act.parameters for node in walk(outcome.task.composition.plan) if node.act] == [
            (("depth_cm", depth),)
        ]
    else:
        assert isinstance(outcome, Refused)
        assert "is not between 5 and 60 cm" in outcome.reasons[0].what


def test_a_unit_of_the_profile_is_a_word_of_the_grammar() -> None:
    rate = Parameter(name="rate", kind="number", default=300.0, minimum=50.0, maximum=900.0, unit="l/ha")
    spraying = replace(
        AMIGA.actions[0], name="spray", words=("spraying",), verbs=("spray",), measures=(), parameters=(rate,)
    )
    sprayer = replace(AMIGA, actions=(*AMIGA.actions, spraying))
    outcome = EnglishPlanner(suggests=False).plan("Spray every tree of row 3 at 400 l/ha.", DEMO, sprayer)
    assert isinstance(outcome, Planned), outcome
    acts = [node.act for node in walk(outcome.task.composition.plan) if node.act]
    assert [(act.action, act.parameters) for act in acts] == [("spray", (("rate", 400.0),))]


@pytest.mark.parametrize(
    "request_", ["Read CO2 at 30 cm at tree 4.", "Take a trunk picture of tree 4.", "CO2 at tree 4, 25 cm deep."]
)
def test_a_robot_without_the_parameter_does_not_drop_it(request_: str) -> None:
    assert isinstance(EnglishPlanner(suggests=False).plan(request_, DEMO, HUSKY), Refused)


def test_twice_at_two_depths_is_once_or_twice_at_each() -> None:
    request = "Measure the soil moisture at tree 4 twice, once at 15 cm and once at 40 cm depth."
    outcome = EnglishPlanner().plan(request, open_site("demo"), load_robot("amiga"))
    assert isinstance(outcome, Clarify)
    assert len(outcome.choices) == 2
