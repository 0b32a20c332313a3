"""Corners, middles, sides and edges: what the compass and the outline of the trees name."""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.language import message, named
from fieldhand.places import selectors as s
from fieldhand.planning.english.asking import how_many
from fieldhand.planning.english.bag import Bag
from fieldhand.planning.english.faults import Question
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.sets import check_sides
from fieldhand.planning.selections import as_edge, zone_of_points
from fieldhand.terms import CornerName, Side

_CORNERS: tuple[CornerName, ...] = ("nw", "ne", "se", "sw")
_CORNER_WORDS = ("north-west", "north-east", "south-east", "south-west")
_CORNER_CHOICES = tuple(named(word, "answer", named(word, "compass")) for word in _CORNER_WORDS)
SIDE_ADVICE = message("say north, east, south or west")


def corners(bag: Bag, of: s.Selector) -> FoundPlace:
    """The trees at corners, one or several."""
    corner = bag.take("CORNER")
    bag.take("TREE")
    bag.take("PLACE")
    bag.take("PLOT")
    which = _which(bag)
    names = which or _CORNERS
    plural = bool(corner and corner.plural) or bag.each or bag.plural
    if bag.count is not None and bag.count > len(names):
        raise bag.fault(
            message("there are {there} such corners, not {count}", there=len(names), count=bag.count),
            message("ask for fewer"),
        )
    everything = s.Corners(which=names, of=of)
    if len(names) == 1:
        return FoundPlace(selector=everything)
    if bag.another or bag.take("OTHER") is not None:
        number = bag.count or (1 if not plural else None)
        if number is None:
            return FoundPlace(selector=s.NotVisited(of=everything), many=True)
        return FoundPlace(
            selector=s.Take(count=number, of=s.NotVisited(of=everything)), many=number > 1, counted=number
        )
    if bag.count is not None and bag.count < len(names):
        if bag.definite or bag.each:
            raise Question(
                message("which {count} of the corners?", context="question", count=bag.count), _CORNER_CHOICES
            )
        return FoundPlace(selector=s.Take(count=bag.count, of=everything), many=bag.count > 1, counted=bag.count)
    if plural or bag.count == len(names):
        if bag.any:
            corners = ("a corner", "2 corners", "all 4 corners")
            raise Question(
                message("how many of the corners?", context="question"),
                ("1", "2", message("all 4", context="answer")),
                terms=bag.phrase.terms,
                words=corners,
            )
        return FoundPlace(selector=everything, many=True, each=bag.each, counted=bag.count)
    if bag.take("NEAREST") is not None:
        return FoundPlace(selector=s.Nearest(to=s.Here(), of=everything))
    if bag.any or bag.article in ("a", "an", "some"):
        return FoundPlace(selector=s.Take(count=1, of=everything))
    words = tuple(f"{word} corner" for word in _CORNER_WORDS)
    raise Question(
        message("which corner?", context="question"),
        _CORNER_CHOICES,
        terms=() if corner is None else (corner,),
        words=words,
    )


def _which(bag: Bag) -> tuple[CornerName, ...]:
    named: list[CornerName] = []
    while (direction := bag.take("DIR", "MOST")) is not None:
        for corner in _CORNERS:  # "the two northern corners"
            one = direction.value == corner or (len(direction.value) > 2 and direction.value[0] in corner)
            if one and corner not in named:
                named.append(corner)
    return tuple(c for c in _CORNERS if c in named)


def middle(bag: Bag, of: s.Selector) -> FoundPlace:
    """The trees nearest to the middle of an area or of an edge."""
    bag.take("MIDDLE")
    treeless = bag.only("PLACE", "PLOT") and bag.count in (None, 1) and not (bag.another or bag.plural or bag.each)
    if treeless and (zone := zone_of_points(of)):
        bag.take("PLACE")
        bag.any = False
        return FoundPlace(selector=s.PointsIn(zone=zone))
    tree = bag.take("TREE", "PLACE")
    bag.take("PLOT")
    bag.take("SIDE")
    bag.any = False
    if tree is not None and tree.plural and bag.count is None:
        raise how_many(bag.phrase, asked=message("how many trees in the middle?", context="question"))
    if bag.another or bag.take("OTHER") is not None:
        of = s.NotVisited(of=of)
    count = bag.count or 1
    many, counted = count > 1, bag.count
    edge, direction = bag.take("EDGE", "FINISH"), bag.take("DIR")
    if direction is not None and edge is not None:
        if len(direction.value) == 2:
            raise bag.fault(message("an edge lies on one side"), SIDE_ADVICE)
        return FoundPlace(selector=s.EdgeMiddle(side=direction.value, count=count, of=of), many=many, counted=counted)
    if direction is not None or edge is not None:
        raise bag.fault(
            message("the middle of which side?"), message("say 'the middle of the northern edge', for example")
        )
    if (whole := as_edge(of)) is not None:
        return FoundPlace(selector=s.EdgeMiddle(side=whole.side, count=count, of=whole.of), many=many, counted=counted)
    return FoundPlace(selector=s.Middle(count=count, of=of), many=many, counted=counted)


def extremes(bag: Bag, kept: Callable[[s.Selector], s.Selector], of: s.Selector) -> FoundPlace:
    """The northernmost tree and its kin; the northernmost edge, part or half.

    Args:
        kept: The trees that the rest of the phrase leaves of an area.
    """
    most = bag.take("MOST")
    side = "" if most is None else most.value
    tree = bag.take("TREE", "PLACE")
    bag.take("PLOT")
    if bag.take("EDGE", "FINISH") is not None:
        area: s.Selector = s.Edge(side=_one_side(bag, side), of=of)
        check_sides(area, bag.phrase)
        return FoundPlace(selector=kept(area), region=True, many=True)
    if bag.take("SIDE", "HALF", "QUARTER") is not None:
        return FoundPlace(selector=kept(half_or_quarter(side, of)), region=True, many=True)
    of = kept(of)
    rank = bag.take("ORD")
    if bag.another or bag.take("OTHER") is not None:
        of = s.NotVisited(of=of)
    count = bag.count or 1
    if len(side) == 2:
        if rank is not None or count > 1 or (tree is not None and tree.plural):
            raise bag.fault(
                message("there is one such tree"), message("say 'the trees in the north-east', for example")
            )
        return FoundPlace(selector=s.Corners(which=(_corner(side),), of=of))
    compass = _one_side(bag, side)
    if rank is not None and rank.value > 1:
        if bag.count is not None or (tree is not None and tree.plural):
            raise bag.fault(
                message("a rank cannot be combined with several trees"), message("say which one, or how many")
            )
        nearer = s.Extreme(side=compass, count=rank.value - 1, of=of)
        return FoundPlace(selector=s.Extreme(side=compass, of=s.Excluding(places=nearer, of=of)))
    if bag.any or (bag.article in ("a", "an") and bag.count is None):
        return FoundPlace(
            selector=s.Take(count=count, of=s.AmongExtreme(side=compass, of=of)), many=count > 1, counted=count
        )
    if tree is not None and tree.plural and bag.count is None:
        return FoundPlace(selector=s.AmongExtreme(side=compass, of=of), many=True, each=bag.each)
    return FoundPlace(
        selector=s.Extreme(side=compass, count=count, of=of), many=count > 1, counted=count, each=bag.each
    )


def region(bag: Bag, of: s.Selector) -> s.Selector:
    """The trees of a half, a quarter, a side or an edge."""
    direction = bag.take("DIR")
    bag.take("PLOT")
    if direction is None:
        if bag.has("EDGE") and isinstance(of, s.Half) and of.of == s.Trees():
            bag.take("EDGE")
            return s.Edge(side=of.side)  # "the edge on the western side"
        if isinstance(of, s.Half) and bag.has("SIDE"):
            bag.take("SIDE")
            return of
        if bag.take("EDGE") is not None:  # "the edge of the orchard": all around it
            sides: tuple[Side, ...] = ("north", "east", "south", "west")
            return s.UnionOf(parts=tuple(s.Edge(side=side, of=of) for side in sides))
        if bag.has("FINISH"):
            raise bag.fault(message("it does not say which trees"), message("say 'the tree nearest to the end'"))
        raise bag.fault(message("it does not say which side"), SIDE_ADVICE)
    side = direction.value
    if bag.take("EDGE", "FINISH") is not None:
        area: s.Selector = s.Edge(side=_one_side(bag, side), of=of)
    else:
        quarter = bag.has("QUARTER")
        bag.take("HALF", "SIDE", "QUARTER")
        if quarter and len(side) != 2:
            raise bag.fault(message("a quarter lies in a corner"), message("say 'the north-east quarter', for example"))
        area = half_or_quarter(side, of)
    check_sides(area, bag.phrase)
    return area


def half_or_quarter(side: str, of: s.Selector) -> s.Selector:
    """The half on one side, or the quarter in one corner."""
    if len(side) == 2:
        return s.Quarter(quarter=_corner(side), of=of)
    compass: Side = {"north": "north", "east": "east", "south": "south"}.get(side, "west")  # type: ignore[assignment]
    return s.Half(side=compass, of=of)


def _corner(name: str) -> CornerName:
    return next(c for c in _CORNERS if c == name)


def _one_side(bag: Bag, side: str) -> Side:
    for compass in ("north", "east", "south", "west"):
        if side == compass:
            found: Side = compass
            return found
    raise bag.fault(message("an edge lies on one side"), SIDE_ADVICE)
