"""A site on a matplotlib Axes, in local metres: the ground that maps and reports draw on."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.errors import OutputError
from fieldhand.site.model import Site, Zone
from fieldhand.site.places.faults import short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TREE_COLOUR = "#5b8c5a"
_GROUND, _FENCE = "#f7f4ea", "#8a7f66"
_KEEP_OUT_FILL, _KEEP_OUT_EDGE = "#bfd7e6", "#4d7c99"
_ZONE_FILL, _ZONE_EDGE = "#efdcae", "#c19a3f"
_INK = "#2f2f2f"
_MARKERS = {"start": ("^", "#1a7f37", "start"), "end": ("s", "#b3261e", "end"), "charger": ("D", "#d48806", "charger")}

#: Fewer trees than this are labelled with their ids unless the caller says otherwise.
_FEW_ENOUGH_TO_LABEL = 220
_MOST_ZONE_LABELS = 20


def site_figure(site: Site) -> Figure:
    """An empty figure whose shape fits the site; draw on ``figure.axes[0]``. It belongs to no window."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    west, south, east, north = _bounds(site)
    ratio = min(max((east - west) / (north - south), 0.5), 2.2)
    height = 9.0 if ratio <= 1.0 else 9.0 / math.sqrt(ratio)
    figure = Figure(figsize=(max(height * ratio, 5.0) + 0.4, height), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    figure.add_subplot()
    return figure


def save_site_picture(site: Site, path: Path, *, label_trees: bool | None = None) -> None:
    """Draw the site into a picture file; the ending says which kind (``.png``, ``.svg``, ``.pdf``).

    Raises:
        OutputError: The file cannot be written, or its ending is of no kind of picture.
    """
    figure = site_figure(site)
    draw_site(figure.axes[0], site, label_trees=label_trees)
    figure.axes[0].set_title(f"{short(site.name)}: {len(site.trees):,} trees", loc="left", color=_INK, fontsize=12)
    try:
        figure.savefig(path, dpi=150)
    except OSError as fault:
        raise OutputError(
            f"the picture cannot be written ({fault.strerror or fault})", where=str(path), advice="choose another place"
        ) from None
    except ValueError:
        raise OutputError(
            f"{path.suffix or 'no ending'} is no kind of picture",
            where=str(path),
            advice="end its name in .png, .svg or .pdf",
        ) from None


def draw_site(ax: Axes, site: Site, *, label_trees: bool | None = None) -> None:
    """Boundary, zones, trees and markers, with a scale bar and a north arrow; axes in metres, equal, without frame.

    Args:
        ax: Drawn on; what is added later in local metres lies on top from ``zorder`` 10 on.
        site: Drawn.
        label_trees: Write each tree's id beside it; by default where there are few enough to read.
    """
    west, south, east, north = _bounds(site)
    ax.set_aspect("equal")
    ax.set_xlim(west, east)
    ax.set_ylim(south, north)
    ax.set_axis_off()
    _draw_zones(ax, site)
    _draw_trees(ax, site, len(site.trees) <= _FEW_ENOUGH_TO_LABEL if label_trees is None else label_trees)
    _draw_markers(ax, site)
    _draw_scale_and_north(ax, (west, south, east, north))


def tree_size(ax: Axes, site: Site) -> float:
    """Area of a tree's dot in square points: about a third of the spacing wide, but never too small to see."""
    return float(np.clip((0.36 * site.spacing_m * _points_a_metre(ax)) ** 2, 1.5, 130.0))


def _points_a_metre(ax: Axes) -> float:
    """How large a metre is drawn, from the room that the figure gives."""
    figure = ax.get_figure(root=True)
    width, height = figure.get_size_inches() if figure is not None else (8.0, 8.0)
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    box = ax.get_position()
    return float(72.0 * min(width * box.width / (x1 - x0), height * box.height / (y1 - y0)))


def _bounds(site: Site) -> tuple[float, float, float, float]:
    """West, south, east, north of all there is, with a margin and room for the scale bar below."""
    points = [site.xy, np.array([p.xy for p in site.markers.values()]).reshape(-1, 2)]
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


def _draw_zones(ax: Axes, site: Site) -> None:
    for zone in site.zones_of("boundary"):
        _patch(ax, zone, facecolor=_GROUND, edgecolor=_FENCE, linewidth=1.6, linestyle=(0, (6, 2)), zorder=1)
    for zone in site.zones_of("zone"):
        _patch(ax, zone, facecolor=_ZONE_FILL, edgecolor=_ZONE_EDGE, linewidth=1.0, alpha=0.6, zorder=2)
    for zone in site.zones_of("keep_out"):
        _patch(ax, zone, facecolor=_KEEP_OUT_FILL, edgecolor=_KEEP_OUT_EDGE, linewidth=1.2, hatch="////", zorder=3)
    for zone in [*site.zones_of("keep_out"), *site.zones_of("zone")][:_MOST_ZONE_LABELS]:
        _label(
            ax, short(zone.name, 24), _open_spot(site, zone), _KEEP_OUT_EDGE if zone.kind == "keep_out" else "#8a6a1c"
        )


def _open_spot(site: Site, zone: Zone) -> tuple[float, float]:
    """Where a name can stand inside a zone: the point of a grid that is farthest from trees, markers and the edge."""
    import shapely
    from scipy.spatial import cKDTree

    west, south, east, north = zone.polygon.bounds
    x, y = (
        g.ravel()
        for g in np.meshgrid(
            np.linspace(west + 0.3 * (east - west), east - 0.3 * (east - west), 25), np.linspace(south, north, 25)
        )
    )
    inside = shapely.contains_xy(zone.polygon, x, y)
    if not inside.any():
        spot = zone.polygon.representative_point()
        return (spot.x, spot.y)
    grid = np.column_stack([x, y])[inside]
    taken = np.vstack([site.xy, *(np.array([p.xy]) for p in site.markers.values())])
    to_edge = shapely.distance(zone.polygon.boundary, shapely.points(grid))
    room = np.minimum(cKDTree(taken).query(grid)[0], to_edge)
    best = grid[int(np.argmax(room))]
    return (float(best[0]), float(best[1]))


def _patch(ax: Axes, zone: Zone, **style: object) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    rings = [zone.polygon.exterior, *zone.polygon.interiors]
    outline = Outline.make_compound_path(*(Outline(np.asarray(r.coords)[:, :2], closed=True) for r in rings))
    ax.add_patch(PathPatch(outline, **style))


def _draw_trees(ax: Axes, site: Site, labelled: bool) -> None:
    size = tree_size(ax, site)
    ax.scatter(site.xy[:, 0], site.xy[:, 1], s=size, c=TREE_COLOUR, linewidths=0, zorder=5)
    if not labelled:
        return
    room = site.spacing_m * _points_a_metre(ax)
    font = float(np.clip(0.3 * room, 3.5, 7.0))
    for tree in site.trees:
        ax.annotate(
            short(tree.place.id, 12),
            tree.place.xy,
            xytext=(math.sqrt(size) / 2 + 0.5, 0),
            textcoords="offset points",
            fontsize=font,
            color="#6f6f6f",
            va="center",
            annotation_clip=True,
            zorder=6,
        )


def _draw_markers(ax: Axes, site: Site) -> None:
    for name, place in site.markers.items():
        shape, colour, words = _MARKERS.get(name, ("o", _INK, name))
        ax.scatter(place.x, place.y, s=90, marker=shape, c=colour, edgecolors="white", linewidths=1.2, zorder=8)
        _label(ax, words, place.xy, colour, offset=(0, -11), zorder=9)


def _label(
    ax: Axes, text: str, xy: tuple[float, float], colour: str, offset: tuple[float, float] = (0, 0), zorder: float = 7
) -> None:
    from matplotlib.patheffects import withStroke

    ax.annotate(
        text.replace("$", r"\$"),
        xy,
        xytext=offset,
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=8,
        fontweight="bold",
        color=colour,
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
        zorder=zorder,
    )


def _draw_scale_and_north(ax: Axes, bounds: tuple[float, float, float, float]) -> None:
    west, south, east, north = bounds
    length = _round_length((east - west) / 4)
    height = north - south
    x, y = west + 0.04 * (east - west), south + 0.025 * height
    ax.plot([x, x + length], [y, y], color=_INK, linewidth=2.5, solid_capstyle="butt", zorder=9)
    ax.text(
        x + length / 2, y + 0.008 * height, f"{length:g} m", ha="center", va="bottom", fontsize=8, color=_INK, zorder=9
    )
    arrow = east - 0.05 * (east - west)
    ax.text(
        *(arrow, y + 0.066 * height, "N"),
        ha="center",
        va="center",
        fontsize=9,
        fontweight="bold",
        color=_INK,
        zorder=9,
    )
    ax.annotate(
        "",
        xy=(arrow, y + 0.055 * height),
        xytext=(arrow, y),
        arrowprops={"arrowstyle": "-|>", "color": _INK, "linewidth": 1.4},
        zorder=9,
    )


def _round_length(metres: float) -> float:
    """The largest of 1, 2, 5, 10, 20, 50 ... that is not longer."""
    power = 10.0 ** math.floor(math.log10(metres))
    return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= metres)
