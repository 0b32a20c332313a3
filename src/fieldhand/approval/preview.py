"""Map of a planned mission: its route, stops and actions, and the certainty of each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.approval.map_labels import draw_labels, label_window
from fieldhand.approval.marks import colours_of, disc_size, draw_arrows, draw_leg, draw_stop
from fieldhand.approval.panel import draw_panel
from fieldhand.approval.readback import ReadBack, read_back
from fieldhand.approval.stops import DrawnPlan, plan_of
from fieldhand.forecast.estimate import Estimate
from fieldhand.language import ENGLISH, Language, message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.drawing import draw_site, site_figure
from fieldhand.site.drawing.detail_window import Window, show_detail, show_window, window_of
from fieldhand.site.drawing.ground import draw_closed_ground, draw_ground, draw_scale
from fieldhand.site.drawing.names import labels_on, name_ground, name_markers, name_zones
from fieldhand.site.drawing.rows import name_rows_within, name_trees
from fieldhand.site.drawing.saving import save_figure
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from fieldhand.site.closed_ground import ClosedGround

#: Lengths in inches: width of the text panel, margin around the figure, minimum height for the text.
_PANEL_IN, _MARGIN_IN, _LEAST_HEIGHT_IN = 4.7, 0.25, 6.8
#: Lengths in inches: height of the inset window, gap above it, maximum space between text and window, height of a
#: figure with a window.
_WINDOW_IN, _GAP_IN, _MOST_SPARE_IN, _TALL_IN = 4.2, 0.15, 1.5, 9.5


def save_map(
    task: Task, site: Site, robot: RobotProfile, estimate: Estimate, path: Path, language: Language = ENGLISH
) -> None:
    """Draw the planned mission into a file; the extension selects the format (``.png``, ``.svg``, ``.pdf``).

    Args:
        task: Task to draw.
        site, robot: Site and robot of the mission.
        estimate: Estimate of the mission; its first branch is drawn completely, the others only where they differ.
        path: Output file; its folder is created if needed.
        language: Language of the text beside the map.

    Raises:
        OutputError: The file cannot be written, or its extension is not a supported image format.
    """
    save_figure(plan_figure(task, site, robot, estimate, language), path, what=message("map", context="file"))


def plan_figure(
    task: Task, site: Site, robot: RobotProfile, estimate: Estimate, language: Language = ENGLISH
) -> Figure:
    """Return the planned mission as the figure that :func:`save_map` writes."""
    words = read_back(task, site, robot, estimate)
    plan = plan_of(task, [b.walk for b in estimate.branches], words.lines)
    return draw_map(task, site, plan, words, language, closed=estimate.closed)


def draw_map(
    task: Task,
    site: Site,
    plan: DrawnPlan,
    words: ReadBack,
    language: Language = ENGLISH,
    *,
    closed: Sequence[ClosedGround] = (),
) -> Figure:
    """Return a figure with the map and the text beside it, attached to no window.

    If trees are too close together on the map and the work covers only part of the site, an enlarged view of that part
    is drawn below the text.
    """
    figure = _two_columns(site)
    ax, panel = figure.axes
    draw_site(ax, site)
    draw_closed_ground(ax, closed)
    _close_up(figure)
    window = window_of(ax, site, [stop.place.xy for stop in plan.stops], _PANEL_IN, _WINDOW_IN)
    if window is not None:
        _halve(figure)
    colours = colours_of(plan.stops)
    points_left = draw_panel(panel, task, plan, language.read(words), colours, language)
    labels = labels_on(ax, site)
    name_markers(labels, site)
    disc = disc_size(ax, plan.stops)
    _draw_plan(ax, plan, colours, disc)
    labels.avoid(leg.points for leg in plan.legs)
    if window is None:
        draw_labels(ax, labels, plan.stops, disc)
    else:
        tall = _WINDOW_IN + min(max(points_left / 72.0 - _GAP_IN, 0.0), _MOST_SPARE_IN)
        window = window.as_tall_as(_PANEL_IN, tall)
        show_window(ax, window)
        label_window(labels, window, plan.stops)
        _draw_window(figure, site, plan, window, colours, tall, closed)
    name_ground(ax, labels, site)
    return figure


def _draw_plan(ax: Axes, plan: DrawnPlan, colours: dict[str, str], disc: float) -> None:
    for leg in plan.legs:
        draw_leg(ax, leg)
    draw_arrows(ax, plan.legs)
    for stop in plan.stops:
        draw_stop(ax, stop, colours, disc)


def _draw_window(
    figure: Figure,
    site: Site,
    plan: DrawnPlan,
    window: Window,
    colours: dict[str, str],
    tall_in: float,
    closed: Sequence[ClosedGround],
) -> None:
    """Draw an enlarged view of the working area below the text, with the given height."""
    height = float(figure.get_size_inches()[1])
    box = figure.axes[1].get_position()
    ax = figure.add_axes((box.x0, _MARGIN_IN / height, box.width, tall_in / height))
    show_detail(ax, window)
    draw_ground(ax, site)
    draw_closed_ground(ax, closed)
    draw_scale(ax)
    shown = [stop for stop in plan.stops if window.holds(stop.place.xy)]
    disc = disc_size(ax, shown)
    _draw_plan(ax, plan, colours, disc)
    labels = labels_on(ax, site)
    labels.avoid(leg.points for leg in plan.legs)
    draw_labels(ax, labels, shown, disc)
    name_markers(labels, site)
    name_zones(labels, site)
    name_rows_within(ax, labels, site)
    name_trees(ax, labels, site)


def _two_columns(site: Site) -> Figure:
    """Return a figure with the axes of the site on the left and of the text on the right, both of fixed size."""
    figure = site_figure(site)
    figure.set_layout_engine("none")
    width, height = figure.get_size_inches()
    height = max(height, _LEAST_HEIGHT_IN)
    whole = width + _PANEL_IN + 3 * _MARGIN_IN
    figure.set_size_inches(whole, height)
    bottom, tall = _MARGIN_IN / height, 1 - 2 * _MARGIN_IN / height
    figure.axes[0].set_position((_MARGIN_IN / whole, bottom, width / whole, tall))
    figure.axes[0].set_anchor("N")
    figure.add_axes(((width + 2 * _MARGIN_IN) / whole, bottom, _PANEL_IN / whole, tall))
    return figure


def _halve(figure: Figure) -> None:
    """Make the figure tall enough for text and window, and free the lower part of the right column."""
    whole, before = figure.get_size_inches()
    height = max(before, _TALL_IN)
    figure.set_size_inches(whole, height)
    ax, panel = figure.axes
    for axes in (ax, panel):
        box = axes.get_position(original=True)
        axes.set_position((box.x0, _MARGIN_IN / height, box.width, 1 - 2 * _MARGIN_IN / height))
    box = panel.get_position(original=True)
    taken = (_WINDOW_IN + _GAP_IN) / height
    panel.set_position((box.x0, box.y0 + taken, box.width, box.height - taken))
    ax.apply_aspect()


def _close_up(figure: Figure) -> None:
    """Remove the unused width beside a narrow site without scaling the drawing."""
    ax, panel = figure.axes
    whole, height = figure.get_size_inches()
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    box = ax.get_position(original=True)
    needed = min(box.width * whole, box.height * height * (x1 - x0) / (y1 - y0))
    spare = box.width * whole - needed
    beside = panel.get_position(original=True)
    figure.set_size_inches(whole - spare, height)
    ax.set_position((_MARGIN_IN / (whole - spare), box.y0, needed / (whole - spare), box.height))
    left, width = beside.x0 * whole - spare, beside.width * whole
    panel.set_position((left / (whole - spare), beside.y0, width / (whole - spare), beside.height))
    ax.apply_aspect()
