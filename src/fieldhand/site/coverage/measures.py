"""Measures of a coverage plan: covered and missed ground, overlap, and the objectives that Fields2Cover defines.

The objectives of Fields2Cover (Mier, Valente and de Bruin 2023, "Fields2Cover: An open-source coverage path planning
library for unmanned agricultural vehicles", IEEE Robotics and Automation Letters 8) are of one cell and its swaths:
their number, the sum of their lengths, the covered share of the cell, and the overlap of every two swaths by its area.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

#: Missed parts of less than this, in square metres, are rounding errors of the geometry.
_NOTHING_M2 = 1e-6

#: Missed parts that vanish if they are shrunk by this, in metres, are rounding errors of the geometry.
_NOTHING_M = 1e-6


@dataclass(frozen=True, kw_only=True)
class Fields2CoverObjectives:
    """The objectives of Fields2Cover for a set of swaths.

    Attributes:
        swaths: Number of swaths.
        swath_m: Sum of the lengths of the swaths.
        coverage: Share of the ground that the swaths cover, 0 to 1.
        overlap: Sum over every two swaths of the ground that both cover, divided by the area of the ground.
    """

    swaths: int
    swath_m: float
    coverage: float
    overlap: float


def fields2cover_objectives(
    ground: BaseGeometry, lines: Sequence[LineString], width_m: float
) -> Fields2CoverObjectives:
    """Return the objectives of Fields2Cover.

    Args:
        ground: Ground to be covered, without headlands.
        lines: Centre lines of the swaths.
        width_m: Working width.
    """
    worked = [shapely.intersection(worked_by(line, width_m), ground) for line in lines]
    tree = shapely.STRtree(worked)
    overlap = sum(
        float(shapely.intersection(worked[i], worked[j]).area)
        for i, j in zip(*tree.query(worked, predicate="intersects").tolist(), strict=True)
        if i < j
    )
    area = float(ground.area)
    return Fields2CoverObjectives(
        swaths=len(lines),
        swath_m=float(sum(line.length for line in lines)),
        coverage=float(shapely.union_all(worked).area) / area if area else 1.0,
        overlap=overlap / area if area else 0.0,
    )


def worked_by(line: LineString, width_m: float) -> Polygon:
    """Return the ground that an implement passes over along a line: flat ends, round corners if the line is closed."""
    return line.buffer(width_m / 2.0, cap_style="flat", join_style="round" if line.is_ring else "mitre")


def missed_parts(ground: BaseGeometry, covered: BaseGeometry) -> tuple[Polygon, ...]:
    """Return the parts of some ground that are not covered, largest first."""
    left = ground.difference(covered)
    parts = [
        part
        for part in shapely.get_parts(left)
        if isinstance(part, Polygon) and part.area > _NOTHING_M2 and not part.buffer(-_NOTHING_M).is_empty
    ]
    return tuple(sorted(parts, key=lambda part: -part.area))


def overlap_m2(worked: Sequence[Polygon], area: BaseGeometry, covered: BaseGeometry) -> float:
    """Return the sum of the worked ground of all passes in an area, less the ground that they cover together."""
    inside = sum(float(part.intersection(area).area) for part in worked)
    return max(inside - float(covered.area), 0.0)


def ends_of(lines: Sequence[Sequence[tuple[float, float]]]) -> list[tuple[float, float]]:
    """Return the first and the last point of each line, in turn."""
    return list(itertools.chain.from_iterable((line[0], line[-1]) for line in lines))
