"""Mission clock that follows ``/clock`` of a simulated robot, as ROS nodes do with ``use_sim_time``.

It runs at the simulation's pace, stops while the simulation is paused, and never goes back when the simulation
restarts: elapsed time is kept. If the simulation disappears, the clock continues in real time, so that waiting for a
killed robot ends.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

from fieldhand.compatibility import Self
from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.transport import QosProfile, Transport
from fieldhand.language import message

TOPIC, TYPE = "/clock", "rosgraph_msgs/msg/Clock"

#: Seconds of the wall clock: between two polls, longest single wait, and interval over which the pace is measured.
_LOOK_S, _WAIT_S, _PACE_S = 0.01, 0.1, 0.5
#: Lower bound of the assumed pace: a paused simulation is expected to continue.
_SLOWEST = 0.01


class RosClock:
    """A :class:`~fieldhand.clock.PacedClock` that follows ``/clock``.

    Args:
        transport: Transport of the robot's graph.
        steady: Monotonic clock in seconds.
        sleep: Sleeps for the given seconds of that clock.
    """

    def __init__(
        self,
        transport: Transport,
        *,
        steady: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        # A best-effort reader matches writers of either kind; only the newest message counts.
        self._topic = transport.subscribe(TOPIC, TYPE, QosProfile(reliable=False, depth=1))
        self._transport, self._steady, self._sleep = transport, steady, sleep
        self._last_s: float | None = None
        self._passed_s = 0.0
        self._pace = 1.0
        self._measured = (steady(), 0.0)
        self._alone_s: float | None = None

    @classmethod
    def wait_for_first(
        cls,
        transport: Transport,
        within_s: float,
        *,
        steady: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> Self:
        """Wait for the first message on ``/clock`` from a single publisher and return the clock.

        Args:
            transport, steady, sleep: As for the constructor.
            within_s: Seconds of the steady clock to wait.

        Raises:
            Ros2Error: There was no message, or several publishers.
        """
        clock = cls(transport, steady=steady, sleep=sleep)
        until_s = steady() + within_s
        while not clock.known or len({peer.participant for peer in transport.writers_of(TOPIC)}) > 1:
            if steady() >= until_s and clock.known:
                raise Ros2Error(
                    f"several simulations publish {TOPIC}",
                    where=transport.name,
                    advice="give each a ROS_DOMAIN_ID of its own: a namespace does not separate them",
                )
            if steady() >= until_s:
                offered = any(peer.type != TYPE for peer in transport.writers_of(TOPIC))
                why = "is of another type" if offered else "is silent"
                raise Ros2Error(
                    f"{TOPIC} {why}, but the robot's time is taken from it ({TYPE})",
                    where=transport.name,
                    advice="start the simulation, or leave use_sim_time out for a robot in real time",
                )
            sleep(_LOOK_S)
        return clock

    @property
    def known(self) -> bool:
        """True once a message was received."""
        self._receive()
        return self._last_s is not None

    @property
    def speed(self) -> float:
        """Seconds that pass here in one second of the wall clock, as last measured."""
        return max(_SLOWEST, self._pace)

    def now(self) -> float:
        """Return the seconds since the first message."""
        self._receive()
        return self._passed_s

    def advance(self, seconds: float) -> None:
        """Wait until the given seconds have passed, at most 0.1 s of the wall clock: the simulation may be paused."""
        until_s, until_wall_s = self.now() + seconds, self._steady() + _WAIT_S
        while self.now() < until_s and self._steady() < until_wall_s:
            self._sleep(_LOOK_S)

    def _receive(self) -> None:
        messages = self._topic.take()
        if not messages:
            if self._last_s is not None and self._topic.publishers() == 0:
                self._continue_alone()
            return
        stamp_s = _seconds(messages[-1]["clock"])
        if self._last_s is not None and self._alone_s is None:
            self._passed_s += max(0.0, stamp_s - self._last_s)
        self._last_s, self._alone_s = stamp_s, None
        wall_s, (from_wall_s, from_s) = self._steady(), self._measured
        if wall_s - from_wall_s >= _PACE_S:
            self._pace = (self._passed_s - from_s) / (wall_s - from_wall_s)
            self._measured = wall_s, self._passed_s

    def _continue_alone(self) -> None:
        """Advance in real time after the publisher has disappeared."""
        wall_s = self._steady()
        if self._alone_s is not None:
            self._passed_s += wall_s - self._alone_s
        self._alone_s, self._pace, self._measured = wall_s, 1.0, (wall_s, self._passed_s)


def unused_clock_remark(transport: Transport) -> str:
    """Return a remark if ``/clock`` is published but not used; empty otherwise."""
    if not any(peer.type == TYPE for peer in transport.writers_of(TOPIC)):
        return ""
    return message(
        "a simulation publishes {topic}, but times are taken from this computer; to use its time: --sim-time",
        topic=TOPIC,
    )


def _seconds(stamp: object) -> float:
    """Return the seconds of a ``builtin_interfaces/msg/Time``."""
    assert isinstance(stamp, Mapping)  # noqa: S101  the transport gives what the type says
    return float(stamp["sec"]) + 1e-9 * float(stamp["nanosec"])
