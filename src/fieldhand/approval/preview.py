"""The map of a planned mission: where it drives, where it stops, what it does there, and what is not certain yet."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.approval.map_labels import draw_labels, label_window
from fieldhand.approval.marks import colours_of, disc_size, draw_arrows, draw_leg, draw_stop
from fieldhand.approval.panel import draw_panel
from fieldhand.approval.readback import ReadBack, read_back
from fieldhand.approval.stops import Plan, plan_of
from fieldhand.forecast.estimate import Estimate
from fieldhand.language import ENGLISH, Language, message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.drawing import draw_site, site_figure
from fieldhand.site.drawing.ground import draw_ground, draw_scale
from fieldhand.site.drawing.names import labels_on, name_ground, name_markers, name_zones
from fieldhand.site.drawing.rows import name_rows_within, name_trees
from fieldhand.site.drawing.saving import save_figure
from fieldhand.site.drawing.window import Window, look_through, show_window, window_of
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Inches: of the words beside the map, of the margin around both, and the least height in which the words have room.
_PANEL_IN, _MARGIN_IN, _LEAST_HEIGHT_IN = 4.7, 0.25, 6.8
#: Inches: of a window below the words, above it, of room that the words leave to it, and of a figure that has one.
_WINDOW_IN, _GAP_IN, _MOST_SPARE_IN, _TALL_IN = 4.2, 0.15, 1.5, 9.5


def save_map(
    task: Task, site: Site, robot: RobotProfile, estimate: Estimate, path: Path, language: Language = ENGLISH
) -> None:
    """Draw the planned mission into a picture file; the ending says which kind (``.png``, ``.svg``, ``.pdf``).

    Args:
        task: What is planned.
        site, robot: Where and with what.
        estimate: Its estimate, whose branches are drawn: the first as a whole, of the others what it lacks.
        path: Where to write; its folder is made if needed.
        language: Of the words beside the map.

    Raises:
        OutputError: The file cannot be written, or its ending is of no kind of picture.
    """
    save_figure(plan_figure(task, site, robot, estimate, language), path, what=message("map", context="file"))


def plan_figure(
    task: Task, site: Site, robot: RobotProfile, estimate: Estimate, language: Language = ENGLISH
) -> Figure:
    """Draw the planned mission, with its words beside it, as :func:`save_map` writes it."""
    words = read_back(task, site, robot, estimate)
    plan = plan_of(task, [b.walk for b in estimate.branches], words.lines)
    return draw_map(task, site, plan, words, language)


def draw_map(task: Task, site: Site, plan: Plan, words: ReadBack, language: Language = ENGLISH) -> Figure:
    """The map with its words beside it, as a figure that belongs to no window.

    Where trees stand close on it and the work lies in a part of the site, that part is drawn larger below the words.
    """
    figure = _two_columns(site)
    ax, panel = figure.axes
    draw_site(ax, site)
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
        _draw_window(figure, site, plan, window, colours, tall)
    name_ground(ax, labels, site)
    return figure


def _draw_plan(ax: Axes, plan: Plan, colours: dict[str, str], disc: float) -> None:
    for leg in plan.legs:
        draw_leg(ax, leg)
    draw_arrows(ax, plan.legs)
    for stop in plan.stops:
        draw_stop(ax, stop, colours, disc)


def _draw_window(
    figure: Figure, site: Site, plan: Plan, window: Window, colours: dict[str, str], tall_in: float
) -> None:
    """Draw the part of the site where the work is below the words, so high."""
    height = float(figure.get_size_inches()[1])
    box = figure.axes[1].get_position()
    ax = figure.add_axes((box.x0, _MARGIN_IN / height, box.width, tall_in / height))
    look_through(ax, window)
    draw_ground(ax, site)
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
    """A figure with the site's axes on the left and those of the words on the right, both of fixed size."""
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
    """Leave the lower part of the right column to a window; the figure is made high enough for both."""
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
    """Take away the room that a narrow site leaves beside itself; what is drawn keeps its size."""
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
