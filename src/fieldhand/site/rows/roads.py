"""Detect roads, which separate blocks, and ponds, which rows continue past, from gaps in rows.

A gap in a row is followed to the rows beside it and onwards, as long as none has a tree there; the area covered is a
strip. A strip that some row runs through is a hole in the planting. A strip open at both sides is a road if it is too
unlikely to consist of missing trees: the fraction of missing trees, to the power of the number missing there, times the
number of possible places. Rows that end at one side of it and rows that begin at the other, out of line with each
other, are further evidence of a road.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fieldhand.site.rows.grouping import TracedRow, group_rows
from fieldhand.site.rows.labels import groups

Floats = NDArray[np.float64]

#: Half width of a strip along the rows, and distance between the places in a gap at which it is searched for, in tree
#: spacings.
_FREE, _EACH = 0.72, 0.5
#: Greatest shift of a strip along the rows from one row to the next, in row spacings.
_SKEW = 0.5
#: Greatest distance from the end of a row to a strip beside it, in row spacings.
_AT_THE_END = 3.0
#: Greatest distance of neighbouring rows, in row spacings; the larger value applies if there is no nearer row.
_BESIDE, _ONE_MISSING = 1.6, 2.3
#: Probability below which a strip is a road and not missing trees; and probability that two rows of one block are out
#: of line.
_BY_CHANCE, _OUT_OF_LINE = 0.003, 0.1
#: Least distance between rows of one block, in row spacings.
_LEAST_APART = 0.65
#: Probability that a row of a block ends at a place where another begins.
_BOTH_SIDES = 0.4
#: Evidence for a road from a row longer than those beside it: its extra length divided by this many times the
#: unevenness of the row ends; and the greatest such evidence.
_PAST, _MOST_PAST = 2.0, 4.0
#: Greatest offset across the rows, in tree spacings, of rows that are in line.
_IN_LINE = 0.42


@dataclass(eq=False, kw_only=True)
class Strip:
    """A strip across rows without trees.

    Attributes:
        at: Coordinate along the rows.
        gaps: For each row with a gap here, the index of the tree before it.
        before: Rows that end here.
        after: Rows that begin here.
        closed: True if a row runs through it.
    """

    at: float
    gaps: dict[int, int] = field(default_factory=dict)
    before: list[int] = field(default_factory=list)
    after: list[int] = field(default_factory=list)
    closed: bool = False


def find_roads(lines: Sequence[TracedRow], spacing: float, wide: float) -> list[Strip]:
    """Return the roads through rows, given the tree spacing ``spacing`` and the row spacing ``wide`` in metres."""
    gaps = [np.flatnonzero(np.diff(line.along) > 2 * _FREE * spacing) for line in lines]
    planted = sum(len(line.trees) for line in lines)
    missing = sum(
        float(np.sum(np.rint(np.diff(line.along)[k] / spacing) - 1)) for line, k in zip(lines, gaps, strict=True)
    )
    beside = _Neighbours(lines, wide)
    found: list[Strip] = []
    cut: set[tuple[int, int]] = set()
    for row in range(len(lines)):
        places = -1
        for k, at in _open_gaps(lines, row, gaps[row], beside, spacing):
            if (row, k) in cut:
                continue
            strip = _strip(lines, row, at, beside, spacing, wide)
            if strip.closed:
                continue
            places = places if places >= 0 else int(beside.alone(row, lines[row].along, _FREE * spacing).sum())
            if _is_road(lines, strip, spacing, wide, planted, missing, places):
                found.append(strip)
                cut.update(strip.gaps.items())
    return found


class _Neighbours:
    """Index of the rows beside each row."""

    def __init__(self, lines: Sequence[TracedRow], wide: float) -> None:
        self._lines, self._wide = lines, wide
        middle = np.array([float(line.across.mean()) for line in lines])
        self._order = np.argsort(middle, kind="stable")
        self._middle = middle[self._order]
        self._bent = max((float(np.ptp(line.across)) for line in lines), default=0.0)
        self._place = np.argsort(self._order)

    def near(self, row: int, reach: float) -> list[int]:
        """Return the rows within a distance of a row, in row spacings."""
        own = self._middle[self._place[row]]
        far = reach * self._wide + self._bent
        low, high = np.searchsorted(self._middle, [own - far, own + far])
        return [int(k) for k in self._order[low:high] if k != row]

    def alone(self, row: int, at: Floats, reach: float) -> NDArray[np.bool_]:
        """Return a mask of the coordinates ``at`` at which no neighbouring row has a tree within reach."""
        free = np.ones(len(at), dtype=bool)
        for other in self.near(row, _BESIDE):
            low, high = np.searchsorted(self._lines[other].along, [at - reach, at + reach])
            free &= low == high
            if not free.any():
                break
        return free

    def at(self, row: int, along: float) -> Iterator[int]:
        """Yield the neighbouring rows on either side at a coordinate along the row, extended if they end before it."""
        across = self._lines[row].across_at(along)
        apart = [
            (float(self._lines[k].across_at(along) - across) / self._wide, k) for k in self.near(row, _ONE_MISSING)
        ]
        for side in (-1.0, 1.0):
            own = [(d * side, k) for d, k in apart if d * side > 0.0]
            least = min((d for d, k in own if len(self._lines[k].trees) > 2), default=0.0)
            reach = _BESIDE if least < _BESIDE else _ONE_MISSING
            yield from (k for d, k in own if d < reach)


def _open_gaps(
    lines: Sequence[TracedRow], row: int, gaps: NDArray[np.intp], beside: _Neighbours, spacing: float
) -> list[tuple[int, float]]:
    """Return the gaps of a row with the coordinates in them at which no neighbouring row has a tree."""
    if not len(gaps):
        return []
    begin, end = lines[row].along[gaps] + _FREE * spacing, lines[row].along[gaps + 1] - _FREE * spacing
    count = np.floor((end - begin) / (_EACH * spacing)).astype(np.intp) + 1
    gap = np.repeat(np.arange(len(gaps)), count)
    step = np.arange(len(gap)) - np.repeat(np.cumsum(count) - count, count)
    at = begin[gap] + (step + 0.5) / count[gap] * (end - begin)[gap]
    free = beside.alone(row, at, _FREE * spacing)
    return [(int(gaps[k]), float(x)) for k, x in zip(gap[free], at[free], strict=True)]


def _strip(lines: Sequence[TracedRow], row: int, at: float, beside: _Neighbours, spacing: float, wide: float) -> Strip:
    """Follow a gap from row to row and return the strip without trees, until a row closes it."""
    strip = Strip(at=at, gaps={row: int(np.searchsorted(lines[row].along, at)) - 1})
    visited, ahead = {row}, [(row, at)]
    while ahead and not strip.closed:
        here, at = ahead.pop(0)
        for other in beside.at(here, at):
            if other in visited:
                continue
            visited.add(other)
            along = lines[other].along
            aside = _skewed(at, float(along[0]), float(along[-1]), _FREE * spacing, _SKEW * wide)
            k = int(np.searchsorted(along, aside))
            before = aside - float(along[k - 1]) if k else np.inf
            after = float(along[k]) - aside if k < len(along) else np.inf
            if min(before, after) < (1.0 - 1e-9) * _FREE * spacing:
                strip.closed = True
            elif min(before, after) > max(_AT_THE_END * wide, _FREE * spacing):
                continue
            elif k == 0:
                strip.after.append(other)
            elif k == len(along):
                strip.before.append(other)
            else:
                strip.gaps[other] = k - 1
            ahead.append((other, aside))
    return strip


def _skewed(at: float, first: float, last: float, free: float, reach: float) -> float:
    """Return the coordinate of a strip at the next row, shifted past the end of the row if it runs at an angle."""
    if abs(at - (last + free)) <= reach and at < last + free:
        return last + free
    if abs(at - (first - free)) <= reach and at > first - free:
        return first - free
    return at


def _is_road(
    lines: Sequence[TracedRow], strip: Strip, spacing: float, wide: float, planted: int, missing: float, places: int
) -> bool:
    widths = np.array([lines[row].along[k + 1] - lines[row].along[k] for row, k in strip.gaps.items()]) / spacing
    if not _rows_at_both_sides(lines, strip):
        return False
    elsewhere = max(missing - float(np.rint(widths - 1).sum()), 0.0)
    part = float(np.clip((elsewhere + 1.0) / (planted + elsewhere + 10.0), 0.05, 0.3))
    lost = _missing_trees(widths)
    if len(widths) > 1:
        places = int(max(float(np.ptp(lines[row].along)) for row in strip.gaps) / spacing)
    chance = lost * np.log(part) + np.log(places + 1.0)
    # In one block, rows that end here and rows that begin across from them would be pairs in one line.
    middle = {k: lines[k].across_at(strip.at) for k in (*strip.gaps, *strip.before, *strip.after)}
    pairs = [
        (abs(middle[a] - middle[b]), a, b)
        for one, other in ((strip.before, (*strip.after, *strip.gaps)), (strip.after, tuple(strip.gaps)))
        for a in one
        for b in other
        if len(lines[a].trees) > 2 and len(lines[b].trees) > 2 and abs(middle[a] - middle[b]) < _LEAST_APART * wide
    ]
    paired: set[int] = set()
    for apart, a, b in sorted(pairs):
        if a in paired or (b in paired and b not in strip.gaps):
            continue
        paired |= {a, b}
        if apart < _IN_LINE * spacing and b not in strip.gaps:
            width = (float(lines[b].along[0]) - float(lines[a].along[-1])) / spacing
            chance += min(_missing_trees(np.array([width])) * np.log(part), 0.0)
        else:
            chance += np.log(_OUT_OF_LINE)
    chance += _overhang(lines, strip, spacing)
    chance += min(len(strip.before), len(strip.after)) * np.log(_BOTH_SIDES)
    return bool(chance < np.log(_BY_CHANCE))


def _overhang(lines: Sequence[TracedRow], strip: Strip, spacing: float) -> float:
    """Return the logarithm of the probability that one row runs on past the strip while all rows beside it end before
    it.

    The unevenness of the row ends is estimated from the rows beside it.
    """
    (row, k), *more = strip.gaps.items()
    if more or bool(strip.before) == bool(strip.after):
        return 0.0
    if strip.before:
        ends = np.array([lines[other].along[-1] for other in strip.before if len(lines[other].trees) > 2])
        over = len(lines[row].trees) - k - 1
    else:
        ends = np.array([lines[other].along[0] for other in strip.after if len(lines[other].trees) > 2])
        over = k + 1
    if len(ends) < 2:
        return 0.0
    uneven = float(ends.std()) / spacing + 1.0
    return -min(over / (_PAST * uneven), _MOST_PAST)


def _rows_at_both_sides(lines: Sequence[TracedRow], strip: Strip) -> bool:
    """Return True if each side has a row of at least three trees."""
    before = [k + 1 for k in strip.gaps.values()] + [len(lines[row].trees) for row in strip.before]
    after = [len(lines[row].trees) - k - 1 for row, k in strip.gaps.items()]
    after += [len(lines[row].trees) for row in strip.after]
    return max(before) >= 3 and max(after) >= 3


def _missing_trees(widths: Floats) -> float:
    """Return the least number of trees missing in gaps, given their widths in tree spacings."""
    return float(np.maximum(np.maximum(np.rint(widths - 0.1) - 1.0, widths - 1.3), 0.0).sum())


def split_by_roads(lines: list[TracedRow], spacing: float, wide: float) -> list[list[TracedRow]]:
    """Split the rows of a block at roads and return the list of rows of each part."""
    strips = find_roads(lines, spacing, wide)
    if not strips:
        return [lines]
    cuts: dict[int, list[int]] = {}
    for strip in strips:
        for row, k in strip.gaps.items():
            cuts.setdefault(row, []).append(k + 1)
    pieces: list[TracedRow] = []
    of_row: list[int] = []
    for row, line in enumerate(lines):
        for own in np.split(np.arange(len(line.trees)), sorted(set(cuts.get(row, ())))):
            pieces.append(TracedRow(line.trees[own], line.along[own], line.across[own]))
            of_row.append(row)
    middle = np.array([float(piece.along.mean()) for piece in pieces])
    sides = []
    for strip in strips:
        beside = np.isin(of_row, [*strip.gaps, *strip.before, *strip.after])
        sides.append(np.where(beside, np.where(middle < strip.at, -1, 1), 0))
    label = group_rows(pieces, wide, sides=np.array(sides))
    return [[pieces[k] for k in own] for own in groups(label, int(label.max()) + 1)]


def rejoin_rows(lines: list[TracedRow], spacing: float) -> list[TracedRow]:
    """Join rows of a block that are separated by a hole, such as a pond, if rows on both sides of it run past."""
    long = [k for k, line in enumerate(lines) if len(line.trees) > 2]
    first = np.array([lines[k].along[0] for k in long])
    last = np.array([lines[k].along[-1] for k in long])
    ahead: dict[int, int] = {}
    for k in long:
        own = lines[k]
        after = sorted((float(lines[o].along[0]), o) for o in long if lines[o].along[0] > own.along[-1])
        for begins, other in after:
            at = 0.5 * (begins + float(own.along[-1]))
            if abs(lines[other].across_at(at) - own.across_at(at)) < _IN_LINE * spacing:
                past = np.array(long)[(first < own.along[-1]) & (last > begins)].tolist()
                off = np.array([lines[o].across_at(at) - own.across_at(at) for o in past])
                if (off < -spacing / 2).any() and (off > spacing / 2).any() and (np.abs(off) > spacing / 2).all():
                    ahead[k] = other
                break
    into = {k: k for k in range(len(lines))}
    merged = dict(enumerate(lines))
    for k, other in sorted(ahead.items(), key=lambda pair: float(lines[pair[0]].along[-1])):
        a, b = merged[into[k]], merged.pop(other)
        merged[into[k]] = TracedRow(
            *(
                np.concatenate(both)
                for both in zip((a.trees, a.along, a.across), (b.trees, b.along, b.across), strict=True)
            )
        )
        into[other] = into[k]
    return [merged[k] for k in sorted(merged)]
