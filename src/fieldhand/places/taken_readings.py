"""Places at which the mission took readings, and what it read there."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.reading_series import ReadingSeries
from fieldhand.site.names import short
from fieldhand.site.planting import Indices

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution


def places_read(resolution: Resolution, reading: str, quantity: str) -> PlaceGroup:
    """Return the places where a quantity of a series was read, each once, in the order of their first readings.

    Raises:
        PlaceError: No reading of this name was taken.
    """
    taken = resolution.context.series.get(reading, ReadingSeries())
    places = {
        (t.place.kind, t.place.id): t.place for t in reversed(tuple(taken)) if quantity in t.values or not t.values
    }
    if not places:
        raise PlaceError(
            message("no reading “{name}” was taken", name=short(reading)),
            advice=message("choose places by a reading that was taken before"),
        )
    return resolution.group(*reversed(places.values()))


def values_by_place(resolution: Resolution, reading: str, quantity: str) -> Mapping[tuple[str, str], tuple[float, ...]]:
    """Return the values read at each place, by its kind and id."""
    found: dict[tuple[str, str], tuple[float, ...]] = {}
    for taken in resolution.context.series.get(reading, ReadingSeries()):
        if quantity in taken.values:
            key = taken.place.kind, taken.place.id
            found[key] = (*found.get(key, ()), taken.values[quantity])
    return found


def mean_values(group: PlaceGroup, resolution: Resolution, reading: str, quantity: str) -> NDArray[np.float64]:
    """Return the mean of the values read at each place; nan where no value is known. Shape (n,)."""
    values = values_by_place(resolution, reading, quantity)
    each = [values.get((place.kind, place.id), ()) for place in group.places]
    return np.array([math.fsum(some) / len(some) if some else math.nan for some in each])


def groups_of(places: PlaceGroup, group: Literal["row", "block"]) -> Indices:
    """Return for each place the index of its row or block; -1 for a place in none. Shape (n,)."""
    rows = places.row
    if group == "row":
        return rows
    blocks = np.array([row.block for row in places.site.planting.rows] or [-1], dtype=np.intp)
    return np.where(rows >= 0, blocks[rows], -1)
