"""The first few of some places by one measure."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fieldhand.language import counted, joined, message
from fieldhand.language.words import listed, say_marker
from fieldhand.places.neighbours.distances import distance_to
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes

_FEW = 4


def rank(candidates: PlaceGroup, key: NDArray[np.float64], count: int, notes: ResolutionNotes, what: str) -> PlaceGroup:
    """The ``count`` with the smallest key, smallest first; says what tied with the last of them and what came next.

    Args:
        candidates: What to choose from.
        key: Of each, in metres or in the unit of an attribute.
        count: How many.
        notes: Told about ties and runners-up.
        what: What the first of them are: "the northernmost".
    """
    longer = candidates.ranked(np.asarray(key), count + _FEW)
    found = longer.keep(slice(count))
    notes.runners_up = tuple(p.id for p in longer.keep(slice(count, None)).places)
    rounded = np.round(key, 4)
    worst = np.partition(rounded, count - 1)[count - 1]
    tied = np.flatnonzero(rounded == worst)
    before = int((rounded < worst).sum())
    if before + len(tied) > count:
        taken = found.keep(slice(before, None))
        ids, taken_ids = ids_of(candidates.keep(tied[: _FEW + 1]), len(tied)), ids_of(taken, len(taken))
        first = counted("{ids} comes first in the file", "{ids} come first in the file", len(taken), ids=taken_ids)
        tied_for: dict[str, str] = {"northernmost": what, "ids": ids, "first": first}
        if candidates.is_tree.all():
            notes.remark(message("{count} trees tie for {northernmost}: {ids}; {first}", count=len(tied), **tied_for))
        else:
            notes.remark(message("{count} places tie for {northernmost}: {ids}; {first}", count=len(tied), **tied_for))
    return found


def ids_of(spots: PlaceGroup, there_are: int | None = None) -> str:
    """The ids of a few places, and how many more there are."""
    total = len(spots) if there_are is None else there_are
    shown = [p.id for p in spots.keep(slice(_FEW if total > _FEW else total)).places]
    if total > len(shown):
        return message("{places} and {count} more", places=joined(", ", shown), count=total - len(shown))
    return listed(shown)


def nearest_to_marker(spots: PlaceGroup, name: Literal["start", "end"], notes: ResolutionNotes) -> PlaceGroup | None:
    """Return the tree nearest to a marker; None where the site has none."""
    marker = spots.site.markers.get(name)
    if marker is None:
        notes.rule = f"the site has no {name} marker, so the file's order counts"
        return None
    notes.rule = f"that is the tree nearest to the {name} marker"
    away = distance_to(spots, PlaceGroup.of(spots.site, [marker]))
    return rank(spots, away, 1, notes, message("the nearest to {place}", place=say_marker(name)))
