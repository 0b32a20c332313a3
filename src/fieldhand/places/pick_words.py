"""What picks from a group of trees, in words: "the 3 northernmost of the yellow trees"."""

from __future__ import annotations

from collections.abc import Mapping

from fieldhand.language import counted, joined, message
from fieldhand.language.words import SIDES, say_marker, say_name
from fieldhand.places import selectors as s
from fieldhand.places.attribute_words import say_attribute
from fieldhand.places.noun import Phrase, clauses
from fieldhand.places.row_words import say_ordinal, say_ranked_tree
from fieldhand.places.saying import Saying, many, of_ground, one, origin
from fieldhand.site.kinds import phrase
from fieldhand.terms import Side

#: What the first is called in an order, of one and of several.
_FOREMOST: Mapping[s.Order, str] = {
    "west_to_east": "westernmost",
    "east_to_west": "easternmost",
    "north_to_south": "northernmost",
    "south_to_north": "southernmost",
    "nearest_first": "nearest",
    "farthest_first": "farthest",
}


def superlative(word: str, count: int) -> str:
    """ "northernmost", as it is said of so many trees."""
    match word:
        case "northernmost":
            return counted("northernmost", "northernmost", count)
        case "easternmost":
            return counted("easternmost", "easternmost", count)
        case "southernmost":
            return counted("southernmost", "southernmost", count)
        case "westernmost":
            return counted("westernmost", "westernmost", count)
        case "nearest":
            return counted("nearest", "nearest", count)
    return counted("farthest", "farthest", count)


def foremost(word: str, count: int, group: Phrase) -> Phrase:
    """The northernmost, the 3 nearest."""
    which = superlative(word, count)
    if count == 1:
        if group.plain:
            return one(message("the {northernmost} tree", northernmost=which))
        return one(message("the {northernmost} of {trees}", context="one", northernmost=which, trees=group.group()))
    if group.plain:
        return many(message("the {count} {northernmost} trees", count=count, northernmost=which))
    return many(message("the {count} {northernmost} of {trees}", count=count, northernmost=which, trees=group.group()))


def picked(selector: s.Middle | s.EdgeMiddle | s.Nearest | s.Farthest | s.Top, saying: Saying) -> Phrase:
    """The trees of a group that are nearest to something, or have the most of something."""
    tail, count = _distinction(selector, saying), selector.count
    group = saying.phrase(selector.of)
    build = one if count == 1 else many
    if isinstance(selector, s.Top):
        clause = tail
    elif group.after or group.among:
        clause = counted("that is {nearest_to}", "that are {nearest_to}", count, nearest_to=tail)
    else:
        clause = counted("{nearest_to}", "{nearest_to}", count, nearest_to=tail)
    if group.closed:
        if count == 1:
            return build(message("the one of {trees} {clause}", trees=group.group(), clause=clause))
        return build(message("the {count} of {trees} {clause}", count=count, trees=group.group(), clause=clause))
    if count == 1:
        return build(
            message("the {adjectives} tree {clauses}", adjectives=group.adjectives(1), clauses=clauses(group, clause))
        )
    return build(
        message(
            "the {count} {adjectives} trees {clauses}",
            count=count,
            adjectives=group.adjectives(),
            clauses=clauses(group, clause),
        )
    )


def _distinction(selector: s.Middle | s.EdgeMiddle | s.Nearest | s.Farthest | s.Top, saying: Saying) -> str:
    """What distinguishes the trees that are picked: "nearest to the middle of the site"."""
    match selector:
        case s.Middle(of=of):
            whole = isinstance(of, s.Trees)
            of_site = message("nearest to the middle of the site"), message("nearest to the middle of their area")
            return of_site[0] if whole else of_site[1]
        case s.EdgeMiddle(side=side, of=of):
            return message(
                "nearest to the middle of the {northern} edge {of_trees}",
                northern=SIDES[side],
                of_trees=of_ground(of, saying),
            )
        case s.Nearest(to=to, adjacent=adjacent, fresh=fresh, side=side):
            place = origin(to, saying)
            near = message("next to {place}", place=place) if adjacent else message("nearest to {place}", place=place)
            there = near if side == "any" else _on_side(near, side)
            return message("{near} and not visited yet", near=there) if fresh else there
        case s.Farthest(origin=far_from):
            return spot(far_from, saying)
        case s.Top(attribute=attribute, lowest=lowest):
            name = say_attribute(attribute)[0]
            return (
                message("with the lowest {name}", name=name)
                if lowest
                else message("with the highest {name}", name=name)
            )


def _on_side(near: str, side: Side) -> str:
    """Return "next to tree 4, on its east side"."""
    match side:
        case "north":
            return message("{near}, on its north side", near=near)
        case "east":
            return message("{near}, on its east side", near=near)
        case "south":
            return message("{near}, on its south side", near=near)
        case "west":
            return message("{near}, on its west side", near=near)


def spot(selector: s.Selector, saying: Saying) -> str:
    """A place that something is far from."""
    if isinstance(selector, s.Here):
        return message("farthest from there")
    return message("farthest from {place}", place=origin(selector, saying))


def nth(selector: s.Nth, saying: Saying) -> Phrase:
    """The second northernmost, the third of them row by row."""
    inner, number = selector.of, selector.nth
    if isinstance(inner, s.Ordered) and number > 0:
        group = saying.phrase(inner.of)
        if inner.by == "attribute":
            return one(_nth_most(inner, number, group))
        if inner.by in _FOREMOST and not inner.descending:
            return _nth_foremost(_FOREMOST[inner.by], number, group)
    group = saying.phrase(inner)
    if group.plain:
        said = say_ranked_tree(number)
    else:
        said = message("the {ordinal} of {trees}", ordinal=say_ordinal(number, "one"), trees=group.group())
    return one(message("{trees}, {order}", trees=said, order=group.order) if group.order else said)


def _nth_most(inner: s.Ordered, number: int, group: Phrase) -> str:
    """The tree with the second highest yield."""
    base = message("the tree") if group.plain else message("the one of {trees}", trees=group.group())
    name = say_attribute(inner.attribute)[0]
    if number == 1:
        most = message("with the highest {name}", name=name), message("with the lowest {name}", name=name)
    else:
        rank = say_ordinal(number, "one")
        most = (
            message("with the {ordinal} highest {name}", ordinal=rank, name=name),
            message("with the {ordinal} lowest {name}", ordinal=rank, name=name),
        )
    return joined(" ", (base, most[0] if inner.descending else most[1]))


def _nth_foremost(word: str, number: int, group: Phrase) -> Phrase:
    """The second northernmost tree."""
    if number == 1:
        return foremost(word, 1, group)
    rank, which = say_ordinal(number, "tree"), superlative(word, 1)
    if group.plain:
        return one(message("the {ordinal} {northernmost} tree", ordinal=rank, northernmost=which))
    rank = say_ordinal(number, "one")
    return one(
        message("the {ordinal} {northernmost} of {trees}", ordinal=rank, northernmost=which, trees=group.group())
    )


def the_most(word: str) -> str:
    """What those are that come first, in a note: "the northernmost"."""
    return message("the {northernmost}", northernmost=superlative(word, 1))


def the_highest(attribute: str, *, lowest: bool) -> str:
    """What those are that have the most of an attribute, in a note: "the highest yield kg"."""
    name = say_name(phrase(attribute))
    return message("the lowest {name}", name=name) if lowest else message("the highest {name}", name=name)


def the_middle_of_edge(side: Side) -> str:
    """What is nearest to the middle of an edge, in a note."""
    return message("the nearest to the middle of the {northern} edge", northern=SIDES[side])


def the_nearest_to_marker(name: str) -> str:
    """What is nearest to a marker, in a note."""
    return message("the nearest to {place}", place=say_marker(name))
