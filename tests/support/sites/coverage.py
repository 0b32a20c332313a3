"""Independent checks of coverage plans."""

from __future__ import annotations

import itertools

import numpy as np
import shapely

from fieldhand.site.coverage.plan import CoveragePlan


def uncovered_m2(plan: CoveragePlan, width_m: float) -> float:
    """Return the ground outside the headlands that no pass covers, computed from the legs alone."""
    worked = [leg.line.buffer(width_m / 2.0, cap_style="flat", join_style="mitre") for leg in plan.legs if leg.works]
    # A micrometre: the ends of neighbouring flat ends are computed separately.
    return float(plan.inside.difference(shapely.union_all(worked).buffer(1e-6)).area)


def is_connected(plan: CoveragePlan) -> bool:
    ends = [(one.points[-1], two.points[0]) for one, two in itertools.pairwise(plan.legs)]
    return all(np.hypot(a[0] - b[0], a[1] - b[1]) < 1e-6 for a, b in ends)
