"""Implements: actions that are on along a path, such as mowing, spraying and filming."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

#: Side of the robot on which an implement works, seen in the direction of travel. ``both``: on both sides at once, or
#: on either of them; ``under``: on the ground below the robot.
ImplementSide = Literal["left", "right", "both", "under"]

#: Square metres of a hectare.
HECTARE_M2 = 10_000.0

_RATE_UNIT = re.compile(r"(?P<amount>[^\W\d_]+)/(?P<per>ha|m2|m²|m|km)")


@dataclass(frozen=True, kw_only=True)
class RateUnit:
    """The unit of a rate: an amount per area or per length.

    Attributes:
        amount: Unit of the amount, such as ``l`` or ``kg``.
        area_m2: Square metres to which the rate refers; 0 if it refers to a length.
        length_m: Metres to which the rate refers; 0 if it refers to an area.
    """

    amount: str
    area_m2: float = 0.0
    length_m: float = 0.0

    def amount_for(self, rate: float, *, metres: float, width_m: float) -> float:
        """Return the amount applied over some metres of a given working width."""
        if self.area_m2:
            return rate * metres * width_m / self.area_m2
        return rate * metres / self.length_m


def rate_unit(unit: str) -> RateUnit | None:
    """Return the parsed unit of a rate, such as ``l/ha``, ``kg/ha`` or ``g/m``; None if it is not one."""
    found = _RATE_UNIT.fullmatch(unit)
    if found is None:
        return None
    match found["per"]:
        case "ha":
            return RateUnit(amount=found["amount"], area_m2=HECTARE_M2)
        case "m2" | "m²":
            return RateUnit(amount=found["amount"], area_m2=1.0)
        case "km":
            return RateUnit(amount=found["amount"], length_m=1000.0)
    return RateUnit(amount=found["amount"], length_m=1.0)


@dataclass(frozen=True, kw_only=True)
class Implement:
    """Properties of an action that is on while the robot drives.

    Attributes:
        speed_m_s: Speed while it is on, in metres per second.
        power_w: Power while it is on in watts, in addition to driving and idling.
        width_m: Working width of one pass in metres; None if it covers no ground, as a camera.
        side: Side on which it works.
        rate: Name of the action's parameter with the rate (amount per area or length); empty if nothing is applied.
        tank: Capacity in the unit of the amount; None if unlimited or unknown.
        on_delay_s, off_delay_s: Seconds from switching until it works, and until it stops.
    """

    speed_m_s: float
    power_w: float = 0.0
    width_m: float | None = None
    side: ImplementSide = "both"
    rate: str = ""
    tank: float | None = None
    on_delay_s: float = 0.0
    off_delay_s: float = 0.0

    @property
    def covers(self) -> bool:
        """True if it works an area, so that several passes may be needed side by side."""
        return self.width_m is not None and self.side == "under"
