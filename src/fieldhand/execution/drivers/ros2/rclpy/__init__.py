"""ROS 2 by its own client library: the transport for where a ROS 2 environment is sourced, with any middleware.

Nothing of it is imported anywhere else, and what is imported here is imported when a node is made: most machines have
no ROS. No thread, no executor, no callback: an executor of rclpy waits until the middleware has something and takes it
then, by ``take_message``, ``take_response`` and ``service_take_request``; here the same is taken when the driver looks.
So nothing can starve, nothing waits for a lock of ours, and where a node of somebody else lives in the same process,
its executor and ours cannot meet: the context is our own, too.

``message_types`` knows the interfaces that are sourced, and turns messages into mappings and back; ``qos`` translates,
``topics`` and ``services`` are the endpoints, ``discovery`` is what the others have, ``transport`` puts them together.
"""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from fieldhand.errors import InputError

if TYPE_CHECKING:
    from fieldhand.execution.drivers.ros2.rclpy.transport import RclpyTransport

__all__ = ["open_rclpy"]


def open_rclpy(domain: int | None = None) -> RclpyTransport:
    """Join a ROS 2 graph with the ROS that is sourced.

    Args:
        domain: Of ROS; None means ``ROS_DOMAIN_ID`` of the environment, else 0.

    Raises:
        InputError: The domain is none, no ROS 2 is sourced, or it is one for another Python.
        Ros2Error: No node can be made.
    """
    try:
        from fieldhand.execution.drivers.ros2.rclpy.transport import RclpyTransport
    except ImportError as error:
        raise _not_sourced(error) from error
    return RclpyTransport(domain)


def _not_sourced(error: ImportError) -> InputError:
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    distro = os.environ.get("ROS_DISTRO", "").strip()[:40]
    if distro:
        return InputError(
            f"ROS 2 {distro} is sourced, but its rclpy cannot be loaded by Python {python} ({error})",
            advice="run this with the Python that this ROS was built for (from 3.11 on), or reach the robot by dds",
        )
    return InputError(
        "no ROS 2 is sourced here: rclpy was not found",
        advice="source it first, such as: . /opt/ros/jazzy/setup.bash; without ROS, reach the robot by dds",
    )
