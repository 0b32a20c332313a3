"""Select trees by their rows: a range of rows, every n-th row, and rows beside that of a place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.errors import PlaceError
from fieldhand.language import counted, message, words
from fieldhand.language.words import COMPASS
from fieldhand.places.place_errors import no_such_row, row_in_several_blocks
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.places.rows.along_and_across import reference_tree
from fieldhand.places.rows.numbers_in_row import blocks_of, in_those_rows
from fieldhand.site.counting import (
    block_words,
    find_row,
    require_rows,
    row_words,
    rows_from,
)
from fieldhand.site.model import Site
from fieldhand.site.names import listed, short
from fieldhand.site.planting import Block, Row

if TYPE_CHECKING:
    from fieldhand.places.rows.rows import Rows


def in_rows(spots: PlaceGroup, selector: Rows, reference: PlaceGroup, notes: ResolutionNotes) -> PlaceGroup:
    """Return the trees in a range of rows, or in every n-th of these.

    A row given by name or number is searched in the blocks of the reference group; otherwise each block counts its own.
    """
    site = spots.site
    require_rows(site)
    if selector.every < 1:
        raise PlaceError(
            message("selecting every {every}th row is not possible", every=selector.every),
            advice=message("ask for every row, every second row, ..."),
        )
    blocks = blocks_of(site, reference)
    if not blocks:
        raise PlaceError(
            message("none of these trees is in a row"), where=site.name, advice=message("ask for other trees")
        )
    chosen: list[Row] = []
    if selector.first or selector.last:
        chosen = list(_range(site, blocks, selector, notes))
    else:
        for block in blocks:
            rows, side = rows_from(site, block, selector.counted_from)
            chosen += rows[:: selector.every]
            notes.rule = f"rows are counted from {side}" + (", in each block" if len(blocks) > 1 else "")
    return in_those_rows(spots, chosen)


def row_of(spots: PlaceGroup, origin: PlaceGroup, over: int, notes: ResolutionNotes) -> PlaceGroup:
    """Return the trees in the rows of the origin, or in the rows ``over`` rows from them."""
    site = spots.site
    planting = require_rows(site)
    rows = np.unique(origin.row)
    own = {
        int(planting.row_of[reference_tree(origin.keep([k]), notes)]) for k in np.flatnonzero(origin.row < 0).tolist()
    }
    chosen: list[Row] = []
    for row in sorted(own | set(rows[rows >= 0].tolist())):
        mine = planting.rows[row]
        in_order, side = rows_from(site, planting.blocks[mine.block], "usual")
        at = next(k for k, r in enumerate(in_order) if r is mine) + over
        if not 0 <= at < len(in_order):
            its = row_words(site, mine)
            raise PlaceError(
                counted(
                    "there is no row {count} row after {row}",
                    "there is no row {count} rows after {row}",
                    over,
                    row=its,
                )
                if over > 0
                else counted(
                    "there is no row {count} row before {row}",
                    "there is no row {count} rows before {row}",
                    -over,
                    row=its,
                ),
                where=site.name,
                advice=message(
                    "the rows are counted from {side}: {rows}",
                    side=COMPASS[side],
                    rows=listed([r.name for r in in_order]),
                ),
            )
        chosen.append(in_order[at])
    notes.rule = f"that is {listed([row_words(site, row) for row in chosen])}"
    return in_those_rows(spots, chosen)


def _range(site: Site, blocks: Sequence[Block], selector: Rows, notes: ResolutionNotes) -> Sequence[Row]:
    """Return the rows from first to last, which must both be in exactly one block."""
    found: list[tuple[Block, Sequence[Row]]] = []
    by_number = selector.counted_from != "usual"
    for block in blocks:
        rows, side = rows_from(site, block, selector.counted_from)
        first = find_row(rows, selector.first, by_number=by_number) if selector.first else 0
        last = find_row(rows, selector.last, by_number=by_number) if selector.last else len(rows) - 1
        if first is not None and last is not None:
            step = selector.every if last >= first else -selector.every
            found.append((block, rows[first : last + 1 : step] if step > 0 else _backwards(rows, first, last, step)))
            notes.rule = f"rows are counted from {side}"
    if not found:
        raise _no_such_range(site, blocks, selector)
    if len(found) > 1:
        raise row_in_several_blocks(site, selector, [block_words(b) for b, _ in found])
    return found[0][1]


def _backwards(rows: Sequence[Row], first: int, last: int, step: int) -> Sequence[Row]:
    return [rows[k] for k in range(first, last - 1, step)]


def _no_such_range(site: Site, blocks: Sequence[Block], selector: Rows) -> PlaceError:
    """Return the error for a range whose ends do not exist or are in different blocks."""
    by_number = selector.counted_from != "usual"
    where: dict[str, list[str]] = {}
    for name in dict.fromkeys(s for s in (selector.first, selector.last) if s):
        has = [b for b in blocks if find_row(rows_from(site, b, selector.counted_from)[0], name, by_number=by_number)
               is not None]  # fmt: skip
        if not has:
            return no_such_row(site, blocks, name)
        where[name] = [block_words(b) for b in has]
    text = words.listed(
        [message("row {name} is in {blocks}", name=short(name), blocks=listed(names)) for name, names in where.items()]
    )
    return PlaceError(
        message("{told}, so they do not form a range", told=text),
        where=site.name,
        advice=message("ask for rows of one block at a time"),
    )
