"""Plausibility checks on the first message of each topic.

Each function returns the content of a message as text, or raises :class:`ImplausibleMessage`.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.event_topics import event_value
from fieldhand.execution.drivers.ros2.images import image_of
from fieldhand.execution.drivers.ros2.message_fields import number_at, value_at
from fieldhand.execution.drivers.ros2.telemetry import MOST_PERCENT, fix_problem
from fieldhand.execution.drivers.ros2.transport import RosMessage
from fieldhand.execution.robot_text import robot_text
from fieldhand.robot.bindings import (
    BatteryBinding,
    EventBinding,
    FieldBinding,
    OdometerBinding,
    PositionBinding,
    StopBinding,
)
from fieldhand.robot.events import MonitoredEvent
from fieldhand.robot.model import Quantity

MessageCheck = Callable[[RosMessage], str]


class ImplausibleMessage(Exception):
    """Raised for a message that a mission cannot use.

    Args:
        what: Reason.
        advice: Recommended action.
    """

    def __init__(self, what: str, advice: str) -> None:
        self.what, self.advice = what, advice
        super().__init__(what)


def position(binding: PositionBinding) -> MessageCheck:
    """Return a check of ``sensor_msgs/msg/NavSatFix`` messages."""

    def check_message(fix: RosMessage) -> str:
        doubt = fix_problem(fix, binding)
        if doubt is not None:
            raise ImplausibleMessage(doubt, "wait for a better fix, or allow more with most_sigma_m in the profile")
        return f"{fix['latitude']:.6f}, {fix['longitude']:.6f}"

    return check_message


def battery(binding: BatteryBinding) -> MessageCheck:
    """Return a check of the charge in percent."""

    def check_message(message: RosMessage) -> str:
        charge = _number(message, binding.value)
        if not 0.0 <= charge <= MOST_PERCENT:
            raise ImplausibleMessage(
                f"{charge:g} % is not a valid charge", "correct unit, scale or path of the battery"
            )
        if 0.0 < charge <= 1.0 and binding.value.scale == 1.0:
            raise ImplausibleMessage(f"{charge:g} % is nearly empty", "if this is a part of 1, set its scale to 100")
        return f"{charge:.0f} %"

    return check_message


def odometry(message: RosMessage) -> str:
    """Check a ``nav_msgs/msg/Odometry`` message."""
    x, y = (_number(message, FieldBinding(path=f"pose.pose.position.{axis}")) for axis in "xy")
    return f"{x:.2f}, {y:.2f} m"


def odometer(binding: OdometerBinding) -> MessageCheck:
    """Return a check of the metres driven in all."""

    def check_message(message: RosMessage) -> str:
        metres = _number(message, binding.value)
        if metres < 0.0:
            raise ImplausibleMessage(f"{metres:g} m is no distance", "correct unit, scale or path of the odometer")
        return f"{metres:.1f} m"

    return check_message


def stop(binding: StopBinding) -> MessageCheck:
    """Return a check of emergency stop messages."""

    def check_message(message: RosMessage) -> str:
        value = value_at(message, binding.path)
        if not isinstance(value, bool):
            raise ImplausibleMessage(
                f"{binding.path} is {robot_text(repr(value))}, neither true nor false", "correct the path of the stop"
            )
        if value == binding.stopped:
            raise ImplausibleMessage("the robot is stopped", "release the emergency stop")
        return "not stopped"

    return check_message


def clock(message: RosMessage) -> str:
    """Check a ``/clock`` message."""
    seconds = value_at(message, "clock.sec")
    return f"{seconds} s"


def reading(binding: FieldBinding, quantity: Quantity) -> MessageCheck:
    """Return a check of the readings of a quantity."""

    def check_message(message: RosMessage) -> str:
        value = _number(message, binding)
        if not quantity.minimum <= value <= quantity.maximum:
            raise ImplausibleMessage(
                f"{value:g} {quantity.unit} is outside of {quantity.minimum:g} to {quantity.maximum:g}",
                "correct the unit, scale or path of this reading, or the range of the quantity",
            )
        return f"{value:g} {quantity.unit}"

    return check_message


def image(name: str) -> MessageCheck:
    """Return a check of images."""

    def check_message(message: RosMessage) -> str:
        try:
            found = image_of(message, name, "the topic")
        except Ros2Error as error:
            raise ImplausibleMessage(error.what, error.advice or "publish another kind of image") from None
        return f"{found.width} x {found.height} pixels, {found.encoding}"

    return check_message


def event(binding: EventBinding, known: MonitoredEvent) -> MessageCheck:
    """Return a check of the messages of an event."""

    def check_message(message: RosMessage) -> str:
        value = event_value(message, binding)
        if value is None:
            found = robot_text(repr(value_at(message, binding.value.path)))
            raise ImplausibleMessage(
                f"{binding.value.path} is {found}, neither true, false nor a number",
                "correct the path of the event",
            )
        if known.unit:
            return f"{value:g} {known.unit}"
        return known.description if value else f"not: {known.description}"

    return check_message


def _number(message: RosMessage, binding: FieldBinding) -> float:
    number = number_at(message, binding)
    if number is None or not math.isfinite(number):
        raise ImplausibleMessage(
            f"{binding.path} is {robot_text(repr(value_at(message, binding.path)))}, no number",
            "check whether the robot measures it, or take another field",
        )
    return number
