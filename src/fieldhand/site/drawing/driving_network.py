"""Draw the drivable network: aisles and headlands as wide as the robot, closed aisles and unreachable trees."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.site.describe.aisles import lane_middle, lane_name, lanes
from fieldhand.site.drawing import colours
from fieldhand.site.drawing.ground import MANY, points_a_metre
from fieldhand.site.driving.network import DrivableNetwork, LineKind
from fieldhand.site.model import Site

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Points: least and greatest width of a band, and width of the lines of links and of closed aisles.
_THINNEST, _WIDEST, _LINE = 0.5, 14.0, 0.8
_BANDS: dict[LineKind, str] = {"aisle": colours.LANE, "headland": colours.HEADLAND}


def draw_network(ax: Axes, network: DrivableNetwork, width_m: float) -> None:
    """Draw the lines of the network: aisles and headlands as wide as the robot, links thin."""
    from matplotlib.collections import LineCollection

    wide = float(np.clip(width_m * points_a_metre(ax), _THINNEST, _WIDEST))
    for kind, colour in _BANDS.items():
        lines = [np.array(line.points) for line in network.of(kind)]
        if lines:
            band = LineCollection(lines, colors=colour, linewidths=wide, alpha=0.4, zorder=2.2, gid=kind)
            ax.add_collection(band, autolim=False)
    links = [np.array(line.points) for line in network.of("link")]
    if links:
        thin = LineCollection(
            links, colors=colours.LINK, linewidths=_LINE, linestyles=(0, (1, 2)), alpha=0.8, zorder=2.1, gid="link"
        )
        ax.add_collection(thin, autolim=False)


def draw_closed(ax: Axes, site: Site, closed: Sequence[str]) -> None:
    """Draw a dashed line along aisles that are closed to the robot."""
    from matplotlib.collections import LineCollection

    names = set(closed)
    lines = [lane_middle(site, lane) for lane in lanes(site) if lane_name(site, lane) in names] if names else []
    if lines:
        ax.add_collection(
            LineCollection(
                lines, colors=colours.NARROW, linewidths=_LINE + 0.4, linestyles=(0, (4, 2)), zorder=2.3, gid="closed"
            ),
            autolim=False,
        )


def draw_unreachable(ax: Axes, site: Site, ids: Sequence[str]) -> None:
    """Draw a cross over each tree that cannot be reached."""
    if not ids:
        return
    xy = np.array([site.by_id[k].place.xy for k in ids])
    size = float(np.clip(0.45 * site.spacing_m * points_a_metre(ax), 1.5, 5.0))
    ax.plot(
        xy[:, 0],
        xy[:, 1],
        linestyle="none",
        marker="x",
        markersize=size,
        markeredgewidth=0.28 * size,
        color=colours.UNREACHABLE,
        zorder=6.5,
        gid="unreachable",
        rasterized=len(ids) > MANY,
    )
