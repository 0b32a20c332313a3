"""Constructions of places: nouns with what describes them, areas, rows, and groups of these."""

from __future__ import annotations

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.places import (
    areas,
    beside_them,
    by_reading,
    choices,
    chosen,
    clauses,
    earlier,
    exceptions,
    flags,
    groups,
    likewise,
    nouns,
    numbered_zones,
    numbers,
    open_parts,
    planted_rows,
    points,
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
    flags,
    planted_rows,
    choices,
    exceptions,
    sets,
    sampling,
    points,
    by_reading,
    earlier,
    numbered_zones,
    vague,
    beside_them,
    open_parts,
):
    GRAMMAR.include(_part.GRAMMAR)
