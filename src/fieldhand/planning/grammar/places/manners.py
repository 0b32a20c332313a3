"""Constructions of participles that say how places are chosen: "spaced evenly along it", "picked at random"."""

from __future__ import annotations

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "EVENLYSPACED: PLACED EVENLY [ALONGIT]", "EVENLYSPACED: EVENLY PLACED [ALONGIT]", "EVENLYSPACED: PLACED ALONGIT",
    cost=0.1,
)  # fmt: skip
def evenly_placed() -> Lex:
    """Compose "spaced evenly along it" and "spread along the bed's length"."""
    return Lex(None, False, "evenly spread")


@construction("RANDOM: PLACED RANDOMLY [ALONGIT]", "RANDOM: RANDOMLY PLACED [ALONGIT]", "RANDOM: CHOSENBY", cost=0.1)
def placed_at_random() -> Lex:
    """Compose "scattered at random"."""
    return Lex(None, False, "at random")
