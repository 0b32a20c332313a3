"""Wishes to be told what the report of a mission says anyway: "and tell me the average", "how far apart are they?"."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline
from planning.grammar.field_requests import require_refusal
from support.sites.gardens import glasshouse, pasture, vegetable_garden

GARDEN, GLASSHOUSE, PASTURE, ORCHARD = vegetable_garden(), glasshouse(), pasture(), open_site("demo")
HUSKY, AMIGA = load_robot("husky"), load_robot("amiga")

BEFORE = [
    (GARDEN, AMIGA, "Measure soil moisture beside five random potatoes"),
    (PASTURE, AMIGA, "Measure soil nitrate at four random points each on the bank and in the boggy corner"),
    (PASTURE, HUSKY, "Walk a W across the long pasture with nine CO2 readings"),
    (GLASSHOUSE, HUSKY, "Take a thermal picture of the melons"),
    (ORCHARD, HUSKY, "Read CO2 at trees 4 and 9"),
]
BEHIND = [
    " and tell me the average.",
    " and report the mean and the highest one.",
    " and give me the average.",
    ", then let me know the average of all of them.",
    ". What is the average?",
    ". I want the mean, the lowest and the highest value.",
    " and say which is higher.",
    ". Which one is higher?",
    ". How far apart are the values?",
    " and work out the difference.",
    " and compare the averages.",
    ", and compare the readings with each other.",
    " and let me know how they differ.",
    ". Which of the two is higher on average?",
    " and tell me all the readings.",
    ". I'd like to know the range.",
]


@pytest.mark.parametrize("behind", BEHIND)
@pytest.mark.parametrize(("site", "robot", "work"), BEFORE)
def test_what_the_report_says_anyway_changes_no_plan(site: object, robot: object, work: str, behind: str) -> None:
    plain, told = (EnglishPlanner().plan(f"{work}{end}", site, robot) for end in (".", behind))
    assert isinstance(plain, Planned)
    assert isinstance(told, Planned), told
    assert outline(told.task) == outline(plain.task)


@pytest.mark.parametrize(
    ("site", "robot", "request_", "plan"),
    [
        (
            PASTURE,
            HUSKY,
            "Report the mean of CO2 at four spots on the bank.",
            "for PointsIn(bank, 4): [co2] | return_to_start",
        ),
        (
            PASTURE,
            AMIGA,
            "Tell me the average soil moisture at eight points in the cow paddock.",
            "for PointsIn(cow paddock, 8): [moisture] | return_to_start",
        ),
        (
            PASTURE,
            HUSKY,
            "Read CO2 on the bank and in the boggy corner, tell me which is higher, then drive to the middle gate.",
            "for UnionOf(PointsIn(bank)+PointsIn(boggy corner)): [co2]; go GateIs(middle gate) | return_to_start",
        ),
    ],
)
def test_a_report_wish_stands_among_commands(site: object, robot: object, request_: str, plan: str) -> None:
    outcome = EnglishPlanner().plan(request_, site, robot)
    assert isinstance(outcome, Planned), outcome
    assert outline(outcome.task) == plan


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        ("Read CO2 on the bank. Report the average of the long pasture.", ""),
        ("Read CO2 on the bank and report the average air temperature.", "air temperature"),
        ("Read CO2 on the bank. If it is above 500 ppm, tell me the difference.", "tell me"),
        ("Read CO2 on the bank and email me the average.", "email me"),
        ("Read CO2 on the bank and compare them with last week.", "last week"),
    ],
)
def test_what_no_report_says_is_refused(request_: str, why: str) -> None:
    require_refusal(PASTURE, HUSKY, request_, why)
