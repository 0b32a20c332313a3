"""Find the rows of a site: those that its file names, else those inferred from the positions of the trees.

- ``named`` reads rows, blocks and positions from the file and checks them against the positions of the trees.
- ``infer`` infers rows from the positions alone: ``patches`` finds the direction of rows in small patches of trees,
  ``regions`` merges patches that agree, ``tracing`` follows lines of trees in them, ``grouping`` and ``roads`` form
  blocks, ``evidence`` rejects rows that scattered trees would show as well, ``refine`` assigns the remaining trees.
- ``combine`` merges both results, and ``assemble`` numbers blocks, rows and planting positions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.planting import Planting
from fieldhand.site.point_index import PointIndex
from fieldhand.site.rows.assemble import assemble
from fieldhand.site.rows.combine import combine
from fieldhand.site.rows.labels import linked
from fieldhand.site.rows.named import named_rows
from fieldhand.site.rows.refine import InferredBlock
from fieldhand.terms import Value

#: Trees closer to each other than this, in metres, are one tree entered twice.
_TWICE_M = 0.2

__all__ = ["planting_of"]


def planting_of(xy: NDArray[np.float64], rows: Sequence[str], properties: Sequence[Mapping[str, Value]]) -> Planting:
    """Return the blocks and rows of a site, and the trees along each row with their planting positions.

    Consistent rows, blocks and positions of the file take precedence; the other trees are assigned to inferred rows. If
    there are none, the planting has no blocks and gives the reason.

    Args:
        xy: Trees in metres, shape (n, 2).
        rows: Name of each tree's row, empty if the file gives none.
        properties: Properties of each tree in the file.
    """
    named = named_rows(rows, properties, xy)
    seen = _seen(xy) if (named.row_of < 0).any() else []
    return assemble(xy, combine(xy, named, seen))


def _seen(xy: NDArray[np.float64]) -> list[InferredBlock]:
    """Infer rows from the points; duplicates of a tree are left out and join its row afterwards."""
    from fieldhand.site.rows.infer import infer_blocks

    first = first_entries(xy)
    kept = np.unique(first)
    copies = np.flatnonzero(first != np.arange(len(xy)))
    blocks = infer_blocks(xy[kept])
    found = []
    for block in blocks:
        rows = [kept[trees] for trees in block.rows]
        if len(copies):
            rows = [np.concatenate([trees, copies[np.isin(first[copies], trees)]]) for trees in rows]
        found.append(replace(block, rows=rows))
    return found


def first_entries(xy: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return for each tree the index of the first tree of the file at the same place."""
    index = PointIndex(xy)
    apart = index.nearest_few(xy, 2)[0][:, 1] if len(xy) > 1 else np.ones(len(xy))
    usual = float(np.median(apart[apart > 0])) if (apart > 0).any() else _TWICE_M
    pairs = index.pairs(min(_TWICE_M, 0.25 * usual))
    if not len(pairs):
        return np.arange(len(xy), dtype=np.intp)
    label = linked(len(xy), pairs[:, 0], pairs[:, 1])
    first = np.full(int(label.max()) + 1, len(xy), dtype=np.intp)
    np.minimum.at(first, label, np.arange(len(xy)))
    return np.asarray(first[label])
