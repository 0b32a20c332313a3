"""Resolves a selector: each part works on the group that the part inside it left, and says how."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import PlaceError
from fieldhand.language import Number, message
from fieldhand.places import attributes, byrow, draw, extent, hand, neighbours, ordering, points
from fieldhand.places import selectors as s
from fieldhand.places.apart import apart
from fieldhand.places.context import Context
from fieldhand.places.faults import no_such_block, no_such_gate, no_such_tree, no_such_zone, nothing, too_few
from fieldhand.places.neighbours import Ground, Origin
from fieldhand.places.nesting import bare_ground
from fieldhand.places.pick_words import the_highest, the_middle_of_edge, the_most, the_nearest_to_marker
from fieldhand.places.spots import Spots, joined
from fieldhand.places.spread import spread
from fieldhand.places.tell import Tell, rank, tell_passed_over
from fieldhand.places.words import say_selector
from fieldhand.site.kinds import phrase
from fieldhand.site.model import Place, Site
from fieldhand.site.names import listed, short

_Source = s.Trees | s.TreeIs | s.Marker | s.GateIs | s.Here | s.Bound | s.Union
_Region = s.Half | s.Quarter | s.Edge | s.AmongExtreme | s.InZone | s.InBlock | s.Within
_Kept = s.Where | s.Other | s.Excluding | s.Rows | s.RowOf | s.InRow | s.EveryNth
_Ranked = s.Extreme | s.Middle | s.EdgeMiddle | s.Nearest | s.Farthest | s.Top
_Chained = s.Adjacent | s.Take | s.Random | s.Spread | s.Successive

_EXTENT_RULE = "halves and quarters go by the middle lines of the extent along true north"


def resolve(selector: s.Selector, site: Site, context: Context) -> tuple[Place, ...]:
    """The places that a selector names, in a fixed order, each once; never none.

    Args:
        selector: Innermost part first: each part keeps, orders or picks from what its ``of`` leaves.
        site: Where.
        context: Where the robot is and has been, for what is said relative to it.

    Raises:
        PlaceError: A part of the selector finds nothing or too little, or names what the site does not have; the
            message says which part, and what there is.
    """
    return Resolution(site, context).spots(selector).places


def resolve_one(selector: s.Selector, site: Site, context: Context) -> Place:
    """The one place that a selector names.

    Raises:
        PlaceError: As :func:`resolve`, or the selector names several.
    """
    return Resolution(site, context).one(selector).places[0]


@dataclass(frozen=True, eq=False)
class Step:
    """A part of a selector that was resolved."""

    selector: s.Selector
    tell: Tell
    found: Spots


class Resolution:
    """One selector on one site at one moment. What comes up again, here or as a ground, is resolved once.

    Attributes:
        steps: The parts that were resolved, each after those inside it.
    """

    def __init__(self, site: Site, context: Context, known: dict[str, Step] | None = None) -> None:
        self.site = site
        self.context = context
        self.steps: list[Step] = []
        self._known: dict[str, Step] = {} if known is None else known
        self._told: set[str] = set()

    def spots(self, selector: s.Selector) -> Spots:
        """What the selector leaves; never nothing."""
        key = repr(selector)  # not the selector: one that says 1.0 is equal to one that says True
        if key not in self._known:
            tell = Tell()
            found = self._resolved(selector, tell)
            if not len(found):
                raise nothing(self.site, selector)
            self._known[key] = Step(selector, tell, found)
        if key not in self._told:
            self._told.add(key)
            self.steps.append(self._known[key])
        return self._known[key].found

    def one(self, selector: s.Selector) -> Spots:
        """What the selector leaves, where that is to be one place."""
        found = self.spots(selector)
        if len(found) > 1:
            raise PlaceError(
                message(
                    "{count} places are meant by '{selector}' where one is needed",
                    count=len(found),
                    selector=short(say_selector(selector), 160),
                ),
                where=self.site.name,
                advice=message(
                    "name one of them: {places}", places=listed([p.id for p in found.keep(slice(9)).places])
                ),
            )
        return found

    def _resolved(self, selector: s.Selector, tell: Tell) -> Spots:
        match selector:
            case s.Trees() | s.TreeIs() | s.Marker() | s.GateIs() | s.Here() | s.Bound() | s.Union():
                return self._source(selector)
            case s.AlongRow(origin=origin):
                return hand.along_row(self.one(origin), selector, tell)
            case s.Across(origin=origin):
                return hand.across(self.one(origin), selector, tell)
            case s.PointsIn():
                return points.points_in(self.site, selector, tell)
        of = self.spots(selector.of)
        tell.candidates = len(of)
        match selector:
            case s.Half() | s.Quarter() | s.Edge() | s.AmongExtreme() | s.InZone() | s.InBlock() | s.Within():
                return self._region(selector, of, tell)
            case s.Where() | s.Other() | s.Excluding() | s.Rows() | s.RowOf() | s.InRow() | s.EveryNth():
                return self._kept(selector, of, tell)
            case s.First() | s.Last() | s.Corners():
                return self._named(selector, of, tell)
            case s.Extreme() | s.Middle() | s.EdgeMiddle() | s.Nearest() | s.Farthest() | s.Top():
                return self._ranked(selector, of, tell)
            case s.Adjacent() | s.Take() | s.Random() | s.Spread() | s.Successive():
                return self._chained(selector, of, tell)
            case s.Ordered():
                return ordering.ordered(of, selector, np.array(self.context.here.xy), tell)
            case s.Nth(nth=number):
                found = ordering.nth(of, number)
                if not len(found):
                    raise too_few(self.site, selector.of, abs(number), len(of))
                return found
            case s.Apart():
                return apart(of.once(selector.count), selector, tell)
            case s.Spaced(near=near):
                return points.spaced(of, self._origin(near), selector, tell)

    def _source(self, selector: _Source) -> Spots:
        match selector:
            case s.Trees():
                return Spots.all_trees(self.site)
            case s.TreeIs(tree=tree):
                if tree not in self.site.by_id:
                    raise no_such_tree(self.site, tree)
                return Spots.of(self.site, [self.site.by_id[tree].place])
            case s.Marker(name=name):
                return Spots.of(self.site, [self._marker(name)])
            case s.GateIs(gate=name):
                return Spots.of(self.site, [self._gate(name)])
            case s.Here():
                return Spots.of(self.site, [self.context.here])
            case s.Bound(label=label):
                places = self.context.bound.get(label, ())
                if not places:
                    known = listed(list(self.context.bound)) or message("nothing yet")
                    raise PlaceError(
                        message("nothing is called '{label}' at this point", label=short(label)),
                        advice=message("named so far: {known}", known=known),
                    )
                return Spots.of(self.site, places)
            case s.Union(parts=parts):
                if not parts:
                    raise nothing(self.site, selector, "it has no parts")
                return joined(self.site, [self.spots(part) for part in parts])

    def _region(self, selector: _Region, of: Spots, tell: Tell) -> Spots:
        match selector:
            case s.Half(side=side):
                tell.rule = _EXTENT_RULE
                return extent.half(of, side, self._ground(selector.of, of))
            case s.Quarter(quarter=name):
                tell.rule = _EXTENT_RULE
                return extent.quarter(of, name, self._ground(selector.of, of))
            case s.Edge(side=side):
                tell.rule = "no tree beside them stands farther out"
                return extent.edge(of, side, self._ground(selector.of, of))
            case s.AmongExtreme(side=side):
                return extent.among_extreme(of, side, tell)
            case s.InZone():
                return self._in_zone(selector, of, tell)
            case s.InBlock():
                return self._in_block(selector, of, tell)
            case s.Within(distance_m=distance):
                if not (math.isfinite(distance) and distance > 0):
                    raise PlaceError(
                        message("a distance of {distance} m holds no tree", distance=Number(f"{distance:g}")),
                        advice=message("ask for more than 0 m"),
                    )
                to = self._origin(selector.to)
                return neighbours.within(neighbours.apart_from(of, to), to, distance)

    def _kept(self, selector: _Kept, of: Spots, tell: Tell) -> Spots:
        match selector:
            case s.Where():
                return attributes.where(of, selector, tell)
            case s.Other():
                return of.without(self._visited())
            case s.Excluding(places=places):
                return of.without(self.spots(places))
            case s.Rows():
                return byrow.in_rows(of, selector, self._ground(selector.of, of), tell)
            case s.RowOf(origin=origin):
                return byrow.row_of(of, self.spots(origin), selector, tell)
            case s.InRow():
                return byrow.in_row(of, selector, tell)
            case s.EveryNth():
                return byrow.every_nth(of, selector, tell)

    def _named(self, selector: s.First | s.Last | s.Corners, of: Spots, tell: Tell) -> Spots:
        match selector:
            case s.First() | s.Last():
                end = "start" if isinstance(selector, s.First) else "end"
                marker = self.site.markers.get(end)
                if marker is not None:
                    tell.rule = f"that is the tree nearest to the {end} marker"
                    away = neighbours.distance_to(of, Spots.of(self.site, [marker]))
                    return rank(of, away, 1, tell, the_nearest_to_marker(end))
                order = of.file_order
                tell.rule = f"the site has no {end} marker, so the file's order counts"
                return of.keep([int(order.argmin() if isinstance(selector, s.First) else order.argmax())])
            case s.Corners(which=which):
                if not which:
                    raise nothing(self.site, selector, "it names no corner")
                tell.rule = "corners are those of the smallest rectangle around the trees"
                return extent.corners(of, which, self._ground(selector.of, of, picks_too=False))

    def _ranked(self, selector: _Ranked, of: Spots, tell: Tell) -> Spots:
        """The first few by one measure."""
        candidates, to = self._candidates(selector, of)
        tell.candidates = len(candidates)
        count = selector.count
        if count < 1 or len(candidates) < count:
            raise too_few(self.site, selector, count, len(candidates))
        match selector:
            case s.Extreme(side=side):
                inward = -extent.outward(candidates.xy, side)
                return rank(candidates, inward, count, tell, the_most(f"{side}ernmost"))
            case s.Middle():
                away = extent.from_centre(candidates, self._ground(selector.of, of, picks_too=False))
                return rank(candidates, away, count, tell, message("the nearest to the middle"))
            case s.EdgeMiddle(side=side):
                away = extent.from_edge_middle(candidates, side, self._ground(selector.of, of))
                return rank(candidates, away, count, tell, the_middle_of_edge(side))
            case s.Nearest(adjacent=True, side="any"):
                tell.rule = "of the nearest ones those in the same row come first"
                return neighbours.next_to(candidates, to, count)
            case s.Nearest() | s.Farthest():
                away, far = neighbours.distance_to(candidates, to), isinstance(selector, s.Farthest)
                most = the_most("farthest" if far else "nearest")
                return rank(candidates, -away if far else away, count, tell, most)
            case s.Top(attribute=name, lowest=lowest):
                known, numbers = attributes.with_number(candidates, selector)
                attributes.tell_lacking(len(of) - len(known), name, tell)
                return rank(known, numbers, count, tell, the_highest(name, lowest=lowest))

    def _candidates(self, selector: _Ranked, of: Spots) -> tuple[Spots, Origin]:
        """What may be chosen from, and what it is measured from (of no meaning where it is not)."""
        match selector:
            case s.Nearest(to=origin) | s.Farthest(origin=origin):
                to = self._origin(origin)
                left = neighbours.apart_from(of, to).once(selector.count if selector.count > 1 else len(of))
                if isinstance(selector, s.Nearest):
                    left = left.without(self._visited()) if selector.fresh else left
                    if selector.side != "any":
                        left = neighbours.on_side(left, to, selector.side, next_to=selector.adjacent)
                return left, to
            case s.EdgeMiddle(side=side):
                return extent.edge(of, side, self._ground(selector.of, of)), of
            case s.Top():
                return attributes.with_number(of, selector)[0], of
            case _:
                return of, of

    def _chained(self, selector: _Chained, of: Spots, tell: Tell) -> Spots:
        """Several, each of which hangs on the ones before, or on the draw."""
        near = of if isinstance(selector, s.Take | s.Random | s.Spread) else self._origin(selector.near)
        count = selector.count
        if isinstance(selector, s.Take | s.Random | s.Spread):
            of = self._outside_keep_outs(of, tell).once(count)
        if count < 1 or len(of) < count:
            raise too_few(self.site, selector, count, len(of))
        match selector:
            case s.Take():
                tell.rule = "from the place in hand to the nearest, from there to the next nearest"
                return neighbours.short_drive(of, np.array(self.context.here.xy), count)
            case s.Random(seed=seed):
                return draw.drawn(of, count, seed, tell)
            case s.Spread():
                return spread(of, count, tell)
            case s.Adjacent():
                tell.rule = "each is a neighbour of one before it, in the same row first"
                found = neighbours.side_by_side(of, near, count)
            case s.Successive():
                found = hand.successive(of, near, selector, tell)
        if len(found) < count:
            there_are = len(found) if isinstance(selector, s.Adjacent) else hand.longest_run(of)
            raise too_few(self.site, selector, count, there_are)
        return found

    def _origin(self, selector: s.Selector) -> Origin:
        """Return what distances are measured from: the zone itself where a selector is all trees of one."""
        zones = self._zones(s.zone_itself(selector))
        return Ground(site=self.site, area=shapely.union_all(zones)) if zones else self.spots(selector)

    def _outside_keep_outs(self, of: Spots, tell: Tell) -> Spots:
        """Where any of them will do, those that no robot may drive to are passed over."""
        closed = np.zeros(len(of), dtype=bool)
        for zone in self.site.zones_of("keep_out"):
            shapely.prepare(zone.polygon)
            closed |= shapely.contains_xy(zone.polygon, of.xy[:, 0], of.xy[:, 1])
        if closed.any():
            tell_passed_over(int(closed.sum()), tell)
        return of.keep(~closed)

    def _marker(self, name: str) -> Place:
        """A missing start is the first tree of the file, a missing end is the start; a charger has no stand-in."""
        if name in self.site.markers:
            return self.site.markers[name]
        if name == "charger":
            raise PlaceError(
                message("the site has no charger"),
                where=self.site.name,
                advice=message('add a point of "kind": "charger" to its file'),
            )
        return self.site.start if name == "start" else self.site.home("return_to_end", self.context.here)

    def _gate(self, name: str) -> Place:
        """Return the gate of that name, whatever its case, hyphens and underscores."""
        alike = [g.place for g in self.site.gates if phrase(g.place.id) == phrase(name)]
        exact = [place for place in alike if place.id == name]
        if not alike:
            raise no_such_gate(self.site, name)
        return (exact or alike)[0]

    def _in_zone(self, selector: s.InZone, of: Spots, tell: Tell) -> Spots:
        """By the zones of that name; where there are none, by the block of that name."""
        if not (math.isfinite(selector.margin_m) and selector.margin_m >= 0):
            raise PlaceError(
                message("no tree is {metres} m from a zone", metres=Number(f"{selector.margin_m:g}")),
                advice=message("give a margin of 0 m or more"),
            )
        inside = self._inside(selector.zone, of, selector.margin_m)
        if inside is None:
            if byrow.find_block(self.site, selector.zone) is None:
                raise no_such_zone(self.site, selector.zone)
            if selector.margin_m:
                raise PlaceError(
                    message("distances are not measured from the block '{zone}'", zone=short(selector.zone)),
                    where=self.site.name,
                    advice=message("name a zone, a tree or a marker to measure from"),
                )
            tell.rule = "that is a block of the site"
            inside = byrow.in_block(of, s.InBlock(block=selector.zone))
        return of.without(inside) if selector.outside else inside

    def _in_block(self, selector: s.InBlock, of: Spots, tell: Tell) -> Spots:
        """By the block of that name; where there is none, by the zones of that name."""
        if byrow.find_block(self.site, selector.block) is not None:
            return byrow.in_block(of, selector)
        inside = self._inside(selector.block, of)
        if inside is None:
            raise no_such_block(self.site, selector.block)
        tell.rule = "that is a zone of the site"
        return inside

    def _inside(self, name: str, of: Spots, margin_m: float = 0.0) -> Spots | None:
        """Return those inside the zones of that name or so near to one; None where there are none."""
        zones = self._zones(name)
        if not zones:
            return None
        inside = np.zeros(len(of), dtype=bool)
        for zone in zones:
            shapely.prepare(zone)
            if margin_m:
                inside |= shapely.dwithin(zone, shapely.points(of.xy), margin_m)
            else:
                inside |= shapely.intersects_xy(zone, of.xy[:, 0], of.xy[:, 1])
        return of.keep(inside)

    def _zones(self, name: str) -> list[BaseGeometry]:
        """Return the outlines of the zones of that name, whatever its case, hyphens and underscores."""
        zones = [z for z in self.site.zones if name and phrase(z.name) == phrase(name)]
        return [z.polygon for z in [z for z in zones if z.name == name] or zones]

    def _visited(self) -> Spots:
        known = [self.site.by_id[t].index for t in self.context.visited if t in self.site.by_id]
        return Spots(site=self.site, index=np.array(known, dtype=np.intp))

    def _ground(self, selector: s.Selector, of: Spots, *, picks_too: bool = True) -> Spots:
        """The group whose extent counts: ``of`` before visited trees (and attributes and picks) are taken out."""
        bare = bare_ground(selector, picks_too=picks_too)
        return of if bare == selector else Resolution(self.site, self.context, self._known).spots(bare)
