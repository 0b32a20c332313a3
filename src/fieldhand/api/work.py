"""Work that takes the processor, done in threads beside the server's own, so much at once and no more."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar

from anyio import CapacityLimiter, to_thread

from fieldhand.api.problems import Turned

T = TypeVar("T")


def _at_once() -> int:
    return max(1, min(4, os.cpu_count() or 1))


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What one server takes on.

    Attributes:
        body_bytes: Of one request.
        at_once: Plans, checks and runs at the same time; as many as there are processors, at most 4.
        waiting: How many more may wait.
        run_s: Seconds (of the real clock) after which a simulation is ended in order.
    """

    body_bytes: int = 16_000_000
    at_once: int = field(default_factory=_at_once)
    waiting: int = 16
    run_s: float = 60.0


class Workers:
    """Runs work in threads.

    Args:
        limits: How much at once, and how much may wait.
    """

    def __init__(self, limits: Limits) -> None:
        self._limiter = CapacityLimiter(limits.at_once)
        self._most = limits.at_once + limits.waiting
        self._inside = 0

    async def do(self, work: Callable[[], T]) -> T:
        """Do the work in a thread and give its result.

        Raises:
            Turned: Too many wait already (status 503).
        """
        if self._inside >= self._most:
            raise Turned(503, "too many requests at once", "try again in a moment")
        self._inside += 1
        try:
            return await to_thread.run_sync(work, limiter=self._limiter)
        finally:
            self._inside -= 1
