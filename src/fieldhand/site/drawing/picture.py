"""Draw the picture of a site with the derived rows and aisles, for the grower to check."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldhand.site.describe.driving import DrivingSummary
from fieldhand.site.drawing import colours
from fieldhand.site.drawing.blocks import draw_blocks
from fieldhand.site.drawing.driving_network import draw_closed, draw_network, draw_unreachable
from fieldhand.site.drawing.ground import (
    bounds_of,
    draw_gates,
    draw_markers,
    draw_scale_and_north,
    draw_zones,
)
from fieldhand.site.drawing.names import labels_on, name_ground, name_markers
from fieldhand.site.drawing.rows import LONGEST_NAME, draw_rows, name_trees
from fieldhand.site.drawing.saving import save_figure
from fieldhand.site.driving.network import DrivableNetwork
from fieldhand.site.model import Site
from fieldhand.site.names import short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Inches: height of the map, also for a very large site, its least width, strips above and below, and margin.
_HEIGHT_IN, _LARGE_HEIGHT_IN, _LEAST_WIDTH_IN, _HEAD_IN, _FOOT_IN, _MARGIN_IN = 9.0, 13.0, 5.5, 0.62, 0.4, 0.15
_LARGE = 20_000
#: Width in inches of an entry of the legend.
_ENTRY_IN = 1.2
#: Room in points for row names beyond the ends of the rows: width of a letter, and the maximum.
_LETTER, _MOST_FOR_NAMES = 5.6, 90.0


def save_site_picture(
    site: Site, path: Path, network: DrivableNetwork | None = None, driving: DrivingSummary | None = None
) -> None:
    """Draw the site into a picture file; the extension selects the format (``.png``, ``.svg``, ``.pdf``).

    Args:
        site: Site to draw.
        path: File to write.
        network, driving: As for :func:`site_picture`.

    Raises:
        OutputError: The file cannot be written, or its extension is not that of a picture format.
    """
    figure = site_picture(site, network, driving)
    save_figure(figure, path)


def site_picture(site: Site, network: DrivableNetwork | None = None, driving: DrivingSummary | None = None) -> Figure:
    """Return the picture as a figure without a window.

    Args:
        site: Site to draw, with coloured rows.
        network: Drivable lines of a robot, if they are to be drawn.
        driving: Width, closed aisles and unreachable trees of the same robot.
    """
    figure = _figure(site)
    ax = figure.axes[0]
    draw_zones(ax, site)
    if network is not None:
        draw_network(ax, network, driving.width_m if driving is not None else 1.0)
    draw_blocks(ax, site)
    draw_rows(ax, site)
    if driving is not None:
        draw_closed(ax, site, driving.closed)
        draw_unreachable(ax, site, [tree for u in driving.unreachable for tree in u.trees])
    draw_gates(ax, site)
    draw_markers(ax, site)
    draw_scale_and_north(ax)
    _write_names(ax, site)
    _write_head(figure, site)
    _write_legend(figure, site, network, driving)
    return figure


def _figure(site: Site) -> Figure:
    """Return a figure whose axes have exactly the shape of the site, so that names can be measured before drawing."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    west, south, east, north = bounds_of(site)
    tallest = _HEIGHT_IN if len(site.trees) < _LARGE else _LARGE_HEIGHT_IN
    ratio = (east - west) / (north - south)
    height = min(tallest if ratio <= 1.0 else tallest / math.sqrt(ratio), 1.6 * tallest / ratio)
    metre_in = height / (north - south)
    room = _room_for_names(site, 72 * metre_in) / 72 / metre_in
    west, south, east, north = west - room, south - room, east + room, north + room
    width, height = (east - west) * metre_in, (north - south) * metre_in
    whole = max(width, _LEAST_WIDTH_IN) + 2 * _MARGIN_IN
    tall = height + _HEAD_IN + _FOOT_IN
    figure = Figure(figsize=(whole, tall), facecolor="white")
    FigureCanvasAgg(figure)
    ax = figure.add_axes(((whole - width) / 2 / whole, _FOOT_IN / tall, width / whole, height / tall))
    ax.set_xlim(west, east)
    ax.set_ylim(south, north)
    ax.set_axis_off()
    return figure


def _room_for_names(site: Site, metre: float) -> float:
    """Return the points that row names need in addition to the margin."""
    longest = max((len(short(row.name, LONGEST_NAME)) for row in site.planting.rows), default=0)
    margin = 0.05 * float(np.ptp(site.outline_xy, axis=0).max()) * metre
    return max(0.0, min(longest * _LETTER + 10.0, _MOST_FOR_NAMES) - margin)


def _write_names(ax: Axes, site: Site) -> None:
    """Write the names, the most important first, so that they get the best places."""
    labels = labels_on(ax, site)
    name_markers(labels, site)
    name_ground(ax, labels, site, row_ink=None)
    name_trees(ax, labels, site)


def _write_head(figure: Figure, site: Site) -> None:
    width, height = figure.get_size_inches()
    left = _MARGIN_IN / width
    name = short(site.name, max(20, int(width * 8)))
    figure.text(left, 1 - 0.12 / height, name, ha="left", va="top", fontsize=12, fontweight="bold", color=colours.INK)
    figure.text(left, 1 - 0.36 / height, _in_short(site), ha="left", va="top", fontsize=8.5, color=colours.QUIET_INK)


def _in_short(site: Site) -> str:
    """Return the numbers of trees, rows, blocks and trees in no row in one line."""
    planting = site.planting
    words = [f"{len(site.trees):,} tree{'s' * (len(site.trees) != 1)}"]
    if planting.rows:
        rows, blocks = len(planting.rows), len(planting.blocks)
        words.append(f"{rows:,} row{'s' * (rows > 1)}" + (f" in {blocks} blocks" if blocks > 1 else ""))
        alone = int((planting.row_of < 0).sum())
        if alone:
            words.append(f"{alone:,} in no row")
    else:
        words.append("no rows")
    return ", ".join(words)


def _write_legend(figure: Figure, site: Site, network: DrivableNetwork | None, driving: DrivingSummary | None) -> None:
    """Write the legend of the symbols that occur."""
    from matplotlib.lines import Line2D

    planting = site.planting
    kinds = {line.kind for line in network.lines} if network is not None else set()
    robot = short(driving.robot, 16) if driving is not None else "robot"
    shown: list[tuple[bool, str, dict[str, Any]]] = [
        (
            bool(planting.rows),
            "row of trees",
            {"color": colours.ROWS[0], "marker": "o", "markersize": 5, "linewidth": 1.4},
        ),
        (
            bool(np.any(planting.row_of < 0)),
            "tree in no row",
            {"color": colours.NO_ROW, "marker": "o", "markersize": 5, "linestyle": "none"},
        ),
        ("aisle" in kinds, "aisle", {"color": colours.LANE, "linewidth": 4, "alpha": 0.5}),
        ("headland" in kinds, "headland", {"color": colours.HEADLAND, "linewidth": 4, "alpha": 0.5}),
        (
            driving is not None and bool(driving.closed),
            f"closed to the {robot}",
            {"color": colours.NARROW, "linewidth": 1.2, "linestyle": (0, (4, 2))},
        ),
        (
            driving is not None and bool(driving.unreachable),
            "cannot be reached",
            {"color": colours.UNREACHABLE, "marker": "x", "markersize": 5, "markeredgewidth": 1.4, "linestyle": "none"},
        ),
        (
            bool(site.gates),
            "gate",
            {"color": "white", "marker": "s", "markersize": 6, "markeredgecolor": colours.GATE, "linestyle": "none"},
        ),
    ]
    handles = [Line2D([], [], label=label, **style) for there, label, style in shown if there]
    if handles:
        across = max(1, int((figure.get_size_inches()[0] - 0.3) / _ENTRY_IN))
        figure.legend(
            handles=handles, loc="lower left", bbox_to_anchor=(0.01, 0.0), ncols=min(across, len(handles)),
            frameon=False, fontsize=8, labelcolor=colours.INK, handlelength=1.6, columnspacing=1.4,
        )  # fmt: skip
