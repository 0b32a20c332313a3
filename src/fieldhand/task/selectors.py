"""Selectors: how a Task names places without coordinates.

A selector is an expression. The innermost part is a source (every tree, a marker, the place in hand); each part around
it keeps, orders or picks from what its ``of`` selects. "Yellow trees in the northern half" is
``Where(attribute="leaf_color", test="eq", value="yellow", of=Half(side="north", of=Trees()))``.

What each one means is computed by :mod:`fieldhand.site.places`, in local metres; the definitions stand there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Literal

Side = Literal["north", "east", "south", "west"]
CornerName = Literal["nw", "ne", "se", "sw"]
MarkerName = Literal["start", "end", "charger"]
Test = Literal["lt", "le", "gt", "ge", "eq", "ne"]
Value = str | float | bool


@dataclass(frozen=True, kw_only=True)
class Trees:
    """Every tree of the site, in the order of the file."""


@dataclass(frozen=True, kw_only=True)
class TreeIs:
    """The tree with this id (the file's own id where it has one, else its position in the file counted from 1)."""

    tree: str


@dataclass(frozen=True, kw_only=True)
class Marker:
    """A marker of the site: where the robot starts, ends or charges."""

    name: MarkerName


@dataclass(frozen=True, kw_only=True)
class Here:
    """The place in hand: where the robot last stopped."""


@dataclass(frozen=True, kw_only=True)
class Bound:
    """The place or places that a node of this Task bound to ``label``."""

    label: str


@dataclass(frozen=True, kw_only=True)
class First:
    """The tree nearest to the start marker, or the first of the file where there is no marker."""

    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Last:
    """The tree nearest to the end marker, or the last of the file where there is no marker."""

    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Corners:
    """The tree nearest to each named corner of the smallest-area enclosing rectangle of ``of``; all four by default."""

    which: tuple[CornerName, ...] = ("nw", "ne", "se", "sw")
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Extreme:
    """The ``count`` trees farthest to one side ("the northernmost tree", "the 3 most eastern trees")."""

    side: Side
    count: int = 1
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class AmongExtreme:
    """The trees within one row spacing of the extreme ("one of the northernmost trees" is one of these)."""

    side: Side
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Middle:
    """The ``count`` trees nearest to the centre of the extent of ``of``."""

    count: int = 1
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class EdgeMiddle:
    """The ``count`` trees on one edge of ``of`` that are nearest to the middle of that edge."""

    side: Side
    count: int = 1
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Half:
    """Trees on one side of the middle line of the extent of ``of``."""

    side: Side
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Quarter:
    """Trees in one quarter of the extent of ``of``."""

    quarter: CornerName
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Edge:
    """Trees on the outermost line of one side of ``of``: those with no tree of ``of`` beyond them within a spacing."""

    side: Side
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Nearest:
    """The ``count`` trees of ``of`` nearest to ``to`` that are not ``to``.

    ``adjacent`` asks for neighbours ("next to"): the same row is preferred. ``fresh`` passes over trees that this
    mission has visited already ("nearby").
    """

    to: Selector
    count: int = 1
    adjacent: bool = False
    fresh: bool = False
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Farthest:
    """The ``count`` trees of ``of`` farthest from ``origin``."""

    origin: Selector
    count: int = 1
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Adjacent:
    """``count`` trees next to each other: the tree of ``of`` nearest to ``near`` and then neighbour after neighbour."""

    near: Selector
    count: int = 2
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Other:
    """Trees that this mission has not visited ("another", "a different tree")."""

    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Excluding:
    """Trees of ``of`` that are not among ``places``."""

    places: Selector
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Where:
    """Trees whose attribute passes a test; text compares without regard to case."""

    attribute: str
    test: Test
    value: Value
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Top:
    """The ``count`` trees with the highest (or lowest) value of an attribute."""

    attribute: str
    count: int
    lowest: bool = False
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class InZone:
    """Trees inside a named zone of the site, or outside it."""

    zone: str
    outside: bool = False
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Within:
    """Trees at most ``distance_m`` metres from ``to``, which itself does not count."""

    distance_m: float
    to: Selector
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Take:
    """Any ``count`` of ``of``: the nearest to the place in hand, so that the drive is short."""

    count: int
    of: Selector


@dataclass(frozen=True, kw_only=True)
class Union:
    """All places of the parts, in their order, each once."""

    parts: tuple[Selector, ...]


Selector = (
    Trees
    | TreeIs
    | Marker
    | Here
    | Bound
    | First
    | Last
    | Corners
    | Extreme
    | AmongExtreme
    | Middle
    | EdgeMiddle
    | Half
    | Quarter
    | Edge
    | Nearest
    | Farthest
    | Adjacent
    | Other
    | Excluding
    | Where
    | Top
    | InZone
    | Within
    | Take
    | Union
)

#: Selectors whose meaning depends on where the robot is or has been: they resolve when they are reached.
RELATIVE = (Here, Bound, Other, Take)


def parts(selector: Selector) -> Iterator[Selector]:
    """The selectors directly inside this one."""
    for field in fields(selector):
        value = getattr(selector, field.name)
        for item in value if isinstance(value, tuple) else (value,):
            if isinstance(item, Selector):
                yield item


def walk(selector: Selector) -> Iterator[Selector]:
    """This selector and every one inside it, outermost first."""
    yield selector
    for part in parts(selector):
        yield from walk(part)


def is_relative(selector: Selector) -> bool:
    """Whether the selector can resolve only when the robot gets there."""
    return any(isinstance(s, RELATIVE) or (isinstance(s, Nearest) and s.fresh) for s in walk(selector))


def is_single(selector: Selector) -> bool:
    """Whether the selector's form promises at most one place ("the northernmost tree", not "trees in the north")."""
    match selector:
        case TreeIs() | Marker() | Here() | First() | Last():
            return True
        case Corners(which=which):
            return len(which) == 1
        case Extreme() | Middle() | EdgeMiddle() | Nearest() | Farthest() | Adjacent() | Top() | Take():
            return selector.count == 1
        case Union(parts=inner):
            return len(inner) == 1 and is_single(inner[0])
        case _:
            return False
