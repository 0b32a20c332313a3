"""What the robot says of itself without being asked: where it is, its battery, its odometry, its emergency stop.

    NavSatFix ──▶ position, lost          Odometry ──▶ metres (without it, along the fixes)
    BatteryState ──▶ charge               emergency stop ──▶ stopped, for good

A topic that has been silent for longer than its binding allows is not believed any more. Times are those of the steady
clock at which messages are taken: the clocks of robot and computer need not agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from fieldhand.execution.drivers.protocol import Position
from fieldhand.execution.drivers.ros2.message_fields import number_at, seconds_at, value_at
from fieldhand.execution.drivers.ros2.transport import Message, QosProfile, Subscription, Transport
from fieldhand.robot.bindings import FieldBinding, PositionBinding, Ros2Bindings, TopicBinding
from fieldhand.site.projection import Projection

#: ``sensor_msgs/msg/NavSatStatus``: no fix; below it, the receiver has not said.
_NO_FIX = -1

#: Metres that two points must be apart for the way between them to count: what is less is noise.
_ODOMETRY_STEP_M, _FIX_STEP_M = 0.02, 0.25
#: A step that would have taken more than that many times the robot's speed is no driving: the odometry was set anew.
_JUMP, _JUMP_M = 5.0, 2.0

#: Percent: batteries that are full say somewhat more than 100.
MOST_PERCENT = 105.0
#: Seconds for which fixes must follow each other elsewhere until they are believed: the robot was carried there, or its
#: receiver corrects itself. Until then it is lost: one that jumps to and fro is two robots, or none.
JUMPED_S = 3.0
#: Times the standard deviation that is allowed: so much fixes may jump.
_NOISE = 5.0

#: Where metres are counted.
_ODOMETRY_X, _ODOMETRY_Y = FieldBinding(path="pose.pose.position.x"), FieldBinding(path="pose.pose.position.y")


@dataclass
class TelemetryTopic:
    """A topic, and when it said something.

    Attributes:
        what: What it is to people.
        name: Its whole name.
        heard: A message came.
        at_s: When the last one came that said something, by the steady clock; None before the first.
        doubt: Why the last message said nothing.
    """

    what: str
    name: str
    binding: TopicBinding
    qos: QosProfile
    subscription: Subscription
    heard: bool = False
    at_s: float | None = None
    doubt: str = ""

    def known(self) -> bool:
        """Whether it has said something. What is kept for who comes late, and never was sent, never changed."""
        kept = self.binding.transient and not self.heard
        return self.at_s is not None or (kept and self.subscription.publishers() > 0)

    def take(self) -> tuple[Message, ...]:
        """What has arrived."""
        messages = self.subscription.take()
        self.heard = self.heard or bool(messages)
        return messages

    def silent(self, now: float) -> str | None:
        """Why nothing is known any more; None while something is."""
        if self.at_s is None:
            return None if self.known() else self.doubt or f"nothing came on {self.name} yet"
        passed = now - self.at_s
        return f"nothing came on {self.name} for {passed:.0f} s" if passed > self.binding.stale_s else None


class _Odometer:
    """Metres along points that follow each other."""

    def __init__(self, step_m: float, speed_m_s: float, clock: Callable[[], float]) -> None:
        self.metres = 0.0
        self._step_m, self._speed, self._clock = step_m, speed_m_s, clock
        self._last: tuple[float, float, tuple[float, float]] | None = None
        self.heard = 0

    def add(self, xy: tuple[float, float], message: Message) -> None:
        """The next point, from a message with a header."""
        self.heard += 1
        now, stamp = self._clock(), _stamp_of(message)
        if self._last is None:
            self._last = now, stamp, xy
            return
        since, before_stamp, before = self._last
        step = math.dist(before, xy)
        if step < self._step_m:
            return
        # Messages that were taken together were not sent together.
        passed = max(now - since, stamp - before_stamp)
        if step <= _JUMP * self._speed * passed + _JUMP_M:
            self.metres += step
        self._last = now, stamp, xy


class _JumpDetector:
    """Whether fixes follow each other as a robot drives.

    Args:
        slack_m: Metres that they may be apart without any time between.
        speed_m_s: Of the robot.
        clock: In whose seconds it drives as fast as that.
        steady: Seconds that pass whatever that does.
    """

    def __init__(
        self, slack_m: float, speed_m_s: float, clock: Callable[[], float], steady: Callable[[], float]
    ) -> None:
        self._slack_m, self._speed, self._clock, self._steady = slack_m, speed_m_s, clock, steady
        self._last: _Point | None = None
        self._elsewhere: tuple[float, _Point] | None = None

    def jumped_m(self, xy: tuple[float, float], message: Message) -> float:
        """How far away a fix lies from those that are believed; 0 where it follows them."""
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
        # Messages that were taken together were not sent together.
        passed = max(point.taken_s - before.taken_s, point.stamp_s - before.stamp_s)
        return math.dist(before.xy, point.xy) <= _JUMP * self._speed * passed + self._slack_m


@dataclass(frozen=True)
class _Point:
    """Where a fix lies, when it was taken, and when it was made."""

    taken_s: float
    stamp_s: float
    xy: tuple[float, float]


class Telemetry:
    """Listens to a robot.

    Args:
        transport: Carries its messages.
        bindings: Which topics say what.
        projection: Of the site.
        speed_m_s: Of the robot: a jump of its odometry is no driving.
        clock: In whose seconds it drives as fast as that.
        steady: Seconds that pass whatever the mission's clock does.

    Raises:
        Ros2Error: A type is not known.
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
        self._stop = topic("the emergency stop", bindings.stop.topic) if bindings.stop else None
        slack_m = max(_JUMP_M, _NOISE * bindings.position.most_sigma_m)
        self._jumps = _JumpDetector(slack_m, speed_m_s, clock, steady)
        self._odometer = _Odometer(_ODOMETRY_STEP_M if self._odometry else _FIX_STEP_M, speed_m_s, clock)
        self._position: Position | None = None
        self._stamp_s: float | None = None
        self._charge: float | None = None
        self._stopped: str | None = None

    @property
    def metres(self) -> float:
        """Driven since this was made."""
        return self._odometer.metres

    @property
    def metres_heard(self) -> int:
        """How many messages have told of metres."""
        return self._odometer.heard

    @property
    def position(self) -> Position | None:
        """The last that was known; None before the first."""
        return self._position

    @property
    def stamp_s(self) -> float | None:
        """Return when that position was measured, in seconds of the robot's clock; None if its message does not say."""
        return self._stamp_s

    @property
    def charge_percent(self) -> float | None:
        """The last that was said, as it was said; None before the first."""
        return self._charge

    @property
    def all(self) -> tuple[TelemetryTopic, ...]:
        """Every topic that is listened to."""
        return tuple(s for s in (self._fix, self._battery, self._odometry, self._stop) if s is not None)

    def listen(self) -> None:
        """Take what has arrived."""
        now = self._steady()
        for message in self._fix.take():
            self._hear_fix(message, now)
        for message in self._battery.take():
            self._hear_battery(message, now)
        for message in self._odometry.take() if self._odometry else ():
            self._hear_odometry(message, now)
        for message in self._stop.take() if self._stop else ():
            self._hear_stop(message, now)

    def lost(self) -> str | None:
        """Why the robot does not know where it is; None while it does."""
        return self._fix.doubt or self._fix.silent(self._steady())

    def silent(self) -> str | None:
        """Why no goal can be carried out: the battery, the emergency stop, or what counts metres is silent."""
        now = self._steady()
        for topic in (self._battery, self._stop, self._odometry):
            if topic is not None and (why := topic.silent(now)) is not None:
                return f"{topic.what} is silent: {why}"
        return None

    def stopped(self) -> str | None:
        """Why the robot will not move again: its emergency stop was pressed, even if it was released since."""
        return self._stopped

    def close(self) -> None:
        """End it."""
        for topic in self.all:
            topic.subscription.close()

    def _hear_fix(self, message: Message, now: float) -> None:
        doubt = fix_problem(message, self._position_binding)
        self._fix.doubt = doubt or ""
        if doubt is not None:
            return
        lat, lon = message["latitude"], message["longitude"]
        assert isinstance(lat, float)  # noqa: S101  else it was doubted
        assert isinstance(lon, float)  # noqa: S101
        x, y = (float(v) for v in self._projection.metres(lat, lon)[0])
        if (jumped_m := self._jumps.jumped_m((x, y), message)) > 0.0:
            self._fix.doubt = f"the position jumped by {jumped_m:.0f} m, farther than the robot drives in that time"
            return
        self._fix.at_s = now
        self._position = Position(x=x, y=y, lat=lat, lon=lon)
        self._stamp_s = seconds_at(message, "header.stamp")
        if self._odometry is None:
            self._odometer.add((x, y), message)

    def _hear_battery(self, message: Message, now: float) -> None:
        charge = number_at(message, self._battery_value)
        if charge is None:
            # NaN is what a battery says that does not measure: it has said nothing.
            self._battery.doubt = f"it says no number at {self._battery_value.path}"
        elif not 0.0 <= charge <= MOST_PERCENT:
            advice = "correct its scale or unit in the profile's ros2 part"
            self._battery.doubt = f"it says {charge:g} percent, which is no charge; {advice}"
        else:
            self._charge, self._battery.at_s = charge, now

    def _hear_odometry(self, message: Message, now: float) -> None:
        assert self._odometry is not None  # noqa: S101  asked for by who has one
        x, y = number_at(message, _ODOMETRY_X), number_at(message, _ODOMETRY_Y)
        if x is not None and y is not None:
            self._odometry.at_s = now
            self._odometer.add((x, y), message)

    def _hear_stop(self, message: Message, now: float) -> None:
        assert self._stop is not None  # noqa: S101  asked for by who has one
        assert self._stop_binding is not None  # noqa: S101
        value = value_at(message, self._stop_binding.path)
        if not isinstance(value, bool):
            # Else one that nobody can read would pass for one that is not pressed.
            self._stop.doubt = f"{self._stop_binding.path} is {value!r}, neither true nor false"
            return
        self._stop.at_s = now
        if value == self._stop_binding.stopped:
            self._stopped = f"the emergency stop was pressed ({self._stop.name})"


def _stamp_of(message: Message) -> float:
    """Return the seconds of a message's header; 0 where it has none."""
    return seconds_at(message, "header.stamp") or 0.0


def fix_problem(fix: Message, binding: PositionBinding) -> str | None:
    """Why a ``sensor_msgs/msg/NavSatFix`` does not say where the robot is; None where it does."""
    lat, lon, status = fix.get("latitude"), fix.get("longitude"), value_at(fix, "status.status")
    if status == _NO_FIX or not isinstance(lat, float) or not isinstance(lon, float):
        return "no satellite fix"
    if not (abs(lat) <= 90.0 and abs(lon) <= 180.0):  # NaN is not, either
        return "no satellite fix"
    covariance, known = fix.get("position_covariance"), fix.get("position_covariance_type")
    if isinstance(covariance, tuple) and len(covariance) == 9 and isinstance(known, int) and known > 0:
        worse = max(float(covariance[0]), float(covariance[4]))
        if not worse <= binding.most_sigma_m**2:
            sigma = f"{math.sqrt(worse):.1f} m" if worse >= 0 else "nobody knows what"
            return f"the position is uncertain by {sigma}, at most {binding.most_sigma_m:g} m are allowed"
        return None
    return None if isinstance(status, int) and status > _NO_FIX else "no satellite fix"
