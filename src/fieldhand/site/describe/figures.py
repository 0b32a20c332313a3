"""Summarize a site in a bounded number of figures."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass

import numpy as np
from shapely.geometry import MultiPoint

from fieldhand.site.describe.rows import BlockSummary, block_summary, shortened
from fieldhand.site.feature_kinds import ZoneKind, number_text
from fieldhand.site.model import Site
from fieldhand.site.rectangle import smallest_rectangle
from fieldhand.terms import Value

MOST_VALUES = 8
MOST_ATTRIBUTES = 20
MOST_ZONES = 12
MOST_NOTES = 5
MOST_BLOCKS = 12
MOST_IDS = 12


@dataclass(frozen=True, kw_only=True)
class AttributeSummary:
    """One attribute of the trees.

    Attributes:
        trees: Number of trees with the attribute.
        distinct: Number of different values.
        minimum, maximum: Range of the values if all are numbers, else None.
        values: The most frequent values as text, in order of frequency (ties in order of the text).
    """

    name: str
    trees: int
    distinct: int
    minimum: float | None
    maximum: float | None
    values: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class ZoneSummary:
    """All zones of one name and kind. ``trees`` counts trees inside or on the edge."""

    name: str
    kind: ZoneKind
    area_m2: float
    trees: int


@dataclass(frozen=True, kw_only=True)
class SiteSummary:
    """A summary of a site in figures.

    Attributes:
        first_id, last_id: Ids of the first and last tree of the file.
        east_west_m, north_south_m: Extent of the trees along true north.
        area_m2: Area of the convex hull of the trees.
        turned_deg: Rotation of the smallest rectangle around the trees, clockwise from true north, -45 to 45.
        spacing_m: Median distance from a tree to its nearest neighbour.
        rows: Number of rows in all blocks; 0 if the trees form none.
        blocks, zones, attributes: The first few; ``blocks_left_out`` and so on count the others.
        in_no_row: Number of trees in no row; ``in_no_row_ids`` lists the first of them.
        why_no_row: Reason, in words, why there are no rows or some trees are in none; else empty.
        markers: Name of each marker, and metres east and north of the middle of the trees.
        gates: Name and width in metres of each gate.
    """

    name: str
    source: str
    trees: int
    first_id: str
    last_id: str
    east_west_m: float
    north_south_m: float
    area_m2: float
    turned_deg: float
    spacing_m: float
    rows: int
    blocks: tuple[BlockSummary, ...]
    blocks_left_out: int
    in_no_row: int
    in_no_row_ids: tuple[str, ...]
    why_no_row: str
    latitude: float
    longitude: float
    markers: tuple[tuple[str, float, float], ...]
    gates: tuple[tuple[str, float], ...]
    zones: tuple[ZoneSummary, ...]
    zones_left_out: int
    attributes: tuple[AttributeSummary, ...]
    attributes_left_out: int
    notes: tuple[str, ...]


def describe(site: Site) -> SiteSummary:
    """Return a summary of a site in figures, of bounded size."""
    east_west, north_south = np.ptp(site.outline_xy, axis=0).tolist()
    zones = _zones(site)
    planting = site.planting
    alone = np.flatnonzero(planting.row_of < 0)
    return SiteSummary(
        name=shortened(site.name),
        source=site.source,
        trees=len(site.trees),
        first_id=site.trees[0].place.id if site.trees else "",
        last_id=site.trees[-1].place.id if site.trees else "",
        east_west_m=east_west,
        north_south_m=north_south,
        area_m2=float(MultiPoint(site.outline_xy).convex_hull.area),
        turned_deg=_turned_deg(site),
        spacing_m=site.spacing_m,
        rows=len(planting.rows),
        blocks=tuple(block_summary(site, block) for block in planting.blocks[:MOST_BLOCKS]),
        blocks_left_out=max(len(planting.blocks) - MOST_BLOCKS, 0),
        in_no_row=len(alone),
        in_no_row_ids=tuple(shortened(site.trees[k].place.id) for k in alone[:MOST_IDS].tolist()),
        why_no_row=shortened(planting.why, 160),
        latitude=site.projection.lat,
        longitude=site.projection.lon,
        markers=tuple((name, *site.markers[name].xy) for name in sorted(site.markers)),
        gates=tuple((shortened(g.place.id), g.width_m) for g in site.gates[:MOST_ZONES]),
        zones=zones[:MOST_ZONES],
        zones_left_out=max(len(zones) - MOST_ZONES, 0),
        attributes=tuple(_attribute(site, name) for name in list(site.attributes)[:MOST_ATTRIBUTES]),
        attributes_left_out=max(len(site.attributes) - MOST_ATTRIBUTES, 0),
        notes=tuple(shortened(note, 160) for note in site.notes[:MOST_NOTES]),
    )


def _zones(site: Site) -> tuple[ZoneSummary, ...]:
    import shapely

    found: dict[tuple[ZoneKind, str], tuple[float, np.ndarray[tuple[int], np.dtype[np.bool_]]]] = {}
    for zone in site.zones[: 4 * MOST_ZONES]:
        shapely.prepare(zone.polygon)
        inside = np.asarray(shapely.intersects_xy(zone.polygon, site.xy[:, 0], site.xy[:, 1]))
        area, before = found.get((zone.kind, zone.name), (0.0, np.zeros(len(site.trees), dtype=bool)))
        found[zone.kind, zone.name] = (area + float(zone.polygon.area), before | inside)
    more = {(z.kind, z.name) for z in site.zones[4 * MOST_ZONES :]} - set(found)
    summaries = [
        ZoneSummary(name=shortened(name), kind=kind, area_m2=area, trees=int(inside.sum()))
        for (kind, name), (area, inside) in found.items()
    ]
    rest = [ZoneSummary(name=shortened(name), kind=kind, area_m2=0.0, trees=0) for kind, name in sorted(more)]
    return (*summaries, *rest)


def _attribute(site: Site, name: str) -> AttributeSummary:
    held = [t.properties[name] for t in site.trees if name in t.properties]
    numbers = [v for v in held if isinstance(v, float)]
    numeric = len(numbers) == len(held)
    frequent = sorted(Counter(value_text(v) for v in held).items(), key=lambda item: (-item[1], item[0]))
    return AttributeSummary(
        name=shortened(name),
        trees=len(held),
        distinct=len(frequent),
        minimum=min(numbers) if numeric else None,
        maximum=max(numbers) if numeric else None,
        values=tuple(shortened(text) for text, _ in frequent[:MOST_VALUES]),
    )


def value_text(value: Value) -> str:
    """Return an attribute's value as text."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value) if isinstance(value, float) else value


def _turned_deg(site: Site) -> float:
    corners = smallest_rectangle(site.outline_xy)
    side = corners[1] - corners[0]
    if not side.any():
        return 0.0
    bearing = math.degrees(math.atan2(side[0], side[1]))
    return (bearing + 45.0) % 90.0 - 45.0
