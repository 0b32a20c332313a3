"""Write the names of markers, zones, gates, blocks and rows on a picture, in order of importance."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fieldhand.site.drawing import colours
from fieldhand.site.drawing.blocks import name_blocks
from fieldhand.site.drawing.ground import marker_look, named_zones, open_spots, tree_size, zone_ink
from fieldhand.site.drawing.labels import XY, Labels
from fieldhand.site.drawing.rows import name_rows
from fieldhand.site.model import Site
from fieldhand.site.names import short

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Fractions of the map (west, south, east, north) covered by the scale bar and the north arrow.
_SCALE_PART, _NORTH_PART = (0.0, 0.0, 0.31, 0.065), (0.9, 0.0, 1.0, 0.105)


def name_site(ax: Axes, site: Site) -> None:
    """Write all names of a site on axes whose position and limits are final."""
    labels = labels_on(ax, site)
    name_markers(labels, site)
    name_ground(ax, labels, site)


def labels_on(ax: Axes, site: Site) -> Labels:
    """Return labels that avoid the trees, scale bar, north arrow, markers and gates of a site."""
    labels = Labels(ax, site.xy, math.sqrt(tree_size(ax, site)) / 2)
    labels.keep_part_free(*_SCALE_PART)
    labels.keep_part_free(*_NORTH_PART)
    for place in (*site.markers.values(), *(g.place for g in site.gates)):
        labels.keep_free(labels.at(place.xy), 6.0)
    return labels


def name_markers(labels: Labels, site: Site) -> None:
    """Write the names of start, end and charger."""
    for name, place in site.markers.items():
        _, colour, words = marker_look(name)
        labels.put(
            words, _around(labels.at(place.xy), labels.size(words, 8, bold=True)),
            font=8, colour=colour, bold=True, over_trees=True, zorder=9,
        )  # fmt: skip


def name_ground(ax: Axes, labels: Labels, site: Site, *, row_ink: str | None = colours.ROW_INK) -> None:
    """Write the names of zones, gates, blocks and rows; row names are in ``row_ink``, else in the colour of the row."""
    name_zones(labels, site)
    for gate in site.gates:
        words = short(gate.place.id, 24)
        labels.put(
            words, _around(labels.at(gate.place.xy), labels.size(words, 7)),
            font=7, colour=colours.GATE, over_trees=True, zorder=9, gid="gate",
        )  # fmt: skip
    name_blocks(labels, site)
    name_rows(ax, labels, site, ink=row_ink)


def name_zones(labels: Labels, site: Site) -> None:
    """Write the names of keep-outs and zones inside them."""
    for zone in named_zones(site):
        labels.put(
            short(zone.name, 24), [labels.at(spot) for spot in open_spots(site, zone)],
            font=8, colour=zone_ink(zone), bold=True, over_trees=True, gid="zone",
        )  # fmt: skip


def _around(at: XY, size: XY) -> list[XY]:
    """Return spots below, above, right and left of a symbol."""
    (x, y), (width, height) = at, size
    over, beside = 7.5 + height / 2, 8.0 + width / 2
    return [(x, y - over), (x, y + over), (x + beside, y), (x - beside, y)]
