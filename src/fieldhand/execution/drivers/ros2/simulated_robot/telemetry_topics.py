"""Telemetry topics of the simulated robot: battery, fix, odometry, emergency stop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.map_frame import orientation
from fieldhand.execution.drivers.ros2.message_fields import message_of
from fieldhand.execution.drivers.ros2.simulated_robot.field_values import field_value, with_header
from fieldhand.execution.drivers.ros2.simulated_robot.robot_platform import SimulatedPlatform
from fieldhand.execution.drivers.ros2.transport import Publisher, QosProfile, RosMessage, Transport
from fieldhand.robot.bindings import EventBinding, Ros2Bindings, TopicBinding

#: Seconds between two messages of each topic.
_FIX_S, _ODOMETRY_S, _BATTERY_S, _STOP_S, _EVENT_S = 0.1, 0.05, 1.0, 0.5, 0.2
_ODOMETER_S = 0.2
#: Status of a receiver with corrections and of one without a fix (``sensor_msgs/msg/NavSatStatus``); standard deviation
#: of the former in metres east, north and up.
_CORRECTED, _NO_FIX = 2, -1
_SIGMA_M = (0.01, 0.01, 0.02)
_UNKNOWN, _DIAGONAL = 0, 2
_DISCHARGING = 2


@dataclass
class _Sent:
    """A topic and the time of its last message.

    Attributes:
        kept: True for transient local topics, which are sent even without subscribers.
    """

    publisher: Publisher
    transient: bool
    every_s: float
    message: Callable[[], RosMessage | None]
    sent_s: float = -math.inf


class TelemetryTopics:
    """Publishes the telemetry.

    Args:
        transport, interfaces: Transport and definitions for the messages.
        bindings: ROS 2 bindings of the robot.
        platform: Source of the values.
        stamped: Returns a header for a frame name.

    Raises:
        Ros2Error: A type is unknown, or lacks the bound field.
    """

    def __init__(
        self,
        transport: Transport,
        interfaces: Interfaces,
        bindings: Ros2Bindings,
        platform: SimulatedPlatform,
        *,
        stamped: Callable[[str], RosMessage],
    ) -> None:
        self._interfaces, self._bindings, self._platform, self._stamped = interfaces, bindings, platform, stamped

        def sent(topic: TopicBinding, every_s: float, message: Callable[[], RosMessage | None]) -> _Sent:
            qos = QosProfile(reliable=True, transient=topic.transient)
            publisher = transport.publish(bindings.whole_name(topic.topic), topic.type, qos)
            return _Sent(publisher, topic.transient, every_s, message)

        interfaces.field_at(bindings.battery.topic.type, bindings.battery.value.path)
        self._topics = [
            sent(bindings.position.fix, _FIX_S, self._fix),
            sent(bindings.battery.topic, _BATTERY_S, self._battery),
        ]
        if bindings.odometry is not None:
            self._topics.append(sent(bindings.odometry, _ODOMETRY_S, self._odometry))
        if bindings.odometer is not None:
            interfaces.field_at(bindings.odometer.topic.type, bindings.odometer.value.path)
            self._topics.append(sent(bindings.odometer.topic, _ODOMETER_S, self._odometer))
        if bindings.stop is not None:
            interfaces.field_at(bindings.stop.topic.type, bindings.stop.path)
            self._topics.append(sent(bindings.stop.topic, _STOP_S, self._stop))
        for name, event in bindings.events.items():
            interfaces.field_at(event.topic.type, event.value.path)
            self._topics.append(sent(event.topic, _EVENT_S, partial(self._event, name, event)))

    @staticmethod
    def topics(bindings: Ros2Bindings) -> frozenset[str]:
        """Return the full names of the telemetry topics."""
        stop = None if bindings.stop is None else bindings.stop.topic
        events = (event.topic for event in bindings.events.values())
        odometer = None if bindings.odometer is None else bindings.odometer.topic
        bound = (bindings.position.fix, bindings.battery.topic, bindings.odometry, odometer, stop, *events)
        return frozenset(bindings.whole_name(topic.topic) for topic in bound if topic is not None)

    def step(self, now: float) -> None:
        """Publish what is due."""
        for topic in self._topics:
            if now - topic.sent_s >= topic.every_s:
                topic.sent_s = now
                if topic.transient or topic.publisher.subscribers():
                    message = topic.message()
                    if message is not None:
                        topic.publisher.send(message)

    def _fix(self) -> RosMessage:
        at, lost = self._platform.fix, self._platform.lost
        variances = [0.0] * 9
        if not lost:
            variances[0], variances[4], variances[8] = (max(sigma, self._platform.noise_m) ** 2 for sigma in _SIGMA_M)
        return {
            "header": self._stamped("gps"),
            "status": {"status": _NO_FIX if lost else _CORRECTED, "service": 1},
            "latitude": math.nan if lost else at.lat,
            "longitude": math.nan if lost else at.lon,
            "altitude": math.nan if lost else 0.0,
            "position_covariance": tuple(variances),
            "position_covariance_type": _UNKNOWN if lost else _DIAGONAL,
        }

    def _battery(self) -> RosMessage:
        binding = self._bindings.battery
        message: RosMessage = {}
        if binding.topic.type == "sensor_msgs/msg/BatteryState":
            unmeasured = ("voltage", "temperature", "current", "charge", "capacity", "design_capacity")
            message = {"power_supply_status": _DISCHARGING, "present": True, **dict.fromkeys(unmeasured, math.nan)}
        charge = field_value(self._interfaces, binding.topic.type, binding.value, self._platform.charge_percent)
        message = {**message, **message_of({binding.value.path: charge})}
        return with_header(self._interfaces, binding.topic.type, message, self._stamped("base_link"))

    def _odometry(self) -> RosMessage:
        east, north = self._platform.odometry
        yaw = math.radians(90.0 - self._platform.heading_deg)
        return {
            "header": self._stamped("odom"),
            "child_frame_id": "base_link",
            "pose": {
                "pose": {
                    "position": {"x": east, "y": north, "z": 0.0},
                    "orientation": orientation(yaw),
                }
            },
            "twist": {"twist": {"linear": {"x": self._platform.speed_m_s, "y": 0.0, "z": 0.0}}},
        }

    def _odometer(self) -> RosMessage:
        binding = self._bindings.odometer
        assert binding is not None  # noqa: S101  sent only where there is one
        metres = field_value(self._interfaces, binding.topic.type, binding.value, self._platform.metres)
        message = message_of({binding.value.path: metres})
        return with_header(self._interfaces, binding.topic.type, message, self._stamped("base_link"))

    def _stop(self) -> RosMessage:
        binding = self._bindings.stop
        assert binding is not None  # noqa: S101  sent only where there is one
        pressed = self._platform.stopped is not None
        message = message_of({binding.path: binding.stopped if pressed else not binding.stopped})
        return with_header(self._interfaces, binding.topic.type, message, self._stamped("base_link"))

    def _event(self, name: str, binding: EventBinding) -> RosMessage | None:
        """Return the message of an event; None if its sensor is silent."""
        value = self._platform.events().get(name)
        if value is None:
            return None
        type_name, path = binding.topic.type, binding.value.path
        if self._interfaces.field_at(type_name, path).many != "one":
            content: object = ({},) if value else ()
        else:
            content = field_value(self._interfaces, type_name, binding.value, _reported(binding, value))
        return with_header(self._interfaces, type_name, message_of({path: content}), self._stamped("base_link"))


def _reported(binding: EventBinding, value: float) -> float:
    """Return a value that a binding reads as an event that holds (1) or not (0), or as the value of a measured one."""
    if binding.equals is not None:
        return binding.equals if value else float(not binding.equals)
    if binding.above is not None:
        return binding.above + (1.0 if value else -1.0)
    if binding.below is not None:
        return binding.below + (-1.0 if value else 1.0)
    return value
