"""Arrangement of the trees: blocks, their rows, and the trees along each row.

Rows are numbered from west to east, or from north to south if they run east-west (a bearing of 45 to 135 degrees). The
usual end of a row is its northern one, or its western one if rows run east-west.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fieldhand.short_repr import short_repr

RowSource = Literal["file", "inferred"]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False, kw_only=True)
class Row:
    """A row of trees.

    Attributes:
        name: Name in the file, else the number as text.
        number: Number within the block from 1, from west, or from north if rows run east-west.
        block: Index of its block in :attr:`Planting.blocks`.
        trees: Indices of its trees on the site, from its usual end.
        slots: Planting position of each tree from 1, counting the missing trees in gaps; the file's own numbers if it
            has them.
        known: Source of the row: the file, or inference from the positions of the trees.
        confidence: Confidence that exactly these trees form the row, 0 to 1.
    """

    name: str
    number: int
    block: int
    trees: Indices
    slots: Indices
    known: RowSource
    confidence: float


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Block:
    """Parallel rows that were planted together.

    Attributes:
        name: Name in the file, else the number as text.
        rows: Rows in numerical order; never empty.
        bearing_deg: Bearing of the rows, clockwise from true north, 0 up to 180.
        row_spacing_m: Distance from row to row; nan for a single row.
        tree_spacing_m: Distance from tree to tree along the rows.
        known: Source of the block: the file, or inference from the positions of the trees.
        confidence: Confidence in the direction of the rows, 0 to 1.
    """

    name: str
    rows: tuple[Row, ...]
    bearing_deg: float
    row_spacing_m: float
    tree_spacing_m: float
    known: RowSource
    confidence: float

    __repr__ = short_repr

    @property
    def runs_east_west(self) -> bool:
        """Return True if the rows run closer to east-west than to north-south."""
        return 45.0 < self.bearing_deg < 135.0


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Planting:
    """The blocks of a site.

    Attributes:
        blocks: Blocks from west to east and from north to south; empty if the trees form no rows.
        tree_count: Number of trees on the site.
        why: Reason, in words, why there are no rows or some trees are in none; else empty.
    """

    blocks: tuple[Block, ...]
    tree_count: int
    why: str = ""

    __repr__ = short_repr

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """Return the rows of all blocks, block after block."""
        return tuple(row for block in self.blocks for row in block.rows)

    @cached_property
    def row_of(self) -> Indices:
        """Return for each tree the index of its row in :attr:`rows`; -1 for a tree in no row. Shape (n,)."""
        found = np.full(self.tree_count, -1, dtype=np.intp)
        for k, row in enumerate(self.rows):
            found[row.trees] = k
        return found

    @cached_property
    def rank(self) -> Indices:
        """Return for each tree its index within its row, from 0; -1 for a tree in no row. Shape (n,)."""
        found = np.full(self.tree_count, -1, dtype=np.intp)
        for row in self.rows:
            found[row.trees] = np.arange(len(row.trees))
        return found
