"""Driving distances between places, asked for once."""

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
    """A table of driving distances that grows with the places that are asked for. Places have their stands.

    Args:
        drives: The ways of the site.
    """

    def __init__(self, drives: Drives) -> None:
        self._drives = drives
        self._row: dict[tuple[float, float], int] = {}
        self._places: list[Place] = []
        self._lengths: Floats = np.zeros((0, 0))

    def between(self, places: Sequence[Place]) -> Floats:
        """Metres, shape (n, n).

        Raises:
            DriveFault: One of them cannot be reached.
        """
        new = list({_stand(p): p for p in places if _stand(p) not in self._row}.values())
        if new:
            known = [*self._places, *new]
            self._lengths = np.asarray(self._drives.lengths(known), dtype=np.float64)
            self._places = known
            self._row = {_stand(p): i for i, p in enumerate(known)}
        rows = [self._row[_stand(p)] for p in places]
        return self._lengths[np.ix_(rows, rows)]

    def linked(self, a: Place, b: Place) -> bool:
        """Whether there is a way from one to the other."""
        try:
            self._drives.between(a, b)
        except DriveFault:
            return False
        return True


def _stand(place: Place) -> tuple[float, float]:
    return place.xy if place.stand is None else place.stand
