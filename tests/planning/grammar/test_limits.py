"""Ways to say a limit on time, distance and battery, and where a mission ends."""

from __future__ import annotations

import pytest

from fieldhand.approval.account import unaccounted
from fieldhand.planning.grammar.reader import composed
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

DEMO = open_site("demo")
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
PLANNED = [
    (
        "husky",
        "Photograph every tree of row 3, but don't use more than 20 % of the battery.",
        "for Rows(3, 3): [picture] | energy_percent 20",
    ),
    (
        "husky",
        "Photograph every tree of row 3 without using more than 20 % of the battery.",
        "for Rows(3, 3): [picture] | energy_percent 20",
    ),
    (
        "husky",
        "Photograph every tree of row 3 in no more than 10 minutes.",
        "for Rows(3, 3): [picture] | duration_s 600",
    ),
    ("husky", "Photograph every tree of row 3 in at most 10 minutes.", "for Rows(3, 3): [picture] | duration_s 600"),
    (
        "husky",
        "Photograph as many trees as possible, in 10 minutes at most.",
        "for Trees optional: [picture] | duration_s 600",
    ),
    (
        "husky",
        "Photograph as many trees as you can within a quarter of an hour.",
        "for Trees optional: [picture] | duration_s 900",
    ),
    (
        "husky",
        "Photograph as many trees as you can in an hour and a half.",
        "for Trees optional: [picture] | duration_s 5400",
    ),
    ("husky", "Photograph as many trees as you can in 1.5 hours.", "for Trees optional: [picture] | duration_s 5400"),
    (
        "husky",
        "Photograph as many trees as you can in ninety minutes.",
        "for Trees optional: [picture] | duration_s 5400",
    ),
    (
        "husky",
        "Photograph as many trees as you can in half an hour.",
        "for Trees optional: [picture] | duration_s 1800",
    ),
    (
        "husky",
        "Photograph as many trees as you can; you have half an hour.",
        "for Trees optional: [picture] | duration_s 1800",
    ),
    (
        "husky",
        "Time limit: 20 minutes. Photograph as many trees as you can.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Max 20 minutes. Photograph as many trees as you can.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    ("husky", "Photograph as many trees as you can, max 20 min.", "for Trees optional: [picture] | duration_s 1200"),
    (
        "husky",
        "Photograph as many trees as you can (20 minutes max).",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Photograph as many trees as you can, 20 minutes tops.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "The whole thing must not take longer than 20 minutes. Photograph as many trees as you can.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "It should take no longer than 20 minutes. Photograph as many trees as you can.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Photograph as many trees as you can but be back in 20 minutes.",
        "for Trees optional: [picture] | duration_s 1200 | return_to_start",
    ),
    (
        "husky",
        "Photograph as many trees as you can but be back within 20 minutes.",
        "for Trees optional: [picture] | duration_s 1200 | return_to_start",
    ),
    (
        "husky",
        "Photograph as many trees as you can and return before 20 minutes are over.",
        "for Trees optional: [picture] | duration_s 1200 | return_to_start",
    ),
    (
        "husky",
        "Photograph as many trees as you can and come back after at most 20 minutes.",
        "for Trees optional: [picture] | duration_s 1200 | return_to_start",
    ),
    (
        "husky",
        "Photograph as many trees as you can before 20 minutes are up.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "In 20 minutes, photograph as many trees as possible.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Within 20 minutes photograph as many trees as possible.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "You have 20 minutes to photograph as many trees as possible.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Use at most 20 minutes to photograph as many trees as possible.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Spend no more than 20 minutes photographing as many trees as possible.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Spend at most 20 % of the battery on photographing as many trees as possible.",
        "for Trees optional: [picture] | energy_percent 20",
    ),
    (
        "husky",
        "Photograph as many trees as possible on 20 % of the battery.",
        "for Trees optional: [picture] | energy_percent 20",
    ),
    (
        "husky",
        "Photograph as many trees as possible using up to 20 % of the charge.",
        "for Trees optional: [picture] | energy_percent 20",
    ),
    (
        "husky",
        "Photograph as many trees as possible, keeping 30 % of the battery.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible, keep 30 % in the battery.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible and leave 30 % in the battery.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible, leaving at least 30 % battery.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible; battery must stay above 30 %.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible. The battery must not drop below 30 %.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible. Don't let the battery fall below 30 %.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible. Never go under 30 % battery.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible. I want 30 % left at the end.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible, with 30 % battery left at the end.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible and be home with 30 % of battery remaining.",
        "for Trees optional: [picture] | reserve 30 | return_to_start",
    ),
    (
        "husky",
        "Photograph as many trees as possible; return with at least 30 percent charge.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Be back before the battery is at 30 % and photograph as many trees as possible.",
        "for Trees optional: [picture] | reserve 30 | return_to_start",
    ),
    (
        "husky",
        "Photograph as many trees as possible until the battery is down to 30 %.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Stop when the battery is at 30 %. Photograph as many trees as possible.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible; come back when the battery reaches 30 %.",
        "for Trees optional: [picture] | reserve 30 | return_to_start",
    ),
    (
        "husky",
        "Save 30 % of the battery. Photograph as many trees as possible.",
        "for Trees optional: [picture] | reserve 30",
    ),
    (
        "husky",
        "Photograph as many trees as possible, driving at most 500 m.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Photograph as many trees as possible and drive no more than 500 metres.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Photograph as many trees as possible without driving more than half a kilometre.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Photograph as many trees as possible within 500 m of driving.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Photograph as many trees as possible, total distance under 500 m.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Photograph as many trees as possible; the distance must be less than 500 m.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Don't drive further than 500 m. Photograph as many trees as possible.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Distance limit 500 m. Photograph as many trees as possible.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Drive at most 500 m and photograph as many trees as possible.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    ("husky", "Photograph as many trees as possible; budget: 500 m.", "for Trees optional: [picture] | distance_m 500"),
    (
        "husky",
        "With a budget of 500 m, photograph as many trees as possible.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    ("husky", "Given 500 m, photograph as many trees as possible.", "for Trees optional: [picture] | distance_m 500"),
    (
        "husky",
        "Photograph as many trees as possible under a 500 m budget.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    (
        "husky",
        "Photograph as many trees as possible without exceeding 500 m.",
        "for Trees optional: [picture] | distance_m 500",
    ),
    ("husky", "Photograph as many trees as the battery allows.", "for Trees optional: [picture]"),
    (
        "husky",
        "Photograph as many trees as you can manage in 20 minutes.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Photograph as many trees as you can get to in 20 minutes.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Photograph as many of the trees of row 3 as possible within 10 minutes.",
        "for Rows(3, 3) optional: [picture] | duration_s 600",
    ),
    (
        "husky",
        "Take as many pictures as possible in row 3 within 10 minutes.",
        "for Rows(3, 3) optional: [picture] | duration_s 600",
    ),
    (
        "husky",
        "Take as many pictures in row 3 as possible within 10 minutes.",
        "for Rows(3, 3) optional: [picture] | duration_s 600",
    ),
    (
        "husky",
        "Get me as many CO2 readings as possible from the Carmel trees in 20 minutes.",
        "for Where(variety, eq, Carmel) optional: [co2] | duration_s 1200",
    ),
    (
        "husky",
        "Photograph the largest possible number of trees in 20 minutes.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    (
        "husky",
        "Photograph the maximum number of trees in 20 minutes.",
        "for Trees optional: [picture] | duration_s 1200",
    ),
    ("husky", "Photograph at least 10 trees within 20 minutes.", "for Take(10, of Trees): [picture] | duration_s 1200"),
    ("husky", "Photograph up to 10 trees within 20 minutes.", "for Trees at most 10: [picture] | duration_s 1200"),
    ("husky", "Photograph 10 trees in under 20 minutes.", "for Take(10, of Trees): [picture] | duration_s 1200"),
    ("husky", "Photograph tree 5 in less than half an hour.", "picture @ TreeIs(5) | duration_s 1800"),
]


@pytest.mark.parametrize(("robot", "request_", "plan"), PLANNED, ids=lambda value: str(value)[:60])
def test_a_limit_is_read_however_it_is_said(robot: str, request_: str, plan: str) -> None:
    found = composed(request_, DEMO, ROBOTS[robot])
    assert isinstance(found, Planned), found
    assert outline(found.task) == plan
    assert unaccounted(found.task) == ()
