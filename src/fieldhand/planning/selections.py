"""Selections: places that a request may mean, and how further words narrow them.

What is true of a selector whatever is said of it is a property of :class:`~fieldhand.places.selector.Selector`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.places import selectors as s
from fieldhand.places.selector import Counted
from fieldhand.terms import CornerName, Side

#: Areas by the order in which they are nested, the innermost first: a row of a half of a block.
_NESTING: dict[type[s.Selector], int] = {
    s.InBlock: 0,
    s.Half: 1,
    s.Quarter: 1,
    s.Edge: 2,
    s.Rows: 2,
    s.InZone: 3,
}
#: Number of free points of which something else says how many there are.
OPEN_NUMBER = 0
#: Selectors of areas.
AREAS = tuple(_NESTING)


def is_gate(selector: s.Selector) -> bool:
    """Return True for a gate by its name."""
    return isinstance(selector, s.GateIs)


def over(selector: s.Selector, base: s.Selector) -> s.Selector:
    """Return a selector that chooses from ``base`` instead of from every tree of the site.

    Areas are nested in a fixed order, whatever the order of the words: "the northern half in row 4" is row 4 of the
    northern half. "The first tree" of rows is the first tree of each.
    """
    if selector == s.Trees():
        return base
    if isinstance(selector, s.UnionOf):
        return s.UnionOf(parts=tuple(over(part, base) for part in selector.parts))
    if isinstance(selector, s.First | s.Last) and selector.of == s.Trees() and are_rows(base):
        number = 1 if isinstance(selector, s.First) else -1
        return s.InRow(first=number, last=number, of=base)
    rank, other = _NESTING.get(type(selector)), _rank(base)
    if rank is not None and other is not None and rank < other:
        return over(base, selector)
    of = getattr(selector, "of", None)
    if of is None:
        return selector
    if isinstance(selector, s.Excluding) and all(is_end_of_site(part) for part in selector.places.members):
        return s.Excluding(places=over(selector.places, base), of=over(of, base))  # "all but the last tree" of a row
    changed: s.Selector = replace(cast(Any, selector), of=over(of, base))
    return changed


def _rank(selector: s.Selector) -> int | None:
    """Return how far outside an area is nested; None for a selector that is no area."""
    if isinstance(selector, s.UnionOf):
        return max((rank for part in selector.parts if (rank := _rank(part)) is not None), default=None)
    return _NESTING.get(type(selector))


def parts(selector: s.Selector) -> tuple[s.Selector, ...]:
    """Return the selectors that a selector is directly made of, in the order of its fields."""
    values = (getattr(selector, name) for name in selector.__dataclass_fields__)
    inner = (part for value in values for part in (value if isinstance(value, tuple) else (value,)))
    return tuple(part for part in inner if isinstance(part, s.Selector))


def anchors(selector: s.Selector) -> tuple[s.Selector, ...]:
    """Return what trees are said to be near to, or far from."""
    found = (getattr(selector, name, None) for name in ("to", "origin", "near"))
    return tuple(one for one in found if isinstance(one, s.Selector))


def swapped(selector: s.Selector, old: s.Selector, new: s.Selector) -> s.Selector:
    """Return a selector with one part in the place of another."""
    if selector == old:
        return new
    changed: dict[str, object] = {}
    for name in selector.__dataclass_fields__:
        value = getattr(selector, name)
        if isinstance(value, s.Selector):
            changed[name] = swapped(value, old, new)
        elif isinstance(value, tuple) and any(isinstance(item, s.Selector) for item in value):
            changed[name] = tuple(swapped(item, old, new) for item in value)
    outer: Any = selector
    made: s.Selector = replace(outer, **changed)
    return made


def as_along_row(selector: s.Selector) -> s.AlongRow | None:
    """Return the selector if it counts trees along a row, None otherwise."""
    return selector if isinstance(selector, s.AlongRow) else None


def moves_on(selector: s.Selector) -> bool:
    """Return True for a place so many trees along the row, or rows across, from where the robot is."""
    row = as_along_row(selector)
    return (row is not None and row.origin == s.Here()) or (
        isinstance(selector, s.Take) and is_row_of_place(selector.of)
    )


def as_random(selector: s.Selector) -> s.RandomSample | None:
    """Return the selector if it draws at random, None otherwise."""
    return selector if isinstance(selector, s.RandomSample) else None


def as_row_of(selector: s.Selector) -> s.RowOf | None:
    """Return the selector if it is the row of a place or one counted from it, None otherwise."""
    return selector if isinstance(selector, s.RowOf) else None


def are_rows(selector: s.Selector) -> bool:
    """Return True for rows, and for lists of rows."""
    return all(isinstance(part, s.Rows | s.RowOf) for part in selector.members)


def rows_kept(selector: s.Selector) -> s.Selector | None:
    """Return the rows of which a selector leaves some out ("all rows except 3"); None for another selector."""
    if isinstance(selector, s.Excluding) and are_rows(selector.of) and are_rows(selector.places):
        return selector.of
    return None


def replaceable_area(selector: s.Selector, area: s.Selector) -> s.Selector | None:
    """Return the part of a selector that another area of the same kind can take the place of; None if none can."""
    if are_rows(selector) and are_rows(area):
        return selector
    alike = {
        part
        for part in selector.walk()
        if isinstance(part, AREAS) and (are_rows(part) if are_rows(area) else type(part) is type(area))
    }
    if len(alike) != 1:
        return None
    (part,) = alike
    return part if {getattr(one, "of", None) for one in area.members} == {getattr(part, "of", None)} else None


def is_whole_rows(rows: s.Selector) -> bool:
    """Return True for rows of the whole site, or of a block, that nothing else restricts."""
    return all(isinstance(part.of, s.Trees | s.InBlock) for part in rows_of(rows))


def picks_per_row(selector: s.Selector) -> bool:
    """Return True if a selector picks trees of each of several rows."""
    return any(isinstance(part, s.Quota) and part.per == "row" for part in selector.walk())


def is_one_row(rows: s.Selector) -> bool:
    """Return True for a single row."""
    return isinstance(rows, s.RowOf) or (isinstance(rows, s.Rows) and rows.first == rows.last != "")


def are_several_rows(selector: s.Selector) -> bool:
    """Return True for several rows, whose trees are selected."""
    return are_rows(selector) and not is_one_row(selector)


def counts_in_row(selector: s.Selector) -> bool:
    """Return True for trees that are counted along their rows."""
    return isinstance(selector, s.InRow)


def as_in_row(selector: s.Selector) -> s.InRow | None:
    """Return the selector if it counts trees along their rows, None otherwise."""
    return selector if isinstance(selector, s.InRow) else None


def rows_of(selector: s.Selector) -> tuple[s.Rows, ...]:
    """Return the rows in a selector that are named by their labels, or are all rows."""
    return tuple(part for part in selector.walk() if isinstance(part, s.Rows))


def chooses_from_trees(selector: s.Selector) -> bool:
    """Return True if a selector can be restricted: it chooses from every tree of the site at last."""
    if selector == s.Trees():
        return True
    if isinstance(selector, s.UnionOf):
        return all(chooses_from_trees(part) for part in selector.parts)
    if isinstance(selector, s.RowOf):
        return False
    of = getattr(selector, "of", None)
    return of is not None and chooses_from_trees(of)


def specifies_part(selector: s.Selector) -> bool:
    """Return True for trees that are described without an area of their own ("the yellow trees", "the first tree")."""
    described = selector != s.Trees() and chooses_from_trees(selector)
    return described and not any(isinstance(part, AREAS) for part in selector.walk())


def landmark_of(one: s.Selector, other: s.Selector) -> s.Selector | None:
    """Return the place that a tree is near or far from, if "it" then means that place ("far from it"); None otherwise.

    "The tree nearest to the charger and the one farthest from it" are both measured from the charger.
    """
    marks = {s.Nearest: "to", s.Farthest: "origin"}
    if type(one) not in marks or type(other) not in marks or type(one) is type(other):
        return None
    landmark: s.Selector = getattr(one, marks[type(one)])
    refers = getattr(other, marks[type(other)]) == s.Here()
    return landmark if refers and not landmark.relative else None


def are_meant_each(selector: s.Selector) -> bool:
    """Return True if "the tree at" several such places means one tree at each ("the tree at the corners")."""
    return isinstance(selector, s.Corners)


def named_places(selector: s.Selector) -> tuple[s.Selector, ...]:
    """Return the places that were named one by one, parts of a list or corners; none if they were not."""
    if isinstance(selector, s.Corners):
        return tuple(replace(selector, which=(corner,)) for corner in selector.which)
    return selector.members if isinstance(selector, s.UnionOf) else ()


def starts_here(selector: s.Selector) -> bool:
    """Return True if the selector leads along or across rows from the current place."""
    return isinstance(selector, s.RowOf | s.AlongRow | s.Across) and selector.origin == s.Here()


def measures_from_here(selector: s.Selector) -> bool:
    """Return True if it contains the nearest or farthest trees, measured from the current place."""
    return any(isinstance(part, s.Nearest | s.Farthest) and s.Here() in part.inner for part in selector.walk())


def is_spot(place: s.Selector) -> bool:
    """Return True for a point such as a corner or a middle, whose nearest tree is the one meant."""
    return place.single and (place.central or isinstance(place, s.Corners))


def all_but(place: s.Selector) -> s.Selector:
    """Return the trees outside of a zone, or all trees but those of other places."""
    return replace(place, outside=True) if isinstance(place, s.InZone) else s.Excluding(places=place)


def is_end_of_site(selector: s.Selector) -> bool:
    """Return True for the first or the last tree of the site."""
    return isinstance(selector, s.First | s.Last)


def as_zone(selector: s.Selector) -> s.InZone | None:
    """Return the selector if it selects by a zone, None otherwise."""
    return selector if isinstance(selector, s.InZone) else None


def is_extreme(selector: s.Selector) -> bool:
    """Return True for the trees farthest to a side."""
    return isinstance(selector, s.Extreme)


def is_drawn(selector: s.Selector) -> bool:
    """Return True for trees that are drawn at random."""
    return isinstance(selector, s.RandomSample)


def drawn_like(some: s.Selector, before: s.Selector) -> s.Selector:
    """Return some places as places that are drawn at random, if those before them are: "six more on the slope"."""
    if not is_random(before):
        return some
    if isinstance(some, s.PointsIn) and some.count > 1:
        return replace(some, random=True)
    return s.RandomSample(count=some.count, of=some.of) if isinstance(some, s.Take) else some


def is_random(selector: s.Selector) -> bool:
    """Return True for trees or points of ground that are drawn at random."""
    return isinstance(selector, s.RandomSample) or (isinstance(selector, s.PointsIn) and selector.random)


def as_spread_points(selector: s.Selector) -> s.PointsIn | None:
    """Return the selector if it spreads free points over a zone, None if it draws them or selects others."""
    return selector if isinstance(selector, s.PointsIn) and not selector.random else None


def as_corners(selector: s.Selector) -> s.Corners | None:
    """Return the selector if it selects corner trees, None otherwise."""
    return selector if isinstance(selector, s.Corners) else None


def as_excluding(selector: s.Selector) -> s.Excluding | None:
    """Return the selector if it leaves out places, None otherwise."""
    return selector if isinstance(selector, s.Excluding) else None


def part_on_side(side: s.Selector, whole: s.Selector) -> s.Selector | None:
    """Return a half or a quarter that is named by its side alone as that of an area; None for other selectors."""
    found = compass_part(side)
    return replace(cast(Any, side), of=whole) if found is not None and found[1] == s.Trees() else None


def compass_part(selector: s.Selector) -> tuple[Side | CornerName, s.Selector] | None:
    """Return the side of a half or a quarter and the area that it is a part of; None for other selectors."""
    if isinstance(selector, s.Half):
        return selector.side, selector.of
    return (selector.quarter, selector.of) if isinstance(selector, s.Quarter) else None


def as_half(selector: s.Selector) -> s.Half | None:
    """Return the selector if it is a half of the site, None otherwise."""
    return selector if isinstance(selector, s.Half) else None


def as_edge(selector: s.Selector) -> s.Edge | None:
    """Return the selector if it is an edge, None otherwise."""
    return selector if isinstance(selector, s.Edge) else None


def as_beside(selector: s.Selector) -> s.Beside | None:
    """Return the selector if it names a side of trees, None otherwise."""
    return selector if isinstance(selector, s.Beside) else None


def as_rows(selector: s.Selector) -> s.Rows | None:
    """Return the selector if it is rows by their labels or all rows, None otherwise."""
    return selector if isinstance(selector, s.Rows) else None


def as_ordered(selector: s.Selector) -> s.Ordered | None:
    """Return the selector if it sorts places, None otherwise."""
    return selector if isinstance(selector, s.Ordered) else None


def as_every_nth(selector: s.Selector) -> s.EveryNth | None:
    """Return the selector if it selects every n-th tree, None otherwise."""
    return selector if isinstance(selector, s.EveryNth) else None


def as_some(selector: s.Selector) -> s.Take | None:
    """Return the selector if it selects a number of any trees, None otherwise."""
    return selector if isinstance(selector, s.Take) else None


def of_each(selector: s.Selector, per: str, whole: s.Selector) -> s.Quota | None:
    """Return a number of any trees, or of those drawn at random, as so many of each group; None for other selectors.

    Args:
        selector: Trees of one group.
        per: Groups, as in :class:`~fieldhand.places.picks.quota.Quota`.
        whole: Trees of all groups.
    """
    match selector:
        case s.Take() if selector.of != s.NotVisited():
            return s.Quota(per=per, count=selector.count, of=over(selector.of, whole))
        case s.RandomSample():
            return s.Quota(per=per, count=selector.count, how="random", seed=selector.seed, of=over(selector.of, whole))
        case s.Quota() if not selector.per:
            return replace(selector, per=per, of=over(selector.of, whole))
        case _:
            return None


def as_quota(selector: s.Selector) -> s.Quota | None:
    """Return the selector if it selects a number or a share of each group, None otherwise."""
    return selector if isinstance(selector, s.Quota) else None


def is_next_to_here(selector: s.Selector) -> bool:
    """Return True for trees that stand next to where the robot is."""
    return isinstance(selector, s.Nearest) and selector.adjacent and selector.to == s.Here()


def measures_distance(selector: s.Selector) -> bool:
    """Return True for trees that are chosen by their distance to a place."""
    return isinstance(selector, s.Within | s.Nearest | s.Farthest)


def centre_of(selector: s.Selector) -> s.Selector | None:
    """Return the place within a distance of which trees are meant, which is none of them; None of other trees."""
    return selector.to if isinstance(selector, s.Within) else None


def are_unvisited(selector: s.Selector) -> bool:
    """Return True for trees that the robot has not visited."""
    return isinstance(selector, s.NotVisited)


def side_named(selector: s.Selector) -> tuple[str, str] | None:
    """Return the kind and the name of a half, a quarter or one corner; None for another selector."""
    match selector:
        case s.Half():
            return "half", selector.side
        case s.Quarter():
            return "quarter", selector.quarter
        case s.Corners() if len(selector.which) == 1:
            return "corner", selector.which[0]
        case _:
            return None


def as_nearest(selector: s.Selector) -> s.Nearest | None:
    """Return the selector if it takes the nearest trees, None otherwise."""
    return selector if isinstance(selector, s.Nearest) else None


def as_apart(selector: s.Selector) -> s.Apart | None:
    """Return the selector if it takes trees at a distance from each other, None otherwise."""
    return selector if isinstance(selector, s.Apart) else None


def rank_of(selector: s.Selector) -> tuple[str, bool] | None:
    """Return the attribute by which trees are ranked or bounded, and True for its low values; None for others."""
    match selector:
        case s.Top():
            return selector.attribute, selector.lowest
        case s.Where(test="lt" | "gt"):
            return selector.attribute, selector.test == "lt"
        case _:
            return None


def as_top(selector: s.Selector) -> s.Top | None:
    """Return the selector if it takes the best by an attribute, None otherwise."""
    return selector if isinstance(selector, s.Top) else None


def blocks_of(selector: s.Selector) -> tuple[s.InBlock, ...]:
    """Return the blocks that are part of a selector."""
    return tuple(part for part in selector.walk() if isinstance(part, s.InBlock))


def is_block(selector: s.Selector) -> bool:
    """Return True for the trees of a block."""
    return isinstance(selector, s.InBlock)


def is_in_block(selector: s.Selector) -> bool:
    """Return True if a block is part of it."""
    return any(isinstance(part, s.InBlock) for part in selector.walk())


def is_row_of_place(selector: s.Selector) -> bool:
    """Return True for the row of a place, or one counted from it."""
    return isinstance(selector, s.RowOf)


def some_of(of: s.Selector, count: int) -> s.Selector:
    """Return a number of trees of a group: spread evenly along a row, else those with a short drive."""
    length = of.count if isinstance(of, s.Successive) else trees_ahead(of)
    return s.Evenly(count=count, of=of) if 1 < count < length else s.Take(count=count, of=of)


def trees_ahead(selector: s.Selector) -> int:
    """Return the number of trees in a run along the row from the current place ("the next 5 trees"); 0 for others."""
    members = selector.members
    first = as_along_row(members[0])
    run = first is not None and all(
        part == replace(first, trees=number) for number, part in enumerate(members, start=1)
    )
    return len(members) if run and starts_here(selector.members[0]) else 0


def from_nearest_row(selector: s.Selector) -> s.Selector:
    """Return the next trees along the row as trees of the nearest row, for a position at no tree."""
    if not isinstance(selector, s.Evenly) or not (length := trees_ahead(selector.of)):
        return selector
    return replace(selector, of=s.Successive(count=length))


def is_across(selector: s.Selector) -> bool:
    """Return True for the tree across the aisle."""
    return isinstance(selector, s.Across)


def is_by_attribute(selector: s.Selector) -> bool:
    """Return True if trees are chosen by an attribute ("yellow", "with vigor below 0.4")."""
    return any(isinstance(part, s.Where) for part in selector.walk())


def is_by_value(selector: s.Selector) -> bool:
    """Return True for trees whose attribute has a value other than a name ("with vigor below 0.4", "with mildew")."""
    return isinstance(selector, s.Where) and not isinstance(selector.value, str)


def picks_from_all(selector: s.Selector) -> bool:
    """Return True if a number of trees is chosen from all trees of the site ("the oldest tree")."""
    return isinstance(selector, Counted) and selector.of == s.Trees()


def picked_from(selector: s.Selector) -> s.Selector | None:
    """Return the trees of which some are chosen ("the trees of row 3" of "the oldest tree in row 3"); else None."""
    return selector.of if isinstance(selector, Counted) else None


def leaves_out(selector: s.Selector) -> bool:
    """Return True if an exception ends the description of trees, or that of those from which some are taken."""
    return isinstance(selector, s.Excluding) or (isinstance(selector, s.Take) and leaves_out(selector.of))


def is_description(selector: s.Selector) -> bool:
    """Return True if trees are chosen by attributes and areas alone ("yellow trees of row 3"), and not all are."""
    parts = list(selector.walk())
    return len(parts) > 1 and all(isinstance(part, (s.Where, s.Trees, *AREAS)) for part in parts)


def as_where(selector: s.Selector) -> s.Where | None:
    """Return the selector if it tests an attribute, None otherwise."""
    return selector if isinstance(selector, s.Where) else None


def chosen_from(selector: s.Selector, group: s.Selector) -> bool:
    """Return True if some of a group described by an attribute are selected: six basil plants, of the basil."""
    kind = as_where(group)
    inside = [where for part in selector.walk() if (where := as_where(part)) is not None]
    same = [w for w in inside if kind is not None and replace(w, of=s.Trees()) == replace(kind, of=s.Trees())]
    return bool(same) and as_where(selector) is None


def has_open_number(selector: s.Selector) -> bool:
    """Return True for free points, or plants drawn at random, of which it is not said how many there are."""
    return any(isinstance(part, s.PointsIn | s.RandomSample) and part.count == OPEN_NUMBER for part in selector.walk())


def with_number(selector: s.Selector, count: int) -> s.Selector:
    """Return places drawn at random, or free points, with their number, where it was open."""
    if isinstance(selector, s.PointsIn | s.RandomSample) and selector.count == OPEN_NUMBER:
        return replace(selector, count=count)
    return selector
