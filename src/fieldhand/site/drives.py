"""Shortest drives between places: along aisles, over headlands and around keep-outs.

The robot keeps its clearance from tree lines, keep-outs and the boundary, and never crosses the line through the trees
of a row. It works on a tree from the aisle beside it. Near a place that is itself closer to an obstacle than the
clearance (a marker beside a pond) the clearance is reduced; keep-outs are never entered.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Point

from fieldhand.errors import DriveFault
from fieldhand.language import message
from fieldhand.language.words import listed, say_marker, say_number, say_side, say_tree
from fieldhand.site.bearings import ahead_of, apart_deg, bearing_of, heading_along, last_heading
from fieldhand.site.driving.lane_choice import RowVisits, choose_lanes, pick_candidate
from fieldhand.site.driving.layout import Layout, Spot
from fieldhand.site.driving.network import DrivableNetwork, network_of
from fieldhand.site.driving.reasons import cut_off, no_stand
from fieldhand.site.driving.roadmap import Roadmap, roadmap_of
from fieldhand.site.driving.stands import Candidate, StandCandidates
from fieldhand.site.model import Place, Site

if TYPE_CHECKING:
    from fieldhand.site.closed_ground import ClosedGround

XY = tuple[float, float]
DriveKey = tuple[tuple[str, str, str], XY, XY | None]

#: Number of drives that are kept; guards look again and again at the drives between the stops that remain.
_MOST_DRIVES = 20_000


@dataclass(frozen=True)
class Drive:
    """A path from one place to another.

    Attributes:
        points: Metres east and north, from the stand of the first place to that of the last; at least two.
        length_m: Length of the path in metres.
        start, end: The places, each with its stand.
    """

    points: tuple[XY, ...]
    length_m: float
    start: Place
    end: Place

    def at(self, metres: float) -> XY:
        """Return the point at a distance along the path; distances outside the path give its ends."""
        left = metres
        for (x0, y0), (x1, y1) in zip(self.points, self.points[1:], strict=False):
            step = float(np.hypot(x1 - x0, y1 - y0))
            if left < step:
                part = max(left, 0.0) / step
                return (x0 + part * (x1 - x0), y0 + part * (y1 - y0))
            left -= step
        return self.points[-1]


class Drives:
    """Paths between the places of one site, cached.

    Args:
        site: Site with rows, keep-outs, boundaries and gates.
        clearance_m: Distance to keep from tree lines, keep-outs and the boundary in metres: half the robot's width.
        standoff_m: Distance in metres from a tree to the robot working on it; less if the middle of the aisle is
            nearer.
        closed: Ground that the mission keeps out of. The robot's stands and the obstacles of rows are those without it.
    """

    def __init__(
        self, site: Site, clearance_m: float, standoff_m: float = 0.0, *, closed: Sequence[ClosedGround] = ()
    ) -> None:
        self.site = site
        self.standoff_m = standoff_m
        self.clearance_m = clearance_m
        self.closed = tuple(closed)
        self.layout = Layout(site, clearance_m, standoff_m, closed)
        self._whole_layout = Layout(site, clearance_m, standoff_m) if closed else self.layout
        self._stands = StandCandidates(site, self._whole_layout, clearance_m, standoff_m)
        self._others: dict[tuple[ClosedGround, ...], Drives] = {}
        self._ables: dict[DriveKey, list[Candidate]] = {}
        self._closed: dict[DriveKey, str] = {}
        self._problems: dict[DriveKey, str] = {}
        self._ways: dict[tuple[XY, XY], tuple[tuple[XY, ...], float] | None] = {}
        self._drives: dict[tuple[Place, XY | None, Place, XY | None], Drive] = {}
        self._axes: dict[DriveKey, float | None] = {}

    # --- drives -----------------------------------------------------------------------------------------------

    def between(self, a: Place, b: Place) -> Drive:
        """Return the shortest path from ``a`` to ``b``; the path from ``b`` to ``a`` is the same, reversed.

        A stand that is not chosen yet is chosen so that this path is short.

        Raises:
            DriveFault: A place cannot be reached, or no path connects them.
        """
        key = (a, a.stand, b, b.stand)
        known = self._drives.get(key)
        if known is None:
            if len(self._drives) >= _MOST_DRIVES:
                self._drives.clear()
            known = self._drives[key] = self._shortest(a, b)
        return known

    def _shortest(self, a: Place, b: Place) -> Drive:
        self._check((a, b))
        if a.stand is None and b.stand is None and a == b:
            a = b = self.stands((a,))[0]
        best: tuple[tuple[XY, ...], float] | None = None
        for one in self._able(a):
            for two in self._able(b):
                way = self._way(one.xy, two.xy)
                if way is not None and (best is None or way[1] < best[1] - 1e-9):
                    best = way
        if best is None:
            raise self._no_way(a, b)
        points, length = best
        return Drive(points, length, replace(a, stand=points[0]), replace(b, stand=points[-1]))

    def lengths(self, places: Sequence[Place], to: Sequence[Place] | None = None) -> NDArray[np.float64]:
        """Return the path lengths in metres from each of the places to each of those in ``to``, shape (n, m).

        Without ``to``, return the lengths between all pairs of the places: shape (n, n), symmetric, 0 on the diagonal.
        Lengths are measured between stands; missing stands are chosen together, as in :meth:`stands`.

        Raises:
            DriveFault: As :meth:`between`, for any two of them.
        """
        others = () if to is None else to
        standing = self.stands([*places, *others])
        self._check(standing)
        xy = [p.stand or p.xy for p in standing]
        one, two = xy[: len(places)], xy[len(places) :] if to is not None else xy
        if not self.layout.open:
            at, there = np.array(one).reshape(-1, 2), np.array(two).reshape(-1, 2)
            return np.asarray(np.hypot(*(at[:, None, :] - there[None, :, :]).transpose(2, 0, 1)))
        lengths = self.layout.lengths(self.layout.spots(one), None if to is None else self.layout.spots(two))
        if np.isinf(lengths).any():
            i, j = np.argwhere(np.isinf(lengths))[0].tolist()
            raise self._no_way(places[i], (places if to is None else to)[j])
        return lengths

    def way_between(self, one: XY, two: XY) -> tuple[tuple[XY, ...], float] | None:
        """Return the points and the length of the shortest path between two points; None if there is none."""
        return self._way(one, two)

    def point_lengths(self, points: Sequence[XY]) -> NDArray[np.float64]:
        """Return the path lengths in metres between all pairs of points, shape (n, n); inf where there is no path."""
        if not self.layout.open:
            at = np.array(points).reshape(-1, 2)
            return np.asarray(np.hypot(*(at[:, None, :] - at[None, :, :]).transpose(2, 0, 1)))
        return self.layout.lengths(self.layout.spots(list(points)))

    def sides(self, trees: Sequence[Place]) -> list[tuple[Candidate, ...]]:
        """Return the stands of trees of rows on either side, first that of lesser v (:class:`Frame`), as far as known.

        A tree in no row, and on a site without rows any tree, has one stand. ``why_not`` says why one is not usable.
        """
        bare = [replace(tree, stand=None) for tree in trees]
        options = self._stands.of_all(bare)
        free = iter(self.layout.are_free(np.array([c.xy for o in options for c in o]).reshape(-1, 2)).tolist())
        blocked = message("a keep-out or the boundary is in the way")
        return [
            tuple(c if next(free) or c.why_not else replace(c, why_not=blocked) for c in option) for option in options
        ]

    def are_straight(self, places: Sequence[Place]) -> bool:
        """Return True if every path between the stands of the places is a straight line."""
        return not self.layout.open or self.layout.is_one_view(self.layout.spots([p.stand or p.xy for p in places]))

    def roadmap(self, places: Sequence[Place]) -> Roadmap:
        """Return the paths between many places as a sparse graph, whose size grows linearly with their number.

        Paths run between stands; missing stands are chosen as in :meth:`stands`. Shortest paths in the graph are never
        shorter than :meth:`lengths`, and slightly longer where they pass other places.

        Raises:
            DriveFault: As :meth:`between`, for any two of them.
        """
        standing = self.stands(places)
        self._check(standing)
        roadmap = roadmap_of(self.layout, standing)
        if (other := roadmap.cut_off()) is not None:
            raise self._no_way(places[0], places[other])
        return roadmap

    # --- stands -----------------------------------------------------------------------------------------------

    def stands(self, places: Sequence[Place], here: Place | None = None) -> tuple[Place, ...]:
        """Return the places with a stand each; existing stands are kept.

        The stands of trees are chosen together, so that few aisles are needed to visit them: for each row the side that
        shares an aisle with the next row, and among equal numbers of aisles the side nearest to ``here`` (else to the
        start). A single tree gets the stand nearest to ``here``.
        """
        if all(p.stand is not None for p in places):
            return tuple(places)
        origin = self._origin(here)
        options = self._stands.of_all(places)
        metres = self._metres(places, options, origin)
        rows: dict[tuple[int, int], RowVisits] = {}
        keys = [self._row_of(place, candidates) for place, candidates in zip(places, options, strict=True)]
        for key, candidates, away in zip(keys, options, metres, strict=True):
            if key is not None:
                lanes = [c.lane for c in candidates]
                row = rows.setdefault(key, RowVisits(lanes[0], lanes[-1]))  # type: ignore[arg-type]
                row.visits.append(
                    {c.lane: (c, m) for c, m in zip(candidates, away, strict=True) if c.lane and np.isfinite(m)}
                )
        used = frozenset(lane for p in places if p.stand is not None and (lane := self._lane_at(p.stand)) is not None)
        preferred = choose_lanes(rows, used)
        return tuple(
            replace(place, stand=pick_candidate(candidates, None if key is None else preferred.get(key), away).xy)
            for place, key, candidates, away in zip(places, keys, options, metres, strict=True)
        )

    @staticmethod
    def _row_of(place: Place, candidates: Sequence[Candidate]) -> tuple[int, int] | None:
        """Return the group and the line of a tree whose stand is to be chosen, else None."""
        if place.stand is not None or len(candidates) < 2 or candidates[0].lane is None:
            return None
        group, _, line = candidates[0].lane
        return group, line

    def _lane_at(self, xy: XY) -> tuple[int, int, int] | None:
        aisle = self.layout.aisle(xy)
        return None if aisle is None else (aisle.group_number, aisle.position, aisle.position + 1)

    def _origin(self, here: Place | None) -> Spot:
        """Return the spot from which stands must be reachable."""
        place = here or self.site.start
        able = self._able(place) or self._stands.of(place)
        return self.layout.spot(able[0].xy)

    def _metres(
        self, places: Sequence[Place], options: Sequence[Sequence[Candidate]], origin: Spot
    ) -> list[list[float]]:
        """Return the straight-line metres from the origin to each candidate of each place; inf if it is unreachable.

        Places that already have a stand get 0.
        """
        able = [
            c
            for place, option in zip(places, options, strict=True)
            if place.stand is None
            for c in option
            if not c.why_not
        ]
        linked = self.layout.reachable(self.layout.spots([c.xy for c in able]), origin)
        away = np.hypot(*(np.array([c.xy for c in able]).reshape(-1, 2) - origin.xy).T).tolist()
        metres = {c.xy: m for c, m, is_linked in zip(able, away, linked, strict=True) if is_linked}
        return [
            [0.0 if place.stand is not None else math.inf if c.why_not else metres.get(c.xy, math.inf) for c in option]
            for place, option in zip(places, options, strict=True)
        ]

    def _able(self, place: Place) -> list[Candidate]:
        """Return the usable candidates for a place's stand."""
        return self._able_of((place,))[0]

    def _able_of(self, places: Sequence[Place]) -> list[list[Candidate]]:
        """Return the usable candidates for the stand of each place, cached."""
        new = list({_key(p): p for p in places if _key(p) not in self._ables}.values())
        if new:
            options = self._stands.of_all(new)
            able = [c.xy for option in options for c in option if not c.why_not]
            margins = [
                self.clearance_m if p.kind == "tree" else 0.0
                for p, option in zip(new, options, strict=True)
                for c in option
                if not c.why_not
            ]
            is_free = self.layout.are_free(np.array(able).reshape(-1, 2)) & ~self._is_closed(able, margins)
            free = iter(is_free.tolist())
            found = [[c for c in option if not c.why_not and next(free)] for option in options]
            self._ables.update(zip(map(_key, new), found, strict=True))
        return [self._ables[_key(p)] for p in places]

    def _is_closed(self, at: Sequence[XY], margins_m: Sequence[float]) -> NDArray[np.bool_]:
        """Return which points are nearer to closed ground than a margin each."""
        found = np.zeros(len(at), dtype=bool)
        for ground in self.closed:
            away = shapely.distance(ground.shape, shapely.points(np.array(at).reshape(-1, 2)))
            found |= away < np.array(margins_m) - 1e-6
        return found

    def network(self) -> DrivableNetwork:
        """Return aisles, headlands, gates and the links between them, as lines."""
        return network_of(self.site, self.layout)

    # --- headings ---------------------------------------------------------------------------------------------

    def axis_deg(self, place: Place) -> float | None:
        """Return the bearing of the aisle in which the robot stands at a place, in degrees clockwise from north; either
        of its two. None on open ground, and on a site without rows.
        """
        key = _key(place)
        if key not in self._axes:
            across = self._stands.across(place)
            if across is not None:
                self._axes[key] = (bearing_of((0.0, 0.0), across) + 90.0) % 360.0
            else:
                at = place.stand or place.xy
                aisle = self.layout.aisle(at)
                self._axes[key] = None if aisle is None else aisle.axis_deg(at)
        return self._axes[key]

    def row_ends(self, place: Place) -> tuple[XY, ...]:
        """Return the first and the last tree of the row of a tree or gap; empty for a place in no row."""
        return self._stands.row_ends(place)

    def heading_after(self, drive: Drive) -> float | None:
        """Return the heading at the end of a drive, in degrees clockwise from north: along the aisle in which it ends,
        in the direction of driving, and on open ground that of its last leg; None if the robot does not move.
        """
        if last_heading(drive.points) is None:
            return None
        axis = self.axis_deg(drive.end)
        return last_heading(drive.points) if axis is None else heading_along(axis, drive.points)

    def arriving(self, a: Place, b: Place, side: str) -> Drive:
        """Return the shortest drive from ``a`` on whose end a tree of a row is on the left or the right of the robot,
        which comes in from the end of the row from which it is; :meth:`between` if there is none.

        The robot turns round where the drive does: its turning circle is not considered.

        Raises:
            DriveFault: As :meth:`between`.
        """
        plain = self.between(a, b)
        ends, best = self._stands.row_ends(b), None
        for stand in () if math.dist(*plain.points[-2:]) == 0.0 else self._able(b):
            end = replace(b, stand=stand.xy)
            axis = self.axis_deg(end)
            if axis is None or not ends or math.dist(stand.xy, b.xy) < self.clearance_m / 2.0:
                continue
            to_tree = bearing_of(stand.xy, b.xy) + (90.0 if side == "left" else -90.0)
            heading = axis if apart_deg(axis, to_tree) < 90.0 else (axis + 180.0) % 360.0
            way = self._arriving(a, end, heading, ends)
            if way is not None and (best is None or way.length_m < best.length_m - 1e-9):
                best = way
        return best or plain

    def _arriving(self, a: Place, end: Place, heading: float, ends: Sequence[XY]) -> Drive | None:
        """Return the drive to a stand that ends in a heading: the shortest one, or one from the end of the row."""
        direct = self.between(a, end)
        if self._ends_in(direct, heading):
            return direct
        stand, one = end.stand or end.xy, min(ends, key=lambda xy: _along(xy, heading))
        beside = (one[0] + stand[0] - end.x, one[1] + stand[1] - end.y)
        for metres in (max(self.standoff_m, 2.0 * self.clearance_m), self.clearance_m, 0.0):
            turn = ahead_of(beside, heading, -metres)
            if not self.layout.are_free(np.array([turn]))[0]:
                continue
            there, in_ = self._way(direct.start.stand or direct.start.xy, turn), self._way(turn, stand)
            if there is None or in_ is None:
                continue
            way = Drive((*there[0], *in_[0][1:]), there[1] + in_[1], direct.start, end)
            if self._ends_in(way, heading):
                return way
        return None

    def _ends_in(self, drive: Drive, heading: float) -> bool:
        ending = self.heading_after(drive)
        return ending is not None and apart_deg(ending, heading) < 90.0

    # --- unreachable places -----------------------------------------------------------------------------------

    def problem(self, place: Place) -> str:
        """Return the reason why a place can never be reached, worded to follow "tree 17 is"; empty if it can.

        Examples: "inside the keep-out 'pond'", "outside the boundary", "out of reach: the aisles beside it are 0.5 m
        wide, the robot is 0.67 m", "cut off from where the robot starts".
        """
        return self.problems((place,))[0]

    def problems(self, places: Sequence[Place]) -> tuple[str, ...]:
        """Return :meth:`problem` for each of the places; much faster than separate calls."""
        new = list({_key(p): p for p in places if _key(p) not in self._problems}.values())
        if new:
            reasons = self._impossible(new)
            possible = [p for p, reason in zip(new, reasons, strict=True) if not reason]
            cut = iter(self._cut_off(possible))
            self._problems.update((_key(p), reason or next(cut)) for p, reason in zip(new, reasons, strict=True))
        return tuple(self._problems[_key(p)] for p in places)

    def reachable(self, places: Sequence[Place], here: Place) -> tuple[bool, ...]:
        """Return for each place True if at least one of its stands can be reached from here."""
        able = [[] if bad else c for bad, c in zip(self._impossible(places), self._able_of(places), strict=True)]
        spots = self.layout.spots([c.xy for some in able for c in some])
        linked = iter(self.layout.reachable(spots, self._origin(here)))
        return tuple(any([next(linked) for _ in some]) for some in able)  # noqa: C419 - each has its turn

    def _impossible(self, places: Sequence[Place]) -> list[str]:
        """Return for each place why a robot can never be there, wherever it comes from; empty if it can. Cached."""
        new = list({_key(p): p for p in places if _key(p) not in self._closed}.values())
        if new:
            at = np.array([self._bounded_point(p) for p in new])
            outside = np.full(len(new), bool(boundaries := self.site.zones_of("boundary")))
            for zone in boundaries:
                outside &= ~shapely.intersects_xy(zone.polygon, at[:, 0], at[:, 1])
            reasons = [message("outside the boundary", context="log") if out else "" for out in outside.tolist()]
            for zone in reversed(self.site.zones_of("keep_out")):
                for k in np.flatnonzero(shapely.contains_xy(zone.polygon, at[:, 0], at[:, 1])).tolist():
                    reasons[k] = message("inside the keep-out '{zone}'", context="log", zone=zone.name)
            for place, reason, able in zip(new, reasons, self._able_of(new), strict=True):
                self._closed[_key(place)] = reason or ("" if able else self._no_stand(place))
        return [self._closed[_key(p)] for p in places]

    def _bounded_point(self, place: Place) -> XY:
        """Return the point that must be inside the boundary: the place, or the stand of a gate (on the fence)."""
        is_gate = any(gate.place == place for gate in self.site.gates)
        return self._stands.of(place)[0].xy if is_gate else place.xy

    def _no_stand(self, place: Place) -> str:
        candidates = self._stands.of(place)
        if why := self._closed_stands(place, candidates):
            return why
        if candidates[0].why_not:
            return no_stand(candidates, 2.0 * self.clearance_m)
        return message(
            "out of reach: {obstacle} is in the way",
            obstacle=self.layout.in_the_way(candidates[0].xy) or message("a fence"),
        )

    def _closed_stands(self, place: Place, candidates: Sequence[Candidate]) -> str:
        """Return the reason why a place is closed to the mission; empty if it could not be reached anyway."""
        stands = [c.xy for c in candidates if not c.why_not]
        stands = [xy for xy in stands if self._whole_layout.are_free(np.array([xy]))[0]]
        margin = self.clearance_m if place.kind == "tree" else 0.0
        closing = [
            [ground for ground in self.closed if ground.shape.distance(Point(xy)) < max(margin - 1e-6, 1e-9)]
            for xy in stands
        ]
        if not closing or not all(closing):
            return ""
        every = [ground for ground in closing[0] if all(ground in some for some in closing)]
        tree = self.site.by_id.get(place.id) if place.kind == "tree" else None
        for ground in every:
            if (tree is not None and tree.index in ground.trees) or ground.shape.intersects(Point(place.xy)):
                return message("{inside}, where the robot must not drive", inside=ground.inside)
        return _out_of_reach(every[:1] or [some[0] for some in closing])

    def _closed_ways(self, places: Sequence[Place]) -> list[str]:
        """Return for places that are cut off the reason if closed ground is why; empty if they are anyway."""
        reasons = []
        for place, anyway in zip(places, self._with(()).problems(places), strict=True):
            alone = (one for one in self.closed if self._with((one,)).problem(place)) if len(self.closed) > 1 else ()
            closing = list(itertools.islice(alone, 1)) or self.closed
            reasons.append("" if anyway else _out_of_reach(closing))
        return reasons

    def _with(self, closed: tuple[ClosedGround, ...]) -> Drives:
        """Return drives with other closed ground, cached."""
        if closed not in self._others:
            self._others[closed] = Drives(self.site, self.clearance_m, self.standoff_m, closed=closed)
        return self._others[closed]

    def _cut_off(self, places: Sequence[Place]) -> list[str]:
        """Return for each place why no path from the robot's start leads to it; empty if one does."""
        if not self.layout.open or self._impossible((self.site.start,))[0]:
            return [""] * len(places)
        start = self._origin(None)
        able = self._able_of(places)
        linked = iter(self.layout.reachable(self.layout.spots([c.xy for cs in able for c in cs]), start))
        reached = [any([next(linked) for _ in candidates]) for candidates in able]  # noqa: C419 - each has its turn
        cut = [place for place, reach in zip(places, reached, strict=True) if not reach]
        closed = dict(zip(map(_key, cut), self._closed_ways(cut) if self.closed else [""] * len(cut), strict=True))
        return [
            ""
            if reach
            else closed[_key(place)] or cut_off(self.layout, self.layout.spots([c.xy for c in candidates]), start)
            for place, reach, candidates in zip(places, reached, able, strict=True)
        ]

    def _way(self, one: XY, two: XY) -> tuple[tuple[XY, ...], float] | None:
        key = (min(one, two), max(one, two))
        if key not in self._ways:
            self._ways[key] = self._find(*key)
        found = self._ways[key]
        if found is None or one == key[0]:
            return found
        return found[0][::-1], found[1]

    def _find(self, one: XY, two: XY) -> tuple[tuple[XY, ...], float] | None:
        points: tuple[XY, ...] | None = (one, two)
        if self.layout.open and one != two:
            points = self.layout.way(self.layout.spot(one), self.layout.spot(two))
        if points is None:
            return None
        steps = np.diff(np.array(points), axis=0)
        return points, float(np.hypot(steps[:, 0], steps[:, 1]).sum())

    def _check(self, places: Sequence[Place]) -> None:
        for place, reason in zip(places, self._impossible(places), strict=True):
            if reason:
                raise DriveFault(
                    message("{place} is {reason}", context="log", place=_called(place), reason=reason),
                    where=self.site.name,
                    advice=message("choose another place, or correct the site"),
                )

    def _no_way(self, a: Place, b: Place) -> DriveFault:
        way = message(
            "there is no way from {start} to {goal} for a robot {width} m wide",
            context="log",
            start=_called(a),
            goal=_called(b),
            width=say_number(2 * self.clearance_m),
        )
        why = next((message("{place} is {reason}", context="log", place=_called(p), reason=reason) for p in (b, a)
                    if (reason := self._cut_off((p,))[0])), "")  # fmt: skip
        return DriveFault(
            message("{what}: {why}", what=way, why=why) if why else way,
            where=self.site.name,
            advice=message("keep-outs, rows or the boundary block every way; choose other places"),
        )


def _key(place: Place) -> DriveKey:
    return place.key, place.xy, place.stand


def _along(xy: XY, heading_deg: float) -> float:
    """Return how far a point lies in a direction, in metres."""
    heading = math.radians(heading_deg)
    return xy[0] * math.sin(heading) + xy[1] * math.cos(heading)


def _out_of_reach(closed: Sequence[ClosedGround]) -> str:
    """Return the reason why a place that the mission's own rules close cannot be reached."""
    rules = listed(tuple(dict.fromkeys(ground.rule for ground in closed)))
    return message("out of reach: the robot must {rules}", rules=rules)


def _called(place: Place) -> str:
    if place.kind == "tree":
        return say_side(place.id, place.side) if place.side else say_tree(place.id)
    return say_marker(place.id) if place.kind == "marker" else place.id
