"""To ask a service and wait for its answer, step by step, and how long to wait for anything."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.goal_outcome import GONE_S, TWO_S
from fieldhand.execution.drivers.ros2.transport import Client, Message

#: Requests that are on the way at once: services keep ten.
_AT_ONCE = 8

#: Where the mission's clock stands still, because the simulation that it follows is gone, a limit holds all the same.
_SLOWEST, _SPARE_S = 10.0, 60.0


class TimeLimit:
    """So many seconds of the mission from now on.

    Args:
        clock: The mission's.
        steady: Seconds that pass whatever that does.
    """

    def __init__(self, seconds: float, clock: Callable[[], float], steady: Callable[[], float]) -> None:
        self.seconds = seconds
        self._clock, self._steady = clock, steady
        self.renew()

    def renew(self) -> None:
        """They count from now on."""
        self._begun, self._begun_steady = self._clock(), self._steady()

    @property
    def over(self) -> bool:
        """Whether they have passed."""
        if self._clock() - self._begun > self.seconds:
            return True
        return self._steady() - self._begun_steady > _SLOWEST * self.seconds + _SPARE_S


def call_service(
    client: Client,
    name: str,
    requests: Sequence[Message],
    limit: TimeLimit,
    steady: Callable[[], float],
    *,
    sending: Callable[[], None] = lambda: None,
) -> Generator[None, None, tuple[Message, ...]]:
    """Ask a service once for each request, as steps that wait.

    Args:
        name: Of the service, for errors.
        sending: Called just before each request is sent.

    Returns:
        The replies, in the order of the requests.

    Raises:
        Ros2Error: Nothing answers, several do, one does not in time, or a request does not fit the type.
    """
    client.replies()  # those that nobody waited for any more
    answers: dict[int, Message] = {}
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
            limit.renew()  # what was asked is not asked again: a service may do something
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
                raise Ros2Error(what, advice="see whether it runs on the robot")
            yield
    return tuple(answers[n] for n in range(len(requests)))
