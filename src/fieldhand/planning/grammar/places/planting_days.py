"""Constructions of when plants were sown or planted: "sown before April", "planted in 2015", "the earliest-sown bed".

The days are those of attributes whose values are dates, and years those of attributes that are years.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.places.filters.attribute_dates import day_number, is_date
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal
from fieldhand.planning.grammar.places.nouns import AttributeTest, that_pass
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.planting_words import How, PlantingDays, PlantingRank, attributes_for
from fieldhand.planning.grammar.words import Lex
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("attribute_test: when=PLANTEDWHEN", cost=0.1, given=("site",))
def planted_when(when: Lex, site: Site) -> list[AttributeTest]:
    """Compose "sown before April"."""
    return list(_tests(when.value, site))


@construction(
    "nominal: when=PLANTEDIN inner=nominal", "planted: when=PLANTEDIN [TREE]", "planted: when=PLANTEDIN inner=planted",
    cost=0.1, given=("site",),
)  # fmt: skip
def of_that_planting(
    when: Lex, site: Site, inner: Nominal | s.Selector | None = None
) -> list[Nominal | s.Selector] | None:
    """Compose "April-sown lettuces" and "April-sown" before "beds"."""
    tests = list(_tests(when.value, site))
    if isinstance(inner, Nominal):
        if inner.single or inner.complete or inner.pronoun:
            return None
        return [replace(inner, selector=that_pass(test, inner.selector), tested=True) for test in tests]
    return [that_pass(test, inner or s.Trees()) for test in tests]


@construction("nominal: WHATEVER [which_is] when=PLANTEDWHEN", cost=0.2, given=("site",))
def whatever_was_planted(when: Lex, site: Site) -> list[Nominal]:
    """Compose "what was sown before April"."""
    return [Nominal(that_pass(test, s.Trees()), plural=True, tested=True) for test in _tests(when.value, site)]


@construction(
    "nominal: rank=PLANTEDRANK inner=nominal", "nominal: inner=nominal [which_is] rank=PLANTEDRANK",
    cost=0.1, given=("site",),
)  # fmt: skip
def planted_first(rank: Lex, inner: Nominal, site: Site) -> list[Nominal] | None:
    """Compose "the earliest-sown lettuces" and "the lettuces that were sown first"."""
    if inner.single or inner.complete or inner.pronoun:
        return None
    days = _outermost(rank.value, inner.selector, site)
    return [replace(inner, selector=that_pass(test, inner.selector), tested=True) for test in days] or None


@construction(
    "planted_rows: rank=PLANTEDRANK noun=ROW", "planted_rows: noun=ROW [which_is] rank=PLANTEDRANK",
    "planted_rows: rank=PLANTEDRANK kind=planted noun=ROW",
    "planted_rows: kind=planted noun=ROW [which_is] rank=PLANTEDRANK",
    cost=0.1, given=("site",),
)  # fmt: skip
def rows_planted_first(
    rank: Lex, noun: Lex, site: Site, kind: s.Selector | None = None
) -> list[tuple[s.Selector, bool]]:
    """Compose "the bed that was sown first" and "the last-sown lettuce bed"."""
    of = kind or s.Trees()
    return [(that_pass(test, of), noun.plural) for test in _outermost(rank.value, of, site)]


def _tests(when: PlantingDays, site: Site) -> Iterator[AttributeTest]:
    """Yield the tests that a phrase can mean: one for each attribute and, where it says no year, for each year."""
    for name in attributes_for(when.verb, site):
        values = site.attributes[name]
        if not all(is_date(value) for value in values):
            if when.first.endswith("-01-01") and when.last.endswith("-12-31") and not when.first.startswith("--"):
                yield from _compared(name, when.how, float(when.first[:4]), float(when.last[:4]))
            continue
        yearless = when.first.startswith("--") or when.last.startswith("--")
        for year in sorted({str(value)[:4] for value in values}) if yearless else [""]:
            first, last = (_in_year(day, year) for day in (when.first, when.last))
            if is_date(first) and is_date(last) and day_number(first) <= day_number(last):
                yield from _compared(name, when.how, first, last)


def _in_year(day: str, year: str) -> str:
    """Return a day that names no year as one of a year; the last of February is the 28th in most."""
    named = f"{year}-{day[2:]}" if day.startswith("--") else day
    return named if is_date(named) or not named.endswith("-02-29") else f"{named[:-2]}28"


def _compared(name: str, how: How, first: str | float, last: str | float) -> Iterator[AttributeTest]:
    """Yield the tests of an attribute by a span of days or years."""
    match how:
        case "lt" | "ge":
            yield (name, how, first)
        case "gt" | "le":
            yield (name, how, last)
        case "by":
            yield (name, "le", last)
            if first != last:
                yield (name, "lt", first)
        case _:
            yield (name, "eq", first) if first == last else (name, "between", (first, last))


def _outermost(rank: PlantingRank, of: s.Selector, site: Site) -> list[AttributeTest]:
    """Return the tests for the first or the last day of some plants."""
    plants = ids_of(of, site) or set()
    tests: list[AttributeTest] = []
    for name in attributes_for(rank.verb, site):
        found = {value for plant in plants if (value := site.by_id[plant].properties.get(name)) is not None}
        days = sorted(found, key=lambda value: day_number(value) if is_date(value) else value)
        tests += [(name, "eq", days[0] if rank.earliest else days[-1])] if days else []
    return tests
