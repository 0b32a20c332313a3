"""Find the places inside zones and blocks, and those outside keep-out zones."""

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
    """Return the outlines of the zones of that name, ignoring case, hyphens and underscores."""
    zones = [z for z in site.zones if name and phrase(z.name) == phrase(name)]
    return [z.polygon for z in [z for z in zones if z.name == name] or zones]


def in_zones(of: PlaceGroup, name: str, margin_m: float = 0.0) -> PlaceGroup | None:
    """Return the places inside or within a margin of the zones of that name; None if there is no such zone."""
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
    """Return the places in the rows of the block of that name or number; None if there is no such block."""
    block = find_block(of.site, name)
    return None if block is None else in_those_rows(of, block.rows)


def outside_keep_outs(of: PlaceGroup, notes: ResolutionNotes) -> PlaceGroup:
    """Return the places that a robot may drive to, for selectors that may choose any of several."""
    closed = np.zeros(len(of), dtype=bool)
    for zone in of.site.zones_of("keep_out"):
        shapely.prepare(zone.polygon)
        closed |= shapely.contains_xy(zone.polygon, of.xy[:, 0], of.xy[:, 1])
    if closed.any():
        notes.remark(
            counted(
                "{count} of them is in a keep-out and is skipped",
                "{count} of them are in a keep-out and are skipped",
                int(closed.sum()),
            )
        )
    return of.keep(~closed)
