"""Trees by block, by row and by their number in the row."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import PlaceError
from fieldhand.language import counted, message, words
from fieldhand.language.words import COMPASS
from fieldhand.places.counted import blocks_of, standing
from fieldhand.places.faults import no_such_block, no_such_row, row_in_several_blocks
from fieldhand.places.hand import tree_in_hand
from fieldhand.places.selectors import EveryNth, InBlock, InRow, RowOf, Rows
from fieldhand.places.spots import Spots
from fieldhand.places.tell import Tell
from fieldhand.site.counting import (
    bare_name,
    block_words,
    find_row,
    need_rows,
    numbered_by_file,
    row_words,
    rows_from,
    trees_from,
)
from fieldhand.site.model import Site
from fieldhand.site.names import listed, short
from fieldhand.site.planting import Block, Indices, Row
from fieldhand.terms import CountedFrom

Mask = NDArray[np.bool_]


def find_block(site: Site, said: str) -> Block | None:
    """The block of that name, else of that number from 1; None where there is none."""
    blocks = site.planting.blocks
    exact = [b for b in blocks if b.name == said]
    alike = exact or [b for b in blocks if bare_name(b.name) == bare_name(said)]
    if alike:
        return alike[0]
    number = bare_name(said)
    return blocks[int(number) - 1] if number.isdecimal() and 0 < int(number[:9]) <= len(blocks) else None


def in_block(spots: Spots, selector: InBlock) -> Spots:
    """Those in the rows of that block."""
    block = find_block(spots.site, selector.block)
    if block is None:
        raise no_such_block(spots.site, selector.block)
    return _in_rows(spots, block.rows)


def in_rows(spots: Spots, selector: Rows, ground: Spots, tell: Tell) -> Spots:
    """Those in a range of rows, or in every so many of them.

    A row that is called by name or number is looked for in the blocks of the ground; without one, each block counts.
    """
    site = spots.site
    need_rows(site)
    if selector.every < 1:
        raise PlaceError(
            message("every {every}th row is no row", every=selector.every),
            advice=message("ask for every row, every second row, ..."),
        )
    blocks = blocks_of(site, ground)
    if not blocks:
        raise PlaceError(
            message("none of these trees stands in a row"), where=site.name, advice=message("ask for other trees")
        )
    chosen: list[Row] = []
    if selector.first or selector.last:
        chosen = list(_range(site, blocks, selector, tell))
    else:
        for block in blocks:
            rows, side = rows_from(site, block, selector.counted_from)
            chosen += rows[:: selector.every]
            tell.rule = f"rows count from {side}" + (", in each block" if len(blocks) > 1 else "")
    return _in_rows(spots, chosen)


def row_of(spots: Spots, origin: Spots, selector: RowOf, tell: Tell) -> Spots:
    """Those in the rows of the origin, or so many rows over."""
    site = spots.site
    planting = need_rows(site)
    rows = np.unique(origin.row)
    own = {int(planting.row_of[tree_in_hand(origin.keep([k]), tell)]) for k in np.flatnonzero(origin.row < 0).tolist()}
    chosen: list[Row] = []
    for row in sorted(own | set(rows[rows >= 0].tolist())):
        mine = planting.rows[row]
        in_order, side = rows_from(site, planting.blocks[mine.block], "usual")
        at = next(k for k, r in enumerate(in_order) if r is mine) + selector.over
        if not 0 <= at < len(in_order):
            its = row_words(site, mine)
            raise PlaceError(
                counted(
                    "there is no row {count} row after {row}",
                    "there is no row {count} rows after {row}",
                    selector.over,
                    row=its,
                )
                if selector.over > 0
                else counted(
                    "there is no row {count} row before {row}",
                    "there is no row {count} rows before {row}",
                    -selector.over,
                    row=its,
                ),
                where=site.name,
                advice=message(
                    "the rows count from {side}: {rows}", side=COMPASS[side], rows=listed([r.name for r in in_order])
                ),
            )
        chosen.append(in_order[at])
    tell.rule = f"that is {listed([row_words(site, row) for row in chosen])}"
    return _in_rows(spots, chosen)


def in_row(spots: Spots, selector: InRow, tell: Tell) -> Spots:
    """Those with such numbers in their row.

    Whole rows whose trees the file numbers go by the file's numbers, unless a side is named to count from; else the
    trees of the group that stand are counted.
    """
    first, last = selector.first, selector.last
    if 0 in (first, last):
        raise PlaceError(
            message("trees in a row count from 1"),
            advice=message("ask for tree 1, or for tree -1 from the row's other end"),
        )
    if first * last > 0 and first > last:
        first, last = last, first
    way, side = _ways(spots, selector.counted_from)
    number, count = standing(spots, way)
    low, high = (np.where(n < 0, count + 1 + n, n) for n in (first, last))
    kept = (number >= low) & (number <= high) & (number > 0)
    tell.rule = f"trees in a row count from {side}"
    if selector.counted_from == "usual":
        kept = _by_own_numbers(spots, kept, (first, last), tell)
    if not kept.any():
        raise _no_such_tree_in_row(spots, selector, count)
    _tell_short_rows(spots, max(first, last), count, tell)
    return spots.keep(kept)


def every_nth(spots: Spots, selector: EveryNth, tell: Tell) -> Spots:
    """Those whose number among the group in their row is ``start``, ``start + nth``, and so on.

    Where no row has as many trees, the count goes on from row to row: "every 50th tree" is not the first of every row.
    """
    if selector.nth < 1 or selector.start < 1:
        raise PlaceError(
            message("every {nth}th tree from the {start}th on is no tree", nth=selector.nth, start=selector.start),
            advice=message("ask for every tree, every second tree, ...; the first tree of a row is tree 1"),
        )
    way, side = _ways(spots, selector.counted_from)
    number, _ = standing(spots, way)
    tell.rule = f"the trees that stand are counted, in each row from {side}"
    outside = int((number == 0).sum())
    if outside:
        tell.note(
            counted(
                "{count} tree stands in no row and cannot be counted",
                "{count} trees stand in no row and cannot be counted",
                outside,
            )
        )
    if 0 < number.max(initial=0) < selector.nth:
        number = _row_by_row(spots, number)
        tell.rule = f"the trees that stand are counted row by row, in each row from {side}"
        tell.note(message("no row has {count} of them, so the count goes on from row to row", count=selector.nth))
    return spots.keep((number >= selector.start) & ((number - selector.start) % selector.nth == 0))


def _row_by_row(spots: Spots, number: Indices) -> Indices:
    """The numbers in their rows counted on from one row to the next; 0 stays what is in no row."""
    counted = np.flatnonzero(number)
    row = spots.site.planting.row_of[spots.index[counted]]
    on = np.zeros_like(number)
    on[counted[np.lexsort((number[counted], row))]] = np.arange(1, len(counted) + 1)
    return on


def _in_rows(spots: Spots, rows: Sequence[Row]) -> Spots:
    chosen = np.zeros(len(spots.site.trees) + 1, dtype=bool)
    for row in rows:
        chosen[row.trees] = True
    return spots.keep(chosen[np.where(spots.is_tree, spots.index, -1)])


def _range(site: Site, blocks: Sequence[Block], selector: Rows, tell: Tell) -> Sequence[Row]:
    """The rows from first to last; they are of one block, and no other block has both."""
    found: list[tuple[Block, Sequence[Row]]] = []
    by_number = selector.counted_from != "usual"
    for block in blocks:
        rows, side = rows_from(site, block, selector.counted_from)
        first = find_row(rows, selector.first, by_number=by_number) if selector.first else 0
        last = find_row(rows, selector.last, by_number=by_number) if selector.last else len(rows) - 1
        if first is not None and last is not None:
            step = selector.every if last >= first else -selector.every
            found.append((block, rows[first : last + 1 : step] if step > 0 else _backwards(rows, first, last, step)))
            tell.rule = f"rows count from {side}"
    if not found:
        raise _no_such_range(site, blocks, selector)
    if len(found) > 1:
        raise row_in_several_blocks(site, selector, [block_words(b) for b, _ in found])
    return found[0][1]


def _backwards(rows: Sequence[Row], first: int, last: int, step: int) -> Sequence[Row]:
    return [rows[k] for k in range(first, last - 1, step)]


def _no_such_range(site: Site, blocks: Sequence[Block], selector: Rows) -> PlaceError:
    """One of the two is nowhere, or they are in different blocks."""
    by_number = selector.counted_from != "usual"
    where: dict[str, list[str]] = {}
    for said in dict.fromkeys(s for s in (selector.first, selector.last) if s):
        has = [b for b in blocks if find_row(rows_from(site, b, selector.counted_from)[0], said, by_number=by_number)
               is not None]  # fmt: skip
        if not has:
            return no_such_row(site, blocks, said)
        where[said] = [block_words(b) for b in has]
    told = words.listed(
        [message("row {name} is in {blocks}", name=short(said), blocks=listed(names)) for said, names in where.items()]
    )
    return PlaceError(
        message("{told}, so they are no range", told=told),
        where=site.name,
        advice=message("ask for rows of one block at a time"),
    )


def _ways(spots: Spots, side: CountedFrom) -> tuple[Indices, str]:
    """For each row of the site the way in which its trees count, and from where, of the blocks of the group."""
    site = spots.site
    planting = need_rows(site)
    way = np.ones(len(planting.rows), dtype=np.intp)
    of_row = np.array([row.block for row in planting.rows])
    blocks = blocks_of(site, spots)
    sides: dict[str, None] = {}
    for block in blocks:
        sign, name = trees_from(site, block, side)
        sides[name] = None
        way[of_row == block.rows[0].block] = sign
    if side == "usual":  # the file's own numbers say where its count begins
        rows = spots.row
        for k in np.unique(rows[rows >= 0]).tolist():
            slots = planting.rows[k].slots
            if len(slots) > 1 and slots[0] > slots[-1]:
                way[k] = -1
    if not blocks:
        raise PlaceError(
            message("none of these trees stands in a row"), where=site.name, advice=message("ask for other trees")
        )
    return way, " or ".join(sides)


def _by_own_numbers(spots: Spots, kept: Mask, ends: tuple[int, int], tell: Tell) -> Mask:
    """The same choice by the file's numbers, in rows that it numbers and of which the group has every tree."""
    site = spots.site
    rows = spots.row
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
        tell.rule = "trees in a row go by their numbers in the file"
    return kept


def _no_such_tree_in_row(spots: Spots, selector: InRow, count: Indices) -> PlaceError:
    site = spots.site
    rows = np.unique(spots.row[spots.row >= 0]).tolist()
    said = message("trees {first} to {last}", first=selector.first, last=selector.last)
    if selector.first == selector.last:
        said = message("tree {id}", id=str(selector.first))
    if len(rows) == 1:
        return PlaceError(
            message("{row} has no {trees}", row=row_words(site, site.planting.rows[rows[0]]), trees=said),
            where=site.name,
            advice=counted(
                "{count} tree is to choose from there", "{count} trees are to choose from there", int(count.max())
            ),
        )
    return PlaceError(
        message("none of the {count} rows has {trees}", count=len(rows), trees=said),
        where=site.name,
        advice=message("the longest has {count} to choose from", count=int(count.max())),
    )


def _tell_short_rows(spots: Spots, last: int, count: Indices, tell: Tell) -> None:
    short_rows = np.unique(spots.row[(count > 0) & (count < last)]).tolist()
    if short_rows and tell.rule.startswith("trees in a row count"):
        names = [row_words(spots.site, spots.site.planting.rows[k]) for k in short_rows]
        trees = counted("{count} tree", "{count} trees", last)
        if len(names) == 1:
            tell.note(message("{row} has fewer than {trees} to choose from", row=names[0], trees=trees))
        else:
            tell.note(message("{rows} have fewer than {trees} to choose from", rows=listed(names), trees=trees))
