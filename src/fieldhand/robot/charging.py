"""Recharging of a robot at a charger: docking, and the power that the battery takes at each charge."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from fieldhand.robot.model import Action

#: Names of the actions by which a robot connects to its charger and leaves it.
DOCK, UNDOCK = "dock", "undock"

#: Steps in percent at which the charging time is tabulated; between them it is interpolated.
_STEP_PERCENT = 0.25


@dataclass(frozen=True, kw_only=True)
class Charging:
    """Charging properties of a robot.

    Attributes:
        dock: Action that connects it to the charger.
        undock: Action that leaves the charger; None if it drives off.
        curve: Power into the battery in watts at each charge in percent, ascending; linear in between, constant beyond
            the ends. The robot's own consumption is supplied by the charger and not included.
        until_percent: Charge up to which it charges by default.
        most_percent: Charge up to which it charges before far places.
        stranding_probability: Accepted probability that a mission that recharges falls to the stop level on the way to
            the charger or home.
    """

    dock: Action
    undock: Action | None = None
    curve: tuple[tuple[float, float], ...]
    until_percent: float
    most_percent: float = 100.0
    stranding_probability: float = 0.0005

    @property
    def maneuvers(self) -> tuple[Action, ...]:
        """Return the actions of docking."""
        return (self.dock,) if self.undock is None else (self.dock, self.undock)

    @property
    def around_s(self) -> float:
        """Return the seconds for docking and leaving the charger."""
        return sum(action.duration_s for action in self.maneuvers)

    @property
    def around_j(self) -> float:
        """Return the energy for docking and leaving the charger in joules, idle power not included."""
        return sum(action.energy_j for action in self.maneuvers)

    def seconds(self, from_percent: ArrayLike, to_percent: ArrayLike, capacity_j: float) -> NDArray[np.float64]:
        """Return the time to charge from one charge to another, elementwise; 0 if the second is not higher.

        Args:
            from_percent, to_percent: Charges, 0 to 100.
            capacity_j: Energy of a full battery in joules.
        """
        percents, joule_per_watt = self._table
        begun, done = (
            np.interp(np.asarray(p, dtype=np.float64), percents, joule_per_watt) for p in (from_percent, to_percent)
        )
        return np.asarray(np.maximum(done - begun, 0.0) * capacity_j / 100.0)

    def percent_after(self, from_percent: ArrayLike, seconds: ArrayLike, capacity_j: float) -> NDArray[np.float64]:
        """Return the charge after some seconds at the charger, elementwise, at most 100."""
        percents, joule_per_watt = self._table
        charge = np.asarray(from_percent, dtype=np.float64)
        begun = np.interp(charge, percents, joule_per_watt)
        after = np.interp(begun + np.asarray(seconds) * 100.0 / capacity_j, joule_per_watt, percents)
        return np.asarray(np.maximum(after, charge))

    @cached_property
    def _table(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return charges, and the integral of the reciprocal power up to each of them in percent per watt."""
        at, watts = (np.array(column, dtype=np.float64) for column in zip(*self.curve, strict=True))
        percents = np.union1d(np.arange(0.0, 100.0 + _STEP_PERCENT, _STEP_PERCENT), at)
        slowness = 1.0 / np.interp(percents, at, watts)
        parts = np.diff(percents) * (slowness[1:] + slowness[:-1]) / 2.0
        return percents, np.concatenate(([0.0], np.cumsum(parts)))
