"""Whatever a model writes: a typed problem or a draft, never a traceback, and never long."""

from __future__ import annotations

import re

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fieldhand.planning.llm.answer import LONGEST_ANSWER, TaskAnswer, Unusable, read_answer
from fieldhand.planning.llm.chat import Reply
from fieldhand.planning.llm.coordinates import coordinates
from fieldhand.planning.llm.request_contradictions import request_contradictions
from fieldhand.planning.llm.review import AnswerProblem, read_draft, review
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.build import make_task
from fieldhand.task.codec import TaskDraft, encode
from fieldhand.task.frames import Task
from fieldhand.testing.generated.tasks import ROVER, Parts
from fieldhand.testing.scripted_chat import task_document

DEMO, HUSKY = open_site("demo"), load_robot("husky")
ABLE = capabilities_of(HUSKY)
KINDS = {"answer", "schema", "reference", "site", "coordinate", "request"}
QUIET = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
GOOD = task_document(
    '<for-each label="l"><select><where attribute="variety" test="eq" value="Carmel"><half side="north"/></where>'
    '</select><body><sequence><act reading="r" count="2"><take_thermal_picture/></act><if><condition>'
    '<compare reading="r" test="lt"><canopy_temperature value="33" unit="degC"/></compare></condition>'
    "<then><act><read_co2/></act></then></if></sequence></body></for-each>",
    '<exits nominal="return_to_start"/><!--constraints-->'
    '<constraints><budget kind="distance_m" limit="500"/></constraints>',
)
#: What goes wrong inside a document.
SPLICES = [
    "", "<", ">", "&", "&x;", "&#0;", "&#x110000;", "]]>", "<![CDATA[", "<!--", "-->", "<?xml?>", "<?pi", "\x00",
    "\x1b", "\ufffe", '"', "'", "=", "<a:b/>", ' xmlns="urn:x"', ' xmlns:f="urn:fieldhand:task:1"', "<f:act/>",
    "</task>", "<task>", "<stop/>", "<sequence>", "</sequence>", "9" * 400, "-1", "1e999", "NaN", "INF", "0x10",
    "\u0664", "1" + "0" * 18, "true", " ", "\n", '<!DOCTYPE task [<!ENTITY a "b">]>',
    '<!ENTITY % x SYSTEM "http://127.0.0.1/">', "<half side='north'>", "\u202e", "\ud7ff",
]  # fmt: skip


def read(document: str) -> tuple[AnswerProblem, ...]:
    """Everything that is done with a document before it is a plan."""
    answer = read_answer(Reply(text=document))
    if not isinstance(answer, TaskAnswer):
        return (AnswerProblem(kind="answer", message=getattr(answer, "reason", "question or refusal")),)
    draft = read_draft(answer.document, ABLE)
    if not isinstance(draft, TaskDraft):
        return draft
    found = (*review(draft, DEMO, ABLE), *coordinates(draft, "Go.", DEMO))
    if found:
        return found
    task = make_task(request="Go.", plan=draft.plan, measures={}, constraints=draft.constraints, nominal=draft.nominal)
    return request_contradictions(task, draft, DEMO, HUSKY)


def is_typed(found: tuple[AnswerProblem, ...]) -> bool:
    return all(p.kind in KINDS and p.message and "\n" not in str(p) for p in found)


def test_the_document_that_is_broken_below_is_sound() -> None:
    draft = read_draft(GOOD, ABLE)
    assert isinstance(draft, TaskDraft), draft
    assert review(draft, DEMO, ABLE) == ()


@QUIET
@given(st.data())
def test_a_document_with_pieces_cut_out_doubled_or_spliced_in_is_a_typed_problem(data: st.DataObject) -> None:
    text = GOOD
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text)))
        until = min(len(text), at + data.draw(st.integers(0, 30)))
        way = data.draw(st.sampled_from(("splice", "cut", "double")))
        piece = data.draw(st.sampled_from(SPLICES)) if way == "splice" else text[at:until] * 2 * (way == "double")
        text = text[:at] + piece + text[at if way == "splice" else until :]
    assert is_typed(read(text))


@QUIET
@given(attribute=st.sampled_from(sorted(set(re.findall(r'="([^"]+)"', GOOD)))), value=st.sampled_from(SPLICES))
def test_any_value_of_an_attribute_is_read_or_a_typed_problem(attribute: str, value: str) -> None:
    assert is_typed(read(GOOD.replace(f'="{attribute}"', f'="{value}"', 1)))


@QUIET
@given(end=st.integers(0, len(GOOD) - 1))
def test_half_a_document_is_never_a_plan(end: int) -> None:
    assert {p.kind for p in read(GOOD[:end])} == {"answer"}
    assert isinstance(read_draft(GOOD[:end], ABLE), tuple)


@settings(QUIET, max_examples=20)
@given(task=Parts(ROVER).tasks())
def test_a_valid_task_of_another_robot_with_any_numbers_is_read_or_a_typed_problem(task: Task) -> None:
    assert is_typed(read(encode(task).decode().partition("\n")[2]))


DEEP = ["half", "sequence", "union", "not", "excluding", "then", "x"]


@pytest.mark.parametrize("name", DEEP)
@pytest.mark.parametrize("depth", [60, 250, 3_000])
def test_whatever_nests_deep_is_a_typed_problem(name: str, depth: int) -> None:
    found = read_draft(task_document(f"<{name}>" * depth + f"</{name}>" * depth), ABLE)
    assert isinstance(found, tuple)
    assert is_typed(found)


def for_each(selector: str) -> str:
    return task_document(
        f"<for-each><select>{selector}</select><body><act><take_thermal_picture/></act></body></for-each>"
    )


HUGE = "9" * 18
EXTREMES = [
    '<spaced apart-m="1e-300"/>', '<spaced apart-m="0.000001"/>', '<spaced apart-m="0"/>', '<spaced apart-m="-1"/>',
    '<spaced apart-m="1e300" count="1000"/>', '<points-in zone="wet corner" count="1000"/>', '<rows every="0"/>',
    f'<along-row trees="{HUGE}"/>', f'<along-row trees="-{HUGE}"/>', f'<in-row first="-{HUGE}" last="{HUGE}"/>',
    f'<nth nth="{HUGE}"><trees/></nth>', '<nth nth="0"><trees/></nth>', '<every-nth nth="0"/>',
    f'<row-of over="{HUGE}"/>', f'<every-nth nth="{HUGE}" start="-{HUGE}"/>',
    f'<rows first="{HUGE * 300}" last="-{HUGE}"/>', '<successive count="1000"/>',
    f'<extreme side="north" count="{HUGE}"/>', '<within distance-m="1e308"><to><here/></to></within>',
    '<tree-is tree=""/>', f'<tree-is tree="{HUGE * 300}"/>', "<union>" + "<trees/>" * 1_000 + "</union>",
    '<bound label="nowhere"/>', '<adjacent count="1000"><near><here/></near></adjacent>',
    "<union>" * 60 + "<other/>" + "</union>" * 60,
]  # fmt: skip


@pytest.mark.parametrize("selector", EXTREMES, ids=lambda s: str(s)[:40])
def test_extreme_numbers_are_read_or_a_typed_problem(selector: str) -> None:
    assert is_typed(read(for_each(selector)))


#: Beginnings that never end: a reader that looks for the end from each of them takes quadratic time.
ENDLESS = [
    "<!--",
    "<think>",
    "<task>",
    "<task",
    "<question><choice>",
    "<choice x='",
    "<",
    "&",
    "<![CDATA[",
    "-->",
    "</task>",
]


@pytest.mark.parametrize("piece", ENDLESS)
@pytest.mark.parametrize(("before", "after"), [("", ""), ("<question>q", "</question>"), ("<task>", "</task>")])
def test_an_answer_full_of_beginnings_is_read_in_one_pass(
    piece: str, before: str, after: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Twenty times the longest answer: a reader that took quadratic time would not come back within the hour."""
    monkeypatch.setattr("fieldhand.planning.llm.answer.LONGEST_ANSWER", 20 * LONGEST_ANSWER)
    middle = piece * ((20 * LONGEST_ANSWER - len(before) - len(after)) // len(piece))
    assert read_answer(Reply(text=before + middle + after)) is not None


def test_a_longer_answer_is_not_even_looked_at() -> None:
    answer = read_answer(Reply(text="<task>" * LONGEST_ANSWER))
    assert isinstance(answer, Unusable)
    assert "longer than" in answer.reason


@pytest.mark.parametrize(
    "namespace",
    ["", "urn:fieldhand:task:2", "http://www.w3.org/2001/XMLSchema", "urn:fieldhand:task:1 ", "&#0;", "\u202e"],
)
def test_a_wrong_namespace_is_a_schema_problem(namespace: str) -> None:
    found = read_draft(GOOD.replace("urn:fieldhand:task:1", namespace), ABLE)
    assert isinstance(found, tuple)
    assert {p.kind for p in found} == {"schema"}
