"""Parts of an area that are named without it: "at the corners of the patch and in the middle", "the south half"."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, TypeVar, cast

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.state import DialogueState, Setting
from fieldhand.planning.grammar.meaning import PlaceMeaning, WorkCommand
from fieldhand.planning.grammar.places.sampling import bare_zone, is_keep_out
from fieldhand.planning.grammar.places.zone_parts import part_of_ground, part_within, side_named
from fieldhand.planning.selections import AREAS, are_rows, as_corners, as_in_row, as_zone, is_one_row
from fieldhand.task import plan as p

T = TypeVar("T")


def with_its_parts(setting: Setting, state: DialogueState, command: T, *, same_sentence: bool) -> T:
    """Return a command at "the middle", "the corners" or "the south half" as those of the area of the last places.

    Where the whole site may be meant as well, it is asked: in a new sentence, and behind trees of an area.

    Args:
        setting: Robot and site.
        state: State before the command.
        command: Command.
        same_sentence: True if it stands in the sentence of the last one.
    """
    one: Any = command
    place = getattr(one, "place", None)
    pending = state.lead or state.area or getattr(one, "within", None) or state.each_of
    changed: Any = command
    if isinstance(place, PlaceMeaning) and place.per is None:
        meant = _meant(setting, state, place, one.used, same_sentence=same_sentence, free=pending is None)
        changed = command if meant == place else replace(one, place=meant)
    elif isinstance(one, WorkCommand) and one.along is not None and pending is None:
        ground = PlaceMeaning(one.along, "area")
        meant = _meant(setting, state, ground, one.used, same_sentence=same_sentence, free=True)
        if getattr(meant.selector, "shape", "") == "edge":  # "film the north side of the pond, then the east side"
            edge: Any = meant.selector
            changed = replace(one, along=s.InZone(zone=edge.zone), mode="perimeter", sides=edge.part)
        elif meant != ground:
            changed = replace(one, along=meant.selector)
    return cast(T, changed)


def _meant(
    setting: Setting, state: DialogueState, place: PlaceMeaning, used: int, *, same_sentence: bool, free: bool
) -> PlaceMeaning:
    """Return a place, its part as that of the area in which the last places are.

    Args:
        setting, state: Robot and site; state before the command.
        place: Place.
        used: Tokens of the command.
        same_sentence: True if it stands in the sentence of the last one.
        free: False if an area before it says where it is.
    """
    if setting.names("site", place.tokens or used):
        return place
    tree = setting.names("TREE", place.tokens or used) or setting.names("ONE", place.tokens or used)
    place = replace(place, selector=_of_earlier_member(setting, place.selector, tree=tree))
    part = part_within(place.selector)
    if part is None or not free:
        return place
    if state.within is not None:
        there = part_of_ground(place.selector, part, state.within, setting.site)
        known = there is not None and bare_zone(state.within, setting.site)
        return replace(place, selector=there) if known and there is not None else place
    last = _last_places(state)
    grounds = {*_grounds(last)} if last is not None else set()
    if last is None or len(grounds) != 1:
        return place
    (ground,) = grounds
    of_site = any(side_named(area) and getattr(area, "of", s.Trees()) == s.Trees() for area in ground.members)
    if not all(isinstance(area, AREAS) for area in ground.members) or (side_named(part) and of_site):
        return place
    ways = _of_ground(setting, place, part, ground, tree)
    contrasts = side_named(part) and any(side_named(one) for one in last.walk())
    bare = bare_zone(ground, setting.site)
    if not ways or (side_named(part) and not contrasts and not bare):
        return place
    of_area = all(_is_part_of_area(member, setting) for member in last.members)
    sure = contrasts or (same_sentence and of_area and not side_named(part)) or (bare and as_in_row(part) is not None)
    return setting.either("of that area, or of the site?", used, ways if sure else [*ways, place])


def _of_earlier_member(setting: Setting, places: s.Selector, *, tree: bool) -> s.Selector:
    """Return places of which one is named as a part of one before it: "on the north side of the pond and the south"."""
    made: list[s.Selector] = []
    for one in places.members:
        part = part_within(one)
        grounds = {ground for known in made for ground in _grounds(known) if isinstance(ground, AREAS)}
        ground = next(iter(grounds)) if len(grounds) == 1 else None
        there = None
        if part is not None and ground is not None and (bare_zone(ground, setting.site) or not side_named(part)):
            there = part_of_ground(one, part, ground, setting.site, tree=tree)
        made.append(there or one)
    return s.UnionOf(parts=tuple(made)) if len(made) > 1 else places


def _is_part_of_area(places: s.Selector, setting: Setting) -> bool:
    """Return True for corners, an end, a middle or points of an area, and for ground where nothing grows itself."""
    if bare_zone(places, setting.site):
        return not is_keep_out(places, setting.site)
    ends = as_in_row(places)
    part = as_corners(places) is not None or places.central or (ends is not None and -1 in (ends.first, -ends.last))
    return part or (bool(getattr(places, "zone", "")) and as_zone(places) is None)


def _last_places(state: DialogueState) -> s.Selector | None:
    only_driven = [node for node in p.walk(state.plan) if node.work is not None and not node.work.action]
    nodes = [node for node in p.walk(state.plan) if node.selector is not None and node not in only_driven]
    return nodes[-1].selector if nodes else None


def _grounds(places: s.Selector) -> Iterator[s.Selector]:
    """Yield the areas in which places are; of a place of the whole site itself."""
    for one in places.members:
        zone = getattr(one, "zone", "")
        of = getattr(one, "of", s.Trees())
        if zone and as_zone(one) is None:
            yield s.InZone(zone=zone)
        elif side_named(one) and of != s.Trees():
            yield of
        elif isinstance(one, AREAS):
            yield one
        else:
            yield of if all(isinstance(area, AREAS) for area in of.members) and of != s.Rows() else one


def _of_ground(
    setting: Setting, place: PlaceMeaning, part: s.Selector, ground: s.Selector, tree: bool
) -> list[PlaceMeaning]:
    """Return a part of the site as that of an area: of each of several rows, or of all of them."""
    there = part_of_ground(place.selector, part, ground, setting.site, tree=tree)
    if there is None:
        return []
    whole = replace(place, selector=there)
    if place.shape == "area" and getattr(there, "shape", "") == "edge":
        whole = replace(whole, shape="one")  # "the east side" of the pond
    if are_rows(ground) and not is_one_row(ground) and not side_named(part):
        return [PlaceMeaning(place.selector, "several", each=True, per=ground, tokens=place.tokens), whole]
    return [whole]
