"""Questions about noun phrases, each choice with the words that it stands for in the request."""

from __future__ import annotations

from fieldhand.planning.english.faults import Question, text_of
from fieldhand.planning.english.syntax import NounPhrase, Part


def how_many(
    phrase: NounPhrase, numbers: tuple[str, ...] = ("2", "3", "4"), *, asked: str = "", of_all: bool = False
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
        choices = (*numbers, "all of them")
    return Question(asked or f"'{text_of(phrase.terms)}': how many?", choices, terms=phrase.terms, words=tuple(words))


def which_of(phrase: NounPhrase, asked: str, *, there: int, claimed: int | None) -> Question:
    """All of what a noun phrase names, or any so many of them; ``claimed``: None where there are not so many."""
    every = f"all {_named(phrase)}" if there > 1 else f"the {_named(phrase)}"
    choices = {f"all {there} of them": every} if there else {}
    if claimed is not None:
        choices[f"any {claimed} of them"] = f"any {claimed} {_named(phrase)}" if claimed > 1 else f"a {_named(phrase)}"
    return Question(asked, tuple(choices), terms=phrase.terms, words=tuple(choices.values()))


def every_or_how_many(part: Part) -> Question:
    """At every tree of an area, or at so many of them."""
    asked = f"'{text_of(part.terms)}': at every tree, or at how many?"
    choices = ("at every tree", "at 4 trees")
    if part.places is None or part.places.joins or (part.relation is not None and part.relation.kind == "ALONG"):
        return Question(asked, choices)
    area = text_of(part.places.terms)
    plain = part.places.chains[0].phrases[0]
    whole = len(part.places.chains[0].phrases) == 1 and all(t.kind == "TREE" for g in plain.nominals for t in g)
    words = ("every tree", "4 trees") if whole else (f"every tree in {area}", f"4 trees in {area}")
    return Question(asked, choices, terms=part.places.terms, words=words)


def each_or_in_all(part: Part, asked: str, choices: tuple[str, str], number: int) -> Question:
    """At each of several places, or at so many of them; ``choices`` say it in this order."""
    if part.places is None:
        return Question(asked, choices)
    area = text_of(part.places.terms)
    words = (f"each of {area}", f"{number} of {area}" if number > 1 else "")
    return Question(asked, choices, terms=part.places.terms, words=words)


def _named(phrase: NounPhrase) -> str:
    return text_of(t for group in phrase.nominals for t in group)
