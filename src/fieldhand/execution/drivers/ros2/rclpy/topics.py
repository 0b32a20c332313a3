"""Topic endpoints through rclpy."""

from __future__ import annotations

from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.serialization import deserialize_message

from fieldhand.execution.drivers.ros2.rclpy import message_types
from fieldhand.execution.drivers.ros2.rclpy.discovery import RclpyDiscovery
from fieldhand.execution.drivers.ros2.transport import RosMessage, most_bytes

RCLError = rclpy_implementation.RCLError


class RclpySubscription:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Subscription` through rclpy."""

    def __init__(self, node: Any, discovery: RclpyDiscovery, message: str, subscription: Any) -> None:
        self._node, self._discovery, self._message, self._subscription = node, discovery, message, subscription
        self._topic = subscription.topic_name
        self.open = True
        #: Why the last undecodable message could not be decoded, and the number of such messages.
        self.unreadable = ""
        self.unread = 0

    def take(self) -> tuple[RosMessage, ...]:
        taken: list[RosMessage] = []
        for _ in range(self._subscription.qos_profile.depth if self.open else 0):
            with self._subscription.handle:
                found = self._subscription.handle.take_message(self._subscription.msg_type, True)
            if found is None:
                break
            if (message := self._read(found[0])) is not None:
                taken.append(message)
        return tuple(taken)

    def publishers(self) -> int:
        if not self.open:
            return 0
        return self._discovery.matched(self._topic, self._message, self._subscription.qos_profile)

    def close(self) -> None:
        if self.open:
            self.open = False
            self._node.destroy_subscription(self._subscription)

    def _read(self, data: bytes) -> RosMessage | None:
        most = most_bytes(self._message)
        if len(data) > most:
            why = f"it has {len(data)} bytes, more than {most}"
        else:
            try:
                return message_types.from_ros(self._message, deserialize_message(data, self._subscription.msg_type))
            except Exception as error:  # noqa: BLE001 - the bytes come from anyone, and rclpy raises whatever it meets
                why = f"its bytes do not fit its type ({error})"
        self.unread, self.unreadable = self.unread + 1, why
        return None


class RclpyPublisher:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Publisher` through rclpy."""

    def __init__(self, node: Any, message: str, publisher: Any) -> None:
        self._node, self._message, self._publisher = node, message, publisher
        self.open = True

    def send(self, message: RosMessage) -> None:
        sample = message_types.to_ros(self._message, message)
        if self.open:
            self._publisher.publish(sample)

    def subscribers(self) -> int:
        return int(self._publisher.get_subscription_count()) if self.open else 0

    def close(self) -> None:
        if self.open:
            self.open = False
            self._node.destroy_publisher(self._publisher)
