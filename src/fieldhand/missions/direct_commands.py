"""Commands to a mission in the memory of its own process, and their merge with those in its folder."""

from __future__ import annotations

import threading
from collections.abc import Callable

from fieldhand.execution.operator_commands import OperatorCommand, StoppingCommand

_RANK: dict[str, int] = {"pause": 1, "return": 2, "abort": 3}


def no_command() -> OperatorCommand | None:
    """Return None: there is no command."""
    return None


class DirectCommands:
    """Commands to a mission that this process carries out, passed in memory, without the disk. Thread-safe.

    Args:
        last: Last command in the mission's folder; empty if there is none.
    """

    def __init__(self, last: str = "") -> None:
        self._lock = threading.Lock()
        self._rank = _RANK.get(last, 0)
        self._order: OperatorCommand | None = None
        self._taken: OperatorCommand | None = None

    def give(self, wanted: StoppingCommand, reason: str) -> OperatorCommand | None:
        """Add a command and return it; return None if the mission already has to return or to stop."""
        with self._lock:
            rank = _RANK[wanted]
            if rank < self._rank and self._rank > _RANK["pause"]:
                return None
            if self._order is None or self._order.wanted != wanted:
                self._order = OperatorCommand(wanted=wanted, reason=reason)
            self._rank = rank
            return self._order

    def drop(self, order: OperatorCommand | None = None) -> None:
        """Remove a command that was written to the mission's folder meanwhile; without an argument, any command."""
        with self._lock:
            if order is None or self._order is order:
                self._order = None
            if order is None and self._rank == _RANK["pause"]:
                self._rank = 0

    def standing(self) -> OperatorCommand | None:
        """Return the current command, and record that the mission received it."""
        with self._lock:
            if self._order is not None:
                self._taken = self._order
            return self._order

    def taken(self, order: OperatorCommand) -> bool:
        """Return True once the mission has received this command."""
        with self._lock:
            return self._taken is order


def latest(
    direct: Callable[[], OperatorCommand | None], folder: Callable[[], OperatorCommand | None]
) -> Callable[[], OperatorCommand | None]:
    """Return a function that returns the later of two commands: the one in memory, or the one in the folder.

    An abort in memory is returned without reading the disk.
    """
    seen: OperatorCommand | None = None
    before: OperatorCommand | None = None

    def standing() -> OperatorCommand | None:
        nonlocal seen, before
        in_memory = direct()
        if in_memory is not None and in_memory.wanted == "abort":
            return in_memory
        on_disk = folder()
        if in_memory is None:
            return on_disk
        if in_memory is not seen:
            seen, before = in_memory, on_disk
        return in_memory if on_disk == before and (on_disk is None or on_disk.wanted != in_memory.wanted) else on_disk

    return standing
