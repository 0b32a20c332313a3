"""Describe where a robot can drive on a site: aisles, headlands, and the unreachable trees with their reasons."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, MultiPoint

from fieldhand.site.describe.aisles import AisleSummary, Lane, aisle_summary, lane_middle, lanes
from fieldhand.site.describe.rows import shortened
from fieldhand.site.drives import Drives
from fieldhand.site.driving.network import DrivableNetwork
from fieldhand.site.model import Site

#: Up to this number of trees the reachability of each is checked; on a larger site only that of trees near obstacles.
_ASK_ALL = 2_000
#: Number of reasons that are listed, of names listed for each, and of headlands listed by name.
_MOST_REASONS, _FEW, _MOST_HEADLANDS = 8, 8, 4


@dataclass(frozen=True, kw_only=True)
class Unreachable:
    """Trees that are unreachable for the same reason.

    Attributes:
        why: Reason from :meth:`Drives.problem`, such as "inside the keep-out 'pond'".
        trees: Ids of the trees, in file order.
    """

    why: str
    trees: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class DrivingSummary:
    """Drivable parts of a site for a robot.

    Attributes:
        robot: Name of the robot.
        width_m: Width of the robot in metres.
        standoff_m: Distance in metres from a trunk to the working robot.
        aisles: Number of aisles between neighbouring rows.
        closed: Names of aisles that the robot cannot drive along: too narrow, or blocked by an obstacle.
        narrow: Names of other aisles that are narrower than the robot in places.
        too_narrow_for: Number of aisles too narrow for each other robot; robots that fit all aisles are left out.
        narrowest_m, widest_m: Median widths of the narrowest and the widest aisle; None without aisles.
        headlands: Names of the headlands; a block has one at each end of its rows if there is room.
        gates: Names of the gates.
        unreachable: Trees that the robot cannot reach, by reason.
    """

    robot: str
    width_m: float
    standoff_m: float
    aisles: int
    closed: tuple[str, ...]
    narrow: tuple[str, ...]
    too_narrow_for: Mapping[str, int]
    narrowest_m: float | None
    widest_m: float | None
    headlands: tuple[str, ...]
    gates: tuple[str, ...]
    unreachable: tuple[Unreachable, ...]


def describe_driving(
    site: Site, drives: Drives, *, robot: str, others: Mapping[str, float] | None = None
) -> DrivingSummary:
    """Return the drivable parts of a site for a robot.

    Args:
        site: Site with its rows.
        drives: Drives of the site for the robot's width and standoff.
        robot: Name of the robot.
        others: Widths of other robots in metres, by name.
    """
    between = tuple(lanes(site))
    aisles = tuple(aisle_summary(site, lane) for lane in between)
    width = 2 * drives.clearance_m
    network = drives.network()
    driven = _driven(site, between, aisles, network)
    return DrivingSummary(
        robot=robot,
        width_m=width,
        standoff_m=drives.standoff_m,
        aisles=len(aisles),
        closed=tuple(a.name for a, can in zip(aisles, driven, strict=True) if not can),
        narrow=tuple(a.name for a, can in zip(aisles, driven, strict=True) if can and a.narrowest_m < width),
        too_narrow_for={
            name: count
            for name, wide in sorted((others or {}).items())
            if name != robot and (count := sum(a.narrowest_m < wide for a in aisles))
        },
        narrowest_m=min((a.width_m for a in aisles), default=None),
        widest_m=max((a.width_m for a in aisles), default=None),
        headlands=tuple(dict.fromkeys(line.name for line in network.of("headland"))),
        gates=tuple(gate.place.id for gate in site.gates),
        unreachable=_unreachable(site, drives, between, aisles),
    )


def _driven(
    site: Site, between: Sequence[Lane], aisles: Sequence[AisleSummary], network: DrivableNetwork
) -> list[bool]:
    """Return for each aisle True if a line of the network runs along it."""
    lines = shapely.STRtree([LineString(line.points) for line in network.of("aisle")])
    return [
        bool(lines.query(MultiPoint(lane_middle(site, lane)), predicate="dwithin", distance=0.4 * aisle.width_m).size)
        for lane, aisle in zip(between, aisles, strict=True)
    ]


def _unreachable(
    site: Site, drives: Drives, between: Sequence[Lane], aisles: Sequence[AisleSummary]
) -> tuple[Unreachable, ...]:
    """Return the unreachable trees by reason, the most frequent reason first."""
    why: dict[int, str] = {}
    asked = _doubtful(site, drives, between, aisles)
    for k in np.flatnonzero(asked).tolist():
        reason = drives.problem(site.trees[k].place)
        if reason:
            why[k] = reason
    why |= _cut_off(site, drives, asked)
    groups: dict[str, list[int]] = {}
    for k in sorted(why):
        groups.setdefault(why[k], []).append(k)
    ordered = sorted(groups.items(), key=lambda item: (-len(item[1]), item[0]))
    return tuple(Unreachable(why=reason, trees=tuple(site.trees[k].place.id for k in ks)) for reason, ks in ordered)


def _doubtful(site: Site, drives: Drives, between: Sequence[Lane], aisles: Sequence[AisleSummary]) -> NDArray[np.bool_]:
    """Return a mask of the trees near obstacles: on a large site only these are checked individually."""
    if len(site.trees) <= _ASK_ALL:
        return np.ones(len(site.trees), dtype=bool)
    doubtful = (site.planting.row_of < 0) | ~_inside(site)
    reach = drives.standoff_m + 3 * drives.clearance_m
    edges = [z.polygon if z.kind == "keep_out" else z.polygon.boundary for z in site.zones if z.kind != "zone"]
    if edges:
        trees = shapely.STRtree([shapely.Point(xy) for xy in site.xy.tolist()])
        doubtful[trees.query(edges, predicate="dwithin", distance=reach)[1]] = True
    for lane, aisle in zip(between, aisles, strict=True):
        if aisle.narrowest_m < 4 * drives.clearance_m:
            doubtful[lane.one.trees] = doubtful[lane.two.trees] = True
    for block in site.planting.blocks:
        for outer in {block.rows[0], block.rows[-1]} if len(site.planting.blocks) > 1 else ():
            doubtful[outer.trees] = True  # another block may be close
    return doubtful


def _inside(site: Site) -> NDArray[np.bool_]:
    """Return a mask of the trees inside the boundary; all of them without a boundary."""
    boundaries = [z.polygon for z in site.zones_of("boundary")]
    if not boundaries:
        return np.ones(len(site.trees), dtype=bool)
    ground = shapely.union_all(boundaries)
    shapely.prepare(ground)
    return np.asarray(shapely.intersects_xy(ground, site.xy[:, 0], site.xy[:, 1]))


def _cut_off(site: Site, drives: Drives, asked: NDArray[np.bool_]) -> dict[int, str]:
    """Return the reasons of unchecked trees that no path leads to; the middle one of a row is checked for all."""
    found: dict[int, str] = {}
    for row in site.planting.rows:
        rest = row.trees[~asked[row.trees]].tolist()
        reason = drives.problem(site.trees[rest[len(rest) // 2]].place) if rest else ""
        if reason:
            found |= dict.fromkeys(rest, reason)
    return found


def driving_lines(driving: DrivingSummary) -> list[str]:
    """Return the summary in words, a line for each fact."""
    d = driving
    lines = [f"Driving with the {d.robot} ({d.width_m:g} m wide, works {d.standoff_m:g} m from a trunk):"]
    if d.narrowest_m is None or d.widest_m is None:
        lines.append("  No aisles: all ground outside keep-outs is open.")
    else:
        one = f"{d.narrowest_m:.1f}" if round(d.narrowest_m, 1) == round(d.widest_m, 1) else ""
        wide = one or f"{d.narrowest_m:.1f} to {d.widest_m:.1f}"
        lines.append(f"  {_count(d.aisles, 'aisle')}, {wide} m from tree line to tree line{_narrow_words(d)}.")
    lines += [f"  {_count(count, 'aisle')} too narrow for the {name}." for name, count in d.too_narrow_for.items()]
    if d.headlands:
        named = f": {_few(d.headlands)}" if len(d.headlands) <= _MOST_HEADLANDS else ""
        lines.append(f"  {_count(len(d.headlands), 'headland')}{named}.")
    for u in d.unreachable[:_MOST_REASONS]:
        why = u.why.removeprefix("out of reach: ")
        lines.append(f"  {_count(len(u.trees), 'tree')} cannot be reached: {_few(u.trees)} ({why}).")
    left = d.unreachable[_MOST_REASONS:]
    if left:
        lines.append(
            f"  {_count(sum(len(u.trees) for u in left), 'tree')} cannot be reached for {len(left)} other reasons."
        )
    return lines if d.unreachable else [*lines, "  Every tree can be reached."]


def _narrow_words(d: DrivingSummary) -> str:
    words = [
        f"{len(names)} {predicate}: {_few([name.removeprefix('aisle ') for name in names])}"
        for names, predicate in ((d.closed, "cannot be driven along"), (d.narrow, "narrower than the robot in places"))
        if names
    ]
    return "; " + "; ".join(words) if words else ""


def _few(names: Sequence[str]) -> str:
    text = ", ".join(shortened(name) for name in names[:_FEW])
    return text + (f" and {len(names) - _FEW:,} more" if len(names) > _FEW else "")


def _count(count: int, noun: str) -> str:
    return f"{count:,} {noun}{'s' * (count != 1)}"
