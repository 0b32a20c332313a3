"""What of a selector can be looked up on the site before the robot has moved."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.places.filters.in_zone import InZone
from fieldhand.places.neighbours.farthest import Farthest
from fieldhand.places.selector import Selector


def foreseeable(selector: Selector) -> Iterator[Selector]:
    """The largest parts of a selector whose places exist or not wherever the robot will be.

    A line of points and a row of so many trees are near to the robot, but that there is one does not depend on it:
    they are looked for from the start.
    """
    near_start = selector.from_start
    if not any(part.depends_on == "mission" for part in near_start.walk()):
        yield near_start
        return
    for part in selector.inner:
        if part is selector.measured_from and part.whole_zone:
            yield Farthest(origin=InZone(zone=part.whole_zone))  # a zone without trees is a place to measure from, too
        else:
            yield from foreseeable(part)
