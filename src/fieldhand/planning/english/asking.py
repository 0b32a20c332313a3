"""Questions about noun phrases, each choice with the words that it stands for in the request."""

from __future__ import annotations

from collections.abc import Iterable

from fieldhand.language import Message, message, named
from fieldhand.language.words import say_action
from fieldhand.planning.english.faults import Question, text_of
from fieldhand.planning.english.syntax import ClausePart, PlacePhrase


def how_many(
    phrase: PlacePhrase, numbers: tuple[str, ...] = ("2", "3", "4"), *, asked: str = "", of_all: bool = False
) -> Question:
    """How many of what a noun phrase names.

    Args:
        phrase: The noun phrase, without a number.
        numbers: The numbers to choose from.
        asked: The question, if it is another than "how many?".
        of_all: All of them is a choice, too.
    """
    article = "the " if any(t.kind == "DET" and t.text.lower() == "the" for t in phrase.quantity) else ""
    words = [f"{article}{number} {_named(phrase)}" for number in numbers]
    choices = numbers
    if of_all:
        words.append(f"all {_named(phrase)}")
        choices = (*numbers, message("all of them", context="answer"))
    return Question(
        asked or message("'{said}': how many?", context="question", said=text_of(phrase.terms)),
        choices,
        terms=phrase.terms,
        words=tuple(words),
    )


def which_of(phrase: PlacePhrase, asked: str, *, there: int, claimed: int | None) -> Question:
    """All of what a noun phrase names, or any so many of them; ``claimed``: None where there are not so many."""
    every = f"all {_named(phrase)}" if there > 1 else f"the {_named(phrase)}"
    choices: dict[str, str] = {message("all {count} of them", context="answer", count=there): every} if there else {}
    if claimed is not None:
        any_of_them = message("any {count} of them", context="answer", count=claimed)
        choices[any_of_them] = f"any {claimed} {_named(phrase)}" if claimed > 1 else f"a {_named(phrase)}"
    return Question(asked, tuple(choices), terms=phrase.terms, words=tuple(choices.values()))


def every_or_how_many(part: ClausePart) -> Question:
    """At every tree of an area, or at so many of them."""
    asked = message("'{said}': at every tree, or at how many?", context="question", said=text_of(part.terms))
    choices = (message("at every tree", context="answer"), message("at 4 trees", context="answer"))
    if part.places is None or part.places.joins or (part.relation is not None and part.relation.kind == "ALONG"):
        return Question(asked, choices)
    area = text_of(part.places.terms)
    plain = part.places.chains[0].phrases[0]
    whole = len(part.places.chains[0].phrases) == 1 and all(t.kind == "TREE" for g in plain.nominals for t in g)
    words = ("every tree", "4 trees") if whole else (f"every tree in {area}", f"4 trees in {area}")
    return Question(asked, choices, terms=part.places.terms, words=words)


def each_or_in_all(part: ClausePart, asked: str, choices: tuple[str, str], number: int) -> Question:
    """At each of several places, or at so many of them; ``choices`` say it in this order."""
    if part.places is None:
        return Question(asked, choices)
    area = text_of(part.places.terms)
    words = (f"each of {area}", f"{number} of {area}" if number > 1 else "")
    return Question(asked, choices, terms=part.places.terms, words=words)


def choices_of_actions(actions: Iterable[str]) -> tuple[str, ...]:
    """Return each action once, as a choice to answer with."""
    return tuple(named(name.replace("_", " "), "answer", _in_words(name)) for name in dict.fromkeys(actions))


def _in_words(action: str) -> Message | None:
    said = say_action(action)
    return said if isinstance(said, Message) else None


def _named(phrase: PlacePhrase) -> str:
    return text_of(t for group in phrase.nominals for t in group)
