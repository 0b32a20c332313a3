"""Maps of Nav2's ``map_server``: an image (PGM) and a YAML file beside it, and the masks of its costmap filters.

Formats: ``nav2_map_server/src/map_io.cpp`` (keys ``image``, ``mode``, ``resolution``, ``origin``, ``negate``,
``occupied_thresh``, ``free_thresh``; the first line of the image has the greatest y) and
``nav2_costmap_2d/plugins/costmap_filters/speed_filter.cpp`` (limit = value * multiplier + base, 0 for no limit).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from fieldhand.exchange.nav2.grid import Cells, MapGrid
from fieldhand.exchange.nav2.ground import MappedGround

#: Grey values of free and of occupied cells, which every threshold between 0.01 and 1 tells apart.
_FREE, _OCCUPIED = 254, 0

#: Greatest value of a speed mask: 1 % of the speed. With 100 the limit would be 0, which means no limit.
_SLOWEST = 99


def occupancy_image(occupied: Cells) -> bytes:
    """Return an image of occupied and free cells for the mode ``trinary``."""
    return _image(np.where(occupied, _OCCUPIED, _FREE).astype(np.uint8))


def speed_image(ground: MappedGround, grid: MapGrid, speed_m_s: float) -> bytes:
    """Return an image of speed limits for the mode ``raw``: the percent by which the robot is slower than its speed.

    With ``base`` 100 and ``multiplier`` -1 they are limits in percent of the controller's speed; with both multiplied
    by a hundredth of the robot's speed, limits in m/s. Of several limits the lowest applies.
    """
    values = np.zeros((grid.rows, grid.columns), dtype=np.uint8)
    for shape, limit_m_s in ground.slow:
        slower = np.uint8(slower_percent(limit_m_s, speed_m_s))
        np.maximum(values, slower, out=values, where=grid.covered(shape))
    return _image(values)


def slower_percent(limit_m_s: float, speed_m_s: float) -> int:
    """Return the percent by which a limit is below a speed, so that the robot is never faster than the limit."""
    return min(_SLOWEST, max(0, 100 - math.floor(100.0 * limit_m_s / speed_m_s + 1e-9)))


def map_document(grid: MapGrid, image: str, *, mode: str) -> bytes:
    """Return the YAML file beside an image."""
    origin = f"[{grid.left!r}, {grid.bottom!r}, 0.0]"
    keys = {"image": image, "mode": mode, "resolution": grid.resolution_m, "origin": origin}
    keys |= {"negate": 0, "occupied_thresh": 0.65, "free_thresh": 0.25}
    return "".join(f"{key}: {value}\n" for key, value in keys.items()).encode()


def _image(values: NDArray[np.uint8]) -> bytes:
    """Return a binary PGM, whose first line is the row of greatest y."""
    rows, columns = values.shape
    return f"P5\n{columns} {rows}\n255\n".encode() + np.ascontiguousarray(values[::-1]).tobytes()
