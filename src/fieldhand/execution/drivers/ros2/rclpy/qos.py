"""Conversion of quality of service to rclpy and back."""

from __future__ import annotations

from typing import Any

from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSCompatibility,
    QoSProfile,
    ReliabilityPolicy,
    qos_check_compatible,
)

from fieldhand.execution.drivers.ros2.transport import QosProfile


def to_rclpy_qos(qos: QosProfile) -> Any:
    """Return the rclpy profile of an own endpoint."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=qos.depth,
        reliability=ReliabilityPolicy.RELIABLE if qos.reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if qos.transient else DurabilityPolicy.VOLATILE,
    )


def from_rclpy_qos(profile: Any) -> QosProfile:
    """Return the quality of service of a remote endpoint; its depth is rarely announced."""
    return QosProfile(
        reliable=profile.reliability == ReliabilityPolicy.RELIABLE,
        transient=profile.durability == DurabilityPolicy.TRANSIENT_LOCAL,
        depth=max(1, profile.depth),
    )


def meets(writer: Any, reader: Any) -> bool:
    """Return True if a writer's offer satisfies a reader's request."""
    verdict, _ = qos_check_compatible(writer, reader)
    return bool(verdict != QoSCompatibility.ERROR)
