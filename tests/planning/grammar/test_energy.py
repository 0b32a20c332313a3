"""Requests about recharging and about the battery."""

from __future__ import annotations

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline
from support.missions.rechargeable import rechargeable

PLANNER, SITE, ROBOT = EnglishPlanner(), open_site("demo"), rechargeable(1_500_000)

EVERY = "for Trees: [picture]"

PLANNED = [
    ("Photograph every tree. Recharge as often as needed.", f"{EVERY} | recharge"),
    ("Photograph every tree, recharging whenever necessary.", f"{EVERY} | recharge"),
    ("Photograph every tree and recharge when needed.", f"{EVERY} | recharge"),
    ("Photograph every tree; if need be go back to the charger and charge.", f"{EVERY} | recharge"),
    ("Photograph every tree and charge when low.", f"{EVERY} | recharge"),
    ("Photograph every tree. If the battery gets low, recharge.", f"{EVERY} | recharge"),
    ("Photograph every tree, with recharging.", f"{EVERY} | recharge"),
    ("Photograph every tree. You may recharge.", f"{EVERY} | recharge"),
    ("Every tree, a picture. Go and charge when you have to, then pick up where you left off.", f"{EVERY} | recharge"),
    ("Measure CO2 at every tree, recharging as often as it takes.", "for Trees: [co2] | recharge"),
    (
        "Photograph every tree in row 3; top up at the charger whenever necessary.",
        "for Rows(3, 3): [picture] | recharge",
    ),
    (
        "Take a thermal picture of every tree in the northern half, stopping to recharge whenever needed.",
        "for Half(north): [picture] | recharge",
    ),
    (
        "As many trees as you can in 3 hours, a picture of each, recharging as needed.",
        "for Trees optional: [picture] | duration_s 10800 | recharge",
    ),
    ("Photograph every tree with at most two charges.", f"{EVERY} | recharge at most 2"),
    ("Photograph every tree; recharge at most twice.", f"{EVERY} | recharge at most 2"),
    ("Photograph every tree; charge as often as needed, up to 90 %.", f"{EVERY} | recharge to 90"),
    ("Photograph every tree and recharge when the battery is below 30 %.", f"{EVERY} | recharge below 30"),
    ("If the battery is below 30 %, recharge and go on. Photograph every tree.", f"{EVERY} | recharge below 30"),
    (
        "Photograph every tree. When the battery drops below 25 % go to the charger, charge to 90 % and continue.",
        f"{EVERY} | recharge below 25 to 90",
    ),
    ("Photograph tree 4, then recharge, then photograph tree 9.", "picture @ TreeIs(4); recharge; picture @ TreeIs(9)"),
    ("Photograph tree 4 and then charge the battery.", "picture @ TreeIs(4); recharge"),
    (
        "Photograph tree 4. Charge fully. Photograph tree 5.",
        "picture @ TreeIs(4); recharge to 100; picture @ TreeIs(5)",
    ),
    (
        "Photograph tree 4, then charge to 80 % and go on. Photograph tree 5.",
        "picture @ TreeIs(4); recharge to 80; picture @ TreeIs(5)",
    ),
    (
        "Photograph tree 4, go to the charger and charge for 20 minutes, then photograph tree 9.",
        "picture @ TreeIs(4); go Marker(charger); recharge for 1200 s; picture @ TreeIs(9)",
    ),
    (
        "Photograph row 5, every tree. Then dock and charge until the battery is full. Then photograph tree 9.",
        "for Rows(5, 5): [picture]; recharge to 100; picture @ TreeIs(9)",
    ),
    (
        "Read CO2 at all corners, recharge to full, and take a picture of tree 9.",
        "for Corners: [co2]; recharge to 100; picture @ TreeIs(9)",
    ),
    (
        "Photograph tree 4. If the battery is above 60 %, photograph tree 9.",
        "picture @ TreeIs(4); if not battery <= 60: [picture @ TreeIs(9)]",
    ),
    (
        "Photograph tree 4. If the battery is under 40 %, go to the charger.",
        "picture @ TreeIs(4); if battery <= 40: [go Marker(charger)]",
    ),
    ("Photograph every tree. If the battery is below 50 percent come home.", f"{EVERY} | reserve 50 | return_to_start"),
    ("Take pictures of every tree until the battery is at 40 %.", f"{EVERY} | reserve 40"),
    ("Photograph tree 4. Be back before the battery is at 30 %.", "picture @ TreeIs(4) | reserve 30 | return_to_start"),
    ("Keep 30 minutes of battery and photograph tree 4.", "picture @ TreeIs(4) | reserve 19.2"),
    ("Photograph tree 4 and leave 20 minutes of battery.", "picture @ TreeIs(4) | reserve 12.8"),
]

NOT_PLANNED = [
    ("If the battery is below 50 percent come home.", "asks for a condition on the battery"),
    ("Photograph row 3, every tree, then charge to 80 % and go on with row 4, every tree.", "go on with row 4"),
]


def planned(request: str, robot: str = "") -> Outcome:
    return PLANNER.plan(request, SITE, load_robot(robot) if robot else ROBOT)


@pytest.mark.parametrize(("request_", "expected"), PLANNED)
def test_plans_recharging(request_: str, expected: str) -> None:
    found = planned(request_)
    assert isinstance(found, Planned), found
    assert outline(found.task) == expected


@pytest.mark.parametrize(("request_", "why"), NOT_PLANNED)
def test_refuses_or_asks_what_it_cannot_place(request_: str, why: str) -> None:
    found = planned(request_)
    assert isinstance(found, Refused | Clarify)
    assert why in (" ".join(r.what for r in found.reasons) if isinstance(found, Refused) else found.question)


def test_a_robot_without_a_charger_is_named() -> None:
    found = planned("Photograph every tree. Recharge as often as needed.", "husky")
    assert isinstance(found, Refused)
    assert found.reasons[0].what == "husky cannot recharge: its profile has no charging"


def test_a_reserve_in_minutes_is_said_in_percent() -> None:
    found = planned("Keep 30 minutes of battery and photograph tree 4.")
    assert isinstance(found, Planned)
    assert any("19.2 % of the battery" in text for text in found.task.command.assumptions)
