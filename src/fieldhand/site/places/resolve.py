"""Resolves a selector: each part works on the group that the part inside it left."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import shapely

from fieldhand.errors import PlaceError
from fieldhand.site.context import Context
from fieldhand.site.kinds import phrase
from fieldhand.site.model import Place, Site
from fieldhand.site.places import attributes, extent, neighbours
from fieldhand.site.places.faults import listed, no_such_tree, no_such_zone, nothing, short, too_few
from fieldhand.site.places.spots import Spots, joined
from fieldhand.site.places.words import words
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

_Picks = Extreme | Middle | EdgeMiddle | Nearest | Farthest | Adjacent | Top | Take


def resolve(selector: Selector, site: Site, context: Context) -> tuple[Place, ...]:
    """The places that a selector names, in a fixed order, each once; never none.

    Args:
        selector: Innermost part first: each part keeps, orders or picks from what its ``of`` leaves.
        site: Where.
        context: Where the robot is and has been, for what is said relative to it.

    Raises:
        PlaceError: A part of the selector finds nothing or too little, or names what the site does not have; the
            message says which part, and what there is.
    """
    return _Resolution(site, context).spots(selector).places


def resolve_one(selector: Selector, site: Site, context: Context) -> Place:
    """The one place that a selector names.

    Raises:
        PlaceError: As :func:`resolve`, or the selector names several.
    """
    places = resolve(selector, site, context)
    if len(places) > 1:
        raise PlaceError(
            f"{len(places)} places are meant by {short(words(selector), 160)!r} where one is needed",
            where=site.name,
            advice=f"name one of them: {listed([p.id for p in places])}",
        )
    return places[0]


class _Resolution:
    """One call of :func:`resolve`."""

    def __init__(self, site: Site, context: Context) -> None:
        self.site = site
        self.context = context

    def spots(self, selector: Selector) -> Spots:
        """What the selector leaves; never nothing."""
        match selector:
            case Trees() | TreeIs() | Marker() | Here() | Bound() | Union():
                return self._source(selector)
            case Half() | Quarter() | Edge() | AmongExtreme() | InZone() | Within() | Where() | Other() | Excluding():
                found = self._filtered(selector, self.spots(selector.of))
                if not len(found):
                    raise nothing(self.site, selector)
                return found
            case First() | Last() | Corners():
                return self._named(selector, self.spots(selector.of))
            case _:
                return self._picked(selector, self.spots(selector.of))

    def _source(self, selector: Trees | TreeIs | Marker | Here | Bound | Union) -> Spots:
        match selector:
            case Trees():
                return Spots.all_trees(self.site)
            case TreeIs(tree=tree):
                if tree not in self.site.by_id:
                    raise no_such_tree(self.site, tree)
                return Spots.of(self.site, [self.site.by_id[tree].place])
            case Marker(name=name):
                return Spots.of(self.site, [self._marker(name)])
            case Here():
                return Spots.of(self.site, [self.context.here])
            case Bound(label=label):
                places = self.context.bound.get(label, ())
                if not places:
                    known = listed(list(self.context.bound)) or "nothing yet"
                    raise PlaceError(
                        f"nothing is called {short(label)!r} at this point", advice=f"named so far: {known}"
                    )
                return Spots.of(self.site, places)
            case Union(parts=parts):
                if not parts:
                    raise nothing(self.site, selector, "it has no parts")
                return joined(self.site, [self.spots(part) for part in parts])

    def _filtered(
        self,
        selector: Half | Quarter | Edge | AmongExtreme | InZone | Within | Where | Other | Excluding,
        of: Spots,
    ) -> Spots:
        match selector:
            case Half(side=side):
                return extent.half(of, side, self._ground(selector.of, of))
            case Quarter(quarter=name):
                return extent.quarter(of, name, self._ground(selector.of, of))
            case Edge(side=side):
                return extent.edge(of, side, self._ground(selector.of, of))
            case AmongExtreme(side=side):
                return extent.among_extreme(of, side)
            case InZone():
                return self._in_zone(selector, of)
            case Within(distance_m=distance):
                if not (math.isfinite(distance) and distance > 0):
                    raise PlaceError(f"a distance of {distance:g} m holds no tree", advice="ask for more than 0 m")
                to = self.spots(selector.to)
                return neighbours.within(neighbours.apart_from(of, to), to, distance)
            case Where():
                return attributes.where(of, selector)
            case Other():
                return of.without(self._visited())
            case Excluding(places=places):
                return of.without(self.spots(places))

    def _named(self, selector: First | Last | Corners, of: Spots) -> Spots:
        match selector:
            case First() | Last():
                marker = self.site.markers.get("start" if isinstance(selector, First) else "end")
                if marker is not None:
                    return neighbours.nearest(of, Spots.of(self.site, [marker]), 1)
                order = of.file_order
                return of.keep([int(order.argmin() if isinstance(selector, First) else order.argmax())])
            case Corners(which=which):
                if not which:
                    raise nothing(self.site, selector, "it names no corner")
                return extent.corners(of, which, self._ground(selector.of, of, attributes_too=False))

    def _picked(self, selector: _Picks, of: Spots) -> Spots:
        candidates, to = self._candidates(selector, of)
        if selector.count < 1 or len(candidates) < selector.count:
            raise too_few(self.site, selector, selector.count, len(candidates))
        count = selector.count
        match selector:
            case Extreme(side=side):
                return extent.extreme(candidates, side, count)
            case Middle():
                return extent.middle(candidates, count, self._ground(selector.of, of, attributes_too=False))
            case EdgeMiddle(side=side):
                return extent.edge_middle(candidates, side, count, self._ground(selector.of, of))
            case Nearest(adjacent=True):
                return neighbours.next_to(candidates, to, count)
            case Nearest():
                return neighbours.nearest(candidates, to, count)
            case Farthest():
                return neighbours.farthest(candidates, to, count)
            case Adjacent():
                found = neighbours.side_by_side(candidates, to, count)
                if len(found) < count:
                    raise too_few(self.site, selector, count, len(found))
                return found
            case Top():
                return candidates.keep(np.arange(count))
            case Take():
                return neighbours.short_drive(candidates, np.array(self.context.here.xy), count)

    def _candidates(self, selector: _Picks, of: Spots) -> tuple[Spots, Spots]:
        """What a pick may choose from, and what it is measured from (of no meaning where it is not)."""
        match selector:
            case Nearest(to=origin) | Farthest(origin=origin):
                to = self.spots(origin)
                left = neighbours.apart_from(of, to)
                return (left.without(self._visited()) if isinstance(selector, Nearest) and selector.fresh else left), to
            case Adjacent(near=near):
                return of, self.spots(near)
            case EdgeMiddle(side=side):
                return extent.edge(of, side, self._ground(selector.of, of)), of
            case Top():
                return attributes.ranked(of, selector), of
            case _:
                return of, of

    def _marker(self, name: str) -> Place:
        """A missing start is the first tree of the file, a missing end is the start; a charger has no stand-in."""
        if name in self.site.markers:
            return self.site.markers[name]
        if name == "charger":
            raise PlaceError(
                "the site has no charger", where=self.site.name, advice='add a point of "kind": "charger" to its file'
            )
        return self.site.start if name == "start" else self.site.home("return_to_end", self.context.here)

    def _in_zone(self, selector: InZone, of: Spots) -> Spots:
        zones = [z for z in self.site.zones if phrase(z.name) == phrase(selector.zone)]
        exact = [z for z in zones if z.name == selector.zone]
        if not zones:
            raise no_such_zone(self.site, selector)
        inside = np.zeros(len(of), dtype=bool)
        for zone in exact or zones:
            shapely.prepare(zone.polygon)
            inside |= shapely.intersects_xy(zone.polygon, of.xy[:, 0], of.xy[:, 1])
        return of.keep(~inside if selector.outside else inside)

    def _visited(self) -> Spots:
        known = [self.site.by_id[t].index for t in self.context.visited if t in self.site.by_id]
        return Spots(site=self.site, index=np.array(known, dtype=np.intp))

    def _ground(self, selector: Selector, of: Spots, *, attributes_too: bool = True) -> Spots:
        """The group whose extent counts: ``of`` before visited trees (and attributes and picks) are taken out."""
        bare = bare_ground(selector, attributes_too=attributes_too)
        return of if bare == selector else self.spots(bare)


def bare_ground(selector: Selector, *, attributes_too: bool = True) -> Selector:
    """The selector without the parts that leave the geometry as it is.

    Args:
        selector: Any.
        attributes_too: Also without attribute tests; else only without what depends on the mission so far.
    """
    match selector:
        case Other() | Excluding() | Take():
            return bare_ground(selector.of, attributes_too=attributes_too)
        case Where() | Top() if attributes_too:
            return bare_ground(selector.of, attributes_too=attributes_too)
        case Where() | Half() | Quarter() | Edge() | AmongExtreme() | InZone() | Within():
            return replace(selector, of=bare_ground(selector.of, attributes_too=attributes_too))
        case Union(parts=parts):
            return Union(parts=tuple(bare_ground(p, attributes_too=attributes_too) for p in parts))
        case _:
            return selector
