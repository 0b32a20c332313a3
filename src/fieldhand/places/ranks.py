"""Rank places by one measure and keep the first few."""

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
    """Return the ``count`` places with the smallest key, smallest first; note ties with the last one and the
    runners-up.

    Args:
        candidates: Places to choose from.
        key: Key of each place, in metres or in the unit of an attribute.
        count: Number of places to keep.
        notes: Receives ties and runners-up.
        what: Name of the first ones: "the northernmost".
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
    """Return the ids of a few places, and the number of the others."""
    total = len(spots) if there_are is None else there_are
    shown = [p.id for p in spots.keep(slice(_FEW if total > _FEW else total)).places]
    if total > len(shown):
        return message("{places} and {count} more", places=joined(", ", shown), count=total - len(shown))
    return listed(shown)


def nearest_to_marker(spots: PlaceGroup, name: Literal["start", "end"], notes: ResolutionNotes) -> PlaceGroup | None:
    """Return the tree nearest to a marker; None where the site has none."""
    marker = spots.site.markers.get(name)
    if marker is None:
        notes.rule = f"the site has no {name} marker, so the order of the file applies"
        return None
    notes.rule = f"that is the tree nearest to the {name} marker"
    away = distance_to(spots, PlaceGroup.of(spots.site, [marker]))
    return rank(spots, away, 1, notes, message("the nearest to {place}", place=say_marker(name)))
