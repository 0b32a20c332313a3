"""Reading an answer: the same document is found whatever a model writes around it, and half of one never is."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.planning.llm.answer import (
    LONGEST_ANSWER,
    QuestionAnswer,
    RefusalAnswer,
    TaskAnswer,
    Unusable,
    read_answer,
)
from fieldhand.planning.llm.chat import Reply

DOCUMENT = '<task version="1">\n  <plan><act><take_picture/></act></plan>\n</task>'
prose = st.text(st.characters(exclude_characters="<>", exclude_categories=["Cs"]), max_size=60)


def read(text: str, finish: str = "stop") -> object:
    return read_answer(Reply(text=text, finish=finish))


@settings(max_examples=60)
@given(before=prose, after=prose, fence=st.sampled_from(["", "```", "```xml", "~~~"]))
def test_prose_and_fences_around_a_document_change_nothing(before: str, after: str, fence: str) -> None:
    wrapped = f"{before}\n{fence}\n{DOCUMENT}\n{fence[:3]}\n{after}"
    assert read(wrapped) == TaskAnswer(document=DOCUMENT)


@pytest.mark.parametrize(
    "text",
    [
        "<think>I could write <task><plan/></task> but no</think>\n" + DOCUMENT,
        "Here is the `<task>` that you asked for:\n" + DOCUMENT,
        '<?xml version="1.0"?>\n<!-- <task> in a comment -->\n' + DOCUMENT,
        DOCUMENT + "\n\nOnce more, the same:\n" + DOCUMENT,
    ],
    ids=["thought", "named before", "comment", "said twice"],
)
def test_what_only_looks_like_a_document_is_passed_over(text: str) -> None:
    assert read(text) == TaskAnswer(document=DOCUMENT)


@settings(max_examples=60)
@given(end=st.integers(min_value=len("<task>"), max_value=len(DOCUMENT) - 1))
def test_a_document_cut_off_anywhere_is_never_taken_for_a_whole_one(end: int) -> None:
    for finish in ("stop", "length"):
        answer = read(DOCUMENT[:end], finish)
        assert isinstance(answer, Unusable)
    assert answer.truncated


def test_an_answer_cut_off_in_the_prose_after_its_document_is_whole() -> None:
    assert read(DOCUMENT + "\nThis plan will", "length") == TaskAnswer(document=DOCUMENT)


def test_a_thought_that_never_ends_is_a_cut_off_answer() -> None:
    answer = read("<think>let me think about the corner trees", "length")
    assert isinstance(answer, Unusable)
    assert answer.truncated


@pytest.mark.parametrize(
    ("text", "finish"),
    [
        ("", "stop"),
        ("  \n", "stop"),
        ("I am sorry, I cannot do that.", "stop"),
        (DOCUMENT + DOCUMENT.replace("1", "2"), "stop"),
        (DOCUMENT + "<refusal>no</refusal>", "stop"),
        ("<refusal> </refusal>", "stop"),
        ("<refusal/>", "stop"),
        ("<question><choice>a</choice></question>", "stop"),
        ("x" * (LONGEST_ANSWER + 1), "stop"),
        (DOCUMENT, "content_filter"),
    ],
)
def test_what_is_no_answer_says_why(text: str, finish: str) -> None:
    answer = read(text, finish)
    assert isinstance(answer, Unusable)
    assert answer.reason.endswith(".")


def test_a_question_with_its_choices() -> None:
    choices = "<choice>row 3</choice><choice> the <b>end</b></choice>"
    text = f"<question>Which &quot;row&quot; &amp; side?\n {choices}</question>"
    assert read(text) == QuestionAnswer(question='Which "row" & side?', choices=("row 3", "the end"))


def test_a_refusal_with_its_reason() -> None:
    assert read("```\n<refusal>It has\n no arm.</refusal>\n```") == RefusalAnswer(reason="It has no arm.")


@settings(max_examples=100)
@given(
    parts=st.lists(
        st.sampled_from(["<task>", "</task>", "<question>", "</question>", "<task/>", "<", ">", "a", "<!--"])
    )
)
def test_no_text_raises(parts: list[str]) -> None:
    assert read("".join(parts)) is not None


def test_lines_are_counted_as_the_model_wrote_them() -> None:
    answer = read("<task>\n<!-- one\ntwo -->\n<plan/>\n</task>")
    assert isinstance(answer, TaskAnswer)
    assert answer.document.splitlines().index("<plan/>") == 3
