"""Interfaces of ROS 2 as text: what messages, services and actions look like, and what fits them.

Definitions come from three places, the later before the earlier: those of ROS's own packages in rosbags, for the
release of the robot; texts of Nav2 and of what else ROS's own packages lack (``text/``, a folder for each release
where they differ, ``common`` where they do not); and those that a profile brings along (``interfaces``). Nothing here
is written twice: what goes over the wire is made from these by the transports.

- ``definitions``: what a text says, as data; the parts of services and actions as messages of their own.
- ``store``: :class:`Interfaces`, all of them for one robot.
- ``values``: messages held against their definition, and completed by defaults.
"""

from __future__ import annotations

from fieldhand.execution.drivers.ros2.interfaces.definitions import Definition, FieldType
from fieldhand.execution.drivers.ros2.interfaces.store import Interfaces

__all__ = ["Definition", "FieldType", "Interfaces"]
