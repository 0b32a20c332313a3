"""Selectors as English that a grower would sign: the one wording of places, for messages, read-back and the map.

A selector is said from the inside out. What only keeps trees (an attribute, a zone, a half of the site, a row) gathers
around one noun: "the yellow trees of row 3 in the northern half". What picks (the northernmost, the 3 nearest) closes
the phrase: "the 3 northernmost of the yellow trees"; whatever keeps among those then starts a new one.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import assert_never

from fieldhand.site.places.attribute_words import say_attribute, say_test
from fieldhand.site.places.nesting import bare_ground
from fieldhand.site.places.noun import Phrase, clauses
from fieldhand.site.places.row_words import (
    say_block,
    say_every,
    say_numbers,
    say_order,
    say_ordinal,
    say_row_of,
    say_rows,
    say_way,
)
from fieldhand.task import selectors as s
from fieldhand.task.words import CORNERS, SIDES, listed, say_count, say_number

Names = Mapping[str, str]

#: Attributes whose values people use as adjectives: "yellow trees", "Kerman trees".
_ADJECTIVAL = re.compile(r"(^|_)(colou?r|variety|cultivar|species|health|status|condition|kind)$")


#: What the first is called in an order.
_FOREMOST: Mapping[s.Order, str] = {
    "west_to_east": "westernmost",
    "east_to_west": "easternmost",
    "north_to_south": "northernmost",
    "south_to_north": "southernmost",
    "nearest_first": "nearest",
    "farthest_first": "farthest",
}


def say_selector(selector: s.Selector, names: Names | None = None, count: int | None = None) -> str:
    """A selector in words.

    Args:
        selector: What to say.
        names: What a label is called ("the tree of step 3"); else it is quoted.
        count: How many places it gives, said where the phrase does not say it itself.
    """
    return _phrase(selector, Saying(names or {})).say(count)


class Saying:
    """What is being said: what labels are called, and the phrases so far, since a group is often said again."""

    def __init__(self, names: Names) -> None:
        self.names = names
        self.known: dict[str, Phrase] = {}


def _phrase(selector: s.Selector, saying: Saying) -> Phrase:
    key = repr(selector)
    if key not in saying.known:
        saying.known[key] = _new_phrase(selector, saying)
    return saying.known[key]


def _new_phrase(selector: s.Selector, saying: Saying) -> Phrase:
    match selector:
        case s.Trees():
            return Phrase()
        case s.TreeIs(tree=tree):
            return _one(f"tree {tree}")
        case s.Marker(name=name):
            return _one("the charger" if name == "charger" else f"the {name} marker")
        case s.Here():
            return _one("the place reached before")
        case s.Bound(label=label):
            return _one(saying.names.get(label, f"the place called “{label}”"))
        case s.First() | s.Last():
            return _ranked("first" if isinstance(selector, s.First) else "last", 1, selector.of, saying)
        case s.Extreme():
            return _ranked(f"{selector.side}ernmost", selector.count, selector.of, saying)
        case s.AmongExtreme(side=side, of=of):
            group = _phrase(of, saying)
            return _many(f"the {side}ernmost {'trees' if group.plain else f'of {group.group()}'}")
        case s.Corners():
            return _corners(selector, saying)
        case s.Half() | s.Quarter() | s.Edge():
            return _area(selector, saying)
        case s.Where() | s.InZone() | s.Within() | s.Other() | s.Excluding():
            return _filtered(selector, saying)
        case s.Middle() | s.EdgeMiddle() | s.Nearest() | s.Farthest() | s.Top():
            return _picked(selector, saying)
        case s.Adjacent():
            return _adjacent(selector, saying)
        case s.Take():
            return _taken(selector, saying)
        case s.InBlock(block=block, of=of):
            return _phrase(of, saying).of_block(say_block(block))
        case s.Rows(of=of):
            said, one = say_rows(selector)
            return _phrase(of, saying).of_rows(said, one=one)
        case s.RowOf(origin=origin, over=over, of=of):
            from_here = isinstance(origin, s.Here)
            return _phrase(of, saying).of_rows(say_row_of(over, "" if from_here else _it(origin, saying)), one=True)
        case s.InRow() | s.EveryNth():
            return _counted(selector, saying)
        case s.AlongRow() | s.Across():
            return _from_hand(selector, saying)
        case s.Successive():
            return _successive(selector, saying)
        case s.Ordered(of=of):
            return replace(_phrase(of, saying), order=say_order(selector))
        case s.Nth():
            return _nth(selector, saying)
        case s.Apart():
            return _apart(selector, saying)
        case s.Spaced() | s.PointsIn():
            return _free_points(selector, saying)
        case s.Union(parts=parts):
            return _together(parts, saying)
        case _:
            assert_never(selector)


def _one(text: str) -> Phrase:
    return Phrase(closed=text, single=True)


def _many(text: str) -> Phrase:
    return Phrase(closed=text)


def _spot(selector: s.Selector, saying: Saying) -> str:
    """A place that something is measured from."""
    return "there" if isinstance(selector, s.Here) else _phrase(selector, saying).say()


def _it(selector: s.Selector, saying: Saying) -> str:
    """A place where "there" would be no English ("next to there")."""
    return "that place" if isinstance(selector, s.Here) else _phrase(selector, saying).say()


def _ranked(rank: str, count: int, of: s.Selector, saying: Saying) -> Phrase:
    """The first, the northernmost: an adjective that picks."""
    group = _phrase(of, saying)
    if count == 1:
        return _one(f"the {rank} tree" if group.plain else f"the {rank} of {group.group()}")
    return _many(f"the {count} {rank} trees" if group.plain else f"the {count} {rank} of {group.group()}")


def _corners(selector: s.Corners, saying: Saying) -> Phrase:
    group = _phrase(selector.of, saying)
    of = "" if group.plain else f" of {group.group()}"
    which = selector.which
    if len(which) == 1:
        return _one(f"the {CORNERS[which[0]]} corner tree{of}")
    if not which or set(which) == set(CORNERS):
        return _many(f"the 4 corner trees{of}")
    return _many(f"the {listed([CORNERS[w] for w in which])} corner trees{of}")


def _area(selector: s.Half | s.Quarter | s.Edge, saying: Saying) -> Phrase:
    """A region of the site, whichever way it is nested with what else keeps trees."""
    match selector:
        case s.Half(side=side):
            area = f"in the {SIDES[side]} half"
        case s.Quarter(quarter=quarter):
            area = f"in the {CORNERS[quarter]} quarter"
        case s.Edge(side=side):
            area = f"along the {SIDES[side]} edge"
    if bare_ground(selector.of) == selector.of:
        return Phrase(after=(f"{area}{_of_ground(selector.of, saying)}",))
    return _phrase(selector.of, saying).keeping(after=f"{area}{_of_ground(selector.of, saying)}")


def _of_ground(of: s.Selector, saying: Saying) -> str:
    """Of what a half or an edge is one, where it is not the whole site (the rule stands in ``site.places``)."""
    ground = bare_ground(of)
    return "" if ground == s.Trees() else f" of {_phrase(ground, saying).group()}"


def _filtered(selector: s.Where | s.InZone | s.Within | s.Other | s.Excluding, saying: Saying) -> Phrase:
    base = _phrase(selector.of, saying)
    match selector:
        case s.Where():
            if isinstance(selector.value, str) and selector.test == "eq" and _ADJECTIVAL.search(selector.attribute):
                return base.keeping(before=selector.value)
            return base.keeping(after=f"whose {say_test(selector.attribute, selector.test, selector.value)}")
        case s.InZone(zone=zone, outside=outside):
            return base.keeping(after=f"{'outside' if outside else 'inside'} the zone “{zone}”")
        case s.Within(distance_m=distance, to=to):
            return base.keeping(after=f"within {say_number(distance)} m of {_it(to, saying)}")
        case s.Other():
            return base.keeping(after="not visited yet")
        case s.Excluding(places=places):
            return base.keeping(after=f"other than {_it(places, saying)}")


def _picked(selector: s.Middle | s.EdgeMiddle | s.Nearest | s.Farthest | s.Top, saying: Saying) -> Phrase:
    verb = "is" if selector.count == 1 else "are"
    match selector:
        case s.Middle():
            own = "the site" if isinstance(selector.of, s.Trees) else "their area"
            tail = f"nearest to the middle of {own}"
        case s.EdgeMiddle(side=side):
            tail = f"nearest to the middle of the {SIDES[side]} edge{_of_ground(selector.of, saying)}"
        case s.Nearest(to=to, adjacent=adjacent, fresh=fresh):
            tail = f"{'next' if adjacent else 'nearest'} to {_it(to, saying)}{' and not visited yet' if fresh else ''}"
        case s.Farthest(origin=origin):
            tail = f"farthest from {_spot(origin, saying)}"
        case s.Top(attribute=attribute, lowest=lowest):
            tail, verb = f"with the {'lowest' if lowest else 'highest'} {say_attribute(attribute)[0]}", ""
    group = _phrase(selector.of, saying)
    build = _one if selector.count == 1 else _many
    number = () if selector.count == 1 else (str(selector.count),)
    noun = "tree" if selector.count == 1 else "trees"
    clause = f"that {verb} {tail}" if verb and (group.after or group.among) else tail
    if not group.closed:
        return build(" ".join(("the", *number, *group.before, noun, *clauses(group), clause)))
    ones = "the one" if selector.count == 1 else f"the {selector.count}"
    return build(f"{ones} of {group.group()} {clause}")


def _adjacent(selector: s.Adjacent, saying: Saying) -> Phrase:
    near = _it(selector.near, saying)
    if selector.count == 1:
        return _picked(s.Nearest(to=selector.near, of=selector.of), saying)
    group = _phrase(selector.of, saying)
    trees = say_count(selector.count, "tree") if group.plain else f"{selector.count} of {group.group()}"
    return _many(f"{trees} next to each other, beginning with the one nearest to {near}")


def _counted(selector: s.InRow | s.EveryNth, saying: Saying) -> Phrase:
    """Trees by their number in the row."""
    group = _phrase(selector.of, saying)
    if isinstance(selector, s.EveryNth):
        every = say_every(selector.nth)
        start = f", from the {say_ordinal(selector.start)} on" if selector.start != 1 else ""
        if selector.counted_from != "usual":
            start += f", counted from the {selector.counted_from}"
        if group.bare:
            return _many(f"{every} tree{group.of_what if group.row else f' of each row{group.of_what}'}{start}")
        return _many(f"{every} one of {group.group()}{start}")
    number = say_numbers(selector)
    from_ = "" if selector.counted_from == "usual" else f", counted from the {selector.counted_from}"
    if not group.bare:
        return _many(f"{number} of each row among {group.group()}{from_}")
    if not group.row:
        return _many(f"{number} of each row{group.of_what}{from_}")
    each = "" if group.one_row or not group.row.startswith(("rows", "the rows")) else " each of"
    return _many(f"{number} of{each}{group.of_what.removeprefix(' of')}{from_}")


def _from_hand(selector: s.AlongRow | s.Across, saying: Saying) -> Phrase:
    """The tree so many trees along the row, or in the next row."""
    origin = "" if isinstance(selector.origin, s.Here) else _it(selector.origin, saying)
    if isinstance(selector, s.Across):
        side = "" if selector.side == "usual" else f" to the {selector.side}"
        return _one(f"the tree abreast of {origin or 'that place'} in the next row{side}")
    trees = "the next tree" if selector.trees == 1 else f"the tree {selector.trees} trees further"
    return _one(f"{trees} {say_way(selector.towards)}{f' from {origin}' if origin else ''}")


def _successive(selector: s.Successive, saying: Saying) -> Phrase:
    group = _phrase(selector.of, saying)
    near = _it(selector.near, saying)
    if selector.count == 1:
        return _picked(s.Nearest(to=selector.near, of=selector.of), saying)
    if group.bare:
        where = group.of_what if group.one_row else f" of one row{group.of_what}"
        return _many(f"{selector.count} successive trees{where}, as near to {near} as there are")
    return _many(
        f"{selector.count} of {group.group()} that follow each other in one row, as near to {near} as there are"
    )


def _nth(selector: s.Nth, saying: Saying) -> Phrase:
    """The second northernmost, the third of them row by row."""
    inner, rank = selector.of, say_ordinal(selector.nth)
    if isinstance(inner, s.Ordered) and selector.nth > 0:
        number = "" if selector.nth == 1 else f"{rank} "
        group = _phrase(inner.of, saying)
        of = "" if group.plain else f" of {group.group()}"
        if inner.by == "attribute":
            end = "highest" if inner.descending else "lowest"
            base = "tree" if group.plain else f"one of {group.group()}"
            return _one(f"the {base} with the {number}{end} {say_attribute(inner.attribute)[0]}")
        if inner.by in _FOREMOST and not inner.descending:
            return _one(f"the {number}{_FOREMOST[inner.by]}{' tree' if group.plain else of}")
    group = _phrase(inner, saying)
    order = f", {group.order}" if group.order else ""
    return _one(f"the {rank} {'tree' if group.plain else f'of {group.group()}'}{order}")


def _apart(selector: s.Apart, saying: Saying) -> Phrase:
    """Trees at a distance from each other."""
    group = _phrase(selector.of, saying)
    trees = say_count(selector.count, "tree") if group.plain else f"{selector.count} of {group.group()}"
    how = "at least" if selector.least else "about"
    return _many(f"{trees}, {how} {say_number(selector.apart_m)} m from each other")


def _free_points(selector: s.Spaced | s.PointsIn, saying: Saying) -> Phrase:
    if isinstance(selector, s.PointsIn):
        if selector.count == 1:
            return _one(f"the middle of the zone “{selector.zone}”")
        return _many(f"{selector.count} points spread over the zone “{selector.zone}”")
    apart = f"{say_number(selector.apart_m)} m apart"
    points = f"{selector.count} points {apart}" if selector.count else f"as many points {apart} as fit"
    group, near = _phrase(selector.of, saying), _it(selector.near, saying)
    if selector.zone:
        where = f"on a line inside the zone “{selector.zone}”"
    elif group.bare and group.one_row:
        where = f"beside {group.of_what.removeprefix(' of ')}"
    else:
        where = "beside the nearest row" if group.plain else f"beside the nearest row of {group.group()}"
    build = _one if selector.count == 1 else _many
    return build(f"{'a point' if selector.count == 1 else points} {where}, beginning at the end nearer to {near}")


def _taken(selector: s.Take, saying: Saying) -> Phrase:
    inner = _phrase(selector.of, saying)
    if selector.count == 1:
        if selector.of == s.Other():
            return _one("another tree, the nearest one not visited yet")
        return inner if inner.single else _one(f"the nearest of {inner.group()}")
    return _many(f"the {selector.count} nearest of {inner.group()}")


def _together(parts: tuple[s.Selector, ...], saying: Saying) -> Phrase:
    trees = [part.tree for part in parts if isinstance(part, s.TreeIs)]
    if len(parts) == 1:
        return _phrase(parts[0], saying)
    if trees and len(trees) == len(parts):
        return _many(f"trees {listed(trees)}")
    return _many(listed([_phrase(part, saying).say() for part in parts]) or "no place at all")


def say_places(ids: tuple[str, ...], few: int = 8) -> str:
    """Places by id: all of them when few, else the first ones and how many more."""
    if len(ids) <= few:
        return listed(ids)
    return f"{', '.join(ids[:few])} and {len(ids) - few} more"
