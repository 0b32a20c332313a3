"""What a selector fixes by its form alone: at how many places it comes out, its counts, its sides of the compass."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from fieldhand.places import selectors as s
from fieldhand.places.selectors import Selector
from fieldhand.terms import Side

_SIDES: dict[str, Side] = {"n": "north", "e": "east", "s": "south", "w": "west"}


@dataclass(frozen=True, kw_only=True)
class Range:
    """A number that a plan fixes to between ``low`` and ``high`` (None: no bound)."""

    low: int
    high: int | None

    @property
    def exact(self) -> int | None:
        """The number, where there is only one."""
        return self.low if self.low == self.high else None

    def times(self, other: Range) -> Range:
        """So many of so many."""
        high = None if self.high is None or other.high is None else self.high * other.high
        return Range(low=self.low * other.low, high=high)


ONE = Range(low=1, high=1)


def places(selector: Selector) -> Range:
    """At how many distinct places a selector comes out, by its form alone."""
    match selector:
        case s.Corners(which=which) if selector.of == s.Trees():
            return Range(low=len(which), high=len(which))
        case s.Union(parts=parts):
            ranges = [places(part) for part in parts]
            highs = [r.high for r in ranges]
            total = None if None in highs else sum(h for h in highs if h is not None)
            apart = all(isinstance(part, s.TreeIs) for part in parts) and len(set(parts)) == len(parts)
            return Range(low=total if apart and total is not None else 1, high=total)
        case s.Spaced(count=count) | s.Apart(count=count) | s.PointsIn(count=count) if count:
            return Range(low=count, high=count)
        case s.Extreme() | s.Middle() | s.EdgeMiddle() | s.Nearest() | s.Farthest() | s.Top() | s.Take() | s.Random():
            return Range(low=selector.count, high=selector.count)
        case s.Adjacent() | s.Successive() | s.Spread():
            return Range(low=selector.count, high=selector.count)
        case s.Ordered(of=of):
            return places(of)
        case s.Where(of=of) | s.InZone(of=of) | s.Within(of=of) | s.Half(of=of) | s.Quarter(of=of) | s.Excluding(of=of):
            return Range(low=0, high=places(of).high)
        case _ if s.is_single(selector):
            return ONE
        case _:
            return Range(low=0, high=None)


def counts(selector: Selector) -> Iterator[int]:
    """The counts in a selector."""
    for part in s.walk(selector):
        count = getattr(part, "count", 0)
        yield from (count,) if count else ()


def sides(selector: Selector) -> Iterator[Side]:
    """The sides of the compass that a selector goes to: not where it counts from, nor all four corners together."""
    match selector:
        case s.Corners(which=which) if len(which) < 4:
            corners: tuple[str, ...] = which
        case s.Quarter(quarter=quarter):
            corners = (quarter,)
        case _:
            corners = ()
            for name in ("side", "towards"):
                value = getattr(selector, name, "")
                yield from (side for side in _SIDES.values() if side == value)
    # A pair of corners such as nw and ne is "the northern corners": only what they share has to be said.
    shared = set.intersection(*(set(corner) for corner in corners)) if corners else set()
    for letter in shared:
        yield _SIDES[letter]
