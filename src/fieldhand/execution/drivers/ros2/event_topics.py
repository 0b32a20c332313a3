"""Events of a robot over ROS 2: one topic each, as the profile binds them.

An event is unknown while no valid message came for longer than its binding allows. Messages are timed by the steady
clock at which they are taken.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

from fieldhand.execution.drivers.ros2.message_fields import number_at, value_at
from fieldhand.execution.drivers.ros2.telemetry import TelemetryTopic
from fieldhand.execution.drivers.ros2.transport import QosProfile, RosMessage, Transport
from fieldhand.robot.bindings import EventBinding, Ros2Bindings


@dataclass
class _Heard:
    """A topic, its binding, and the last value that it gave."""

    topic: TelemetryTopic
    binding: EventBinding
    value: float | None = None


class EventTopics:
    """Subscriptions to the events that a mission watches.

    Args:
        transport: Transport of the robot's graph.
        bindings: ROS 2 bindings of the robot.
        steady: Monotonic clock in seconds.
        only: Names of the events; None for all that the profile binds.

    Raises:
        Ros2Error: A type is unknown.
    """

    def __init__(
        self,
        transport: Transport,
        bindings: Ros2Bindings,
        *,
        steady: Callable[[], float],
        only: Collection[str] | None = None,
    ) -> None:
        self._steady = steady
        self._heard: dict[str, _Heard] = {}
        for name, bound in bindings.events.items():
            if only is not None and name not in only:
                continue
            full = bindings.whole_name(bound.topic.topic)
            qos = QosProfile(reliable=bound.topic.reliable, transient=bound.topic.transient)
            subscription = transport.subscribe(full, bound.topic.type, qos)
            topic = TelemetryTopic(f"the event {name}", full, bound.topic, qos, subscription)
            self._heard[name] = _Heard(topic=topic, binding=bound)

    @property
    def all(self) -> tuple[TelemetryTopic, ...]:
        """All subscribed topics."""
        return tuple(heard.topic for heard in self._heard.values())

    def listen(self) -> None:
        """Process the received messages."""
        for heard in self._heard.values():
            for message in heard.topic.take():
                value = event_value(message, heard.binding)
                if value is None:
                    heard.topic.problem = f"it has no value at {heard.binding.value.path}"
                else:
                    heard.value, heard.topic.at_s = value, self._steady()

    def values(self) -> dict[str, float | None]:
        """Return the value of each event; None if its topic is silent."""
        now = self._steady()
        silent = {name: heard.topic.at_s is None or heard.topic.silent(now) for name, heard in self._heard.items()}
        return {name: None if silent[name] else heard.value for name, heard in self._heard.items()}

    def close(self) -> None:
        """Close all subscriptions."""
        for topic in self.all:
            topic.subscription.close()


def event_value(message: RosMessage, binding: EventBinding) -> float | None:
    """Return the value of an event in a message: 1 or 0, or that of a measured event; None if it has none."""
    found = value_at(message, binding.value.path)
    if isinstance(found, bool):
        number: float | None = float(found)
    elif isinstance(found, tuple | list):
        number = float(len(found))
    else:
        number = number_at(message, binding.value)
    if number is None:
        return None
    if binding.equals is not None:
        return float(number == binding.equals)
    if binding.above is not None:
        return float(number > binding.above)
    if binding.below is not None:
        return float(number < binding.below)
    return number
