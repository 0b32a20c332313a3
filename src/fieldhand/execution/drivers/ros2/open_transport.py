"""Opening a transport by its name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.errors import InputError

if TYPE_CHECKING:
    from fieldhand.execution.drivers.ros2.interfaces import Interfaces
    from fieldhand.execution.drivers.ros2.transport import Transport


def open_transport(name: str, interfaces: Interfaces, domain: int | None = None) -> Transport:
    """Open a node in a ROS 2 graph.

    Args:
        name: ``dds`` or ``rclpy``.
        interfaces: Types for DDS; rclpy uses the sourced ones.
        domain: ROS domain id; None for ``ROS_DOMAIN_ID`` of the environment, else 0.

    Raises:
        InputError: The transport does not exist, the domain id is invalid, or a required package is missing.
        Ros2Error: The network cannot be used.
    """
    if name == "rclpy":
        from fieldhand.execution.drivers.ros2.rclpy import open_rclpy

        return open_rclpy(domain)
    if name == "dds":
        from fieldhand.execution.drivers.ros2.dds import open_dds

        return open_dds(interfaces, domain)
    raise InputError(
        f"there is no transport '{name[:80]}'",
        where="--on",
        advice="give dds or rclpy",
    )
