"""Generate the built-in vineyard as GeoJSON: two blocks of curved rows, three varieties, a meadow, a gate and a pond.

``scripts/make_demo_vineyard.py`` writes it into the package.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.projection import Projection

_SEED = 1872
_LATITUDE, _LONGITUDE = 38.4137, -122.6015
#: Bearing of the rows' chord, in degrees clockwise from true north.
_TURNED_DEG = -11.0
#: Seven decimals of a degree are 1 cm.
_DECIMALS = 7

Feature = dict[str, Any]
Points = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class VineVariety:
    """A variety, the year in which it was planted, and the last of the rows that it fills (the first follows on)."""

    name: str
    planted: int
    last_row: int


@dataclass(frozen=True, kw_only=True)
class VineBlock:
    """A block of parallel rows; distances in metres from the vineyard's middle.

    Attributes:
        west, north: Position of the north end of row 1.
        bow_m: Largest distance of a row from its chord, to the east; the row is an arc.
        bend_deg: Change of direction in the middle of a row, to the east going south; an arc has none.
    """

    name: str
    west: float
    north: float
    rows: int
    vines_a_row: int
    varieties: tuple[VineVariety, ...]
    bow_m: float = 0.0
    bend_deg: float = 0.0
    row_spacing_m: float = 3.0
    vine_spacing_m: float = 1.8
    jitter_m: float = 0.05
    missing: float = 0.025

    def position(self, row: int, place: int) -> tuple[float, float]:
        """Return where a vine is planted; rows count from west, places from north, both from 1."""
        down = (place - 1) * self.vine_spacing_m
        share = (place - 1) / max(1, self.vines_a_row - 1)
        half = (self.vines_a_row - 1) * self.vine_spacing_m / 2
        east = self.bow_m * math.sin(math.pi * share) + max(0.0, down - half) * math.tan(math.radians(self.bend_deg))
        return self.west + (row - 1) * self.row_spacing_m + east, self.north - down

    def variety(self, row: int) -> VineVariety:
        """Return the variety of a row."""
        return next(v for v in self.varieties if row <= v.last_row)


NORTH = VineBlock(
    name="North",
    west=0.0,
    north=50.0,
    rows=24,
    vines_a_row=24,
    bow_m=-3.0,
    varieties=(
        VineVariety(name="Cabernet Sauvignon", planted=2008, last_row=10),
        VineVariety(name="Merlot", planted=2012, last_row=18),
        VineVariety(name="Syrah", planted=2015, last_row=24),
    ),
)
SOUTH = VineBlock(
    name="South",
    west=3.0,
    north=-8.0,
    rows=20,
    vines_a_row=23,
    bend_deg=9.0,
    varieties=(
        VineVariety(name="Merlot", planted=2010, last_row=8),
        VineVariety(name="Syrah", planted=2015, last_row=14),
        VineVariety(name="Cabernet Sauvignon", planted=2018, last_row=20),
    ),
)

_BOUNDARY = ((-62.0, -66.0), (98.0, -66.0), (98.0, 64.0), (-62.0, 64.0))
_MEADOW = ((-58.0, -40.0), (-15.0, -48.0), (-15.0, 52.0), (-58.0, 58.0))
_WET_CORNER = ((-2.0, -62.0), (30.0, -62.0), (30.0, -38.0), (-2.0, -38.0))
_PUMP = ((78.0, 38.0), (82.0, 38.0), (82.0, 42.0), (78.0, 42.0))
_POND_CENTRE, _POND_HALF_AXES = (85.0, -2.0), (9.0, 8.0)
#: The fence between the meadow and the vines; the gate is in it.
_FENCE, _GATE = ((-12.0, -66.0), (-12.0, 64.0)), (-12.0, 0.0)
_MARKERS = (("start", "barn", (-6.0, -60.0)), ("charger", "", (-6.0, -54.0)), ("end", "loading bay", (84.0, -56.0)))


def demo_vineyard(seed: int = _SEED) -> dict[str, Any]:
    """Return the built-in vineyard as a GeoJSON FeatureCollection; the same seed gives the same vineyard.

    Vines are the weaker the nearer they grow to the wet corner in the south-west, and young where they were
    replanted, so that queries over vigor and year find a pattern. A few positions in the rows are empty.
    """
    rng = np.random.default_rng(seed)
    projection = Projection(_LATITUDE, _LONGITUDE)
    features = [*_areas(projection, rng), *_points(projection)]
    for block in (NORTH, SOUTH):
        features.extend(_vines(projection, block, rng))
    return {"type": "FeatureCollection", "name": "Demo vineyard", "features": features}


def _areas(projection: Projection, rng: np.random.Generator) -> Iterator[Feature]:
    turn = np.arange(16) * (2 * math.pi / 16)
    swell = 1.0 + 0.07 * rng.uniform(-1.0, 1.0, len(turn))
    (x, y), (a, b) = _POND_CENTRE, _POND_HALF_AXES
    shore = tuple(zip(x + a * swell * np.cos(turn), y + b * swell * np.sin(turn), strict=True))
    for kind, name, corners in (
        ("boundary", "property line", _BOUNDARY),
        ("keep-out", "pond", shore),
        ("zone", "meadow", _MEADOW),
        ("zone", "wet corner", _WET_CORNER),
        ("zone", "pump", _PUMP),
    ):
        ring = _degrees(projection, np.array([*corners, corners[0]]))
        yield _feature("Polygon", [ring], {"kind": kind, "name": name})
    yield _feature("LineString", _degrees(projection, np.array(_FENCE)), {"kind": "fence", "name": "meadow fence"})


def _points(projection: Projection) -> Iterator[Feature]:
    gate = {"kind": "gate", "name": "meadow gate", "width_m": 4}
    yield _feature("Point", _degrees(projection, np.array(_GATE))[0], gate)
    for kind, name, at in _MARKERS:
        properties = {"kind": kind, "name": name} if name else {"kind": kind}
        yield _feature("Point", _degrees(projection, np.array(at))[0], properties)


def _vines(projection: Projection, block: VineBlock, rng: np.random.Generator) -> Iterator[Feature]:
    number = 0
    for row in range(1, block.rows + 1):
        variety = block.variety(row)
        for place in range(1, block.vines_a_row + 1):
            du, dv = rng.normal(0.0, block.jitter_m, 2)
            gone, replanted, growth = rng.random(3)
            at_end = place in (1, block.vines_a_row)
            if gone < block.missing and not at_end:
                continue
            number += 1
            x, y = block.position(row, place)
            wet = math.exp(-(((x - 5.0) / 30.0) ** 2) - ((y + 50.0) / 30.0) ** 2)
            young = replanted < 0.05
            vigor = 0.8 - 0.45 * wet - 0.25 * young + 0.35 * (growth - 0.5)
            properties = {
                "id": f"{block.name[0]}{number}",
                "block": block.name,
                "row": row,
                "variety": variety.name,
                "planted": variety.planted + 1 + int(replanted * 20 * (2024 - variety.planted))
                if young
                else variety.planted,
                "vigor": round(min(1.0, max(0.0, vigor)), 2),
            }
            yield _feature("Point", _degrees(projection, np.array([x + du, y + dv]))[0], {"kind": "vine", **properties})


def _degrees(projection: Projection, local: Points) -> list[list[float]]:
    turned = math.radians(_TURNED_DEG)
    c, s = math.cos(turned), math.sin(turned)
    return projection.positions(np.atleast_2d(local) @ np.array([[c, -s], [s, c]]), _DECIMALS)


def _feature(kind: str, coordinates: Any, properties: dict[str, Any]) -> Feature:
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}
