"""Waits, driving speeds, sides of trees and parameters in English: a request and its plan, question or refusal."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.request_coverage import request_pieces
from planning.english.outlines import outline

YELLOW = "Where(leaf_color, eq, yellow)"
PLANNED = {
    # waits
    "Go to tree 4 and wait there for 10 minutes.": "go TreeIs(4); wait 600",
    "Take a picture of tree 4, wait 10 min, then take another.": "picture @ TreeIs(4); wait 600; picture",
    "Take a picture of tree 4. Wait 10 min. Take another.": "picture @ TreeIs(4); wait 600; picture",
    "Go to the charger, wait for half an hour, then take a picture of tree 4.": (
        "go Marker(charger); wait 1800; picture @ TreeIs(4)"
    ),
    "Pause for 30 seconds at each yellow tree.": f"for {YELLOW}: [wait 30]",
    "Stay at tree 4 for half an hour.": "go TreeIs(4); wait 1800",
    "Stand still at tree 4 for 90 seconds, then measure CO2.": "go TreeIs(4); wait 90; co2",
    "Wait 5 minutes at tree 4 and measure CO2.": "go TreeIs(4); wait 300; co2",
    "Wait at tree 4 for 5 minutes and measure CO2.": "go TreeIs(4); wait 300; co2",
    "Make a 30-second stop at every corner.": "for Corners: [wait 30]",
    "Take a 10 minute pause at tree 4.": "go TreeIs(4); wait 600",
    "Go to the charger and stay there for 20 minutes.": "go Marker(charger); wait 1200",
    "Wait 10 minutes, then photograph tree 4.": "wait 600; picture @ TreeIs(4)",
    "Photograph every yellow tree, pausing 30 s at each.": f"for {YELLOW}: [picture; wait 30]",
    "At each yellow tree wait 20 seconds and take a picture.": f"for {YELLOW}: [wait 20; picture]",
    "Measure CO2 at tree 4; if it is above 450 ppm wait 5 min and measure it again.": (
        "co2 @ TreeIs(4) = r1; if r1 > 450 ppm: [wait 300; co2]"
    ),
    # before each capture
    "Let the sensor settle for 20 s before each reading of CO2 at the yellow trees.": f"for {YELLOW}: [wait 20; co2]",
    "Measure CO2 at every yellow tree, waiting 20 s before each reading.": f"for {YELLOW}: [wait 20; co2]",
    "Photograph every yellow tree with a 5-second pause before each picture.": f"for {YELLOW}: [wait 5; picture]",
    "Measure CO2 at tree 4 three times with a pause of 10 minutes before each reading.": (
        "go TreeIs(4); 3 times: [wait 600; co2]"
    ),
    # speeds
    "Drive slowly, at 0.3 m/s, and take a picture of tree 4.": "picture @ TreeIs(4) | speed 0.3",
    "Photograph every yellow tree at half speed.": f"for {YELLOW}: [picture] | speed 0.5",
    "Photograph every yellow tree at 50% of its speed.": f"for {YELLOW}: [picture] | speed 0.5",
    "No faster than 0.5 m/s between trees: photograph every yellow tree.": f"for {YELLOW}: [picture] | speed 0.5",
    "Speed limit: 1.8 km/h. Photograph every yellow tree.": f"for {YELLOW}: [picture] | speed 0.5",
    "Keep your speed below 1 mph and photograph every yellow tree.": f"for {YELLOW}: [picture] | speed 0.44704",
    "Photograph every yellow tree as fast as you can.": f"for {YELLOW}: [picture] | speed 1",
    "Drive no faster than 3 m/s and photograph tree 4.": "picture @ TreeIs(4) | speed 3",
    "Photograph tree 4, then drive slowly, at 0.2 m/s, to tree 9 and measure CO2 there.": (
        "picture @ TreeIs(4); at 0.2 m/s: [go TreeIs(9)]; co2"
    ),
    "Drive along row 3 at 0.4 m/s and photograph every tree.": "at 0.4 m/s: [for Rows(3, 3): [picture]]",
    # sides
    "Take pictures of both sides of tree 50.": "for Beside(both, of TreeIs(50)): [picture]",
    "Photograph each tree of row 3 from both sides.": "for Beside(both, of Rows(3, 3)): [picture]",
    "Photograph row 3, both sides of every tree.": "for Beside(both, of Rows(3, 3)): [picture]",
    "Take a picture of tree 50 from the east side.": "picture @ Beside(east, of TreeIs(50))",
    "Photograph tree 50 on its west side.": "picture @ Beside(west, of TreeIs(50))",
    "Photograph the west side of every tree in row 3.": "for Beside(west, of Rows(3, 3)): [picture]",
    "Photograph both sides of trees 4, 9 and 12.": (
        "for Beside(both, of UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12))): [picture]"
    ),
}
REFUSED = {
    "Drive at 3 m/s and photograph tree 4.": "husky drives at most 1 m/s",
    "Photograph the north side of tree 50.": "its sides are west and east",
    "Go to tree 4 and wait until I come back.": "asks for waiting until something happens",
    "Wait 30 hours at tree 4.": "a wait lasts at most 24 hours",
    "Photograph tree 4 at walking pace.": "asks for a way of driving",
}
ASKED = {
    "Photograph every yellow tree and wait 10 s.": "which is meant?",
    "Drive slowly and photograph tree 4.": "how fast?",
    "Go to tree 4 and wait.": "for how long?",
    "Photograph row 2, every tree. Then go to tree 90 and measure CO2, driving at 0.3 m/s.": "which is meant?",
}
AMIGA = {
    "Measure the soil moisture at depths of 20 and 40 cm at tree 4.": (
        "moisture(depth_cm 20) @ TreeIs(4); moisture(depth_cm 40)"
    ),
    "Moisture at 0.4 m at tree 4.": "moisture(depth_cm 40) @ TreeIs(4)",
    "Moisture 40 cm deep at tree 7.": "moisture(depth_cm 40) @ TreeIs(7)",
    "Take pictures of the trunk of tree 4.": "picture(view trunk) @ TreeIs(4)",
}
AMIGA_REFUSED = {
    "Moisture at tree 7 at a depth of 90 cm.": "90 cm is not between 5 and 60 cm",
    "Take a picture of tree 4 at a depth of 20 cm.": "has no such parameter; it has: view",
}


def outcome_of(request: str, robot: str = "husky") -> Planned | Clarify | Refused:
    return EnglishPlanner(suggests=False).plan(request, open_site("demo"), load_robot(robot))


@pytest.mark.parametrize(("request_", "plan"), PLANNED.items())
def test_planned(request_: str, plan: str) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan
    # Every word has a part in the plan.
    unused = [piece.text for piece in request_pieces(outcome.task) if piece.role == "nothing"]
    assert [text for text in unused if text.isalnum()] == []


@pytest.mark.parametrize(("request_", "plan"), AMIGA.items())
def test_parameters(request_: str, plan: str) -> None:
    outcome = outcome_of(request_, "amiga")
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan


@pytest.mark.parametrize(
    ("robot", "request_", "why"),
    [*(("husky", *one) for one in REFUSED.items()), *(("amiga", *one) for one in AMIGA_REFUSED.items())],
)
def test_refused(robot: str, request_: str, why: str) -> None:
    outcome = outcome_of(request_, robot)
    assert isinstance(outcome, Refused), outcome
    assert why in " ".join(str(reason.what) for reason in outcome.reasons)


@pytest.mark.parametrize(("request_", "question"), ASKED.items())
def test_asked(request_: str, question: str) -> None:
    outcome = outcome_of(request_)
    assert isinstance(outcome, Clarify), outcome
    assert question in str(outcome.question)


def test_slowly_is_the_speed_that_the_profile_says() -> None:
    robot = replace(load_robot("husky"), slow_m_s=0.25)
    outcome = EnglishPlanner(suggests=False).plan("Drive slowly and photograph tree 4.", open_site("demo"), robot)
    assert isinstance(outcome, Planned)
    assert outcome.task.constraints.speed_m_s == 0.25
    assert any("0.25 m/s" in str(one) for one in outcome.task.command.assumptions)


@pytest.mark.parametrize(
    "request_",
    [
        "Photograph rows 3 and 4 and wait half a minute at the end of each row.",
        "Photograph rows 3 and 4, waiting half a minute at the end of each row.",
    ],
)
def test_a_wait_at_several_places_beside_other_work_is_not_made_afterwards(request_: str) -> None:
    outcome = EnglishPlanner().plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(outcome, Refused)
