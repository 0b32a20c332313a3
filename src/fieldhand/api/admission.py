"""Limits on the number of connections of a server.

A new connection is always admitted. If there are too many, the one of the lowest rank is closed, first from the address
with the most connections, and the oldest of these. Idle connections can therefore not block others.
"""

from __future__ import annotations

import ipaddress
import itertools
from collections import Counter
from collections.abc import Callable, MutableMapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any


class Rank(IntEnum):
    """The rank of a connection: one of a lower rank is closed first.

    ``WAITING``: no complete request yet, or a refused one. ``RECEIVING``: a body is being received. ``WORKING``: a
    response is being computed. ``OPERATOR``: an authorized command to a robot.
    """

    WAITING = 0
    RECEIVING = 1
    WORKING = 2
    OPERATOR = 3


#: Keys of the rank in a request's state, and of the sign that the server ends.
_RANK, _ENDING = "fieldhand.rank", "fieldhand.ending"


def set_rank(scope: MutableMapping[str, Any], rank: Rank) -> None:
    """Set the rank of a request; by default it is ``RECEIVING`` and then ``WORKING``."""
    scope.setdefault("state", {})[_RANK] = rank


def rank_of(scope: MutableMapping[str, Any]) -> Rank | None:
    """Return the rank that was set for a request; None if none was."""
    found = scope.get("state", {}).get(_RANK)
    return found if isinstance(found, Rank) else None


def set_ending(scope: MutableMapping[str, Any]) -> None:
    """Note for a request that the server ends, so that a response without end is to end now."""
    scope.setdefault("state", {})[_ENDING] = True


def is_ending(scope: MutableMapping[str, Any]) -> bool:
    """Return True if the server ends."""
    return bool(scope.get("state", {}).get(_ENDING, False))


@dataclass(eq=False, kw_only=True)
class AdmittedConnection:
    """A connection that was admitted.

    Attributes:
        number: Number of the connection, in the order of admission.
        address: Address of the client; an IPv6 network of 64 bits counts as one address.
        rank: Returns the current rank.
        close: Closes the connection at once.
    """

    number: int
    address: str
    rank: Callable[[], Rank]
    close: Callable[[], None]


class Admission:
    """Admits connections, and closes others if there are too many.

    Args:
        total: Largest number of connections.
        of_address: Largest number of connections from one address.
    """

    def __init__(self, *, total: int, of_address: int) -> None:
        self._total, self._of_address = total, of_address
        self._numbers = itertools.count()
        self._places: dict[int, AdmittedConnection] = {}
        self._counts: Counter[str] = Counter()

    def __len__(self) -> int:
        return len(self._places)

    def enter(self, address: str, *, rank: Callable[[], Rank], close: Callable[[], None]) -> AdmittedConnection:
        """Admit a connection; close another one if there are too many.

        Args:
            address: Address of the client.
            rank: Returns the current rank.
            close: Closes the connection at once.
        """
        place = AdmittedConnection(number=next(self._numbers), address=network_of(address), rank=rank, close=close)
        self._places[place.number] = place
        self._counts[place.address] += 1
        if self._counts[place.address] > self._of_address:
            self._close_one(place.address)
        elif len(self._places) > self._total:
            self._close_one(None)
        return place

    def leave(self, place: AdmittedConnection) -> None:
        """Remove a connection that has ended; do nothing if it was removed already."""
        if self._places.pop(place.number, None) is not None:
            self._counts[place.address] -= 1
            if not self._counts[place.address]:
                del self._counts[place.address]

    def _close_one(self, address: str | None) -> None:
        """Close the connection of the lowest rank, except the newest one."""
        newest = max(self._places)
        least = min(
            (place for n, place in self._places.items() if n != newest and address in (None, place.address)),
            key=lambda place: (place.rank(), -self._counts[place.address], place.number),
        )
        self.leave(least)
        least.close()


def network_of(address: str) -> str:
    """Return an IPv4 address, or the 64-bit network of an IPv6 address, which belongs to one client."""
    try:
        found = ipaddress.ip_address(address)
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv6Address):
        if found.ipv4_mapped is not None:
            return str(found.ipv4_mapped)
        return str(ipaddress.IPv6Network((int(found) >> 64 << 64, 64)))
    return address
