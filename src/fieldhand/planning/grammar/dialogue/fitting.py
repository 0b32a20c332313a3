"""The places that a capture means: how many visits, how many captures at each, and one row after the other."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, OpenQuestion, Setting
from fieldhand.planning.grammar.meaning import DriveCommand, Lead, PlaceMeaning, Thing
from fieldhand.planning.grammar.places.areas import of_each_block
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.sampling import bare_points, bare_zone, is_keep_out
from fieldhand.planning.grammar.places.zone_parts import part_of_ground, part_within
from fieldhand.planning.grammar.row_by_row import MOST_ONE_BY_ONE, one_by_one
from fieldhand.planning.selections import (
    AREAS,
    are_rows,
    are_several_rows,
    as_along_row,
    as_excluding,
    as_in_row,
    as_some,
    as_spread_points,
    as_zone,
    chooses_from_trees,
    counts_in_row,
    is_in_block,
    is_one_row,
    of_each,
    over,
    rows_kept,
    swapped,
)
from fieldhand.site.model import Site

#: Largest area of something that is one place, and not ground over which several are spread, in square metres.
_LARGEST_SPOT_M2 = 25.0
#: Words that tie captures to an area and leave open at which of its trees ("a picture of row 3", "along row 3").
_OPEN = ("of", "along")


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


def in_area(setting: Setting, before: Lead | DriveCommand, place: PlaceMeaning | None) -> PlaceMeaning:
    """Return the place of a command in an area that was named before it ("along row 3, ... at every other tree").

    Raises:
        NotComposed: The two are different places, or how many trees are meant is unclear.
    """
    area = before.place.selector
    middles = [bare_points(part, setting.site, 1) for part in area.members]
    if len(middles) > 1 and None not in middles and is_spoken_of(place):
        spots = s.UnionOf(parts=tuple(one for one in middles if one is not None))
        return PlaceMeaning(spots, "several", count=len(middles), each=True)
    if before.place.each and is_spoken_of(place):
        return PlaceMeaning(area, "several", each=True)
    if place is None and isinstance(before, DriveCommand) and are_several_rows(area):
        each = PlaceMeaning(area, "several", each=True)
        ways = (each, PlaceMeaning(s.Quota(per="row", count=1, of=area), "several"))
        return setting.either("at every tree, or at how many?", before.used, ways)
    if place is None or place.shape in ("here", "those"):
        if is_keep_out(area, setting.site):
            zone = as_zone(area)
            name = "" if zone is None else zone.zone
            raise NotComposed(message("{name} is a keep-out zone", name=name), advice=message("say 'at its edge'"))
        if place is None or not place.each:
            return PlaceMeaning(area, "area")
        if are_rows(area) and not is_one_row(area) and place.selector != s.Trees():
            return PlaceMeaning(s.Trees(), "area", each=True, per=area)
        return PlaceMeaning(area, "several", each=True)
    part = part_within(place.selector) if place.per is None and bare_zone(area, setting.site) else None
    there = None if part is None else part_of_ground(place.selector, part, area, setting.site)
    if there is not None:  # "in the herb patch, ... at the corners"
        return replace(place, selector=there, shape="one" if place.shape == "area" else place.shape)
    if place.per is None and place.shape in ("one", "several") and chooses_from_trees(place.selector):
        counted = [row for part in place.selector.walk() if (row := as_in_row(part)) is not None]
        if isinstance(area, s.RowOf) and any(row.of == s.Trees() for row in counted):
            return place  # "go down the row, ... at the third tree": counted from here, or from the end?
        selector = over(place.selector, area)
        of_each_row = are_several_rows(area) and all(counts_in_row(part) for part in selector.members)
        return replace(place, selector=selector, shape="several" if of_each_row else place.shape)
    if place.per is not None and are_rows(place.per) and not is_in_block(place.per) and not are_rows(area):
        return replace(place, per=over(place.per, area))  # "in the south block, the middle tree of every fifth row"
    within_block = is_in_block(area) and not is_in_block(place.selector) and chooses_from_trees(place.selector)
    if place.shape == "area" and place.per is None and within_block:
        return replace(place, selector=over(place.selector, area))  # "in the north block, ... rows 3 to 5"
    of_the_row = swapped(place.selector, s.RowOf(), s.Trees())
    if are_rows(area) and of_the_row != place.selector and chooses_from_trees(of_the_row):
        return in_each_row(area, replace(place, selector=of_the_row))
    raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))


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
        raise NotComposed(message("it is not clear in which direction along the row", context="fault"))
    made = tuple(replace(part, towards=before.along) for part in parts)
    return replace(place, selector=made[0] if len(made) == 1 else s.UnionOf(parts=made))


def of_each_before(state: DialogueState, place: PlaceMeaning | None) -> PlaceMeaning | None:
    """Return a place in each of the rows of its sentence ("in each row the first tree, then the last"), if it fits."""
    if state.each_of is None or place is None or place.shape not in ("one", "several") or place.per is not None:
        return place
    own_area = any(isinstance(part, AREAS) for part in place.selector.walk())
    named = any(part.named_tree for part in place.selector.members)
    if place.selector.relative or own_area or named or not chooses_from_trees(place.selector):
        return place
    return in_each_row(state.each_of, place)


def in_each_row(rows: s.Selector, place: PlaceMeaning) -> PlaceMeaning:
    """Return the place of a command in each of the rows that were named before it ("in each row, ... at the ends").

    Raises:
        NotComposed: The place is none of a row.
    """
    place = replace(place, selector=swapped(place.selector, s.RowOf(), s.Trees()))  # "for each row, ... at its end"
    if not chooses_from_trees(place.selector):
        raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
    by_number = are_rows(rows) and all(counts_in_row(part) for part in over(place.selector, s.Rows()).members)
    if by_number or (place.shape == "several" and place.count is None):
        return replace(place, selector=over(place.selector, rows), shape="several")
    return replace(place, shape="several", per=rows)


def spaced(
    setting: Setting, place: PlaceMeaning | None, things: tuple[Thing, ...], spacing: float, used: int
) -> tuple[PlaceMeaning, tuple[Thing, ...]]:
    """Return the free points of captures at a spacing, and the captures at each.

    Raises:
        NotComposed: The line of the points, or their number, is unclear.
    """
    counts = {thing.count for thing in things}
    if len(counts) > 1:
        raise NotComposed(message("it gives two different numbers", context="fault"))
    count = counts.pop() or 0
    once = _once(things)
    if place is None or place.shape != "area":
        if count < 2:
            asked = message("'{said}': how many, or along which row?", context="question", said=setting.quoted(used))
            raise OpenQuestion(asked)
        return PlaceMeaning(s.Spaced(apart_m=spacing, count=count), "several"), once
    area = place.selector if place.per is None else place.per
    if zone := bare_zone(area, setting.site):
        line = s.Spaced(apart_m=spacing, count=count, zone=zone)
        if count > 1:
            return PlaceMeaning(line, "several"), once
        ways = (s.Grid(every_m=spacing, zone=zone), line)
        return PlaceMeaning(setting.either("on a grid, or along a line?", used, ways), "several"), once
    rows = one_by_one(area, setting.site) if are_rows(area) else ()
    if not rows:
        raise NotComposed(message("it is not clear along which row", context="fault"))
    if count and len(rows) > 1 and place.per is None:
        asked = message(
            "'{said}': {count} along each row, or {count} in all?",
            context="question",
            said=setting.quoted(used),
            count=count,
        )
        raise OpenQuestion(asked)
    if len(rows) == 1:
        return PlaceMeaning(s.Spaced(apart_m=spacing, count=count, of=area), "several"), once
    parts = tuple(s.Spaced(apart_m=spacing, count=count, of=row) for row in rows)
    return PlaceMeaning(s.UnionOf(parts=parts), "several"), once


def fitted(
    setting: Setting, place: PlaceMeaning, things: tuple[Thing, ...], relation: str, used: int
) -> tuple[PlaceMeaning, tuple[Thing, ...]]:
    """Return a place of one or several visits, and the captures at each.

    Args:
        setting: Robot and site that the request is read for.
        place: Place that the phrase names.
        things: Captures.
        relation: What ties them to the place.
        used: Tokens of the command.

    Raises:
        NotComposed: How many visits are meant is unclear.
    """
    _require_whole_ground(setting, place)
    if place.each and place.shape == "several" and place.per is None:
        return place, things
    counts = {thing.count for thing in things}
    if len(counts) > 1 and place.shape not in ("one", "step"):
        raise NotComposed(message("it gives two different numbers", context="fault"))
    count = next(iter(counts)) if len(counts) == 1 else None
    if place.shape == "step":
        return setting.either("the tree so far along, or so many trees?", used, _along(place, relation)), things
    if place.shape == "nearby":
        return _nearby(setting, place, things, count, used), _once(things)
    if place.per is not None:
        return _of_rows(setting, place, place.per, things, count, relation, used), _once(things)
    if place.shape == "one":
        some = as_some(place.selector)
        if some is not None and some.count == 1 and are_several_rows(some.of):
            return _one_in_each_or_in_all(setting, some.of, used), things
        return place, things
    if place.shape == "area":
        return _of_area(setting, place, things, count, relation, used), _once(things)
    if place.each or count is None:
        return place, things
    if count == 1 or count == place.count:
        return place, _once(things)
    return setting.either("so many at each place, or in all?", used, _at_each_or_in_all(setting, place, things, count))


def _require_whole_ground(setting: Setting, place: PlaceMeaning) -> None:
    """Raise unless points of ground without plants are those of a zone as a whole."""
    for part in place.selector.walk():
        rest = as_excluding(part)
        if rest is not None and (as_spread_points(rest.of) is not None or bare_zone(rest.of, setting.site)):
            raise NotComposed(
                message("so many points of bare ground are spread over all of it", context="fault"),
                advice=message("say 'on a 10 m grid over the meadow except the wet corner', or 'every 10 m'"),
            )


def _once(things: tuple[Thing, ...]) -> tuple[Thing, ...]:
    """Return captures without their numbers."""
    return tuple(replace(thing, count=None) for thing in things)


def _are_plural(things: tuple[Thing, ...]) -> bool:
    """Return True for captures in the plural."""
    return all(thing.plural for thing in things)


def _along(place: PlaceMeaning, relation: str) -> tuple[PlaceMeaning, ...]:
    """Return the meanings of "5 trees down the row": the tree that is so far along, and for "of" the trees up to it."""
    far = replace(place, shape="one")
    last = as_along_row(place.selector)
    if relation != "of" or last is None or last.trees < 2:
        return (far,)
    steps = tuple(replace(last, trees=number) for number in range(1, last.trees + 1))
    return (far, PlaceMeaning(s.UnionOf(parts=steps), "several", count=len(steps)))


def _at_each_or_in_all(
    setting: Setting, place: PlaceMeaning, things: tuple[Thing, ...], count: int
) -> tuple[tuple[PlaceMeaning, tuple[Thing, ...]], ...]:
    """Return the meanings of "2 pictures at the corners": so many at each place, and so many in all."""
    ways = [(place, things)]
    places = place.count or len(ids_of(place.selector, setting.site) or ())
    if 0 < count < places:
        some = PlaceMeaning(s.Take(count=count, of=place.selector), "one" if count == 1 else "several", count=count)
        ways.append((some, _once(things)))
    elif places and count > places and count % places == 0:
        ways.append((place, tuple(replace(thing, count=count // places) for thing in things)))
    if len(ways) == 1:
        raise NotComposed(
            message("it is not clear whether so many are meant at each place, or in all", context="fault")
        )
    return tuple(ways)


def _one_in_each_or_in_all(setting: Setting, rows: s.Selector, used: int) -> PlaceMeaning:
    """Return one tree of each of several rows, or one of all of them."""
    named = rows.members
    ones = named if len(named) > 1 and all(is_one_row(row) for row in named) else one_by_one(rows, setting.site)
    if not 1 < len(ones) <= MOST_ONE_BY_ONE:
        raise NotComposed(
            message("it is not clear whether one in each of them is meant, or one in all", context="fault")
        )
    each = PlaceMeaning(s.Quota(per="row", count=1, of=rows), "several", count=len(ones))
    return setting.either(
        "one in each of them, or one in all?", used, (each, PlaceMeaning(s.Take(count=1, of=rows), "one"))
    )


def _nearby(
    setting: Setting, place: PlaceMeaning, things: tuple[Thing, ...], count: int | None, used: int
) -> PlaceMeaning:
    """Return trees around the robot, as many as there are captures."""
    number = count or (setting.either("how many trees?", used, (2, 3, 4)) if _are_plural(things) else 1)
    selector: s.Selector = replace(cast(Any, place.selector), count=number)
    return PlaceMeaning(selector, "one" if number == 1 else "several", count=number)


def _of_rows(
    setting: Setting,
    place: PlaceMeaning,
    rows: s.Selector,
    things: tuple[Thing, ...],
    count: int | None,
    relation: str,
    used: int,
) -> PlaceMeaning:
    """Return what is said of each of several rows."""
    if place.shape == "area" and all(bare_zone(part, setting.site) for part in rows.members):
        return of_each_row(setting, place, count or 1)
    if place.shape == "area" and count is None and not things[0].count and _are_plural(things):
        return PlaceMeaning(rows, "several")
    if place.shape == "area" and relation in _OPEN and setting.either("every tree, or how many?", used, (True, False)):
        return PlaceMeaning(rows, "several")
    return of_each_row(setting, place, count or 1)


def of_each_row(setting: Setting, place: PlaceMeaning, count: int = 1) -> PlaceMeaning:
    """Return what is said of each of several rows, one row after the other; of an area so many trees of each.

    Raises:
        NotComposed: The rows cannot be named one by one.
    """
    rows = place.per or s.Rows()
    counted = are_rows(rows) or rows_kept(rows) is not None
    selector = s.Take(count=count, of=s.Trees()) if place.shape == "area" else place.selector
    zones = [bare_zone(part, setting.site) for part in rows.members]
    if all(zones) and place.shape == "area":
        points = tuple(s.PointsIn(zone=zone, count=count) for zone in zones)
        return PlaceMeaning(points[0] if len(points) == 1 else s.UnionOf(parts=points), "several")
    quota = _quota(setting, selector, rows, by_row=counted)
    if quota is not None:
        return PlaceMeaning(quota, "several")
    single = one_by_one(rows, setting.site) if counted else rows.members
    if not single or len(single) > MOST_ONE_BY_ONE:
        raise NotComposed(message("rows are visited one after the other here only if they are named", context="fault"))
    parts = tuple(over(selector, row) for row in single)
    return PlaceMeaning(parts[0] if len(parts) == 1 else s.UnionOf(parts=parts), "several")


def _quota(setting: Setting, selector: s.Selector, rows: s.Selector, *, by_row: bool) -> s.Quota | None:
    """Return so many trees of each row or block, spread over them; None for trees that are chosen otherwise."""
    if by_row:
        return of_each(selector, "row", rows)
    return of_each_block(selector, rows.members, setting.site)


def _is_spot(area: s.Selector, site: Site) -> bool:
    """Return True for a zone so small that there is one place to be at: a trough, a mast."""
    name = bare_zone(area, site)
    return bool(name) and 0.0 < sum(one.polygon.area for one in site.zones if one.name == name) <= _LARGEST_SPOT_M2


def _of_area(
    setting: Setting, place: PlaceMeaning, things: tuple[Thing, ...], count: int | None, relation: str, used: int
) -> PlaceMeaning:
    """Return the trees of an area: all of them, or as many as there are captures; of bare ground so many points."""
    each = [bare_points(part, setting.site, 1) for part in place.selector.members]
    spots = all(_is_spot(part, setting.site) for part in place.selector.members)  # "at the trough and the tap"
    one_each = count is None and (spots or not _are_plural(things))
    if len(each) > 1 and None not in each and count != 1 and not one_each and not (spots and count == len(each)):
        raise OpenQuestion(message("'{said}': at how many places?", context="question", said=setting.quoted(used)))
    if len(each) > 1 and None not in each:
        return PlaceMeaning(s.UnionOf(parts=tuple(one for one in each if one is not None)), "several", count=len(each))
    if (points := bare_points(place.selector, setting.site, count or 1)) is not None:
        if count is None and not one_each:
            raise OpenQuestion(message("'{said}': at how many places?", context="question", said=setting.quoted(used)))
        return PlaceMeaning(points, "several" if (count or 1) > 1 else "one", count=count)
    named = [as_zone(part) for part in place.selector.members]
    zones = [one.zone for one in named if one is not None and one == s.InZone(zone=one.zone)]
    if len(named) == len(zones) > 1 and count in (None, 1, len(zones)) and not _are_plural(things):
        points_of_each = s.UnionOf(parts=tuple(s.PointsIn(zone=zone) for zone in zones))  # "at the trough and the tap"
        return PlaceMeaning(points_of_each, "several", each=True, count=len(zones))
    if count is None and _are_plural(things):
        return replace(place, shape="several")
    if relation in _OPEN and count in (None, 1) and setting.either("every tree, or how many?", used, (True, False)):
        return replace(place, shape="several")
    if count in (None, 1) and are_several_rows(place.selector):
        return _one_in_each_or_in_all(setting, place.selector, used)
    number = count or 1
    return PlaceMeaning(s.Take(count=number, of=place.selector), "one" if number == 1 else "several", count=number)
