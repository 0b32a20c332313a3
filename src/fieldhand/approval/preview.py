"""The map of a planned mission: where it drives, where it stops, what it does there, and what is not certain yet."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.approval.marks import colours_of, disc_size, draw_arrows, draw_labels, draw_leg, draw_stop
from fieldhand.approval.panel import draw_panel
from fieldhand.approval.readback import ReadBack, read_back
from fieldhand.approval.stops import Plan, plan_of
from fieldhand.forecast.estimate import Estimate
from fieldhand.language import ENGLISH, Language
from fieldhand.robot.model import RobotProfile
from fieldhand.site.drawing import draw_site, site_figure
from fieldhand.site.drawing.saving import save_figure
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Inches: of the words beside the map, of the margin around both, and the least height in which the words have room.
_PANEL_IN, _MARGIN_IN, _LEAST_HEIGHT_IN = 4.7, 0.25, 6.8


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
    words = read_back(task, site, robot, estimate)
    plan = plan_of(task, [b.walk for b in estimate.branches], words.lines)
    figure = draw_map(task, site, plan, words, language)
    save_figure(figure, path, what="map")


def draw_map(task: Task, site: Site, plan: Plan, words: ReadBack, language: Language = ENGLISH) -> Figure:
    """The map with its words beside it, as a figure that belongs to no window."""
    figure = _two_columns(site)
    ax = figure.axes[0]
    draw_site(ax, site)
    _close_up(figure)
    colours, size = colours_of(plan.stops), disc_size(plan.stops)
    for leg in plan.legs:
        draw_leg(ax, leg)
    draw_arrows(ax, plan.legs)
    for stop in plan.stops:
        draw_stop(ax, stop, colours, size)
    draw_labels(ax, plan, tuple(m.xy for m in site.markers.values()), size)
    draw_panel(figure.axes[1], task, plan, language.read(words), colours, language)
    return figure


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
