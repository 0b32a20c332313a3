"""A selector in a few words, for messages."""

from __future__ import annotations

from fieldhand.task.selectors import (
    Adjacent,
    AmongExtreme,
    Bound,
    Corners,
    Edge,
    EdgeMiddle,
    Excluding,
    Extreme,
    Farthest,
    First,
    Half,
    Here,
    InZone,
    Last,
    Marker,
    Middle,
    Nearest,
    Other,
    Quarter,
    Selector,
    Take,
    Top,
    TreeIs,
    Trees,
    Union,
    Where,
    Within,
)

_TESTS = {"lt": "below", "le": "at most", "gt": "above", "ge": "at least", "eq": "equal to", "ne": "not"}
_CORNER = {"nw": "north-west", "ne": "north-east", "se": "south-east", "sw": "south-west"}
_DEEPEST = 6


def words(selector: Selector, depth: int = 0) -> str:
    """What the selector asks for, as a noun phrase: "the 3 trees nearest to tree 7 of the trees in zone wet corner"."""
    if depth > _DEEPEST:
        return "..."

    def say(inner: Selector) -> str:
        return words(inner, depth + 1)

    match selector:
        case Trees():
            return "trees"
        case TreeIs(tree=tree):
            return f"tree {tree}"
        case Marker(name=name):
            return f"the {name} marker"
        case Here():
            return "the place in hand"
        case Bound(label=label):
            return f"the places called {label}"
        case Union(parts=inner):
            return " and ".join(say(part) for part in inner[:4]) + (" and more" if len(inner) > 4 else "")
        case Take(count=count):
            return f"any {count} of the {say(selector.of)}"
        case Nearest():
            kind = "next to" if selector.adjacent else "near"
            fresh = "unvisited " if selector.fresh else ""
            return f"{_few(selector.count)}{fresh}{kind} {say(selector.to)} of the {say(selector.of)}"
        case Farthest():
            return f"{_few(selector.count)}farthest from {say(selector.origin)} of the {say(selector.of)}"
        case Adjacent():
            return f"{selector.count} next to each other near {say(selector.near)} of the {say(selector.of)}"
        case Excluding(places=places):
            return f"{say(selector.of)} other than {say(places)}"
        case Other():
            return f"{say(selector.of)} not visited yet"
        case Where(attribute=attribute, test=test, value=value):
            return f"{say(selector.of)} with {attribute} {_TESTS[test]} {value}"
        case Top(attribute=attribute):
            end = "lowest" if selector.lowest else "highest"
            return f"{_few(selector.count)}{end} by {attribute} of the {say(selector.of)}"
        case InZone(zone=zone):
            return f"{say(selector.of)} {'outside' if selector.outside else 'inside'} zone {zone}"
        case Within(distance_m=distance):
            return f"{say(selector.of)} within {distance:g} m of {say(selector.to)}"
        case _:
            return _of_the_extent(selector, say(selector.of))


def _of_the_extent(
    selector: First | Last | Corners | Extreme | AmongExtreme | Middle | EdgeMiddle | Half | Quarter | Edge, of: str
) -> str:
    match selector:
        case First():
            return f"the first of the {of}"
        case Last():
            return f"the last of the {of}"
        case Corners(which=which):
            return f"at the {', '.join(_CORNER[w] for w in which)} corner of the {of}"
        case Extreme(side=side, count=count):
            return f"{_few(count)}{side}ernmost of the {of}"
        case AmongExtreme(side=side):
            return f"among the {side}ernmost of the {of}"
        case Middle(count=count):
            return f"{_few(count)}in the middle of the {of}"
        case EdgeMiddle(side=side, count=count):
            return f"{_few(count)}in the middle of the {side} edge of the {of}"
        case Half(side=side):
            return f"{of} in the {side} half"
        case Quarter(quarter=quarter):
            return f"{of} in the {_CORNER[quarter]} quarter"
        case Edge(side=side):
            return f"{of} on the {side} edge"


def _few(count: int) -> str:
    return "the " if count == 1 else f"the {count} "
