"""ROS 2 interface definitions: parsing, lookup, and validation of messages.

Definitions come from three sources, the later ones overriding the earlier: ROS's own packages from rosbags, for the
robot's release; definitions of Nav2 and other packages that rosbags lacks (``text/``, one folder per release where they
differ, ``common`` where they do not); and the profile's own (``interfaces``). The transports generate their types from
these definitions.

- ``definitions``: parses definition texts; derives the parts of services and actions.
- ``store``: :class:`Interfaces`, all definitions for one robot.
- ``validation``: checks messages against their definition and fills in defaults.
"""

from __future__ import annotations

from fieldhand.execution.drivers.ros2.interfaces.definitions import Definition, FieldType
from fieldhand.execution.drivers.ros2.interfaces.store import Interfaces

__all__ = ["Definition", "FieldType", "Interfaces"]
