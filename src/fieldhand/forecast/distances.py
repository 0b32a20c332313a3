"""Driving distances between places, each computed once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import DriveFault
from fieldhand.site.model import Place

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

Floats = NDArray[np.float64]


class Distances:
    """A table of driving distances in metres, extended on demand. Places must have stands.

    Args:
        drives: Drives between places of the site.
    """

    def __init__(self, drives: Drives) -> None:
        self._drives = drives
        self._row: dict[tuple[float, float], int] = {}
        self._places: list[Place] = []
        self._lengths: Floats = np.zeros((0, 0))

    def between(self, places: Sequence[Place]) -> Floats:
        """Return the distances between places in metres, shape (n, n).

        Raises:
            DriveFault: A place cannot be reached.
        """
        new = list({_stand(p): p for p in places if _stand(p) not in self._row}.values())
        if new:
            self._lengths = self._grown(new)
            self._row.update({_stand(p): len(self._places) + k for k, p in enumerate(new)})
            self._places += new
        rows = [self._row[_stand(p)] for p in places]
        return self._lengths[np.ix_(rows, rows)]

    def _grown(self, new: Sequence[Place]) -> Floats:
        """Return the table extended by new places; known distances are kept."""
        n = len(self._places)
        grown = np.empty((n + len(new), n + len(new)))
        grown[n:, n:] = self._drives.lengths(new)
        if n:
            grown[:n, :n] = self._lengths
            grown[n:, :n] = self._drives.lengths(new, self._places)
            grown[:n, n:] = grown[n:, :n].T
        return grown

    def connected(self, a: Place, b: Place) -> bool:
        """Return True if a drive leads from one place to the other."""
        try:
            self._drives.between(a, b)
        except DriveFault:
            return False
        return True


def _stand(place: Place) -> tuple[float, float]:
    return place.xy if place.stand is None else place.stand
