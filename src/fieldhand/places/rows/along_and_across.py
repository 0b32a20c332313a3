"""Trees relative to a tree: along its row, across to the next row, and several in a row."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldhand import language
from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import COMPASS, say_rounded, say_tree
from fieldhand.places.neighbours.distances import Origin, distance_to
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site import counting
from fieldhand.site.counting import require_rows, row_words, wind
from fieldhand.site.model import Site
from fieldhand.site.planting import Row
from fieldhand.terms import CountedFrom, Side, Towards

if TYPE_CHECKING:
    from fieldhand.places.rows.along_row import AlongRow


def reference_tree(origin: PlaceGroup, notes: ResolutionNotes) -> int:
    """Return the site index of the tree that a place stands for: itself, or the nearest tree in a row.

    Raises:
        PlaceError: The site has no rows.
    """
    site = origin.site
    planting = require_rows(site)
    at = int(origin.index[0])
    if at >= 0 and planting.row_of[at] >= 0:
        return at
    in_rows = np.flatnonzero(planting.row_of >= 0)
    away = np.round(np.hypot(*(site.xy[in_rows] - origin.xy[0]).T), 4)
    tree = int(in_rows[np.argmin(away)])
    place = origin.places[0]
    called = say_tree(place.id) if place.kind == "tree" else place.id
    notes.remark(
        message(
            "{place} is not in a row, so counting starts at the nearest tree in a row, {id}",
            place=called,
            id=site.trees[tree].place.id,
        )
    )
    return tree


def along_row(origin: PlaceGroup, selector: AlongRow, notes: ResolutionNotes) -> PlaceGroup:
    """Return the tree a number of trees along the row of the origin, or the last one of the row."""
    site = origin.site
    if selector.trees < 1:
        raise PlaceError(
            message("moving {trees} trees along a row is not possible", trees=selector.trees),
            advice=message("ask for 1 tree or more"),
        )
    tree = reference_tree(origin, notes)
    row = site.planting.rows[int(site.planting.row_of[tree])]
    way = _way_along(site, row, selector.towards, notes)
    at = int(site.planting.rank[tree])
    end = len(row.trees) - 1 if way > 0 else 0
    left = abs(end - at)
    notes.candidates = left
    found = int(row.trees[at + way * min(selector.trees, left)])
    if left < selector.trees:
        row_name, tree_id = row_words(site, row), site.trees[found].place.id
        if left:
            notes.remark(
                language.counted(
                    "{row} ends after {count} tree; its last tree in that direction is {id}",
                    "{row} ends after {count} trees; its last tree in that direction is {id}",
                    left,
                    row=row_name,
                    id=tree_id,
                )
            )
        else:
            notes.remark(message("{row} ends here; its last tree in that direction is {id}", row=row_name, id=tree_id))
    return PlaceGroup(site=site, index=np.array([found], dtype=np.intp))


def across(origin: PlaceGroup, side: CountedFrom, notes: ResolutionNotes) -> PlaceGroup:
    """Return the tree of the next row nearest to the origin: on the given side, or in the nearer neighbouring row."""
    site = origin.site
    tree = reference_tree(origin, notes)
    row = site.planting.rows[int(site.planting.row_of[tree])]
    block = site.planting.blocks[row.block]
    axis = counting.across(block)
    ways: tuple[int, ...] = (-1, 1)
    if side != "usual":
        way = counting.leads(axis, side)
        if way == 0:
            raise _beside(site, row, side, along=False)
        ways = (way,)
    at = next(k for k, r in enumerate(block.rows) if r is row)
    rows = [block.rows[at + way] for way in ways if 0 <= at + way < len(block.rows)]
    if not rows:
        own = row_words(site, row)
        raise PlaceError(
            message("there is no row beside {row}", row=own)
            if side == "usual"
            else message("there is no row to the {side} of {row}", side=COMPASS[side], row=own),
            where=site.name,
            advice=message("ask for a tree of another row"),
        )
    trees = np.concatenate([r.trees for r in rows])
    found = PlaceGroup(site=site, index=trees).ranked(np.hypot(*(site.xy[trees] - site.xy[tree]).T), 1)
    other = site.planting.rows[int(site.planting.row_of[found.index[0]])]
    notes.candidates = len(trees)
    notes.rule = f"that is in {row_words(site, other)}"
    aside = abs(float((site.xy[found.index[0]] - site.xy[tree]) @ counting.along(block)))
    if aside > 0.75 * block.tree_spacing_m:
        notes.remark(
            message(
                "{row} has no tree abreast of it; the nearest one is {metres} m along the row",
                row=row_words(site, other),
                metres=say_rounded(aside),
            )
        )
    return found


def successive(spots: PlaceGroup, near: Origin, count: int, notes: ResolutionNotes) -> PlaceGroup:
    """Return ``count`` consecutive places of the group in one row.

    Among the rows with enough places, the row with the nearest tree is chosen; in it, the run with the smallest total
    distance, ordered from its end nearer to ``near``. The result is empty if no row has enough places.
    """
    site = spots.site
    require_rows(site)
    order = np.lexsort((spots.rank_in_row, spots.row))
    order = order[spots.row[order] >= 0]
    row = spots.row[order]
    first, last = (np.searchsorted(row, row, side=s) for s in ("left", "right"))
    long_enough = last - first >= count
    notes.candidates = len(spots)
    if not long_enough.any():
        return spots.keep([])
    away = distance_to(spots, near)[order]
    nearest_row = row[long_enough][np.argmin(np.round(away[long_enough], 4))]
    own = np.flatnonzero(row == nearest_row)
    sums = np.convolve(away[own], np.ones(count), mode="valid")
    begin = int(own[int(np.argmin(np.round(sums, 3)))])
    taken = order[begin : begin + count]
    if away[begin] > away[begin + count - 1] + 1e-4:
        taken = taken[::-1]
    notes.rule = f"{row_words(site, site.planting.rows[int(nearest_row)])} is the nearest with that many"
    return spots.keep(taken)


def longest_run(spots: PlaceGroup) -> int:
    """Return the largest number of places of the group in one row."""
    rows = spots.row[spots.row >= 0]
    return int(np.bincount(rows).max()) if len(rows) else 0


def _way_along(site: Site, row: Row, towards: Towards, notes: ResolutionNotes) -> int:
    """Return 1 if a direction leads away from the usual end of the row, -1 if towards it."""
    axis = counting.along(site.planting.blocks[row.block])
    if towards == "down" or towards == "up":
        start = np.array(site.start.xy)
        to_usual, to_other = (np.hypot(*(site.xy[row.trees[k]] - start)) for k in (0, -1))
        down = 1 if to_usual <= to_other + 1e-4 else -1
        way = down if towards == "down" else -down
        begins = "the start" if "start" in site.markers else f"the first tree {site.start.id}"
        where = f"away from {begins}" if towards == "down" else f"towards {begins}"
        notes.rule = f"{towards} is {wind(way * axis)} here, {where}"
        return way
    way = counting.leads(axis, towards)
    if way == 0:
        raise _beside(site, row, towards, along=True)
    return way


def _beside(site: Site, row: Row, side: Side, *, along: bool) -> PlaceError:
    """Return the error for a side across the row where one along it is needed, or vice versa."""
    block = site.planting.blocks[row.block]
    axis = counting.along(block) if along else counting.across(block)
    fills = {"side": COMPASS[side], "row": row_words(site, row), "way": counting.way_of(block)}
    ways = {"one": COMPASS[wind(-axis)], "other": COMPASS[wind(axis)]}
    if along:
        what = message("{side} is not a direction along {row}, which runs {way}", **fills)
        return PlaceError(what, where=site.name, advice=message("say {one} or {other}, down or up", **ways))
    what = message("{side} is not a side of {row}, which runs {way}", **fills)
    return PlaceError(what, where=site.name, advice=message("say {one} or {other}", **ways))
