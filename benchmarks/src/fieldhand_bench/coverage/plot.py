"""Plot coverage plans of generated blocks: swaths, headland passes, the drives between them, and missed ground."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import OutputError
from fieldhand.site.coverage.plan import CoveragePlan
from fieldhand_bench.coverage.blocks import BlockToCover
from fieldhand_bench.coverage.measure import plan_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Plans drawn at most, and in one line.
_MOST, _ACROSS = 12, 4

_COLOURS = {"swath": "#117a65", "headland": "#0072b2", "transit": "#d55e00"}
_LABELS = {"swath": "swath", "headland": "headland pass", "transit": "implement off"}
_GROUND, _EDGE, _WORKED, _MISSED = "#f7f4ea", "#8a7f66", "#d3e6cd", "#b3261e"


def plot_plans(blocks: Sequence[BlockToCover], file: Path) -> None:
    """Plot the plans of the first blocks to a file; its suffix selects the format (png, svg, pdf).

    Raises:
        OutputError: The file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    drawn = blocks[:_MOST]
    lines = math.ceil(len(drawn) / _ACROSS)
    across = min(len(drawn), _ACROSS)
    figure = Figure(figsize=(3.4 * across, 3.4 * lines + 0.4), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(lines, across, squeeze=False).ravel().tolist()
    for panel, block in zip(panels, drawn, strict=False):
        _draw(panel, plan_of(block))
        panel.set_title(f"{block.name}, {block.width_m:g} m", fontsize="small")
    for panel in panels:
        panel.set_axis_off()
    shown = {
        label: handle for panel in figure.axes for handle, label in zip(*panel.get_legend_handles_labels(), strict=True)
    }
    figure.legend(shown.values(), shown.keys(), loc="outside lower center", ncols=4, fontsize="small")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(file, dpi=110)
    except (OSError, ValueError) as error:
        raise OutputError(f"the plot cannot be written: {error}", where=str(file)) from error


def _draw(panel: Axes, plan: CoveragePlan) -> None:
    _fill(panel, plan.area, _GROUND, _EDGE)
    _fill(panel, plan.covered, _WORKED, "none")
    for part in plan.missed:
        _fill(panel, part, _MISSED, "none")
    for leg in plan.legs:
        east, north = np.array(leg.points).T
        panel.plot(east, north, color=_COLOURS[leg.kind], linewidth=0.9, label=_LABELS[leg.kind])
    panel.plot(*plan.legs[0].points[0], "o", color="black", markersize=3, label="start")
    panel.set_aspect("equal")
    panel.set_axis_off()


def _fill(panel: Axes, area: BaseGeometry, colour: str, edge: str) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    for part in shapely.get_parts(area):
        if not part.is_empty and part.geom_type == "Polygon":
            rings = [Outline(shapely.get_coordinates(ring)) for ring in (part.exterior, *part.interiors)]
            outline = Outline.make_compound_path(*rings)
            panel.add_patch(PathPatch(outline, facecolor=colour, edgecolor=edge, linewidth=0.6))
