"""Draw rows in alternating colours, with their names at both ends."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.drawing import colours
from fieldhand.site.drawing.ground import draw_dots, points_a_metre, tree_size
from fieldhand.site.drawing.labels import XY, Labels
from fieldhand.site.model import Site
from fieldhand.site.names import short
from fieldhand.site.planting import Block, Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_STEPS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
LONGEST_NAME = 16
#: Distance in points from the last tree of a row to its name, and additional distances to try.
_GAP, _FARTHER = 3.0, (0.0, 7.0, 13.0)
#: Trees are named only up to this number, and from this spacing in points on.
_MOST_IDS, _LEAST_ROOM = 400, 9.0


def draw_rows(ax: Axes, site: Site) -> None:
    """Draw the trees of each row in its colour with a line through them, and trees in no row in grey."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb

    size = tree_size(ax, site)
    palette = np.array([to_rgb(c) for c in (*colours.ROWS, colours.NO_ROW)])
    rows = site.planting.rows
    colour_of_row = np.array(
        [(row.number - 1) % len(colours.ROWS) for row in rows] + [len(colours.ROWS)], dtype=np.intp
    )
    long = [k for k, row in enumerate(rows) if len(row.trees) > 1]
    if long:
        width = float(np.clip(0.12 * math.sqrt(size) + 0.5, 0.6, 1.6))
        ax.add_collection(
            LineCollection(
                [site.xy[rows[k].trees] for k in long],
                colors=palette[colour_of_row[long]],
                linewidths=width,
                alpha=0.55,
                zorder=2.6,
                gid="rows",
            ),
            autolim=False,
        )
    draw_dots(ax, site.xy, size, palette[colour_of_row[site.planting.row_of]])


def name_rows(ax: Axes, labels: Labels, site: Site, *, ink: str | None = None) -> None:
    """Write names at both ends of the rows: of all rows, or of every second, fifth, tenth ... if they are too close.

    Args:
        ax: Axes of the map.
        labels: Labels of the map.
        site: Site that is drawn.
        ink: Colour of the names; None for that of each row's dots.
    """
    for block in site.planting.blocks:
        apart = (block.row_spacing_m if block.row_spacing_m == block.row_spacing_m else 10.0) * points_a_metre(ax)
        font = float(np.clip(0.8 * apart, 5.5, 8.0))
        names = [short(row.name, LONGEST_NAME) for row in block.rows]
        turn = math.radians(90.0 - block.bearing_deg)
        sizes = [labels.size(name, font, bold=True) for name in names]
        room = max(abs(math.sin(turn)) * w + abs(math.cos(turn)) * h for w, h in sizes) + 2.0
        along = room > apart and max(w for w, _ in sizes) > 1.6 * font  # long names are written along their rows
        if along:
            room = font * 1.05 + 2.0
        step = next((s for s in _STEPS if s * apart >= room), _STEPS[-1])
        turn_deg = 90.0 - (90.0 - math.degrees(turn)) % 180.0 if along else 0.0
        for k in _worth_naming(block, step):
            for end in (0, -1):
                spots = _beyond(ax, labels, site, block.rows[k], end, turn, sizes[k], along)
                labels.put(
                    names[k], spots, font=font, turn_deg=turn_deg, gid="row",
                    colour=ink or colours.ROW_INKS[(block.rows[k].number - 1) % len(colours.ROWS)], bold=True,
                )  # fmt: skip


def name_rows_within(ax: Axes, labels: Labels, site: Site) -> None:
    """Write names at both ends of the visible part of each row; of every second, fifth ... row if too close."""
    font, near, inside = 8.0, 1.5 * site.spacing_m, _shown(ax, site)
    for block in site.planting.blocks:
        there = [(row, row.trees[inside[row.trees]]) for row in block.rows if inside[row.trees].any()]
        apart = (block.row_spacing_m if block.row_spacing_m == block.row_spacing_m else near) * points_a_metre(ax)
        width = max((labels.size(short(row.name, LONGEST_NAME), font, bold=True)[0] for row, _ in there), default=0.0)
        step = next((s for s in _STEPS if s * apart >= max(width, font) + 3.0), _STEPS[-1])
        for row, trees in there:
            if step > 1 and row.number % step:
                continue
            text = short(row.name, LONGEST_NAME)
            size = labels.size(text, font, bold=True)
            for end in (0, -1):
                at = labels.at((float(site.xy[trees[end]][0]), float(site.xy[trees[end]][1])))
                out = _out(site, row, end)
                beyond = _GAP + 2.0 + abs(out[0]) * size[0] / 2 + abs(out[1]) * size[1] / 2
                spots = [(at[0] + out[0] * away, at[1] + out[1] * away) for away in (beyond, 0.0, -12.0, -24.0)]
                labels.put(text, spots, font=font, colour=colours.ROW_INK, bold=True, over_trees=True, gid="row")


def _out(site: Site, row: Row, end: int) -> XY:
    """Return the unit vector that points outwards at an end of a row."""
    way = (site.xy[row.trees[0]] - site.xy[row.trees[-1]]) * (1.0 if end == 0 else -1.0)
    length = float(np.hypot(*way))
    return (float(way[0]) / length, float(way[1]) / length) if length else (0.0, 1.0)


def _shown(ax: Axes, site: Site) -> NDArray[np.bool_]:
    """Return a mask of the trees within the limits of the axes, shape (n,)."""
    (west, east), (south, north) = ax.get_xlim(), ax.get_ylim()
    x, y = site.xy[:, 0], site.xy[:, 1]
    return np.asarray((west < x) & (x < east) & (south < y) & (y < north), dtype=np.bool_)


def name_trees(ax: Axes, labels: Labels, site: Site) -> None:
    """Write the ids of trees beside them, if few are visible and there is room."""
    room = site.spacing_m * points_a_metre(ax)
    shown = _shown(ax, site)
    if int(shown.sum()) > _MOST_IDS or room < _LEAST_ROOM:
        return
    font = float(np.clip(0.3 * room, 4.5, 7.0))
    radius = math.sqrt(tree_size(ax, site)) / 2
    planting = site.planting
    for tree in (site.trees[k] for k in np.flatnonzero(shown)):
        text = short(tree.place.id, 12)
        width, height = labels.size(text, font)
        x, y = labels.at(tree.place.xy)
        beside, over = radius + 1.0 + width / 2, radius + 1.0 + height / 2
        sideways: list[XY] = [(x + beside, y), (x - beside, y)]
        upright: list[XY] = [(x, y - over), (x, y + over)]
        row = int(planting.row_of[tree.index])
        lies = row >= 0 and planting.blocks[planting.rows[row].block].runs_east_west
        spots = upright + sideways if lies else sideways + upright
        labels.put(text, spots, font=font, colour=colours.QUIET_INK, zorder=6, gid="tree")


def _worth_naming(block: Block, step: int) -> list[int]:
    """Return the indices of the rows to be named, the more important first."""
    last = len(block.rows) - 1
    round_ones = [k for k in range(last + 1) if block.rows[k].number % step == 0 or step == 1]
    return list(dict.fromkeys([0, *round_ones, last]))


def _beyond(ax: Axes, labels: Labels, site: Site, row: Row, end: int, turn: float, size: XY, along: bool) -> list[XY]:
    """Return spots just beyond the last tree of a row, in line with it, nearest first."""
    last = site.xy[row.trees[end]]
    way = site.xy[row.trees[0]] - site.xy[row.trees[-1]]
    if len(row.trees) < 2 or not way.any():
        way = np.array([math.cos(turn), math.sin(turn)])
        way = way if way[1] > abs(way[0]) or way[0] < -abs(way[1]) else -way
    out = way / np.hypot(*way) * (1.0 if end == 0 else -1.0)
    width, height = size
    radius = math.sqrt(tree_size(ax, site)) / 2
    reach = width / 2 if along else abs(out[0]) * width / 2 + abs(out[1]) * height / 2
    x, y = labels.at((float(last[0]), float(last[1])))
    aways = (radius + _GAP + reach + more for more in _FARTHER)
    return [(x + float(out[0]) * away, y + float(out[1]) * away) for away in aways]
