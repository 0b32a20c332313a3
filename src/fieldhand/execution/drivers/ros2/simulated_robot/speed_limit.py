"""Speed limit, received like Nav2's controller does."""

from __future__ import annotations

from fieldhand.execution.drivers.ros2.transport import QosProfile, RosMessage, Transport
from fieldhand.robot.bindings import Ros2Bindings

_TYPE = "nav2_msgs/msg/SpeedLimit"


class SpeedLimit:
    """Maximum speed of the robot.

    Args:
        transport: Transport of the robot's graph.
        bindings: ROS 2 bindings; they may name no speed limit topic.
        own_m_s: Speed of the robot in m/s, the upper bound.

    Raises:
        Ros2Error: The type is unknown.
    """

    def __init__(self, transport: Transport, bindings: Ros2Bindings, own_m_s: float) -> None:
        self._own_m_s = self._limit_m_s = own_m_s
        topic = bindings.navigation.speed_limit
        self._subscription = transport.subscribe(bindings.whole_name(topic), _TYPE, QosProfile()) if topic else None

    def m_s(self) -> float:
        """Return the last limit received, in m/s. As in Nav2, 0 removes the limit."""
        for message in self._subscription.take() if self._subscription is not None else ():
            self._limit_m_s = min(self._own_m_s, self._limit_in(message) or self._own_m_s)
        return self._limit_m_s

    def _limit_in(self, message: RosMessage) -> float:
        limit = message.get("speed_limit")
        limit = float(limit) if isinstance(limit, (int, float)) and limit > 0 else 0.0
        return limit / 100.0 * self._own_m_s if message.get("percentage") else limit
