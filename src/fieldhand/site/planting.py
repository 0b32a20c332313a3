"""How the trees stand: blocks, their rows, and the trees along each row.

Numbers count from west to east, and from north to south where that is the way of the count; "the usual end" of a row is
its northern one, or its western one where rows run east-west (a bearing of 45 to 135 degrees).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fieldhand.short_repr import short_repr

Known = Literal["file", "inferred"]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False, kw_only=True)
class Row:
    """A row of trees.

    Attributes:
        name: The file's own name, else its number as text.
        number: Counted within the block from 1, from west, or from north where rows run east-west.
        block: Position of its block in :attr:`Planting.blocks`.
        trees: Positions of its trees on the site, from its usual end.
        slots: For each of the trees its planting position from 1: a gap counts for the trees that are missing in it;
            the file's own numbers where it has them.
        known: Whether the file says so.
        confidence: That these trees are a row and no others are in it, 0 to 1.
    """

    name: str
    number: int
    block: int
    trees: Indices
    slots: Indices
    known: Known
    confidence: float


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Block:
    """Rows that belong together.

    Attributes:
        name: The file's own name, else its number as text.
        rows: In their order; never empty.
        bearing_deg: Of the rows, clockwise from true north, 0 up to 180.
        row_spacing_m: From row to row; nan for a single row.
        tree_spacing_m: From tree to tree along the rows.
        confidence: That the rows run this way, 0 to 1.
    """

    name: str
    rows: tuple[Row, ...]
    bearing_deg: float
    row_spacing_m: float
    tree_spacing_m: float
    known: Known
    confidence: float

    __repr__ = short_repr

    @property
    def runs_east_west(self) -> bool:
        """Whether its rows run rather east-west than north-south."""
        return 45.0 < self.bearing_deg < 135.0


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Planting:
    """The blocks of a site.

    Attributes:
        blocks: From west to east and from north to south; empty where the trees stand in no rows.
        tree_count: Trees of the site.
        why: Where there are no rows, or some trees are in none, the reason in words; else empty.
    """

    blocks: tuple[Block, ...]
    tree_count: int
    why: str = ""

    __repr__ = short_repr

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """The rows of all blocks, block after block."""
        return tuple(row for block in self.blocks for row in block.rows)

    @cached_property
    def row_of(self) -> Indices:
        """For each tree the position of its row in :attr:`rows`; -1 for a tree in no row. Shape (n,)."""
        found = np.full(self.tree_count, -1, dtype=np.intp)
        for k, row in enumerate(self.rows):
            found[row.trees] = k
        return found

    @cached_property
    def rank(self) -> Indices:
        """For each tree which of its row's trees it is, from 0; -1 for a tree in no row. Shape (n,)."""
        found = np.full(self.tree_count, -1, dtype=np.intp)
        for row in self.rows:
            found[row.trees] = np.arange(len(row.trees))
        return found
