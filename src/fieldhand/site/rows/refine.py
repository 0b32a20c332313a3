"""Refine inferred rows: join pieces of a row, and assign single trees to rows."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.point_index import PointIndex

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Greatest distance of a tree from the line of its row, and from the next tree of the row, in tree spacings.
_BESIDE, _BEYOND = 0.42, 2.6
#: Least distance from the next tree along the row, in tree spacings, unless the tree is this close to the line.
_ROOM, _ON_IT = 0.5, 0.2
#: Number of nearest trees that determine the line of a row at a place.
_NEXT_TO = 8
#: Greatest gap between pieces of one row, in tree spacings; the longer one applies to a block of a single row.
_JOINED, _JOINED_ALONE = 1.65, 3.6
_ONE_WAY = np.cos(np.radians(9.0))


@dataclass(frozen=True, eq=False, kw_only=True)
class InferredBlock:
    """A block inferred from the positions of the trees.

    Attributes:
        rows: Trees of each row.
        row_spacing, tree_spacing: Metres.
        way: Unit vector along the rows.
        power: Power of the wave across the rows, 0 to 1.
        spacing_ratio: Row spacing divided by the spacing of the lines of trees across the rows.
        file_order_share: Fraction of the steps from tree to tree in file order that go along rows, not across.
        straight: True if the rows are straight.
        confidence: Confidence in the direction of the rows, 0 to 1.
        row_confidences: Confidence in each row, 0 to 1.
    """

    rows: list[Indices]
    row_spacing: float
    tree_spacing: float
    way: Floats
    power: float
    spacing_ratio: float
    file_order_share: float = 0.5
    straight: bool = True
    confidence: float = 1.0
    row_confidences: list[float] = field(default_factory=list)


class RowRefinement:
    """Step-by-step refinement of rows.

    Args:
        xy: Trees in metres.
        blocks: Inferred blocks.
    """

    def __init__(self, xy: Floats, blocks: list[InferredBlock]) -> None:
        self._xy = xy
        self._blocks = blocks
        self._rows: list[Indices] = []
        self._block_of: list[int] = []
        for k, block in enumerate(blocks):
            for trees in block.rows:
                self._rows.append(self._ordered(trees, block.way))
                self._block_of.append(k)
        self._merged: dict[int, int] = {}
        self._row_of = np.full(len(xy), -1, dtype=np.intp)
        for k, trees in enumerate(self._rows):
            self._row_of[trees] = k

    def refined(self) -> list[InferredBlock]:
        """Return the refined blocks, without those whose rows were all merged into others."""
        self._assign_single_trees()
        self._join_pieces()
        self._fill_gaps()
        self._assign_single_trees()
        found = []
        for k, block in enumerate(self._blocks):
            rows = [r for r, b in zip(self._rows, self._block_of, strict=True) if b == k and len(r)]
            if rows:
                found.append(replace(block, rows=rows))
        return found

    def _ordered(self, trees: Indices, way: Floats) -> Indices:
        return trees[np.argsort(self._xy[trees] @ way, kind="stable")]

    def _fit(self, row: int, tree: int) -> tuple[float, float]:
        """Return the distances, in tree spacings, to the row's line and the nearest other tree along it."""
        block = self._blocks[self._block_of[row]]
        others = self._rows[row][self._rows[row] != tree]
        if not len(others):
            return np.inf, np.inf
        off = self._xy[others] - self._xy[tree]
        along = off @ block.way
        near = np.argsort(np.abs(along), kind="stable")[:_NEXT_TO]
        way = _way(off[near], block.way) if len(near) == _NEXT_TO else block.way
        middle = off[near].mean(axis=0)
        beside = abs(float(middle[0] * way[1] - middle[1] * way[0]))
        return beside / block.tree_spacing, float(np.abs(off @ way).min()) / block.tree_spacing

    def _best_row(self, tree: int, near: Indices) -> int | None:
        """Return the row that a tree fits best; None if it fits none."""
        found = []
        for row in {int(self._row_of[k]) for k in near} - {-1}:
            if len(self._rows[row]) < 2:
                continue
            beside, gap = self._fit(row, tree)
            if beside < _BESIDE and gap < _BEYOND and (gap > _ROOM or beside < _ON_IT):
                found.append(((beside / 0.2) ** 2 + 2 * max(gap - 1.0, 0.0) ** 2, row))
        return min(found)[1] if found else None

    def _near(self, trees: Indices) -> list[Indices]:
        return list(PointIndex(self._xy).nearest_few(self._xy[trees], 24)[1])

    def _assign_single_trees(self) -> None:
        """Assign trees in no row to the row that they are in line with, repeating for trees next to them."""
        lone = np.flatnonzero(self._row_of < 0)
        around = self._near(lone) if len(lone) else []
        for _ in range(4):
            moved = False
            for tree, near in zip(lone.tolist(), around, strict=True):
                if self._row_of[tree] < 0 and (row := self._best_row(tree, near)) is not None:
                    way = self._blocks[self._block_of[row]].way
                    self._rows[row] = self._ordered(np.append(self._rows[row], tree), way)
                    self._row_of[tree] = row
                    moved = True
            if not moved:
                return

    def _join_pieces(self) -> None:
        """Join pieces of rows of different blocks that continue each other, and merge blocks joined by several rows."""
        ends, ways, rows = self._ends()
        if len(ends) < 2:
            return
        spacing = np.array([self._blocks[self._block_of[r]].tree_spacing for r in rows])
        size = Counter(b for r, b in zip(self._rows, self._block_of, strict=True) if len(r))
        reach = _JOINED_ALONE * float(spacing.max())
        met: Counter[tuple[int, int]] = Counter()
        joins = []
        for i, j in PointIndex(ends).pairs(reach).tolist():
            a, b = rows[i], rows[j]
            if self._block_of[a] == self._block_of[b] or ways[i] @ ways[j] > -_ONE_WAY:
                continue
            step, wide, off = min(spacing[i], spacing[j]), max(spacing[i], spacing[j]), ends[j] - ends[i]
            if wide > 1.4 * step:
                continue
            way = ways[i] - ways[j]
            way = way / np.hypot(*way)
            gap, beside = float(off @ way), abs(float(off[0] * way[1] - off[1] * way[0]))
            alone = min(size[self._block_of[a]], size[self._block_of[b]]) == 1
            if -2.5 * step < gap < (_JOINED_ALONE if alone else _JOINED) * step and beside < _BESIDE * wide:
                joins.append((gap, a, b))
        for _, a, b in sorted(joins):
            met[(min(self._block_of[a], self._block_of[b]), max(self._block_of[a], self._block_of[b]))] += 1
            self._merge(a, b)
        for (a, b), count in met.items():
            if a != b and count >= 2:
                self._block_of = [a if k == b else k for k in self._block_of]

    def _fill_gaps(self) -> None:
        """Merge blocks of a single row that lie in a gap of another row into that row."""
        size = Counter(b for r, b in zip(self._rows, self._block_of, strict=True) if len(r))
        for row, trees in enumerate(self._rows):
            if len(trees) < 2 or size[self._block_of[row]] > 1:
                continue
            ends = trees[[0, -1]]
            ways = self._blocks[self._block_of[row]].way
            for other in {int(k) for near in self._near(ends) for k in self._row_of[near]} - {-1, row}:
                fits = [self._fit(other, int(tree)) for tree in ends]
                one_way = abs(float(ways @ self._blocks[self._block_of[other]].way)) > _ONE_WAY
                if one_way and all(beside < _BESIDE and gap < _JOINED_ALONE for beside, gap in fits):
                    self._merge(other, row)
                    break

    def _merge(self, a: int, b: int) -> None:
        a, b = self._merged_into(a), self._merged_into(b)
        if a == b:
            return
        if len(self._rows[a]) < len(self._rows[b]):
            a, b = b, a
        way = self._blocks[self._block_of[a]].way
        self._row_of[self._rows[b]] = a
        self._rows[a] = self._ordered(np.concatenate([self._rows[a], self._rows[b]]), way)
        self._merged[b] = a
        self._rows[b] = np.empty(0, dtype=np.intp)

    def _merged_into(self, row: int) -> int:
        while row in self._merged:
            row = self._merged[row]
        return row

    def _ends(self) -> tuple[Floats, Floats, list[int]]:
        """Return both ends of each row of at least three trees: point on the row's line, outward direction, row."""
        ends, ways, rows = [], [], []
        for row, trees in enumerate(self._rows):
            if len(trees) < 3:
                continue
            block = self._blocks[self._block_of[row]]
            for own, out in ((trees[:_NEXT_TO], -1.0), (trees[::-1][:_NEXT_TO], 1.0)):
                points = self._xy[own]
                way = _way(points - points[0], block.way) if len(own) == _NEXT_TO else block.way
                middle = points.mean(axis=0)
                ends.append(middle + way * float((points[0] - middle) @ way))
                ways.append(way * out)
                rows.append(row)
        return np.array(ends).reshape(-1, 2), np.array(ways).reshape(-1, 2), rows


def _way(points: Floats, like: Floats) -> Floats:
    """Return the main axis of points, oriented like another vector."""
    off = points - points.mean(axis=0)
    axis = np.linalg.eigh(off.T @ off)[1][:, 1]
    return np.asarray(axis if axis @ like > 0 else -axis)
