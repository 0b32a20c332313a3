"""Reject features far from the trees, and centre the projection on the trees."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.features import AreaFeature, FeatureSet, PointFeature
from fieldhand.site.formats.faults import Faults
from fieldhand.site.projection import Projection

MAX_EXTENT_M = 20_000.0
_EARTH_RADIUS_M = 6_371_000.0


def drop_strays(features: FeatureSet, faults: Faults) -> FeatureSet:
    """Return the features within 20 km of the median tree; report the others, which often have swapped coordinates."""
    planted = [(p.lon, p.lat) for p in features.points if p.kind == "tree"]
    planted = planted or [at for area in features.areas for at in area.rings[0]]
    if not planted:
        return features
    middle = np.median(_unwrapped(np.array(planted)), axis=0)
    away = _great_circle_m(np.array([(p.lon, p.lat) for p in features.points]).reshape(-1, 2), middle)
    strays = _Strays(middle, faults)
    for k in np.flatnonzero(away > MAX_EXTENT_M).tolist():
        p = features.points[k]
        strays.add(p.feature, (p.lon, p.lat), float(away[k]), needed=False)
    near = away <= MAX_EXTENT_M
    points = features.points if near.all() else [features.points[k] for k in np.flatnonzero(near).tolist()]
    areas = [a for a in features.areas if strays.near(a.feature, a.rings[0], needed=a.kind != "zone")]
    barriers = [b for b in features.barriers if strays.near(b.feature, b.positions, needed=True)]
    return replace(features, points=points, areas=areas, barriers=barriers)


def middle_of(planted: Sequence[PointFeature], grounds: Sequence[AreaFeature] = ()) -> Projection:
    """Return the projection centred on the middle of the trees' extent, without trees on that of the areas."""
    positions = [(p.lon, p.lat) for p in planted] or [at for area in grounds for at in area.rings[0]]
    degrees = _unwrapped(np.array(positions))
    lon, lat = (degrees.min(axis=0) + degrees.max(axis=0)) / 2
    return Projection(lat=float(lat), lon=float((lon + 180.0) % 360.0 - 180.0))


class _Strays:
    def __init__(self, middle: NDArray[np.float64], faults: Faults) -> None:
        self._middle = middle
        self._add: Callable[..., None] = faults.add

    def near(self, number: int, positions: Sequence[tuple[float, float]], *, needed: bool) -> bool:
        away = _great_circle_m(np.array(positions), self._middle)
        worst = int(np.argmax(away))
        if away[worst] <= MAX_EXTENT_M:
            return True
        self.add(number, positions[worst], float(away[worst]), needed=needed)
        return False

    def add(self, number: int, position: tuple[float, float], away_m: float, *, needed: bool) -> None:
        lon, lat = position
        swapped = abs(lon) <= 90 and _great_circle_m(np.array([(lat, lon)]), self._middle)[0] <= MAX_EXTENT_M
        self._add(
            number,
            f"it lies {away_m / 1000:,.0f} km from the middle of the trees"
            + (": its latitude and longitude are swapped" if swapped else ""),
            "write [longitude, latitude]" if swapped else "correct its coordinates [longitude, latitude] or remove it",
            needed=needed,
        )


def _unwrapped(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return positions with continuous longitudes for sites across the date line."""
    out = degrees.copy()
    if np.ptp(out[:, 0]) > 180.0:
        out[out[:, 0] < 0.0, 0] += 360.0
    return out


def _great_circle_m(degrees: NDArray[np.float64], middle: NDArray[np.float64]) -> NDArray[np.float64]:
    lon, lat = np.radians(degrees[:, 0]), np.radians(degrees[:, 1])
    lon0, lat0 = np.radians(middle)
    h = np.sin((lat - lat0) / 2) ** 2 + np.cos(lat) * np.cos(lat0) * np.sin((lon - lon0) / 2) ** 2
    return np.asarray(2 * _EARTH_RADIUS_M * np.arcsin(np.sqrt(np.clip(h, 0.0, 1.0))), dtype=np.float64)
