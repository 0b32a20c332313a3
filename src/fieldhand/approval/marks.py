"""The marks of a planned mission on a map: legs, arrows, stops and their numbers."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

from fieldhand.approval.stops import Certainty, Leg, Plan, Stop

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Colours that stay apart for most colour-blind readers (Okabe and Ito 2008), on green trees.
PALETTE = ("#d55e00", "#0072b2", "#cc79a7", "#e69f00", "#56b4e9", "#8b5cf6", "#111111")
WAY, INK = "#26324f", "#2f2f2f"
LineStyle = Literal["solid"] | tuple[float, Sequence[float]]
#: Line style, width and opacity of a leg.
LINES: dict[Certainty, tuple[LineStyle, float, float]] = {
    "certain": ("solid", 2.2, 0.9),
    "budget": ("solid", 1.2, 0.65),
    "conditional": ((0.0, (4.0, 2.5)), 1.5, 0.8),
}
_OUTER, _OUTER_OF_MANY = 10.5, 8.0
#: More stops than this are not named by their trees; of longer loops only some visits are numbered.
_NAMED, _NUMBERED, _EVERY = 16, 12, 5

XY = tuple[float, float]
Box = tuple[float, float, float, float]


def colours_of(stops: Sequence[Stop]) -> dict[str, str]:
    """A colour for each action, in the order in which they come up."""
    names = list(dict.fromkeys(action for stop in stops for action in stop.actions))
    return {name: PALETTE[k % len(PALETTE)] for k, name in enumerate(names)}


def draw_leg(ax: Axes, leg: Leg) -> None:
    """A way, its line saying how certain it is."""
    style, width, alpha = LINES[leg.certainty]
    x, y = zip(*leg.points, strict=True)
    ax.plot(x, y, color=WAY, linestyle=style, linewidth=width, alpha=alpha, zorder=10, gid="leg")


def draw_arrows(ax: Axes, legs: Sequence[Leg]) -> None:
    """Arrow heads along the way, a fixed part of the picture apart, so that short legs are not covered by them."""
    from matplotlib.markers import MarkerStyle
    from matplotlib.path import Path as Outline
    from matplotlib.transforms import Affine2D

    head = Outline([(0, 1.1), (-0.75, -0.8), (0, -0.35), (0.75, -0.8), (0, 1.1)], closed=True)
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
            turn = math.degrees(math.atan2(ay1 - ay0, ax1 - ax0)) - 90
            marker = MarkerStyle(head, transform=Affine2D().rotate_deg(turn))
            count = max(1, round(length / (3 * gap)))
            for part in ((k + 0.6) / count for k in range(count)):
                ax.plot(
                    ax0 + part * (ax1 - ax0),
                    ay0 + part * (ay1 - ay0),
                    marker=marker,
                    markersize=9,
                    color=WAY,
                    markeredgecolor="white",
                    markeredgewidth=0.7,
                    zorder=11,
                    gid="arrow",
                )


def disc_size(stops: Sequence[Stop]) -> float:
    """Diameter of a disc in points: smaller where there are many."""
    return _OUTER if len(stops) <= _NAMED else _OUTER_OF_MANY


def draw_stop(ax: Axes, stop: Stop, colours: dict[str, str], disc: float) -> None:
    """One disc an action, one inside the other; hollow where it is not certain that it will be done."""
    x, y = stop.place.xy
    if stop.place.stand is not None:
        # The robot works from the aisle: a thin line to where it stands.
        ax.plot((x, stop.place.stand[0]), (y, stop.place.stand[1]), color=WAY, linewidth=0.9, alpha=0.7, zorder=9)
    if not stop.actions:
        ax.plot(x, y, marker="o", markersize=6, color="white", markeredgecolor=WAY, markeredgewidth=1.5, zorder=12)
    size = stop_size(stop, disc)
    # What is certain lies outside, so that a hollow disc stands for what may be added to it.
    for action, certainty in sorted(stop.actions.items(), key=lambda item: item[1] == "conditional"):
        hollow = certainty == "conditional"
        ax.plot(
            x,
            y,
            marker="o",
            markersize=max(size - (2.0 if hollow else 0.0), 3.0),
            color="white" if hollow else colours[action],
            markeredgecolor=colours[action] if hollow else "white",
            markeredgewidth=2.0 if hollow else 1.0,
            zorder=13,
            gid="stop",
        )
        size -= disc / 2


def stop_size(stop: Stop, disc: float) -> float:
    """Diameter of a stop's largest disc, in points."""
    return disc + disc / 2 * max(0, min(len(stop.actions), 4) - 1)


def draw_labels(ax: Axes, plan: Plan, markers: Sequence[XY], disc: float) -> None:
    """The numbers of the read-back's steps beside each stop, and which tree it is where stops are few.

    Args:
        ax: Drawn on, in metres.
        plan: Its stops are labelled; its legs stay as free as can be.
        markers: Places whose own names must stay free.
        disc: Diameter of a disc in points.
    """
    from matplotlib.patheffects import withStroke

    stops = plan.stops
    named = len(stops) <= _NAMED
    points = 8.5 if named else 7.5
    taken: list[Box] = [_around(_at(ax, s.place.xy), stop_size(s, disc) / 2) for s in stops]
    taken += [(x - 20, y - 22, x + 20, y + 9) for x, y in (_at(ax, xy) for xy in markers)]
    taken += _written(ax)
    taken += [_around(point, 1.5) for leg in plan.legs for point in _along(ax, leg)]
    for stop in stops:
        labels = [label for label in stop.labels if _worth_a_number(label, stops)]
        if not labels:
            continue
        text = ", ".join(_ranges(labels))
        if named and stop.place.kind == "tree":
            text += f"  tree {stop.place.id}"
        offset, side = _free_spot(
            ax, _at(ax, stop.place.xy), stop_size(stop, disc), (len(text) * points * 0.62, points * 1.5), taken
        )
        ax.annotate(
            text,
            stop.place.xy,
            xytext=offset,
            textcoords="offset points",
            ha=side,
            va="center",
            fontsize=points,
            fontweight="bold",
            color=INK,
            path_effects=[withStroke(linewidth=3.0, foreground="white")],
            zorder=14,
            gid="label",
        )


def _at(ax: Axes, xy: XY) -> XY:
    """Where a place is drawn, in points from the lower left of the figure."""
    figure = ax.get_figure(root=True)
    dots = 72.0 / (figure.dpi if figure is not None else 100.0)
    x, y = ax.transData.transform(xy)
    return (float(x) * dots, float(y) * dots)


def _written(ax: Axes) -> list[Box]:
    """The names that stand on the map already."""
    figure = ax.get_figure(root=True)
    dots = 72.0 / (figure.dpi if figure is not None else 100.0)
    boxes = [text.get_window_extent() for text in ax.texts if text.get_text()]
    return [(box.x0 * dots, box.y0 * dots, box.x1 * dots, box.y1 * dots) for box in boxes]


def _around(at: XY, half: float) -> Box:
    return (at[0] - half, at[1] - half, at[0] + half, at[1] + half)


def _along(ax: Axes, leg: Leg) -> list[XY]:
    """Points of the figure along a leg, six apart."""
    corners = [_at(ax, xy) for xy in leg.points]
    found: list[XY] = []
    for (x0, y0), (x1, y1) in itertools.pairwise(corners):
        count = min(int(math.hypot(x1 - x0, y1 - y0) / 6) + 1, 400)
        found += [(x0 + (x1 - x0) * k / count, y0 + (y1 - y0) * k / count) for k in range(count)]
    return found


def _free_spot(
    ax: Axes, at: XY, disc: float, size: tuple[float, float], taken: list[Box]
) -> tuple[tuple[float, float], Literal["left", "right", "center"]]:
    """Where a label covers least of the other labels and stops; remembers it as taken."""
    (x, y), (width, height) = at, size
    away = disc / 2 + 4
    left, bottom, right, top = _frame(ax)
    spots: tuple[tuple[float, float, Literal["left", "right", "center"]], ...] = (
        (away, 0.4 * height, "left"),
        (-away, 0.4 * height, "right"),
        (away, -0.6 * height, "left"),
        (-away, -0.6 * height, "right"),
        (0.0, away + 0.5 * height, "center"),
        (0.0, -away - 0.5 * height, "center"),
    )

    def box(spot: tuple[float, float, str]) -> Box:
        start = {"left": 0.0, "right": -width, "center": -width / 2}[spot[2]]
        west, south = x + spot[0] + start, y + spot[1] - height / 2
        return (west, south, west + width, south + height)

    def covered(spot: tuple[float, float, str]) -> float:
        own = box(spot)
        outside = width * height - _shared(own, (left, bottom, right, top))
        return 3 * outside + sum(_shared(own, other) for other in taken)

    best = min(spots, key=covered)
    taken.append(box(best))
    return (best[0], best[1]), best[2]


def _frame(ax: Axes) -> Box:
    """The part of the map that labels may use: the scale bar and the north arrow stand below it."""
    figure = ax.get_figure(root=True)
    dots = 72.0 / (figure.dpi if figure is not None else 100.0)
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    west, south = ax.transData.transform((x0, y0))
    east, north = ax.transData.transform((x1, y1))
    return (
        float(west) * dots,
        float(south + 0.105 * (north - south)) * dots,
        float(east) * dots,
        float(north) * dots,
    )


def _shared(one: Box, other: Box) -> float:
    """The area that two boxes share, in square points."""
    wide = min(one[2], other[2]) - max(one[0], other[0])
    tall = min(one[3], other[3]) - max(one[1], other[1])
    return max(0.0, wide) * max(0.0, tall)


def _worth_a_number(label: str, stops: Sequence[Stop]) -> bool:
    """In a long loop the first, the last and every fifth visit are numbered."""
    loop, _, visit = label.partition(".")
    if not visit:
        return True
    visits = [int(known.partition(".")[2]) for s in stops for known in s.labels if known.startswith(f"{loop}.")]
    return len(visits) <= _NUMBERED or int(visit) in (1, max(visits)) or int(visit) % _EVERY == 0


def _ranges(labels: Sequence[str]) -> list[str]:
    """Steps that follow each other as a range: 1, 2, 3 is "1-3"."""
    found: list[list[str]] = []
    for label in labels:
        last = found[-1][-1] if found else ""
        if last.isdigit() and label.isdigit() and int(label) == int(last) + 1:
            found[-1].append(label)
        else:
            found.append([label])
    return [f"{run[0]}\N{EN DASH}{run[-1]}" if len(run) > 2 else ", ".join(run) for run in found]
