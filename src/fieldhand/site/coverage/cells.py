"""Divide an area into cells of parallel swaths, and choose the bearing of each.

A boustrophedon decomposition cuts the area, along the swaths, at the corners where a sweep across them would meet a new
obstacle or leave one (Choset and Pignon 1997). Neighbouring cells are then merged as long as that saves driving.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient

from fieldhand.site.coverage.strips import estimated_cost, in_frame, strip_cost, swath_frame
from fieldhand.site.driving.graph import Points

#: Distance in degrees between the bearings that are tried beside those of the edges.
_GRID_DEG = 7.5

#: Edges of more different bearings than this are tried only if they are among the longest.
_EDGES = 16

#: Bearings of edges that differ by less than this, in degrees, are tried once.
_ALIKE_DEG = 0.5

#: Bearings for which the swaths of a cell are computed, best estimates first.
_COMPUTED = 6

#: Metres by which a cut is extended beyond the edge, so that both surely cross.
_BEYOND_M = 1e-6

#: Cells are not merged pairwise if there are more than this many.
_MANY_CELLS = 40


@dataclass(frozen=True, eq=False)
class SwathCell:
    """A part of an area, the bearing of its swaths, and the metres that they need, turns included."""

    polygon: BaseGeometry
    bearing_deg: float
    cost_m: float


@dataclass(frozen=True)
class CellSearch:
    """Settings of the search for cells.

    Attributes:
        width_m: Working width.
        apart_m: Greatest distance from swath to swath.
        turn_m: Metres that a turn counts for.
        bearing_deg: Bearing of all swaths; None to choose.
    """

    width_m: float
    apart_m: float
    turn_m: float
    bearing_deg: float | None

    def best(self, polygon: BaseGeometry, count: int = 1) -> list[SwathCell]:
        """Return a part of an area with the best bearings for it, best first."""
        if self.bearing_deg is not None:
            return [self._cell(polygon, self.bearing_deg)]
        bearings = candidate_bearings(polygon, self.width_m)
        estimates = estimated_cost(_edges(polygon), bearings, self.apart_m, self.turn_m)
        likely = np.argsort(np.round(estimates, 6), kind="stable")[: max(_COMPUTED, count)]
        cells = [self._cell(polygon, float(bearings[k])) for k in likely]
        return sorted(cells, key=lambda cell: round(cell.cost_m, 6))[:count]

    def _cell(self, polygon: BaseGeometry, bearing_deg: float) -> SwathCell:
        local = in_frame(polygon, swath_frame(bearing_deg))
        return SwathCell(polygon, bearing_deg, strip_cost(local, self.width_m, self.apart_m, self.turn_m))


def divisions(area: BaseGeometry, search: CellSearch, count: int) -> list[tuple[SwathCell, ...]]:
    """Return ways to divide an area into cells, cheapest first: undivided, and cut along several bearings.

    Args:
        area: Ground to be covered by the swaths.
        search: Settings.
        count: Greatest number of divisions.
    """
    parts = [part for part in shapely.get_parts(area) if isinstance(part, Polygon) and part.area > 0.0]
    if not parts:
        return []
    each = [_divisions_of_part(part, search, count) for part in parts]
    found = [
        tuple(itertools.chain.from_iterable(some[min(k, len(some) - 1)] for some in each))
        for k in range(max(map(len, each)))
    ]
    return found[:count]


def _divisions_of_part(part: Polygon, search: CellSearch, count: int) -> list[tuple[SwathCell, ...]]:
    whole = search.best(part, count)
    found: list[tuple[SwathCell, ...]] = [(cell,) for cell in whole]
    for bearing in dict.fromkeys(cell.bearing_deg for cell in whole):
        pieces = split(part, bearing)
        if len(pieces) > 1:
            merged = _merged([search.best(piece)[0] for piece in pieces], search)
            if len(merged) > 1:
                found.append(tuple(merged))
    costs = [round(sum(cell.cost_m for cell in cells), 6) for cells in found]
    order = sorted(range(len(found)), key=lambda k: (costs[k], len(found[k])))
    distinct = [k for n, k in enumerate(order) if all(costs[k] != costs[j] for j in order[:n])]
    return [found[k] for k in distinct[:count]]


def candidate_bearings(polygon: BaseGeometry, width_m: float) -> Points:
    """Return the bearings to try, in degrees from 0 up to 180: those of the edges, and a grid."""
    edges = _edges(shapely.simplify(polygon, 0.1 * width_m))
    lengths = np.hypot(*edges.T)
    bearings = np.mod(np.degrees(np.arctan2(edges[:, 0], edges[:, 1])), 180.0)
    chosen: list[float] = []
    for k in np.argsort(-np.round(lengths, 6), kind="stable").tolist():
        away = [abs((bearings[k] - other + 90.0) % 180.0 - 90.0) for other in chosen]
        if len(chosen) < _EDGES and min(away, default=90.0) > _ALIKE_DEG:
            chosen.append(float(bearings[k]))
    # The grid turns with the area, so that the plan of a rotated area is the rotated plan.
    grid = np.mod(chosen[0] + np.arange(0.0, 180.0, _GRID_DEG), 180.0)
    return np.concatenate([chosen, grid[1:]])


def split(polygon: Polygon, bearing_deg: float) -> list[Polygon]:
    """Cut a polygon along a bearing at every corner where a sweep across it meets or leaves an obstacle."""
    frame = swath_frame(bearing_deg)
    local = in_frame(polygon, frame)
    cuts = _cuts(local)
    if not cuts:
        return [polygon]
    lines = shapely.union_all([local.boundary, *cuts])
    pieces = shapely.get_parts(shapely.polygonize([*shapely.get_parts(lines)]))
    kept = [piece for piece in pieces if local.contains(piece.representative_point())]
    return [shapely.transform(piece, frame.world) for piece in kept]


def _cuts(local: BaseGeometry) -> list[LineString]:
    """Return the cuts through the corners at which the ground on the side of the corner divides, along u."""
    west, _, east, _ = local.bounds
    cuts = []
    for part in shapely.get_parts(local):
        turned = orient(part)
        for ring in (turned.exterior, *turned.interiors):
            at = shapely.get_coordinates(ring)[:-1]
            before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
            reflex = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] < -1e-9
            level = 1e-9 * np.hypot(*(before + after).T)
            turns = (before[:, 1] * after[:, 1] <= level * level) & reflex
            for u, v in at[turns].tolist():
                line = LineString([(west - 1.0, v), (east + 1.0, v)]).intersection(local)
                near = [g for g in shapely.get_parts(line) if g.length > 0.0 and g.distance(shapely.Point(u, v)) < 1e-6]
                for piece in near:
                    first, _, last, _ = piece.bounds
                    cuts.append(LineString([(first - _BEYOND_M, v), (last + _BEYOND_M, v)]))
    return cuts


def _merged(cells: list[SwathCell], search: CellSearch) -> list[SwathCell]:
    """Merge the pair of adjacent cells that saves most, again and again, as long as one saves anything."""
    numbered = dict(enumerate(cells))
    if len(numbered) > _MANY_CELLS:
        return cells
    pairs = {
        (i, j): one
        for i, j in itertools.combinations(numbered, 2)
        if (one := _together(numbered[i], numbered[j], search)) is not None
    }
    while pairs:
        saved = {(i, j): numbered[i].cost_m + numbered[j].cost_m - one.cost_m for (i, j), one in pairs.items()}
        best = max(saved, key=lambda pair: round(saved[pair], 6))
        if saved[best] < -1e-6:
            break
        merged, new = pairs[best], max(numbered) + 1
        pairs = {pair: cell for pair, cell in pairs.items() if not {*pair} & {*best}}
        numbered = {k: cell for k, cell in numbered.items() if k not in best}
        for k, cell in numbered.items():
            if (one := _together(cell, merged, search)) is not None:
                pairs[k, new] = one
        numbered[new] = merged
    return list(numbered.values())


def _together(one: SwathCell, two: SwathCell, search: CellSearch) -> SwathCell | None:
    """Return two cells as one; None if they do not share an edge."""
    if shapely.dwithin(one.polygon, two.polygon, 1e-6):
        # Grown a little, since the edge between them was computed twice.
        both = shapely.union_all([cell.polygon.buffer(1e-7, join_style="mitre") for cell in (one, two)])
        if isinstance(both, Polygon):
            return search.best(both)[0]
    return None


def _edges(polygon: BaseGeometry) -> Points:
    """Return the vectors along all edges, shape (n, 2)."""
    rings = shapely.get_parts(shapely.get_rings(shapely.get_parts(polygon)))
    found = [np.diff(shapely.get_coordinates(ring), axis=0) for ring in rings]
    return np.concatenate([np.empty((0, 2)), *found])
