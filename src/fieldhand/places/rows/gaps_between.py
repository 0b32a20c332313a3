"""Find the gaps in rows between the trees of a group."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldhand.errors import PlaceError
from fieldhand.language import counted, message
from fieldhand.places.place_errors import nothing
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.counting import require_rows
from fieldhand.site.gaps import empty_positions

if TYPE_CHECKING:
    from fieldhand.places.rows.missing import Missing


def gaps_between(of: PlaceGroup, selector: Missing, notes: ResolutionNotes) -> PlaceGroup:
    """Return the gaps both of whose neighbours in the row are in the group, row after row.

    Where a row passes a keep-out, such as a pond, no tree is missing.

    Raises:
        PlaceError: There are no rows, or no gaps there; the message says how many the whole site has.
    """
    site = of.site
    require_rows(site)
    gaps = empty_positions(site)
    inside = np.zeros(len(site.trees), dtype=bool)
    inside[of.index[of.is_tree]] = True
    plantable = np.ones(len(gaps), dtype=bool)
    for zone in site.zones_of("keep_out"):
        plantable &= ~np.asarray(shapely.intersects_xy(zone.polygon, gaps.xy[:, 0], gaps.xy[:, 1]))
    kept = np.flatnonzero(inside[gaps.before] & inside[gaps.after] & plantable)
    notes.candidates = len(gaps)
    notes.rule = message("empty positions between two trees of a row, by the spacing of the row")
    if not len(kept):
        fault = nothing(site, selector)
        raise PlaceError(
            fault.what,
            where=site.name,
            advice=counted(
                "no position is empty there; the rows of this site have {count} gap",
                "no position is empty there; the rows of this site have {count} gaps",
                len(gaps),
            ),
        )
    return PlaceGroup.of(site, [gaps.places[k] for k in kept.tolist()])
