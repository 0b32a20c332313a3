"""Draw the blocks of a site: an outline around the rows of each, and its name beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.drawing import colours
from fieldhand.site.drawing.labels import XY, Labels
from fieldhand.site.model import Site
from fieldhand.site.names import short
from fieldhand.site.planting import Block

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FONT = 9.0


def draw_blocks(ax: Axes, site: Site) -> None:
    """Draw an outline around each block, if there are several."""
    from matplotlib.collections import PolyCollection

    blocks = site.planting.blocks
    if len(blocks) < 2:
        return
    outlines = [np.asarray(outline_of(site, block).exterior.coords)[:, :2] for block in blocks]
    ax.add_collection(
        PolyCollection(
            outlines, facecolors="none", edgecolors=colours.BLOCK_EDGE, linewidths=0.9, zorder=2.4, gid="block outline"
        ),
        autolim=False,
    )


def outline_of(site: Site, block: Block) -> Any:
    """Return the polygon around a block's rows, following the row ends at about half a spacing."""
    import shapely

    first, last = block.rows[0].trees, block.rows[-1].trees
    ring = [
        *(row.trees[0] for row in block.rows),
        *last[1:-1],
        *(row.trees[-1] for row in reversed(block.rows)),
        *first[-2:0:-1],
    ]
    around: Any = shapely.Polygon(site.xy[ring]) if len(ring) > 3 else None
    if around is None or not around.is_valid:
        trees = np.concatenate([row.trees for row in block.rows])
        around = shapely.MultiPoint(site.xy[trees]).convex_hull
    return around.buffer(0.6 * max(site.spacing_m, np.nan_to_num(block.row_spacing_m), 0.1), quad_segs=4)


def name_blocks(labels: Labels, site: Site) -> None:
    """Write the name of each block beside it, if there are several."""
    blocks = site.planting.blocks
    if len(blocks) < 2:
        return
    for block in blocks:
        text = block_words(block)
        corners = _corners(labels, site, block)
        middle = corners.mean(axis=0)
        spots: list[XY] = []
        width, height = labels.size(text, _FONT, bold=True)
        for beyond in (24.0, 38.0, 12.0):
            for a, b in ((2, 3), (0, 1), (0, 2), (1, 3)):  # beyond the far ends, the usual ends, and at the sides
                side = (corners[a] + corners[b]) / 2
                out = (side - middle) / max(float(np.hypot(*(side - middle))), 1e-9)
                away = beyond + abs(out[0]) * width / 2 + abs(out[1]) * height / 2
                spots.append((float(side[0] + out[0] * away), float(side[1] + out[1] * away)))
        spots.append((float(middle[0]), float(middle[1])))
        labels.put(text, spots, font=_FONT, colour=colours.INK, bold=True, over_trees=True, gid="block")


def block_words(block: Block) -> str:
    """Return the name of a block, preceded by "block" if the name is short or a number."""
    return short(block.name, 24) if len(block.name) > 3 and not block.name.isdigit() else f"block {block.name}"


def _corners(labels: Labels, site: Site, block: Block) -> NDArray[np.float64]:
    """Return the drawn ends of the first and last row: the usual ends of both, then the other ends."""
    first, last = block.rows[0].trees, block.rows[-1].trees
    trees = (first[0], last[0], first[-1], last[-1])
    return np.array([labels.at((float(site.xy[t][0]), float(site.xy[t][1]))) for t in trees])
