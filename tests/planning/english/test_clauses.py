"""Requests of several steps whose sentences the grammar does not take: clause by clause they are the same plan, or none."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO, HUSKY = open_site("demo"), load_robot("husky")
SENSORS = {"a CO2 sample": "co2", "an air temperature reading": "air", "a thermal picture": "picture"}


def plan_of(request: str) -> str:
    outcome = EnglishPlanner().plan(request, DEMO, HUSKY)
    match outcome:
        case Planned(task=task):
            return outline(task)
        case Clarify(question=question):
            return f"asks {question}"
        case Refused(reasons=reasons):
            return f"refuses {reasons[0].what}"


@pytest.mark.parametrize(
    ("said", "plain"),
    [
        ("Acquire a photograph at tree 4. A photograph less than 33 °C there requires a CO2 sample.", "Take a picture at tree 4. If it is below 33 °C, take a CO2 sample."),
        ("Find a tree around the middle of the orchard and get its CO2 level. With a low level, get two thermal images of nearby trees by going to them.", "Go to the middle of the orchard and measure CO2. If it is low, take 2 pictures of nearby trees."),
        ("CO2 at tree 5. Only if it is low do we visit a nearby tree and take its picture.", "Measure CO2 at tree 5. If it is low, go to a nearby tree and take a picture."),
        ("Your first task is a CO2 measurement at tree 5. If it gives a low reading, your next task is to go to two different nearby trees and image each of them.", "Measure CO2 at tree 5. If it is low, go to 2 different trees nearby and take a picture of each."),
        ("The husky goes to the first tree and photographs it. If the photograph gives less than 33 degrees, the husky measures the surrounding air temperature; if this gives less than 30 degrees, it measures CO2.", "Go to the first tree and take a picture. If it is below 33 °C, take the air temperature. If that is below 30 °C, take CO2."),
        ("Take CO2 at tree 5. Then move as far away as possible for a CO2 reading of another tree.", "Take CO2 at tree 5. Then take CO2 at another tree as far away as possible."),
        ("Take a CO2 sample at tree 5. If that is below 400 ppm, take a further sample to confirm it. If it is again less than 400 ppm, drive on to another tree and do one more CO2 sample.", "Take CO2 at tree 5. If it is below 400 ppm, take another. If that is below 400 ppm, go to another tree and take CO2."),
        ("Photograph any six trees and then come back to where you started.", "Take a picture of any 6 trees. Return to start."),
    ],
)  # fmt: skip
def test_clauses_come_to_the_plan_of_plain_sentences(said: str, plain: str) -> None:
    found = plan_of(said)
    assert found == plan_of(plain)
    assert not found.startswith(("asks", "refuses"))


@pytest.mark.parametrize("calls", ["calls for", "leads to", "means", "requires", "asks for"])
@settings(deadline=None, max_examples=6)
@given(first=st.sampled_from(["a thermal picture"]), then=st.sampled_from(sorted(SENSORS)), bound=st.integers(20, 45))
def test_what_a_reading_calls_for_is_what_is_done_if_it_holds(calls: str, first: str, then: str, bound: int) -> None:
    said = plan_of(f"Obtain {first} of tree 5. A value below {bound} °C {calls} {then}.")
    assert said == plan_of(f"Take {first} of tree 5. If it is below {bound} °C, take {then} again.") or said == plan_of(
        f"Take {first} of tree 5. If it is below {bound} °C, take {then}."
    )
    assert not said.startswith(("asks", "refuses"))


@pytest.mark.parametrize(
    "request_",
    [
        "Two trees get a picture in this mission. At the first tree take a picture. At another tree take a picture.",
        "Take CO2 at tree 5, then do it all over with the pictures of two trees included.",
        "Take a picture of tree 4 and repeat the process with its two pictures at tree 9.",
        "A value below 33 °C prevents a CO2 sample at tree 4.",
        "Three checks of the trees at the first tree decide.",
    ],
)
def test_what_could_change_the_mission_is_not_left_out(request_: str) -> None:
    assert plan_of(request_).startswith(("asks", "refuses"))
