"""Marks of a mission on a map of its report: drives, captures, values, work left out, incidents."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fieldhand.evaluation.report.log_facts import captures, cut_off_places, end_of, failed_targets
from fieldhand.evaluation.report.readings import ReadingSummary
from fieldhand.language.words import capitalised, say_action, say_name
from fieldhand.site.drawing.colours import FAILED, INK, PATH
from fieldhand.site.drawing.labels import Labels
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Arrived, Driving, Event, InDoubt, Obstructed, Resumed, Shed, Worked, Working

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
XY = tuple[float, float]
#: An entry of the legend: shape, colour and meaning.
LegendEntry = tuple[str, str, str]

#: Perceptually uniform; legible with colour blindness and in grey.
COLOURS = "viridis"
LEFT_OUT, DOUBT = "#8a5a00", "#6a1b9a"
#: Captures that measured nothing, by action (Okabe and Ito 2008).
PLAIN = ("#0072b2", "#d55e00", "#cc79a7", "#e69f00")
#: Font size of values in points, and the most values written on a map.
FONT, _MOST_VALUES = 7.0, 60


def driven_ways(site: Site, events: Sequence[Event]) -> list[tuple[Floats, bool]]:
    """Return the logged way of each drive in local metres, shape (n, 2), and True if the robot arrived."""
    found: list[tuple[Floats, bool]] = []
    arrived = False
    for event in reversed(events):
        if isinstance(event, Arrived) or (isinstance(event, Worked) and event.status == "success"):
            arrived = True
        elif isinstance(event, Driving | Working):
            degrees = np.asarray(event.path, dtype=np.float64).reshape(-1, 2)
            if len(degrees) > 1 and np.isfinite(degrees).all():
                found.append((site.projection.metres(degrees[:, 0], degrees[:, 1]), arrived))
            arrived = False
    return found[::-1]


def draw_worked(ax: Axes, site: Site, events: Sequence[Event]) -> list[LegendEntry]:
    """Draw the parts of the way on which an implement was on, in a colour for each action."""
    entries: dict[str, LegendEntry] = {}
    for event in events:
        if not isinstance(event, Worked) or not event.action:
            continue
        known = list(dict.fromkeys([*entries, event.action]))
        colour = PLAIN[known.index(event.action) % len(PLAIN)]
        for part in event.paths:
            degrees = np.asarray(part, dtype=np.float64).reshape(-1, 2)
            if len(degrees) < 2 or not np.isfinite(degrees).all():
                continue
            way = site.projection.metres(degrees[:, 0], degrees[:, 1])
            ax.plot(way[:, 0], way[:, 1], color=colour, linewidth=3.2, alpha=0.6, zorder=9, gid="worked")
            entries.setdefault(event.action, ("line", colour, f"worked: {say_name(event.action)}"))
    return list(entries.values())


def draw_drives(ax: Axes, site: Site, events: Sequence[Event]) -> list[LegendEntry]:
    """Draw the way of each drive, dashed if it did not arrive, and the last position of the robot."""
    entries: list[LegendEntry] = []
    drives = driven_ways(site, events)
    since = math.inf
    for way, arrived in drives:
        style: Any = "solid" if arrived else (0, (3, 2))
        ax.plot(way[:, 0], way[:, 1], color=PATH, linewidth=1.3, alpha=0.8, linestyle=style, zorder=10, gid="way")
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
                arrowprops={"arrowstyle": "-|>", "color": PATH, "mutation_scale": 9, "linewidth": 0},
                zorder=11,
            )
    if any(arrived for _, arrived in drives):
        entries.append(("line", PATH, "driven"))
    if any(not arrived for _, arrived in drives):
        entries.append(("dashed", PATH, "did not arrive"))
    for x, y in last_stand(site, events):
        ax.plot(x, y, "o", markersize=9, color="none", markeredgecolor=PATH, markeredgewidth=1.6, zorder=16)
        entries.append(("ring", PATH, "robot at the end"))
    return entries


def last_stand(site: Site, events: Sequence[Event]) -> Floats:
    """Return the robot's position at the end of the mission, shape (1, 2), or (0, 2) if the log lacks it."""
    ended = end_of(events)
    if ended is None or not (math.isfinite(ended.lat) and math.isfinite(ended.lon)):
        return np.zeros((0, 2))
    return np.asarray(site.projection.metres([ended.lat], [ended.lon]), dtype=np.float64)


def draw_left_out(
    ax: Axes, site: Site, events: Sequence[Event], ahead: Sequence[str], disc: float
) -> list[LegendEntry]:
    """Draw trees that were given up or not reached, and those to which a drive failed."""
    entries: list[LegendEntry] = []
    # Those to which no way led are drawn by draw_incidents.
    shed = [e for e in events if isinstance(e, Shed) and e.cause in ("budget", "event")]
    groups: tuple[tuple[str, str, Sequence[str]], ...] = (
        ("ring", "left out", [p for e in shed if e.optional for p in e.places]),
        ("cross", "given up, though to be done", [p for e in shed if not e.optional for p in e.places]),
        ("dot", "not reached", ahead),
    )
    shapes: dict[str, dict[str, Any]] = {
        "ring": {"marker": "o", "markerfacecolor": "none"},
        "cross": {"marker": "x"},
        "dot": {"marker": ".", "markerfacecolor": LEFT_OUT},
    }
    for shape, word, places in groups:
        xy = trees_xy(site, places)
        if len(xy):
            ax.plot(
                *(xy[:, 0], xy[:, 1]), linestyle="none", markersize=0.75 * disc, markeredgecolor=LEFT_OUT,
                markeredgewidth=1.3, zorder=12, gid="left out", **shapes[shape],
            )  # fmt: skip
            entries.append((shape, LEFT_OUT, word))
    xy = trees_xy(site, failed_targets(events))
    if len(xy):
        ax.plot(xy[:, 0], xy[:, 1], "s", color="none", markersize=disc + 2, markeredgecolor=FAILED, zorder=15)
        entries.append(("square", FAILED, "a drive did not get there"))
    return entries


def draw_incidents(ax: Axes, site: Site, events: Sequence[Event], disc: float) -> list[LegendEntry]:
    """Draw obstacles known at the end, trees to which no way led, captures in doubt and power cuts."""
    from matplotlib.collections import PolyCollection

    entries: list[LegendEntry] = []
    areas = _blocked_areas(site, events)
    if areas:
        ax.add_collection(
            PolyCollection(areas, facecolors=f"{FAILED}55", edgecolors=FAILED, linewidths=1.0, zorder=9), autolim=False
        )
        entries.append(("area", FAILED, "something stands in the way"))
    xy = trees_xy(site, cut_off_places(events))
    if len(xy):
        ax.plot(
            *(xy[:, 0], xy[:, 1]), "x", markersize=0.75 * disc, markeredgecolor=FAILED, markeredgewidth=1.6, zorder=12,
            gid="out of reach",
        )  # fmt: skip
        entries.append(("cross", FAILED, "no way led there"))
    for x, y in metres_of(site, [e for e in events if isinstance(e, InDoubt)]):
        ax.plot(x, y, "o", color="none", markersize=disc + 4, markeredgecolor=DOUBT, markeredgewidth=1.4, zorder=15)
        entries.append(("ring", DOUBT, "capture in doubt"))
    for x, y in metres_of(site, [e for e in events if isinstance(e, Resumed)]):
        ax.plot(x, y, "D", color="white", markersize=0.6 * disc, markeredgecolor=DOUBT, markeredgewidth=1.2, zorder=15)
        entries.append(("diamond", DOUBT, "went on after a power cut"))
    return entries


def _blocked_areas(site: Site, events: Sequence[Event]) -> list[Floats]:
    """Return the areas that the robot avoided at the end, in local metres, each of shape (n, 2)."""
    last = next((e for e in reversed(events) if isinstance(e, Obstructed)), None)
    found = [np.asarray(area, dtype=np.float64).reshape(-1, 2) for area in (() if last is None else last.blocked)]
    return [site.projection.metres(a[:, 0], a[:, 1]) for a in found if len(a) > 2 and np.isfinite(a).all()]


def draw_readings(ax: Axes, site: Site, good: Sequence[Acted], summary: ReadingSummary, disc: float) -> None:
    """Draw captures coloured by value, the last reading of a place on top."""
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


def draw_plain(ax: Axes, site: Site, plain: Sequence[Acted], disc: float) -> list[LegendEntry]:
    """Draw captures that measured nothing, coloured by action."""
    entries: list[LegendEntry] = []
    for k, action in enumerate(dict.fromkeys(e.action for e in plain)):
        xy = metres_of(site, [e for e in plain if e.action == action])
        colour = PLAIN[k % len(PLAIN)]
        ax.plot(xy[:, 0], xy[:, 1], "o", color=colour, markersize=disc, markeredgecolor=INK, zorder=13)
        entries.append(("disc", colour, capitalised(say_action(action))))
    return entries


def draw_failed(ax: Axes, site: Site, events: Sequence[Event], disc: float) -> list[LegendEntry]:
    """Draw captures that failed and did not succeed when retried."""
    good = {(e.node, e.action, e.place) for e in captures(events) if e.status == "success"}
    failed = [e for e in placed(events) if e.status != "success" and (e.node, e.action, e.place) not in good]
    if not failed:
        return []
    xy = metres_of(site, failed)
    ax.plot(xy[:, 0], xy[:, 1], "X", color=FAILED, markersize=disc, markeredgecolor="white", zorder=14)
    return [("saltire", FAILED, "failed")]


def write_values(labels: Labels, site: Site, good: Sequence[Acted], summary: ReadingSummary, disc: float) -> None:
    """Write the last reading of each place beside it where there is room; write none if there are too many."""
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
    """Return centres for a label above, below, right and left of a symbol, then at its corners."""
    (x, y), (width, height) = at, size
    over, beside = gap + height / 2, gap + width / 2
    straight = [(x, y + over), (x, y - over), (x + beside, y), (x - beside, y)]
    aslant = 0.75
    return straight + [(x + a * aslant * beside, y + b * aslant * over) for a in (1, -1) for b in (1, -1)]


def placed(events: Sequence[Event]) -> list[Acted]:
    """Return the captures whose position the log holds."""
    return [e for e in captures(events) if _has_position(e)]


def metres_of(site: Site, events: Sequence[Acted | InDoubt | Resumed]) -> Floats:
    """Return the known positions of events in local metres, shape (n, 2)."""
    known = [(e.lat, e.lon) for e in events if _has_position(e)]
    degrees = np.asarray(known, dtype=np.float64).reshape(-1, 2)
    return np.asarray(site.projection.metres(degrees[:, 0], degrees[:, 1]), dtype=np.float64).reshape(-1, 2)


def _has_position(event: Acted | InDoubt | Resumed) -> bool:
    return math.isfinite(event.lat) and math.isfinite(event.lon)


def trees_xy(site: Site, places: Sequence[str]) -> Floats:
    """Return the positions of trees in local metres, each once, shape (n, 2); skip places that are no trees."""
    found = [site.by_id[p].place.xy for p in dict.fromkeys(places) if p in site.by_id]
    return np.asarray(found, dtype=np.float64).reshape(-1, 2)
