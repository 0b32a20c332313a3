"""Trees inside zones and blocks, and outside keep-outs."""

from __future__ import annotations

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from fieldhand.language import counted
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.places.rows.numbers_in_row import in_those_rows
from fieldhand.site.counting import find_block
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Site


def zones_called(site: Site, name: str) -> list[BaseGeometry]:
    """Return the outlines of the zones of that name, whatever its case, hyphens and underscores."""
    zones = [z for z in site.zones if name and phrase(z.name) == phrase(name)]
    return [z.polygon for z in [z for z in zones if z.name == name] or zones]


def in_zones(of: PlaceGroup, name: str, margin_m: float = 0.0) -> PlaceGroup | None:
    """Return those inside the zones of that name or so near to one; None where there are none."""
    zones = zones_called(of.site, name)
    if not zones:
        return None
    inside = np.zeros(len(of), dtype=bool)
    for zone in zones:
        shapely.prepare(zone)
        if margin_m:
            inside |= shapely.dwithin(zone, shapely.points(of.xy), margin_m)
        else:
            inside |= shapely.intersects_xy(zone, of.xy[:, 0], of.xy[:, 1])
    return of.keep(inside)


def in_block(of: PlaceGroup, name: str) -> PlaceGroup | None:
    """Return those in the rows of the block of that name or number; None where there is none."""
    block = find_block(of.site, name)
    return None if block is None else in_those_rows(of, block.rows)


def outside_keep_outs(of: PlaceGroup, notes: ResolutionNotes) -> PlaceGroup:
    """Return those that a robot may drive to: where any of them will do, the others are passed over."""
    closed = np.zeros(len(of), dtype=bool)
    for zone in of.site.zones_of("keep_out"):
        shapely.prepare(zone.polygon)
        closed |= shapely.contains_xy(zone.polygon, of.xy[:, 0], of.xy[:, 1])
    if closed.any():
        notes.remark(
            counted(
                "{count} of them stands in a keep-out: passed over",
                "{count} of them stand in a keep-out: passed over",
                int(closed.sum()),
            )
        )
    return of.keep(~closed)
