"""Map marks of a planned mission: legs, arrows and stops."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from fieldhand.approval.stops import Certainty, Leg, MapStop
from fieldhand.site.bearings import bearing_of
from fieldhand.site.drawing.colours import PATH
from fieldhand.site.drawing.ground import disc_diameter

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.markers import MarkerStyle

#: Colours that most colour-blind readers can distinguish (Okabe and Ito 2008) on green trees.
PALETTE = ("#d55e00", "#0072b2", "#cc79a7", "#e69f00", "#56b4e9", "#8b5cf6", "#111111")
LineStyle = Literal["solid"] | tuple[float, Sequence[float]]
#: Line style, width and opacity of a leg.
LINES: dict[Certainty, tuple[LineStyle, float, float]] = {
    "certain": ("solid", 2.2, 0.9),
    "budget": ("solid", 1.2, 0.65),
    "conditional": ((0.0, (4.0, 2.5)), 1.5, 0.8),
}
#: Disc diameters in points: for up to :data:`MANY_STOPS` stops, and for more.
_OUTER, _OUTER_OF_MANY = 10.5, 8.0
MANY_STOPS = 16


def colours_of(stops: Sequence[MapStop]) -> dict[str, str]:
    """Return a colour for each action, in order of first appearance."""
    names = list(dict.fromkeys(action for stop in stops for action in stop.actions))
    return {name: PALETTE[k % len(PALETTE)] for k, name in enumerate(names)}


#: Colour and width in points of the parts of the route on which an implement is on.
WORKED, _WORKED_PT = "#e08a1e", 4.0


#: Colour and size in points of the mark for the robot's heading at a picture.
HEADING, HEADING_PT = "#ffd23f", 8.0


def draw_leg(ax: Axes, leg: Leg) -> None:
    """Draw a leg with a line style that shows its certainty."""
    style, width, alpha = LINES[leg.certainty]
    x, y = zip(*leg.points, strict=True)
    ax.plot(x, y, color=PATH, linestyle=style, linewidth=width, alpha=alpha, zorder=10, gid="leg")
    for part in leg.worked:
        x, y = zip(*part, strict=True)
        ax.plot(x, y, color=WORKED, linewidth=_WORKED_PT, alpha=0.55, solid_capstyle="butt", zorder=9, gid="worked")


def _arrow_head(heading_deg: float) -> MarkerStyle:
    """Return an arrow head that points in a heading, in degrees clockwise from north."""
    from matplotlib.markers import MarkerStyle
    from matplotlib.path import Path as Outline
    from matplotlib.transforms import Affine2D

    head = Outline([(0, 1.1), (-0.75, -0.8), (0, -0.35), (0.75, -0.8), (0, 1.1)], closed=True)
    return MarkerStyle(head, transform=Affine2D().rotate_deg(-heading_deg))


def draw_arrows(ax: Axes, legs: Sequence[Leg]) -> None:
    """Draw arrow heads along the route, spaced by a fixed fraction of the map so that short legs remain visible."""
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    gap = 0.09 * math.hypot(x1 - x0, y1 - y0)
    since = gap
    for leg in legs:
        for (ax0, ay0), (ax1, ay1) in itertools.pairwise(leg.points):
            length = math.hypot(ax1 - ax0, ay1 - ay0)
            since += length
            if length <= 0 or since < gap:
                continue
            since = 0.0
            marker = _arrow_head(bearing_of((ax0, ay0), (ax1, ay1)))
            count = max(1, round(length / (3 * gap)))
            for part in ((k + 0.6) / count for k in range(count)):
                ax.plot(
                    ax0 + part * (ax1 - ax0),
                    ay0 + part * (ay1 - ay0),
                    marker=marker,
                    markersize=9,
                    color=PATH,
                    markeredgecolor="white",
                    markeredgewidth=0.7,
                    zorder=11,
                    gid="arrow",
                )


def disc_size(ax: Axes, stops: Sequence[MapStop]) -> float:
    """Return the disc diameter in points, smaller where stops are many or close together on the map."""
    most = _OUTER if len(stops) <= MANY_STOPS else _OUTER_OF_MANY
    return disc_diameter(ax, np.array([stop.place.xy for stop in stops]).reshape(-1, 2), most)


def draw_stop(ax: Axes, stop: MapStop, colours: dict[str, str], disc: float) -> None:
    """Draw concentric discs, one per action; a hollow disc marks an uncertain action."""
    x, y = stop.place.xy
    if stop.place.stand is not None:
        # The robot works from the aisle: a thin line connects the tree to the robot's position.
        ax.plot((x, stop.place.stand[0]), (y, stop.place.stand[1]), color=PATH, linewidth=0.9, alpha=0.7, zorder=9)
    if stop.heading_deg is not None and stop.place.stand is not None:
        ax.plot(
            *stop.place.stand,
            marker=_arrow_head(stop.heading_deg),
            markersize=HEADING_PT,
            color=HEADING,
            markeredgecolor=PATH,
            markeredgewidth=0.8,
            zorder=12,
            gid="heading",
        )
    if not stop.actions:
        ax.plot(x, y, marker="o", markersize=6, color="white", markeredgecolor=PATH, markeredgewidth=1.5, zorder=12)
    size = stop_size(stop, disc)
    # Certain actions are drawn outside, so that a hollow inner disc marks a possible addition.
    for action, certainty in sorted(stop.actions.items(), key=lambda item: item[1] == "conditional"):
        hollow = certainty == "conditional"
        ax.plot(
            x,
            y,
            marker="o",
            markersize=max(size - (2.0 if hollow else 0.0), 3.0),
            color="white" if hollow else colours[action],
            markeredgecolor=colours[action] if hollow else "white",
            markeredgewidth=2.0 if hollow else min(1.0, 0.12 * disc),
            zorder=13,
            gid="stop",
        )
        size -= disc / 2


def stop_size(stop: MapStop, disc: float) -> float:
    """Return the diameter of a stop's outermost disc, in points."""
    return disc + disc / 2 * max(0, min(len(stop.actions), 4) - 1)
