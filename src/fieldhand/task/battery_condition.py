"""The condition on the charge of the battery."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class BatteryBelow:
    """The charge of the battery is at or below a percentage of a full battery."""

    percent: float
