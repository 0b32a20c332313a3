"""Coverage plan: the swaths over an area in driving order, the drives between them, and what they cover."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

XY = tuple[float, float]
LegKind = Literal["swath", "headland", "transit"]


@dataclass(frozen=True, kw_only=True)
class CoverageParams:
    """Parameters of a coverage plan. Lengths in metres.

    Attributes:
        working_width_m: Width that the implement works on at once.
        overlap_m: Least overlap of neighbouring swaths, for errors in steering.
        turning_radius_m: Least turning radius; 0 for a robot that turns on the spot.
        headland_passes: Passes around the area and around its holes; the swaths cover the ground inside them.
        headland_m: Width of the headland if it is to differ from that of the passes; with no passes it is ground on
            which the robot only turns.
        headland_first: Work on the headland before the swaths, else after them.
        bearing_deg: Bearing of the swaths, clockwise from true north; None for the best one.
        turn_m: Metres of driving that a turn counts for when bearings and cells are compared; None for the working
            width, or half a turning circle if that is longer.
        row_gap_m: Distance from a line of plants up to which an aisle is worked on.
        passes_per_aisle: Passes along each aisle between rows; None for as many as its width needs.
        seed: Seed of the search for the order of the swaths.
    """

    working_width_m: float
    overlap_m: float = 0.0
    turning_radius_m: float = 0.0
    headland_passes: int = 1
    headland_m: float | None = None
    headland_first: bool = True
    bearing_deg: float | None = None
    turn_m: float | None = None
    row_gap_m: float = 0.0
    passes_per_aisle: int | None = None
    seed: int = 0


@dataclass(frozen=True, kw_only=True)
class Swath:
    """The centre line of one pass of the implement, in the direction in which it is driven.

    Attributes:
        points: Metres east and north, at least two.
        width_m: Width that is worked on.
        cell: Index of its cell in :attr:`CoveragePlan.cells`.
    """

    points: tuple[XY, ...]
    width_m: float
    cell: int

    @property
    def line(self) -> LineString:
        """Return the centre line."""
        return LineString(self.points)

    @property
    def length_m(self) -> float:
        """Return the length in metres."""
        return float(self.line.length)

    @property
    def worked(self) -> Polygon:
        """Return the ground that the implement passes over, with flat ends."""
        return self.line.buffer(self.width_m / 2.0, cap_style="flat", join_style="mitre")


@dataclass(frozen=True, kw_only=True)
class CoverageCell:
    """A part of the area whose swaths are parallel, or an aisle between rows.

    Attributes:
        polygon: The part, in metres east and north.
        bearing_deg: Bearing of its swaths, clockwise from true north, 0 up to 180.
    """

    polygon: BaseGeometry
    bearing_deg: float


@dataclass(frozen=True, kw_only=True)
class CoverageLeg:
    """A part of the drive, with the implement on (a swath, a pass of the headland) or off (a transit).

    Attributes:
        kind: ``swath``, ``headland`` or ``transit``.
        points: Metres east and north; each leg starts where the one before it ends.
        swath: Index of the swath in :attr:`CoveragePlan.swaths`, of a swath.
        is_tight: True if a transit has a turn that is tighter than the turning radius, since no wider one fits.
    """

    kind: LegKind
    points: tuple[XY, ...]
    swath: int | None = None
    is_tight: bool = False

    @property
    def works(self) -> bool:
        """Return True if the implement is on."""
        return self.kind != "transit"

    @property
    def line(self) -> LineString:
        """Return the path."""
        return LineString(self.points)

    @property
    def length_m(self) -> float:
        """Return the length in metres."""
        return float(self.line.length)


@dataclass(frozen=True, kw_only=True)
class CoveragePlan:
    """The drive that covers an area, and what it covers.

    Areas are measured on the exact geometry: the union of the swaths and passes, each as wide as the implement, with
    flat ends.

    Attributes:
        area: The area to be covered.
        inside: The ground outside the declared headlands, which the swaths cover; in a planted area, the aisles.
        legs: The whole drive, in order and connected.
        swaths: Swaths in driving order.
        headlands: Closed passes around the area and its holes, in driving order.
        cells: Parts of the area with parallel swaths.
        covered: Ground of the area that is worked on.
        missed: Parts of :attr:`inside`, and of the headland if it is worked on, that no pass reaches.
        covered_share: Covered share of :attr:`inside`, 0 to 1.
        overlap_m2: Sum of the worked areas of all passes in the area, less the area of their union.
    """

    area: BaseGeometry
    inside: BaseGeometry
    legs: tuple[CoverageLeg, ...]
    swaths: tuple[Swath, ...]
    headlands: tuple[tuple[XY, ...], ...]
    cells: tuple[CoverageCell, ...]
    covered: BaseGeometry
    missed: tuple[Polygon, ...]
    covered_share: float
    overlap_m2: float

    @property
    def covered_m2(self) -> float:
        """Return the worked area in square metres, without overlap."""
        return float(self.covered.area)

    @property
    def missed_m2(self) -> float:
        """Return the missed area in square metres."""
        return float(sum(part.area for part in self.missed))

    @cached_property
    def working_m(self) -> float:
        """Return the metres driven with the implement on."""
        return sum(leg.length_m for leg in self.legs if leg.works)

    @cached_property
    def transit_m(self) -> float:
        """Return the metres driven with the implement off."""
        return sum(leg.length_m for leg in self.legs if not leg.works)

    @property
    def length_m(self) -> float:
        """Return the metres of the whole drive."""
        return self.working_m + self.transit_m

    @property
    def tight_turns(self) -> int:
        """Return the number of transits in which the robot has to turn tighter than its turning radius."""
        return sum(leg.is_tight for leg in self.legs)
