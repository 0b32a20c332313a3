"""Draw the base map: boundary, zones, rows as faint lines, trees and markers, with a scale bar and a north arrow."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.drawing import colours
from fieldhand.site.drawing.blocks import draw_blocks
from fieldhand.site.model import Place, Site, Zone
from fieldhand.site.point_index import PointIndex

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from fieldhand.site.closed_ground import ClosedGround

TREE_COLOUR = colours.TREE
XY = tuple[float, float]

_MOST_ZONE_LABELS = 20
#: Least diameter of a disc in points, and its diameter as a fraction of the distance to the next one.
_LEAST_DISC, _PART = 3.5, 0.9
#: Larger sites are drawn as raster images, since vector graphics with so many objects are slow.
MANY = 5_000


def site_figure(site: Site) -> Figure:
    """Return an empty figure, without a window, whose shape fits the site; draw on ``figure.axes[0]``."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    west, south, east, north = bounds_of(site)
    ratio = min(max((east - west) / (north - south), 0.5), 2.2)
    height = 9.0 if ratio <= 1.0 else 9.0 / math.sqrt(ratio)
    figure = Figure(figsize=(max(height * ratio, 5.0) + 0.4, height), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    figure.add_subplot()
    return figure


def draw_site(ax: Axes, site: Site) -> None:
    """Draw a base map without names for further drawings; axes in metres, with equal scales, without a frame.

    Args:
        ax: Axes to draw on; further drawings in local metres lie on top from ``zorder`` 10 on.
        site: Site to draw.
    """
    west, south, east, north = bounds_of(site)
    ax.set_aspect("equal")
    ax.set_xlim(west, east)
    ax.set_ylim(south, north)
    ax.set_axis_off()
    draw_ground(ax, site)
    draw_scale_and_north(ax)


def draw_ground(ax: Axes, site: Site) -> None:
    """Draw zones, blocks, rows, trees, gates and markers in muted colours, without names."""
    draw_zones(ax, site)
    draw_blocks(ax, site)
    _draw_rows(ax, site)
    draw_dots(ax, site.xy, tree_size(ax, site), colours.TREE)
    draw_gates(ax, site)
    draw_markers(ax, site)


def tree_size(ax: Axes, site: Site) -> float:
    """Return the area of a tree's dot in square points: about a third of the spacing wide, with a visible minimum."""
    return float(np.clip((0.36 * site.spacing_m * points_a_metre(ax)) ** 2, 1.5, 130.0))


def disc_diameter(ax: Axes, xy: NDArray[np.float64], most: float) -> float:
    """Return the diameter in points of discs at some places, smaller if the places are close on the map."""
    places = np.unique(xy, axis=0)
    if len(places) < 2:
        return most
    away = PointIndex(places).nearest_few(places, 2)[0][:, 1]
    apart = float(np.median(away)) * points_a_metre(ax)
    return float(np.clip(_PART * apart, min(_LEAST_DISC, most), most))


def points_a_metre(ax: Axes) -> float:
    """Return the scale of the map in points per metre."""
    figure = ax.get_figure(root=True)
    width, height = figure.get_size_inches() if figure is not None else (8.0, 8.0)
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    box = ax.get_position()
    return float(72.0 * min(width * box.width / (x1 - x0), height * box.height / (y1 - y0)))


def bounds_of(site: Site) -> tuple[float, float, float, float]:
    """Return west, south, east and north of all features, with a margin and room for the scale bar below."""
    points = [site.xy, *(np.array([p.xy]) for p in (*site.markers.values(), *(g.place for g in site.gates)))]
    points += [np.array(z.polygon.exterior.coords)[:, :2] for z in site.zones]
    everything = np.vstack(points)
    low, high = everything.min(axis=0), everything.max(axis=0)
    span = max(float((high - low).max()), 4.0 * min(site.spacing_m, 10.0))
    margin = 0.05 * span
    return (
        float(low[0]) - margin,
        float(low[1]) - margin - 0.09 * span,
        float(high[0]) + margin,
        float(high[1]) + margin,
    )


def draw_zones(ax: Axes, site: Site) -> None:
    """Draw boundaries, zones and keep-outs, without their names."""
    for zone in site.zones_of("boundary"):
        _patch(
            ax, zone, facecolor=colours.GROUND, edgecolor=colours.FENCE, linewidth=1.6, linestyle=(0, (6, 2)), zorder=1
        )
    for zone in site.zones_of("zone"):
        _patch(ax, zone, facecolor=colours.ZONE_FILL, edgecolor=colours.ZONE_EDGE, linewidth=1.0, alpha=0.6, zorder=2)
    for zone in site.zones_of("keep_out"):
        _patch(
            ax,
            zone,
            facecolor=colours.KEEP_OUT_FILL,
            edgecolor=colours.KEEP_OUT_EDGE,
            linewidth=1.2,
            hatch="////",
            zorder=3,
        )


def draw_closed_ground(ax: Axes, closed: Sequence[ClosedGround]) -> None:
    """Hatch the ground that a mission keeps out of."""
    import shapely
    from matplotlib.patches import Polygon as Patch

    for shape in shapely.get_parts([ground.shape for ground in closed]):
        ax.add_patch(
            Patch(
                shapely.get_coordinates(shape.exterior),
                closed=True,
                facecolor="none",
                edgecolor=colours.AVOIDED,
                linewidth=0.8,
                hatch="xxx",
                alpha=0.7,
                zorder=4,
            )
        )


def named_zones(site: Site) -> Sequence[Zone]:
    """Return the zones to name on a picture, keep-outs first, up to a maximum number."""
    return [*site.zones_of("keep_out"), *site.zones_of("zone")][:_MOST_ZONE_LABELS]


def zone_ink(zone: Zone) -> str:
    """Return the colour of a zone's name."""
    return colours.KEEP_OUT_EDGE if zone.kind == "keep_out" else colours.ZONE_INK


def draw_dots(
    ax: Axes, xy: NDArray[np.float64], size: float, colour: str | NDArray[np.float64], zorder: float = 5
) -> None:
    """Draw trees as dots with an area in square points."""
    ax.scatter(xy[:, 0], xy[:, 1], s=size, c=colour, linewidths=0, zorder=zorder, rasterized=len(xy) > MANY)


def draw_gates(ax: Axes, site: Site) -> None:
    """Draw gates as open squares on the fence."""
    for gate in site.gates:
        ax.plot(
            *gate.place.xy, marker="s", markersize=7, color="white", markeredgecolor=colours.GATE,
            markeredgewidth=1.8, zorder=8, gid="gate",
        )  # fmt: skip


def draw_markers(ax: Axes, site: Site) -> list[Place]:
    """Draw start, end and charger without their names; return the places that were drawn."""
    for name, place in site.markers.items():
        shape, colour, _ = marker_look(name)
        ax.scatter(place.x, place.y, s=90, marker=shape, c=colour, edgecolors="white", linewidths=1.2, zorder=8)
    return list(site.markers.values())


def marker_look(name: str) -> tuple[str, str, str]:
    """Return symbol, colour and label of a marker."""
    return colours.MARKERS.get(name, ("o", colours.INK, name))


def draw_scale(ax: Axes) -> None:
    """Draw a scale bar at the lower left, on white."""
    (west, east), (south, north) = ax.get_xlim(), ax.get_ylim()
    length = _round_length((east - west) / 4)
    height = north - south
    x, y = west + 0.03 * (east - west), south + 0.02 * height
    ax.plot([x, x + length], [y, y], color=colours.INK, linewidth=2.5, solid_capstyle="butt", zorder=19)
    ax.text(
        *(x + length / 2, y + 0.015 * height, f"{length:g} m"), ha="center", va="bottom", fontsize=8, color=colours.INK,
        zorder=19, bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 2.0},
    )  # fmt: skip


def draw_scale_and_north(ax: Axes) -> None:
    """Draw a scale bar at the lower left and a north arrow at the lower right."""
    (west, east), (south, north) = ax.get_xlim(), ax.get_ylim()
    length = _round_length((east - west) / 4)
    height = north - south
    x, y = west + 0.04 * (east - west), south + 0.025 * height
    ax.plot([x, x + length], [y, y], color=colours.INK, linewidth=2.5, solid_capstyle="butt", zorder=9)
    ax.text(
        *(x + length / 2, y + 0.008 * height, f"{length:g} m"),
        ha="center",
        va="bottom",
        fontsize=8,
        color=colours.INK,
        zorder=9,
    )
    arrow = east - 0.05 * (east - west)
    ax.text(
        *(arrow, y + 0.066 * height, "N"),
        ha="center",
        va="center",
        fontsize=9,
        fontweight="bold",
        color=colours.INK,
        zorder=9,
    )
    ax.annotate(
        "",
        xy=(arrow, y + 0.055 * height),
        xytext=(arrow, y),
        arrowprops={"arrowstyle": "-|>", "color": colours.INK, "linewidth": 1.4},
        zorder=9,
    )


def _draw_rows(ax: Axes, site: Site) -> None:
    """Draw each row as a faint line that shows the direction of the rows."""
    from matplotlib.collections import LineCollection

    lines = [site.xy[row.trees] for row in site.planting.rows if len(row.trees) > 1]
    if lines:
        ax.add_collection(
            LineCollection(lines, colors=colours.FAINT_ROW, linewidths=0.6, alpha=0.8, zorder=2.5), autolim=False
        )


def open_spots(site: Site, zone: Zone) -> list[XY]:
    """Return points of a grid inside a zone for its name, those farthest from trees, markers and the edge first."""
    import shapely

    west, south, east, north = zone.polygon.bounds
    inset = 0.3 * (east - west)
    x, y = (g.ravel() for g in np.meshgrid(np.linspace(west + inset, east - inset, 25), np.linspace(south, north, 25)))
    inside = shapely.contains_xy(zone.polygon, x, y)
    if not inside.any():
        spot = zone.polygon.representative_point()
        return [(spot.x, spot.y)]
    grid = np.column_stack([x, y])[inside]
    taken = np.vstack([site.xy, *(np.array([p.xy]) for p in site.markers.values())])
    to_edge = shapely.distance(zone.polygon.boundary, shapely.points(grid))
    room = np.minimum(PointIndex(taken).nearest(grid)[0], to_edge)
    return [(float(x), float(y)) for x, y in grid[np.argsort(-room, kind="stable")]]


def _patch(ax: Axes, zone: Zone, **style: object) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    rings = [zone.polygon.exterior, *zone.polygon.interiors]
    outline = Outline.make_compound_path(*(Outline(np.asarray(r.coords)[:, :2], closed=True) for r in rings))
    ax.add_patch(PathPatch(outline, **style))


def _round_length(metres: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20, 50 ... that is not longer."""
    power = 10.0 ** math.floor(math.log10(metres))
    return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= metres)
