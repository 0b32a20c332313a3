"""A language of the grammar: what differs between languages."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.words import Phrases
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Returns words with small misspellings mended, and what was mended as sentences.
Respelling = Callable[[Sequence[Word], Lexicon], tuple[list[Word], list[str]]]


@dataclass(frozen=True, kw_only=True)
class GrammarLanguage:
    """A language that requests can be in.

    Attributes:
        code: Code of the language, such as ``en``.
        words_of: Returns the words of a request in order.
        phrases: Returns the words of the language for a robot on a site.
        grammar: Returns the constructions of the language; most are shared by all languages.
        respelt: Returns words with small misspellings mended, and what was mended as sentences; None for none.
        frames: Returns the ranges of polite frames ("would you be able to"), for requests that are not read otherwise;
            None for none.
        aims: Returns the ranges of the phrases with which purposes begin ("I want to know how"), for such requests,
            too; None for none.
    """

    code: str
    words_of: Callable[[str], list[Word]]
    phrases: Callable[[RobotProfile, Site], Phrases]
    grammar: Callable[[], Grammar]
    respelt: Respelling | None = None
    frames: Callable[[Sequence[Word]], Iterator[tuple[int, int]]] | None = None
    aims: Callable[[Sequence[Word]], Iterator[tuple[int, int]]] | None = None
