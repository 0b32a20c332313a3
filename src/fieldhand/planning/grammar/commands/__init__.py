"""Constructions of commands, conditions and limits, and of requests made of them."""

from __future__ import annotations

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands import (
    adjuncts,
    aggregates,
    aisles,
    asked,
    asked_places,
    at_edges,
    bringing,
    captures,
    clauses,
    conditions,
    counting,
    driving,
    earlier,
    edge_sides,
    ending,
    energy,
    events,
    exclusions,
    finished,
    further_work,
    going_round,
    headings,
    laps,
    left_standing,
    limits,
    pace,
    parameters,
    precision,
    reported,
    requests,
    row_parts,
    sampling,
    sides,
    slow,
    spacing,
    things,
    to_and_fro,
    waits,
    ways,
    which_of_two,
    work_sequel,
    work_wanted,
    working,
)

#: The constructions of all themes. Of readings that cost the same, the one composed first is kept, so the order counts.
GRAMMAR = Grammar()
_THEMES = (
    things, parameters, spacing, clauses, adjuncts, captures, driving, conditions, limits, energy, events, requests,
    finished, exclusions, ways, slow, sampling, waits, pace, sides, aggregates, working, aisles, earlier,
    work_wanted, laps, headings, edge_sides, row_parts, asked, left_standing, to_and_fro, work_sequel, at_edges,
    bringing, reported, further_work, counting, which_of_two, asked_places, precision,
    ending, going_round,
)  # fmt: skip
for _theme in _THEMES:
    GRAMMAR.include(_theme.GRAMMAR)

__all__ = ["GRAMMAR"]
