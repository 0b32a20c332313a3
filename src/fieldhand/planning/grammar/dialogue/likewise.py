"""Places that are named by others before them: the opposite side, another one of its kind, the best of those ranked."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.plans import block_at, is_inside, node_at
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, Setting
from fieldhand.planning.grammar.meaning import (
    Again,
    CaptureCommand,
    Command,
    DriveCommand,
    Lead,
    Likewise,
    PlaceMeaning,
)
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.places.exceptions import drawn_from
from fieldhand.planning.grammar.places.groups import kind_in_area
from fieldhand.planning.grammar.places.likewise import of_other_value
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.sampling import bare_points
from fieldhand.planning.selections import (
    AREAS,
    anchors,
    are_rows,
    as_excluding,
    as_in_row,
    as_ordered,
    as_some,
    as_top,
    as_where,
    as_zone,
    chosen_from,
    counts_in_row,
    is_block,
    is_by_attribute,
    is_end_of_site,
    is_one_row,
    named_places,
    over,
    picked_from,
    side_named,
    swapped,
)
from fieldhand.task import plan as p
from fieldhand.terms import Side

_OPPOSITE = {"n": "s", "s": "n", "e": "w", "w": "e", "north": "south", "south": "north", "east": "west", "west": "east"}
#: Commands with a place.
_WithPlace = CaptureCommand | DriveCommand | Lead | Again


def with_known_place(setting: Setting, state: DialogueState, command: Command) -> Command:
    """Return a command with a place that no longer depends on what was named before.

    Raises:
        NotComposed: What it refers to is unclear.
    """
    if not isinstance(command, _WithPlace) or command.place is None:
        return command
    place = command.place
    if place.shape == "those":
        place = _those_named(setting, state, place, command.used)
    place = _end_of_row_spoken_of(state, _in_row_spoken_of(state, place))
    place = _middle_of_those(setting, state, place)
    place = _beside_unreached(state, place)
    command = replace(command, place=place)
    if place.beside:
        near = _beside(setting, state, place, command.used)
        return replace(command, place=replace(near, selector=_of_kind_before(state, near), like=None))
    if place.like is not None and place.like.kind == "those" and not isinstance(place.selector, AREAS):
        return replace(command, place=replace(place, selector=_some_of_those(setting, state, place), like=None))
    if isinstance(place.selector, s.Top) and place.like is not None:
        return _best_of_ranked(state, command, place.selector)
    if place.like is not None and place.like.kind == "those":
        before = state.where
        kind = before.selector if before is not None and before.shape == "several" else s.Trees()
        return replace(command, place=replace(place, selector=kind_in_area(kind, place.selector), like=None))
    if place.like is not None and place.like.kind == "extreme":
        return replace(command, place=_extreme(state, replace(place, like=None), place.like.side))
    if place.like is not None and place.like.kind == "rest":
        return replace(command, place=replace(place, selector=_rest(state, place.selector), like=None))
    if place.like is not None and place.like.kind == "nth":
        one = _nth(state, place.like) if place.like.number else _described(state, place.selector)
        return replace(command, place=replace(place, selector=one, like=None))
    if place.like is not None and place.like.kind == "value":
        other = _of_another_value(setting, state, place)
        return replace(command, place=replace(place, selector=other, like=None))
    return command if place.like is None else replace(command, place=_likewise(state, place, place.like))


def _those_named(setting: Setting, state: DialogueState, place: PlaceMeaning, used: int) -> PlaceMeaning:
    """Return "those five leeks" as the places that were named last, if they are five, and leeks.

    Raises:
        NotComposed: They are others.
    """
    before = state.where if state.where is not None else None if state.area is None else state.area.place
    numbered, described = place.each and place.count is not None, place.selector not in (s.Here(), s.Trees())
    if before is None or not (numbered or described):
        return place
    known = len(single_places(state)) if before.shape == "one" else before.count
    if known is None and (found := ids_of(before.selector, setting.site)) is not None:
        known = len(found)
    if (described and place.selector not in before.selector.walk()) or (numbered and known not in (None, place.count)):
        said = setting.quoted(place.tokens or used)
        raise NotComposed(message("'{said}': no such ones were named before", context="fault", said=said))
    return replace(place, selector=s.Trees() if described else place.selector, count=None if numbered else place.count)


def _some_of_those(setting: Setting, state: DialogueState, place: PlaceMeaning) -> s.Selector:
    """Return "those with mildew" and "every third one" as those of the places named last; of all where none were named.

    Raises:
        NotComposed: None of the places named last are so, or which these are is known only during the mission.
    """
    before = state.where
    if state.lead is not None and state.lead.relation == "":
        raise NotComposed(message("it is not clear which trees are meant", context="fault"))
    if state.lead is not None or state.area is not None:
        return place.selector
    group = None if before is None or before.selector == s.Trees() else before.selector
    if group is not None and before is not None and before.shape == "one":
        group = picked_from(group)  # "the tomato nearest the barn and ... the one farthest from it"
    if group is None or group == s.Trees():
        return place.selector
    there = next((part for part in place.selector.walk() if isinstance(part, AREAS)), None)
    if there is not None:  # "the tomatoes in bed 7, then the ones in bed 8 over a metre tall"
        return swapped(place.selector, there, kind_in_area(group, there))
    if group.relative or drawn_from(group) is not None:
        raise NotComposed(message("it is not clear which trees are meant", context="fault"))
    left = as_excluding(group)
    for one in (group, *(() if left is None else (left.of,))):  # "all courgettes but those with mildew, ... these"
        some = over(place.selector, one)
        if ids_of(some, setting.site):
            return some
    said = setting.quoted(place.tokens)
    raise NotComposed(message("'{said}': no such ones were named before", context="fault", said=said))


def _of_kind_before(state: DialogueState, place: PlaceMeaning) -> s.Selector:
    """Return "the one farthest from it" behind "the tomato nearest the barn" as a tomato."""
    before = state.where
    kind = None if before is None or before.shape != "one" else picked_from(before.selector)
    is_pronoun = place.like is not None and place.like.kind == "those"
    return over(place.selector, kind) if is_pronoun and kind is not None else place.selector


def _extreme(state: DialogueState, place: PlaceMeaning, side: str) -> PlaceMeaning:
    """Return "the easternmost" behind a row as the row that is farthest to the east, and as a tree behind others."""
    before = state.where
    if before is None or before.shape == "one" or not are_rows(before.selector):
        return place
    outermost = s.Rows(first="1", last="1", counted_from=cast(Side, side))
    block = next((part for part in before.selector.walk() if is_block(part)), None)
    return replace(place, selector=outermost if block is None else over(outermost, block), shape="area")


def _beside_unreached(state: DialogueState, place: PlaceMeaning) -> PlaceMeaning:
    """Return a place near one that could not be reached as measured from that one, where the robot is not."""
    if not state.scope or state.scope[-1] != "otherwise" or s.Here() not in place.selector.walk():
        return place
    tried = node_at(state.plan, state.scope[:-1])
    if not tried.caught or block_at(state.plan, state.scope).steps:
        return place
    named = [node.selector for node in p.walk(tried) if node.selector is not None and not node.selector.relative]
    if len(named) != 1 or not named[0].single:
        return place
    return replace(place, beside=False, selector=swapped(place.selector, s.Here(), named[0]))


def _in_row_spoken_of(state: DialogueState, place: PlaceMeaning) -> PlaceMeaning:
    """Return a place in "that row" as one in the only row of the trees named last, if several were named."""
    before = state.where
    if s.RowOf() not in place.selector.walk() or before is None or before.shape != "several" or state.area is not None:
        return place
    if state.loop is not None and is_inside(state.scope, state.loop):
        return place  # the row of the tree that is visited
    rows = {part for part in before.selector.walk() if are_rows(part)}
    if len(rows) != 1 or before.selector.relative or not is_one_row(next(iter(rows))):
        return place
    return replace(place, selector=swapped(place.selector, s.RowOf(), rows.pop()))


def _end_of_row_spoken_of(state: DialogueState, place: PlaceMeaning) -> PlaceMeaning:
    """Return "the first tree" and "the last tree" behind the trees of one row as the ends of that row.

    Raises:
        NotComposed: The trees before were those of several rows, or an order of visits was given.
    """
    before = state.where
    if not is_end_of_site(place.selector) or before is None or before.shape != "several" or state.area is not None:
        return place
    rows = {part for part in before.selector.walk() if are_rows(part)}
    if not rows:
        return place
    last = place.selector == s.Last()
    row = rows.pop()
    if rows or not is_one_row(row):
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    ordered = next((one for part in before.selector.walk() if (one := as_ordered(part)) is not None), None)
    if ordered is None:
        return replace(place, selector=s.InRow(first=-1 if last else 1, last=-1 if last else 1, of=row))
    side = ordered.by.partition("_to_")[2 if last else 0]
    if side not in SIDES:
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    return replace(place, selector=s.Extreme(side=side, of=row))


def _middle_of_those(setting: Setting, state: DialogueState, place: PlaceMeaning) -> PlaceMeaning:
    """Return "the middle" behind places of one row or zone as its middle, and of the site behind others."""
    before = state.where
    if place.selector != s.Middle() or place.itself or before is None or before.selector.relative:
        return place
    if state.lead is not None or state.area is not None:
        return place
    rows = {part for part in before.selector.walk() if are_rows(part)}
    zones = {zone for part in before.selector.walk() if (zone := str(getattr(part, "zone", "")))}
    if not rows and len(zones) == 1:
        ground = s.InZone(zone=zones.pop())
        return replace(place, selector=bare_points(ground, setting.site, 1) or s.Middle(of=ground))
    if not rows and not zones:
        return place
    row = rows.pop() if rows else None
    if rows or zones or row is None or not is_one_row(row):
        return place
    return replace(place, selector=s.Middle(of=row))


def _of_another_value(setting: Setting, state: DialogueState, place: PlaceMeaning) -> s.Selector:
    """Return the trees named last with another value of their attribute ("the green ones" behind "the yellow trees").

    Of others it is those that have it: "the grafted ones" behind "the tomatoes".

    Raises:
        NotComposed: None of them have it.
    """
    if state.where is None and state.lead is None and state.area is None:
        return place.selector  # "check the covered ones", before which none were named
    before = None if state.where is None or state.where.selector.relative else state.where.selector
    other = None if before is None else of_other_value(before, place.selector)
    described = as_where(place.selector)
    if other is None and (before is None or described is None or not isinstance(described.value, bool)):
        raise NotComposed(message("it is not clear which trees are meant", context="fault"))
    return other or _some_of_those(setting, state, place)


def _beside(setting: Setting, state: DialogueState, place: PlaceMeaning, used: int) -> PlaceMeaning:
    """Return a place near the one spoken of last: the tree, or what that tree was said to be near to.

    Raises:
        NotComposed: None was spoken of, or several.
    """
    before = state.where if state.lead is None else state.lead.place
    if before is None and state.area is not None:
        before = state.area.place
    from_here = before is not None and s.Here() in anchors(before.selector)
    if from_here and before is not None and place.selector != before.selector:
        return replace(place, beside=False, selector=swapped(place.selector, s.Here(), _last_known(state)))
    if before is not None and before.shape == "area" and as_zone(before.selector) is not None and state.awaits_command:
        return replace(place, beside=False, selector=swapped(place.selector, s.Here(), before.selector))
    in_loop = state.loop is not None and is_inside(state.scope, state.loop)
    if before is None or (before.shape != "one" and not in_loop):
        raise NotComposed(message("which place is meant?", context="fault"))
    known = replace(place, beside=False)
    named = [to for to in anchors(before.selector) if to.named_marker or as_zone(to) is not None]
    ways = [known, *(replace(known, selector=swapped(place.selector, s.Here(), to)) for to in named)]
    return setting.either("near the tree, or near what was named?", used, ways)


def _last_known(state: DialogueState) -> s.Selector:
    """Return the place that was named last by itself: "at tree 50, at the tree north of it and at the one south of it".

    Raises:
        NotComposed: There is none, or there were several.
    """
    named = [node.selector for node in p.walk(state.plan) if node.selector is not None and not node.selector.relative]
    if not named or not named[-1].single:
        raise NotComposed(message("which place is meant?", context="fault"))
    return named[-1]


def _rest(state: DialogueState, area: s.Selector) -> s.Selector:
    """Return the other trees of an area, or of the group, of which some were named last.

    Raises:
        NotComposed: The group is unclear.
    """
    where = state.where
    if where is not None and where.shape == "one" and not where.selector.relative and area != s.Trees():
        return s.Excluding(places=where.selector, of=area)  # "tree 1 ..., all the other trees of row 1"
    last = None if where is None or where.shape != "several" else where.selector
    if last is not None and area != s.Trees() and not last.relative and chosen_from(last, area):
        return s.Excluding(places=last, of=area)  # "six basil plants along the bed ..., the rest of the basil"
    of_all = state.decided is not None and state.decided.of_series
    if any(node.tested is not None for node in p.walk(state.plan)) and not of_all:
        last = None  # "those above 35 degrees ..., the others ...": those that did not pass
    group = getattr(last, "of", None) if area == s.Trees() else area
    drawn = last is not None and any(hasattr(part, "seed") for part in last.walk())  # again, it draws others
    if last is None or group is None or last.relative or is_by_attribute(group) or as_some(last) is not None or drawn:
        raise NotComposed(message("it is not clear which others are meant", context="fault"))
    return s.Excluding(places=last, of=group)


def _nth(state: DialogueState, like: Likewise) -> s.Selector:
    """Return one of the places that were named last.

    Raises:
        NotComposed: There are fewer, or they were not named one by one.
    """
    number = like.number
    before = state.where if state.where is not None or state.area is None else state.area.place
    last = None if before is None else before.selector
    counted = None if last is None else as_in_row(last)
    if counted is not None and counted.first == counted.last and is_one_row(counted.of):
        return replace(counted, first=number, last=number)  # "at the first tree of row 4, then at the last one"
    if counted is not None and 0 < counted.first < counted.last and is_one_row(counted.of):
        which = counted.last if number == -1 else counted.first + number - 1
        if which <= counted.last:
            return replace(counted, first=which, last=which)  # "trees 5 to 8 of row 9, then the last of them"
    named = () if last is None else named_places(last)
    known = len(named) if before is None or before.count is None else before.count
    if like.of_number and known != like.of_number:
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    visited = state.loop is not None and not is_inside(state.scope, state.loop)
    if number == -1 and visited and len(named) < 2 and last is not None and not counts_in_row(last):
        return s.Here()  # the last of those that were visited
    if not 1 < len(named) >= number or not all(place.single and not place.relative for place in named):
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    return named[number - 1 if number > 0 else -1]


def _described(state: DialogueState, mark: s.Selector) -> s.Selector:
    """Return the only one of the single places named before that is described by a zone ("the pond one").

    Raises:
        NotComposed: None or several of them are.
    """
    found = [place for place in single_places(state) if mark in place.walk()]
    if len(found) != 1:
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    return found[0]


def _best_of_them(where: PlaceMeaning | None, best: s.Top) -> s.Selector:
    """Return the best of the places of the step before ("the tallest of them")."""
    group = None if where is None or where.per is not None or where.optional else where.selector
    drawn = group is not None and any(hasattr(part, "count") for part in group.walk())
    if group is None or drawn or group.relative or not (is_by_attribute(group) or are_rows(group)):
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    return replace(best, of=group)


def _best_of_ranked(state: DialogueState, command: _WithPlace, best: s.Top) -> Command:
    """Return a command at the best of the trees that were ranked."""
    ranking = state.ranking
    last = None if ranking is not None or state.where is None else state.where.selector
    where = state.where
    if command.place is not None and command.place.like is not None and command.place.like.holds:
        return replace(command, place=replace(command.place, selector=_best_of_them(where, best), like=None))
    if best.attribute and best.count == 1 and best.of == s.Trees() and ranking is None and where is not None:
        group = where.selector  # "photograph the beans, then take a leaf of the tallest one"
        of_those = where.shape == "several" and where.per is None and not group.relative and is_by_attribute(group)
        if of_those and as_top(group) is None and command.place is not None:
            return replace(command, place=replace(command.place, selector=replace(best, of=group), like=None))
    of_area = best.attribute and isinstance(last, s.Top) and not is_by_attribute(last.of)
    if of_area and best.count == 1 and command.place is not None and ranking is None:
        return replace(command, place=replace(command.place, like=None))  # "in the northern half, ... the youngest"
    if isinstance(last, s.Top) and best.attribute in ("", last.attribute) and best.lowest != last.lowest:
        # "the ten weakest vines, then the ten strongest"
        best = replace(best, attribute=last.attribute, of=last.of)
        return (
            command
            if command.place is None
            else replace(command, place=replace(command.place, selector=best, like=None))
        )
    if ranking is None and best.attribute and command.place is not None:
        return replace(command, place=replace(command.place, like=None))  # "the oldest five", of all trees
    if ranking is None or best.attribute not in ("", ranking.attribute) or command.place is None:
        raise NotComposed(message("it is not clear by what they are ranked", context="fault"))
    best = replace(best, attribute=ranking.attribute, of=ranking.trees.selector)
    place = replace(command.place, selector=best, like=None)
    return replace(command, place=place, used=command.used | ranking.used)


def _likewise(state: DialogueState, place: PlaceMeaning, like: Likewise) -> PlaceMeaning:
    """Return a place on a side that is named by the last one."""
    last = _last_side(state)
    if last is None:
        if like.kind or like.holds or place.shape != "one" or like.side not in SIDES:
            raise NotComposed(message("it is not clear which one is meant", context="fault"))
        return replace(place, selector=_of_those(state, like.side), like=None)
    kind, side = last
    if not like.kind and kind != "corner" and len(single_places(state)) > 1:
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    if like.kind not in ("", kind):
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    side = like.side or _opposite(side)
    if (side in SIDES) != (kind == "half") or (kind == "corner") != (place.shape == "one" and not like.holds):
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    named: Any = side
    area: s.Selector = s.Half(side=named)
    if side in CORNERS:
        area = s.Corners(which=(named,)) if kind == "corner" else s.Quarter(quarter=named)
    return replace(place, selector=over(place.selector, area) if like.holds else area, like=None)


def _last_side(state: DialogueState) -> tuple[str, str] | None:
    """Return the kind and the name of the half, quarter or corner that was named last."""
    for node in reversed(list(p.walk(state.plan))):
        place = node.selector
        if place is not None and place.single and as_some(place) is None and side_named(place) is None:
            return None  # "the northernmost tree of the eastern half, then the southern one"
        for part in () if place is None else place.walk():
            if (named := side_named(part)) is not None:
                return named
    return None


def _opposite(side: str) -> str:
    """Return the opposite side, or the diagonally opposite corner."""
    return _OPPOSITE[side] if side in _OPPOSITE else "".join(_OPPOSITE[one] for one in side)


def _of_those(state: DialogueState, side: str) -> s.Selector:
    """Return the place farthest to a side, of the single places that were named before."""
    places = single_places(state)
    if len(places) < 2:
        raise NotComposed(message("it is not clear which one is meant", context="fault"))
    return s.Extreme(side=cast(Any, side), of=s.UnionOf(parts=places))


def single_places(state: DialogueState) -> tuple[s.Selector, ...]:
    """Return the single places that were named before, if there were no others."""
    named = [step.selector for step in state.plan.steps if step.selector is not None]
    places = [place for selector in named for place in named_places(selector) or (selector,)]
    if not all(place.single and not place.relative for place in places):
        return ()
    return tuple(dict.fromkeys(places))
