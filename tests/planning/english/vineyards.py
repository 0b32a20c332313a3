"""A made vineyard as growers have one: two blocks of curved rows, varieties, vigor, a pond, a gate and a barn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

from fieldhand.site.model import Site
from support.sites.points import area, point, read, square

ROWS, ALONG = 14, 24
#: Metres between rows, and between vines along them.
APART_M, STEP_M = 3.0, 1.8
_LON, _LAT = -122.3, 38.3
_EAST_M, _NORTH_M = 111_320.0 * math.cos(math.radians(_LAT)), 110_990.0
VARIETIES = ("Merlot", "Syrah", "Cabernet Sauvignon")


@dataclass(frozen=True, kw_only=True)
class Vine:
    """A vine as it was planted: ``row`` counts from west, ``place`` in the row from north, both from 1."""

    id: str
    block: str
    row: int
    place: int
    x: float
    y: float
    variety: str
    vigor: float


@cache
def vines() -> tuple[Vine, ...]:
    """Return the vines of both blocks; a row bends to the east in its middle."""
    made: list[Vine] = []
    for block, top in (("North", 100.0), ("South", 0.0)):
        for row in range(1, ROWS + 1):
            for place in range(1, ALONG + 1):
                bend = 2.5 * math.sin(math.pi * (place - 1) / (ALONG - 1))
                number = len(made) + 1
                made.append(
                    Vine(
                        id=f"N{number}",
                        block=block,
                        row=row,
                        place=place,
                        x=row * APART_M + bend,
                        y=top - place * STEP_M,
                        variety=VARIETIES[(row - 1) // 5],
                        vigor=round(0.2 + ((number * 37) % 61) / 100, 2),
                    )
                )
    return tuple(made)


@cache
def vineyard() -> Site:
    """Return the vineyard, read from GeoJSON."""
    features: list[dict[str, Any]] = [
        point(*_degrees(v.x, v.y), id=v.id, block=v.block, variety=v.variety, vigor=v.vigor) for v in vines()
    ]
    pond = area(square(*_degrees(60.0, 90.0), half=0.00005), name="pond", kind="keep_out")
    w, s = _degrees(-30.0, -80.0)
    e, n = _degrees(90.0, 130.0)
    fence = area([(w, s), (e, s), (e, n), (w, n), (w, s)], name="property line", kind="boundary")
    barn = point(*_degrees(-10.0, -60.0), name="barn", kind="start")
    gate = point(*_degrees(-30.0, 20.0), name="gate", kind="gate")
    return read(*features, pond, fence, barn, gate)


def _degrees(x: float, y: float) -> tuple[float, float]:
    return _LON + x / _EAST_M, _LAT + y / _NORTH_M
