"""Candidate positions (stands) from which a robot works on a tree, in the aisle beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.ops import nearest_points

from fieldhand.site.driving.aisles import Aisle
from fieldhand.site.driving.graph import Indices, Points
from fieldhand.site.driving.layout import XY, Layout
from fieldhand.site.gaps import empty_positions
from fieldhand.site.model import Gate, Place, Site
from fieldhand.site.point_index import PointIndex

#: Lane of a stand: (group, line, line) of the aisle that it lies in; on the outer side of an outer row one line is -1
#: or one past the last.
LaneKey = tuple[int, int, int]

#: The direction of a bent row at a tree is measured between the trees this many places before and after it.
_ALONG = 3

#: Number of points, from the standoff towards the tree, that are tried for a stand clear of obstacles.
_NEARER = 6

#: A gate belongs to open ground within half its width plus this many clearances.
_FROM_GATE = 2.0

#: Direction of each side of a tree, east and north.
_COMPASS: dict[str, tuple[float, float]] = {
    "north": (0.0, 1.0), "east": (1.0, 0.0), "south": (0.0, -1.0), "west": (-1.0, 0.0),
}  # fmt: skip

#: Number of directions tried for approaching a tree in no row.
_DIRECTIONS = 16


@dataclass(frozen=True, slots=True)
class Candidate:
    """A possible stand for a tree.

    Attributes:
        xy: Metres east and north.
        lane: Lane that it lies in; None on open ground.
        why_not: Reason why the robot cannot be there; empty if it can.
        aisle_m: Width of the aisle in metres, if it is too narrow.
    """

    xy: XY
    lane: LaneKey | None = None
    why_not: str = ""
    aisle_m: float | None = None


class StandCandidates:
    """Candidates for the stands of a site's trees and gaps.

    Args:
        site: The site.
        layout: Drivable layout of the site.
        clearance_m: Half the robot's width.
        standoff_m: Distance in metres from a tree to its stand, if the aisle is wide enough.
    """

    def __init__(self, site: Site, layout: Layout, clearance_m: float, standoff_m: float) -> None:
        self._site, self._layout = site, layout
        self._clearance_m = clearance_m
        self._standoff_m = max(standoff_m, clearance_m)
        self._candidates: dict[int, tuple[Candidate, ...]] = {}

    def of(self, place: Place) -> tuple[Candidate, ...]:
        """Return a candidate on either side of a tree in a row, or the position of any other place.

        A place with a side has a single candidate, on that side.

        The stand of a gate, which lies on a fence, is the nearest open ground. On a site without rows the stand of a
        tree is its own position. On a site with rows, a tree in no row is approached from its most open side.
        """
        return self.of_all((place,))[0]

    def of_all(self, places: Sequence[Place]) -> list[tuple[Candidate, ...]]:
        """Return the candidates of each of the places, cached."""
        trees = [self._open_tree(p) for p in places]
        new = np.array([k for k in dict.fromkeys(trees) if k is not None and k not in self._candidates], dtype=np.intp)
        rows = self._row_of[new]
        self._candidates.update(zip(new[rows < 0].tolist(), self._open_sides(new[rows < 0]), strict=True))
        for row in np.unique(rows[rows >= 0]).tolist():
            self._find(new[rows == row], *self._line_of[row])
        return [
            (self._beside_open(p),)
            if self._is_open(p)
            else (self._candidate(p),)
            if tree is None
            else self._on_side(p, tree, self._candidates[tree])
            for p, tree in zip(places, trees, strict=True)
        ]

    def across(self, place: Place) -> XY | None:
        """Return the direction across the row of a tree or gap, east and north; None for a place in no row.

        Near a straight aisle it is that of the block, else that of the row at the tree.
        """
        if not place.planted or not self._layout.aisles.groups:
            return None
        index = self._planted_index(place)
        if index is None or self._row_of[index] < 0:
            return None
        group, _ = self._line_of[int(self._row_of[index])]
        aisle = self._layout.aisle(place.stand or place.xy)
        bent = aisle is None or not aisle.is_straight
        return _xy(self._across(np.array([index]), group, bent=bent)[0])

    def row_ends(self, place: Place) -> tuple[XY, ...]:
        """Return the first and the last tree of the row of a tree or gap; empty for a place in no row."""
        index = self._planted_index(place)
        if index is None or self._row_of[index] < 0:
            return ()
        trees = self._site.planting.rows[int(self._row_of[index])].trees
        return _xy(self._site.xy[trees[0]]), _xy(self._site.xy[trees[-1]])

    def _is_open(self, place: Place) -> bool:
        """Return True for a side of a tree that stands in no row, whose stand is to be chosen."""
        tree = self._site.by_id.get(place.id) if place.side and place.stand is None else None
        return tree is not None and (not self._layout.aisles.groups or self._site.planting.row_of[tree.index] < 0)

    def _on_side(self, place: Place, tree: int, candidates: tuple[Candidate, ...]) -> tuple[Candidate, ...]:
        """Return the candidates of a tree in a row that lie on the side of the place."""
        if not place.side:
            return candidates
        group, _ = self._line_of[int(self._site.planting.row_of[tree])]
        east, north = self._layout.aisles.groups[group].frame.across
        to_east, to_north = _COMPASS[place.side]
        return candidates[1:] if east * to_east + north * to_north > 0.0 else candidates[:1]

    def _beside_open(self, place: Place) -> Candidate:
        """Return the stand beside a tree in no row, in the direction of the place's side."""
        to_east, to_north = _COMPASS[place.side]
        off = self._standoff_m * np.linspace(1.0, 0.0, _NEARER, endpoint=False)[:, None]
        tried = np.array(place.xy) + off * np.array([to_east, to_north])
        apart = self._trees.nearest_few(tried, 2)[0].min(axis=1)
        clear = self._layout.is_clear(tried) & (apart >= min(self._clearance_m, float(off[-1, 0])) * 0.999)
        return Candidate(_xy(tried[int(np.argmax(clear))]), None, "" if clear.any() else self._in_the_way(tried[0]))

    def _candidate(self, place: Place) -> Candidate:
        """Return the only stand of a place other than a tree: its own, its position, or the ground near a gate."""
        gate = self._gates.get(place.xy)
        if place.stand is not None or gate is None or self._layout.soft.is_empty:
            return Candidate(place.stand or place.xy)
        at = shapely.Point(place.xy)
        beside, _ = nearest_points(self._layout.soft, at)
        near = beside.distance(at) <= gate.width_m / 2.0 + _FROM_GATE * self._clearance_m
        return Candidate((beside.x, beside.y) if near else place.xy)

    @cached_property
    def _gates(self) -> dict[XY, Gate]:
        """Return the gates of the site by their position."""
        return {gate.place.xy: gate for gate in self._site.gates}

    def _open_tree(self, place: Place) -> int | None:
        """Return the index of a tree whose stand is to be chosen, for a gap that after the trees; None for any other
        place."""
        if place.stand is not None or not place.planted or not self._layout.aisles.groups:
            return None
        return self._planted_index(place)

    def _planted_index(self, place: Place) -> int | None:
        """Return the index of a tree, for a gap that after the trees; None for any other place."""
        if place.kind == "gap":
            return self._gap_index.get(place.xy)
        tree = self._site.by_id.get(place.id) if place.kind == "tree" else None
        return None if tree is None else tree.index

    @cached_property
    def _gap_index(self) -> dict[XY, int]:
        """Return the index of each gap by its position, counted on from the trees."""
        return {gap.xy: len(self._site.trees) + k for k, gap in enumerate(empty_positions(self._site).places)}

    @cached_property
    def _xy(self) -> Points:
        """Return the positions of trees and gaps."""
        return np.vstack([self._site.xy, empty_positions(self._site).xy])

    @cached_property
    def _row_of(self) -> Indices:
        """Return the row of each tree and gap."""
        return np.concatenate([self._site.planting.row_of, empty_positions(self._site).row])

    @cached_property
    def _rank(self) -> Indices:
        """Return which tree of its row each is; of a gap, its neighbour."""
        rank = self._site.planting.rank
        return np.concatenate([rank, rank[empty_positions(self._site).before]])

    def _find(self, trees: Indices, group: int, line: int) -> None:
        """Compute the candidates of trees of one row, below and above it."""
        sides = [self._beside(trees, group, line, side) for side in (-1, 1)]
        self._candidates.update(zip(trees.tolist(), zip(*sides, strict=True), strict=True))

    @cached_property
    def _line_of(self) -> dict[int, tuple[int, int]]:
        """Return for each row of the planting its group and its line in the group."""
        return {
            row: (number, k)
            for number, group in enumerate(self._layout.aisles.groups)
            for k, line in enumerate(group.lines)
            for row in line.rows
        }

    @cached_property
    def _trees(self) -> PointIndex:
        return PointIndex(self._site.xy)

    def _beside(self, trees: Indices, group: int, line: int, side: int) -> list[Candidate]:
        """Return the candidates on one side of a row; side -1 is that of lesser v."""
        within = self._layout.aisles.groups[group]
        other = line + side
        lane = (group, min(line, other), max(line, other))
        if 0 <= other < len(within.lines):
            return self._in_aisle(trees, self._layout.aisles.of(group, min(line, other)), side, lane)
        at = self._xy[trees]
        away = side * self._across(trees, group, bent=True)
        room = self._free_way(at, away, {*within.lines[line].rows})
        off = np.minimum(self._standoff_m, room)
        steps = off[:, None] + np.linspace(0.0, 1.0, _NEARER) * (self._clearance_m - off)[:, None]
        beside = at[:, None] + steps[:, :, None] * away[:, None]
        clear = self._layout.is_clear(beside.reshape(-1, 2)).reshape(-1, _NEARER)
        return [
            Candidate(_xy(at[k]), lane, "another row is too near")
            if room[k] < self._clearance_m
            else self._stand(beside[k], clear[k], lane)
            for k in range(len(trees))
        ]

    def _stand(self, beside: Points, clear: NDArray[np.bool_], lane: LaneKey) -> Candidate:
        """Return a candidate at the first clear point, else one with the reason why there is none."""
        if clear.any():
            return Candidate(_xy(beside[int(np.argmax(clear))]), lane)
        return Candidate(_xy(beside[0]), lane, self._in_the_way(beside[0]))

    def _in_aisle(self, trees: Indices, aisle: Aisle, side: int, lane: LaneKey) -> list[Candidate]:
        frame, at = aisle.frame, self._xy[trees]
        u, v = frame.local(at).T
        across = self._across(trees, lane[0], bent=not aisle.is_straight)
        lean = np.maximum(across[:, 0] * frame.across[0] + across[:, 1] * frame.across[1], 0.2)
        to_middle = np.maximum(side * (aisle.middle(u) - v) / lean, 0.0)
        xy = at + side * np.minimum(self._standoff_m, to_middle)[:, None] * across
        low, high = aisle.bounds(frame.local(xy)[:, 0])
        # Rows may be uneven or bent, so keep the clearance from both. If an obstacle is in the aisle, try points nearer
        # to the tree.
        beside = xy[:, None] + np.linspace(0.0, 1.0, _NEARER)[:, None] * (at - xy)[:, None]
        uv = frame.local(beside.reshape(-1, 2))
        uv[:, 1] = np.clip(uv[:, 1], np.repeat(low, _NEARER), np.repeat(np.maximum(low, high), _NEARER))
        beside = frame.world(uv).reshape(-1, _NEARER, 2)
        clear = self._layout.is_clear(beside.reshape(-1, 2)).reshape(-1, _NEARER)
        clear[low > high] = False
        self._keep_to(aisle, beside, clear)
        return [
            Candidate(_xy(xy[k]), lane, "the aisle is too narrow", float(aisle.width(u[k])))
            if low[k] > high[k]
            else self._stand(beside[k], clear[k], lane)
            for k in range(len(trees))
        ]

    def _keep_to(self, aisle: Aisle, beside: Points, clear: NDArray[np.bool_]) -> None:
        """Clear the flags, shape (n, m), of each tree's points before the first one that lies in this aisle."""
        open_ = np.flatnonzero(clear.any(axis=1))
        while len(open_):
            first = clear[open_].argmax(axis=1)
            elsewhere = np.array([found is not aisle for found in self._layout.aisles.at(beside[open_, first])])
            clear[open_[elsewhere], first[elsewhere]] = False
            open_ = open_[elsewhere & clear[open_].any(axis=1)]

    def _across(self, trees: Indices, group: int, *, bent: bool) -> Points:
        """Return the direction across the row at each tree, towards greater v, shape (n, 2): that of the block, or if
        ``bent`` that of the row at the tree."""
        frame = self._layout.aisles.groups[group].frame
        across = np.tile(frame.across, (len(trees), 1))
        if not bent:
            return across
        planting = self._site.planting
        row = planting.rows[int(self._row_of[trees[0]])].trees
        rank = self._rank[trees]
        near = [self._site.xy[row[np.clip(rank + step, 0, len(row) - 1)]] for step in (-_ALONG, _ALONG)]
        along = near[1] - near[0]
        length = np.hypot(*along.T)
        sure = length >= 2.0 * self._clearance_m
        own = np.column_stack([along[sure, 1], -along[sure, 0]]) / length[sure, None]
        turned = own[:, 0] * frame.across[0] + own[:, 1] * frame.across[1] > 0.0
        across[sure] = np.where(turned[:, None], own, -own)
        return across

    def _free_way(self, at: Points, away: Points, own: set[int]) -> Points:
        """Return the metres that a robot may move away from each tree of a row before it is nearer to another row."""
        room = np.full(len(at), np.inf)
        rays = shapely.linestrings(np.stack([at, at + 2.0 * self._standoff_m * away], axis=1))
        tree, line = self._layout.aisles.row_lines.query(rays, predicate="intersects")
        other = ~np.isin(line, list(own))
        tree, line = tree[other], line[other]
        np.minimum.at(
            room, tree, shapely.distance(shapely.points(at[tree]), self._layout.aisles.row_lines.geometries[line]) / 2.0
        )
        return room

    def _in_the_way(self, stand: Points) -> str:
        nearest = self._layout.in_the_way(_xy(stand))
        return f"{nearest} is too near" if nearest else "there is no drivable ground beside it"

    def _open_sides(self, trees: Indices) -> list[tuple[Candidate, ...]]:
        """Return the candidates of trees in no row: on clear ground where other trees are farthest."""
        if len(trees) == 0:
            return []
        turn = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
        offsets = self._standoff_m * np.column_stack([np.sin(turn), np.cos(turn)])
        around = self._site.xy[trees][:, None] + offsets
        away = self._trees.nearest_few(around.reshape(-1, 2), 2)[0]
        away = away.reshape(len(trees), _DIRECTIONS, -1)
        other = np.where(away[:, :, 0] < self._standoff_m * 0.999, away[:, :, 0], away[:, :, -1])
        order = np.argsort(-np.round(other, 3), axis=1, kind="stable")
        clear = self._layout.is_clear(around.reshape(-1, 2)).reshape(-1, _DIRECTIONS)
        found: list[tuple[Candidate, ...]] = [
            (Candidate(_xy(around[k, int(np.argmax(other[k]))]), None, "there is no drivable ground beside it"),)
            for k in range(len(trees))
        ]
        left = np.arange(len(trees))
        for rank in range(_DIRECTIONS):
            tried = left[clear[left, order[left, rank]]]
            spots = self._layout.spots([_xy(around[k, order[k, rank]]) for k in tried.tolist()])
            reached = np.array([spot.foot is not None for spot in spots], dtype=bool)
            for k in np.flatnonzero(reached).tolist():
                found[tried[k]] = (Candidate(spots[k].xy),)
            left = np.setdiff1d(left, tried[reached])
        return found


def _xy(at: Points) -> XY:
    return (float(at[0]), float(at[1]))
