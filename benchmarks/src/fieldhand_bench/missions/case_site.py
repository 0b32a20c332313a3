"""Trees and markers of a GeoJSON file with the distances between them, independent of how Fieldhand reads sites."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import KDTree

from fieldhand.errors import CaseError

CornerName = Literal["nw", "ne", "sw", "se"]

#: WGS 84: semi-major axis in metres, and squared eccentricity.
_AXIS_M, _ECCENTRICITY2 = 6_378_137.0, 6.694_379_990_14e-3
_TOWARD: Mapping[CornerName, tuple[float, float]] = {
    "nw": (-1.0, 1.0),
    "ne": (1.0, 1.0),
    "sw": (-1.0, -1.0),
    "se": (1.0, -1.0),
}

Points = NDArray[np.float64]


class CaseSite:
    """Trees and markers in metres east and north of the first tree.

    The length of a degree is that of the ellipsoid at that tree, accurate to a few parts in 10,000 within a farm.

    Args:
        trees: (n, 2), latitude and longitude in degrees, in the order of the file; two or more.
        properties: Properties of each tree.
        markers: Latitude and longitude of ``start`` and ``end``, degrees; markers may be missing.
        zones: Corners of each named polygon, latitude and longitude in degrees.
    """

    def __init__(
        self,
        trees: Points,
        properties: tuple[Mapping[str, Any], ...],
        markers: Mapping[str, tuple[float, float]],
        zones: Mapping[str, Points] = MappingProxyType({}),
    ) -> None:
        self._origin = trees[0]
        lat = math.radians(float(trees[0, 0]))
        flat = 1.0 - _ECCENTRICITY2 * math.sin(lat) ** 2
        north = _AXIS_M * (1.0 - _ECCENTRICITY2) / flat**1.5
        east = _AXIS_M * math.cos(lat) / math.sqrt(flat)
        self._metres_a_degree = np.radians(np.array([north, east]))
        self.properties = properties
        self.xy: Points = self.metres(trees)
        self.markers: Mapping[str, Points] = {name: self.metres(np.array(at)) for name, at in markers.items()}
        self.zones = {name: shapely.Polygon(self.metres(corners)) for name, corners in zones.items()}
        self._near = KDTree(self.xy)

    def metres(self, degrees: Points) -> Points:
        """Return metres east and north for latitudes and longitudes in degrees, along the last axis."""
        return np.asarray(((degrees - self._origin) * self._metres_a_degree)[..., ::-1])

    def nearest(self, at: Points) -> tuple[int, float]:
        """Return the index of the tree nearest to a point and its distance in metres."""
        away, tree = self._near.query(at)
        return int(tree), float(away)

    def ranked(self, at: Points, count: int) -> list[int]:
        """Return the ``count`` trees nearest to a point, nearest first; ties are in the order of the file."""
        away = np.hypot(*(self.xy - at).T)
        return [int(k) for k in np.argsort(away, kind="stable")[:count]]

    def distances(self, tree: int) -> Points:
        """Return the distances from a tree to every tree, metres."""
        return np.asarray(np.hypot(*(self.xy - self.xy[tree]).T))

    @cached_property
    def spacing_m(self) -> float:
        """Median distance from a tree to its nearest neighbour, metres."""
        away = np.sort(np.asarray(self._near.query(self.xy, k=2)[0])[:, 1])
        return float(away[len(away) // 2])

    @cached_property
    def low(self) -> Points:
        """Minimum east and north of the trees, metres."""
        return np.asarray(self.xy.min(axis=0))

    @cached_property
    def high(self) -> Points:
        """Maximum east and north of the trees, metres."""
        return np.asarray(self.xy.max(axis=0))

    @cached_property
    def middle(self) -> Points:
        """Middle of the trees' extent, metres east and north."""
        return (self.low + self.high) / 2

    @cached_property
    def corners(self) -> Mapping[CornerName, frozenset[int]]:
        """Trees that count as each corner of the farm.

        These are the tree nearest to that corner of the smallest enclosing rectangle, others hardly farther from it,
        and the tree that lies farthest in that compass direction.
        """
        hull = shapely.oriented_envelope(shapely.MultiPoint(self.xy))
        rectangle = np.unique(shapely.get_coordinates(hull), axis=0)
        centre = rectangle.mean(axis=0)
        found = {}
        for name, toward in _TOWARD.items():
            corner = rectangle[int(np.argmax((rectangle - centre) @ np.array(toward)))]
            away = np.hypot(*(self.xy - corner).T)
            trees = set(np.flatnonzero(away <= away.min() + self.spacing_m / 4).tolist())
            found[name] = frozenset(trees | {int(np.argmax(self.xy @ np.array(toward)))})
        return found


def load_case_site(path: Path) -> CaseSite:
    """Return the trees and markers of a GeoJSON file.

    Points are trees if their ``marker-symbol`` or ``kind`` says so or if they have neither; ``start`` and ``end`` are
    markers. All other features are ignored.

    Raises:
        CaseError: The file cannot be read, is not GeoJSON, or contains fewer than two trees.
    """
    trees: list[tuple[float, float]] = []
    properties: list[Mapping[str, Any]] = []
    markers: dict[str, tuple[float, float]] = {}
    for named, at in _points(path):
        kind = str(named.get("marker-symbol") or named.get("kind") or "tree")
        if kind in ("start", "end"):
            markers[kind] = at
        elif "tree" in kind or "vine" in kind:
            trees.append(at)
            properties.append(named)
    if len(trees) < 2:
        raise CaseError(
            f"the judge finds {len(trees)} trees in it", where=str(path), advice="give a site with two trees or more"
        )
    return CaseSite(np.array(trees), tuple(properties), markers, _zones(path))


def _zones(path: Path) -> Mapping[str, Points]:
    """Return the outline of each polygon that has a name, latitudes and longitudes of its corners."""
    zones: dict[str, Points] = {}
    for feature in json.loads(path.read_text(encoding="utf-8-sig"))["features"]:
        name = str((feature["properties"] or {}).get("name") or "")
        if feature["geometry"]["type"] == "Polygon" and name:
            ring = feature["geometry"]["coordinates"][0]
            zones[name] = np.array([_degrees(position) for position in ring])
    return zones


def _points(path: Path) -> list[tuple[Mapping[str, Any], tuple[float, float]]]:
    """Return properties, latitude and longitude of each point."""
    try:
        features = json.loads(path.read_text(encoding="utf-8-sig"))["features"]
        points = [f for f in features if f["geometry"]["type"] == "Point"]
        return [(f["properties"] or {}, _degrees(f["geometry"]["coordinates"])) for f in points]
    except OSError as error:
        raise CaseError(
            f"the site cannot be read: {error.strerror}", where=str(path), advice="correct the key 'site'"
        ) from None
    except (ValueError, KeyError, TypeError, IndexError, RecursionError):
        raise CaseError(
            "is not a GeoJSON file that the judge can read", where=str(path), advice="a case needs a site in GeoJSON"
        ) from None


def _degrees(position: list[float]) -> tuple[float, float]:
    lon, lat = float(position[0]), float(position[1])
    if not (math.isfinite(lat) and math.isfinite(lon)):
        raise ValueError("no number")
    return lat, lon
