"""What an error says can be printed on any terminal, whatever it quotes."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from fieldhand.errors import SiteError, TaskError


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
    assert len(str(error)) < 5_000
    assert error.what.endswith("...")
