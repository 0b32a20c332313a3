"""Threads for CPU-bound work, with a limit on their number and on the waiting requests."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar

from anyio import CapacityLimiter, to_thread

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


class Workers:
    """Runs functions in threads.

    Args:
        limits: Number of threads, and of waiting requests.
    """

    def __init__(self, limits: Limits) -> None:
        self._limiter = CapacityLimiter(limits.at_once)
        self._most = limits.at_once + limits.waiting
        self._inside = 0

    async def do(self, work: Callable[[], T]) -> T:
        """Call a function in a thread and return its result.

        Raises:
            RefusedRequest: Too many requests are waiting (status 503).
        """
        if self._inside >= self._most:
            raise RefusedRequest(503, "too many requests at once", "try again in a moment")
        self._inside += 1
        try:
            return await to_thread.run_sync(work, limiter=self._limiter)
        finally:
            self._inside -= 1
