"""Local metric projection of a site."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import pyproj
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class Projection:
    """Azimuthal equidistant projection about a point of the site, on WGS 84.

    Distances differ from the geodesic by less than 1 mm within 5 km. Axes point to true east and north at the origin.
    """

    lat: float
    lon: float

    @cached_property
    def _transformer(self) -> pyproj.Transformer:
        return _transformer_about(self.lat, self.lon)

    def metres(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.float64]:
        """Convert degrees to metres east and north, shape (n, 2)."""
        x, y = self._transformer.transform(np.atleast_1d(lon), np.atleast_1d(lat))
        return np.column_stack([x, y]).astype(np.float64)

    def degrees(self, xy: ArrayLike) -> NDArray[np.float64]:
        """Convert metres east and north, shape (n, 2), to latitude and longitude, shape (n, 2)."""
        points = np.atleast_2d(np.asarray(xy, dtype=np.float64))
        lon, lat = self._transformer.transform(points[:, 0], points[:, 1], direction="INVERSE")
        return np.column_stack([lat, lon]).astype(np.float64)

    def lat_lon(self, xy: ArrayLike) -> tuple[tuple[float, float], ...]:
        """Return points in metres east and north, shape (n, 2), as n pairs of latitude and longitude in degrees."""
        return tuple((lat, lon) for lat, lon in self.degrees(xy).tolist())

    def positions(self, xy: ArrayLike, decimals: int = 15) -> list[list[float]]:
        """Return points in metres east and north, shape (n, 2), as GeoJSON positions; in full precision by default."""
        return [[round(lon, decimals), round(lat, decimals)] for lat, lon in self.degrees(xy).tolist()]


#: WGS 84 in degrees. PROJ finds the same operation for ``EPSG:4326``, after a search of its database that takes 15 ms.
_DEGREES = "+proj=longlat +datum=WGS84"


@lru_cache(maxsize=256)
def _transformer_about(lat: float, lon: float) -> pyproj.Transformer:
    """Return the conversion from degrees to metres about a point; threads can share it."""
    local = pyproj.CRS.from_proj4(f"+proj=aeqd +lat_0={lat!r} +lon_0={lon!r} +datum=WGS84 +units=m")
    return pyproj.Transformer.from_crs(_DEGREES, local, always_xy=True)
