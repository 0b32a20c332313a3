"""Constructions of places chosen by the readings of the mission: "the hottest of them", "where the CO2 was highest"."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, PlaceMeaning
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Units of the readings of which a comparison is said, by the feature of its words.
_SAID_OF = {"more_heat": "degC", "more_water": "percent"}
#: Statistics of one reading that is higher or lower than all others: True for lower.
_EXTREMES = {"minimum": True, "maximum": False}


def places_read(quantity: str, count: int, *, lowest: bool, unit: str = "") -> PlaceMeaning:
    """Return the places with the highest or lowest readings, which the dialogue finds."""
    selector = s.ByReading(reading="", quantity=quantity, count=count, lowest=lowest)
    several = count > 1
    return PlaceMeaning(
        selector, "several" if several else "one", count=count if several else None, like=Likewise("read", side=unit)
    )


@construction("read_noun: noun=ONE", "read_noun: noun=TREE", "read_noun: noun=POINT", cost=0.0)
def read_noun(noun: Lex) -> bool:
    """Compose "ones", "trees" and "spots" behind "the hottest": True in the plural."""
    return noun.plural or "plural" in noun.features or noun.text.endswith("s")


@construction(
    "place: DET most=MOSTREAD",
    "place: DET most=MOSTREAD several=read_noun",
    "place: DET most=MOSTREAD OFTHEALL",
    "place: DET most=MOSTREAD OFTHEM",
    "place: [DET] most=MOSTREAD n=count OFTHEM",
    "place: [DET] n=count most=MOSTREAD OFTHEM",
    "place: DET most=MOSTREAD several=read_noun OFTHEALL",
    "place: [DET] most=MOSTREAD n=count",
    "place: [DET] most=MOSTREAD n=count several=read_noun",
    "place: [DET] most=MOSTREAD n=count OFTHEALL",
    "place: [DET] n=count most=MOSTREAD",
    "place: [DET] n=count most=MOSTREAD several=read_noun",
    "place: [DET] n=count most=MOSTREAD OFTHEALL",
    cost=0.4,
)
def most_read(most: Lex, n: int = 1, several: bool | None = None) -> PlaceMeaning | None:
    """Compose "the hottest one" and "the 3 driest of them"."""
    if several is not None and several != (n > 1):
        return None  # "the hottest ones": how many?
    return places_read("", n, lowest=most.value[0], unit=most.value[1])


@construction(
    "place: DET most=MOSTREAD several=read_noun in_ where=region",
    "place: DET most=MOSTREAD several=read_noun OF where=region",
    "place: DET n=count most=MOSTREAD several=read_noun in_ where=region",
    "place: DET n=count most=MOSTREAD several=read_noun OF where=region",
    "place: DET most=MOSTREAD n=count several=read_noun in_ where=region",
    "place: [DET] n=count most=MOSTREAD OF where=region",
    cost=0.4,
)
def most_read_in(most: Lex, where: s.Selector, several: bool | None = None, n: int = 1) -> PlaceMeaning | None:
    """Compose "the hottest vine of row 4", of readings that were taken there."""
    place = most_read(most, n, several)
    return None if place is None else replace(place, per=where)


@construction(
    "place: DET word=BARECMP OFTHEALL",
    "place: DET word=BARECMP OFTHEM",
    "place: DET word=BARECMP ONE",
    "place: DET word=BARECMP TREE",
    cost=0.5,
)
def more_read(word: Lex) -> PlaceMeaning | None:
    """Compose "the hotter of the two"."""
    if word.value not in ("lt", "gt"):
        return None
    unit = next((unit for name, unit in _SAID_OF.items() if name in word.features), "")
    return places_read("", 1, lowest=word.value == "lt", unit=unit)


@construction(
    "place: DET several=read_noun WITH DET most=STATISTIC READING",
    "place: DET several=read_noun WITH DET most=STATISTIC noun=NOUN [READING]",
    "place: DET n=count several=read_noun WITH DET most=STATISTIC READING",
    "place: DET n=count several=read_noun WITH DET most=STATISTIC noun=NOUN [READING]",
    "place: DET several=read_noun OF DET most=STATISTIC READING",
    cost=0.4,
)
def with_most(most: Lex, n: int = 1, several: bool = False, noun: Lex | None = None) -> list[PlaceMeaning] | None:
    """Compose "the tree with the highest CO2" and "the 3 spots with the lowest readings"."""
    if most.value not in _EXTREMES or several != (n > 1):
        return None
    return [places_read(name, n, lowest=_EXTREMES[most.value]) for name in _names(noun)]


@construction(
    "place: WHERE [IT] [IS] most=STATISTIC",
    "place: WHERE [DET] noun=NOUN [READING] IS [DET] most=STATISTIC",
    "place: WHERE [DET] READING IS [DET] most=STATISTIC",
    "place: WHERE [IT] IS [DET] warm=MOSTREAD",
    "place: WHERE [DET] noun=NOUN [READING] IS [DET] warm=MOSTREAD",
    "place: DET POINT WHERE [IT] [IS] most=STATISTIC",
    "place: DET TREE WHERE [IT] [IS] most=STATISTIC",
    "place: DET TREE WHERE [DET] noun=NOUN [READING] IS [DET] most=STATISTIC",
    "place: DET POINT WHERE [DET] noun=NOUN [READING] IS [DET] most=STATISTIC",
    "place: WHERE IT READ [DET] most=STATISTIC [noun=NOUN]",
    cost=0.4,
)
def where_most(most: Lex | None = None, noun: Lex | None = None, warm: Lex | None = None) -> list[PlaceMeaning] | None:
    """Compose "where the CO2 was highest" and "where it was hottest"."""
    if warm is not None:
        return [places_read(name, 1, lowest=warm.value[0], unit=warm.value[1]) for name in _names(noun)]
    if most is None or most.value not in _EXTREMES:
        return None
    return [places_read(name, 1, lowest=_EXTREMES[most.value]) for name in _names(noun)]


@construction(
    "place: word=ANY [OFTHEM] [WHICH] IS [DET] most=STATISTIC [noun=NOUN]",
    "place: word=ANY [OFTHEM] [WHICH] IS [DET] warm=MOSTREAD",
    "place: word=ANY ONE [OFTHEM] IS [DET] most=STATISTIC", "place: word=ANY ONE [OFTHEM] IS [DET] warm=MOSTREAD",
    "place: word=ANY TREE IS [DET] most=STATISTIC", "place: word=ANY TREE IS [DET] warm=MOSTREAD",
    "place: word=ANY POINT IS [DET] most=STATISTIC", "place: word=ANY POINT IS [DET] warm=MOSTREAD",
    "place: word=ANY HAVE [DET] most=STATISTIC noun=NOUN", "place: word=ANY HAVE [DET] most=STATISTIC READING",
    "place: word=ANY TREE HAVE [DET] most=STATISTIC noun=NOUN",
    "place: word=ANY TREE HAVE [DET] most=STATISTIC READING",
    "place: word=DET [several=ONE] WHICH IS [DET] most=STATISTIC",
    "place: word=DET several=TREE WHICH IS [DET] most=STATISTIC",
    "place: word=DET most=STATISTIC ONE", "place: word=DET most=STATISTIC OFTHEM",
    "place: word=DET most=STATISTIC OFTHEALL",
    cost=0.4,
)  # fmt: skip
def whichever_was_most(
    word: Lex, most: Lex | None = None, warm: Lex | None = None, noun: Lex | None = None, several: Lex | None = None
) -> list[PlaceMeaning] | None:
    """Compose "whichever came out lowest" and "the one that was highest"."""
    free, one = "free_choice" in word.features, "definite" in word.features
    if not (free or one) or (several is not None and (several.plural or "plural" in several.features)):
        return None
    return where_most(most, noun, warm)


def _names(noun: Lex | None) -> list[str]:
    """Return the quantities of a noun; an empty name if there is none."""
    if noun is None:
        return [""]
    naming: Naming = noun.value
    found: list[Any] = list(dict.fromkeys(naming.quantities)) or list(naming.actions[:1])
    return found
