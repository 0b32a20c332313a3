"""Everyday turns of phrase: what they mean, and that those which mean nothing are no obstacle."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

READ = [
    ("Start the morning in row 4: a thermal picture of every third tree.", "for EveryNth(3, of Rows(4, 4)): [picture]"),
    (
        "Take a picture of tree 4. If it is high, measure CO2 before you move on.",
        "picture @ TreeIs(4) = r1; if r1 high: [co2]",
    ),
    ("Photograph tree 4 and finish back at the start where I'm parked.", "picture @ TreeIs(4) | return_to_start"),
    ("Take one last picture at tree 9.", "picture @ TreeIs(9)"),
    (
        "I can spare the robot for 25 minutes. Photograph as many of the pale green trees as you can in that time.",
        "for Where(leaf_color, eq, pale green) optional: [picture] | duration_s 1500",
    ),
    ("I have only 10 minutes. Take a picture of tree 4.", "picture @ TreeIs(4) | duration_s 600"),
    ("Photograph the third, fifth and seventh rows.", "for UnionOf(Rows(3, 3)+Rows(5, 5)+Rows(7, 7)): [picture]"),
    ("Photograph the middle third of row 2.", "for InRow(7, 12, of Rows(2, 2)): [picture]"),
    ("Run down row 3 with a thermal picture every 15 metres.", "for Spaced(15, of Rows(3, 3)): [picture]"),
    ("At tree 4 I'd also like the CO2.", "go TreeIs(4); co2"),
    ("Photograph tree 4, then do tree 9 as well.", "picture @ TreeIs(4); go TreeIs(9); picture"),
    (
        "Photograph as many yellow trees as 30 percent of the battery allows.",
        "for Where(leaf_color, eq, yellow) optional: [picture] | energy_percent 30",
    ),
    (
        "Visit as many yellow trees as 60 minutes allow and take one CO2 reading at each.",
        "for Where(leaf_color, eq, yellow) optional: [co2] | duration_s 3600",
    ),
    (
        "Try to get a thermal picture of tree 50; if you can't reach it, take tree 51 instead. Either way, go on to "
        "tree 60 for an air temperature.",
        "try [picture @ TreeIs(50)] or [picture @ TreeIs(51)]; go TreeIs(60); air",
    ),
    ("Photograph tree 9 and, on the way back, tree 4.", "picture @ TreeIs(9); picture @ TreeIs(4)"),
    (
        "Measure the air temperature at tree 4. If it's over 35, come straight back; otherwise take a CO2 sample in "
        "the middle of the field on the way home.",
        "air @ TreeIs(4) = r1; if r1 > 35 degC: [go Marker(start)] else [co2 @ Middle] | return_to_start",
    ),
]


@pytest.mark.parametrize(("request_", "expected"), READ)
def test_a_turn_of_phrase_is_read_as_it_is_meant(request_: str, expected: str) -> None:
    planned = EnglishPlanner().plan(request_, open_site("demo"), load_robot("husky"))
    assert isinstance(planned, Planned)
    assert outline(planned.task) == expected
