"""Compare an event log with the expected outcome."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping

import numpy as np
import shapely
from shapely.geometry import LineString
from shapely.geometry.base import BaseGeometry

from fieldhand_bench.missions.case_site import CaseSite, Points
from fieldhand_bench.missions.cases import Bounds, Expected, KeptFrom
from fieldhand_bench.missions.log import Done, Log
from fieldhand_bench.missions.matching import describe, mismatch

#: An action is away from trees if the nearest one is farther than both so many spacings and so many metres.
_AT_TREE, _AT_TREE_M = 0.75, 3.0
#: Maximum distance at which a position counts as at a marker, metres.
_AT_MARKER_M = 3.0
#: Allowance for the projections of the log and of the case, metres.
_TOLERANCE_M = 0.05


def judge(site: CaseSite, expected: Expected, log: Log) -> tuple[str, ...]:
    """Return the deviations from the expected outcome, one sentence each; empty if there are none."""
    return (
        *_away_from_trees(site, expected, log),
        *_steps(site, expected, log),
        *_counts(expected, log),
        *_elsewhere(site, expected, log),
        *_works(site, expected, log),
        *_distances(expected, log),
        *_pauses(expected, log),
        *_too_near(site, expected, log),
        *_too_fast(site, expected, log),
        *_end(site, expected, log),
    )


def _away_from_trees(site: CaseSite, expected: Expected, log: Log) -> Iterator[str]:
    if expected.free_points:
        return
    for one in log.done:
        if one.off_m > max(_AT_TREE * site.spacing_m, _AT_TREE_M):
            yield f"{one.action} was done {one.off_m:.1f} m from the nearest tree"


def _steps(site: CaseSite, expected: Expected, log: Log) -> Iterator[str]:
    if expected.steps is not None:
        wrong = mismatch(site, expected.steps, log.done, any_order=expected.any_order)
        if wrong:
            yield wrong
    if len(log.done) < expected.least_stops:
        yield f"{len(log.done)} actions were done, {expected.least_stops} at least wanted"


def _counts(expected: Expected, log: Log) -> Iterator[str]:
    for action, bounds in (expected.counts or {}).items():
        captures = sum(one.captures for one in log.done if one.action == action)
        if not _within(captures, bounds):
            yield f"{action} was done {captures} times, wanted {_bounds_text(bounds)}"
    for action, bounds in expected.trees.items():
        trees = len({one.tree for one in log.done if one.action == action})
        if not _within(trees, bounds):
            yield f"{action} was done at {trees} different trees, wanted {_bounds_text(bounds)}"
    if expected.counts is not None:
        yield from _uncalled_for(expected.counts, expected, log.done)


def _uncalled_for(counts: Mapping[str, Bounds], expected: Expected, done: tuple[Done, ...]) -> Iterator[str]:
    for action in sorted({one.action for one in done} - set(counts)):
        yield f"nobody asked for {action}"
    if not (expected.repeats or expected.free_points) and len({(d.action, d.tree) for d in done}) < len(done):
        yield "a tree was worked on twice"


def _elsewhere(site: CaseSite, expected: Expected, log: Log) -> Iterator[str]:
    for one in log.done:
        if not expected.at_all.holds(site, one.tree, {}):
            yield f"{describe(site, one)} is not at {expected.at_all.words}"


def _works(site: CaseSite, expected: Expected, log: Log) -> Iterator[str]:
    for action in sorted({action for action, _ in log.worked} - {work.action for work in expected.works}):
        yield f"nobody asked for {action}"
    for work in expected.works:
        paths = [path for action, path in log.worked if action == work.action]
        metres = sum(float(np.hypot(*np.diff(path, axis=0).T).sum()) for path in paths)
        if not _within(metres, work.metres):
            yield f"{work.action} was on along {metres:.0f} m, wanted {_bounds_text(work.metres)} m"
        if work.past.demands:
            line = shapely.union_all([LineString(path) for path in paths])
            away = shapely.distance(shapely.points(site.xy), line)
            passed = {int(k) for k in np.flatnonzero(away <= work.reach_m)}
            wanted = {k for k in range(len(site.xy)) if work.past.holds(site, k, {})}
            if passed != wanted:
                yield (
                    f"{work.action} was on beside {len(passed)} trees, {len(passed - wanted)} of them not "
                    f"{work.past.words}, and beside {len(passed & wanted)} of the {len(wanted)} that are"
                )


def _distances(expected: Expected, log: Log) -> Iterator[str]:
    if expected.apart_m is not None:
        for here, there in itertools.pairwise(log.stops):
            away = math.dist(here, there)
            if not _within(away, expected.apart_m):
                yield f"two stops are {away:.1f} m apart, wanted {_bounds_text(expected.apart_m)} m"
    if expected.most_travel_m is not None and log.travelled_m > expected.most_travel_m:
        yield f"{log.travelled_m:.1f} m were driven, {expected.most_travel_m:g} m at most wanted"
    if expected.lasts_s is not None and not _within(log.lasts_s, expected.lasts_s):
        yield f"the mission lasted {log.lasts_s:.0f} s, wanted {_bounds_text(expected.lasts_s)} s"
    if expected.most_speed_m_s is not None and log.fastest_m_s > expected.most_speed_m_s * 1.001:
        yield f"a leg was driven at {log.fastest_m_s:.2f} m/s, {expected.most_speed_m_s:g} m/s at most wanted"
    if expected.stands is not None:
        for tree in sorted({one.tree for one in log.done}):
            if log.stands.get(tree, 0) != expected.stands:
                yield f"tree {tree} was worked on from {log.stands.get(tree, 0)} positions, wanted {expected.stands}"


def _pauses(expected: Expected, log: Log) -> Iterator[str]:
    if expected.charges is not None and not _within(log.charges, expected.charges):
        yield f"the battery was charged {log.charges} times, wanted {_bounds_text(expected.charges)}"
    if expected.waited_s is not None and not _within(log.waited_s, expected.waited_s):
        yield f"it stood still {log.waited_s:.0f} s for events, wanted {_bounds_text(expected.waited_s)} s"


def _too_near(site: CaseSite, expected: Expected, log: Log) -> Iterator[str]:
    for kept in expected.keeps_from:
        shape, name = _ground(site, kept)
        away = min((float(shape.distance(shapely.LineString(path))) for path in log.paths), default=math.inf)
        if away < kept.metres - _TOLERANCE_M:
            yield f"it drove {away:.1f} m from {name}, {kept.metres:g} m at least wanted"


def _too_fast(site: CaseSite, expected: Expected, log: Log) -> Iterator[str]:
    for slow in expected.slow_near:
        shape, name = _ground(site, slow.near)
        ground = shape.buffer(slow.near.metres - _TOLERANCE_M)
        fast = [v for path, v in log.driven if v > slow.most_m_s * 1.001 and _enters(path, ground)]
        if fast:
            yield (
                f"it drove at {max(fast):.2f} m/s within {slow.near.metres:g} m of {name}, "
                f"{slow.most_m_s:g} m/s at most wanted"
            )


def _enters(path: Points, ground: BaseGeometry) -> bool:
    return len(path) > 1 and float(shapely.LineString(path).intersection(ground).length) > _TOLERANCE_M


def _ground(site: CaseSite, kept: KeptFrom) -> tuple[BaseGeometry, str]:
    """Return the outline of a zone or trees, and their name."""
    if kept.zone:
        return site.zones[kept.zone], f"the zone '{kept.zone}'"
    trees = [tree for tree in range(len(site.xy)) if kept.trees.holds(site, tree, {})]
    return shapely.MultiPoint(site.xy[trees]), f"the trees {kept.trees.words}"


def _end(site: CaseSite, expected: Expected, log: Log) -> Iterator[str]:
    if log.end is None:
        yield "the log does not say how the mission ended"
        return
    if log.status != expected.status:
        yield f"the mission ended as {log.status}, wanted {expected.status}"
    if isinstance(expected.end, str):
        away = math.dist(log.end, site.markers[expected.end])
        if away > _AT_MARKER_M:
            yield f"it ended {away:.1f} m from the {expected.end} marker"
    elif expected.end is not None and not expected.end.holds(site, site.nearest(log.end)[0], {}):
        yield f"it did not end at {expected.end.words}"


def _within(value: float, bounds: Bounds) -> bool:
    return bounds[0] <= value <= bounds[1]


def _bounds_text(bounds: Bounds) -> str:
    low, high = bounds
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"
