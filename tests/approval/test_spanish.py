"""The read-back in Spanish: nothing of it stays English, and a grower would sign it."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings

from fieldhand import mission
from fieldhand.language import Message, open_language
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_demo
from fieldhand.task.codec import decode, encode
from fieldhand.testing.generated.tasks import ROVER, Parts
from fieldhand.testing.small_orchard import husky, orchard
from fieldhand.wording.steps import write_lines
from support.requests.english import PLANNED
from support.requests.planned import outcome_of

SPANISH = open_language("es")
DEMO = load_demo()
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}

_SPEC = importlib.util.spec_from_file_location(
    "catalogue_words", Path(__file__).parents[2] / "scripts" / "catalogue.py"
)
assert _SPEC is not None
assert _SPEC.loader is not None
CATALOGUE = importlib.util.module_from_spec(_SPEC)
sys.modules[_SPEC.name] = CATALOGUE
_SPEC.loader.exec_module(CATALOGUE)


def words_of(text: str) -> set[str]:
    return set(re.findall(r"[^\W\d_]{2,}", re.sub(r"\{\w+\}", " ", text).lower()))


def _catalogue_words() -> tuple[set[str], set[str]]:
    from fieldhand.language.po import read_entries

    english, spanish = set[str](), set[str]()
    for entry in read_entries(next(CATALOGUE.catalogues()).read_text(encoding="utf-8")):
        if entry.template:
            english |= words_of(entry.template) | words_of(entry.many)
            for said in entry.translations:
                spanish |= words_of(re.sub("«[^»]*»", "", said))  # what is quoted is to be typed, in English
    return english, spanish


ENGLISH_WORDS, SPANISH_WORDS = _catalogue_words()
#: What units and the names of values in the built-in orchard are called is no English.
ONLY_ENGLISH = ENGLISH_WORDS - SPANISH_WORDS - {"kg", "cm", "ppm"}
#: Nor are names of the site: of its zones, and of a variety.
OF_THE_SITE = words_of(" ".join(zone.name for zone in DEMO.zones)) | {"carmel"}


def texts_in(part: Any) -> Iterator[str]:
    """Every text that a Task holds: names and values from files stand in the read-back as they are."""
    if isinstance(part, str):
        yield part
    elif isinstance(part, tuple | list):
        for one in part:
            yield from texts_in(one)
    elif is_dataclass(part):
        for one in fields(part):
            yield from texts_in(getattr(part, one.name))


def test_most_words_of_the_source_are_english_only() -> None:
    """The tests below look for these; were there few, they would find nothing."""
    assert len(ONLY_ENGLISH) > 200
    assert {"tree", "trees", "the", "row", "nearest", "budget", "drive"} <= ONLY_ENGLISH


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(task=Parts(ROVER).tasks())
def test_no_english_word_is_left_in_the_lines_of_any_task(task: Any) -> None:
    """Whatever the plan: words of the catalogue are Spanish; quoted names of unknown actions stay what they are."""
    given_words = words_of(" ".join(texts_in(task)))
    for line in write_lines(task, orchard(), husky(), {}):
        said = re.sub(r"«[^»]*»", " ", SPANISH.say(line.text))
        left = (words_of(said) & ONLY_ENGLISH) - given_words
        assert not left, f"{left} in {said!r}, from {line.text!r}"


@pytest.mark.parametrize(("robot", "request_"), [(r, q) for r, q, _ in PLANNED[::16]], ids=lambda v: str(v)[:40])
def test_whole_read_backs_of_requests_are_spanish(robot: str, request_: str) -> None:
    """Steps, limits, faults, assumptions, notes, totals and problems; also of the Task that was read from its file."""
    outcome = outcome_of(robot, request_)
    assert isinstance(outcome, Planned)
    assert all(isinstance(text, Message) for text in outcome.task.command.assumptions)
    again = decode(encode(outcome.task), source="task")
    said = []
    for task in (outcome.task, again):
        review = mission.review(task, DEMO, ROBOTS[robot])
        assert review.read_back is not None
        lines = SPANISH.read((*review.read_back.text_lines(), *(p.line() for p in review.problems)))
        said.append(lines)
        for line in lines:
            unquoted = re.sub(r"«[^»]*»", " ", line)
            assert not (words_of(unquoted) & ONLY_ENGLISH) - OF_THE_SITE, line
    assert said[0] == said[1]


GOLDEN = (Path(__file__).parents[1] / "data" / "spanish_read_backs.txt").read_text(encoding="utf-8")


def whole(robot: str, request_: str) -> str:
    outcome = outcome_of(robot, request_)
    assert isinstance(outcome, Planned), outcome
    review = mission.review(outcome.task, DEMO, ROBOTS[robot])
    assert review.read_back is not None
    return "\n".join(SPANISH.read(review.read_back.text_lines()))


def same_figures(text: str) -> str:
    """Set every figure of the drives and draws to 0: other tests compare them."""
    figures = ("  En total", "  Nueve", "  Probabilidad")
    lines = [re.sub(r"\d+", "0", line) if line.startswith(figures) else line for line in text.splitlines()]
    return re.sub(r"se esperan \d+ de (\d+), \d+ %", r"se esperan 0 de \1, 0 %", "\n".join(lines))


@pytest.mark.parametrize("case", GOLDEN.split("\n### ")[1:], ids=lambda c: c[:40])
def test_whole_read_backs_stand_as_a_grower_approved_them(case: str) -> None:
    heading, _, text = case.partition("\n")
    robot, _, request_ = heading.partition(": ")
    assert same_figures(whole(robot, request_)) == same_figures(text.rstrip())


def test_a_profile_brings_its_own_names_along() -> None:
    from dataclasses import replace

    from fieldhand.task.conditions import Compare
    from fieldhand.task.plan import Act
    from fieldhand.wording.conditions import say_act, say_condition

    robot = husky()
    action = replace(robot.action["read_co2"], name="sniff_air", labels={"es": "olfatear el aire"})
    quantity = replace(robot.quantity["co2"], name="smell", labels={"es": "el olor"})
    robot = replace(robot, actions=(action,), quantities=(quantity,))
    once, often = (say_act(Act(id="", action="sniff_air", count=count), robot) for count in (1, 3))
    assert (once, often) == ("sniff an air", "sniff 3 airs")
    assert [SPANISH.say(said) for said in (once, often)] == ["olfatear el aire", "olfatear el aire 3 veces"]
    condition = Compare(reading="r", quantity="smell", test="lt", value=2.5, unit="ppm")
    assert SPANISH.say(say_condition(condition, {"r": ""}, robot)) == "el olor es inferior a 2,5 ppm"
