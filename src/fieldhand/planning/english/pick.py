"""How many of the trees that a phrase leaves, and which: all, some, the nearest, the oldest, those of an area."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from fieldhand.errors import PlaceError, TaskError
from fieldhand.planning.english.attributes import attribute_of, filtered
from fieldhand.planning.english.bag import Bag
from fieldhand.planning.english.faults import Question, text_of
from fieldhand.planning.english.found import Found
from fieldhand.planning.english.regions import corners, extremes, middle, region
from fieldhand.planning.english.sets import Group
from fieldhand.site.context import Context
from fieldhand.site.model import Site
from fieldhand.site.places import resolve
from fieldhand.task import selectors as s


def picked(bag: Bag, group: Group, site: Site) -> Found:
    """The trees of a phrase.

    Raises:
        Unclear, Question: A word of it could not be placed, or it leaves open how many.
    """
    of = group.area
    found: Found
    if bag.has("CORNER"):
        found = _corner_trees(bag, group, site)
    elif bag.has("MIDDLE"):
        found = middle(bag, group.kept(filtered(bag, of, site)))
    elif bag.has("MOST"):
        found = extremes(bag, lambda base: group.kept(filtered(bag, base, site)), of)
    elif bag.has("EDGE", "HALF", "QUARTER", "SIDE", "FINISH") or (bag.has("DIR") and not bag.has("TREE")):
        found = _area(bag, group, site)
    else:
        found = _trees(bag, group, site)
    bag.finish()
    return found


def _corner_trees(bag: Bag, group: Group, site: Site) -> Found:
    described = bag.has("ATTRVAL") or bool(bag.compared)
    found = corners(bag, group.area)
    if described:
        found = replace(found, selector=filtered(bag, found.selector, site))
    return replace(found, selector=group.kept(found.selector))


def _area(bag: Bag, group: Group, site: Site) -> Found:
    """Halves, quarters, sides and edges: areas, or with "tree" in the phrase the trees in them."""
    count, one, tree = bag.count, bag.count == 1, bag.take("TREE")
    area = group.kept(filtered(bag, region(bag, group.area), site))
    if bag.another or bag.take("OTHER") is not None:
        area = s.Other(of=area)
    if tree is None and not (count or bag.any or bag.each or bag.as_many or bag.up_to):
        return Found(selector=area, region=True, many=True)
    del one
    return _some_of(bag, area, plural=bool(tree and tree.plural), site=site, single=False)


def _trees(bag: Bag, group: Group, site: Site) -> Found:
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
        of = s.Other(of=of)
    tree = bag.take("TREE", "PLACE")
    if tree is not None and tree.kind == "PLACE" and tree.plural:
        raise bag.fault("which trees are meant by it?", "say 'trees'")
    plural = bag.plural and bag.count is None
    if ranked is not None:
        lowest = ranked.value[1]
        return _ranked(bag, of, plural, lambda n, base: s.Top(attribute=name, count=n, lowest=lowest, of=base))
    near = group.anchor or s.Here()
    if bag.take("ADJACENT") is not None:
        size = bag.count or 2
        return Found(selector=s.Adjacent(near=near, count=size, of=of), many=size > 1, counted=size)
    if bag.take("FARTHEST", "FAR") is not None:
        return _ranked(bag, of, plural, lambda n, base: s.Farthest(origin=near, count=n, of=base))
    if group.anchor is not None:
        bag.take("NEAREST", "NEARBY")
        beside = group.beside
        if not beside and is_spot(near) and not bag.has("ORD"):
            return _ranked(bag, of, plural, lambda n, base: s.Adjacent(near=near, count=n, of=base))
        return _ranked(bag, of, plural, lambda n, base: s.Nearest(to=near, count=n, adjacent=beside, of=base))
    if bag.take("NEAREST") is not None:
        return _ranked(bag, of, plural, lambda n, base: s.Nearest(to=near, count=n, of=base))
    if bag.take("NEARBY") is not None:
        one = bag.count or 1
        near_here = s.Nearest(to=s.Here(), count=one, fresh=True, of=of)
        return Found(selector=near_here, many=plural or one > 1, counted=bag.count)
    if bag.has("ORD", "LAST"):
        return _first_or_last(bag, of, site)
    plot = bag.take("PLOT")
    if bag.take("EVERYWHERE") is not None:
        return Found(selector=of, many=True, each=True)
    if tree is None and (plot is not None or zoned) and not (bag.as_many or bag.count):
        return Found(selector=of, region=True, many=True)
    if tree is None:
        raise bag.fault("which place or which trees are meant does not stand there")
    return _some_of(bag, of, plural=tree.plural, site=site, single=group.single)


def is_spot(place: s.Selector) -> bool:
    """Whether a place is a spot of the ground: the tree nearest to a corner or a middle is the one there."""
    return s.is_single(place) and isinstance(place, s.Corners | s.Middle | s.EdgeMiddle)


def _ranked(bag: Bag, of: s.Selector, plural: bool, pick: Callable[[int, s.Selector], s.Selector]) -> Found:
    """The first ones of an order, or the second, the third of it."""
    rank = bag.take("ORD")
    if rank is not None and rank.value > 1:
        if bag.count is not None or plural:
            raise bag.fault("a rank and several trees at once", "say which one, or how many")
        return Found(selector=pick(1, s.Excluding(places=pick(rank.value - 1, of), of=of)), counted=1)
    if plural:
        raise Question(f"'{text_of(bag.phrase.terms)}': how many?", ("2", "3", "4"))
    number = bag.count or 1
    return Found(selector=pick(number, of), many=number > 1, counted=number, each=bag.each)


def _first_or_last(bag: Bag, of: s.Selector, site: Site) -> Found:
    rank, last = bag.take("ORD"), bag.take("LAST")
    if any(g[0].kind == "PLACE" for g in bag.phrase.nominals):
        raise bag.fault("the first or last of which trees?", "say 'the last tree', or name it by its id")
    number = bag.count or 1
    if rank is not None and rank.value != 1:
        advice = "name the tree by its id, or by a side: 'the second northernmost tree'"
        raise bag.fault(f"'{rank.text}' could be counted in several ways", advice)
    if bag.plural and bag.count is None:
        raise Question(f"'{text_of(bag.phrase.terms)}': how many?", ("2", "3", "4"))
    if number == 1:
        return Found(selector=s.First(of=of) if last is None else s.Last(of=of), counted=1)
    marker: s.MarkerName = "start" if last is None else "end"
    if marker not in site.markers:
        raise bag.fault(f"the site has no {marker} marker to count from", "name the trees by their ids")
    return Found(selector=s.Nearest(to=s.Marker(name=marker), count=number, of=of), many=True, counted=number)


def _some_of(bag: Bag, of: s.Selector, *, plural: bool, site: Site, single: bool) -> Found:
    """All of a group, a number of it, or any one."""
    count, text = bag.count, text_of(bag.phrase.terms)
    if bag.as_many:
        bag.as_many = False
        return Found(selector=of, many=True, optional=True, at_most=None if count is None else count)
    if bag.up_to:
        if count is None:
            raise bag.fault("up to how many?", "say 'up to 6 trees', for example")
        bag.up_to = False
        return Found(selector=of, many=True, at_most=count)
    if bag.more:
        bag.more = False
        of = s.Other(of=of)
    if isinstance(of, s.Middle | s.EdgeMiddle) and not bag.each:
        number = count or 1
        return Found(selector=replace(of, count=number), many=number > 1, counted=number)
    if single and count in (None, 1):
        return Found(selector=of)
    if bag.any and plural and count is None:
        raise Question(f"'{text}': how many of them?", ("2", "4", "all of them"))
    if bag.article == "some" and plural and count is None:
        raise Question(f"'{text}': how many?", ("2", "4", "all of them"))
    bare = of == s.Trees()
    if bare and bag.definite and count is None and not bag.each:
        if not plural:
            return Found(selector=s.Here(), here=True)
        return Found(selector=of, many=True, here=bag.pointing, all_or_these=not bag.pointing)
    if count is not None and count > 1 and bare and bag.pointing:
        return Found(selector=s.Here(), many=True, here=True, counted=count)
    if bag.each or (bag.definite and not bag.any):
        return _every(bag, of, plural, site)
    if plural and count is None:
        return Found(selector=of, many=True)
    number = count or 1
    return Found(selector=s.Take(count=number, of=of), many=number > 1, counted=number)


def _every(bag: Bag, of: s.Selector, plural: bool, site: Site) -> Found:
    """All of a group; how many there are has to agree with what is said, where that can be told."""
    count = bag.count
    claimed = count if count is not None else None if (bag.each or plural) else 1
    there = _size(of, site) if claimed is not None else None
    if claimed is not None and there is not None and there != claimed:
        what = f"'{text_of(bag.phrase.terms)}': there are {there} such trees"
        if there < claimed:
            raise Question(f"{what}, not {claimed}", (f"all {there} of them",) if there else ())
        raise Question(f"{what}; which are meant?", (f"all {there} of them", f"any {claimed} of them"))
    if claimed == 1:
        return Found(selector=s.Take(count=1, of=of))
    if claimed is not None and there is None and not bag.each:
        return Found(selector=s.Take(count=claimed, of=of), many=True, counted=claimed)
    return Found(selector=of, many=True, each=bag.each, counted=claimed)


def _size(of: s.Selector, site: Site) -> int | None:
    """How many trees a selector names; None if only the robot can tell."""
    if s.is_relative(of):
        return None
    try:
        return len(resolve(of, site, Context(here=site.start)))
    except (PlaceError, TaskError):
        return 0
