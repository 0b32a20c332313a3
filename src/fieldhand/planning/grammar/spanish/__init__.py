"""Spanish as a language of the grammar: its words, their inflection, and the constructions of its word order."""

from __future__ import annotations

from functools import cache

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.language import GrammarLanguage
from fieldhand.planning.grammar.spanish.phrases import phrases_for
from fieldhand.planning.grammar.spanish.tokens import words_of


@cache
def _grammar() -> Grammar:
    from fieldhand.planning.grammar.spanish import constructions

    return constructions.GRAMMAR


SPANISH = GrammarLanguage(code="es", words_of=words_of, phrases=phrases_for, grammar=_grammar)

__all__ = ["SPANISH"]
