"""ROS 2 through rclpy: the transport for machines with a sourced ROS environment, with any middleware.

Nothing outside this folder imports rclpy, and these modules are imported only when a node is created: most machines
have no ROS. There are no threads, executors or callbacks: instead of an executor that waits for the middleware, the
driver polls with the same functions (``take_message``, ``take_response``, ``service_take_request``). The context is
separate, so a node of another program in the same process and its executor are unaffected.

``message_types`` finds the sourced interfaces and converts messages, ``qos`` converts quality of service, ``topics``
and ``services`` are the endpoints, ``discovery`` lists remote endpoints, ``transport`` combines them.
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
    """Join a ROS 2 graph with the sourced ROS.

    Args:
        domain: ROS domain id; None for ``ROS_DOMAIN_ID`` of the environment, else 0.

    Raises:
        InputError: The domain id is invalid, no ROS 2 is sourced, or it is built for another Python.
        Ros2Error: No node can be created.
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
            advice="run this with the Python that this ROS was built for (from 3.10 on), or reach the robot by dds",
        )
    return InputError(
        "no ROS 2 is sourced here: rclpy was not found",
        advice="source it first, such as: . /opt/ros/jazzy/setup.bash; without ROS, reach the robot by dds",
    )
