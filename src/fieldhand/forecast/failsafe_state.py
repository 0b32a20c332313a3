"""State of a mission between two decisions, and the failsafe's forecast for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.forecast.mission_state import Spent, Work
from fieldhand.forecast.resource_limits import ResourceKind

#: ``turn_home``: going on would more likely than not exceed a limit, and turning round is safer. ``out_of_reach``: the
#: charge above the stop level does not suffice for the way home. ``turn_back``: the current drive costs far more than
#: expected, and at its end the charge might not suffice for the way to the charger.
FailsafeAlarm = Literal["none", "turn_home", "turn_back", "out_of_reach"]


@dataclass(frozen=True, kw_only=True)
class FailsafeState:
    """The state of a robot between two decisions.

    Attributes:
        spent: Resources used since the mission began, including the current goal.
        charge_percent: Current battery charge, 0 to 100.
        on_m: Metres left of the current drive; 0 if the robot is not driving.
        work: Remaining work of the current capture or wait; the time that a lower speed adds to the current drive.
        after_m: Metres home from the end of the current drive.
        home_m: Upper bound of the metres home from here.
        haven_after_m, haven_m: As ``after_m`` and ``home_m``, to the charger where it is nearer and may be used.
        returning: True if the robot is already on its way home.
        driven_m, done_m: Metres driven on the current drive, and metres of its way that are done.
        charger_after_m, charger_m: Metres to the charger from the end of the drive, and from here.
        turns: Number of drives just broken off because they cost too much; None if the robot does not turn to the
            charger for that.
    """

    spent: Spent
    charge_percent: float
    on_m: float
    work: Work
    after_m: float
    home_m: float
    haven_after_m: float
    haven_m: float
    returning: bool
    driven_m: float = 0.0
    done_m: float = 0.0
    charger_after_m: float = 0.0
    charger_m: float = 0.0
    turns: int | None = None


@dataclass(frozen=True, kw_only=True)
class FailsafeForecast:
    """The forecast of the failsafe.

    Attributes:
        limit: The limit that caused the alarm.
        left: Amount left of that limit in its unit; for ``reserve`` the charge above the reserve, for ``out_of_reach``
            the charge above the stop level; for ``turn_back`` the latter at the end of the drive.
        needed: Mean amount of that limit needed for the way home, for ``turn_back`` from the end of the drive.
        chance_short: Probability of exceeding it by going on.
        reach_m: Mean range in metres of the charge above the stop level.
        drain: Battery drain as a multiple of its model.
    """

    alarm: FailsafeAlarm = "none"
    limit: ResourceKind = "reserve"
    left: float = 0.0
    needed: float = 0.0
    chance_short: float = 0.0
    reach_m: float = 0.0
    drain: float = 1.0
