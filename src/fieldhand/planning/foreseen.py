"""What of a selector can be looked up on the site before the robot has moved."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from fieldhand.task.selectors import Bound, Here, Marker, Nearest, Other, Selector, Spaced, Successive, parts, walk


def foreseeable(selector: Selector) -> Iterator[Selector]:
    """The largest parts of a selector whose places exist or not wherever the robot will be.

    A line of points and a row of so many trees are near to the robot, but that there is one does not depend on it:
    they are looked for from the start.
    """
    near_start = _from_start(selector)
    if not any(_depends(part) for part in walk(near_start)):
        yield near_start
        return
    for part in parts(selector):
        yield from foreseeable(part)


def _depends(part: Selector) -> bool:
    """Whether what it selects depends on where the robot is or has been, more than any choice of the nearest does."""
    return isinstance(part, Here | Bound | Other) or (isinstance(part, Nearest) and part.fresh)


def _from_start(selector: Selector) -> Selector:
    match selector:
        case Spaced() | Successive() if selector.near == Here():
            return replace(selector, near=Marker(name="start"))
        case _:
            return selector
