"""The trees that the phrases around a noun leave to choose from."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from fieldhand.planning.english.faults import unclear
from fieldhand.planning.english.found import Found
from fieldhand.planning.english.syntax import NounPhrase
from fieldhand.task import selectors as s

#: Selectors that keep a tree or not by itself, whatever the others are: their order does not matter.
FILTERS = (s.Where, s.InZone, s.Within, s.Excluding, s.Other)


@dataclass
class Group:
    """What a phrase's descriptions say.

    Attributes:
        area: The trees that they leave.
        anchor: The place that nearness is measured from.
        beside: "Next to" rather than "near".
        region: The descriptions name an area.
        single: The descriptions name one place.
    """

    area: s.Selector = field(default_factory=s.Trees)
    anchor: s.Selector | None = None
    beside: bool = False
    region: bool = False
    single: bool = False
    _outer: list[tuple[str, Any]] = field(default_factory=list)

    @property
    def empty(self) -> bool:
        """Whether nothing is said."""
        return self.area == s.Trees() and not self._outer and self.anchor is None and not self.region

    def add(self, found: Found, phrase: NounPhrase) -> None:
        """Only trees of an area, or of those that another phrase selects."""
        if found.here or isinstance(found.selector, s.Marker | s.TreeIs):
            raise unclear(phrase.terms, "there are no trees in one place", "say 'the tree nearest to' it")
        self.region = self.region or found.region
        self.single = self.single or not found.many
        self.area = both(self.area, found.selector, phrase)

    def within(self, metres: float, of: s.Selector) -> None:
        """Only trees within a distance."""
        self._outer.append(("within", (metres, of)))

    def without(self, *places: s.Selector) -> None:
        """No tree of these."""
        self._outer.append(("without", places))

    def kept(self, selector: s.Selector) -> s.Selector:
        """A selection without what distance and exceptions leave out."""
        for kind, value in self._outer:
            if kind == "within":
                selector = s.Within(distance_m=value[0], to=value[1], of=selector)
                continue
            zones = [p for p in value if isinstance(p, s.InZone) and p.of == s.Trees() and not p.outside]
            others = tuple(p for p in value if p not in zones)
            for zone in zones:
                selector = replace(zone, outside=True, of=selector)
            if others:
                places = others[0] if len(others) == 1 else s.Union(parts=others)
                selector = s.Excluding(places=places, of=selector)
        return selector


def nested(group: Group, inner: s.Selector) -> s.Selector:
    """The trees that a group leaves of others."""
    return group.kept(inside(group.area, inner))


def inside(outer: s.Selector, inner: s.Selector) -> s.Selector:
    """An expression with its innermost "every tree" replaced."""
    if outer == s.Trees():
        return inner
    of = getattr(outer, "of", None)
    if of is None:
        return outer
    deeper: Any = inside(of, inner)
    changed: s.Selector = replace(outer, of=deeper)
    return changed


def both(first: s.Selector, second: s.Selector, phrase: NounPhrase) -> s.Selector:
    """Trees of both. Which of two areas is taken of the other matters to their middles; a filter's order does not."""
    if first == s.Trees() or second == s.Trees():
        return second if first == s.Trees() else first
    if isinstance(second, FILTERS) and not isinstance(first, FILTERS):
        return inside(second, first)
    selector = inside(first, second)
    check_sides(selector, phrase)
    return selector


def check_sides(selector: s.Selector, phrase: NounPhrase) -> None:
    """An edge is one line of trees: it has no half along its own direction, and no opposite side.

    Raises:
        Unclear: The selector asks for one.
    """
    outer = selector
    while (of := getattr(outer, "of", None)) is not None:
        sides = _line_of(outer), _line_of(of) if isinstance(of, s.Edge | s.EdgeMiddle) else ""
        if isinstance(outer, s.Half | s.Edge) and sides[0] == sides[1]:
            advice = "an edge has two halves along its length"
            raise unclear(phrase.terms, f"that edge has no {outer.side}ern part", advice)
        outer = of


def _line_of(selector: object) -> str:
    """Along which line a side lies: north and south on one, east and west on the other."""
    side = str(getattr(selector, "side", ""))
    return {"north": "ns", "south": "ns", "east": "ew", "west": "ew"}.get(side, "")
