"""Preselection of optional visits, if there are more than fit a table of distances."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.forecast.mission_state import Visit
from fieldhand.forecast.remaining_work import RemainingWork
from fieldhand.orienteering.table import MOST
from fieldhand.site.model import Place

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

#: Maximum number of visits in one choice; with the current place and the end they fill a table of distances.
MOST_CANDIDATES = MOST - 2


def cheapest(
    here: Place, visits: Sequence[Visit], rest: RemainingWork, drives: Drives, most: int = MOST_CANDIDATES
) -> tuple[int, ...]:
    """Return the indices of the visits to choose from, in ascending order.

    All visits are kept if there are at most ``most``, or if all drives are straight lines, which need no table.
    Otherwise the ``most`` visits with the shortest detour from here over the visit to the start of the remaining work
    are kept; ties go to the first. A mission would reach the others last, if at all.

    Args:
        here: Current place of the robot.
        visits: Possible visits; their places have stands.
        rest: Work that follows. If it includes no drive, only the drive to the visit counts.
        drives: Drives between places of the site.
        most: Maximum number of visits.

    Raises:
        DriveFault: Some visit cannot be reached.
    """
    every = tuple(range(len(visits)))
    if len(visits) <= most:
        return every
    places, ends = [v.place for v in visits], [v.end for v in visits]
    if rest.first is not None and places == ends and drives.are_straight([here, *places, rest.first]):
        return every
    metres = drives.lengths([here], places)[0]
    if rest.first is not None:
        metres = metres + drives.lengths([rest.first], ends)[0]
    # Rounded to millimetres, because the two directions of a drive may differ in the last digit.
    order = np.argsort(np.round(metres, 3), kind="stable")
    return tuple(np.sort(order[:most]).tolist())
