"""Selectors: how a Task names places without coordinates.

A selector is an expression. The innermost part is a source (every tree, a marker, the place in hand); each part around
it keeps, orders or picks from what its ``of`` selects. "Yellow trees in the northern half" is
``Where(attribute="leaf_color", test="eq", value="yellow", of=Half(side="north", of=Trees()))``.

What each one means is computed by :mod:`fieldhand.places.resolution`, in local metres; the definitions stand there.
This file is long because it is the vocabulary, to be read as a whole, and its parts nest in each other.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Literal

from fieldhand.terms import AnySide, CornerName, CountedFrom, MarkerName, Side, Test, Towards, Value

Order = Literal[
    "west_to_east",
    "east_to_west",
    "north_to_south",
    "south_to_north",
    "nearest_first",
    "farthest_first",
    "rows",
    "attribute",
]


@dataclass(frozen=True, kw_only=True)
class Trees:
    """Every tree of the site, in the order of the file."""


@dataclass(frozen=True, kw_only=True)
class TreeIs:
    """The tree with this id: the file's own, else its position in the file from 1."""

    tree: str


@dataclass(frozen=True, kw_only=True)
class Marker:
    """A marker of the site: where the robot starts, ends or charges."""

    name: MarkerName


@dataclass(frozen=True, kw_only=True)
class GateIs:
    """The gate with this name."""

    gate: str


@dataclass(frozen=True, kw_only=True)
class Here:
    """The place in hand."""


@dataclass(frozen=True, kw_only=True)
class Bound:
    """The place or places that a node of this Task bound to ``label``."""

    label: str


@dataclass(frozen=True, kw_only=True)
class First:
    """The tree nearest to the start marker; the first of the file without one."""

    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Last:
    """The tree nearest to the end marker; the last of the file without one."""

    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Corners:
    """The tree nearest to each named corner of the smallest-area enclosing rectangle of ``of``; all four by default."""

    which: tuple[CornerName, ...] = ("nw", "ne", "se", "sw")
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Extreme:
    """The ``count`` trees farthest to one side."""

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
    """Trees of ``of`` on one side of the middle line of its ground.

    The ground is the site, or the zone, block, half or picked trees inside; attributes, rows and visits inside do not
    change it.
    """

    side: Side
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Quarter:
    """Trees of ``of`` in one quarter of its ground, which is as for a half."""

    quarter: CornerName
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Edge:
    """Trees of ``of`` on the outermost line of one side of its ground: no tree stands right beyond them."""

    side: Side
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Nearest:
    """The ``count`` trees of ``of`` nearest to ``to`` that are not ``to``, nearest first.

    ``adjacent`` asks for neighbours ("next to"): the same row is preferred. ``fresh`` passes over trees that were
    visited already ("nearby"). ``side`` keeps those that lie in that direction from ``to`` ("its neighbour
    on the east"). :class:`InZone` as ``to``, ``origin`` or ``near`` is the zone itself ("nearest to
    the pond").
    """

    to: Selector
    count: int = 1
    adjacent: bool = False
    fresh: bool = False
    side: AnySide = "any"
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
    """Trees that this mission has not visited."""

    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Excluding:
    """Trees of ``of`` that are not among ``places``."""

    places: Selector
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Where:
    """Trees whose attribute passes a test; letter case is ignored."""

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
    """Trees inside a named zone of the site or at most ``margin_m`` metres from it, or all others (``outside``)."""

    zone: str
    outside: bool = False
    margin_m: float = 0.0
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
class Random:
    """``count`` of ``of``, drawn at random.

    Attributes:
        seed: The same seed draws the same trees whenever it is drawn.
    """

    count: int
    seed: int = 0
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Spread:
    """``count`` of ``of``, spread over where they stand: far from each other."""

    count: int
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class InBlock:
    """Trees of one block, by the block's name or number."""

    block: str
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Rows:
    """Trees of row ``first`` (left out: the first) to row ``last`` (the last), or of each ``every``-th of these, from
    ``first`` on.

    A row is called by its name, or by its number in the block; -1 is the last row. Numbers count from west, or from
    north where rows run east-west, or from the side ``counted_from``. Of several blocks, ``of`` says which
    (:class:`InBlock`).
    """

    first: str = ""
    last: str = ""
    every: int = 1
    counted_from: CountedFrom = "usual"
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class RowOf:
    """Trees in the same row as ``origin``, or ``over`` rows from it (1 the next higher number, -1 the next lower)."""

    origin: Selector = Here()
    over: int = 0
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class InRow:
    """Trees ``first`` to ``last`` along each row of ``of``; negative numbers count from the row's other end.

    They count from north, or from west where rows run east-west, or from the side ``counted_from``: what stands, or by
    the file's own numbers.
    """

    first: int
    last: int
    counted_from: CountedFrom = "usual"
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class EveryNth:
    """Every ``nth`` tree along each row of ``of``, from tree ``start`` on (1, 4, 7 for 3); they count as for
    :class:`InRow`, on from row to row where no row has ``nth``."""

    nth: int
    start: int = 1
    counted_from: CountedFrom = "usual"
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class AlongRow:
    """The tree that many ``trees`` along the row from ``origin``: down is away from the start marker, up towards it.

    Where the row ends before, its last tree.
    """

    trees: int
    towards: Towards = "down"
    origin: Selector = Here()


@dataclass(frozen=True, kw_only=True)
class Across:
    """The tree abreast of ``origin`` in the next row: the nearer one, or the one on ``side``."""

    origin: Selector = Here()
    side: CountedFrom = "usual"


@dataclass(frozen=True, kw_only=True)
class Successive:
    """``count`` trees of one row, one after the other: of the rows that have as many the nearest to ``near``, where it
    is nearest, from the end that is nearer to it."""

    count: int
    near: Selector = Here()
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Ordered:
    """``of`` in an order that is to be kept: by the compass, by distance from the place in hand, row by row
    (``rows``), or by an ``attribute``, from its lowest value or ``descending``."""

    by: Order
    attribute: str = ""
    descending: bool = False
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Nth:
    """The ``nth`` place of ``of`` in its order; -1 is the last."""

    nth: int
    of: Selector


@dataclass(frozen=True, kw_only=True)
class Spaced:
    """``count`` free points ``apart_m`` metres apart, else as many as fit, on a line beside the row of ``of`` nearest
    to ``near``, from its end nearer to that; without rows, or inside a ``zone``, on a straight line. Points are no
    trees."""

    apart_m: float
    count: int = 0
    near: Selector = Here()
    zone: str = ""
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class Apart:
    """``count`` trees of ``of``, each about ``apart_m`` metres from the one before it; with ``least``, at least so far
    from all."""

    apart_m: float
    count: int
    least: bool = False
    of: Selector = Trees()


@dataclass(frozen=True, kw_only=True)
class PointsIn:
    """``count`` free points spread evenly over a zone; one point is its middle."""

    zone: str
    count: int = 1


@dataclass(frozen=True, kw_only=True)
class Union:
    """All places of the parts, in their order, each once."""

    parts: tuple[Selector, ...]


Selector = (
    Trees
    | TreeIs
    | Marker
    | GateIs
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
    | Random
    | Spread
    | InBlock
    | Rows
    | RowOf
    | InRow
    | EveryNth
    | AlongRow
    | Across
    | Successive
    | Ordered
    | Nth
    | Spaced
    | Apart
    | PointsIn
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


def zone_itself(selector: Selector) -> str:
    """Return the name of the zone that a selector is all trees of; where distances are measured from, it is the zone.

    Empty for any other selector.
    """
    return selector.zone if isinstance(selector, InZone) and selector == InZone(zone=selector.zone) else ""


def is_relative(selector: Selector) -> bool:
    """Whether the selector can resolve only when the robot gets there."""
    return any(
        isinstance(s, RELATIVE)
        or (isinstance(s, Nearest) and s.fresh)
        or (isinstance(s, Ordered) and s.by in ("nearest_first", "farthest_first"))
        for s in walk(selector)
    )


def is_single(selector: Selector) -> bool:
    """Whether the selector's form promises at most one place ("the northernmost tree", not "trees in the north")."""
    match selector:
        case TreeIs() | Marker() | GateIs() | Here() | First() | Last() | AlongRow() | Across() | Nth():
            return True
        case Corners(which=which):
            return len(which) == 1
        case (
            Extreme()
            | Middle()
            | EdgeMiddle()
            | Nearest()
            | Farthest()
            | Adjacent()
            | Top()
            | Take()
            | Random()
            | Spread()
        ):
            return selector.count == 1
        case Spread() | Successive() | Spaced() | Apart() | PointsIn():
            return selector.count == 1
        case Union(parts=inner):
            return len(inner) == 1 and is_single(inner[0])
        case _:
            return False
