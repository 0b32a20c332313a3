"""The chart parser: what it combines, what it skips, and which readings it keeps."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.planning.grammar.chart import Chart, Grammar, PhraseEdge, tokens_of

SUMS = Grammar()


@SUMS.construction("sum: n=number", cost=0.0)
def one(n: int) -> int:
    return n


@SUMS.construction("sum: left=sum plus right=number")
def added(left: int, right: int) -> int:
    return left + right


@SUMS.construction("sum: left=sum minus right=sum", cost=2.0)
def subtracted(left: int, right: int) -> int | None:
    return left - right if left >= right else None


@SUMS.construction("pair: first=sum [comma] second=sum")
def pair(first: int, second: int) -> list[tuple[int, int]]:
    return [(first, second), (second, first)]


def edges(text: str) -> list[PhraseEdge]:
    kinds = {"+": "plus", "-": "minus", ",": "comma", "um": "filler"}
    words = text.split()
    return [
        PhraseEdge(kinds.get(word, "number"), k, k + 1, int(word) if word.isdigit() else word, 1.0, 1 << k)
        for k, word in enumerate(words)
    ]


def chart(text: str) -> Chart:
    words = edges(text)
    made = Chart(SUMS, len(words), frozenset(k for k, word in enumerate(words) if word.category == "filler"))
    made.parse(words)
    return made


def test_meanings_are_composed_from_the_parts() -> None:
    assert [edge.meaning for edge in chart("1 + 2 + 3").whole("sum")] == [6]


def test_parts_that_do_not_fit_make_no_phrase() -> None:
    assert chart("1 - 2").whole("sum") == []
    assert chart("1 +").whole("sum") == []


def test_readings_of_different_meaning_are_kept_cheapest_first() -> None:
    found = chart("9 - 4 - 2").whole("sum")
    assert {edge.meaning for edge in found} == {3, 7}
    assert [edge.cost for edge in found] == sorted(edge.cost for edge in found)


def test_one_construction_can_give_several_meanings_and_have_optional_parts() -> None:
    for text in ("1 2", "1 , 2"):
        assert {edge.meaning for edge in chart(text).whole("pair")} == {(1, 2), (2, 1)}


@pytest.mark.parametrize("text", ["um 1 + 2", "1 um + 2", "1 + um um 2 um"])
def test_fillers_are_skipped_at_a_price_and_are_no_part_of_the_phrase(text: str) -> None:
    (found,) = chart(text).whole("sum")
    assert found.meaning == 3
    assert [text.split()[k] for k in tokens_of(found.used)] == ["1", "+", "2"]


def test_a_word_that_no_construction_uses_is_never_skipped() -> None:
    assert chart("1 + 2 , 3 +").whole("pair") == []


@given(st.lists(st.integers(min_value=0, max_value=99), min_size=1, max_size=12))
def test_a_sum_of_any_length_is_read_in_one_way(numbers: list[int]) -> None:
    found = chart(" + ".join(map(str, numbers))).whole("sum")
    assert [edge.meaning for edge in found] == [sum(numbers)]
    assert found[0].used == (1 << (2 * len(numbers) - 1)) - 1


@given(st.text(alphabet="1+- ,", max_size=24))
def test_the_same_words_give_the_same_readings(text: str) -> None:
    spaced = " ".join(text.replace(" ", ""))
    first, second = chart(spaced), chart(spaced)
    assert first.whole("sum") == second.whole("sum")
    assert first.whole("pair") == second.whole("pair")


def test_a_text_that_takes_too_many_combinations_has_no_reading() -> None:
    words = edges(" - ".join(["9"] * 60))
    made = Chart(SUMS, len(words), frozenset(), most=500)
    made.parse(words)
    assert made.whole("sum") == []
    assert made.combinations < 2_000
