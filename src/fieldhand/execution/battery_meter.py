"""Battery meter filter: the charge that a mission acts on, without single false readings.

A meter may report an empty or full battery for a moment. As in the battery failsafe of a flight controller, a reading
that the battery model does not explain, or that would cross a level, counts only once readings have stayed on that side
for a short time; then the mildest of them counts. Every other reading counts at once.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

#: Number of readings at different times before an unexpected value counts.
LEAST_READINGS = 3
#: Percent by which a sound meter may jump at once: the resolution of most meters.
STEP_PERCENT = 1.0
#: Seconds within which two times are equal: clocks add floating-point numbers.
_SAME_S = 1e-9


@dataclass(frozen=True, kw_only=True)
class _Outlier:
    """A reading that does not count yet; ``explained`` if the battery can have reached it, but past a level."""

    at: float
    percent: float
    explained: bool


class BatteryMeter:
    """Filters the readings of a battery meter.

    Args:
        percent: First reading.
        now: Time of the mission clock in seconds.
        hold_s: Seconds for which an unexpected reading must persist; 0 to accept every reading at once. A charge that
            the
            model explains must persist no longer than it takes to lose :data:`STEP_PERCENT`.
        fastest: Highest plausible drain in percent per second.
        levels: Charges in percent whose crossing has consequences.

    Attributes:
        percent: Filtered charge.
    """

    def __init__(
        self, percent: float, now: float, *, hold_s: float, fastest: float, levels: Sequence[float] = ()
    ) -> None:
        self.percent = percent
        self._at, self._hold_s, self._fastest, self._levels = now, hold_s, fastest, tuple(levels)
        self._explained_s = min(hold_s, STEP_PERCENT / fastest) if fastest > 0.0 else hold_s
        self._outliers: deque[_Outlier] = deque()
        self._falls = False
        self._rise = 0.0

    def rises(self, percent_per_s: float) -> None:
        """Accept a charge that rises up to that fast; 0 where the robot is not at its charger."""
        self._rise = percent_per_s

    def read(self, percent: float, now: float) -> float:
        """Process a reading and return the filtered charge. Readings that are not finite are ignored."""
        if not math.isfinite(percent):
            return self.percent
        explained = self._is_explained(percent, now)
        if self._hold_s <= 0.0 or (explained and not any(percent <= level < self.percent for level in self._levels)):
            self.percent, self._at = percent, now
            self._outliers.clear()
            return percent
        self._add_outlier(_Outlier(at=now, percent=percent, explained=explained))
        if len(self._outliers) >= LEAST_READINGS and now - self._outliers[0].at >= self._lasts_s - _SAME_S:
            held = [outlier.percent for outlier in self._outliers]
            self.percent, self._at = max(held) if self._falls else min(held), now
            while now - self._outliers[0].at > self._lasts_s:
                self._outliers.popleft()
        return self.percent

    def next_reading_in(self, now: float) -> float:
        """Return the seconds until the next reading is due: soon after an unexpected one, otherwise infinity."""
        if not self._outliers:
            return math.inf
        return max(0.0, self._outliers[-1].at + self._lasts_s / (LEAST_READINGS - 1) - now)

    @property
    def _lasts_s(self) -> float:
        """Seconds for which the current unexpected readings must persist."""
        return self._explained_s if all(outlier.explained for outlier in self._outliers) else self._hold_s

    def _is_explained(self, percent: float, now: float) -> bool:
        """Return True if the battery can have come to that charge since the last one that counts."""
        fell = self.percent - percent
        seconds = max(0.0, now - self._at)
        return -STEP_PERCENT - self._rise * seconds <= fell <= STEP_PERCENT + self._fastest * seconds

    def _add_outlier(self, outlier: _Outlier) -> None:
        falls = outlier.percent < self.percent
        if falls != self._falls:
            self._outliers.clear()
        elif self._outliers and self._outliers[-1].at >= outlier.at:
            self._outliers.pop()  # several looks at one moment are one reading
        self._falls = falls
        self._outliers.append(outlier)
