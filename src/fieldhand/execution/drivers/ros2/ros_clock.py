"""The time of a robot that is itself a simulation: ``/clock``, as ROS has it where ``use_sim_time`` is set.

It passes as fast as that simulation goes, stands still while it is paused, and does not go back when it is started
anew: what has passed until then stays passed. Where the simulation has gone, time passes as ours: whoever waits for a
robot that was killed stops waiting.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Self

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.transport import QosProfile, Transport
from fieldhand.language import message

TOPIC, TYPE = "/clock", "rosgraph_msgs/msg/Clock"

#: Seconds of the wall clock: between two looks at the topic, at most in one wait, and over which the pace is measured.
_LOOK_S, _WAIT_S, _PACE_S = 0.01, 0.1, 0.5
#: The pace that is reckoned with at least: a simulation that stands goes on some time.
_SLOWEST = 0.01


class RosClock:
    """A :class:`~fieldhand.clock.PacedClock` that follows ``/clock``.

    Args:
        transport: Where it is heard.
        steady: Seconds of a clock that nobody sets.
        sleep: Waits so many of them.
    """

    def __init__(
        self,
        transport: Transport,
        *,
        steady: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        # Best effort hears writers of either kind; only the newest counts.
        self._topic = transport.subscribe(TOPIC, TYPE, QosProfile(reliable=False, depth=1))
        self._transport, self._steady, self._sleep = transport, steady, sleep
        self._said_s: float | None = None
        self._passed_s = 0.0
        self._pace = 1.0
        self._measured = (steady(), 0.0)
        self._alone_s: float | None = None

    @classmethod
    def heard(
        cls,
        transport: Transport,
        within_s: float,
        *,
        steady: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> Self:
        """The clock, once it was heard for the first time, from one alone.

        Args:
            transport, steady, sleep: As for the clock itself.
            within_s: How long to wait for that, in seconds of the steady clock.

        Raises:
            Ros2Error: Nothing was heard, or several say the time.
        """
        clock = cls(transport, steady=steady, sleep=sleep)
        until_s = steady() + within_s
        while not clock.known or len({peer.participant for peer in transport.writers_of(TOPIC)}) > 1:
            if steady() >= until_s and clock.known:
                raise Ros2Error(
                    f"several simulations say their time on {TOPIC}",
                    where=transport.name,
                    advice="give each a ROS_DOMAIN_ID of its own: a namespace does not part them",
                )
            if steady() >= until_s:
                offered = any(peer.type != TYPE for peer in transport.writers_of(TOPIC))
                why = "is of another type" if offered else "is silent"
                raise Ros2Error(
                    f"{TOPIC} {why}, and the robot's time is to be taken from it ({TYPE})",
                    where=transport.name,
                    advice="start the simulation, or leave use_sim_time out for a robot in real time",
                )
            sleep(_LOOK_S)
        return clock

    @property
    def known(self) -> bool:
        """Whether it was heard at least once."""
        self._hear()
        return self._said_s is not None

    @property
    def speed(self) -> float:
        """Seconds that pass here in one second of the wall clock, as was measured last."""
        return max(_SLOWEST, self._pace)

    def now(self) -> float:
        """Seconds that have passed since the topic was first heard."""
        self._hear()
        return self._passed_s

    def advance(self, seconds: float) -> None:
        """Wait until so many seconds have passed, or a tenth of a second of the wall clock: it may stand still."""
        until_s, until_wall_s = self.now() + seconds, self._steady() + _WAIT_S
        while self.now() < until_s and self._steady() < until_wall_s:
            self._sleep(_LOOK_S)

    def _hear(self) -> None:
        messages = self._topic.take()
        if not messages:
            if self._said_s is not None and self._topic.publishers() == 0:
                self._go_on_alone()
            return
        said_s = _seconds(messages[-1]["clock"])
        if self._said_s is not None and self._alone_s is None:
            self._passed_s += max(0.0, said_s - self._said_s)
        self._said_s, self._alone_s = said_s, None
        wall_s, (from_wall_s, from_s) = self._steady(), self._measured
        if wall_s - from_wall_s >= _PACE_S:
            self._pace = (self._passed_s - from_s) / (wall_s - from_wall_s)
            self._measured = wall_s, self._passed_s

    def _go_on_alone(self) -> None:
        """Nobody says the time any more."""
        wall_s = self._steady()
        if self._alone_s is not None:
            self._passed_s += wall_s - self._alone_s
        self._alone_s, self._pace, self._measured = wall_s, 1.0, (wall_s, self._passed_s)


def unused_clock_remark(transport: Transport) -> str:
    """What to know where the time of :data:`TOPIC` is not taken; empty where nobody says one."""
    if not any(peer.type == TYPE for peer in transport.writers_of(TOPIC)):
        return ""
    return message(
        "a simulation says its own time on {topic}, and times are taken from this computer; for its own: --sim-time",
        topic=TOPIC,
    )


def _seconds(stamp: object) -> float:
    """Seconds of a ``builtin_interfaces/msg/Time``."""
    assert isinstance(stamp, Mapping)  # noqa: S101  the transport gives what the type says
    return float(stamp["sec"]) + 1e-9 * float(stamp["nanosec"])
