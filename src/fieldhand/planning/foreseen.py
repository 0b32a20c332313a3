"""What of a selector can be looked up on the site before the robot has moved."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from fieldhand.places.selectors import (
    Adjacent,
    Bound,
    Farthest,
    Here,
    InZone,
    Marker,
    Nearest,
    Other,
    Selector,
    Spaced,
    Successive,
    Within,
    parts,
    walk,
    zone_itself,
)


def foreseeable(selector: Selector) -> Iterator[Selector]:
    """The largest parts of a selector whose places exist or not wherever the robot will be.

    A line of points and a row of so many trees are near to the robot, but that there is one does not depend on it:
    they are looked for from the start.
    """
    near_start = _from_start(selector)
    if not any(_depends(part) for part in walk(near_start)):
        yield near_start
        return
    measured = _measured_from(selector)
    for part in parts(selector):
        if part is measured and (zone := zone_itself(part)):
            yield Farthest(origin=InZone(zone=zone))  # a zone without trees is a place to measure from, too
        else:
            yield from foreseeable(part)


def _measured_from(selector: Selector) -> Selector | None:
    """Return the part of a selector from which it measures distances."""
    match selector:
        case Nearest(to=origin) | Within(to=origin) | Farthest(origin=origin):
            return origin
        case Adjacent(near=origin) | Successive(near=origin) | Spaced(near=origin):
            return origin
        case _:
            return None


def _depends(part: Selector) -> bool:
    """Whether what it selects depends on where the robot is or has been, more than any choice of the nearest does."""
    return isinstance(part, Here | Bound | Other) or (isinstance(part, Nearest) and part.fresh)


def _from_start(selector: Selector) -> Selector:
    match selector:
        case Spaced() | Successive() if selector.near == Here():
            return replace(selector, near=Marker(name="start"))
        case _:
            return selector
