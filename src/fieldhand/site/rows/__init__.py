"""Find the rows of a site: those that its file names, else those inferred from the positions of the trees.

- ``named``: what the file says about rows, blocks and positions, and whether that makes sense on the ground.
- ``infer``: rows from bare points. ``patches`` finds which way rows run in small patches of trees, ``regions`` puts
  patches that agree together, ``tracing`` follows lines of trees there, ``grouping`` makes blocks of them,
  ``evidence`` throws out what scattered trees would show as well, ``settle`` gives trees on their own a home.
- ``combine`` puts both together, and ``assemble`` numbers blocks, rows and planting positions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.planting import Planting
from fieldhand.site.rows.assemble import assemble
from fieldhand.site.rows.combine import combine
from fieldhand.site.rows.labels import linked
from fieldhand.site.rows.named import named_rows
from fieldhand.site.rows.refine import InferredBlock
from fieldhand.terms import Value

#: Trees nearer to each other than this, in metres, are one tree entered twice.
_TWICE_M = 0.2

__all__ = ["planting_of"]


def planting_of(xy: NDArray[np.float64], rows: Sequence[str], properties: Sequence[Mapping[str, Value]]) -> Planting:
    """Return the blocks and rows of a site, and the trees along each row with their planting positions.

    The file's own rows, blocks and positions win where they make sense; the other trees are in the rows that can be
    seen in how they stand. Where none can, the planting has no blocks and says why.

    Args:
        xy: Trees in metres, shape (n, 2).
        rows: The name of each tree's row, empty where the file gives none.
        properties: What else the file says of each tree.
    """
    named = named_rows(rows, properties, xy)
    seen = _seen(xy) if (named.row_of < 0).any() else []
    return assemble(xy, combine(xy, named, seen))


def _seen(xy: NDArray[np.float64]) -> list[InferredBlock]:
    """Rows from the points; trees entered twice are seen once, and stand where the other does."""
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
    """Of each tree the first of the file that stands in the same place."""
    from scipy.spatial import cKDTree

    tree = cKDTree(xy)
    apart = np.asarray(tree.query(xy, k=2)[0])[:, 1] if len(xy) > 1 else np.ones(len(xy))
    usual = float(np.median(apart[apart > 0])) if (apart > 0).any() else _TWICE_M
    pairs = tree.query_pairs(min(_TWICE_M, 0.25 * usual), output_type="ndarray")
    if not len(pairs):
        return np.arange(len(xy), dtype=np.intp)
    label = linked(len(xy), pairs[:, 0], pairs[:, 1])
    first = np.full(int(label.max()) + 1, len(xy), dtype=np.intp)
    np.minimum.at(first, label, np.arange(len(xy)))
    return np.asarray(first[label])
