"""Choose a number or a share of each group of trees."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray

from fieldhand.errors import PlaceError
from fieldhand.language import counted, joined, message
from fieldhand.places.filters.attributes import column_of, column_rows, note_lacking, with_number
from fieldhand.places.picks.random_sample import drawn
from fieldhand.places.place_errors import too_few, value_text
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.counting import block_words, require_rows, row_words
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.names import listed

if TYPE_CHECKING:
    from fieldhand.places.picks.quota import Quota

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Maximum number of computed distances, about half a second; beyond it, trees are chosen along the rows.
_MOST_MEASURED = 50_000_000

#: Maximum number of trees that are listed by group.
_MOST_LISTED = 40

#: Shift of the choice from one row to the next, as a fraction of the step along the row; the golden ratio makes
#: neighbouring rows differ most (Kronecker sequence).
_SHIFT = (math.sqrt(5.0) - 1.0) / 2.0


@dataclass(frozen=True, eq=False)
class _Part:
    """A group of trees: its name in messages, its trees, and how many of them are chosen."""

    name: str
    trees: PlaceGroup
    count: int


def of_each_group(of: PlaceGroup, selector: Quota, notes: ResolutionNotes) -> PlaceGroup:
    """Return the trees of each group that the selector chooses, group after group.

    Raises:
        PlaceError: The quota is not possible, or the site lacks the rows, blocks, zones or attribute.
    """
    _check(selector)
    trees = of.once(1)
    groups = list(_groups(trees, selector.per, notes)) if selector.per else [("", trees)]
    parts = [_Part(name, group, _size(selector, len(group))) for name, group in groups if len(group)]
    if not parts:
        raise too_few(of.site, selector, max(1, selector.count), 0)
    _note_short(parts, selector, notes)
    chosen = _choose(parts, selector)
    index = np.concatenate([group.index for group in chosen])
    if selector.per:
        names = listed([_with_count(part.name, len(group)) for part, group in zip(parts, chosen, strict=True)])
        notes.rule = message("chosen of each: {names}", names=names)
    return PlaceGroup(site=of.site, index=index, others=of.others)


def say_each_group(trees: PlaceGroup, per: str) -> str:
    """Return the ids of trees by their groups: "Merlot: 12, 48; Syrah: 3, 9"; empty if there are too many."""
    if len(trees) > _MOST_LISTED:
        return ""
    groups = [(name, group) for name, group in _groups(trees, per, ResolutionNotes()) if len(group)]
    named = [message("{name}: {ids}", name=name, ids=joined(", ", [p.id for p in g.places])) for name, g in groups]
    return joined("; ", named)


def _check(selector: Quota) -> None:
    if (selector.count > 0) == (selector.percent > 0) or selector.count < 0 or not 0 <= selector.percent <= 100:
        raise PlaceError(
            message("a quota needs either a count of at least 1 or a percentage from above 0 to 100"),
            advice=message("give one of the two"),
        )
    if (selector.how in ("highest", "lowest")) != bool(selector.by):
        raise PlaceError(
            message("the highest or lowest of each group need the attribute by which they are compared"),
            advice=message("name the attribute, or choose them in another way"),
        )


def _size(selector: Quota, trees: int) -> int:
    """Return the number of trees of a group of this size that are chosen, at least 1."""
    if selector.percent:
        return max(1, math.floor(selector.percent * trees / 100.0 + 0.5))
    return min(selector.count, trees)


def _note_short(parts: Sequence[_Part], selector: Quota, notes: ResolutionNotes) -> None:
    short = [part for part in parts if len(part.trees) < selector.count]
    if short:
        names = listed([_with_count(part.name, len(part.trees)) for part in short])
        notes.remark(
            counted(
                "{count} group has fewer than {wanted} trees, and all of them are chosen: {names}",
                "{count} groups have fewer than {wanted} trees, and all of them are chosen: {names}",
                len(short),
                wanted=selector.count,
                names=names,
            )
        )


def _with_count(name: str, count: int) -> str:
    return message("{name} ({count})", name=name, count=count) if name else str(count)


def _groups(trees: PlaceGroup, per: str, notes: ResolutionNotes) -> Iterator[tuple[str, PlaceGroup]]:
    """Yield the name and the trees of each group, in the order of the rows, blocks, zones or values."""
    match per:
        case "row" | "block":
            yield from _planted(trees, per, notes)
        case "zone":
            yield from _zones(trees)
        case _:
            yield from _values(trees, per, notes)


def _planted(trees: PlaceGroup, per: str, notes: ResolutionNotes) -> Iterator[tuple[str, PlaceGroup]]:
    planting = require_rows(trees.site)
    row = trees.row
    lacking = int((row < 0).sum())
    if lacking:
        notes.remark(counted("{count} is in no row and is left out", "{count} are in no row and are left out", lacking))
    if per == "row":
        for k, one in enumerate(planting.rows):
            yield row_words(trees.site, one), trees.keep(row == k)
        return
    block = np.array([one.block for one in planting.rows], dtype=np.intp)
    of_tree = np.where(row >= 0, block[row], -1)
    for k, known in enumerate(planting.blocks):
        yield block_words(known), trees.keep(of_tree == k)


def _zones(trees: PlaceGroup) -> Iterator[tuple[str, PlaceGroup]]:
    """Yield the zones with the trees inside; a tree in several zones belongs to the first."""
    left = np.ones(len(trees), dtype=bool)
    for zone in trees.site.zones_of("zone"):
        inside = left & shapely.intersects_xy(zone.polygon, *trees.xy.T)
        left &= ~inside
        yield zone.name, trees.keep(inside)


def _values(trees: PlaceGroup, attribute: str, notes: ResolutionNotes) -> Iterator[tuple[str, PlaceGroup]]:
    """Yield the trees of each value of an attribute: numbers in rising order, then texts in alphabetical order."""
    column = column_rows(column_of(trees.site, attribute), trees)
    numeric = ~np.isnan(column.numbers)
    texts = ~numeric & (column.codes >= 0)
    note_lacking(int((~numeric & ~texts).sum()), attribute, notes)
    for number in np.unique(column.numbers[numeric]).tolist():
        yield value_text(number), trees.keep(numeric & (column.numbers == number))
    spelt = {
        _spelling(trees, int(np.flatnonzero(texts & (column.codes == k))[0]), attribute): k
        for k in np.unique(column.codes[texts]).tolist()
    }
    for name in sorted(spelt):
        yield name, trees.keep(texts & (column.codes == spelt[name]))


def _spelling(trees: PlaceGroup, position: int, attribute: str) -> str:
    """Return the attribute of a tree as the file spells it."""
    properties = trees.site.trees[int(trees.index[position])].properties
    name = attribute if attribute in properties else next(k for k in properties if phrase(k) == phrase(attribute))
    return value_text(properties[name])


def _choose(parts: Sequence[_Part], selector: Quota) -> list[PlaceGroup]:
    """Return the chosen trees of each group."""
    match selector.how:
        case "random":
            return [drawn(part.trees, part.count, selector.seed) for part in parts]
        case "first":
            return [_along_rows(part.trees).keep(slice(0, part.count)) for part in parts]
        case "last":
            return [_along_rows(part.trees).keep(slice(len(part.trees) - part.count, None)) for part in parts]
        case "highest" | "lowest":
            return [_ranked(part, selector) for part in parts]
        case _:
            return _spread(parts, selector.per)


def _along_rows(trees: PlaceGroup) -> PlaceGroup:
    """Return the trees row after row, from the usual end of each; those in no row last."""
    row = trees.row
    last = len(trees.site.planting.rows)
    return trees.keep(np.lexsort((trees.file_order, trees.rank_in_row, np.where(row >= 0, row, last))))


def _ranked(part: _Part, selector: Quota) -> PlaceGroup:
    known, numbers = with_number(part.trees, selector.by)
    return known.ranked(numbers if selector.how == "lowest" else -numbers, part.count)


def _spread(parts: Sequence[_Part], per: str) -> list[PlaceGroup]:
    """Return trees spread over all groups together: along the rows if the groups are rows, else far from each other."""
    wanted = sum(part.count for part in parts)
    every = sum(len(part.trees) for part in parts)
    if per == "row" or wanted * every > _MOST_MEASURED:
        return [_systematic(part, k) for k, part in enumerate(parts)]
    taken = farthest_of_groups([part.trees.xy for part in parts], [part.count for part in parts])
    return [
        part.trees.keep(sorted(few, key=lambda k, part=part: int(part.trees.file_order[k])))  # type: ignore[misc]
        for part, few in zip(parts, taken, strict=True)
    ]


def _systematic(part: _Part, number: int) -> PlaceGroup:
    """Return trees at equal steps along the rows, shifted from group to group so that neighbouring rows differ.

    Systematic sampling with a start of its own in each stratum; the starts form a Kronecker sequence.
    """
    line = _along_rows(part.trees)
    start = (0.5 + number * _SHIFT) % 1.0
    at = np.floor((np.arange(part.count) + start) * len(line) / part.count).astype(np.intp)
    return line.keep(np.minimum(at, len(line) - 1))


def farthest_of_groups(xy: Sequence[Floats], counts: Sequence[int]) -> list[list[int]]:
    """Return for each group the positions of points far from all other chosen ones, of other groups too.

    Farthest-point sampling (Gonzalez 1985) over all groups at once: the next point is the farthest from all chosen,
    of the groups that still lack some.

    Args:
        xy: Points of each group, shape (n, 2).
        counts: Number of points to choose of each, at most n.
    """
    group = np.repeat(np.arange(len(xy)), [len(points) for points in xy])
    first = np.concatenate([[0], np.cumsum([len(points) for points in xy])])
    x, y = np.ascontiguousarray(np.concatenate(list(xy)).T)
    left = np.array(counts)
    taken: list[list[int]] = [[] for _ in xy]
    away = (x - x.mean()) ** 2 + (y - y.mean()) ** 2
    nearest = -away if left.sum() == 1 else away
    fresh = np.ones(len(x), dtype=bool)
    for step in range(int(left.sum())):
        able = fresh & (left[group] > 0)
        k = int(np.argmax(np.where(able, nearest, -np.inf)))
        taken[int(group[k])].append(k - int(first[group[k]]))
        left[group[k]] -= 1
        fresh[k] = False
        distance = (x - x[k]) ** 2 + (y - y[k]) ** 2
        nearest = distance if step == 0 else np.minimum(nearest, distance)
    return taken
