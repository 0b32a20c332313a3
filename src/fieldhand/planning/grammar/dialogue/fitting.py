"""Which places a capture means: how many visits, how many captures at each, and one row after the other."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.places import selectors as s
from fieldhand.planning.english.onebyone import MOST_ONE_BY_ONE, one_by_one, swapped
from fieldhand.planning.grammar.dialogue.faults import NotComposed
from fieldhand.planning.grammar.meaning import DriveCommand, Lead, PlaceMeaning, Thing
from fieldhand.planning.selections import are_rows, are_several_rows, as_some, chooses_from_trees, counts_in_row, over
from fieldhand.site.model import Site


def is_spoken_of(place: PlaceMeaning | None) -> bool:
    """Return True for places that were spoken of before, or that the command leaves out."""
    return place is None or place.shape in ("here", "those")


def within_area(place: PlaceMeaning | None, area: s.Selector | None) -> PlaceMeaning | None:
    """Return a place restricted to the area of its sentence, where it can be."""
    if area is None or place is None or place.shape not in ("one", "several") or place.per is not None:
        return place
    if not chooses_from_trees(place.selector) or any(are_rows(part) for part in place.selector.walk()):
        return place
    return replace(place, selector=over(place.selector, area))


def in_area(before: Lead | DriveCommand, place: PlaceMeaning | None) -> PlaceMeaning:
    """Return the place of a command in an area that was named before it ("along row 3, ... at every other tree").

    Raises:
        NotComposed: The two are different places, or how many trees are meant is unclear.
    """
    area = before.place.selector
    if before.place.each and is_spoken_of(place):
        return PlaceMeaning(area, "several", each=True)
    if place is None and isinstance(before, DriveCommand) and are_several_rows(area):
        raise NotComposed("at every tree, or at how many?")
    if place is None or place.shape in ("here", "those"):
        if place is None or not place.each:
            return PlaceMeaning(area, "area")
        if are_rows(area) and place.selector != s.Trees():
            return PlaceMeaning(s.Trees(), "area", each=True, per=area)
        return PlaceMeaning(area, "several", each=True)
    if place.per is None and place.shape in ("one", "several") and chooses_from_trees(place.selector):
        return replace(place, selector=over(place.selector, area))
    of_the_row = swapped(place.selector, s.RowOf(), s.Trees())
    if are_rows(area) and of_the_row != place.selector and chooses_from_trees(of_the_row):
        return in_each_row(area, replace(place, selector=of_the_row))
    raise NotComposed("two places for one command")


def along_row(before: DriveCommand, place: PlaceMeaning) -> PlaceMeaning | None:
    """Return the next trees of the row that the robot is sent up or down; None for other places.

    Raises:
        NotComposed: The two name different directions.
    """
    parts = [part for part in place.selector.members if isinstance(part, s.AlongRow) and part.origin == s.Here()]
    if (
        before.along not in ("down", "up")
        or before.place.selector != s.RowOf()
        or len(parts) != len(place.selector.members)
    ):
        return None
    if {part.towards for part in parts} != {"down"}:
        raise NotComposed("up or down the row?")
    made = tuple(replace(part, towards=before.along) for part in parts)
    return replace(place, selector=made[0] if len(made) == 1 else s.UnionOf(parts=made))


def in_each_row(rows: s.Selector, place: PlaceMeaning) -> PlaceMeaning:
    """Return the place of a command in each of the rows that were named before it ("in each row, ... at the ends").

    Raises:
        NotComposed: The place is none of a row.
    """
    if not chooses_from_trees(place.selector):
        raise NotComposed("two places for one command")
    by_number = all(counts_in_row(part) for part in over(place.selector, s.Rows()).members)
    if by_number or (place.shape == "several" and place.count is None):
        return replace(place, selector=over(place.selector, rows), shape="several")
    return replace(place, shape="several", per=rows)


def spaced(
    place: PlaceMeaning | None, things: tuple[Thing, ...], spacing: float, site: Site
) -> tuple[PlaceMeaning, tuple[Thing, ...]]:
    """Return the free points of captures at a spacing, and the captures at each.

    Raises:
        NotComposed: The line of the points, or their number, is unclear.
    """
    counts = {thing.count for thing in things}
    if len(counts) > 1:
        raise NotComposed("different numbers of captures")
    count = counts.pop() or 0
    once = _once(things)
    if place is None or place.shape != "area":
        if count < 2:
            raise NotComposed("along which row?")
        return PlaceMeaning(s.Spaced(apart_m=spacing, count=count), "several"), once
    area = place.selector if place.per is None else place.per
    rows = one_by_one(area, site) if are_rows(area) else ()
    if not rows:
        raise NotComposed("along which row?")
    if count and len(rows) > 1 and place.per is None:
        raise NotComposed("so many in each row, or in all?")
    if len(rows) == 1:
        return PlaceMeaning(s.Spaced(apart_m=spacing, count=count, of=area), "several"), once
    parts = tuple(s.Spaced(apart_m=spacing, count=count, of=row) for row in rows)
    return PlaceMeaning(s.UnionOf(parts=parts), "several"), once


def fitted(
    place: PlaceMeaning, things: tuple[Thing, ...], relation: str, site: Site
) -> tuple[PlaceMeaning, tuple[Thing, ...]]:
    """Return a place of one or several visits, and the captures at each.

    Raises:
        NotComposed: How many visits are meant is unclear.
    """
    if place.each and place.shape == "several" and place.per is None:
        return place, things
    counts = {thing.count for thing in things}
    if len(counts) > 1 and place.shape not in ("one", "step"):
        raise NotComposed("different numbers of captures")
    count = next(iter(counts)) if len(counts) == 1 else None
    if place.shape == "step":
        if relation == "of":
            raise NotComposed("the tree so far along, or so many trees?")
        return replace(place, shape="one"), things
    if place.shape == "nearby":
        return _nearby(place, things, count), _once(things)
    if place.per is not None:
        return _of_rows(place, place.per, things, count, relation, site), _once(things)
    if place.shape == "one":
        some = as_some(place.selector)
        if some is not None and some.count == 1 and are_several_rows(some.of):
            raise NotComposed("one in each of them, or one in all?")
        return place, things
    if place.shape == "area":
        return _of_area(place, things, count, relation), _once(things)
    if place.each or count is None:
        return place, things
    if count == 1 or count == place.count:
        return place, _once(things)
    raise NotComposed("so many at each place, or in all?")


def _once(things: tuple[Thing, ...]) -> tuple[Thing, ...]:
    """Return captures without their numbers."""
    return tuple(replace(thing, count=None) for thing in things)


def _are_plural(things: tuple[Thing, ...]) -> bool:
    """Return True for captures in the plural."""
    return all(thing.plural for thing in things)


def _nearby(place: PlaceMeaning, things: tuple[Thing, ...], count: int | None) -> PlaceMeaning:
    """Return trees around the robot, as many as there are captures."""
    number = count or (2 if _are_plural(things) else 1)
    if count is None and number > 1:
        raise NotComposed("how many trees?")
    selector: s.Selector = replace(cast(Any, place.selector), count=number)
    return PlaceMeaning(selector, "one" if number == 1 else "several", count=number)


def _of_rows(
    place: PlaceMeaning, rows: s.Selector, things: tuple[Thing, ...], count: int | None, relation: str, site: Site
) -> PlaceMeaning:
    """Return what is said of each of several rows."""
    if place.shape == "area" and count is None and not things[0].count and _are_plural(things):
        return PlaceMeaning(rows, "several")
    if place.shape == "area" and relation == "of":
        raise NotComposed("every tree, or how many?")
    single = one_by_one(rows, site)
    if not single or len(single) > MOST_ONE_BY_ONE:
        raise NotComposed("rows one by one")
    selector = s.Take(count=count or 1, of=s.Trees()) if place.shape == "area" else place.selector
    parts = tuple(over(selector, row) for row in single)
    return PlaceMeaning(parts[0] if len(parts) == 1 else s.UnionOf(parts=parts), "several")


def _of_area(place: PlaceMeaning, things: tuple[Thing, ...], count: int | None, relation: str) -> PlaceMeaning:
    """Return the trees of an area: all of them, or as many as there are captures."""
    if count is None and _are_plural(things):
        return replace(place, shape="several")
    if relation == "of" and count in (None, 1):
        raise NotComposed("every tree, or how many?")
    if count in (None, 1) and are_several_rows(place.selector):
        raise NotComposed("one in each of them, or one in all?")
    number = count or 1
    return PlaceMeaning(s.Take(count=number, of=place.selector), "one" if number == 1 else "several", count=number)
