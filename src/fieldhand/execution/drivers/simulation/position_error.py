"""Error of the position that a simulated robot knows: it drifts with the metres driven, and each fix has noise."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np

from fieldhand.execution.drivers.simulation.ground_truth import Point
from fieldhand.execution.drivers.simulation.world import Localisation

#: Fixes within a millisecond have the same noise.
_PER_S = 1000.0

#: Keys of the random generators: the direction of the drift, the noise of a fix.
_DIRECTION, _NOISE = 1, 2


class PositionError:
    """Error of the position that a robot knows, in metres east and north of where it is.

    It depends on nothing but the seed, the metres driven and the time, so that a mission which is replayed sees the
    same.

    Args:
        localisation: Size of the error; None for none.
        seed: Returns the seed.
    """

    def __init__(self, localisation: Localisation | None, seed: Callable[[], int]) -> None:
        self._size, self._seed = localisation, seed

    @property
    def exists(self) -> bool:
        """True if the robot does not know exactly where it is."""
        return self._size is not None

    @property
    def noise_m(self) -> float:
        """Standard deviation of each fix in metres, east and north."""
        return 0.0 if self._size is None else self._size.noise_m

    def along(self, path: tuple[Point, ...], begin: Point, metres: float) -> tuple[Point, ...]:
        """Return the error at each corner of a path along which the robot believes to drive; empty if it knows.

        Args:
            begin: Error at the first corner.
            metres: Metres driven up to the last one.
        """
        if self._size is None:
            return ()
        lengths = [math.dist(a, b) for a, b in itertools.pairwise(path)]
        per_m = self._size.drift_m_per_100_m / 100.0 * metres / (sum(lengths) or 1.0)
        toward = math.radians(self._toward_deg(self._size))
        east, north = per_m * math.sin(toward), per_m * math.cos(toward)
        return tuple(
            (begin[0] + driven * east, begin[1] + driven * north)
            for driven in itertools.accumulate(lengths, initial=0.0)
        )

    def of_fix(self, error: Point, now_s: float) -> Point:
        """Return the error of a fix, given that of the pose by which the robot steers."""
        if self._size is None:
            return (0.0, 0.0)
        east, north = error if self._size.fix_drifts else (0.0, 0.0)
        if not self._size.noise_m:
            return east, north
        noise = np.random.default_rng([self._seed(), _NOISE, max(0, round(now_s * _PER_S))])
        one, two = noise.normal(0.0, self._size.noise_m, 2)
        return east + float(one), north + float(two)

    def _toward_deg(self, size: Localisation) -> float:
        if size.toward_deg is not None:
            return size.toward_deg
        return float(np.random.default_rng([self._seed(), _DIRECTION]).uniform(0.0, 360.0))


def apart(path: tuple[Point, ...], errors: tuple[Point, ...]) -> tuple[Point, ...]:
    """Return the path that a robot drives which believes to be on another; the same one without errors."""
    if not errors:
        return path
    return tuple((x - east, y - north) for (x, y), (east, north) in zip(path, errors, strict=True))
