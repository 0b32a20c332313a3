"""The driven path with its captures coloured by what they read: one map for each quantity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import OutputError
from fieldhand.evaluation.report_data import captures
from fieldhand.site.drawing import draw_site, site_figure
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Driving, Ended, Event, Started
from fieldhand.task.words import capitalised, say_action, say_name, say_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_WAY, _INK, _FAILED = "#26324f", "#2f2f2f", "#b3261e"
_MAPS = ("inferno", "viridis", "cividis", "plasma")
_NO_READING = ("#0072b2", "#d55e00", "#cc79a7", "#e69f00")
#: Inches: a map is this high and at most this wide, its colour bar this wide; at most so many maps are drawn.
_HEIGHT_IN, _WIDEST_IN, _BAR_IN, _MOST = 7.5, 8.5, 1.2, 6
#: As many values are written beside their places.
_FEW = 12


def save_path_picture(site: Site, events: Sequence[Event], path: Path) -> None:
    """Draw the driven path and the captures.

    Raises:
        OutputError: The file cannot be written.
    """
    figure = draw_path_picture(site, events)
    try:
        figure.savefig(path, dpi=130)
    except OSError as fault:
        raise OutputError(
            f"the picture cannot be written ({fault.strerror or fault})", where=str(path), advice="choose another place"
        ) from None


def draw_path_picture(site: Site, events: Sequence[Event]) -> Figure:
    """The picture as a figure that belongs to no window: a map a quantity, and one for captures without readings."""
    made = [e for e in captures(events) if math.isfinite(e.lat) and math.isfinite(e.lon)]
    good = [e for e in made if e.status == "success"]
    failed = [e for e in made if e.status != "success"]
    quantities = list(dict.fromkeys(q for e in good for q in e.readings))[:_MOST]
    plain = [e for e in good if not e.readings]
    titles: list[str] = quantities + ([""] if plain or not quantities else [])
    figure = _figure(site, len(titles))
    ways = driven_ways(site, events)
    for k, (ax, quantity) in enumerate(zip(figure.axes, titles, strict=True)):
        draw_site(ax, site)
        _draw_ways(ax, ways)
        if quantity:
            _draw_readings(figure, ax, site, good, quantity, _MAPS[k % len(_MAPS)])
        else:
            _draw_plain(ax, site, plain)
        if failed:
            x, y = _metres(site, failed)
            ax.plot(x, y, "X", color=_FAILED, markersize=8, markeredgecolor="white", zorder=14, label="Failed")
        if ax.get_legend_handles_labels()[0]:
            ax.legend(loc="upper left", bbox_to_anchor=(0.0, 0.0), frameon=False, fontsize=9, labelcolor=_INK)
    figure.suptitle(_title(events), x=0.02, ha="left", fontsize=11, color=_INK)
    return figure


def driven_ways(site: Site, events: Sequence[Event]) -> list[Floats]:
    """Each drive of the log in local metres, shape (n, 2); drives of which the log holds no way are left out."""
    ways = []
    for event in events:
        if isinstance(event, Driving) and len(event.path) > 1:
            degrees = np.asarray(event.path, dtype=np.float64).reshape(-1, 2)
            if np.isfinite(degrees).all():
                ways.append(site.projection.metres(degrees[:, 0], degrees[:, 1]))
    return ways


def _figure(site: Site, maps: int) -> Figure:
    """A figure with one axes for each map, side by side, in two rows where there are more than three."""
    figure = site_figure(site)
    draw_site(figure.axes[0], site)
    (x0, x1), (y0, y1) = figure.axes[0].get_xlim(), figure.axes[0].get_ylim()
    figure.clear()
    columns = maps if maps <= 3 else math.ceil(maps / 2)
    rows = math.ceil(maps / columns)
    high = (_HEIGHT_IN if rows == 1 else 0.75 * _HEIGHT_IN) * (1.0 if columns == 1 else 0.85)
    wide = high * (x1 - x0) / (y1 - y0)
    shrink = min(1.0, _WIDEST_IN / wide)
    figure.set_size_inches(columns * (max(wide * shrink, 2.2) + _BAR_IN), rows * high * shrink + 0.5)
    for k in range(maps):
        figure.add_subplot(rows, columns, k + 1)
    return figure


def _draw_ways(ax: Axes, ways: Sequence[Floats]) -> None:
    for way in ways:
        ax.plot(way[:, 0], way[:, 1], color=_WAY, linewidth=1.6, alpha=0.75, zorder=10, gid="way")
        middle, ahead = _middle(way)
        if ahead is not None:
            ax.annotate(
                "",
                xy=tuple(ahead),
                xytext=tuple(middle),
                arrowprops={"arrowstyle": "-|>", "color": _WAY, "mutation_scale": 13, "linewidth": 0},
                zorder=11,
            )


def _middle(way: Floats) -> tuple[Floats, Floats | None]:
    """The middle of the longest part of a way, and a point just ahead of it; none on a way without length."""
    parts = np.diff(way, axis=0)
    lengths = np.hypot(parts[:, 0], parts[:, 1])
    longest = int(lengths.argmax())
    middle = (way[longest] + way[longest + 1]) / 2
    if lengths[longest] < 1e-6:
        return middle, None
    return middle, middle + parts[longest] * 0.02


def _draw_readings(figure: Figure, ax: Axes, site: Site, good: Sequence[Acted], quantity: str, colours: str) -> None:
    """Captures coloured by value, few of them with the value beside; the last reading of a place lies on top."""
    from matplotlib.patheffects import withStroke

    with_it = [e for e in good if math.isfinite(e.readings.get(quantity, math.nan))]
    unit = next((e.units[quantity] for e in with_it if quantity in e.units), "")
    values = np.array([e.readings[quantity] for e in with_it])
    x, y = _metres(site, with_it)
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    alone = high - low < 1e-9
    if alone:
        low, high = low - 0.5, high + 0.5
    dots = ax.scatter(
        x, y, c=values, cmap=colours, vmin=low, vmax=high, s=95, edgecolors="white", linewidths=1.2, zorder=13
    )
    bar = figure.colorbar(dots, ax=ax, shrink=0.6, pad=0.02)
    bar.set_label(f"{capitalised(say_name(quantity))} [{say_unit(unit)}]" if unit else say_name(quantity))
    bar.outline.set_visible(False)
    if alone:
        bar.set_ticks([(low + high) / 2])
    for px, py, value in zip(x, y, values, strict=True) if len(values) <= _FEW else ():
        ax.annotate(
            f"{value:.4g}",
            (px, py),
            xytext=(8, 6),
            textcoords="offset points",
            fontsize=8.5,
            fontweight="bold",
            color=_INK,
            path_effects=[withStroke(linewidth=3, foreground="white")],
            zorder=15,
        )


def _draw_plain(ax: Axes, site: Site, plain: Sequence[Acted]) -> None:
    """Captures that measured nothing, by action."""
    for k, action in enumerate(dict.fromkeys(e.action for e in plain)):
        x, y = _metres(site, [e for e in plain if e.action == action])
        label = capitalised(say_action(action))
        colour = _NO_READING[k % len(_NO_READING)]
        ax.plot(x, y, "o", color=colour, markersize=9, markeredgecolor="white", zorder=13, label=label)


def _metres(site: Site, events: Sequence[Acted]) -> tuple[Floats, Floats]:
    if not events:
        return np.zeros(0), np.zeros(0)
    xy = site.projection.metres([e.lat for e in events], [e.lon for e in events])
    return xy[:, 0], xy[:, 1]


def _title(events: Sequence[Event]) -> str:
    ended = next((e for e in reversed(events) if isinstance(e, Ended)), None)
    started = next((e for e in events if isinstance(e, Started)), None)
    robot = started.robot if started else "robot"
    made = sum(e.status == "success" for e in captures(events))
    what = f"{made} capture{'s' * (made != 1)}"
    if ended is None:
        return f"{robot}: cut off, {what}".replace("$", r"\$")
    return f"{robot}: {ended.status}, {ended.travelled_m:.0f} m driven, {what}".replace("$", r"\$")
