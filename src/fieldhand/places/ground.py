"""The ground that trees stand on, for work over an area or along its edge."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import MultiPoint
from shapely.geometry.base import BaseGeometry

from fieldhand.site.model import Site

#: Shape of an outline, from 0 (tight) to 1 (convex).
_RATIO = 0.25


def ground_of_trees(site: Site, trees: Sequence[int]) -> BaseGeometry:
    """Return the outline of trees with half a row spacing around them, in local metres; empty without trees.

    The trees of each block have an outline of their own, as do those in no row.
    """
    planting = site.planting
    blocks: dict[int, list[int]] = {}
    for tree in trees:
        row = int(planting.row_of[tree]) if planting.blocks else -1
        blocks.setdefault(-1 if row < 0 else planting.rows[row].block, []).append(tree)
    parts = []
    for number, inside in blocks.items():
        margin = site.spacing_m / 2.0
        if number >= 0 and math.isfinite(planting.blocks[number].row_spacing_m):
            margin = planting.blocks[number].row_spacing_m / 2.0
        points = MultiPoint(np.asarray(site.xy[inside]))
        outline = shapely.concave_hull(points, ratio=_RATIO) if len(inside) > 3 else shapely.convex_hull(points)
        parts.append(outline.buffer(margin, join_style="mitre", mitre_limit=2.0))
    return shapely.union_all(parts)
