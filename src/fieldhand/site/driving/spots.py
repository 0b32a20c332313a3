"""Where points of a site lie: in which aisle, beside which rows, on open ground; and what ways they reach."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from fieldhand.site.driving.access import Access
from fieldhand.site.driving.aisles import Aisle
from fieldhand.site.driving.bodies import Body
from fieldhand.site.driving.free import Free
from fieldhand.site.driving.graph import Indices, Links, Points
from fieldhand.site.driving.ground import XY, Ground


@dataclass(frozen=True, kw_only=True, eq=False)
class Spot:
    """A point of the site, with how the ways of the site are reached from it.

    Attributes:
        xy: Metres east and north.
        aisle: In which it lies, with ``uv`` in the frame of its rows; None on open ground.
        within: The nodes of the site's graph that it reaches in its aisle.
        ground, foot: The open ground and where on it the spot begins; no foot in an aisle.
        spur: Metres straight from the spot to its foot: beside an outer row the outline is reached first.
    """

    xy: XY
    aisle: Aisle | None = None
    uv: Points | None = None
    within: Links
    ground: Ground
    foot: XY | None = None
    spur: float = 0.0

    @property
    def access(self) -> Access | None:
        """To open ground; None in an aisle."""
        return None if self.foot is None else self.ground.access(self.foot)

    @cached_property
    def links(self) -> Links:
        """To the nodes of the site's graph."""
        access = self.access
        if access is None:
            return self.within
        return access.links if self.spur == 0.0 else Links(access.links.nodes, access.links.metres + self.spur)


class Spots:
    """The spots of one site, remembered.

    Args:
        free: Where a robot may be.
        bodies: Of rows.
        aisles: Body after body.
        nodes_in: For each aisle its nodes of the graph, mouths and turns, with their (u, v).
        ground: The open ground around the bodies.
    """

    def __init__(
        self,
        free: Free,
        bodies: Sequence[Body],
        aisles: Sequence[Aisle],
        nodes_in: Sequence[Mapping[int, Points]],
        ground: Ground,
    ) -> None:
        self._free, self._bodies, self._aisles, self._ground = free, bodies, aisles, ground
        self._nodes_in = nodes_in
        self.outlines = shapely.STRtree([b.polygon for b in bodies])
        self._found: dict[XY, Spot] = {}

    def at(self, places: Sequence[XY]) -> list[Spot]:
        """Where these points lie and what they reach."""
        new = [xy for xy in dict.fromkeys(places) if xy not in self._found]
        if new:
            self._found.update((spot.xy, spot) for spot in self._locate(new))
        return [self._found[xy] for xy in places]

    def aisle_of(self, body: int, below: int) -> Aisle:
        """The aisle above that line of a body."""
        return self._aisles[self._first_aisle[body] + below]

    @cached_property
    def _first_aisle(self) -> list[int]:
        """Position of each body's first aisle."""
        counts = [len(b.lines) - 1 for b in self._bodies]
        return [0, *np.cumsum(counts).tolist()]

    def _locate(self, places: Sequence[XY]) -> Iterator[Spot]:
        xy = np.array(places)
        body_of = np.full(len(xy), len(self._bodies))
        points, bodies = self.outlines.query(shapely.points(xy), predicate="intersects")
        np.minimum.at(body_of, points, bodies)
        for number in np.unique(body_of).tolist():
            which = np.flatnonzero(body_of == number)
            if number < len(self._bodies):
                yield from self._in_body(number, [places[k] for k in which.tolist()], xy[which])
            else:
                yield from (self._spot(places[k], foot=places[k]) for k in which.tolist())

    def _in_body(self, number: int, places: Sequence[XY], xy: Points) -> Iterator[Spot]:
        body = self._bodies[number]
        uv = body.frame.local(xy)
        below = _lines_below(body, uv)
        for k in np.unique(below).tolist():
            which = np.flatnonzero(below == k)
            some = [places[i] for i in which.tolist()]
            if 0 < k < len(body.lines):
                yield from self._in_aisle(some, self.aisle_of(number, k - 1), uv[which])
            else:
                yield from self._beside(some, body, uv[which], low=k == 0)

    def _in_aisle(self, places: Sequence[XY], aisle: Aisle, uv: Points) -> Iterator[Spot]:
        open_ = self._spurs_are_free(aisle, uv)
        nodes = np.array(list(self._nodes_in[aisle.number]), dtype=np.intp)
        metres = np.empty((len(places), len(nodes)))
        for k, at in enumerate(self._nodes_in[aisle.number].values()):
            metres[open_, k] = aisle.metres_from(at, uv[open_])
        reached = np.isfinite(metres)
        for k, xy in enumerate(places):
            if open_[k]:
                all_of_them = bool(reached[k].all())
                links = Links(nodes, metres[k]) if all_of_them else Links(nodes[reached[k]], metres[k][reached[k]])
                yield self._spot(xy, aisle=aisle, uv=uv[k], within=links)
            else:
                yield self._spot(xy)

    def _spurs_are_free(self, aisle: Aisle, uv: Points) -> NDArray[np.bool_]:
        """Which spots near a row are not parted by a keep-out from where the robot is clear of the row."""
        if aisle.course == "closed":
            return np.zeros(len(uv), dtype=bool)
        if not self._free.bounded or aisle.course == "obstructed":
            return np.ones(len(uv), dtype=bool)
        world = aisle.body.frame.world
        return self._free.sees(world(uv), world(aisle.clear_of_rows(uv)), soft=False)

    def _beside(self, places: Sequence[XY], body: Body, uv: Points, *, low: bool) -> Iterator[Spot]:
        """Between an outer row and the outline: straight out of the body first."""
        foot_v = np.interp(uv[:, 0], *(body.low_side if low else body.high_side))
        feet = body.frame.world(np.column_stack([uv[:, 0], foot_v]))
        free = self._free.sees(np.array(places), feet, soft=False).tolist()
        spurs = np.abs(foot_v - uv[:, 1]).tolist()
        for xy, (x, y), spur, is_free in zip(places, feet.tolist(), spurs, free, strict=True):
            yield self._spot(xy, foot=(x, y), spur=spur) if is_free else self._spot(xy)

    def _spot(
        self,
        xy: XY,
        *,
        aisle: Aisle | None = None,
        uv: Points | None = None,
        within: Links | None = None,
        foot: XY | None = None,
        spur: float = 0.0,
    ) -> Spot:
        return Spot(xy=xy, aisle=aisle, uv=uv, within=within or Links.none(), ground=self._ground, foot=foot, spur=spur)


def _lines_below(body: Body, uv: Points) -> Indices:
    """How many of a body's lines each spot is above."""
    first, last = np.zeros(len(uv), dtype=np.intp), np.full(len(uv), len(body.lines), dtype=np.intp)
    while (open_ := first < last).any():
        middle = (first + last) // 2
        for k in np.unique(middle[open_]).tolist():
            line = body.lines[k]
            which = np.flatnonzero(open_ & (middle == k))
            above = uv[which, 1] >= np.interp(uv[which, 0], line.u, (line.low + line.high) / 2.0)
            first[which[above]] = k + 1
            last[which[~above]] = k
    return first
