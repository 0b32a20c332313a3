"""Orders to a mission: from its folder, which every process can write to, and from the memory of its own process."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Literal

from fieldhand.execution.orders import Order

#: Orders that are passed in memory: they make a robot stop, or come home.
Urgent = Literal["pause", "return", "abort"]

_RANK: dict[str, int] = {"pause": 1, "return": 2, "abort": 3}


def nobody() -> Order | None:
    """Give no order."""
    return None


class DirectOrders:
    """Orders to a mission that this process carries out. They need no disk. Safe for several threads.

    Args:
        last: The last order in the mission's folder; empty if there is none.
    """

    def __init__(self, last: str = "") -> None:
        self._guard = threading.Lock()
        self._rank = _RANK.get(last, 0)
        self._order: Order | None = None
        self._taken: Order | None = None

    def give(self, wanted: Urgent, reason: str) -> Order | None:
        """Give an order; return None if it comes too late: the mission was told to come home, or to stop."""
        with self._guard:
            rank = _RANK[wanted]
            if rank < self._rank and self._rank > _RANK["pause"]:
                return None
            if self._order is None or self._order.wanted != wanted:
                self._order = Order(wanted=wanted, reason=reason)
            self._rank = rank
            return self._order

    def drop(self, order: Order | None = None) -> None:
        """Forget an order that lies in the mission's folder by now, or any if none is given."""
        with self._guard:
            if order is None or self._order is order:
                self._order = None
            if order is None and self._rank == _RANK["pause"]:
                self._rank = 0

    def standing(self) -> Order | None:
        """Return the order that stands, and note that the mission has taken it."""
        with self._guard:
            if self._order is not None:
                self._taken = self._order
            return self._order

    def taken(self, order: Order) -> bool:
        """Return True once the mission has taken this order."""
        with self._guard:
            return self._taken is order


def latest(direct: Callable[[], Order | None], folder: Callable[[], Order | None]) -> Callable[[], Order | None]:
    """Return what gives the later of two standing orders: the direct one, or that in the mission's folder.

    An abort in memory is given without a look at the disk.
    """
    seen: Order | None = None
    before: Order | None = None

    def standing() -> Order | None:
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
