"""Waiting: for a time, and for a lost position."""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.errors import LostFault
from fieldhand.execution.attempt import Attempt
from fieldhand.language import joined, message
from fieldhand.task.results import Faulted, Waited
from fieldhand.task.run import Steps

#: Seconds within which two times are equal: clocks add floating-point numbers.
_SAME_S = 1e-6


def wait(attempt: Attempt, seconds: float, over: Callable[[], bool] = lambda: False) -> Steps:
    """Stand still for some seconds of the mission, or until ``over`` returns True."""
    until_s = attempt.clock.now() + seconds
    attempt.wait_until(until_s)
    try:
        while attempt.clock.now() < until_s - _SAME_S and not over():
            yield
    finally:
        attempt.wait_until(None)


def know_position(attempt: Attempt, node: str) -> Steps:
    """Wait for a lost position as long as the profile allows; indefinitely while the mission is halted.

    Raises:
        LostFault: The position is still unknown.
    """
    while attempt.halted:
        yield
    why = attempt.seen.lost
    if why is None:
        return
    begun_s, patience = attempt.clock.now(), attempt.robot.patience.lost_wait_s
    what = message("the robot does not know where it is ({why})", context="log", why=why)
    still = message("it stands still for at most {seconds} s", context="log", seconds=f"{patience:g}")
    standing = joined("; ", (what, still))
    attempt.emit(Faulted(t=attempt.t, node=node, fault="lost", what=standing, handled=True))
    yield from wait(attempt, patience, over=lambda: attempt.seen.lost is None)
    known, waited_s = attempt.seen.lost is None, attempt.clock.now() - begun_s
    attempt.emit(Waited(t=attempt.t, node=node, wanted="position", seconds=waited_s, over=known, what=why))
    if not known:
        lasting = message("{known}, {seconds} s on still", context="log", known=what, seconds=f"{patience:g}")
        raise LostFault(lasting, advice=message("bring it back by hand", context="log"))
