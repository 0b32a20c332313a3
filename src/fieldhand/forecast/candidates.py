"""The optional visits that one choice is made from, where there are more than a table of distances has room for."""

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

#: The most visits that one choice is made from; with the place in hand and the end they fill a table of distances.
MOST_CANDIDATES = MOST - 2


def cheapest(
    here: Place, visits: Sequence[Visit], rest: RemainingWork, drives: Drives, most: int = MOST_CANDIDATES
) -> tuple[int, ...]:
    """Return the positions of the visits that one choice is made from, in their order.

    These are all visits where they are no more than ``most``, or where all drives are straight lines, which need no
    table. Else they are the ``most`` with the shortest drives from here to the visit and on to where the rest begins;
    of equal ones the first. A mission would come to the others last, if at all.

    Args:
        here: Where the robot is.
        visits: That can be made, each with its stand.
        rest: What follows. Where it drives nowhere only the drive to the visit counts.
        drives: The ways of the site.
        most: The most visits.

    Raises:
        DriveFault: There is no way to some of them.
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
    # In whole millimetres: there and back may differ in the last digit.
    order = np.argsort(np.round(metres, 3), kind="stable")
    return tuple(np.sort(order[:most]).tolist())
