"""Constructions of the one of two places that readings decide: "the crop that came out lower", "the drier bed"."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, PlaceMeaning
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "compared: DET GROUPNOUN WHICH [IS] [ONAVERAGE] word=BARECMP [ONAVERAGE]",
    "compared: DET ONE WHICH [IS] [ONAVERAGE] word=BARECMP [ONAVERAGE]",
    "compared: DET GROUPNOUN WITH DET word=BARECMP STATISTIC", "compared: DET GROUPNOUN WITH DET word=BARECMP READING",
    "compared: DET ONE WITH DET word=BARECMP STATISTIC", "compared: DET ONE WITH DET word=BARECMP READING",
    "compared: DET ONE WITH DET word=BARECMP NOUN", "compared: DET GROUPNOUN WITH DET word=BARECMP NOUN",
    "compared: DET word=BARECMP GROUPNOUN [ONAVERAGE]", "compared: DET word=BARECMP ONE [ONAVERAGE]",
    "compared: DET word=BARECMP OF DET count [GROUPNOUN]", "compared: DET word=BARECMP OF DET GROUPNOUN",
    "compared: DET word=BARECMP [GROUPNOUN] OFTHEM",
    "compared: ANY [GROUPNOUN] IS word=BARECMP [ONAVERAGE]", "compared: ANY OF GROUPALL IS word=BARECMP [ONAVERAGE]",
    cost=0.2,
)  # fmt: skip
def one_of_two(word: Lex) -> PlaceMeaning | None:
    """Compose "the crop that came out lower on average" and "the drier of the two beds"."""
    check: Any = word.value
    return PlaceMeaning(s.Here(), "area", like=Likewise("compared", side=check)) if check in ("lt", "gt") else None


@construction("place: one=compared", cost=0.2)
def as_place(one: PlaceMeaning) -> PlaceMeaning:
    """Compose "the drier bed" as a place."""
    return one


@construction("place: n=count TREE in_ one=compared", "place: n=count POINT in_ one=compared", cost=0.2)
def so_many_in_it(n: int, one: PlaceMeaning) -> PlaceMeaning:
    """Compose "three points in the drier area"."""
    return replace(one, count=n)
