"""Sentences are known again in text from a file, and no text costs more than its length says."""

from __future__ import annotations

import pytest

from fieldhand.language import kept_in_log, open_language
from fieldhand.language.catalogue import _LONGEST_RETOLD
from fieldhand.language.po import Entry
from fieldhand.language.recalling import _MOST_STEPS, Effort, Sentence, sentences

SPANISH = open_language("es")


class Counted(Effort):
    """Effort that counts its steps."""

    def __init__(self) -> None:
        super().__init__()
        self.steps = 0

    def step(self) -> bool:
        self.steps += 1
        return super().step()


def one(template: str, context: str = "question") -> Sentence:
    return sentences([Entry(template=template, translations=("x",), context=context)])[context][0]


@pytest.mark.parametrize(
    ("template", "text", "fills"),
    [
        ("nothing", "nothing", {}),
        ("nothing", "nothing else", None),
        ("'{said}': which row?", "'a: b': which row?", {"said": "a: b"}),
        ("{one} or {other}?", "a or b or c?", {"one": "a", "other": "b or c"}),
        ("{n} at each, or {n} in all?", "2 at each, or 2 in all?", {"n": "2"}),
        ("{n} at each, or {n} in all?", "2 at each, or 3 in all?", None),
        ("a{one}a", "aa", {"one": ""}),
        ("a{one}a", "a", None),
    ],
)
def test_a_sentence_is_known_with_what_fills_it(template: str, text: str, fills: dict[str, str] | None) -> None:
    assert one(template).fills_of(text, Effort()) == fills


def test_a_log_knows_figures_from_words() -> None:
    sentence = one("{reading} is below {limit}", "log")
    assert sentence.fills_of("31 °C is below 33 °C", Effort())
    assert sentence.fills_of("it is below 33 °C", Effort()) is None


@pytest.mark.parametrize(
    "piece",
    [
        "a and ",
        "a: ",
        "a; ",
        "x is below y and ",
        "1 m, ",
        "drive to tree 4: ",
        "at tree 4 ",
        "(",
        "12 m left; going to ",
    ],
)
def test_no_text_takes_more_steps_than_there_are(piece: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Sentences within sentences once made 600 characters take longer than anybody would wait."""
    efforts: list[Counted] = []

    def counted() -> Counted:
        efforts.append(Counted())
        return efforts[-1]

    monkeypatch.setattr("fieldhand.language.catalogue.Effort", counted)
    for length in (_LONGEST_RETOLD, 100_000):
        SPANISH.say(kept_in_log((piece * length)[:length]))
    # Steps are asked for where none is left, too: once for each sentence that begins and ends as the text does.
    most = _MOST_STEPS + sum(map(len, SPANISH.patterns.values()))
    assert 0 < max(effort.steps for effort in efforts) < 10 * most
