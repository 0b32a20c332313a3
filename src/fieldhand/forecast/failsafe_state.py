"""State of a mission between two decisions, and the failsafe's forecast for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.forecast.mission_state import Spent, Work
from fieldhand.forecast.resource_limits import ResourceKind

#: ``turn_home``: going on would more likely than not exceed a limit, and turning round is safer. ``out_of_reach``: the
#: battery does not last for the way home above its stop level.
Alarm = Literal["none", "turn_home", "out_of_reach"]


@dataclass(frozen=True, kw_only=True)
class FailsafeState:
    """The state of a robot between two decisions.

    Attributes:
        spent: Used since the mission began, the goal in hand included.
        charge_percent: Battery left.
        on_m: Metres left of the drive in hand; 0 without one.
        work: Remaining work of the current capture.
        after_m: Metres home from where the drive in hand ends.
        home_m: Metres home from here, at most.
        returning: True if it is already on its way home.
    """

    spent: Spent
    charge_percent: float
    on_m: float
    work: Work
    after_m: float
    home_m: float
    returning: bool


@dataclass(frozen=True, kw_only=True)
class FailsafeForecast:
    """The forecast of the failsafe.

    Attributes:
        limit: The limit that caused the alarm.
        left: Amount left of it in its unit; charge above the reserve for ``reserve``, above the stop level for
            ``out_of_reach``.
        needed: Amount of it needed for the way home, on average.
        chance_short: Probability of exceeding it by going on.
        reach_m: Metres that the charge above the stop level lasts for.
        drain: Battery drain relative to its model.
    """

    alarm: Alarm = "none"
    limit: ResourceKind = "reserve"
    left: float = 0.0
    needed: float = 0.0
    chance_short: float = 0.0
    reach_m: float = 0.0
    drain: float = 1.0
