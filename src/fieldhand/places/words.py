"""Selectors in words that a grower would sign: the one wording of places, for messages, read-back and the map.

A selector is said from the inside out. What only keeps trees (an attribute, a zone, a half of the site, a row) gathers
around one noun: "the yellow trees of row 3 in the northern half". What picks (the northernmost, the 3 nearest) closes
the phrase: "the 3 northernmost of the yellow trees"; whatever keeps among those then starts a new one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from typing import assert_never

from fieldhand.language import joined, message
from fieldhand.language.words import CORNERS, SIDES, listed, say_gate, say_marker, say_number, say_tree, say_zone
from fieldhand.places import selectors as s
from fieldhand.places.attribute_words import say_whose
from fieldhand.places.nesting import bare_ground
from fieldhand.places.noun import Phrase
from fieldhand.places.pick_words import foremost, nth, picked, superlative
from fieldhand.places.row_phrases import adjacent, apart, by_number, free_points, from_hand, successive
from fieldhand.places.row_words import say_order, say_row_of, say_rows
from fieldhand.places.saying import Names, Saying, it, many, of_ground, one, origin
from fieldhand.site.counting import say_block

#: Attributes whose values people use as adjectives: "yellow trees", "Kerman trees".
_ADJECTIVAL = re.compile(r"(^|_)(colou?r|variety|cultivar|species|health|status|condition|kind)$")


def say_selector(selector: s.Selector, names: Names | None = None, count: int | None = None) -> str:
    """A selector in words.

    Args:
        selector: What to say.
        names: What a label is called ("the tree of step 3"); else it is quoted.
        count: How many places it gives, said where the phrase does not say it itself.
    """
    return Saying(names or {}, _new_phrase).phrase(selector).say(count)


def say_selectors(selectors: Iterable[s.Selector]) -> tuple[str, ...]:
    """Several selectors in words, as :func:`say_selector` says each; what they have in common is phrased once."""
    saying = Saying({}, _new_phrase)
    return tuple(saying.phrase(selector).say() for selector in selectors)


def _new_phrase(selector: s.Selector, saying: Saying) -> Phrase:
    match selector:
        case s.Trees():
            return Phrase()
        case s.TreeIs(tree=tree):
            return one(say_tree(tree))
        case s.Marker(name=name):
            return one(say_marker(name))
        case s.GateIs(gate=name):
            return one(say_gate(name))
        case s.Here():
            return one(message("the place reached before"))
        case s.Bound(label=label):
            return one(saying.names.get(label) or message("the place called “{label}”", label=label))
        case s.First(of=of):
            group = saying.phrase(of)
            whole = message("the first tree"), message("the first of {trees}", trees=group.group())
            return one(whole[0] if group.plain else whole[1])
        case s.Last(of=of):
            group = saying.phrase(of)
            whole = message("the last tree"), message("the last of {trees}", trees=group.group())
            return one(whole[0] if group.plain else whole[1])
        case s.Extreme(side=side, count=count, of=of):
            return foremost(f"{side}ernmost", count, saying.phrase(of))
        case s.AmongExtreme(side=side, of=of):
            group, which = saying.phrase(of), superlative(f"{side}ernmost", 2)
            if group.plain:
                return many(message("the {northernmost} trees", northernmost=which))
            return many(message("the {northernmost} of {trees}", northernmost=which, trees=group.group()))
        case s.Corners():
            return _corners(selector, saying)
        case s.Half() | s.Quarter() | s.Edge():
            return _area(selector, saying)
        case s.Where() | s.InZone() | s.Within() | s.Other() | s.Excluding():
            return _filtered(selector, saying)
        case s.Middle() | s.EdgeMiddle() | s.Nearest() | s.Farthest() | s.Top():
            return picked(selector, saying)
        case s.Adjacent():
            return adjacent(selector, saying)
        case s.Take():
            return _taken(selector, saying)
        case s.Random():
            return _drawn(selector, saying)
        case s.Spread():
            return _spread(selector, saying)
        case s.InBlock(block=block, of=of):
            return saying.phrase(of).of_block(say_block(block))
        case s.Rows(of=of):
            rows, single = say_rows(selector)
            return saying.phrase(of).of_rows(rows, one=single)
        case s.RowOf(over=over, of=of):
            start = "" if isinstance(selector.origin, s.Here) else it(selector.origin, saying)
            return saying.phrase(of).of_rows(say_row_of(over, start), one=True)
        case s.InRow() | s.EveryNth():
            return by_number(selector, saying)
        case s.AlongRow() | s.Across():
            return from_hand(selector, saying)
        case s.Successive():
            return successive(selector, saying)
        case s.Ordered(of=of):
            return replace(saying.phrase(of), order=say_order(selector))
        case s.Nth():
            return nth(selector, saying)
        case s.Apart():
            return apart(selector, saying)
        case s.Spaced() | s.PointsIn():
            return free_points(selector, saying)
        case s.Union(parts=parts):
            return _together(parts, saying)
        case _:
            assert_never(selector)


def _corners(selector: s.Corners, saying: Saying) -> Phrase:
    group = saying.phrase(selector.of)
    of = "" if group.plain else message("of {trees}", trees=group.group())
    which = selector.which
    if len(which) == 1:
        return one(message("the {north_west} corner tree {of_trees}", north_west=CORNERS[which[0]], of_trees=of))
    if not which or set(which) == set(CORNERS):
        return many(message("the 4 corner trees {of_trees}", of_trees=of))
    named_corners = listed([CORNERS[w] for w in which])
    return many(message("the {north_west} corner trees {of_trees}", north_west=named_corners, of_trees=of))


def _area(selector: s.Half | s.Quarter | s.Edge, saying: Saying) -> Phrase:
    """A region of the site, whichever way it is nested with what else keeps trees."""
    of = of_ground(selector.of, saying)
    match selector:
        case s.Half(side=side):
            area = message("in the {northern} half {of_trees}", northern=SIDES[side], of_trees=of)
        case s.Quarter(quarter=quarter):
            area = message("in the {north_west} quarter {of_trees}", north_west=CORNERS[quarter], of_trees=of)
        case s.Edge(side=side):
            area = message("along the {northern} edge {of_trees}", northern=SIDES[side], of_trees=of)
    if bare_ground(selector.of) == selector.of:
        return Phrase(after=(area,))
    return saying.phrase(selector.of).keeping(after=area)


def _filtered(selector: s.Where | s.InZone | s.Within | s.Other | s.Excluding, saying: Saying) -> Phrase:
    base = saying.phrase(selector.of)
    match selector:
        case s.Where():
            if isinstance(selector.value, str) and selector.test == "eq" and _ADJECTIVAL.search(selector.attribute):
                return base.keeping(before=selector.value)
            return base.keeping(after=say_whose(selector.attribute, selector.test, selector.value))
        case s.InZone(zone=zone, outside=outside, margin_m=margin) if margin:
            near = {"distance": say_number(margin), "place": say_zone(zone)}
            if outside:
                return base.keeping(after=message("more than {distance} m from {place}", **near))
            return base.keeping(after=message("within {distance} m of {place}", **near))
        case s.InZone(zone=zone, outside=outside):
            if outside:
                return base.keeping(after=message("outside {zone}", zone=say_zone(zone)))
            return base.keeping(after=message("inside {zone}", zone=say_zone(zone)))
        case s.Within(distance_m=distance, to=to):
            return base.keeping(
                after=message("within {distance} m of {place}", distance=say_number(distance), place=origin(to, saying))
            )
        case s.Other():
            return base.keeping(after=message("not visited yet"))
        case s.Excluding(places=places):
            return base.keeping(after=message("other than {place}", place=it(places, saying)))


def _taken(selector: s.Take, saying: Saying) -> Phrase:
    inner = saying.phrase(selector.of)
    if selector.count == 1:
        if selector.of == s.Other():
            return one(message("another tree, the nearest one not visited yet"))
        return inner if inner.single else one(message("the nearest of {trees}", trees=inner.group()))
    return many(message("the {count} nearest of {trees}", count=selector.count, trees=inner.group()))


def _drawn(selector: s.Random, saying: Saying) -> Phrase:
    group, seed = saying.phrase(selector.of).group(), selector.seed
    if selector.count == 1:
        return one(message("one of {trees}, drawn at random (seed {seed})", trees=group, seed=seed))
    said = message("{count} of {trees}, drawn at random (seed {seed})", count=selector.count, trees=group, seed=seed)
    return many(said)


def _spread(selector: s.Spread, saying: Saying) -> Phrase:
    group = saying.phrase(selector.of).group()
    if selector.count == 1:
        return one(message("of {trees} the one nearest to their middle", trees=group))
    return many(message("{count} of {trees}, spread far from each other", count=selector.count, trees=group))


def _together(parts: tuple[s.Selector, ...], saying: Saying) -> Phrase:
    trees = [part.tree for part in parts if isinstance(part, s.TreeIs)]
    if len(parts) == 1:
        return saying.phrase(parts[0])
    if trees and len(trees) == len(parts):
        return many(message("trees {ids}", ids=listed(trees)))
    return many(listed([saying.phrase(part).say() for part in parts]) or message("no place at all"))


def say_places(ids: tuple[str, ...], few: int = 8) -> str:
    """Places by id: all of them when few, else the first ones and how many more."""
    if len(ids) <= few:
        return listed(ids)
    return message("{places} and {count} more", places=joined(", ", ids[:few]), count=len(ids) - few)
