"""Sort places by compass direction, distance, row or attribute."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.language import counted
from fieldhand.places.filters.attributes import column_of, column_rows
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.counting import require_rows, rows_from
from fieldhand.site.model import Site
from fieldhand.site.planting import Indices

if TYPE_CHECKING:
    from fieldhand.places.picks.ordered import Order, Ordered


_COMPASS: dict[Order, tuple[float, float]] = {
    "west_to_east": (1, 0),
    "east_to_west": (-1, 0),
    "south_to_north": (0, 1),
    "north_to_south": (0, -1),
}


def ordered(spots: PlaceGroup, selector: Ordered, here: tuple[float, float], notes: ResolutionNotes) -> PlaceGroup:
    """Return all places sorted; ties in file order, places without a row or the attribute last."""
    key, lacking = _key(spots, selector, here, notes)
    if lacking.any():
        count = int(lacking.sum())
        if selector.by == "attribute":
            notes.remark(
                counted(
                    "{count} place lacks {attribute} and comes last",
                    "{count} places lack {attribute} and come last",
                    count,
                    attribute=selector.attribute,
                )
            )
        else:
            notes.remark(
                counted(
                    "{count} place is not in a row and comes last",
                    "{count} places are not in a row and come last",
                    count,
                )
            )
    rounded = np.round(-key if selector.descending else key, 4)
    return spots.keep(np.lexsort((spots.file_order, rounded, lacking)))


def _key(
    spots: PlaceGroup, selector: Ordered, here: tuple[float, float], notes: ResolutionNotes
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return the sort key of each place, and a mask of the places without one."""
    none = np.zeros(len(spots), dtype=bool)
    match selector.by:
        case "nearest_first" | "farthest_first":
            away = np.asarray(np.hypot(*(spots.xy - np.array(here)).T), dtype=np.float64)
            return (away if selector.by == "nearest_first" else -away), none
        case "rows":
            place, side = _row_places(spots.site)
            row = spots.row
            notes.rule = f"rows are counted from {side}, the trees of each row from its usual end"
            return np.asarray(place[row] * (len(spots.site.trees) + 1.0) + spots.rank_in_row), row < 0
        case "attribute":
            column = column_rows(column_of(spots.site, selector.attribute), spots)
            if np.isnan(column.numbers).all() and (column.codes >= 0).any():
                alphabetical = np.argsort(np.argsort(np.array(column.texts)))
                return np.where(column.codes >= 0, alphabetical[column.codes], 0).astype(np.float64), column.codes < 0
            return np.nan_to_num(column.numbers), np.isnan(column.numbers)
        case by:
            return np.asarray(spots.xy @ np.array(_COMPASS[by], dtype=np.float64)), none


def _row_places(site: Site) -> tuple[Indices, str]:
    """Return the position of each row in the count, block after block, and the rule in words."""
    planting = require_rows(site)
    position = {id(row): k for k, row in enumerate(planting.rows)}
    place = np.zeros(len(planting.rows), dtype=np.intp)
    sides: dict[str, None] = {}
    counted = 0
    for block in planting.blocks:
        rows, side = rows_from(site, block, "usual")
        sides[side] = None
        for row in rows:
            place[position[id(row)]] = counted
            counted += 1
    return place, " or ".join(sides)
