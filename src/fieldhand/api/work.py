"""Threads for CPU-bound work, with a limit on their number and on the waiting requests."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import TypeVar

from anyio import CapacityLimiter, Event, to_thread

from fieldhand.api.problems import RefusedRequest

T = TypeVar("T")


def _at_once() -> int:
    return max(1, min(4, os.cpu_count() or 1))


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits of a server's work.

    Attributes:
        body_bytes: Largest body of a request, in bytes.
        at_once: Largest number of plans, checks and runs at the same time; by default one per processor, at most 4.
        waiting: Largest number of further requests that wait.
        run_s: Seconds of real time after which a simulation is ended in order.
    """

    body_bytes: int = 16_000_000
    at_once: int = field(default_factory=_at_once)
    waiting: int = 16
    run_s: float = 60.0


@dataclass(eq=False, kw_only=True)
class _Waiting:
    """A request that waits for a thread."""

    caller: str
    turn: Event = field(default_factory=Event)
    refused: bool = False


class Workers:
    """Runs functions in threads; callers take turns, so that none keeps the others away.

    Args:
        limits: Number of threads, and of waiting requests.
    """

    def __init__(self, limits: Limits) -> None:
        self._limiter = CapacityLimiter(limits.at_once)
        self._free, self._most_waiting = limits.at_once, limits.waiting
        self._waiting: list[_Waiting] = []
        #: Callers in the order in which they had their last turn, while they have requests.
        self._served: dict[str, int] = {}
        self._turns = count()

    async def do(self, work: Callable[[], T], caller: str = "") -> T:
        """Call a function in a thread and return its result.

        If too many requests are waiting, the last one of the caller with the most of them is refused.

        Args:
            work: The function.
            caller: Name of the caller.

        Raises:
            RefusedRequest: Too many requests are waiting (status 503).
        """
        await self._await_turn(caller)
        try:
            return await to_thread.run_sync(work, limiter=self._limiter)
        finally:
            self._pass_on()

    async def _await_turn(self, caller: str) -> None:
        if self._free:
            self._free -= 1
            self._served[caller] = next(self._turns)
            return
        own = _Waiting(caller=caller)
        self._waiting.append(own)
        if len(self._waiting) > self._most_waiting:
            held = Counter(one.caller for one in self._waiting)
            # Of several callers with the most, it is the one who came last: max takes the first of the reversed list.
            last = max(reversed(self._waiting), key=lambda one: held[one.caller])
            self._waiting.remove(last)
            last.refused = True
            last.turn.set()
        try:
            await own.turn.wait()
        except BaseException:
            if own in self._waiting:
                self._waiting.remove(own)
            elif not own.refused:
                self._pass_on()
            raise
        if own.refused:
            raise RefusedRequest(503, "too many requests at once", "try again in a moment")

    def _pass_on(self) -> None:
        """Give a thread to the waiting caller whose last turn is the longest ago, else free it."""
        if not self._waiting:
            self._free += 1
            self._served.clear()
            return
        following = min(self._waiting, key=lambda one: self._served.get(one.caller, -1))
        self._waiting.remove(following)
        self._served[following.caller] = next(self._turns)
        following.turn.set()
