"""What an error says can be printed on any terminal, whatever it quotes."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.errors import SiteError, TaskError, few


@given(st.text(st.characters(categories=None)), st.text(st.characters(categories=None)))
def test_a_message_holds_nothing_that_steers_a_terminal(what: str, where: str) -> None:
    said = str(TaskError(what, where=where))
    said.encode()
    assert not any((ord(c) < 32 and c not in "\n\t") or 0x7F <= ord(c) < 0xA0 or c in "\u2028\u202e" for c in said)


@given(st.text("abc é樹\u00a0\n", max_size=400))
def test_plain_text_stays_as_it_is(text: str) -> None:
    assert SiteError(text, where=text, advice=text).what == text


def test_what_no_screen_holds_is_cut() -> None:
    error = TaskError("a" * 100_000, where="b" * 100_000, advice="c" * 100_000)
    assert len(str(error)) < 2_500
    assert error.what.endswith("...")


def test_of_many_names_the_first_are_listed_and_the_others_counted() -> None:
    names = [f"n{k}" for k in range(49)]
    assert few(names) == f"{', '.join(names[:12])} and 37 more"
    assert few(names[:3]) == "n0, n1, n2"
    assert few([]) == "none"


def test_a_document_with_many_mistakes_is_refused_in_few_words() -> None:
    from fieldhand.robot.capabilities import capabilities_of
    from fieldhand.robot.loader import load_robot
    from fieldhand.task.codec_shapes import NAMESPACE
    from fieldhand.task.schema import require_valid

    steps = "".join(f'<act id="n{k}" said=""><at><nowhere-{k}/></at><read_co2/></act>' for k in range(30))
    document = (
        f'<task xmlns="{NAMESPACE}" id="t"><command><request>x</request></command><task-composition><plan>'
        f'<sequence id="n99">{steps}</sequence></plan></task-composition></task>'
    )
    with pytest.raises(TaskError) as refused:
        require_valid(document.encode(), capabilities_of(load_robot("husky")), source="task.xml")
    said = str(refused.value)
    assert len(said) < 1_300
    assert "nowhere-0" in said
    assert "more" in said
