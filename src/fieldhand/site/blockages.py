"""What a robot found blocked on its way, and the ways that are left without it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import shapely
from shapely.geometry import Polygon

from fieldhand.site.drives import XY, Drives
from fieldhand.site.driving.stretch import blocked_stretch
from fieldhand.site.model import Zone

#: On open ground a stretch is at first so many clearances wide to either side.
_WIDE = 1.5

#: Stretches that are nearer than this to one another are of one obstacle, of which more has been seen.
_SAME_M = 1.0

#: A robot stands outside a stretch by at least so much.
_BESIDE_M = 1e-3


class Blockages:
    """The stretches that are blocked, and the drives that avoid them.

    Args:
        drives: The ways of the site as it was approved.

    Attributes:
        drives: The ways that are left. What they avoid counts as a keep-out.
        stretches: In metres east and north.
        version: Changes whenever the ways do.
    """

    def __init__(self, drives: Drives) -> None:
        self._all = self.drives = drives
        self.stretches: tuple[Polygon, ...] = ()
        self.version = 0

    def found(self, at: XY, towards: XY) -> Polygon:
        """A robot was stopped at a point by what is between it and the next.

        Of an obstacle on open ground that turns out to be larger each further stretch is taken twice as wide.

        Returns:
            What is taken as blocked from now on.
        """
        # Where the robot stands nothing is in the way, whatever was seen there from another side.
        self.stretches = tuple(s for s in self.stretches if s.distance(shapely.Point(at)) > _BESIDE_M)
        near = shapely.Point(at).buffer(_SAME_M)
        known = sum(stretch.intersects(near) for stretch in self.stretches)
        half_width_m = _WIDE * self._all.clearance_m * 2.0 ** min(known, 6)
        stretch = blocked_stretch(self._all.layout, at, towards, half_width_m)
        self.are((*self.stretches, stretch))
        return stretch

    def are(self, stretches: Sequence[Polygon]) -> None:
        """Let these be what is blocked, and nothing else."""
        self.stretches, self.version = tuple(stretches), self.version + 1
        self.drives = _without(self._all, self.stretches) if stretches else self._all


def _without(drives: Drives, stretches: Sequence[Polygon]) -> Drives:
    zones = tuple(
        Zone(name=f"blocked stretch {number}", kind="keep_out", polygon=polygon)
        for number, polygon in enumerate(stretches, start=1)
    )
    site = replace(drives.site, zones=(*drives.site.zones, *zones))
    vars(site)["planting"] = drives.site.planting  # the rows are where they were
    return Drives(site, drives.clearance_m, drives.standoff_m)
