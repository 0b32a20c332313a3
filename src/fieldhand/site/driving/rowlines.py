"""Lines of rows in the frame of their block: u metres along the rows, v metres across them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Line = tuple[Points, Points]


@dataclass(frozen=True, eq=False)
class Frame:
    """Axes of a block. ``along`` and ``across`` are unit vectors in metres east and north."""

    along: Points
    across: Points

    @staticmethod
    def of_bearing(bearing_deg: float) -> Frame:
        """Return the frame of rows with a bearing, clockwise from true north."""
        b = np.radians(bearing_deg)
        return Frame(np.array([np.sin(b), np.cos(b)]), np.array([np.cos(b), -np.sin(b)]))

    def turned(self, slope: float) -> Frame:
        """Return the frame rotated by a slope: metres across for each metre along."""
        along = self.along + slope * self.across
        along /= np.hypot(*along)
        return Frame(along, np.array([along[1], -along[0]]))

    def local(self, xy: Points) -> Points:
        """Convert metres east and north to metres along and across, shape (n, 2)."""
        # Term by term: a matrix product may round otherwise for one point than for many.
        x, y = xy[:, 0], xy[:, 1]
        (e, n), (f, m) = self.along, self.across
        return np.column_stack([e * x + n * y, f * x + m * y])

    def world(self, uv: Points) -> Points:
        """Convert metres along and across to metres east and north, shape (n, 2)."""
        return np.asarray(uv[:, :1] * self.along + uv[:, 1:] * self.across)


@dataclass(frozen=True, eq=False)
class RowLine:
    """The line through the trees of one row, from its first to its last.

    Attributes:
        rows: Indices of the planting's rows: one, or several end to end.
        u: Coordinates along the row at which the line is sampled, strictly increasing.
        low, high: Least and greatest v at each u; they differ only where the line doubles back (trees entered twice).
        clearance_m: Distance in metres that a robot keeps from the line.
    """

    rows: tuple[int, ...]
    u: Points
    low: Points
    high: Points
    clearance_m: float

    @cached_property
    def upper(self) -> Line:
        """Return (u, v) of the line above which a robot is clear of the trees; it continues level beyond its ends."""
        return _raised(self.u, self.high, self.clearance_m)

    @cached_property
    def lower(self) -> Line:
        """Return (u, v) of the line below which a robot is clear of the trees."""
        u, v = _raised(self.u, -self.low, self.clearance_m)
        return u, -v

    @cached_property
    def top(self) -> float:
        """Return the v above which a robot is clear of the whole line."""
        return float(self.high.max()) + self.clearance_m

    @cached_property
    def bottom(self) -> float:
        """Return the v below which a robot is clear of the whole line."""
        return float(self.low.min()) - self.clearance_m


def row_line(rows: tuple[int, ...], uv: Points, clearance_m: float) -> RowLine:
    """Return the line of a row from its trees in order, shape (n, 2)."""
    if len(uv) > 1 and uv[0, 0] > uv[-1, 0]:
        uv = uv[::-1]
    u, v = uv[:, 0], uv[:, 1]
    if len(u) > 1 and (np.diff(u) <= 0.0).any():
        return RowLine(rows, *_envelope(u, v), clearance_m)
    return RowLine(rows, u, v, v, clearance_m)


def _envelope(u: Points, v: Points) -> tuple[Points, Points, Points]:
    """Return u, least v and greatest v of a line that doubles back."""
    at = np.unique(u)
    low, high = np.full(len(at), np.inf), np.full(len(at), -np.inf)
    for k in range(len(u) - 1):
        one, two = (k, k + 1) if u[k] <= u[k + 1] else (k + 1, k)
        first, last = np.searchsorted(at, [u[one], u[two]])
        part = np.interp(at[first : last + 1], u[[one, two]], v[[one, two]])
        low[first : last + 1] = np.minimum(low[first : last + 1], np.minimum(part, v[two] if first == last else part))
        high[first : last + 1] = np.maximum(high[first : last + 1], np.maximum(part, v[two] if first == last else part))
    np.minimum.at(low, np.searchsorted(at, u), v)
    np.maximum.at(high, np.searchsorted(at, u), v)
    return at, low, high


def _raised(u: Points, v: Points, by: float) -> Line:
    """Return a line that is at least ``by`` above and beside this one: its maximum within ``by``, plus ``by``.

    Between the returned points the exact line is convex, so the returned line lies above it.
    """
    at = np.unique(np.concatenate([u - by, u, u + by]))
    most = np.maximum(np.interp(at - by, u, v), np.interp(at + by, u, v))
    first, last = np.searchsorted(u, at - by, "left"), np.searchsorted(u, at + by, "right")
    for step in range(int((last - first).max(initial=0))):
        inside = first + step < last
        most = np.where(inside, np.maximum(most, v[np.minimum(first + step, len(u) - 1)]), most)
    return at, most + by
