"""A fixed clock stands still until it is moved."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest

from fieldhand.clock import WallClock
from fieldhand.compatibility import UTC
from fieldhand.testing.fixed_clock import FixedClock


def test_it_stands_still_until_it_is_moved() -> None:
    moment = datetime(2026, 3, 1, 12, tzinfo=UTC)
    clock = FixedClock(moment)
    wall: WallClock = clock
    assert clock() == clock() == moment
    assert wall.now() == wall.now() == moment.timestamp()
    clock.advance(90)
    assert clock() == moment + timedelta(seconds=90)
    clock.advance(-120)
    assert wall.now() == moment.timestamp() - 30


def test_it_needs_a_time_zone() -> None:
    with pytest.raises(ValueError, match="no time zone"):
        FixedClock(datetime(2026, 3, 1))
