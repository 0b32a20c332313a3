"""Telemetry of a robot: position, battery, odometry, emergency stop.

    NavSatFix ──▶ position, lost          Odometry ──▶ metres (without it, along the fixes)
    BatteryState ──▶ charge               emergency stop ──▶ stopped, for good

A value is outdated once its topic was silent for longer than its binding allows. Messages are timed by the steady clock
at which they are taken: the clocks of robot and computer need not agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from fieldhand.execution.drivers.protocol import Position
from fieldhand.execution.drivers.ros2.map_frame import yaw_in
from fieldhand.execution.drivers.ros2.message_fields import number_at, seconds_at, value_at
from fieldhand.execution.drivers.ros2.transport import QosProfile, RosMessage, Subscription, Transport
from fieldhand.execution.robot_text import robot_text
from fieldhand.robot.bindings import FieldBinding, PositionBinding, Ros2Bindings, TopicBinding
from fieldhand.site.projection import Projection

#: No fix (``sensor_msgs/msg/NavSatStatus``); lower values mean that the receiver has not reported yet.
_NO_FIX = -1

#: Distance in metres below which the step between two points is noise and not counted.
_ODOMETRY_STEP_M, _FIX_STEP_M = 0.02, 0.25
#: A step that exceeds this multiple of the robot's speed, plus metres, is a reset of the odometry, not driving.
_JUMP, _JUMP_M = 5.0, 2.0

#: Highest plausible charge in percent: full batteries report somewhat more than 100.
MOST_PERCENT = 105.0
#: Seconds for which fixes must be consistent at a new place before they are accepted: the robot was carried there, or
#: its receiver corrects itself. Until then it is lost; fixes that alternate come from two robots.
JUMPED_S = 3.0
#: Multiple of the standard deviation by which fixes may jump.
_NOISE = 5.0

#: Fields from which the odometry is read.
_ODOMETRY_X, _ODOMETRY_Y = FieldBinding(path="pose.pose.position.x"), FieldBinding(path="pose.pose.position.y")


@dataclass
class TelemetryTopic:
    """A topic and the time of its last valid message.

    Attributes:
        what: Name for people.
        name: Full topic name.
        heard: True once a message was received.
        at_s: Time of the last valid message by the steady clock; None before the first.
        doubt: Reason why the last message was invalid.
    """

    what: str
    name: str
    binding: TopicBinding
    qos: QosProfile
    subscription: Subscription
    received: bool = False
    at_s: float | None = None
    problem: str = ""

    def known(self) -> bool:
        """Return True if the value is known. A transient local topic without a message has not changed yet."""
        kept = self.binding.transient and not self.received
        return self.at_s is not None or (kept and self.subscription.publishers() > 0)

    def take(self) -> tuple[RosMessage, ...]:
        """Return the messages received since the last call."""
        messages = self.subscription.take()
        self.received = self.received or bool(messages)
        return messages

    def silent(self, now: float) -> str | None:
        """Return why the value is unknown or outdated; None if it is current."""
        if self.at_s is None:
            return None if self.known() else self.problem or f"no message on {self.name} yet"
        passed = now - self.at_s
        return f"no message on {self.name} for {passed:.0f} s" if passed > self.binding.stale_s else None


class _Odometer:
    """Distance in metres along successive points."""

    def __init__(self, step_m: float, speed_m_s: float, clock: Callable[[], float]) -> None:
        self.metres = 0.0
        self._step_m, self._speed, self._clock = step_m, speed_m_s, clock
        self._last: tuple[float, float, tuple[float, float]] | None = None
        self.received = 0

    def add(self, xy: tuple[float, float], message: RosMessage) -> None:
        """Add the next point, from a message with a header."""
        self.received += 1
        now, stamp = self._clock(), _stamp_of(message)
        if self._last is None:
            self._last = now, stamp, xy
            return
        since, before_stamp, before = self._last
        step = math.dist(before, xy)
        if step < self._step_m:
            return
        # Messages taken together were not sent together.
        passed = max(now - since, stamp - before_stamp)
        if step <= _JUMP * self._speed * passed + _JUMP_M:
            self.metres += step
        self._last = now, stamp, xy


class _JumpDetector:
    """Detects fixes that a driving robot cannot reach.

    Args:
        slack_m: Distance in metres allowed without any time between two fixes.
        speed_m_s: Speed of the robot in m/s.
        clock: Mission clock in seconds, by which the robot drives.
        steady: Monotonic clock in seconds.
    """

    def __init__(
        self, slack_m: float, speed_m_s: float, clock: Callable[[], float], steady: Callable[[], float]
    ) -> None:
        self._slack_m, self._speed, self._clock, self._steady = slack_m, speed_m_s, clock, steady
        self._last: _Point | None = None
        self._elsewhere: tuple[float, _Point] | None = None

    def jumped_m(self, xy: tuple[float, float], message: RosMessage) -> float:
        """Return the distance in metres of a fix from the accepted ones; 0 if it follows them."""
        point = _Point(self._clock(), _stamp_of(message), xy)
        if self._last is None or self._follows(self._last, point):
            self._last, self._elsewhere = point, None
            return 0.0
        since = self._steady()
        if self._elsewhere is not None and self._follows(self._elsewhere[1], point):
            since = self._elsewhere[0]
        self._elsewhere = since, point
        if self._steady() - since < JUMPED_S:
            return math.dist(self._last.xy, xy)
        self._last, self._elsewhere = point, None
        return 0.0

    def _follows(self, before: _Point, point: _Point) -> bool:
        # Messages taken together were not sent together.
        passed = max(point.taken_s - before.taken_s, point.stamp_s - before.stamp_s)
        return math.dist(before.xy, point.xy) <= _JUMP * self._speed * passed + self._slack_m


@dataclass(frozen=True)
class _Point:
    """A fix: when it was taken, its stamp, and its place."""

    taken_s: float
    stamp_s: float
    xy: tuple[float, float]


class Telemetry:
    """Subscriptions to the robot's state.

    Args:
        transport: Transport of the robot's graph.
        bindings: ROS 2 bindings of the robot.
        projection: Projection of the site.
        speed_m_s: Speed of the robot in m/s, to detect jumps.
        clock: Mission clock in seconds, by which the robot drives.
        steady: Monotonic clock in seconds.

    Raises:
        Ros2Error: A type is unknown.
    """

    def __init__(
        self,
        transport: Transport,
        bindings: Ros2Bindings,
        projection: Projection,
        *,
        speed_m_s: float,
        clock: Callable[[], float],
        steady: Callable[[], float],
    ) -> None:
        self._projection, self._steady, self._position_binding = projection, steady, bindings.position
        self._battery_value, self._stop_binding = bindings.battery.value, bindings.stop

        def topic(what: str, topic: TopicBinding) -> TelemetryTopic:
            name, qos = (
                bindings.whole_name(topic.topic),
                QosProfile(reliable=topic.reliable, transient=topic.transient),
            )
            return TelemetryTopic(what, name, topic, qos, transport.subscribe(name, topic.type, qos))

        self._fix = topic("the position", bindings.position.fix)
        self._battery = topic("the battery", bindings.battery.topic)
        self._odometry = topic("the odometry", bindings.odometry) if bindings.odometry else None
        self._counter = topic("the odometer", bindings.odometer.topic) if bindings.odometer else None
        self._counter_value = bindings.odometer.value if bindings.odometer else None
        self._stop = topic("the emergency stop", bindings.stop.topic) if bindings.stop else None
        slack_m = max(_JUMP_M, _NOISE * bindings.position.most_sigma_m)
        self._jumps = _JumpDetector(slack_m, speed_m_s, clock, steady)
        self._odometer = _Odometer(_ODOMETRY_STEP_M if self._odometry else _FIX_STEP_M, speed_m_s, clock)
        self._frame = bindings.navigation.frame
        #: Yaw of the robot in the map in radians; None if its odometry is not in that frame.
        self.yaw: float | None = None
        self._position: Position | None = None
        self._stamp_s: float | None = None
        self._charge: float | None = None
        self._counted: float | None = None
        self._stopped: str | None = None

    @property
    def metres(self) -> float:
        """Metres driven since construction."""
        return self._odometer.metres

    @property
    def odometry_count(self) -> int:
        """Number of messages that contributed to the odometry."""
        return self._odometer.received

    @property
    def position(self) -> Position | None:
        """Last known position; None before the first fix."""
        return self._position

    @property
    def stamp_s(self) -> float | None:
        """Time of that position in seconds of the robot's clock; None if its message has no stamp."""
        return self._stamp_s

    @property
    def charge_percent(self) -> float | None:
        """Last charge, as reported; None before the first message."""
        return self._charge

    @property
    def odometer_m(self) -> float | None:
        """Last reading of the odometer, which counts all metres; None if there is none, or it is silent."""
        silent = self._counter is None or self._counter.silent(self._steady()) is not None
        return None if silent else self._counted

    @property
    def all(self) -> tuple[TelemetryTopic, ...]:
        """All subscribed topics."""
        return tuple(s for s in (self._fix, self._battery, self._odometry, self._counter, self._stop) if s is not None)

    def listen(self) -> None:
        """Process the received messages."""
        now = self._steady()
        for message in self._fix.take():
            self._receive_fix(message, now)
        for message in self._battery.take():
            self._receive_battery(message, now)
        for message in self._odometry.take() if self._odometry else ():
            self._receive_odometry(message, now)
        for message in self._counter.take() if self._counter else ():
            self._receive_counter(message, now)
        for message in self._stop.take() if self._stop else ():
            self._receive_stop(message, now)

    def lost(self) -> str | None:
        """Return why the robot's position is unknown; None if it is known."""
        return self._fix.problem or self._fix.silent(self._steady())

    def silent(self) -> str | None:
        """Return why no goal can run: battery, emergency stop or odometry is silent; None if all report."""
        now = self._steady()
        for topic in (self._battery, self._stop, self._odometry):
            if topic is not None and (why := topic.silent(now)) is not None:
                return f"{topic.what} is silent: {why}"
        return None

    def stopped(self) -> str | None:
        """Return why the robot will not move again: its emergency stop was pressed, even if released since."""
        return self._stopped

    def close(self) -> None:
        """Close all subscriptions."""
        for topic in self.all:
            topic.subscription.close()

    def _receive_fix(self, message: RosMessage, now: float) -> None:
        problem = fix_problem(message, self._position_binding)
        self._fix.problem = problem or ""
        if problem is not None:
            return
        lat, lon = message["latitude"], message["longitude"]
        assert isinstance(lat, float)  # noqa: S101  else it was doubted
        assert isinstance(lon, float)  # noqa: S101
        x, y = (float(v) for v in self._projection.metres(lat, lon)[0])
        if (jumped_m := self._jumps.jumped_m((x, y), message)) > 0.0:
            self._fix.problem = f"the position jumped by {jumped_m:.0f} m, farther than the robot drives in that time"
            return
        self._fix.at_s = now
        self._position = Position(x=x, y=y, lat=lat, lon=lon)
        self._stamp_s = seconds_at(message, "header.stamp")
        if self._odometry is None:
            self._odometer.add((x, y), message)

    def _receive_battery(self, message: RosMessage, now: float) -> None:
        charge = number_at(message, self._battery_value)
        if charge is None:
            # Batteries report NaN for values they do not measure.
            self._battery.problem = f"it has no number at {self._battery_value.path}"
        elif not 0.0 <= charge <= MOST_PERCENT:
            advice = "correct its scale or unit in the profile's ros2 part"
            self._battery.problem = f"it says {charge:g} percent, which is not a valid charge; {advice}"
        else:
            self._charge, self._battery.at_s = charge, now

    def _receive_odometry(self, message: RosMessage, now: float) -> None:
        assert self._odometry is not None  # noqa: S101  asked for by who has one
        x, y = number_at(message, _ODOMETRY_X), number_at(message, _ODOMETRY_Y)
        if x is not None and y is not None:
            self._odometry.at_s = now
            self._odometer.add((x, y), message)
            if value_at(message, "header.frame_id") == self._frame:
                self.yaw = yaw_in(message, "pose.pose.orientation")

    def _receive_counter(self, message: RosMessage, now: float) -> None:
        assert self._counter is not None  # noqa: S101  asked for by who has one
        assert self._counter_value is not None  # noqa: S101
        metres = number_at(message, self._counter_value)
        if metres is None:
            self._counter.problem = f"it has no number at {self._counter_value.path}"
        else:
            self._counted, self._counter.at_s = metres, now

    def _receive_stop(self, message: RosMessage, now: float) -> None:
        assert self._stop is not None  # noqa: S101  asked for by who has one
        assert self._stop_binding is not None  # noqa: S101
        value = value_at(message, self._stop_binding.path)
        if not isinstance(value, bool):
            # An unreadable emergency stop must not pass for one that is not pressed.
            self._stop.problem = f"{self._stop_binding.path} is {robot_text(repr(value))}, neither true nor false"
            return
        self._stop.at_s = now
        if value == self._stop_binding.stopped:
            self._stopped = f"the emergency stop was pressed ({self._stop.name})"


def _stamp_of(message: RosMessage) -> float:
    """Return the stamp of a message's header in seconds; 0 if it has none."""
    return seconds_at(message, "header.stamp") or 0.0


def fix_problem(fix: RosMessage, binding: PositionBinding) -> str | None:
    """Return why a ``sensor_msgs/msg/NavSatFix`` gives no usable position; None if it does."""
    lat, lon, status = fix.get("latitude"), fix.get("longitude"), value_at(fix, "status.status")
    if status == _NO_FIX or not isinstance(lat, float) or not isinstance(lon, float):
        return "no satellite fix"
    if not (abs(lat) <= 90.0 and abs(lon) <= 180.0):  # also excludes NaN
        return "no satellite fix"
    covariance, known = fix.get("position_covariance"), fix.get("position_covariance_type")
    if isinstance(covariance, tuple) and len(covariance) == 9 and isinstance(known, int) and known > 0:
        worse = max(float(covariance[0]), float(covariance[4]))
        if not worse <= binding.most_sigma_m**2:
            sigma = f"{math.sqrt(worse):.1f} m" if worse >= 0 else "an unknown amount"
            return f"the position is uncertain by {sigma}, at most {binding.most_sigma_m:g} m are allowed"
        return None
    return None if isinstance(status, int) and status > _NO_FIX else "no satellite fix"
