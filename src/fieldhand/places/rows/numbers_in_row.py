"""Compute the positions of trees in their rows and blocks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fieldhand.places.place_group import PlaceGroup
from fieldhand.site.counting import require_rows
from fieldhand.site.model import Site
from fieldhand.site.planting import Block, Indices, Row


def numbers_in_row(spots: PlaceGroup, way: Indices) -> tuple[Indices, Indices]:
    """Return for each place its number among the group in its row, and the number of the group in that row.

    Args:
        spots: The group.
        way: For each row of the site 1 to count its trees from the usual end, -1 from the other end.

    Returns:
        Numbers from 1 and counts, shape (n,) each; 0 for places in no row.
    """
    row = spots.row
    key = spots.rank_in_row * np.where(row >= 0, way[row], 1)
    order = np.lexsort((key, row))
    first = np.searchsorted(row[order], row[order], side="left")
    number = np.zeros(len(spots), dtype=np.intp)
    number[order] = np.arange(1, len(spots) + 1) - first
    sizes = np.bincount(row + 1, minlength=len(way) + 1)
    sizes[0] = 0
    return np.where(row >= 0, number, 0), sizes[row + 1]


def blocks_of(site: Site, spots: PlaceGroup) -> tuple[Block, ...]:
    """Return the blocks of these places, in the site's order."""
    planting = require_rows(site)
    rows = spots.row
    of_row = np.array([row.block for row in planting.rows], dtype=np.intp)
    return tuple(planting.blocks[k] for k in np.unique(of_row[np.unique(rows[rows >= 0])]).tolist())


def in_those_rows(spots: PlaceGroup, rows: Sequence[Row]) -> PlaceGroup:
    """Return the places in the given rows."""
    chosen = np.zeros(len(spots.site.trees) + 1, dtype=bool)
    for row in rows:
        chosen[row.trees] = True
    return spots.keep(chosen[np.where(spots.is_tree, spots.index, -1)])
