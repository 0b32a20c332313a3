"""All that the built-in planner asks and refuses is made of messages, and the catalogues have each of them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from fieldhand.language import open_language, recalled
from fieldhand.mission import make_planner
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Answer, Clarify, Outcome, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import load_demo
from fieldhand.site.model import Site
from language.silent_language import silent_language, words_left, words_of
from support.requests import english as english_requests
from support.requests import rows as row_requests
from support.requests.planned import outcome_of, site_of

SILENT, SPANISH = silent_language(), open_language("es")
DEMO = load_demo()
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
ON_THE_DEMO = [
    (robot, request)
    for table in (english_requests.ASKED, english_requests.REFUSED, row_requests.ASKED, row_requests.REFUSED)
    for robot, request, *_ in table
]


def said(outcome: Outcome) -> Iterator[str]:
    """Return the text that a person is shown of a question or a refusal."""
    match outcome:
        case Clarify():
            yield outcome.question
            yield from outcome.choices
        case Refused():
            for reason in outcome.reasons:
                yield from (reason.what, reason.advice)


def names(site: Site, robot: RobotProfile) -> set[str]:
    """Words that no catalogue has: of the robot and what it measures, of the site and what is there."""
    values = {str(value) for tree in site.trees for value in tree.properties.values()}
    rows = {row.name for row in site.planting.rows} | {block.name for block in site.planting.blocks}
    whole = {robot.name, site.name, *values, *rows, *site.attributes, *(zone.name for zone in site.zones)}
    whole |= {tree.place.id for tree in site.trees} | {gate.place.id for gate in site.gates}
    return {word for name in whole for word in words_of(name)} | {"ppm", "degC", "percent"}


def left(request: str, outcome: Outcome, site: Site, robot: RobotProfile) -> list[str]:
    """Words of no message, but for those of the request, those that are near to them, and names."""
    known = names(site, robot) | set(words_of(request)) | set(words_of(request.lower()))
    return [f"{words} <- {text}" for text in said(outcome) if (words := words_left(SILENT.say(text), known))]


@pytest.mark.parametrize(("robot", "request_"), ON_THE_DEMO)
def test_no_question_or_refusal_is_without_translation(robot: str, request_: str) -> None:
    outcome = outcome_of(robot, request_)
    assert not isinstance(outcome, Planned)
    assert list(said(outcome))
    assert not left(request_, outcome, DEMO, ROBOTS[robot])


@pytest.mark.parametrize(
    ("site", "request_"),
    [(site, request) for site, request, becomes in row_requests.ELSEWHERE if becomes[:4] in ("asks", "refu")],
)
def test_nor_where_rows_and_blocks_are_others(site: str, request_: str) -> None:
    outcome = outcome_of("husky", request_, site)
    assert not isinstance(outcome, Planned)
    assert not left(request_, outcome, site_of(site), ROBOTS["husky"])


@pytest.mark.parametrize("request_", ["Fly to the moon.", "Toma una foto de todos los arboles", "Photograph tree 999."])
def test_nor_with_the_advice_to_name_a_model(request_: str) -> None:
    outcome = make_planner("auto", {}).plan(request_, DEMO, ROBOTS["husky"])
    assert not left(f"{request_} FIELDHAND_MODEL docs planning llm md", outcome, DEMO, ROBOTS["husky"])


def test_a_question_and_its_answer_are_said_among_the_assumptions() -> None:
    """Also of a Task that was read from its document, which holds them in English."""
    asked = EnglishPlanner().plan("Take pictures of some trees in row 3.", DEMO, ROBOTS["husky"])
    assert isinstance(asked, Clarify)
    answer = Answer(question=asked.question, answer=asked.choices[-1])
    said_at_once = SPANISH.say(answer.sentence())
    assert "«Take pictures of some trees in row 3»: ¿" in said_at_once
    assert "En cada uno de los 10" in said_at_once
    written = SPANISH.say(recalled(str(answer), "assumption"))
    assert written.split(" Respuesta: ")[0] == said_at_once.split(" Respuesta: ")[0]
