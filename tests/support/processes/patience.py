"""Waiting for what another process does."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

#: Seconds within which anything happens that happens at all, on the busiest machine; what does not fails.
LONG_S = 300.0

_Seen = TypeVar("_Seen")


def until(seen: Callable[[], _Seen], within_s: float = LONG_S) -> _Seen:
    """Return what is seen as soon as it is true; fail if it stays false."""
    end = time.monotonic() + within_s
    while not (found := seen()):
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.002)
    return found
