"""The maps of a report: what was driven and, for each quantity, what was read where, as drawings that scale."""

from __future__ import annotations

import io
import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.evaluation.report_facts import captures
from fieldhand.evaluation.report_incidents import draw_incidents
from fieldhand.evaluation.report_marks import (
    COLOURS,
    Mark,
    draw_drives,
    draw_failed,
    draw_left_out,
    draw_plain,
    draw_readings,
    driven_ways,
    last_stand,
    metres_of,
    placed,
    unreached,
    write_values,
)
from fieldhand.evaluation.report_readings import Summary
from fieldhand.site.drawing import colours
from fieldhand.site.drawing.blocks import draw_blocks, name_blocks
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
from fieldhand.site.drawing.window import Window, look_through, show_window, window_of
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Event
from fieldhand.task.words import capitalised, say_action

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
XY = tuple[float, float]

TREE = "#cfd6cc"
#: Inches: wide as a phone, so that what is written on the map is read there and on paper.
_WIDE_IN, _TALLEST_IN, _LEAST_IN = 4.3, 5.6, 1.6
#: So many maps, and trees that are drawn one by one.
_MOST, _MOST_TREES = 6, 800
#: How large the map of the whole site is below one of the part where the work is.
_WHOLE = 0.55


@dataclass(frozen=True, kw_only=True)
class ReportMap:
    """One map.

    Attributes:
        title: The quantity, or what was done where nothing was measured.
        svg: The drawing.
        width, height: Of the drawing, in CSS pixels.
        summary: The readings that it shows; None where nothing was measured.
        scale: Colours from the lowest to the highest reading; empty where all are alike.
        marks: Shape, colour and meaning of each kind of mark that is on it.
    """

    title: str
    svg: bytes
    width: float
    height: float
    summary: Summary | None
    scale: tuple[str, ...]
    marks: tuple[Mark, ...]


def report_maps(
    site: Site, events: Sequence[Event], read: Sequence[Summary], missed: Sequence[str] = ()
) -> tuple[ReportMap, ...]:
    """A map for each quantity that was read, and one for captures that measured nothing.

    Args:
        site, events: What was driven where.
        read: The quantities.
        missed: Trees that were to be visited and were not come to.
    """
    plain = [e for e in captures(events) if e.status == "success" and not e.readings]
    shown: list[Summary | None] = list(read[:_MOST])
    if plain or not shown:
        shown.append(None)
    return tuple(_map(site, events, summary, plain if summary is None else [], missed) for summary in shown)


def draw_map(
    site: Site, events: Sequence[Event], summary: Summary | None, missed: Sequence[str] = ()
) -> tuple[Figure, list[Mark]]:
    """A map as a figure that belongs to no window, and the marks that are on it.

    Args:
        site, events: What was driven where.
        summary: The quantity by which captures are coloured; None for those that measured nothing.
    """
    figure = _figure(site)
    ax = figure.axes[0]
    done = placed(events)
    good = [e for e in done if e.status == "success"]
    work = [(float(x), float(y)) for x, y in metres_of(site, done)]
    window = window_of(ax, site, work, _WIDE_IN, _WIDE_IN)
    if window is not None:
        _draw_whole(figure, site, events, window)
        look_through(ax, window)
    size = _ground(ax, site)
    labels = labels_on(ax, site)
    disc = disc_diameter(ax, np.array(work).reshape(-1, 2), float(np.clip(1.5 * math.sqrt(size), 5.0, 9.5)))
    marks = draw_drives(ax, site, events)
    marks += draw_left_out(ax, site, events, missed, disc)
    marks += draw_incidents(ax, site, events, disc)
    if summary is None:
        marks += draw_plain(ax, site, [e for e in good if not e.readings], disc)
    else:
        draw_readings(ax, site, good, summary, disc)
    marks += draw_failed(ax, site, events, disc)
    for x, y in (*last_stand(site, events), *unreached(site, events)):
        labels.keep_free(labels.at((float(x), float(y))), 5.0)
    if summary is not None:
        write_values(labels, site, good, summary, disc)
    labels.avoid([(float(x), float(y)) for x, y in way] for way in driven_ways(site, events))
    if window is None:
        draw_scale_and_north(ax)
        name_ground(ax, labels, site)
    else:
        draw_scale(ax)
        name_zones(labels, site)
        name_rows_within(ax, labels, site)
    return figure, marks + _marker_marks(site)


def _draw_whole(figure: Figure, site: Site, events: Sequence[Event], window: Window) -> None:
    """Make room below the map for a small one of the whole site, which shows where the window lies."""
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
    _ground(whole, site)
    draw_drives(whole, site, events)
    draw_scale_and_north(whole)
    show_window(whole, window)
    labels = labels_on(whole, site)
    name_blocks(labels, site)


def _map(
    site: Site, events: Sequence[Event], summary: Summary | None, plain: Sequence[Acted], missed: Sequence[str]
) -> ReportMap:
    with warnings.catch_warnings():
        # A name in a script that the drawing's font lacks is a row of boxes there; the page has it in full.
        warnings.filterwarnings("ignore", message="Glyph .* missing from font", category=UserWarning)
        figure, marks = draw_map(site, events, summary, missed)
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
        marks=tuple(dict.fromkeys(marks)),
    )


def _svg(figure: Figure) -> bytes:
    """The figure as a drawing without date, programs' names or addresses, the same for the same mission."""
    from matplotlib import rc_context

    out = io.BytesIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    with rc_context({"svg.fonttype": "path", "svg.hashsalt": "report"}):
        make_text_visible(figure)
        figure.savefig(out, format="svg", dpi=220, metadata=nothing)
    return out.getvalue()


def _scale(summary: Summary | None, steps: int = 24) -> tuple[str, ...]:
    """The colour scale as colours from its low to its high end."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    if summary is None or not summary.values or max(summary.values) - min(summary.values) < 1e-9:
        return ()
    return tuple(to_hex(colour) for colour in colormaps[COLOURS](np.linspace(0.0, 1.0, steps)))


# --- the ground --------------------------------------------------------------------------------------------------


def _figure(site: Site) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    west, south, east, north = bounds_of(site)
    tall = float(np.clip(_WIDE_IN * (north - south) / (east - west), _LEAST_IN, _TALLEST_IN))
    figure = Figure(figsize=(_WIDE_IN, tall), facecolor="white")
    FigureCanvasAgg(figure)
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    # The picture's shape is bounded, the ground's is not: what is missing is added on both sides.
    metres = max((east - west) / _WIDE_IN, (north - south) / tall)
    wide, high = metres * _WIDE_IN, metres * tall
    ax.set_xlim((west + east - wide) / 2, (west + east + wide) / 2)
    ax.set_ylim((south + north - high) / 2, (south + north + high) / 2)
    ax.set_axis_off()
    return figure


def _ground(ax: Axes, site: Site) -> float:
    """Zones, rows, trees and markers, quiet beneath what was done; returns the area of a tree's dot."""
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


def _marker_marks(site: Site) -> list[Mark]:
    """Start, end and charger for the legend: their names would cover what was read beside them."""
    return [(name if name in colours.MARKERS else "disc", *marker_look(name)[1:]) for name in site.markers]
