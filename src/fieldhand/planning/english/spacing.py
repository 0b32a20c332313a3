"""Words for a distance from stop to stop ("15 meters apart"), and for the order of places, as one term each."""

from __future__ import annotations

import re
from dataclasses import dataclass

from fieldhand.planning.english.rewriting import Rule, merged, rewritten
from fieldhand.planning.english.tokens import Term

_BEFORE = r"(?:<COMMA>)?"
#: A comma behind the distance separates nothing where the line follows ("15 m apart, along row 4").
_AFTER = r"(?:<COMMA>(?=<AT[.>]|<ALONG>|<INSIDE>))?"
_METRES = r"<AMOUNT\.metres>"


@dataclass(frozen=True, kw_only=True)
class Stops:
    """Metres from stop to stop.

    Attributes:
        every: As in "every 20 m", where a number may be that of each stop.
        least: The distance is a least one.
    """

    apart_m: float
    every: bool = False
    least: bool = False


@dataclass(frozen=True, kw_only=True)
class Ranking:
    """An order by an attribute: the word that names it, or the words of the site for it."""

    attribute: str | tuple[str, ...]
    descending: bool
    said: bool = True


#: Behind these, "oldest first" is an order.
_BEHIND = frozenset({"COMMA", "TREE", "PLACE", "ROW", "ROWIDS", "ZONE", "HALF", "QUARTER", "SIDE", "PLOT", "ATTRVAL"})


def with_spacing(terms: list[Term]) -> list[Term]:
    """Distances from stop to stop as ``EVERYM``."""
    return rewritten(terms, _SPACING)


def with_orders(terms: list[Term]) -> list[Term]:
    """Orders by an attribute as ``ORDERED``; those by the compass and by distance are phrases of the lexicon."""
    return rewritten(terms, _ORDERS)


def _stops(group: list[Term], before: Term | None) -> list[Term]:
    amount = next(t for t in group if t.kind == "AMOUNT")
    every = any(t.kind == "EACH" for t in group) and not any(t.kind in ("APART", "SPACEDBY") for t in group)
    least = any(t.kind == "CMP" for t in group)
    made = merged(group, "EVERYM", Stops(apart_m=amount.value.number, every=every, least=least))
    if before is None and group[0].kind == "COMMA":
        return [group[0], made]
    return [made]


def _ranked(group: list[Term], _before: Term | None) -> list[Term]:
    """ "In order of age": from its lowest value where the words do not say."""
    word, attribute = group[0], next(t for t in group if t.kind == "ATTR")
    down = any(w in word.text.lower() for w in ("descending", "decreasing", "falling"))
    up = any(w in word.text.lower() for w in ("ascending", "increasing", "rising"))
    ranking = Ranking(attribute=attribute.value, descending=down, said=up or down)
    return [merged(group, "ORDERED", ("attribute", ranking, down))]


def _superlative(group: list[Term], before: Term | None) -> list[Term] | None:
    """ "Oldest first", "from the oldest to the youngest", "starting with the oldest"."""
    first = next(t for t in group if t.kind == "SUPER")
    if before is not None and before.kind not in _BEHIND and group[0].kind not in ("FROM", "GO"):
        return None  # "photograph the oldest first" is a step of several
    named = next((t.value for t in group if t.kind == "ATTR"), None)
    hint, lowest = first.value
    if not hint and named is None:
        return None
    ranking = Ranking(attribute=hint if named is None else named, descending=not lowest)
    return [merged(group, "ORDERED", ("attribute", ranking, not lowest))]


_ONE = r"(?:<TREE>|<PLACE\.\w+>|<NUM\.one>)?"
_SPACING: tuple[Rule, ...] = (
    (
        re.compile(
            rf"{_BEFORE}(?:<WHICH>)?(?:<SPACEDBY>|<WITH>|<AT\.\w+>|<EACH\.\w+>|<DET>|<CMP\.g[et]>)*{_METRES}<APART>{_AFTER}"
            rf"|{_BEFORE}(?:<SPACEDBY>)?(?:<AT\.\w+>|<WITH>)(?:<DET>)?{_METRES}<INTERVAL>{_AFTER}"
            rf"|{_BEFORE}(?:<SPACEDBY>)?(?:<AT\.\w+>|<WITH>)(?:<DET>)?<INTERVAL><OF>{_METRES}{_AFTER}"
            rf"|{_BEFORE}<SPACEDBY>(?:<AT\.\w+>|<NEAR>)?(?:<EACH\.(?:every|each)>)?{_METRES}(?:<APART>)?{_AFTER}"
            rf"|{_BEFORE}<EACH\.(?:every|each)>{_METRES}{_AFTER}"
        ),
        _stops,
    ),
)
_END = r"(?=$|<COMMA>|<AND\.\w+>|<THEN\.|<BUDGET>|<IF>|<AT[.>]|<INSIDE>|<OF>)"
_ORDERS: tuple[Rule, ...] = (
    (re.compile(r"<ORDEROF>(?:<DET>)?<ATTR>"), _ranked),
    (
        re.compile(
            rf"<FROM>(?:<DET>)?<SUPER>(?:<ATTR>)?{_ONE}<AT\.to>(?:<DET>)?<SUPER>(?:<ATTR>)?{_ONE}"
            rf"|<GO\.(?:starting|beginning)>(?:(?:<WITH>|<AT\.\w+>|<FROM>)(?:<DET>)?|<WHICH>)<SUPER>(?:<ATTR>)?{_ONE}{_END}"
            rf"|(?:<DET>)?<SUPER>(?:<ATTR>)?(?:<PLACE\.ones?>|<NUM\.one>)?<ORD\.1>{_END}"
        ),
        _superlative,
    ),
)
