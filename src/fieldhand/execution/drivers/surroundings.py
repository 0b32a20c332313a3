"""What is simulated beside the robot: the computer's time of day, and its disk."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime

from fieldhand.clock import Clock, SimulatedWallClock, WallClock
from fieldhand.errors import OutputError
from fieldhand.execution.world import ClockJumps, DiskFull, World
from fieldhand.task.results import Event

#: When a mission begins whose world sets the wall clock and does not say when it began.
SOME_MORNING = datetime(2026, 1, 1, 6, 0, tzinfo=UTC)


def wall_clock_of(world: World, clock: Clock) -> WallClock | None:
    """The time of day in a world; None where the world says nothing of it."""
    jumps = [(fault.at_s, fault.by_s) for fault in world.faults if isinstance(fault, ClockJumps)]
    if world.begins is None and not jumps:
        return None
    return SimulatedWallClock(clock, (world.begins or SOME_MORNING).timestamp(), jumps)


def writing_in(world: World, write: Callable[[Event], None]) -> Callable[[Event], None]:
    """Writes events as ``write`` does, until the world's disk is full."""
    full_s = min((fault.at_s for fault in world.faults if isinstance(fault, DiskFull)), default=None)
    if full_s is None:
        return write

    def until_full(event: Event) -> None:
        if event.t >= full_s:
            raise OutputError(
                "the event log cannot be written: no space left on the disk",
                where=f"{event.t:.0f} s into the mission",
                advice="the robot was stopped where it was; make room, what was written before is kept",
            )
        write(event)

    return until_full
