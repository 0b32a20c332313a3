"""Places by what earlier missions did, from a model: described in the prompt, planned without records, and checked."""

from __future__ import annotations

import pytest

from fieldhand.planning.llm.language import describe_language
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.testing.scripted_chat import ScriptedChat, planner_of, task_document
from planning.english.outlines import outline

VISITS = (
    '<for-each words="{words}"><select>{select}</select><body><act words="{act}"><take_thermal_picture/></act></body>'
    "</for-each>"
)
PICTURE = "Take a picture"
SINCE_MONDAY = '<excluding><places><done-earlier><period first-day="mon"/></done-earlier></places></excluding>'


def answer(words: str, select: str) -> str:
    return task_document(VISITS.format(words=words, select=select, act=PICTURE))


@pytest.mark.parametrize(
    ("places", "select", "expected"),
    [
        ("every tree not visited since Monday", SINCE_MONDAY, "for Excluding(DoneEarlier(first_day mon)): [picture]"),
        ("the 10 hottest trees of last week",
         '<top-earlier count="10"><canopy_temperature/><period calendar="last_week"/></top-earlier>',
         "for TopEarlier(canopy_temperature, 10, calendar last_week): [picture]"),
        ("the trees where CO2 was above 450 ppm last time",
         '<where-earlier test="gt"><co2 value="450" unit="ppm"/><period last-missions="1"/></where-earlier>',
         "for WhereEarlier(co2, gt, 450, ppm, missions 1): [picture]"),
        ("the trees we did not get to yesterday",
         '<done-earlier outcome="left_out"><period calendar="yesterday"/></done-earlier>',
         "for DoneEarlier(left_out, calendar yesterday): [picture]"),
        ("the trees photographed in the last 3 days",
         '<done-earlier action="take_thermal_picture"><period last-days="3"/></done-earlier>',
         "for DoneEarlier(take_thermal_picture, days 3): [picture]"),
    ],
)  # fmt: skip
def test_an_answer_about_earlier_missions_becomes_a_task_without_records(
    places: str, select: str, expected: str
) -> None:
    chat = ScriptedChat(answer(f"of {places}", select))
    planned = planner_of(chat).plan(f"{PICTURE} of {places}", open_site("demo"), load_robot("husky"))
    assert isinstance(planned, Planned), chat.prompts[-1]
    assert outline(planned.task) == expected
    assert len(chat.prompts) == 1


@pytest.mark.parametrize(
    ("places", "select", "problem"),
    [
        ("every tree not visited since Monday", "<trees/>", "since monday"),
        ("the trees photographed yesterday", "<trees/>", "yesterday"),
        ("the trees photographed yesterday",
         '<done-earlier><period calendar="last_week"/></done-earlier>', "yesterday"),
        ("the trees that have not been photographed", "<trees/>", "have not been photographed"),
        ("the trees photographed in the last 3 days",
         '<done-earlier><period last-days="5"/></done-earlier>', "last 3 days"),
        ("the 10 hottest trees of last week", '<take count="10"><trees/></take>', "last week"),
    ],
)  # fmt: skip
def test_words_about_the_past_demand_places_that_depend_on_it(places: str, select: str, problem: str) -> None:
    chat = ScriptedChat(answer(f"of {places}", select), "<refusal>no</refusal>")
    planner_of(chat).plan(f"{PICTURE} of {places}", open_site("demo"), load_robot("husky"))
    assert len(chat.prompts) == 2
    assert problem in chat.prompts[1].lower()


def test_the_description_has_the_period_as_its_own_element() -> None:
    text = describe_language()
    assert "<period [calendar=" in text
    assert "[<period/>]" in text
    assert "earlier-missions" not in text
