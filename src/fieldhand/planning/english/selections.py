"""Questions about a selection that matter to English alone: what words may mean by it, and what may be said of it next.

What is true of a selector whatever the language is a property of :class:`~fieldhand.places.selector.Selector`.
"""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s


def says_how_many(selector: s.Selector) -> bool:
    """Return True if the words of a selection say how many trees are meant ("the 4 oldest", "the corners")."""
    return isinstance(selector, s.Take | s.Top | s.Extreme | s.Nearest | s.Adjacent | s.Corners | s.UnionOf)


def may_be_listed(selector: s.Selector) -> bool:
    """Return True if a list of its places may follow ("at the corners: first the south-west one, then ...")."""
    return isinstance(selector, s.Corners) or selector.any_of is not None


def are_meant_each(selector: s.Selector) -> bool:
    """Return True if "the tree at" several such places means one at each of them ("the tree at the corners")."""
    return isinstance(selector, s.Corners)


def named_places(selector: s.Selector) -> tuple[s.Selector, ...]:
    """Return the places that were named one by one, parts of a list or corners; none if they were not."""
    if isinstance(selector, s.Corners):
        return tuple(replace(selector, which=(corner,)) for corner in selector.which)
    return selector.members if isinstance(selector, s.UnionOf) else ()


def names_here(selector: s.Selector) -> bool:
    """Return True if the place in hand is named along with others ("it and the one beside it")."""
    return selector != s.Here() and s.Here() in selector.members


def starts_here(selector: s.Selector) -> bool:
    """Return True if it is a way along or across rows from the place in hand."""
    return isinstance(selector, s.RowOf | s.AlongRow | s.Across) and selector.origin == s.Here()


def measures_from_here(selector: s.Selector) -> bool:
    """Return True if the nearest or the farthest of some trees from the place in hand is part of it."""
    return any(isinstance(part, s.Nearest | s.Farthest) and s.Here() in part.inner for part in selector.walk())


def may_be_near(selector: s.Selector) -> bool:
    """Return True if the robot may be there, or close by, when it is named: it depends on where the robot is."""
    return any(isinstance(part, s.Here | s.Take | s.NotVisited | s.RowOf | s.Nearest) for part in selector.walk())


def so_many_nearby(selector: s.Selector | None, count: int) -> s.Selector | None:
    """Return that many trees nearby where no number was said of them yet ("nearby trees"); None of other places."""
    return replace(selector, count=count) if isinstance(selector, s.Nearest) and selector.count == 1 else None


def is_spot(place: s.Selector) -> bool:
    """Return True if a place is a spot of the ground: the tree nearest to a corner or a middle is the one there."""
    return place.single and (place.central or isinstance(place, s.Corners))


def zone_of_points(selector: s.Selector) -> str:
    """Return the zone that free points may be spread over where all trees in it, or near it, are meant; else nothing.

    Points of the zone itself are near it, too.
    """
    if isinstance(selector, s.InZone) and selector == s.InZone(zone=selector.zone, margin_m=selector.margin_m):
        return selector.zone
    return ""


def all_but(place: s.Selector) -> s.Selector:
    """Return the trees outside of a zone, or all trees but those of other places."""
    return replace(place, outside=True) if isinstance(place, s.InZone) else s.Excluding(places=place)


def is_about_rows(selector: s.Selector) -> bool:
    """Return True if a row that is named, or counted from a place, is part of it."""
    return any(part.row_of is not None or isinstance(part, s.Rows) for part in selector.walk())


def skips_rows(selector: s.Selector) -> bool:
    """Return True if it takes every so many rows ("every third row")."""
    return isinstance(selector, s.Rows) and selector.every > 1


def names_several_rows(rows: s.Selector) -> bool:
    """Return True if several rows or blocks are named one by one or as a range ("rows 2 and 4", "rows 2 to 5")."""
    return isinstance(rows, s.UnionOf) or (isinstance(rows, s.Rows) and rows.first != rows.last)


def are_several_rows(rows: s.Selector) -> bool:
    """Return True if several rows are meant, named or all of them ("the rows")."""
    return names_several_rows(rows) or (isinstance(rows, s.Rows) and not rows.first)
