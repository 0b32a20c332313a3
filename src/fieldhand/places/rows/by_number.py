"""Select trees by their numbers in their row."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import PlaceError
from fieldhand.language import counted, message
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.places.rows.numbers_in_row import blocks_of, numbers_in_row
from fieldhand.site.counting import (
    numbered_by_file,
    require_rows,
    row_words,
    trees_from,
)
from fieldhand.site.names import listed
from fieldhand.site.planting import Indices
from fieldhand.terms import CountedFrom

if TYPE_CHECKING:
    from fieldhand.places.rows.every_nth import EveryNth
    from fieldhand.places.rows.in_row import InRow


Mask = NDArray[np.bool_]


def in_row(spots: PlaceGroup, selector: InRow, notes: ResolutionNotes) -> PlaceGroup:
    """Return the trees with the selected numbers in their row.

    Complete rows whose trees are numbered in the file use those numbers, unless the selector counts from a side;
    otherwise the trees of the group in the row are counted.
    """
    first, last = selector.first, selector.last
    if 0 in (first, last):
        raise PlaceError(
            message("trees in a row are counted from 1"),
            advice=message("ask for tree 1, or for tree -1 from the row's other end"),
        )
    if first * last > 0 and first > last:
        first, last = last, first
    way, side = _ways(spots, selector.counted_from)
    number, count = numbers_in_row(spots, way)
    low, high = (np.where(n < 0, count + 1 + n, n) for n in (first, last))
    kept = (number >= low) & (number <= high) & (number > 0)
    notes.rule = f"trees in a row are counted from {side}"
    by_file: Collection[int] = ()
    if selector.counted_from == "usual":
        kept, by_file = _by_own_numbers(spots, kept, (first, last))
    if by_file:
        notes.rule = "trees in a row go by their numbers in the file"
    if not kept.any():
        raise _no_such_tree_in_row(spots, selector, count)
    _note_short_rows(spots, max(first, last), count, by_file, notes)
    return spots.keep(kept)


def every_nth(spots: PlaceGroup, selector: EveryNth, notes: ResolutionNotes) -> PlaceGroup:
    """Return the trees whose number among the group in their row is ``start``, ``start + nth``, and so on.

    If no row has that many trees, the count continues from row to row: "every 50th tree" is not the first of every row.
    """
    if selector.nth < 1 or selector.start < 1:
        raise PlaceError(
            message(
                "selecting every {nth}th tree from the {start}th on is not possible",
                nth=selector.nth,
                start=selector.start,
            ),
            advice=message("ask for every tree, every second tree, ...; the first tree of a row is tree 1"),
        )
    way, side = _ways(spots, selector.counted_from)
    number, _ = numbers_in_row(spots, way)
    notes.rule = f"existing trees are counted, in each row from {side}"
    outside = int((number == 0).sum())
    if outside:
        notes.remark(
            counted(
                "{count} tree is not in a row and cannot be counted",
                "{count} trees are not in a row and cannot be counted",
                outside,
            )
        )
    if 0 < number.max(initial=0) < selector.nth:
        number = _row_by_row(spots, number)
        notes.rule = f"existing trees are counted row by row, in each row from {side}"
        notes.remark(message("no row has {count} of them, so the count goes on from row to row", count=selector.nth))
    return spots.keep((number >= selector.start) & ((number - selector.start) % selector.nth == 0))


def _row_by_row(spots: PlaceGroup, number: Indices) -> Indices:
    """Return numbers that continue from one row to the next; 0 for places in no row."""
    counted = np.flatnonzero(number)
    row = spots.site.planting.row_of[spots.index[counted]]
    on = np.zeros_like(number)
    on[counted[np.lexsort((number[counted], row))]] = np.arange(1, len(counted) + 1)
    return on


def _ways(spots: PlaceGroup, side: CountedFrom) -> tuple[Indices, str]:
    """Return the counting direction of each row of the site, and the rule in words for the blocks of the group."""
    site = spots.site
    planting = require_rows(site)
    way = np.ones(len(planting.rows), dtype=np.intp)
    of_row = np.array([row.block for row in planting.rows])
    blocks = blocks_of(site, spots)
    sides: dict[str, None] = {}
    for block in blocks:
        sign, name = trees_from(site, block, side)
        sides[name] = None
        way[of_row == block.rows[0].block] = sign
    if side == "usual":  # numbers in the file determine the end at which a row begins
        rows = spots.row
        for k in np.unique(rows[rows >= 0]).tolist():
            slots = planting.rows[k].slots
            if len(slots) > 1 and slots[0] > slots[-1]:
                way[k] = -1
    if not blocks:
        raise PlaceError(
            message("none of these trees is in a row"), where=site.name, advice=message("ask for other trees")
        )
    return way, " or ".join(sides)


def _by_own_numbers(spots: PlaceGroup, kept: Mask, ends: tuple[int, int]) -> tuple[Mask, Collection[int]]:
    """Apply the numbers of the file in numbered rows of which the group contains every tree.

    Returns:
        The choice, which is that of ``kept`` in all other rows, and the numbered rows by their index.
    """
    site = spots.site
    rows = spots.row
    by_file: list[int] = []
    there = np.bincount(rows[rows >= 0], minlength=len(site.planting.rows))
    for k in np.flatnonzero(there).tolist():
        row = site.planting.rows[k]
        counted = np.arange(1, len(row.trees) + 1)
        if there[k] != len(row.trees) or np.array_equal(np.sort(row.slots), counted) or not numbered_by_file(site, row):
            continue
        mine = np.flatnonzero(rows == k)
        slots = np.sort(row.slots)
        low, high = (n if n > 0 else int(slots[len(slots) + n]) if -n <= len(slots) else 0 for n in ends)
        number = row.slots[site.planting.rank[spots.index[mine]]]
        kept[mine] = (number >= low) & (number <= high)
        by_file.append(k)
    return kept, by_file


def _no_such_tree_in_row(spots: PlaceGroup, selector: InRow, count: Indices) -> PlaceError:
    site = spots.site
    rows = np.unique(spots.row[spots.row >= 0]).tolist()
    text = message("trees {first} to {last}", first=selector.first, last=selector.last)
    if selector.first == selector.last:
        text = message("tree {id}", id=str(selector.first))
    if len(rows) == 1:
        return PlaceError(
            message("{row} has no {trees}", row=row_words(site, site.planting.rows[rows[0]]), trees=text),
            where=site.name,
            advice=counted("{count} tree can be chosen there", "{count} trees can be chosen there", int(count.max())),
        )
    return PlaceError(
        message("none of the {count} rows has {trees}", count=len(rows), trees=text),
        where=site.name,
        advice=message("the longest has {count} to choose from", count=int(count.max())),
    )


def _note_short_rows(
    spots: PlaceGroup, last: int, count: Indices, by_file: Collection[int], notes: ResolutionNotes
) -> None:
    short_rows = [k for k in np.unique(spots.row[(count > 0) & (count < last)]).tolist() if k not in by_file]
    if short_rows:
        names = [row_words(spots.site, spots.site.planting.rows[k]) for k in short_rows]
        trees = counted("{count} tree", "{count} trees", last)
        if len(names) == 1:
            notes.remark(message("{row} has fewer than {trees} to choose from", row=names[0], trees=trees))
        else:
            notes.remark(message("{rows} have fewer than {trees} to choose from", rows=listed(names), trees=trees))
