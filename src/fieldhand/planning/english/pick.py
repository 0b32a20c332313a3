"""How many of the trees that a phrase leaves, and which: all, some, the nearest, the oldest, those of an area."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.english.asking import how_many, which_of
from fieldhand.planning.english.attributes import attribute_of, filtered
from fieldhand.planning.english.bag import Bag
from fieldhand.planning.english.faults import text_of
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.inrow import ends_of_rows, every_nth, next_in_row, opposite, ranked_in_rows, stepped
from fieldhand.planning.english.onebyone import distributed
from fieldhand.planning.english.regions import corners, extremes, middle, region
from fieldhand.planning.english.sets import Group
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.selections import is_about_rows, is_by_attribute, is_spot, some_of, zone_of_points
from fieldhand.site.model import Site
from fieldhand.terms import CornerName, MarkerName


def picked(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """The trees of a phrase.

    Raises:
        Unclear, Question: A word of it could not be placed, or it leaves open how many.
    """
    of = group.area
    found: FoundPlace
    if bag.has("STEP"):
        found = stepped(bag, group, site)
    elif bag.has("OPPOSITE"):
        found = opposite(bag, group, site)
    elif bag.has("EVERYNTH"):
        found = every_nth(bag, group, site)
    elif group.rows is not None and bag.has("START", "FINISH"):
        found = ends_of_rows(bag, group, site)
    elif bag.has("CORNER"):
        found = _corner_trees(bag, group, site)
    elif bag.has("MIDDLE"):
        found = middle(bag, group.kept(filtered(bag, of, site)))
    elif bag.has("MOST"):
        _whole_rows(bag, group)
        found = extremes(bag, lambda base: group.kept(filtered(bag, base, site)), of)
    elif bag.has("EDGE", "HALF", "QUARTER", "SIDE", "FINISH") or (bag.has("DIR") and not bag.has("TREE")):
        _whole_rows(bag, group)
        found = _area(bag, group, site)
    else:
        found = _trees(bag, group, site)
    bag.finish()
    if group.anchor is not None and not any(part == group.anchor for part in found.selector.walk()):
        raise bag.fault(message("it is not clear what is near to what"), message("say it in two steps"))
    found = distributed(found, group, bag)
    return replace(found, assumed=(*found.assumed, *group.assumed)) if group.assumed else found


def _whole_rows(bag: Bag, group: Group) -> None:
    """Halves and edges are those of the orchard or of a block, never of a row."""
    rows = group.rows is not None and is_about_rows(group.rows)
    if rows and group.rows_of and bag.has("EDGE", "HALF", "QUARTER", "SIDE"):
        advice = message("say 'trees 1 to 9 of row 3', or 'the trees of row 3 in the northern half of the orchard'")
        raise bag.fault(message("a row has no halves or edges"), advice)


def _corner_trees(bag: Bag, group: Group, site: Site) -> FoundPlace:
    described = bag.has("ATTRVAL") or bool(bag.compared)
    found = corners(bag, group.area)
    if described:
        found = replace(found, selector=filtered(bag, found.selector, site))
    return replace(found, selector=group.kept(found.selector))


def _area(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """Halves, quarters, sides and edges: areas, or with "tree" in the phrase the trees in them."""
    quarters = _each_quarter(bag, group)
    if quarters is not None:
        return quarters
    count, one, tree = bag.count, bag.count == 1, bag.take("TREE")
    area = group.kept(filtered(bag, region(bag, group.area), site))
    if bag.another or bag.take("OTHER") is not None:
        area = s.NotVisited(of=area)
    if tree is None and not (count or bag.any or bag.each or bag.as_many or bag.up_to):
        return FoundPlace(selector=area, region=True, many=True)
    del one
    return _some_of(bag, area, plural=bool(tree and tree.plural), site=site, single=False)


def _each_quarter(bag: Bag, group: Group) -> FoundPlace | None:
    """ "Each of the four quarters", each of which is meant by itself; None if one of them is named."""
    word = next(iter(bag.words("QUARTER")), None)
    several = bag.each or bag.count == 4
    if word is None or not several or bag.has("DIR", "MOST", "TREE") or bag.count not in (None, 1, 4) or bag.another:
        return None
    bag.take("QUARTER")
    bag.take("PLOT")
    corners: tuple[CornerName, ...] = ("nw", "ne", "se", "sw")
    ones = tuple(group.kept(s.Quarter(quarter=corner, of=group.area)) for corner in corners)
    return FoundPlace(selector=s.Trees(), many=True, each=True, region=True, rows=True, one_by_one=ones)


def _trees(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """Trees by where they stand to another place, by an attribute, or by being any."""
    of = group.area
    if (direction := bag.take("DIR")) is not None:  # "the northern trees"
        corner = len(direction.value) == 2
        of = s.Quarter(quarter=direction.value, of=of) if corner else s.Half(side=direction.value, of=of)
    zoned = bag.has("ZONE")
    ranked = bag.take("SUPER")
    name = attribute_of(bag, ranked.value[0], None, site) if ranked is not None else ""
    of = group.kept(filtered(bag, of, site))
    if bag.take("OTHER") is not None or bag.another:
        of = s.NotVisited(of=of)
    found = _by_rows(bag, of, group, ranked, site)
    if found is not None:
        return found
    tree = bag.take("TREE", "PLACE")
    if tree is not None and tree.kind == "PLACE" and tree.plural and (group.empty or tree.text.lower() != "ones"):
        raise bag.fault(
            message("which trees does it refer to?"),
            message("say 'trees', or name a zone: '4 points in the wet corner'"),
        )
    plural = bag.plural and bag.count is None
    if ranked is not None:
        lowest = ranked.value[1]
        return _ranked(bag, of, plural, lambda n, base: s.Top(attribute=name, count=n, lowest=lowest, of=base))
    found = _by_nearness(bag, of, group, plural)
    if found is not None:
        return found
    if bag.has("ORD", "LAST") and (tree is not None or bag.definite):
        return _first_or_last(bag, of, site)
    plot = bag.take("PLOT")
    if bag.take("EVERYWHERE") is not None:
        return FoundPlace(selector=of, many=True, each=True)
    if tree is None and (plot is not None or zoned) and not (bag.as_many or bag.count):
        return FoundPlace(selector=of, region=True, many=True)
    if tree is None:
        raise bag.fault(message("it does not say which place or which trees"))
    return _some_of(bag, of, plural=tree.plural, site=site, single=group.single)


def _by_rows(bag: Bag, of: s.Selector, group: Group, superlative: Term | None, site: Site) -> FoundPlace | None:
    """A rank along rows, points of a zone, or the next tree in the row; None if none of these is meant."""
    if bag.has("BACKORD", "COUNTEDFROM") or _is_ranked(bag, group, superlative):
        return ranked_in_rows(bag, of, group, site)
    points = _points(bag, group) if bag.has("PLACE") else None
    return points or (_following(bag, group) if bag.has("NEARBY") else None)


def _by_nearness(bag: Bag, of: s.Selector, group: Group, plural: bool) -> FoundPlace | None:
    """The nearest, the farthest, neighbours; None if nothing is said of nearness."""
    near = group.anchor or s.Here()
    if bag.take("ADJACENT") is not None:
        size = bag.count or 2
        if group.plain_rows:
            return FoundPlace(selector=s.Successive(count=size, near=near, of=of), many=size > 1, counted=size)
        return FoundPlace(selector=s.Adjacent(near=near, count=size, of=of), many=size > 1, counted=size)
    if bag.take("FARTHEST", "FAR") is not None:
        return _ranked(bag, of, plural, lambda n, base: s.Farthest(origin=near, count=n, of=base))
    if bag.more and (group.anchor is not None or bag.has("NEARBY", "NEAREST")):
        bag.more, of = False, s.NotVisited(of=of)  # "three more trees around it"
    if group.anchor is not None:
        bag.take("NEAREST", "NEARBY")
        beside = group.beside
        if not beside and is_spot(near) and not bag.has("ORD"):
            return _ranked(bag, of, plural, lambda n, base: s.Adjacent(near=near, count=n, of=base))
        side = group.side
        if side != "any" and (plural or (bag.count or 1) > 1):
            raise bag.fault(
                message("only one tree is next to it on that side"), message("say 'the tree next to it on the east'")
            )
        return _ranked(
            bag, of, plural, lambda n, base: s.Nearest(to=near, count=n, adjacent=beside, side=side, of=base)
        )
    if bag.take("NEAREST") is not None:
        return _ranked(bag, of, plural, lambda n, base: s.Nearest(to=near, count=n, of=base))
    if bag.has("NEARBY") and bag.words("NEARBY")[0].text.lower().startswith("neighb") and (bag.count or 0) > 1:
        bag.take("NEARBY")  # "two neighbouring trees" are neighbours of each other
        size = bag.count or 2
        return FoundPlace(selector=s.Adjacent(near=near, count=size, of=of), many=True, counted=size)
    if bag.take("NEARBY") is not None:
        one = bag.count or 1
        near_here = s.Nearest(to=s.Here(), count=one, fresh=True, of=of)
        return FoundPlace(selector=near_here, many=plural or one > 1, counted=bag.count)
    return None


def _is_ranked(bag: Bag, group: Group, superlative: Term | None) -> bool:
    """Whether a rank counts along rows, rather than by nearness or by an attribute."""
    other = superlative is not None or group.anchor is not None or bag.has("NEAREST", "FARTHEST", "FAR", "ADJACENT")
    return group.rows is not None and bag.has("ORD", "LAST") and not other


def _points(bag: Bag, group: Group) -> FoundPlace | None:
    """ "Four spots in the wet corner": free points of a zone, not trees."""
    zone = zone_of_points(group.area)
    points = all(t.text.lower() not in ("one", "ones") for t in bag.words("PLACE"))
    if not (points and zone):
        return None
    if bag.has("RANDOM"):
        raise bag.fault(
            message("points are spread evenly over a zone, not at random"),
            message("say 'at 3 points', or '3 random trees'"),
        )
    if not bag.only("PLACE", "OTHER") or group.anchor is not None or group.kept(group.area) != group.area:
        return None
    bag.take("OTHER")
    place = bag.take("PLACE")
    if bag.each or bag.as_many or bag.up_to or bag.more or bag.another:
        raise bag.fault(message("how many points are meant?"), message("say 'at 4 points in the zone', for example"))
    if place is not None and place.plural and bag.count is None:
        raise how_many(
            bag.phrase,
            ("3", "4", "5"),
            asked=message("'{said}': how many points?", context="question", said=text_of(bag.phrase.terms)),
        )
    bag.any = False
    count = bag.count or 1
    return FoundPlace(selector=s.PointsIn(zone=zone, count=count), many=count > 1, counted=count)


def _following(bag: Bag, group: Group) -> FoundPlace | None:
    """ "The next tree in the row" is the next along it; "a nearby tree in the row" is not."""
    said = bag.words("NEARBY")
    return next_in_row(bag, group) if said and said[0].text.lower() == "next" else None


def _ranked(bag: Bag, of: s.Selector, plural: bool, pick: Callable[[int, s.Selector], s.Selector]) -> FoundPlace:
    """The first ones of an order, or the second, the third of it."""
    rank = bag.take("ORD")
    if rank is not None and rank.value > 1:
        if bag.count is not None or plural:
            raise bag.fault(
                message("a rank cannot be combined with several trees"), message("say which one, or how many")
            )
        return FoundPlace(selector=pick(1, s.Excluding(places=pick(rank.value - 1, of), of=of)), counted=1)
    if plural:
        raise how_many(bag.phrase)
    number = bag.count or 1
    return FoundPlace(selector=pick(number, of), many=number > 1, counted=number, each=bag.each)


def _first_or_last(bag: Bag, of: s.Selector, site: Site) -> FoundPlace:
    rank, last = bag.take("ORD"), bag.take("LAST")
    if any(g[0].kind == "PLACE" for g in bag.phrase.nominals):
        raise bag.fault(
            message("the first or last of which trees?"), message("say 'the last tree', or name it by its id")
        )
    number = bag.count or 1
    if rank is not None and rank.value != 1:
        advice = message("name the tree by its id, or by a side: 'the second northernmost tree'")
        raise bag.fault(message("'{said}' could be counted in several ways", said=rank.text), advice)
    if bag.plural and bag.count is None:
        raise how_many(bag.phrase)
    if number == 1:
        return FoundPlace(selector=s.First(of=of) if last is None else s.Last(of=of), counted=1)
    marker: MarkerName = "start" if last is None else "end"
    if marker not in site.markers:
        raise bag.fault(
            message("the site has no {marker} marker to count from", marker=marker),
            message("name the trees by their ids"),
        )
    return FoundPlace(selector=s.Nearest(to=s.Marker(name=marker), count=number, of=of), many=True, counted=number)


def _some_of(bag: Bag, of: s.Selector, *, plural: bool, site: Site, single: bool) -> FoundPlace:
    """All of a group, a number of it, or any one."""
    count, text = bag.count, text_of(bag.phrase.terms)
    if bag.as_many:
        bag.as_many = False
        return FoundPlace(selector=of, many=True, optional=True, at_most=None if count is None else count)
    if bag.up_to:
        if count is None:
            raise bag.fault(message("up to how many?"), message("say 'up to 6 trees', for example"))
        bag.up_to = False
        return FoundPlace(selector=of, many=True, at_most=count)
    if bag.more:
        bag.more = False
        of = s.NotVisited(of=of)
    if isinstance(of, s.Middle | s.EdgeMiddle) and not bag.each:
        number = count or 1
        return FoundPlace(selector=replace(of, count=number), many=number > 1, counted=number)
    if single and count in (None, 1):
        return FoundPlace(selector=of)
    if bag.any and plural and count is None:
        raise how_many(
            bag.phrase,
            ("2", "4"),
            asked=message("'{said}': how many of them?", context="question", said=text),
            of_all=True,
        )
    if bag.any and count is None and is_by_attribute(of):
        raise how_many(
            bag.phrase, ("1",), asked=message("'{said}': how many of them?", context="question", said=text), of_all=True
        )
    if bag.article == "some" and plural and count is None:
        raise how_many(bag.phrase, ("2", "4"), of_all=True)
    if bag.spread:
        return _spread(bag, of, plural=plural)
    if bag.count is not None and (share := bag.take("SHARE")) is not None:
        return FoundPlace(selector=s.Evenly(count=bag.count, out_of=int(share.value), of=of), many=True)
    if (drawn := bag.take("RANDOM")) is not None:
        return _drawn(bag, of, int(drawn.value or 0), plural=plural)
    bare = of == s.Trees()
    if bare and bag.definite and count is None and not bag.each:
        if not plural:
            return FoundPlace(selector=s.Here(), here=True)
        return FoundPlace(selector=of, many=True, here=bag.pointing, all_or_these=not bag.pointing)
    if count is not None and count > 1 and bare and bag.pointing:
        return FoundPlace(selector=s.Here(), many=True, here=True, counted=count)
    if bag.each or (bag.definite and not bag.any):
        return _every(bag, of, plural, site)
    if plural and count is None:
        return FoundPlace(selector=of, many=True)
    number = count or 1
    return FoundPlace(selector=some_of(of, number), many=number > 1, counted=number)


def _drawn(bag: Bag, of: s.Selector, seed: int, *, plural: bool) -> FoundPlace:
    """Return some of a group, drawn at random."""
    if bag.each:
        raise bag.fault(message("all of them, or some at random?"), message("say how many: '10 trees at random'"))
    if plural and bag.count is None:
        raise how_many(bag.phrase, ("5", "10"), of_all=True)
    number = bag.count or 1
    return FoundPlace(selector=s.RandomSample(count=number, seed=seed, of=of), many=number > 1, counted=number)


def _spread(bag: Bag, of: s.Selector, *, plural: bool) -> FoundPlace:
    """Return some of a group, far from each other."""
    if bag.each:
        raise bag.fault(
            message("all of them, or some, spread over it?"), message("say how many: '10 trees spread over the block'")
        )
    if plural and bag.count is None:
        raise how_many(bag.phrase, ("5", "10"), of_all=True)
    bag.spread, number = (), bag.count or 1
    return FoundPlace(selector=s.Spread(count=number, of=of), many=number > 1, counted=number)


def _every(bag: Bag, of: s.Selector, plural: bool, site: Site) -> FoundPlace:
    """All of a group; how many there are has to agree with what is said, where that can be told."""
    count = bag.count
    claimed = count if count is not None else None if (bag.each or plural) else 1
    there = _size(of, site) if claimed is not None else None
    if claimed is not None and there is not None and there != claimed:
        what = message("'{said}': there are {there} such trees", said=text_of(bag.phrase.terms), there=there)
        if there < claimed:
            raise which_of(
                bag.phrase,
                message("{what}, not {claimed}", context="question", what=what, claimed=claimed),
                there=there,
                claimed=None,
            )
        raise which_of(
            bag.phrase, message("{what}; which are meant?", context="question", what=what), there=there, claimed=claimed
        )
    if claimed == 1:
        return FoundPlace(selector=s.Take(count=1, of=of))
    if claimed is not None and there is None and not bag.each:
        return FoundPlace(selector=some_of(of, claimed), many=True, counted=claimed)
    return FoundPlace(selector=of, many=True, each=bag.each, counted=claimed)


def _size(of: s.Selector, site: Site) -> int | None:
    """How many trees a selector names; None if only the robot can tell."""
    if of.relative:
        return None
    try:
        return len(resolve(of, site, Context(here=site.start)))
    except (PlaceError, TaskError):
        return 0
