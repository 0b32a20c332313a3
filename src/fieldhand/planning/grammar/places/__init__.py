"""Constructions of places: nouns with what describes them, areas, rows, and groups of these."""

from __future__ import annotations

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.places import (
    areas,
    by_reading,
    choices,
    chosen,
    clauses,
    earlier,
    exceptions,
    groups,
    likewise,
    nouns,
    numbered_zones,
    numbers,
    positions,
    quantities,
    rounds,
    rows,
    sampling,
    sets,
    spots,
    steps,
    vague,
)

GRAMMAR = Grammar()
for _part in (
    numbers,
    nouns,
    areas,
    rows,
    positions,
    spots,
    quantities,
    rounds,
    groups,
    likewise,
    steps,
    chosen,
    clauses,
    choices,
    exceptions,
    sets,
    sampling,
    by_reading,
    earlier,
    numbered_zones,
    vague,
):
    GRAMMAR.include(_part.GRAMMAR)
