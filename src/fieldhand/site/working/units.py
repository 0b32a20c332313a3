"""Units of work along rows and aisles: each row side or pass, with the ways in which it can be driven."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.site.counting import require_rows, row_words
from fieldhand.site.describe.aisles import Lane as AisleLane
from fieldhand.site.describe.aisles import lane_middle, lane_name, lanes
from fieldhand.site.model import Site
from fieldhand.site.planting import Block, Row
from fieldhand.site.working.lanes import LanePath, lanes_past
from fieldhand.site.working.stretch import Interval, Stretch, joined
from fieldhand.terms import Side

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

XY = tuple[float, float]
Points = NDArray[np.float64]

#: Sides of a row to be worked: any one of them, both, or that towards a side of the compass.
WorkSides = Literal["one", "both", "north", "east", "south", "west"]
#: Side of the robot on which an implement works.
MountedSide = Literal["left", "right", "both", "under"]

#: Trees of a row that are farther apart than this many tree spacings have a gap between them.
GAP_SPACINGS = 1.6
#: Metres by which passes may leave ground between them unworked.
_TOLERATED_M = 0.1
#: A side of a row faces a side of the compass within 60 degrees.
_FACES_COS = 0.5 - 1e-9
_OUTWARD: dict[Side, tuple[float, float]] = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}


@dataclass(frozen=True, kw_only=True)
class WorkUnit:
    """Work that belongs together: one side of a row, a pass through an aisle, a lane of an area.

    Attributes:
        options: Ways of doing it, of which one is enough; each consists of stretches in order, at least one.
    """

    options: tuple[tuple[Stretch, ...], ...]


@dataclass(frozen=True, kw_only=True)
class RowWork:
    """Options of work along rows.

    Attributes:
        sides: Sides of each row.
        mounted: Side of the robot on which the implement works.
        gaps_on: True to keep the implement on in gaps of a row.
    """

    sides: WorkSides = "one"
    mounted: MountedSide = "both"
    gaps_on: bool = False


def row_units(drives: Drives, trees: Sequence[int], work: RowWork) -> tuple[WorkUnit, ...]:
    """Return the work along the rows of some trees, each row from its first to its last of these trees.

    Args:
        drives: Drives of the robot.
        trees: Indices of trees of the site, each once. Rows come in the order of their first trees.
        work: How the rows are worked.

    Raises:
        PlaceError: No row can be worked along: the trees stand in no row, no aisle is wide enough, or a row has no such
            side.
    """
    site = drives.site
    planting = require_rows(site)
    found: list[WorkUnit] = []
    rows = [r for r in dict.fromkeys(planting.row_of[list(trees)].tolist()) if r >= 0]
    if not rows:
        raise PlaceError(
            message("none of these trees is in a row"), where=site.name, advice=message("ask for other trees")
        )
    wanted = set(trees)
    why = ""
    for number in rows:
        row = planting.rows[number]
        own = [k for k in row.trees.tolist() if k in wanted]
        block = planting.blocks[row.block]
        options, reason = _sides_of(drives, row, block, own, work)
        why = why or reason
        found += [WorkUnit(options=tuple(sides)) for sides in options if sides]
    if not found:
        raise PlaceError(
            message("no row can be worked along: {why}", why=why or message("each has a single tree here")),
            where=site.name,
            advice=message("choose other rows, or a narrower robot"),
        )
    return tuple(found)


def _sides_of(
    drives: Drives, row: Row, block: Block, trees: list[int], work: RowWork
) -> tuple[list[list[tuple[Stretch, ...]]], str]:
    """Return the options for each unit of a row, and why a side cannot be driven along."""
    site = drives.site
    candidates = drives.sides([site.trees[k].place for k in trees])
    sides = _side_names(block, len(candidates[0]))
    if work.sides not in ("one", "both"):
        if work.sides not in sides:
            raise PlaceError(
                message(
                    "{row} has no {side} side; its sides are {sides}",
                    row=row_words(site, row),
                    side=COMPASS[work.sides],
                    sides=message("{one} and {two}", one=COMPASS[sides[0]], two=COMPASS[sides[-1]]),
                ),
                where=site.name,
                advice=message("name one of its sides"),
            )
        chosen = [sides.index(work.sides)]
    else:
        chosen = list(range(len(sides)))
    options: list[tuple[Stretch, ...]] = []
    why = ""
    for k in chosen:
        usable = [n for n, c in enumerate(candidates) if not c[k].why_not]
        why = why or next((c[k].why_not for c in candidates if c[k].why_not), "")
        name = message("{row}, {side} side", context="log", row=row_words(site, row), side=COMPASS[sides[k]])
        stretches = _along_row(
            drives, name, [trees[n] for n in usable], [candidates[n][k].xy for n in usable], block, work
        )
        if stretches:
            options.append(stretches)
    if work.sides == "both":
        return [[option] for option in options], why
    return [options], why


def _side_names(block: Block, count: int) -> tuple[Side, ...]:
    """Return the compass sides that the stands of a tree lie on, in their order: lesser v first."""
    turn = math.radians(block.bearing_deg)
    across = (math.cos(turn), -math.sin(turn))
    upper = max(_OUTWARD, key=lambda side: across[0] * _OUTWARD[side][0] + across[1] * _OUTWARD[side][1])
    lower: Side = {"north": "south", "south": "north", "east": "west", "west": "east"}[upper]  # type: ignore[assignment]
    return (lower, upper) if count == 2 else (lower,)


def _along_row(
    drives: Drives, name: str, trees: Sequence[int], stands: Sequence[XY], block: Block, work: RowWork
) -> tuple[Stretch, ...]:
    """Return the stretches past stands on one side of a row."""
    site = drives.site
    found: list[Stretch] = []
    lanes = lanes_past(drives, stands)
    for number, lane in enumerate(lanes, start=1):
        on = _on_past(lane, [trees[k] for k in lane.passed], site, block, gaps_on=work.gaps_on)
        part = name if len(lanes) == 1 else message("{row}, part {number}", context="log", row=name, number=number)
        stretch = Stretch(name=part, points=lane.points, on=on)
        if stretch.length_m <= 0.0 or not on:
            continue
        found.append(_mounted(stretch, site.xy[[trees[k] for k in lane.passed]], work.mounted))
    if found and all(s.one_way for s in found) and _against(found[0], stands):
        found.reverse()
    return tuple(found)


def _on_past(lane: LanePath, trees: Sequence[int], site: Site, block: Block, *, gaps_on: bool) -> tuple[Interval, ...]:
    """Return where the implement is on: from the first to the last tree, and off in gaps."""
    begin, end = lane.at_m[0], lane.at_m[-1]
    if gaps_on or len(trees) < 2:
        return ((begin, end),) if end > begin else ()
    spacing = block.tree_spacing_m
    half = spacing / 2.0 if math.isfinite(spacing) else 0.0
    apart = np.hypot(*np.diff(site.xy[list(trees)], axis=0).T)
    parts: list[Interval] = []
    since = begin
    for k, metres in enumerate(apart.tolist()):
        if math.isfinite(spacing) and metres > GAP_SPACINGS * spacing:
            parts.append((since, min(end, lane.at_m[k] + half)))
            since = max(begin, lane.at_m[k + 1] - half)
    parts.append((since, end))
    return joined((a, b) for a, b in parts if b > a)


def _mounted(stretch: Stretch, trees: Points, mounted: MountedSide) -> Stretch:
    """Return the stretch in the direction in which the implement faces the row, if it works on one side only."""
    if mounted not in ("left", "right"):
        return stretch
    (ax, ay), (bx, by) = stretch.begin, stretch.end
    x, y = trees.mean(axis=0) - np.array([(ax + bx) / 2.0, (ay + by) / 2.0])
    is_left = (bx - ax) * y - (by - ay) * x > 0.0
    directed = stretch if is_left == (mounted == "left") else stretch.reversed()
    return Stretch(name=directed.name, points=directed.points, on=directed.on, one_way=True)


def _against(stretch: Stretch, stands: Sequence[XY]) -> bool:
    """Return True if a stretch leads from the last stand towards the first."""
    return math.dist(stretch.begin, stands[0]) > math.dist(stretch.end, stands[0])


# --- aisles -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class AisleWork:
    """Options of work through aisles.

    Attributes:
        width_m: Working width of one pass; None if one pass is enough.
        every: 2 for every second aisle.
    """

    width_m: float | None = None
    every: int = 1


def aisle_units(drives: Drives, trees: Sequence[int], work: AisleWork) -> tuple[WorkUnit, ...]:
    """Return the work through the aisles between neighbouring rows of some trees, each in as many passes as needed.

    Args:
        drives: Drives of the robot.
        trees: Indices of trees of the site.
        work: How the aisles are worked.

    Raises:
        PlaceError: No aisle lies between the rows of these trees, or none can be driven through.
    """
    site = drives.site
    planting = require_rows(site)
    rows = {id(planting.rows[r]) for r in planting.row_of[list(trees)].tolist() if r >= 0}
    between = [lane for lane in lanes(site) if id(lane.one) in rows and id(lane.two) in rows]
    if not between:
        raise PlaceError(
            message("no aisle lies between these rows"),
            where=site.name,
            advice=message("name two neighbouring rows or more: an aisle lies between two rows"),
        )
    found: list[WorkUnit] = []
    for block in planting.blocks:
        inside = [lane for lane in between if lane.block is block]
        for lane in inside[:: work.every]:
            found += _passes(drives, lane, work)
    if not found:
        raise PlaceError(
            message("none of these aisles can be driven through"),
            where=site.name,
            advice=message("choose other aisles, or a narrower robot"),
        )
    return tuple(found)


def _passes(drives: Drives, lane: AisleLane, work: AisleWork) -> Iterator[WorkUnit]:
    """Yield the passes through an aisle side by side."""
    site = drives.site
    name, middle = lane_name(site, lane), lane_middle(site, lane)
    other = LineString(site.xy[lane.two.trees]) if len(lane.two.trees) > 1 else None
    wide = 2.0 * float(shapely.distance(other, shapely.points(middle)).min()) if other is not None else 0.0
    offsets = pass_offsets(wide - 2.0 * drives.clearance_m, work.width_m)
    for number, offset in enumerate(offsets, start=1):
        stops = _beside(middle, offset, lane.block)
        parts = lanes_past(drives, stops)
        stretches = []
        for part, path in enumerate(parts, start=1):
            called = name
            if len(offsets) > 1:
                called = message("{aisle}, pass {number}", context="log", aisle=called, number=number)
            if len(parts) > 1:
                called = message("{row}, part {number}", context="log", row=called, number=part)
            stretch = Stretch(name=called, points=path.points, on=((path.at_m[0], path.at_m[-1]),))
            if stretch.length_m > 0.0:
                stretches.append(stretch)
        if stretches:
            yield WorkUnit(options=(tuple(stretches),))


def pass_offsets(room_m: float, width_m: float | None) -> tuple[float, ...]:
    """Return the offsets from the middle at which passes side by side work a strip.

    Args:
        room_m: Width in metres within which the robot's middle may drive; negative counts as 0.
        width_m: Working width; None for a single pass.
    """
    room = max(0.0, room_m)
    if width_m is None or room <= _TOLERATED_M:
        return (0.0,)
    count = max(1, math.ceil((room + width_m - _TOLERATED_M) / width_m))
    if count == 1:
        return (0.0,)
    step = room / (count - 1)
    return tuple(-room / 2.0 + k * step for k in range(count))


def _beside(middle: Points, offset: float, block: Block) -> list[XY]:
    """Return points in order along an aisle, moved across it."""
    turn = math.radians(block.bearing_deg)
    along, across = np.array([math.sin(turn), math.cos(turn)]), np.array([math.cos(turn), -math.sin(turn)])
    ordered = middle[np.argsort(middle @ along, kind="stable")] + offset * across
    return [(float(x), float(y)) for x, y in ordered.tolist()]
