"""Cameras that look to one side of a robot, and what that means for its heading.

Headings and bearings are in degrees clockwise from true north, 0 to 360.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.site.bearings import apart_deg

#: Side of the robot to which a camera looks, seen in the direction of travel; as that of an implement.
CameraSide = Literal["left", "right", "front", "back"]

#: Direction of each side in degrees clockwise from the robot's heading.
_CLOCKWISE_DEG: dict[CameraSide, float] = {"front": 0.0, "right": 90.0, "back": 180.0, "left": 270.0}

#: Default horizontal field of view in degrees.
VIEW_DEG = 60.0


@dataclass(frozen=True, kw_only=True)
class Camera:
    """The camera with which an action takes a picture of a plant, fixed to the robot.

    Attributes:
        side: Side to which it looks.
        view_deg: Horizontal field of view in degrees; the plant is in view up to half of it beside the middle.
    """

    side: CameraSide
    view_deg: float = VIEW_DEG

    @property
    def lateral(self) -> bool:
        """True if it looks to the left or to the right, so that a robot along the aisle sees the row beside it."""
        return self.side in ("left", "right")

    def heading_towards(self, bearing_deg: float) -> float:
        """Return the heading of the robot at which the middle of the picture has this bearing."""
        return (bearing_deg - _CLOCKWISE_DEG[self.side]) % 360.0

    def bearing_at(self, heading_deg: float) -> float:
        """Return the bearing of the middle of the picture at a heading of the robot."""
        return (heading_deg + _CLOCKWISE_DEG[self.side]) % 360.0

    def off_deg(self, heading_deg: float, bearing_deg: float) -> float:
        """Return the angle of a bearing from the middle of the picture in degrees, 0 to 180."""
        return apart_deg(self.heading_towards(bearing_deg), heading_deg)

    def sees(self, heading_deg: float, bearing_deg: float) -> bool:
        """Return True if what has this bearing from the robot is in view."""
        return self.off_deg(heading_deg, bearing_deg) <= self.view_deg / 2.0
