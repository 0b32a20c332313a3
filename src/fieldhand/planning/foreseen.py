"""Find the parts of a selector whose places can be resolved on the site before the mission starts."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.places.filters.in_zone import InZone
from fieldhand.places.neighbours.farthest import Farthest
from fieldhand.places.selector import Selector


def foreseeable(selector: Selector) -> Iterator[Selector]:
    """Yield the largest parts of a selector whose places exist or not regardless of where the robot will be.

    The nearest line of points or row of so many trees depends on the robot's position, but its existence does not:
    such parts are searched from the start. What earlier missions did may be unknown where a mission is planned.
    """
    near_start = selector.from_start
    if not any(part.depends_on in ("mission", "readings") or part.uses_records for part in near_start.walk()):
        yield near_start
        return
    for part in selector.inner:
        if part is selector.measured_from and part.whole_zone:
            yield Farthest(origin=InZone(zone=part.whole_zone))  # a zone without trees can be measured from, too
        else:
            yield from foreseeable(part)
