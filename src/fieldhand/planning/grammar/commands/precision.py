"""Constructions of means that are wanted with a precision: "the mean nitrate of bed 3 to within 5 percent"."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.asked import AskedArea
from fieldhand.planning.grammar.meaning import (
    AllTests,
    Amount,
    CaptureCommand,
    LinkedCommand,
    PlaceMeaning,
    Said,
    Test,
    UntilCondition,
    VisitLimit,
)
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.sampling import bare_ground, some_points
from fieldhand.planning.grammar.words import Lex
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class Precise:
    """A mean that is wanted with a precision.

    Attributes:
        asked: What is measured, and where.
        width: Half the width of the interval in which it has to be known.
        most: Maximum number of readings; 0 if it is not said.
        random: True if the phrase says that their places are drawn at random.
    """

    asked: AskedArea
    width: Amount
    most: int = 0
    random: bool = False


@construction(
    "precise: asked=asked [COMMA] [KNOWN] value=width", "precise: CAUSE asked=asked [COMMA] [KNOWN] value=width",
    "precise: TAKE asked=asked [COMMA] [KNOWN] value=width", cost=0.2,
)  # fmt: skip
def precise(asked: AskedArea, value: Amount) -> Precise | None:
    """Compose "I want the average soil moisture of the leeks to within 2 percent"."""
    return Precise(asked, value) if len(asked.areas) == len(asked.things) == 1 else None


@construction(
    "precise: one=precise [COMMA] [spots_by] RANDOM TREE", "precise: one=precise [COMMA] [spots_by] RANDOM POINT",
    "precise: one=precise [COMMA] [spots_by] TREE RANDOM", "precise: one=precise [COMMA] AT RANDOM TREE",
    "precise: one=precise [COMMA] AT RANDOM POINT", "precise: one=precise [COMMA] RANDOM", cost=0.1,
)  # fmt: skip
def of_random_places(one: Precise) -> Precise | None:
    """Compose "from randomly picked plants"."""
    return None if one.random else replace(one, random=True)


@construction("joined: COMMA", "joined: AND", "joined: COMMA AND", "joined: FULLSTOP", cost=0.0)
def joined() -> str:
    """Compose a comma before a limit."""
    return "and"


@construction(
    "precise: one=precise [joined] [spots_by] UPTO n=count [random=RANDOM] spots_noun",
    "precise: one=precise [joined] [spots_by] less n=count [random=RANDOM] spots_noun",
    "precise: one=precise [joined] [spots_by] n=count [random=RANDOM] spots_noun UPTO",
    "precise: one=precise [joined] [spots_by] n=count [random=RANDOM] spots_noun TOPS", cost=0.1,
)  # fmt: skip
def with_at_most(one: Precise, n: int, random: Lex | None = None) -> Precise | None:
    """Compose "with no more than 20 readings"."""
    return None if one.most or n < 2 else replace(one, most=n, random=one.random or random is not None)


@construction("said: one=precise", cost=0.3, given=("site",))
def until_it_is_known(one: Precise, used: int, site: Site) -> Said | None:
    """Compose "I want the average nitrate of bed 3 to within 5 percent" as readings until the mean is known."""
    (where,), (thing,) = one.asked.areas, one.asked.things
    plants = ids_of(where, site)
    if bare_ground(where, site) is not None:
        places = some_points(where, site, one.most, random=True) if one.most else None
    elif one.random:
        places = s.RandomSample(count=min(one.most or len(plants or ()), len(plants or ())), of=where)
    else:
        places = where
    if places is None:
        return None
    reading = CaptureCommand((replace(thing, count=None),), PlaceMeaning(places, "several", each=True), used)
    known = AllTests((Test("", "known", one.width.number, one.width.unit, of="mean"),))
    clauses = [LinkedCommand(None, reading), LinkedCommand(None, UntilCondition(known, 0))]
    return Said((*clauses, *([LinkedCommand(None, VisitLimit(one.most, 0))] if one.most else [])))
