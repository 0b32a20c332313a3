"""Export a site as GeoJSON (RFC 7946), with the derived rows, aisles, headlands and drivable lines.

Reading the document again gives the same site: it contains the trees, markers, gates and zones as they were read, and
the rows as properties of the trees. The lines are for display; the reader ignores them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike
from shapely.geometry.polygon import orient

from fieldhand.site.feature_kinds import BLOCK_KEYS, COLUMN_KEYS, POSITION_KEYS, area_kind, row_of, text_of
from fieldhand.site.model import Site, Tree, Zone
from fieldhand.terms import Value

if TYPE_CHECKING:
    from fieldhand.site.driving.network import DrivableNetwork

Feature = dict[str, Any]

#: Decimals of a degree for computed lines: about a millimetre.
_DECIMALS = 8
_ZONE_WORDS = {"boundary": ("boundary",), "keep_out": ("keep-out",), "zone": ("zone", "named zone")}


def site_document(site: Site, network: DrivableNetwork | None = None) -> dict[str, Any]:
    """Return the site as a GeoJSON FeatureCollection.

    Trees in a row have the properties ``row``, ``block`` and ``position``. Rows, aisles, headlands and the drivable
    lines are LineStrings with a ``kind``; a row also has its ``confidence``.

    Args:
        site: Site to export; rows that the file does not name are inferred.
        network: Drivable lines to include, if any.
    """
    features = [
        *_trees(site),
        *(_point(p.lon, p.lat, {"kind": kind} | _named(site, kind)) for kind, p in site.markers.items()),
        *(
            _point(g.place.lon, g.place.lat, {"kind": "gate", "name": g.place.id, "width_m": g.width_m})
            for g in site.gates
        ),
        *(_area(site, zone) for zone in site.zones),
        *_rows(site),
        *(_drivable(site, network) if network is not None else ()),
    ]
    return {"type": "FeatureCollection", "name": site.name, "features": features}


def _named(site: Site, kind: str) -> dict[str, Value]:
    """Return the name of a marker as a property, if it has one."""
    name = dict(site.marker_names).get(kind)
    return {} if name is None else {"name": name}


def _trees(site: Site) -> Iterator[Feature]:
    planting = site.planting
    several = len(planting.blocks) > 1
    where: dict[int, dict[str, Value]] = {}
    for row in planting.rows:
        names: dict[str, Value] = {"row": row.name}
        if several:
            names["block"] = planting.blocks[row.block].name
        for tree, slot in zip(row.trees.tolist(), row.slots.tolist(), strict=True):
            where[tree] = {**names, "position": slot}
    for tree in site.trees:
        properties = {**tree.properties, **_missing_properties(tree, where.get(tree.index, {}))}
        yield {**_point(tree.place.lon, tree.place.lat, properties), "id": tree.place.id}


def _missing_properties(tree: Tree, where: dict[str, Value]) -> dict[str, Value]:
    """Return the row, block and position of a tree that its own properties do not give; those are kept unchanged."""
    names = {
        "row": row_of(tree.properties),
        "block": text_of(tree.properties, BLOCK_KEYS),
        "position": text_of(tree.properties, POSITION_KEYS),
    }
    if not names["row"] and text_of(tree.properties, COLUMN_KEYS):
        names["row"] = names["position"] = "its column"  # next to a row, a column would be read as the position
    return {name: value for name, value in where.items() if not names[name]}


def _rows(site: Site) -> Iterator[Feature]:
    planting = site.planting
    for row in planting.rows:
        if len(row.trees) < 2:
            continue  # a line needs two ends
        properties = {
            "kind": "row",
            "name": row.name,
            "number": row.number,
            "block": planting.blocks[row.block].name,
            "trees": len(row.trees),
            "known": row.known,
            "confidence": round(row.confidence, 3),
        }
        yield _line(site, site.xy[row.trees], properties)


def _drivable(site: Site, network: DrivableNetwork) -> Iterator[Feature]:
    for line in network.lines:
        properties = {"kind": line.kind, "name": line.name, "length_m": round(line.length_m, 2)}
        yield _line(site, line.points, properties)


def _area(site: Site, zone: Zone) -> Feature:
    properties = next(
        p for word in _ZONE_WORDS[zone.kind] if area_kind(p := {"kind": word, "name": zone.name})[0] == zone.kind
    )
    polygon = orient(zone.polygon)  # counterclockwise outside, clockwise holes
    rings = [_positions(site, ring.coords) for ring in (polygon.exterior, *polygon.interiors)]
    return _feature("Polygon", [_closed(ring) for ring in rings], properties)


def _closed(ring: list[list[float]]) -> list[list[float]]:
    return [*ring[:-1], ring[0]]


def _line(site: Site, points: ArrayLike, properties: dict[str, Any]) -> Feature:
    positions = _positions(site, points)
    return _feature("LineString", [[round(v, _DECIMALS) for v in p] for p in positions], properties)


def _positions(site: Site, points: ArrayLike | Sequence[Any]) -> list[list[float]]:
    """Return longitude and latitude of points in metres."""
    xy = np.asarray(points, dtype=np.float64)[:, :2]
    return site.projection.positions(xy)


def _point(lon: float, lat: float, properties: dict[str, Any]) -> Feature:
    return _feature("Point", [lon, lat], properties)


def _feature(kind: str, coordinates: Any, properties: dict[str, Any]) -> Feature:
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}
