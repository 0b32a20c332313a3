"""Drives between places: along aisles, over headlands, around keep-outs, the shortest way.

The robot keeps its clearance from tree lines, keep-outs and the boundary. It never crosses the line through the trees
of a row. A tree is worked on from the aisle beside it. Near a place that itself stands closer than the clearance (a
marker beside the pond) the clearance gives way; the keep-out itself never does.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from fieldhand.errors import DriveFault
from fieldhand.site.driving.layout import Layout, Spot
from fieldhand.site.driving.network import Network, network_of
from fieldhand.site.driving.reasons import cut_off, no_stand
from fieldhand.site.driving.sides import Visited, few_lanes, pick
from fieldhand.site.driving.stands import Candidate, Stands
from fieldhand.site.model import Place, Site

XY = tuple[float, float]


@dataclass(frozen=True)
class Drive:
    """A way from one place to another.

    Attributes:
        points: Metres east and north, from the first place's stand to the last one's; at least two.
        length_m: Metres along the points.
        start, end: The places, each with its stand.
    """

    points: tuple[XY, ...]
    length_m: float
    start: Place
    end: Place

    def at(self, metres: float) -> XY:
        """The point that many metres along the way; its ends for less than nothing and more than its length."""
        left = metres
        for (x0, y0), (x1, y1) in zip(self.points, self.points[1:], strict=False):
            step = float(np.hypot(x1 - x0, y1 - y0))
            if left < step:
                part = max(left, 0.0) / step
                return (x0 + part * (x1 - x0), y0 + part * (y1 - y0))
            left -= step
        return self.points[-1]


class Drives:
    """Ways between the places of one site, remembered.

    Args:
        site: With its rows, keep-outs, boundaries and gates.
        clearance_m: Metres to keep from tree lines, keep-outs and the boundary: half the robot's width.
        standoff_m: From a tree to where the robot stands to work on it; less where the aisle's middle is nearer.
    """

    def __init__(self, site: Site, clearance_m: float, standoff_m: float = 0.0) -> None:
        self.site = site
        self.standoff_m = standoff_m
        self.clearance_m = clearance_m
        self._layout = Layout(site, clearance_m, standoff_m)
        self._stands = Stands(site, self._layout, clearance_m, standoff_m)
        self._problems: dict[tuple[XY, XY | None], str] = {}
        self._ways: dict[tuple[XY, XY], tuple[tuple[XY, ...], float] | None] = {}

    # --- drives -----------------------------------------------------------------------------------------------

    def between(self, a: Place, b: Place) -> Drive:
        """The shortest way from ``a`` to ``b``; from ``b`` to ``a`` it is the same way back.

        Where the stand of one of them is still open, it is chosen so that this way is short.

        Raises:
            DriveFault: One of them cannot be driven to, or there is no way.
        """
        self._check((a, b))
        if a.stand is None and b.stand is None and a.xy == b.xy:
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

    def lengths(self, places: Sequence[Place]) -> NDArray[np.float64]:
        """Metres of the drive between every two of the places, shape (n, n), symmetric, 0 on the diagonal.

        Between their stands; those that are still open are chosen as :meth:`stands` does.

        Raises:
            DriveFault: As :meth:`between`, for any two of them.
        """
        if len(places) == 0:
            return np.zeros((0, 0))
        standing = self.stands(places)
        self._check(standing)
        xy = [p.stand or p.xy for p in standing]
        if not self._layout.open:
            at = np.array(xy)
            return np.asarray(np.hypot(*(at[:, None, :] - at[None, :, :]).transpose(2, 0, 1)))
        lengths = self._layout.lengths([self._layout.spot(p) for p in xy])
        if np.isinf(lengths).any():
            i, j = np.argwhere(np.isinf(lengths))[0].tolist()
            raise self._no_way(places[i], places[j])
        return lengths

    # --- stands -----------------------------------------------------------------------------------------------

    def stands(self, places: Sequence[Place], here: Place | None = None) -> tuple[Place, ...]:
        """The places, each with its stand: where it has one already, there.

        Those of trees are chosen together, so that they can be visited through few aisles: for each row the side that
        shares an aisle with the next row, and of equally few aisles those nearest to ``here`` (else to the start).
        A single tree stands where it is driven to shortest from ``here``.
        """
        if all(p.stand is not None for p in places):
            return tuple(places)
        origin = self._origin(here)
        options = [self._stands.of(p) for p in places]
        metres = [self._metres(p, c, origin) for p, c in zip(places, options, strict=True)]
        rows: dict[tuple[int, int], Visited] = {}
        for place, candidates, away in zip(places, options, metres, strict=True):
            key = self._row_of(place)
            if key is not None:
                lanes = [c.lane for c in candidates]
                row = rows.setdefault(key, Visited(lanes[0], lanes[-1]))  # type: ignore[arg-type]
                row.visits.append(
                    {c.lane: (c, m) for c, m in zip(candidates, away, strict=True) if c.lane and np.isfinite(m)}
                )
        used = frozenset(lane for p in places if p.stand is not None and (lane := self._lane_at(p.stand)) is not None)
        preferred = few_lanes(rows, used)
        found = []
        for place, candidates, away in zip(places, options, metres, strict=True):
            key = self._row_of(place)
            lane = preferred.get(key) if key is not None else None
            found.append(replace(place, stand=pick(candidates, lane, away).xy))
        return tuple(found)

    def _row_of(self, place: Place) -> tuple[int, int] | None:
        """The body and the line of a tree whose stand is open; None for all else."""
        if place.stand is not None:
            return None
        candidates = self._stands.of(place)
        if len(candidates) < 2 or candidates[0].lane is None:
            return None
        body, _, line = candidates[0].lane
        return body, line

    def _lane_at(self, xy: XY) -> tuple[int, int, int] | None:
        aisle = self._layout.spot(xy).aisle
        if aisle is None:
            return None
        below = aisle.body.lines.index(aisle.below)
        return aisle.body_number, below, below + 1

    def _origin(self, here: Place | None) -> Spot:
        """From where stands are to be reached."""
        place = here or self.site.start
        able = self._able(place) or self._stands.of(place)
        return self._layout.spot(able[0].xy)

    def _metres(self, place: Place, candidates: Sequence[Candidate], origin: Spot) -> list[float]:
        """Metres in a straight line from the origin to each candidate; inf for one that cannot be driven to."""
        if place.stand is not None:
            return [0.0]
        parts = self._layout.parts(origin)
        return [
            float(np.hypot(c.xy[0] - origin.xy[0], c.xy[1] - origin.xy[1]))
            if not c.why_not and self._connected(self._layout.spot(c.xy), origin, parts)
            else np.inf
            for c in candidates
        ]

    def _connected(self, spot: Spot, origin: Spot, parts: frozenset[int]) -> bool:
        if not self._layout.open or not parts.isdisjoint(self._layout.parts(spot)):
            return True
        return self._layout.way(spot, origin) is not None

    def _able(self, place: Place) -> list[Candidate]:
        """The candidates for a place's stand at which the robot can be."""
        able = [c for c in self._stands.of(place) if not c.why_not]
        return [c for c in able if self._layout.is_free(c.xy)]

    def network(self) -> Network:
        """Aisles, headlands, gates and the links between them, as lines."""
        return network_of(self.site, self._layout)

    # --- what cannot be driven --------------------------------------------------------------------------------

    def problem(self, place: Place) -> str:
        """Why a place can never be driven to, in words that follow "tree 17 is"; empty if it can.

        "inside the keep-out 'pond'", "outside the boundary", "out of reach: the aisles beside it are 0.5 m wide, the
        robot is 0.67 m", "out of reach: no way out of its aisle: keep-out 'pond' closes one end and the boundary the
        other", "cut off from where the robot starts".
        """
        key = (place.xy, place.stand)
        if key not in self._problems:
            self._problems[key] = self._impossible(place) or self._cut_off(place)
        return self._problems[key]

    def _impossible(self, place: Place) -> str:
        """Why a robot can never be at a place, wherever it comes from."""
        for zone in self.site.zones_of("keep_out"):
            if shapely.contains_xy(zone.polygon, place.x, place.y):
                return f"inside the keep-out {zone.name!r}"
        boundaries = self.site.zones_of("boundary")
        if boundaries and not any(shapely.intersects_xy(z.polygon, place.x, place.y) for z in boundaries):
            return "outside the boundary"
        if self._able(place):
            return ""
        candidates = self._stands.of(place)
        if candidates[0].why_not:
            return no_stand(candidates, 2.0 * self.clearance_m)
        return f"out of reach: {self._layout.in_the_way(candidates[0].xy) or 'a fence'} is there"

    def _cut_off(self, place: Place) -> str:
        """Why no way leads to a place from where the robot starts."""
        if not self._layout.open or self._impossible(self.site.start):
            return ""
        start = self._origin(None)
        parts = self._layout.parts(start)
        spots = [self._layout.spot(c.xy) for c in self._able(place)]
        if any(self._connected(spot, start, parts) for spot in spots):
            return ""
        return cut_off(self._layout, spots, start)

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
        if self._layout.open and one != two:
            points = self._layout.way(self._layout.spot(one), self._layout.spot(two))
        if points is None:
            return None
        steps = np.diff(np.array(points), axis=0)
        return points, float(np.hypot(steps[:, 0], steps[:, 1]).sum())

    def _check(self, places: Iterable[Place]) -> None:
        for place in places:
            reason = self._impossible(place)
            if reason:
                raise DriveFault(
                    f"{_called(place)} is {reason}",
                    where=self.site.name,
                    advice="choose another place, or correct the site",
                )

    def _no_way(self, a: Place, b: Place) -> DriveFault:
        why = next((f": {_called(p)} is {reason}" for p in (b, a) if (reason := self._cut_off(p))), "")
        return DriveFault(
            f"there is no way from {_called(a)} to {_called(b)} for a robot {2 * self.clearance_m:g} m wide{why}",
            where=self.site.name,
            advice="keep-outs, rows or the boundary close it off; choose other places",
        )


def _called(place: Place) -> str:
    return {"tree": f"tree {place.id}", "marker": f"the {place.id} marker"}.get(place.kind, place.id)
