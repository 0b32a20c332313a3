"""Where a robot stands to be at a tree: in the aisle beside it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from scipy.spatial import cKDTree

from fieldhand.site.driving.aisles import Aisle
from fieldhand.site.driving.bodies import tree_lines
from fieldhand.site.driving.graph import Points
from fieldhand.site.driving.ground import XY
from fieldhand.site.driving.layout import Layout
from fieldhand.site.model import Place, Site

#: The direction of a bent row at a tree is that between the trees so many places before and after it.
_ALONG = 3

#: A stand that is not clear of what stands about is looked for at so many points nearer to the tree.
_NEARER = 6

#: Directions from which a tree in no row may be approached.
_DIRECTIONS = 16


@dataclass(frozen=True)
class Candidate:
    """A stand for a tree.

    Attributes:
        lane: Stands beside one row on one side, or in one aisle, have the same: (body, line, line) of the aisle, the
            second line -1 or one past the last on the outer side of an outer row.
        why_not: Why the robot cannot stand there; empty if it can.
        aisle_m: Width of the aisle there, where that is why.
    """

    xy: XY
    lane: tuple[int, int, int] | None = None
    why_not: str = ""
    aisle_m: float | None = None


class Stands:
    """Candidates for the stands of a site's trees.

    Args:
        site: The site.
        layout: Its open ground and aisles.
        clearance_m: Half the robot's width.
        standoff_m: From a tree to its stand, where the aisle is wide enough.
    """

    def __init__(self, site: Site, layout: Layout, clearance_m: float, standoff_m: float) -> None:
        self._site, self._layout = site, layout
        self._clearance_m = clearance_m
        self._standoff_m = max(standoff_m, clearance_m)
        self._found: dict[XY, tuple[Candidate, ...]] = {}

    def of(self, place: Place) -> tuple[Candidate, ...]:
        """One candidate for either side of a tree in a row; the place's own position for all else.

        Where no tree of the site stands in a row there are no aisles, and a tree's own position is its stand. A tree in
        no row on a site that has rows is approached from its most open side.
        """
        if place.stand is not None:
            return (Candidate(place.stand),)
        if place.xy not in self._found:
            self._found[place.xy] = self._candidates(place)
        return self._found[place.xy]

    def _candidates(self, place: Place) -> tuple[Candidate, ...]:
        tree = self._site.by_id.get(place.id) if place.kind == "tree" else None
        if tree is None or not self._layout.bodies:
            return (Candidate(place.xy),)
        row = int(self._site.planting.row_of[tree.index])
        if row < 0:
            return (self._open_side(place.xy),)
        body, line = self._line_of[row]
        return (self._beside(tree.index, body, line, -1), self._beside(tree.index, body, line, 1))

    @cached_property
    def _line_of(self) -> dict[int, tuple[int, int]]:
        """For each of the planting's rows its body, and its line there."""
        return {
            row: (number, k)
            for number, body in enumerate(self._layout.bodies)
            for k, line in enumerate(body.lines)
            for row in line.rows
        }

    @cached_property
    def _trees(self) -> cKDTree:
        return cKDTree(self._site.xy)

    @cached_property
    def _row_lines(self) -> shapely.STRtree:
        return tree_lines(self._site)

    def _beside(self, tree: int, body: int, line: int, side: int) -> Candidate:
        """On one side of a row: -1 that of lesser v."""
        within = self._layout.bodies[body]
        other = line + side
        lane = (body, min(line, other), max(line, other))
        at = self._site.xy[tree]
        if 0 <= other < len(within.lines):
            return self._in_aisle(at, tree, self._layout.aisle_of(body, min(line, other)), side, lane)
        away = side * self._across(tree, body, bent=True)
        room = self._free_way(at, away, {*within.lines[line].rows})
        if room < self._clearance_m:
            return Candidate(_xy(at), lane, "another row is too near")
        off = min(self._standoff_m, room)
        beside = at + np.linspace(off, self._clearance_m, _NEARER)[:, None] * away
        clear = self._layout.is_clear(beside)
        if not clear.any():
            return Candidate(_xy(beside[0]), lane, self._in_the_way(beside[0]))
        return Candidate(_xy(beside[int(np.argmax(clear))]), lane)

    def _in_aisle(self, at: Points, tree: int, aisle: Aisle, side: int, lane: tuple[int, int, int]) -> Candidate:
        frame = aisle.body.frame
        u, v = frame.local(at[None, :])[0].tolist()
        across = self._across(tree, lane[0], bent=aisle.low > aisle.high)
        lean = max(float(across @ frame.across), 0.2)
        to_middle = max(side * (aisle.middle(u) - v) / lean, 0.0)
        xy = at + side * min(self._standoff_m, to_middle) * across
        low, high = aisle.bounds(float(frame.local(xy[None, :])[0, 0]))
        if low > high:
            return Candidate(_xy(xy), lane, "the aisle is too narrow", aisle.width(u))
        # Rows may be uneven or bent: not nearer to either of them than the robot's clearance. Where something stands in
        # the aisle, nearer to the tree.
        beside = np.array([xy + part * (at - xy) for part in np.linspace(0.0, 1.0, _NEARER)])
        uv = frame.local(beside)
        uv[:, 1] = np.clip(uv[:, 1], low, high)
        beside = frame.world(uv)
        clear = self._layout.is_clear(beside)
        for stand in beside[clear]:
            if self._layout.spot(_xy(stand)).aisle is aisle:
                return Candidate(_xy(stand), lane)
        return Candidate(_xy(beside[0]), lane, self._in_the_way(beside[0]))

    def _across(self, tree: int, body: int, *, bent: bool) -> Points:
        """The direction across the row at a tree, towards greater v: its block's, or that of the row just there."""
        frame = self._layout.bodies[body].frame
        if not bent:
            return frame.across
        row = self._site.planting.rows[int(self._site.planting.row_of[tree])]
        rank = int(self._site.planting.rank[tree])
        near = self._site.xy[row.trees[[max(rank - _ALONG, 0), min(rank + _ALONG, len(row.trees) - 1)]]]
        along = near[1] - near[0]
        length = float(np.hypot(*along))
        if length < 2.0 * self._clearance_m:
            return frame.across
        across = np.array([along[1], -along[0]]) / length
        return across if across @ frame.across > 0.0 else -across

    def _free_way(self, at: Points, away: Points, own: set[int]) -> float:
        """How far a robot may go from a row before it is nearer to another."""
        ray = shapely.linestrings([at, at + 2.0 * self._standoff_m * away])
        near = [k for k in self._row_lines.query(ray, predicate="intersects").tolist() if k not in own]
        if not near:
            return math.inf
        return float(shapely.distance(shapely.points(at), self._row_lines.geometries[near]).min()) / 2.0

    def _in_the_way(self, stand: Points) -> str:
        nearest = self._layout.in_the_way(_xy(stand))
        return f"{nearest} is too near" if nearest else "nothing can be driven to beside it"

    def _open_side(self, at: XY) -> Candidate:
        """For a tree in no row: where other trees are farthest, on ground that can be driven on."""
        turn = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
        around = np.array(at) + self._standoff_m * np.column_stack([np.sin(turn), np.cos(turn)])
        away = np.asarray(self._trees.query(around, k=min(2, len(self._site.xy)))[0]).reshape(_DIRECTIONS, -1)
        other = np.where(away[:, 0] < self._standoff_m * 0.999, away[:, 0], away[:, -1])
        clear = self._layout.is_clear(around)
        for k in np.argsort(-np.round(other, 3), kind="stable").tolist():
            if clear[k] and self._layout.reaches(self._layout.spot(_xy(around[k]))):
                return Candidate(_xy(around[k]))
        return Candidate(_xy(around[int(np.argmax(other))]), None, "nothing can be driven to beside it")


def _xy(at: Points) -> XY:
    return (float(at[0]), float(at[1]))
