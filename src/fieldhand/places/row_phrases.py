"""Trees counted along rows, and points on lines, in words: "trees 4 to 9 of row 2", "5 points 15 m apart"."""

from __future__ import annotations

from fieldhand.language import counted, joined, message
from fieldhand.language.words import COMPASS, say_number, say_zone
from fieldhand.places import selectors as s
from fieldhand.places.noun import Phrase
from fieldhand.places.pick_words import picked
from fieldhand.places.row_words import say_numbers, say_ordinal, say_way
from fieldhand.places.saying import Saying, it, many, one, origin
from fieldhand.terms import CountedFrom


def adjacent(selector: s.Adjacent, saying: Saying) -> Phrase:
    """Trees next to each other."""
    near, count = origin(selector.near, saying), selector.count
    if count == 1:
        return picked(s.Nearest(to=selector.near, of=selector.of), saying)
    group = saying.phrase(selector.of)
    if group.plain:
        return many(
            message(
                "{count} trees next to each other, beginning with the one nearest to {place}", count=count, place=near
            )
        )
    return many(
        message(
            "{count} of {trees} next to each other, beginning with the one nearest to {place}",
            count=count,
            trees=group.group(),
            place=near,
        )
    )


def by_number(selector: s.InRow | s.EveryNth, saying: Saying) -> Phrase:
    """Trees by their number in the row."""
    group = saying.phrase(selector.of)
    if isinstance(selector, s.EveryNth):
        return _every_nth(selector, group)
    return _many_from(_numbered(say_numbers(selector), group), selector.counted_from)


def _many_from(said: str, side: CountedFrom) -> Phrase:
    """Trees with the side that they are counted from, where that is not the usual one."""
    if side == "usual":
        return many(said)
    return many(message("{trees}, counted from the {side}", trees=said, side=COMPASS[side]))


def _every_nth(selector: s.EveryNth, group: Phrase) -> Phrase:
    """Every third tree of each row, from the second on."""
    nth = selector.nth
    if group.bare:
        each = "" if group.row else message("of each row")
        of = joined(" ", [part for part in (each, group.of_what) if part])
        match nth:
            case 1:
                said = message("every tree {of_rows}", of_rows=of)
            case 2:
                said = message("every other tree {of_rows}", of_rows=of)
            case _:
                said = message("every {ordinal} tree {of_rows}", ordinal=say_ordinal(nth), of_rows=of)
    else:
        trees = group.group()
        match nth:
            case 1:
                said = message("every one of {trees}", trees=trees)
            case 2:
                said = message("every other one of {trees}", context="trees", trees=trees)
            case _:
                said = message("every {ordinal} one of {trees}", ordinal=say_ordinal(nth), trees=trees)
    if selector.start != 1:
        said = message("{trees}, from the {ordinal} on", trees=said, ordinal=say_ordinal(selector.start, "one"))
    return _many_from(said, selector.counted_from)


def _numbered(number: str, group: Phrase) -> str:
    """Trees 4 to 9 of whichever rows the group stands in."""
    if not group.bare:
        return message("{numbered} of each row among {trees}", numbered=number, trees=group.group())
    if not group.row:
        of = message("of {part}", part=group.block) if group.block else ""
        return message("{numbered} of each row {of_block}", numbered=number, of_block=of)
    if group.one_row or not group.row.startswith(("rows", "the rows")):
        return message("{numbered} of {rows}", numbered=number, rows=group.whose)
    return message("{numbered} of each of {rows}", numbered=number, rows=group.whose)


def from_hand(selector: s.AlongRow | s.Across, saying: Saying) -> Phrase:
    """The tree so many trees along the row, or in the next row."""
    start = "" if isinstance(selector.origin, s.Here) else it(selector.origin, saying)
    if isinstance(selector, s.Across):
        place = start or message("that place")
        if selector.side == "usual":
            return one(message("the tree abreast of {place} in the next row", place=place))
        return one(
            message(
                "the tree abreast of {place} in the next row to the {side}", place=place, side=COMPASS[selector.side]
            )
        )
    way = say_way(selector.towards)
    if selector.trees == 1:
        said = message("the next tree {down_the_row}", down_the_row=way)
    else:
        said = message("the tree {count} trees further {down_the_row}", count=selector.trees, down_the_row=way)
    return one(message("{tree} from {place}", tree=said, place=start) if start else said)


def successive(selector: s.Successive, saying: Saying) -> Phrase:
    """Trees that follow each other in one row."""
    group = saying.phrase(selector.of)
    near, count = origin(selector.near, saying), selector.count
    if count == 1:
        return picked(s.Nearest(to=selector.near, of=selector.of), saying)
    if group.bare:
        each = "" if group.one_row else message("of one row")
        where = joined(" ", [part for part in (each, group.of_what) if part])
        return many(
            message(
                "{count} successive trees {of_row}, as near to {place} as there are",
                count=count,
                of_row=where,
                place=near,
            )
        )
    return many(
        message(
            "{count} of {trees} that follow each other in one row, as near to {place} as there are",
            count=count,
            trees=group.group(),
            place=near,
        )
    )


def apart(selector: s.Apart, saying: Saying) -> Phrase:
    """Trees at a distance from each other."""
    group, count = saying.phrase(selector.of), selector.count
    if group.plain:
        trees = counted("{count} tree", "{count} trees", count)
    else:
        trees = message("{count} of {trees}", count=count, trees=group.group())
    distance = say_number(selector.apart_m)
    if selector.least:
        return many(message("{trees}, at least {distance} m from each other", trees=trees, distance=distance))
    return many(message("{trees}, about {distance} m from each other", trees=trees, distance=distance))


def free_points(selector: s.Spaced | s.PointsIn, saying: Saying) -> Phrase:
    """Places that are tied to no tree."""
    if isinstance(selector, s.PointsIn):
        zone = say_zone(selector.zone)
        if selector.count == 1:
            return one(message("the middle of {zone}", zone=zone))
        return many(message("{count} points spread over {zone}", count=selector.count, zone=zone))
    apart, count = say_number(selector.apart_m), selector.count
    where, near = _line_of(selector, saying), origin(selector.near, saying)
    if count == 1:
        return one(message("a point {where}, beginning at the end nearer to {place}", where=where, place=near))
    if count:
        points = message("{count} points {distance} m apart", count=count, distance=apart)
    else:
        points = message("as many points {distance} m apart as fit", distance=apart)
    return many(
        message("{points} {where}, beginning at the end nearer to {place}", points=points, where=where, place=near)
    )


def _line_of(selector: s.Spaced, saying: Saying) -> str:
    """On which line spaced points lie."""
    group = saying.phrase(selector.of)
    if selector.zone:
        return message("on a line inside {zone}", zone=say_zone(selector.zone))
    if group.bare and group.one_row:
        return message("beside {row}", row=group.whose)
    if group.plain:
        return message("beside the nearest row")
    return message("beside the nearest row of {trees}", trees=group.group())
