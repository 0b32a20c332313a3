"""Find the phrases that say when plants were sown or planted: "sown before April", "the earliest-sown bed"."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Literal

from fieldhand.places.filters.attribute_dates import is_date
from fieldhand.planning.english.naming import name_words
from fieldhand.planning.english.tokens import Word
from fieldhand.planning.grammar.earlier.periods import compiled, day_named, matches_in, month_named
from fieldhand.site.model import Site

How = Literal["lt", "gt", "le", "ge", "by", "in", "between"]

#: Words of work that begins with a plant, as requests have them.
_WORDS = {
    "sow": "sown|sowed|sowing|seeded|seeding|drilled|direct sown|direct seeded",
    "plant": "planted|planting|planted out|put in|put out|set out|bedded out|replanted",
    "transplant": "transplanted|transplanting|pricked out|potted|potted on|potted up",
    "graft": "grafted|grafting",
}
#: Further words for these in the names of attributes.
_IN_NAMES = {"sow": {"sow"}, "plant": {"plant", "set"}, "transplant": {"transplant"}, "graft": {"graft"}}
_VERB = "|".join(sorted((word for words in _WORDS.values() for word in words.split("|")), key=len, reverse=True))
_SAID = (
    r"(?:(?:we|i|they|you) (?:have |had )?)?(?:(?:was|were|been|is|are|have been|has been) )?"
    rf"(?P<verb>{_VERB})(?: dates?)?(?: (?:is|are|was|were|lies|lie))?"
)
_DATE = "{date}|{month}(?: 20\\d\\d)?|20\\d\\d"
_DAY, _FIRST, _LAST = (f"(?P<{name}>{_DATE})" for name in ("day", "first", "last"))
#: Which days are meant, by the words before and behind a date.
_HOW: dict[How, tuple[str, ...]] = {
    "between": (f"(?:between|from) {_FIRST} (?:and|to|until|till|through) {_LAST}",),
    "lt": (f"(?:before|earlier than|prior to|ahead of) {_DAY}",),
    "gt": (f"(?:after|later than) {_DAY}",),
    "le": (
        f"(?:no later than|not later than|not after|on or before|at the latest on) {_DAY}",
        f"(?:on |in )?{_DAY} or (?:earlier|before)",
    ),
    "ge": (
        f"(?:since|no earlier than|not earlier than|not before|on or after|in or after) {_DAY}",
        f"(?:on |in )?{_DAY} or (?:later|after)",
        f"from {_DAY} (?:on|onwards?)",
    ),
    "by": (f"by {_DAY}",),
    "in": (f"(?:(?:on|in|during|within|at) )?{_DAY}",),
}
_RANKS = {"first": True, "earliest": True, "last": False, "latest": False, "most recently": False, "most lately": False}
_RANK = "|".join(sorted(_RANKS, key=len, reverse=True))


@dataclass(frozen=True, slots=True)
class PlantingDays:
    """Days on which something was sown or planted, as a phrase states them.

    Attributes:
        verb: What was done, one of the words of planting.
        how: How the days are compared with these.
        first: First day, as "2026-04-01" or "--04-01" for any year.
        last: Last day.
    """

    verb: str
    how: How
    first: str
    last: str


@dataclass(frozen=True, slots=True)
class PlantingRank:
    """The first or last day on which something was sown or planted."""

    verb: str
    earliest: bool


@cache
def _patterns() -> tuple[tuple[How, re.Pattern[str]], ...]:
    return tuple((how, compiled(f"{_SAID} {pattern}")) for how, patterns in _HOW.items() for pattern in patterns)


@cache
def _before_noun() -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Return the patterns of "April-sown" and of "earliest-sown" and "sown first"."""
    day = compiled(f"{_DAY} (?:- )?(?P<verb>{_VERB})")
    rank = compiled(
        rf"(?:(?P<rank>{_RANK}) (?:- )?(?:to be )?(?P<verb>{_VERB})"
        rf"|(?:(?:was|were|been|is|are) )?(?P<verb2>{_VERB}) (?:the )?(?P<rank2>{_RANK})(?: of all)?)"
    )
    return day, rank


def planting_edges(words: Sequence[Word], site: Site) -> Iterator[tuple[str, int, int, PlantingDays | PlantingRank]]:
    """Yield the phrases that say when plants were sown or planted: category, range of the words, and value.

    Args:
        words: Words of a request.
        site: Its site, whose plants have dates or years.
    """
    if not planting_attributes(site):
        return
    for how, pattern in _patterns():
        for first, last, found in matches_in(pattern, words):
            if (days := _days(how, found)) is not None:
                yield "PLANTEDWHEN", first, last, days
    day, rank = _before_noun()
    for first, last, found in matches_in(day, words):
        if (days := _days("in", found)) is not None:
            yield "PLANTEDIN", first, last, days
    for first, last, found in matches_in(rank, words):
        verb, said = found["verb"] or found["verb2"], found["rank"] or found["rank2"]
        yield "PLANTEDRANK", first, last, PlantingRank(verb, _RANKS[said])


def planting_words(words: Sequence[Word], site: Site) -> frozenset[int]:
    """Return the numbers of the words that say when plants were sown or planted, which is no time of the mission."""
    return frozenset(k for _, first, last, _ in planting_edges(words, site) for k in range(first, last))


def _days(how: How, found: re.Match[str]) -> PlantingDays | None:
    """Return the days that a match states; None for a day that no calendar has."""
    groups = found.groupdict()
    if how == "between":
        first, last = _span(groups["first"]), _span(groups["last"])
        return None if first is None or last is None else PlantingDays(groups["verb"], how, first[0], last[1])
    span = _span(groups["day"])
    return None if span is None else PlantingDays(groups["verb"], how, *span)


def _span(said: str) -> tuple[str, str] | None:
    """Return the first and the last day of a day, a month or a year."""
    if said.isdigit():
        return f"{said}-01-01", f"{said}-12-31"
    month, _, year = said.partition(" ")
    if not year and month.startswith("feb"):
        return "--02-01", "--02-29"
    span = month_named(month, year or None) if not year or (year.isdigit() and len(year) == 4) else None
    if span is not None:
        return span
    day = day_named(said)
    return (day, day) if day and "-" in day else None


def attributes_for(verb: str, site: Site) -> list[str]:
    """Return the attributes that a verb is about: those whose names have it, else all that say when plants began."""
    known = planting_attributes(site)
    stem = next(stem for stem, words in _WORDS.items() if verb in words.split("|"))
    named = [name for name, stems in known.items() if stem in stems]
    return named or (list(known) if len(known) == 1 and stem != "graft" else [])


def planting_attributes(site: Site) -> dict[str, set[str]]:
    """Return the attributes that say when plants were sown or planted, each with the work that its name tells."""
    if "planting" not in site.cache:
        found: dict[str, set[str]] = {}
        for name, values in site.attributes.items():
            words = name_words(name)
            stems = {stem for stem, forms in _WORDS.items() if ({*forms.split("|")} | _IN_NAMES[stem]) & {*words}}
            if stems and all(is_date(value) or _is_year(value) for value in values):
                found[name] = stems
        site.cache["planting"] = found
    kept: dict[str, set[str]] = site.cache["planting"]  # type: ignore[assignment]
    return kept


def _is_year(value: object) -> bool:
    return isinstance(value, float) and value == int(value) and 1900 <= value <= 2100
