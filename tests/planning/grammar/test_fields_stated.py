"""Statements of growers beside a command: how their plants are, what day it is, what they do before or meanwhile."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from planning.grammar.field_requests import require_plan
from support.sites.gardens import pasture, vegetable_garden

GARDEN, PASTURE = vegetable_garden(), pasture()
AMIGA, TRACTOR = load_robot("amiga"), load_robot("tractor")

BEANS = "for EveryNth(2, of Where(crop, eq, bean)): [picture]"
BANK = "mow area InZone(bank)"

STATED = [
    (GARDEN, AMIGA, "The beans look pale. Photograph every second bean.", BEANS),
    (GARDEN, AMIGA, "The beans are wilting, so photograph every second bean.", BEANS),
    (GARDEN, AMIGA, "Beans come first today. Photograph every second bean.", BEANS),
    (GARDEN, AMIGA, "The beans are next. Photograph every second one.", BEANS),
    (GARDEN, AMIGA, "It is bean day. Photograph every second bean.", BEANS),
    (GARDEN, AMIGA, "Something has been eating the beans, so photograph every second bean.", BEANS),
    (GARDEN, AMIGA, "We have fleeced the beans. Photograph every second bean.", BEANS),
    (GARDEN, AMIGA, "Before I take the fleece off, photograph every second bean.", BEANS),
    (GARDEN, AMIGA, "Photograph every second bean before I take the fleece off.", BEANS),
    (GARDEN, AMIGA, "Photograph every second bean before we start watering.", BEANS),
    (GARDEN, AMIGA, "After we have watered the garden, photograph every second bean.", BEANS),
    (GARDEN, AMIGA, "While we have lunch, photograph every second bean.", BEANS),
    (PASTURE, TRACTOR, "The bank is steep, so mow it.", BANK),
    (PASTURE, TRACTOR, "The ground is rough, so mow the bank slowly, at 0.5 m/s.", f"{BANK} | speed 0.5"),
    (PASTURE, TRACTOR, "The grass is knee high on the bank. Mow the bank.", BANK),
    (PASTURE, TRACTOR, "The heifers stay in the stable, so mow the bank.", BANK),
    (PASTURE, TRACTOR, "Today is hay day. Mow the bank.", BANK),
    (PASTURE, TRACTOR, "Mow the bank before we turn the heifers out.", BANK),
]


@pytest.mark.parametrize(("site", "robot", "request_", "plan"), STATED)
def test_what_is_stated_beside_a_command_changes_no_plan(site: object, robot: object, request_: str, plan: str) -> None:
    require_plan(site, robot, request_, plan)


KEPT = [
    (PASTURE, TRACTOR, "The boggy corner is quicksand. Mow the long pasture."),
    (PASTURE, TRACTOR, "The heifers stay in the boggy corner. Mow the long pasture."),
    (PASTURE, TRACTOR, "The boggy corner is to be raked, so mow the long pasture."),
    (PASTURE, TRACTOR, "The bank should be raked, so mow it."),
    (PASTURE, TRACTOR, "Mow the bank before we come and rake it."),
    (PASTURE, TRACTOR, "Rake the bank, so mow it."),
    (GARDEN, AMIGA, "The squash come first today. Photograph the beans."),
    (GARDEN, AMIGA, "The squash come first. Photograph the beans, then the squash."),
    (GARDEN, AMIGA, "Is it hay day? Photograph the beans until it is."),
    (GARDEN, AMIGA, "You are weeding the beans. Photograph every second bean."),
]


@pytest.mark.parametrize(("site", "robot", "request_"), KEPT)
def test_what_may_restrict_the_work_is_not_left_out(site: object, robot: object, request_: str) -> None:
    assert not isinstance(EnglishPlanner().plan(request_, site, robot), Planned)
