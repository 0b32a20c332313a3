"""Constructions of commands, conditions and limits, and of requests made of them."""

from __future__ import annotations

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands import (
    captures,
    conditions,
    driving,
    limits,
    parameters,
    requests,
    spacing,
    things,
)

#: The constructions of all themes. Of readings that cost the same, the one composed first is kept, so the order counts.
GRAMMAR = Grammar()
for _theme in (things, parameters, captures, spacing, driving, conditions, limits, requests):
    GRAMMAR.include(_theme.GRAMMAR)

__all__ = ["GRAMMAR"]
