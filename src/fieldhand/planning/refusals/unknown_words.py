"""Words of a request that are not known: misspellings, properties and places that the site lacks, or not understood."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from fieldhand.language import joined, message
from fieldhand.planning.english.languages import language_of
from fieldhand.planning.english.lexicon import Lexicon
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.english.wishes import Offers
from fieldhand.planning.grammar.refusals import not_understood
from fieldhand.planning.planner import Clarify, Planned, Reason
from fieldhand.planning.refusals.examples import PlanRequest
from fieldhand.planning.refusals.offers import say_offers
from fieldhand.planning.refusals.spelling import likely_meant
from fieldhand.planning.refusals.understood import ParsedRequest

#: A request with more unknown words is not one with misspellings.
_MOST_MISSPELT = 3
#: Categories of words behind which a place is named.
_TO_A_PLACE = frozenset({"AT", "NEAR", "NEXTTO", "INSIDE", "OUTSIDE", "ALONG", "FROM", "GO", "VISIT"})
#: Categories of words that may stand between these and the name.
_BEFORE_A_NAME = frozenset({"DET", "EACH", "ANY"})
#: Categories of words behind which trees are described.
_OF_TREES = frozenset({"OF", "NUM", "RANDOM"})
#: Categories of words at which a name ends.
_ENDS = frozenset({"FULLSTOP", "COMMA", "AND", "THEN", "PLOT", "ZONE"})


@dataclass(frozen=True, kw_only=True)
class UnknownWords:
    """The unknown words of a request that no known wish explains, by their numbers."""

    numbers: tuple[int, ...]
    parsed: ParsedRequest
    lexicon: Lexicon

    @property
    def words(self) -> list[Word]:
        """The words."""
        return [self.parsed.words[k] for k in self.numbers]

    @property
    def topic(self) -> Offers:
        """Name the kind of thing that the site has instead of most of them."""
        kinds = [_lacking(number, self) for number in self.numbers]
        return next((kind for kind in kinds if kind), "")


@dataclass(frozen=True, kw_only=True)
class SpellingCorrection:
    """Unknown words with the words that were meant.

    Attributes:
        meant: The misspelt words with the known ones.
        example: The request with the known words, if it can be planned as it then is.
    """

    meant: tuple[tuple[str, str], ...]
    example: str


def corrected(unknown: UnknownWords, plan: PlanRequest) -> SpellingCorrection | None:
    """Return the words that were meant, if all unknown words are misspelt and the request is understood with others."""
    words = unknown.words
    if not 0 < len(words) <= _MOST_MISSPELT:
        return None
    meant = [(word, likely_meant(word.text, unknown.lexicon)) for word in words]
    if not all(known for _, known in meant):
        return None
    text, at = "", 0
    for word, known in meant:
        text += unknown.parsed.request[at : word.start] + _in_case_of(word.text, known)
        at = word.end
    text += unknown.parsed.request[at:]
    outcome = plan(text)
    if not isinstance(outcome, Planned | Clarify):
        return None
    fits = isinstance(outcome, Planned) and not outcome.task.command.warnings
    return SpellingCorrection(meant=tuple((word.text, known) for word, known in meant), example=text if fits else "")


def _in_case_of(typed: str, known: str) -> str:
    if typed.isupper():
        return known.upper()
    return known.capitalize() if typed[:1].isupper() else known


def reasons_of_unknown(unknown: UnknownWords, correction: SpellingCorrection | None) -> Iterator[Reason]:
    """Yield what is known of the unknown words: misspelt, lacking on the site, or not understood."""
    site, robot = unknown.parsed.site, unknown.parsed.robot
    if correction is not None:
        near = [message("'{near}' for '{said}'", near=known, said=typed) for typed, known in correction.meant]
        advice = message("did you mean {near}?", near=joined(", ", near))
        yield replace(not_understood(unknown.words, advice), final=True)
        return
    foreign = language_of(word.text for word in unknown.words)
    strange: list[Word] = []
    for number in unknown.numbers:
        word = unknown.parsed.words[number]
        lacking = "" if foreign else _lacking(number, unknown)
        span = (word.start, word.end)
        if lacking == "properties":
            what = message("'{said}': the site's file does not say this of the trees", context="wish", said=word.text)
            advice = message("known of the trees: {offers}", context="wish", offers=say_offers(lacking, site, robot))
            yield Reason(what=what, said=(span,), advice=advice, final=True)
        elif lacking == "places":
            what = message("'{said}' is no place of this site's file", context="wish", said=word.text)
            advice = message("places here are {offers}", context="wish", offers=say_offers(lacking, site, robot))
            yield Reason(what=what, said=(span,), advice=advice, final=True)
        else:
            strange.append(word)
    if strange:
        yield not_understood(strange)


def _lacking(number: int, unknown: UnknownWords) -> Offers:
    """Return what the site lacks if a word names a property ("the Zinfandel vines") or a place ("to the winery")."""
    parsed = unknown.parsed
    words = parsed.words
    if not words[number].norm.isalpha():
        return ""
    articles = parsed.ends(_BEFORE_A_NAME)
    before = number - 1
    determined = False
    while before >= 0 and (before in articles or before in unknown.numbers):
        determined = determined or before in articles
        before -= 1
    to_a_place = before in parsed.ends(_TO_A_PLACE)
    if number + 1 in parsed.begins({"TREE"}) and (determined or to_a_place or before in parsed.ends(_OF_TREES)):
        return "properties"
    ends = number + 1 >= len(words) or number + 1 in parsed.begins(_ENDS)
    return "places" if ends and determined and to_a_place else ""
