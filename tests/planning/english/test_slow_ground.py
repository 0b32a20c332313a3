"""Ground on which a mission drives slowly, in English."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_demo
from planning.english.outlines import outline

WORK = "Photograph rows 4 to 6"
PLAN = "for Rows(4, 6): [picture]"
HUSKY = load_robot("husky")

SLOW = [
    ("Drive at most 0.5 m/s within 10 m of the pond", "slow InZone(pond) 10 m at 0.5 m/s"),
    ("At most 0.5 m/s within 10 m of the pond", "slow InZone(pond) 10 m at 0.5 m/s"),
    ("Drive no faster than 0.5 m/s within 30 feet of the pond", "slow InZone(pond) 9.144 m at 0.5 m/s"),
    ("Within 10 m of the pond, drive at most 0.5 m/s", "slow InZone(pond) 10 m at 0.5 m/s"),
    ("Slow down to 0.3 m/s within 5 m of the pond", "slow InZone(pond) 5 m at 0.3 m/s"),
    ("Do not exceed 1 km/h within 5 m of the pond", "slow InZone(pond) 5 m at 0.277778 m/s"),
    ("Never exceed 0.4 m/s less than 5 m from the pond", "slow InZone(pond) 5 m at 0.4 m/s"),
    ("Drive at 0.3 m/s in row 5", "slow Rows(5, 5) at 0.3 m/s"),
    ("In row 5 drive at 0.3 m/s", "slow Rows(5, 5) at 0.3 m/s"),
    ("In row 5, drive no faster than 0.3 m/s", "slow Rows(5, 5) at 0.3 m/s"),
    ("Drive no faster than 0.4 m/s in rows 3 and 5", "slow Rows(3, 3) at 0.4 m/s | slow Rows(5, 5) at 0.4 m/s"),
    ("Do not drive faster than 0.5 m/s in the wet corner", "slow InZone(wet corner) at 0.5 m/s"),
    ("Drive at half speed in the wet corner", "slow InZone(wet corner) at 0.5 m/s"),
    ("Go no faster than 0.5 m/s in the wet corner", "slow InZone(wet corner) at 0.5 m/s"),
    ("Speed limit 0.3 m/s within 4 m of the charger", "slow Marker(charger) 4 m at 0.3 m/s"),
    ("Drive at 0.2 m/s within 3 m of tree 40", "slow TreeIs(40) 3 m at 0.2 m/s"),
]  # fmt: skip


@pytest.mark.parametrize(("rule", "slow"), SLOW)
def test_the_speed_holds_there_and_the_work_is_unchanged(rule, slow):
    for request in (f"{WORK}. {rule}.", f"{rule}. {WORK}.", f"{WORK}, and {rule[0].lower()}{rule[1:]}."):
        outcome = EnglishPlanner().plan(request, load_demo(), HUSKY)
        assert isinstance(outcome, Planned), (request, outcome)
        assert outline(outcome.task) == f"{PLAN} | {slow}"


def test_how_slowly_is_asked_or_taken_from_the_profile():
    request = f"{WORK}. Drive slowly in row 5."
    asked = EnglishPlanner().plan(request, load_demo(), HUSKY)
    assert isinstance(asked, Clarify)
    assert "how fast?" in asked.question
    outcome = EnglishPlanner().plan(request, load_demo(), replace(HUSKY, slow_m_s=0.4))
    assert isinstance(outcome, Planned)
    assert outline(outcome.task) == f"{PLAN} | slow Rows(5, 5) at 0.4 m/s"
    assert any("is taken as 0.4 m/s" in line for line in outcome.task.command.assumptions)


@pytest.mark.parametrize(
    ("rule", "why"),
    [
        ("Drive slowly near the pond", "how near"),
        ("Drive at 0.3 m/s in the swamp", "swamp"),
        ("Drive at 0.3 m/s in row 77", "77"),
        ("Drive at 3 m/s in row 5", "at most"),
        ("Drive at 0.001 m/s in row 5", "slower than a robot drives"),
    ],
)
def test_a_rule_that_says_too_little_or_cannot_be_kept_is_refused(rule, why):
    outcome = EnglishPlanner().plan(f"{WORK}. {rule}.", load_demo(), HUSKY)
    assert isinstance(outcome, Refused), outcome
    assert why in " ".join(str(reason.what) for reason in outcome.reasons)


def test_a_speed_of_the_whole_mission_remains_one():
    for request, speed in (("Photograph row 3 at 0.5 m/s.", 0.5), ("Never exceed 0.3 m/s. Photograph row 3.", 0.3)):
        outcome = EnglishPlanner().plan(request, load_demo(), HUSKY)
        assert isinstance(outcome, Planned)
        assert outcome.task.constraints.speed_m_s == speed
        assert outcome.task.constraints.slow == ()


@pytest.mark.parametrize("word", ["purple", "yesterday", "twice", "bravely"])
def test_no_word_of_such_a_sentence_is_dropped(word):
    words = ["Drive", "at", "0.3", "m/s", "in", "row", "5"]
    for at in range(len(words) + 1):
        sentence = " ".join([*words[:at], word, *words[at:]])
        outcome = EnglishPlanner().plan(f"{WORK}. {sentence}.", load_demo(), HUSKY)
        assert not isinstance(outcome, Planned) or outcome.task.command.warnings or outcome.task.command.no_part, (
            sentence
        )
