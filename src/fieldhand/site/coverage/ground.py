"""Ground on which a robot drives between swaths: shortest paths over open ground, or between the rows of a site."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from shapely.geometry.base import BaseGeometry

from fieldhand.site.coverage.plan import XY
from fieldhand.site.driving.graph import Points, ShortestWays, chain
from fieldhand.site.driving.layout import Layout
from fieldhand.site.driving.visibility_graph import VisibilityGraph


class TransitGround(Protocol):
    """Ground with shortest paths between its points."""

    def lengths(self, points: Sequence[XY]) -> Points:
        """Return the metres between all pairs of points, shape (n, n); inf if no path connects them."""
        ...

    def way(self, one: XY, two: XY) -> tuple[XY, ...] | None:
        """Return the shortest path from one point to another, both included; None if there is none."""
        ...

    def covers(self, path: BaseGeometry) -> bool:
        """Return True if a path stays on the ground."""
        ...


class OpenGround:
    """Ground without rows.

    Args:
        ground: Ground that paths stay on; its holes are driven around.
    """

    def __init__(self, ground: BaseGeometry) -> None:
        self.ground = ground
        self._visibility = VisibilityGraph(ground, np.empty((0, 2, 2)))

    def lengths(self, points: Sequence[XY]) -> Points:
        """Return the metres between all pairs of points."""
        at = np.array(points, dtype=np.float64).reshape(-1, 2)
        best = self._visibility.graph.lengths(self._visibility.links(at))
        for i, j in self._visibility.pairs(at):
            metres = np.hypot(*(at[i] - at[j]).T)
            clear = self._visibility.area.sees(at[i], at[j])
            i, j, metres = i[clear], j[clear], metres[clear]
            np.minimum.at(best, (i, j), metres)
            np.minimum.at(best, (j, i), metres)
        np.fill_diagonal(best, 0.0)
        return best

    def way(self, one: XY, two: XY) -> tuple[XY, ...] | None:
        """Return the shortest path from one point to another."""
        at = np.array([one, two], dtype=np.float64)
        if self._visibility.area.sees(at[:1], at[1:])[0]:
            return (one, two)
        near, there = self._visibility.links(at)
        rows: ShortestWays = self._visibility.graph.rows([near])
        around = rows.metres[0, there.nodes] + there.metres
        if not np.isfinite(around).any():
            return None
        nodes = chain(rows, 0, int(there.nodes[np.argmin(around)]))
        return (one, *((x, y) for x, y in self._visibility.corners[nodes].tolist()), two)

    def covers(self, path: BaseGeometry) -> bool:
        """Return True if a path stays on the ground."""
        return bool(self._visibility.area.covers(path)[0])


class RowGround:
    """Ground of a site, on which no path crosses a row.

    Args:
        layout: Drivable layout of the site for the robot.
    """

    def __init__(self, layout: Layout) -> None:
        self._layout = layout

    def lengths(self, points: Sequence[XY]) -> Points:
        """Return the metres between all pairs of points."""
        spots = self._layout.spots(points)
        if not self._layout.open:
            at = np.array(points, dtype=np.float64).reshape(-1, 2)
            return np.asarray(np.hypot(*(at[:, None] - at[None]).transpose(2, 0, 1)))
        return self._layout.lengths(spots)

    def way(self, one: XY, two: XY) -> tuple[XY, ...] | None:
        """Return the shortest path from one point to another."""
        if not self._layout.open or one == two:
            return (one, two)
        return self._layout.way(*self._layout.spots([one, two]))

    def covers(self, path: BaseGeometry) -> bool:
        """Return True if a path stays clear of rows and keep-outs."""
        return not self._layout.open or bool(self._layout.visibility.area.covers(path)[0])
