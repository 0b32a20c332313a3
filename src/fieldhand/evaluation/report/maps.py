"""Maps of a report, as SVG: the drives and, for each quantity, the readings."""

from __future__ import annotations

import io
import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.evaluation.report.log_facts import captures, failed_targets
from fieldhand.evaluation.report.marks import (
    COLOURS,
    LegendEntry,
    draw_drives,
    draw_failed,
    draw_incidents,
    draw_left_out,
    draw_plain,
    draw_readings,
    draw_worked,
    driven_ways,
    last_stand,
    metres_of,
    placed,
    trees_xy,
    write_values,
)
from fieldhand.evaluation.report.readings import ReadingSummary
from fieldhand.language.words import capitalised, say_action
from fieldhand.site.drawing import colours
from fieldhand.site.drawing.blocks import draw_blocks, name_blocks
from fieldhand.site.drawing.detail_window import Window, show_detail, show_window, window_of
from fieldhand.site.drawing.ground import (
    bounds_of,
    disc_diameter,
    draw_dots,
    draw_gates,
    draw_markers,
    draw_scale,
    draw_scale_and_north,
    draw_zones,
    marker_look,
    tree_size,
)
from fieldhand.site.drawing.names import labels_on, name_ground, name_zones
from fieldhand.site.drawing.rows import name_rows_within
from fieldhand.site.drawing.saving import make_text_visible
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Event

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
XY = tuple[float, float]

TREE = "#cfd6cc"
#: Inches: as wide as a phone, so that text on the map is legible there and on paper.
_WIDE_IN, _TALLEST_IN, _LEAST_IN = 4.3, 5.6, 1.6
#: Maps per report, and trees drawn as vectors.
_MOST, _MOST_TREES = 6, 800
#: Size of the overview of the whole site, as a part of the map of the work above it.
_WHOLE = 0.55


@dataclass(frozen=True, kw_only=True)
class ReportMap:
    """One map.

    Attributes:
        title: The quantity, or the actions if nothing was measured.
        svg: The drawing.
        width, height: Size of the drawing in CSS pixels.
        summary: The readings shown, or None if nothing was measured.
        scale: Colours from the lowest to the highest reading; empty if all are equal.
        legend: One entry per kind of mark on the map.
    """

    title: str
    svg: bytes
    width: float
    height: float
    summary: ReadingSummary | None
    scale: tuple[str, ...]
    legend: tuple[LegendEntry, ...]


def report_maps(
    site: Site, events: Sequence[Event], read: Sequence[ReadingSummary], ahead: Sequence[str] = ()
) -> tuple[ReportMap, ...]:
    """Draw a map for each quantity that was read, and one for captures that measured nothing.

    Args:
        site, events: The site and the event log.
        read: The quantities.
        ahead: Trees still to be visited when the mission ended.
    """
    plain = [e for e in captures(events) if e.status == "success" and not e.readings]
    shown: list[ReadingSummary | None] = list(read[:_MOST])
    if plain or not shown:
        shown.append(None)
    return tuple(_map(site, events, summary, plain if summary is None else [], ahead) for summary in shown)


def draw_map(
    site: Site, events: Sequence[Event], summary: ReadingSummary | None, ahead: Sequence[str] = ()
) -> tuple[Figure, list[LegendEntry]]:
    """Draw a map on a figure that belongs to no window; return it with its legend.

    Args:
        site, events: The site and the event log.
        summary: The quantity by which captures are coloured, or None for captures that measured nothing.
        ahead: Trees still to be visited when the mission ended.
    """
    figure = _figure(site)
    ax = figure.axes[0]
    done = placed(events)
    good = [e for e in done if e.status == "success"]
    work = [(float(x), float(y)) for x, y in metres_of(site, done)]
    window = window_of(ax, site, work, _WIDE_IN, _WIDE_IN)
    if window is not None:
        _draw_whole(figure, site, events, window)
        show_detail(ax, window)
    size = _draw_background(ax, site)
    labels = labels_on(ax, site)
    disc = disc_diameter(ax, np.array(work).reshape(-1, 2), float(np.clip(1.5 * math.sqrt(size), 5.0, 9.5)))
    legend = draw_drives(ax, site, events)
    legend += draw_worked(ax, site, events)
    legend += draw_left_out(ax, site, events, ahead, disc)
    legend += draw_incidents(ax, site, events, disc)
    if summary is None:
        legend += draw_plain(ax, site, [e for e in good if not e.readings], disc)
    else:
        draw_readings(ax, site, good, summary, disc)
    legend += draw_failed(ax, site, events, disc)
    for x, y in (*last_stand(site, events), *trees_xy(site, failed_targets(events))):
        labels.keep_free(labels.at((float(x), float(y))), 5.0)
    if summary is not None:
        write_values(labels, site, good, summary, disc)
    labels.avoid([(float(x), float(y)) for x, y in way] for way, _ in driven_ways(site, events))
    if window is None:
        draw_scale_and_north(ax)
        name_ground(ax, labels, site)
    else:
        draw_scale(ax)
        name_zones(labels, site)
        name_rows_within(ax, labels, site)
    return figure, legend + _marker_entries(site)


def _draw_whole(figure: Figure, site: Site, events: Sequence[Event], window: Window) -> None:
    """Draw an overview of the whole site below the map, with the outline of the map's window."""
    ax = figure.axes[0]
    limits, tall = (ax.get_xlim(), ax.get_ylim()), float(figure.get_size_inches()[1])
    small, gap = tall * _WHOLE, 0.1
    height = _WIDE_IN + gap + small
    figure.set_size_inches(_WIDE_IN, height)
    edge = 0.005
    ax.set_position((edge, 1 - _WIDE_IN / height + edge, 1 - 2 * edge, _WIDE_IN / height - 2 * edge))
    ax.set_axis_on()
    whole = figure.add_axes(((1 - _WHOLE) / 2, 0.0, _WHOLE, small / height))
    whole.set_xlim(limits[0])
    whole.set_ylim(limits[1])
    whole.set_axis_off()
    _draw_background(whole, site)
    draw_drives(whole, site, events)
    draw_worked(whole, site, events)
    draw_scale_and_north(whole)
    show_window(whole, window)
    labels = labels_on(whole, site)
    name_blocks(labels, site)


def _map(
    site: Site, events: Sequence[Event], summary: ReadingSummary | None, plain: Sequence[Acted], ahead: Sequence[str]
) -> ReportMap:
    with warnings.catch_warnings():
        # A name in a script that the font lacks is drawn as boxes; the page shows it in full.
        warnings.filterwarnings("ignore", message="Glyph .* missing from font", category=UserWarning)
        figure, legend = draw_map(site, events, summary, ahead)
        svg = _svg(figure)
    width, height = figure.get_size_inches()
    done = [capitalised(say_action(action)) for action in dict.fromkeys(e.action for e in plain)]
    return ReportMap(
        title=summary.name if summary else ", ".join(done) or "The way that was driven",
        svg=svg,
        width=round(96 * width),
        height=round(96 * height),
        summary=summary,
        scale=_scale(summary),
        legend=tuple(dict.fromkeys(legend)),
    )


def _svg(figure: Figure) -> bytes:
    """Return the figure as SVG without metadata, so that equal missions give equal bytes."""
    from matplotlib import rc_context

    out = io.BytesIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    with rc_context({"svg.fonttype": "path", "svg.hashsalt": "report"}):
        make_text_visible(figure)
        figure.savefig(out, format="svg", dpi=220, metadata=nothing)
    return out.getvalue()


def _scale(summary: ReadingSummary | None, steps: int = 24) -> tuple[str, ...]:
    """Return the colours of the scale from its low to its high end."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    if summary is None or not summary.values or max(summary.values) - min(summary.values) < 1e-9:
        return ()
    return tuple(to_hex(colour) for colour in colormaps[COLOURS](np.linspace(0.0, 1.0, steps)))


def _figure(site: Site) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    west, south, east, north = bounds_of(site)
    tall = float(np.clip(_WIDE_IN * (north - south) / (east - west), _LEAST_IN, _TALLEST_IN))
    figure = Figure(figsize=(_WIDE_IN, tall), facecolor="white")
    FigureCanvasAgg(figure)
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    # The picture's aspect ratio is bounded, the site's is not: pad both sides equally.
    metres = max((east - west) / _WIDE_IN, (north - south) / tall)
    wide, high = metres * _WIDE_IN, metres * tall
    ax.set_xlim((west + east - wide) / 2, (west + east + wide) / 2)
    ax.set_ylim((south + north - high) / 2, (south + north + high) / 2)
    ax.set_axis_off()
    return figure


def _draw_background(ax: Axes, site: Site) -> float:
    """Draw zones, rows, trees and markers in muted colours; return the area of a tree's dot."""
    from matplotlib.collections import LineCollection

    draw_zones(ax, site)
    draw_blocks(ax, site)
    lines = [site.xy[row.trees] for row in site.planting.rows if len(row.trees) > 1]
    if lines:
        ax.add_collection(LineCollection(lines, colors=TREE, linewidths=0.7, zorder=2.5), autolim=False)
    size = tree_size(ax, site)
    draw_dots(ax, site.xy, size, TREE)
    if len(site.trees) > _MOST_TREES:
        ax.collections[-1].set_rasterized(True)
    draw_gates(ax, site)
    draw_markers(ax, site)
    return size


def _marker_entries(site: Site) -> list[LegendEntry]:
    """Return legend entries for start, end and charger, whose names on the map would cover readings."""
    return [(name if name in colours.MARKERS else "disc", *marker_look(name)[1:]) for name in site.markers]
