"""Empty planting positions: where a plant is missing between two others of its row."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from fieldhand.language import message
from fieldhand.site.counting import row_words
from fieldhand.site.model import Place, Site

Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False, kw_only=True)
class EmptyPositions:
    """The empty planting positions of a site, row after row, each from the row's usual end.

    Attributes:
        places: The positions as places of kind ``gap``, on the line between their neighbours.
        row: Index of the row of each in :attr:`~.Planting.rows`.
        before, after: Indices of the neighbouring trees in the row, towards its usual end and away from it.
    """

    places: tuple[Place, ...]
    row: Indices
    before: Indices
    after: Indices

    def __len__(self) -> int:
        return len(self.places)

    @property
    def xy(self) -> NDArray[np.float64]:
        """Metres east and north, shape (n, 2)."""
        return np.array([place.xy for place in self.places], dtype=np.float64).reshape(-1, 2)


def empty_positions(site: Site) -> EmptyPositions:
    """Return the empty positions between the ends of the rows, from the planting positions of the trees; cached.

    The positions are those that the file numbers, else those inferred from the spacing of the trees. Positions beyond
    the last tree of a row are unknown.
    """
    if "empty positions" not in site.cache:
        site.cache["empty positions"] = _empty_positions(site)
    return cast(EmptyPositions, site.cache["empty positions"])


def _empty_positions(site: Site) -> EmptyPositions:
    found = list(_of_rows(site))
    xy = np.array([at for _, _, _, at, _ in found], dtype=np.float64).reshape(-1, 2)
    degrees = site.projection.degrees(xy).tolist() if found else []
    rows = site.planting.rows
    return EmptyPositions(
        places=tuple(
            Place(
                kind="gap",
                id=message("position {number} of {row}", number=slot, row=row_words(site, rows[row])),
                x=float(x),
                y=float(y),
                lat=lat,
                lon=lon,
            )
            for (row, _, _, _, slot), (x, y), (lat, lon) in zip(found, xy.tolist(), degrees, strict=True)
        ),
        row=np.array([row for row, *_ in found], dtype=np.intp),
        before=np.array([before for _, before, *_ in found], dtype=np.intp),
        after=np.array([after for _, _, after, *_ in found], dtype=np.intp),
    )


def _of_rows(site: Site) -> Iterator[tuple[int, int, int, NDArray[np.float64], int]]:
    """Yield row, neighbours, position in metres and planting position of each gap."""
    for number, row in enumerate(site.planting.rows):
        _, first = np.unique(row.slots, return_index=True)
        first = np.sort(first)  # several trees in one position count once
        slots, trees = row.slots[first], row.trees[first]
        for k in np.flatnonzero(np.abs(np.diff(slots)) > 1).tolist():
            before, after = int(trees[k]), int(trees[k + 1])
            step = int(slots[k + 1]) - int(slots[k])
            for j in range(1, abs(step)):
                share = j / abs(step)
                at = site.xy[before] + share * (site.xy[after] - site.xy[before])
                yield number, before, after, at, int(slots[k]) + (j if step > 0 else -j)


__all__ = ["EmptyPositions", "empty_positions"]
