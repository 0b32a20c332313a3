"""Orders to a mission: from its folder, which every process can write to, and from the memory of its own process."""

from __future__ import annotations

import threading
from collections.abc import Callable

from fieldhand.execution.operator_commands import OperatorCommand, StoppingCommand

_RANK: dict[str, int] = {"pause": 1, "return": 2, "abort": 3}


def no_command() -> OperatorCommand | None:
    """Give no order."""
    return None


class DirectCommands:
    """Orders to a mission that this process carries out. They need no disk. Safe for several threads.

    Args:
        last: The last order in the mission's folder; empty if there is none.
    """

    def __init__(self, last: str = "") -> None:
        self._guard = threading.Lock()
        self._rank = _RANK.get(last, 0)
        self._order: OperatorCommand | None = None
        self._taken: OperatorCommand | None = None

    def give(self, wanted: StoppingCommand, reason: str) -> OperatorCommand | None:
        """Give an order; return None if it comes too late: the mission was told to come home, or to stop."""
        with self._guard:
            rank = _RANK[wanted]
            if rank < self._rank and self._rank > _RANK["pause"]:
                return None
            if self._order is None or self._order.wanted != wanted:
                self._order = OperatorCommand(wanted=wanted, reason=reason)
            self._rank = rank
            return self._order

    def drop(self, order: OperatorCommand | None = None) -> None:
        """Forget an order that lies in the mission's folder by now, or any if none is given."""
        with self._guard:
            if order is None or self._order is order:
                self._order = None
            if order is None and self._rank == _RANK["pause"]:
                self._rank = 0

    def standing(self) -> OperatorCommand | None:
        """Return the order that stands, and note that the mission has taken it."""
        with self._guard:
            if self._order is not None:
                self._taken = self._order
            return self._order

    def taken(self, order: OperatorCommand) -> bool:
        """Return True once the mission has taken this order."""
        with self._guard:
            return self._taken is order


def latest(
    direct: Callable[[], OperatorCommand | None], folder: Callable[[], OperatorCommand | None]
) -> Callable[[], OperatorCommand | None]:
    """Return what gives the later of two standing orders: the direct one, or that in the mission's folder.

    An abort in memory is given without a look at the disk.
    """
    seen: OperatorCommand | None = None
    before: OperatorCommand | None = None

    def standing() -> OperatorCommand | None:
        nonlocal seen, before
        told = direct()
        if told is not None and told.wanted == "abort":
            return told
        kept = folder()
        if told is None:
            return kept
        if told is not seen:
            seen, before = told, kept
        return told if kept == before and (kept is None or kept.wanted != told.wanted) else kept

    return standing
