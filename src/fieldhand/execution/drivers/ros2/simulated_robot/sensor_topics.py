"""Topics from which a profile reads quantities.

A sensor without a call measures once whenever the robot has stopped, and repeats that value until the robot moves. A
sensor with a call publishes what the capture of that call has measured. A simulated fault that silences a sensor lasts
longer than any client waits, so exactly one capture fails by it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.message_fields import message_of
from fieldhand.execution.drivers.ros2.simulated_robot.field_values import field_value, with_header
from fieldhand.execution.drivers.ros2.transport import Publisher, QosProfile, RosMessage, Transport
from fieldhand.robot.bindings import NextMessage, Ros2Bindings

#: Seconds between two messages; duration of a sensor's silence as a multiple of the client's time limit.
_PERIOD_S, _LONGER = 0.5, 1.5


@dataclass
class _SensorTopic:
    """A topic with the quantities in its messages."""

    type: str
    publisher: Publisher
    values: dict[str, NextMessage] = field(default_factory=dict)
    sent_s: float = float("-inf")


class SensorTopics:
    """Publishes the topics.

    Args:
        transport, interfaces: Transport and definitions for the messages.
        bindings: ROS 2 bindings of the robot.
        taken: Names of the topics that carry telemetry.
        measure: Returns the readings of an action's sensors at the robot's position; a failure gives none.
        header: Returns a header with the current time.

    Raises:
        Ros2Error: A type is unknown or lacks the field, or a topic is bound with two types.
    """

    def __init__(
        self,
        transport: Transport,
        interfaces: Interfaces,
        bindings: Ros2Bindings,
        *,
        taken: frozenset[str],
        measure: Callable[[str], Mapping[str, float]],
        header: Callable[[], RosMessage],
    ) -> None:
        self._interfaces, self._bindings, self._measure, self._header = interfaces, bindings, measure, header
        self._sensors: dict[str, _SensorTopic] = {}
        self._streaming = [name for name, bound in bindings.actions.items() if bound.call is None and bound.topics]
        self._readings: dict[str, float] = {}
        self._silent_s: dict[str, float] = {}
        self._measured: set[str] = set()
        for bound in bindings.actions.values():
            for quantity, message in bound.topics.items():
                topic = bindings.whole_name(message.topic)
                if topic in taken:
                    raise Ros2Error(
                        f"{topic} carries telemetry, but {quantity} is read from it, too",
                        advice="the simulated robot cannot publish both on one topic; bind the quantity to another",
                    )
                feed = self._sensors.get(topic)
                if feed is None:
                    qos = QosProfile(reliable=True)
                    feed = _SensorTopic(type=message.type, publisher=transport.publish(topic, message.type, qos))
                    self._sensors[topic] = feed
                if feed.type != message.type:
                    raise Ros2Error(f"{topic} is bound as {feed.type} and as {message.type}")
                interfaces.field_at(message.type, message.value.path)
                feed.values[quantity] = message

    @property
    def shortest_wait_s(self) -> float:
        """Shortest time limit of any client, in seconds; infinite if there is none."""
        return min((m.within_s for feed in self._sensors.values() for m in feed.values.values()), default=float("inf"))

    def captured(self, action: str, readings: Mapping[str, float], now: float) -> None:
        """Publish the readings of a finished capture from now on. Clients of a silent sensor start waiting only now."""
        for silent in self._silent_s:
            self._silent_s[silent] = now + self._silence_s(silent)
        for quantity in self._bindings.actions[action].topics:
            self._readings.pop(quantity, None)
            if quantity in readings:
                self._readings[quantity] = readings[quantity]

    def step(self, now: float, standing: bool) -> None:
        """Measure and publish what is due.

        Args:
            standing: True while the robot stands still.
        """
        if not standing:
            self._readings.clear()
            self._silent_s.clear()
            self._measured.clear()
            return
        for action in self._streaming:
            if self._wanted(action) and (action not in self._measured or now >= self._silent_s.get(action, now + 1.0)):
                self._measure_action(action, now)
        for feed in self._sensors.values():
            if now - feed.sent_s >= _PERIOD_S and all(quantity in self._readings for quantity in feed.values):
                self._send(feed, now)

    def _wanted(self, action: str) -> bool:
        """Return True if a topic of the action has subscribers; before, nothing is measured and no fault is used up."""
        topics = (self._bindings.whole_name(m.topic) for m in self._bindings.actions[action].topics.values())
        return any(self._sensors[topic].publisher.subscribers() for topic in topics)

    def _measure_action(self, action: str, now: float) -> None:
        topics = self._bindings.actions[action].topics
        readings = self._measure(action)
        self._measured.add(action)
        self._silent_s.pop(action, None)
        for quantity in topics:
            if quantity in readings:
                self._readings[quantity] = readings[quantity]
        if any(quantity not in readings for quantity in topics):
            self._silent_s[action] = now + self._silence_s(action)

    def _silence_s(self, action: str) -> float:
        """Return a duration in seconds that is longer than any client waits for the action's messages."""
        return _LONGER * max(message.within_s for message in self._bindings.actions[action].topics.values())

    def _send(self, feed: _SensorTopic, now: float) -> None:
        feed.sent_s = now
        values = {
            binding.value.path: field_value(self._interfaces, feed.type, binding.value, self._readings[quantity])
            for quantity, binding in feed.values.items()
        }
        if None not in values.values():
            message = with_header(self._interfaces, feed.type, message_of(values), self._header())
            feed.publisher.send(message)
