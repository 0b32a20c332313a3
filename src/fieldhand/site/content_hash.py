"""Hash of the contents of a site: equal for the same orchard, whatever its file format."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry import Polygon

#: Zones are stored in metres only; their corners are rounded to the millimetre.
_DECIMALS = 3

HashItem = Sequence[Any]


def content_sha256(
    trees: Sequence[HashItem],
    markers: Sequence[HashItem],
    gates: Sequence[HashItem],
    zones: Sequence[HashItem],
) -> str:
    """Return the SHA-256 of one JSON line for each tree, marker, gate and zone.

    The hash ignores the names of the site and of the file, feature numbers and notes.

    Args:
        trees: Id, latitude, longitude and sorted properties of each; their order counts.
        markers: Name, latitude and longitude of each, in any order.
        gates: Id, latitude, longitude and width of each, in any order.
        zones: Kind, name and rings (:func:`rings_of`) of each, in any order.
    """
    digest = hashlib.sha256(b"fieldhand site 1\n")
    for line in _lines(trees, markers, gates, zones):
        digest.update(line.encode())
        digest.update(b"\n")
    return digest.hexdigest()


def rings_of(polygon: Polygon) -> list[list[list[float]]]:
    """Return the rings of a polygon in a normal form, independent of their direction and first corner."""
    rounded = shapely.transform(polygon, lambda xy: np.round(xy, _DECIMALS) + 0.0)
    whole = shapely.normalize(rounded)
    return [shapely.get_coordinates(ring).tolist() for ring in (whole.exterior, *whole.interiors)]


def _lines(
    trees: Sequence[HashItem],
    markers: Sequence[HashItem],
    gates: Sequence[HashItem],
    zones: Sequence[HashItem],
) -> Iterator[str]:
    for tree in trees:
        yield _line("tree", tree)
    for marker in sorted(markers, key=lambda record: str(record[0])):
        yield _line("marker", marker)
    yield from sorted(_line("gate", gate) for gate in gates)
    yield from sorted(_line("zone", zone) for zone in zones)


def _line(kind: str, record: HashItem) -> str:
    return json.dumps([kind, *record], ensure_ascii=True, separators=(",", ":"))
