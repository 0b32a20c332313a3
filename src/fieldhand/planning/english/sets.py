"""The trees that the phrases around a noun leave to choose from."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from fieldhand.language import message
from fieldhand.language.words import SIDES
from fieldhand.places import selectors as s
from fieldhand.places.selector import FromGroup
from fieldhand.planning.english.faults import unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.syntax import PlacePhrase
from fieldhand.planning.selections import as_edge, as_half, as_zone
from fieldhand.terms import AnySide

#: Selectors that keep a tree or not by itself, whatever the others are: their order does not matter.
FILTERS = (s.Where, s.InZone, s.Within, s.Excluding, s.NotVisited)
#: Selectors that are about rows: which trees are in a row does not depend on the others that are left.
BY_ROWS = (s.Rows, s.RowOf, s.InBlock)


@dataclass
class Group:
    """What a phrase's descriptions say.

    Attributes:
        area: The trees that they leave.
        anchor: The place that nearness is measured from.
        beside: "Next to" rather than "near".
        side: On which side of the anchor.
        region: The descriptions name an area.
        single: The descriptions name one place.
        rows: The rows or blocks that they name; None if they name none.
        one_by_one: Each of these rows or blocks by itself, where each is meant.
        row_of: The tree whose row is meant ("the row of tree 12").
        along: The way goes along the rows.
        upwards: The way goes up the rows.
        rows_of: They are said with "of" ("the northern half of row 3").
        assumed: What was taken for granted.
    """

    area: s.Selector = field(default_factory=s.Trees)
    anchor: s.Selector | None = None
    beside: bool = False
    side: AnySide = "any"
    region: bool = False
    single: bool = False
    rows: s.Selector | None = None
    one_by_one: tuple[s.Selector, ...] = ()
    row_of: s.Selector | None = None
    rows_of: bool = False
    upwards: bool = False
    along: bool = False
    assumed: tuple[str, ...] = ()
    _outer: list[tuple[str, Any]] = field(default_factory=list)

    @property
    def plain(self) -> bool:
        """Whether nothing is said but where to measure from."""
        return self.area == s.Trees() and not self._outer and not self.region

    @property
    def plain_rows(self) -> bool:
        """Whether nothing is said but which rows."""
        return self.area == self.rows and not self._outer and self.anchor is None

    @property
    def empty(self) -> bool:
        """Whether nothing is said."""
        return self.area == s.Trees() and not self._outer and self.anchor is None and not self.region

    def add(self, found: FoundPlace, phrase: PlacePhrase) -> None:
        """Only trees of an area, or of those that another phrase selects."""
        if found.here or found.selector.named_marker or found.selector.named_tree:
            raise unclear(
                phrase.terms, message("there are no trees in one place"), message("say 'the tree nearest to' it")
            )
        self.region = self.region or found.region
        self.single = self.single or not found.many
        selector = found.selector
        if isinstance(selector, s.PointsIn):  # "a tree in the middle of the wet corner" is a tree
            if selector.count > 1:
                raise unclear(
                    phrase.terms,
                    message("points are not trees"),
                    message("say 'at 4 points in the wet corner', for example"),
                )
            selector = s.Middle(of=s.InZone(zone=selector.zone))
        self.assumed += found.assumed
        if found.rows:
            if self.rows is not None:
                raise unclear(
                    phrase.terms, message("rows cannot be selected within rows"), message("name the rows once")
                )
            self.rows, self.one_by_one = selector, found.one_by_one
        before = self.area
        self.area = both(before, selector, phrase)
        if found.rows and before != s.Trees():  # the rows are those of what was said before
            self.rows, self.one_by_one = self.area, tuple(both(before, one, phrase) for one in self.one_by_one)

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
            zones = [z for p in value if (z := as_zone(p)) is not None and z.of == s.Trees() and not z.outside]
            others = tuple(p for p in value if p not in zones)
            for zone in zones:
                selector = replace(zone, outside=True, of=selector)
            if others:
                places = others[0] if len(others) == 1 else s.UnionOf(parts=others)
                selector = s.Excluding(places=places, of=selector)
        return selector


def nested(group: Group, inner: s.Selector) -> s.Selector:
    """The trees that a group leaves of others."""
    return group.kept(inside(group.area, inner))


def inside(outer: s.Selector, inner: s.Selector) -> s.Selector:
    """An expression with its innermost "every tree" replaced."""
    if outer == s.Trees():
        return inner
    if outer.members != (outer,):
        return s.UnionOf(parts=tuple(inside(part, inner) for part in outer.members))
    return outer.around(inside(outer.of, inner)) if isinstance(outer, FromGroup) else outer


def both(first: s.Selector, second: s.Selector, phrase: PlacePhrase) -> s.Selector:
    """Trees of both. Which of two areas is taken of the other matters to their middles; a filter's order does not."""
    if first == s.Trees() or second == s.Trees():
        return second if first == s.Trees() else first
    if _by_rows(second) and not _by_rows(first):
        return _checked(inside(second, first), second, phrase)
    if isinstance(second, FILTERS) and not isinstance(first, FILTERS):
        return _checked(inside(second, first), second, phrase)
    selector = _checked(inside(first, second), first, phrase)
    check_sides(selector, phrase)
    return selector


def _by_rows(selector: s.Selector) -> bool:
    return all(isinstance(part, BY_ROWS) for part in selector.members)


def _checked(selector: s.Selector, outer: s.Selector, phrase: PlacePhrase) -> s.Selector:
    """Nothing that was said may be lost where two selections are made one."""
    if selector == outer:
        raise unclear(
            phrase.terms,
            message("it is not clear which trees these belong to"),
            message("say it in a sentence of its own"),
        )
    return selector


def check_sides(selector: s.Selector, phrase: PlacePhrase) -> None:
    """An edge is one line of trees: it has no half along its own direction, and no opposite side.

    Raises:
        Unclear: The selector asks for one.
    """
    outer = selector
    while (of := getattr(outer, "of", None)) is not None:
        sides = _line_of(outer), _line_of(of) if as_edge(of) is not None or isinstance(of, s.EdgeMiddle) else ""
        halved = as_edge(outer) or as_half(outer)
        if halved is not None and sides[0] == sides[1]:
            advice = message("an edge has two halves along its length")
            raise unclear(phrase.terms, message("that edge has no {side} part", side=SIDES[halved.side]), advice)
        outer = of


def _line_of(selector: object) -> str:
    """Along which line a side lies: north and south on one, east and west on the other."""
    side = str(getattr(selector, "side", ""))
    return {"north": "ns", "south": "ns", "east": "ew", "west": "ew"}.get(side, "")
