"""The marks of a mission on a map of its report: ways, captures, values, what was left out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fieldhand.evaluation.report_facts import captures, end_of, out_of_reach
from fieldhand.evaluation.report_readings import Summary
from fieldhand.site.drawing.labels import Labels
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Arrived, Driving, Event, Faulted, Shed
from fieldhand.task.words import capitalised, say_action

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
XY = tuple[float, float]
#: Shape, colour and meaning, for the legend.
Mark = tuple[str, str, str]

#: Of even lightness steps, told apart by readers who see red and green, or blue and yellow, alike, and in grey.
COLOURS = "viridis"
WAY, INK, LEFT_OUT, FAILED = "#26324f", "#2f2f2f", "#8a5a00", "#b3261e"
#: Captures that measured nothing, by action (Okabe and Ito 2008).
PLAIN = ("#0072b2", "#d55e00", "#cc79a7", "#e69f00")
#: Points high are values; so many of them are written on a map at most.
FONT, _MOST_VALUES = 7.0, 60


def driven_ways(site: Site, events: Sequence[Event]) -> list[Floats]:
    """Each drive of the log in local metres, shape (n, 2); drives of which the log holds no way are left out."""
    return [way for way, _ in ways(site, events)]


def ways(site: Site, events: Sequence[Event]) -> list[tuple[Floats, bool]]:
    """The way of each drive in local metres, and whether the robot arrived."""
    found: list[tuple[Floats, bool]] = []
    arrived = False
    for event in reversed(events):
        if isinstance(event, Arrived):
            arrived = True
        elif isinstance(event, Driving):
            degrees = np.asarray(event.path, dtype=np.float64).reshape(-1, 2)
            if len(degrees) > 1 and np.isfinite(degrees).all():
                found.append((site.projection.metres(degrees[:, 0], degrees[:, 1]), arrived))
            arrived = False
    return found[::-1]


def draw_drives(ax: Axes, site: Site, events: Sequence[Event]) -> list[Mark]:
    """The way of each drive, dashed where it did not arrive, and where the robot stood at the end."""
    marks: list[Mark] = []
    drives = ways(site, events)
    since = math.inf
    for way, arrived in drives:
        style: Any = "solid" if arrived else (0, (3, 2))
        ax.plot(way[:, 0], way[:, 1], color=WAY, linewidth=1.3, alpha=0.8, linestyle=style, zorder=10, gid="way")
        # Arrows lie an eighth of the map apart, so that many short legs are not covered by them.
        parts = np.diff(way, axis=0)
        lengths = np.hypot(parts[:, 0], parts[:, 1])
        since += float(lengths.sum())
        longest = int(lengths.argmax())
        if since > 0.125 * float(np.ptp(ax.get_xlim())) and lengths[longest] > 1e-6:
            since = 0.0
            middle = (way[longest] + way[longest + 1]) / 2
            ax.annotate(
                "",
                xy=tuple(middle + parts[longest] * 0.02),
                xytext=tuple(middle),
                arrowprops={"arrowstyle": "-|>", "color": WAY, "mutation_scale": 9, "linewidth": 0},
                zorder=11,
            )
    if any(arrived for _, arrived in drives):
        marks.append(("line", WAY, "driven"))
    if any(not arrived for _, arrived in drives):
        marks.append(("dashed", WAY, "did not arrive"))
    for x, y in last_stand(site, events):
        ax.plot(x, y, "o", markersize=9, color="none", markeredgecolor=WAY, markeredgewidth=1.6, zorder=16)
        marks.append(("ring", WAY, "robot at the end"))
    return marks


def last_stand(site: Site, events: Sequence[Event]) -> Floats:
    """Where the robot was when the mission was over, shape (1, 2); (0, 2) where the log does not say."""
    ended = end_of(events)
    if ended is None or not (math.isfinite(ended.lat) and math.isfinite(ended.lon)):
        return np.zeros((0, 2))
    return np.asarray(site.projection.metres([ended.lat], [ended.lon]), dtype=np.float64)


def draw_left_out(ax: Axes, site: Site, events: Sequence[Event], missed: Sequence[str], disc: float) -> list[Mark]:
    """Trees that were given up or not come to, and those that a drive did not reach."""
    marks: list[Mark] = []
    # Those to which no way led have a mark of their own.
    shed = [e for e in events if isinstance(e, Shed) and not out_of_reach(e)]
    groups: tuple[tuple[str, str, Sequence[str]], ...] = (
        ("ring", "left out", [p for e in shed if e.optional for p in e.places]),
        ("cross", "given up, though to be done", [p for e in shed if not e.optional for p in e.places]),
        ("dot", "not reached", missed),
    )
    shapes: dict[str, dict[str, Any]] = {
        "ring": {"marker": "o", "markerfacecolor": "none"},
        "cross": {"marker": "x"},
        "dot": {"marker": ".", "markerfacecolor": LEFT_OUT},
    }
    for shape, word, places in groups:
        xy = _trees(site, places)
        if len(xy):
            ax.plot(
                *(xy[:, 0], xy[:, 1]), linestyle="none", markersize=0.75 * disc, markeredgecolor=LEFT_OUT,
                markeredgewidth=1.3, zorder=12, gid="left out", **shapes[shape],
            )  # fmt: skip
            marks.append((shape, LEFT_OUT, word))
    xy = unreached(site, events)
    if len(xy):
        ax.plot(xy[:, 0], xy[:, 1], "s", color="none", markersize=disc + 2, markeredgecolor=FAILED, zorder=15)
        marks.append(("square", FAILED, "a drive did not get there"))
    return marks


def unreached(site: Site, events: Sequence[Event]) -> Floats:
    """Where drives that failed were to lead, shape (n, 2)."""
    towards, missed = "", []
    for event in events:
        if isinstance(event, Driving):
            towards = event.place
        elif isinstance(event, Faulted) and event.fault == "drive_failed":
            missed.append(towards)
    return _trees(site, missed)


def draw_readings(ax: Axes, site: Site, good: Sequence[Acted], summary: Summary, disc: float) -> None:
    """Captures coloured by value; the last reading of a place lies on top."""
    from matplotlib import colormaps

    shown = [e for e in good if math.isfinite(e.readings.get(summary.quantity, math.nan))]
    values = np.array([e.readings[summary.quantity] for e in shown])
    if not len(values):
        return
    xy = metres_of(site, shown)
    low, high = float(values.min()), float(values.max())
    if high - low < 1e-9:
        low, high = low - 0.5, high + 0.5
    dots = ax.scatter(
        *(xy[:, 0], xy[:, 1]), c=values, cmap=colormaps[COLOURS], vmin=low, vmax=high, s=disc**2,
        edgecolors=INK, linewidths=0.7, zorder=13,
    )  # fmt: skip
    dots.set_gid("readings")


def draw_plain(ax: Axes, site: Site, plain: Sequence[Acted], disc: float) -> list[Mark]:
    """Captures that measured nothing, coloured by what was done."""
    marks: list[Mark] = []
    for k, action in enumerate(dict.fromkeys(e.action for e in plain)):
        xy = metres_of(site, [e for e in plain if e.action == action])
        colour = PLAIN[k % len(PLAIN)]
        ax.plot(xy[:, 0], xy[:, 1], "o", color=colour, markersize=disc, markeredgecolor=INK, zorder=13)
        marks.append(("disc", colour, capitalised(say_action(action))))
    return marks


def draw_failed(ax: Axes, site: Site, events: Sequence[Event], disc: float) -> list[Mark]:
    """Captures that failed and did not succeed when tried again."""
    good = {(e.node, e.action, e.place) for e in captures(events) if e.status == "success"}
    failed = [e for e in placed(events) if e.status != "success" and (e.node, e.action, e.place) not in good]
    if not failed:
        return []
    xy = metres_of(site, failed)
    ax.plot(xy[:, 0], xy[:, 1], "X", color=FAILED, markersize=disc, markeredgecolor="white", zorder=14)
    return [("saltire", FAILED, "failed")]


def write_values(labels: Labels, site: Site, good: Sequence[Acted], summary: Summary, disc: float) -> None:
    """The last reading of each place beside it, where it covers nothing; none where there are many."""
    last = {(e.kind, e.place): e for e in good if math.isfinite(e.readings.get(summary.quantity, math.nan))}
    spots = {key: labels.at((float(x), float(y))) for key, (x, y) in zip(
        last, metres_of(site, list(last.values())), strict=True)}  # fmt: skip
    for at in spots.values():
        labels.keep_free(at, disc / 2)
    if len(last) > _MOST_VALUES:
        return
    for key, event in last.items():
        text = summary.say(event.readings[summary.quantity])
        beside = _around(spots[key], labels.size(text, FONT, bold=True), disc / 2 + 1.5)
        labels.put(text, beside, font=FONT, colour=INK, bold=True, over_trees=True, zorder=20, gid="value")


def _around(at: XY, size: XY, gap: float) -> list[XY]:
    """Above, below, right and left of a symbol, then at its corners."""
    (x, y), (width, height) = at, size
    over, beside = gap + height / 2, gap + width / 2
    straight = [(x, y + over), (x, y - over), (x + beside, y), (x - beside, y)]
    aslant = 0.75
    return straight + [(x + a * aslant * beside, y + b * aslant * over) for a in (1, -1) for b in (1, -1)]


def placed(events: Sequence[Event]) -> list[Acted]:
    """The captures of which the log says where they were made."""
    return [e for e in captures(events) if math.isfinite(e.lat) and math.isfinite(e.lon)]


def metres_of(site: Site, events: Sequence[Acted]) -> Floats:
    """Return where captures were made, shape (n, 2)."""
    if not events:
        return np.zeros((0, 2))
    return np.asarray(site.projection.metres([e.lat for e in events], [e.lon for e in events]), dtype=np.float64)


def _trees(site: Site, places: Sequence[str]) -> Floats:
    found = [site.by_id[p].place.xy for p in dict.fromkeys(places) if p in site.by_id]
    return np.asarray(found, dtype=np.float64).reshape(-1, 2)
