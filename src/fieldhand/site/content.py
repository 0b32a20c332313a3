"""What a site holds as one number: the same for the same orchard, however its file is written."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

if TYPE_CHECKING:
    from fieldhand.site.model import Site, Zone

#: Zones are held in metres only, so their corners are compared to the millimetre.
_DECIMALS = 3


def content_sha256(site: Site) -> str:
    """SHA-256 of one JSON line for each tree, marker, gate and zone.

    Trees count in their order, by id, latitude, longitude and properties; markers, gates and zones in any order; rings
    of zones whatever their direction and first corner. Names of the site and of the file, the numbers of the features
    and notes do not count.
    """
    digest = hashlib.sha256(b"fieldhand site 1\n")
    for line in _lines(site):
        digest.update(line.encode())
        digest.update(b"\n")
    return digest.hexdigest()


def _lines(site: Site) -> Iterator[str]:
    for tree in site.trees:
        yield _line(["tree", tree.place.id, tree.place.lat, tree.place.lon, sorted(tree.properties.items())])
    for name, place in sorted(site.markers.items()):
        yield _line(["marker", name, place.lat, place.lon])
    yield from sorted(_line(["gate", g.place.id, g.place.lat, g.place.lon, g.width_m]) for g in site.gates)
    yield from sorted(_line(["zone", z.kind, z.name, _rings(z)]) for z in site.zones)


def _line(record: list[Any]) -> str:
    return json.dumps(record, ensure_ascii=True, separators=(",", ":"))


def _rings(zone: Zone) -> list[list[list[float]]]:
    polygon = shapely.transform(zone.polygon, lambda xy: np.round(xy, _DECIMALS) + 0.0)
    whole = shapely.normalize(polygon)
    return [shapely.get_coordinates(ring).tolist() for ring in (whole.exterior, *whole.interiors)]
