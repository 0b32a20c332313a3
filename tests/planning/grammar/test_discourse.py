"""How requests are opened, ordered, repeated and corrected, and what depends on readings: plans of everyday wording."""

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
