"""Service calls in non-blocking steps, and time limits."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.action_outcome import GONE_S, TWO_S
from fieldhand.execution.drivers.ros2.transport import Client, RosMessage

#: Requests in flight at once: services keep ten.
_AT_ONCE = 8

#: A limit expires by the steady clock, too, for when the mission clock stands still because its simulation is gone.
_SLOWEST, _SPARE_S = 10.0, 60.0


class TimeLimit:
    """A time limit in seconds of the mission clock, counted from now.

    Args:
        clock: Mission clock in seconds.
        steady: Monotonic clock in seconds.
    """

    def __init__(self, seconds: float, clock: Callable[[], float], steady: Callable[[], float]) -> None:
        self.seconds = seconds
        self._clock, self._steady = clock, steady
        self.renew()

    def renew(self) -> None:
        """Restart the time limit."""
        self._begun, self._begun_steady = self._clock(), self._steady()

    @property
    def over(self) -> bool:
        """True once the time limit has passed."""
        if self._clock() - self._begun > self.seconds:
            return True
        return self._steady() - self._begun_steady > _SLOWEST * self.seconds + _SPARE_S


def call_service(
    client: Client,
    name: str,
    requests: Sequence[RosMessage],
    limit: TimeLimit,
    steady: Callable[[], float],
    *,
    sending: Callable[[], None] = lambda: None,
) -> Generator[None, None, tuple[RosMessage, ...]]:
    """Call a service once for each request, in steps that yield while waiting.

    Args:
        name: Name of the service, for error messages.
        sending: Called just before each request is sent.

    Returns:
        The replies, in the order of the requests.

    Raises:
        Ros2Error: No server or several servers answer, a reply is late, or a request does not fit the type.
    """
    client.replies()  # discards late replies to earlier calls
    answers: dict[int, RosMessage] = {}
    asked: dict[int, int] = {}
    absent_s = two_s = None
    while len(answers) < len(requests):
        for number, reply in client.replies():
            if number in asked:
                answers.setdefault(asked[number], reply)
        servers = client.servers()
        absent_s = None if servers else steady() if absent_s is None else absent_s
        if servers > 1:
            two_s = steady() if two_s is None else two_s
            if steady() - two_s > TWO_S:
                advice = "let one robot be on this domain and namespace"
                raise Ros2Error(f"{servers} servers answer {name}", advice=advice)
            yield
            continue
        if two_s is not None and not asked:
            limit.renew()  # a request is never repeated: the service may have side effects
        two_s = None
        if servers == 1 and len(asked) < len(requests) and len(asked) - len(answers) < _AT_ONCE:
            sending()
            asked[client.ask(requests[len(asked)])] = len(asked)
            continue
        if len(answers) < len(requests):
            if asked and absent_s is not None and steady() - absent_s >= GONE_S:
                raise Ros2Error(f"{name} is gone: nothing answers any more")
            if limit.over:
                what = f"{name} did not answer within {limit.seconds:g} s" if asked else f"nothing answers {name}"
                raise Ros2Error(what, advice="check whether it runs on the robot")
            yield
    return tuple(answers[n] for n in range(len(requests)))
