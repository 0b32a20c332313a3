"""Connections of one server: how many there may be, and which is closed when there are too many.

A new connection is always admitted: for it the oldest of those that matter least is closed, of the address that has the
most. So nobody can keep others out by connecting and saying nothing.
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

    ``WAITING``: no whole request yet, or a refused one. ``RECEIVING``: a body is arriving. ``WORKING``: an answer is
    being made. ``OPERATOR``: an order to a robot, from someone who may give it.
    """

    WAITING = 0
    RECEIVING = 1
    WORKING = 2
    OPERATOR = 3


#: Under this key of a request's state the application says of what rank it is.
_RANK = "fieldhand.rank"


def set_rank(scope: MutableMapping[str, Any], rank: Rank) -> None:
    """Say of what rank a request is; without that it is ``RECEIVING`` and then ``WORKING``."""
    scope.setdefault("state", {})[_RANK] = rank


def rank_of(scope: MutableMapping[str, Any]) -> Rank | None:
    """Return the rank that the application gave a request; None if it gave none."""
    found = scope.get("state", {}).get(_RANK)
    return found if isinstance(found, Rank) else None


@dataclass(eq=False, kw_only=True)
class AdmittedConnection:
    """A connection that was admitted.

    Attributes:
        number: Counted from the first connection on.
        address: From where it comes; an IPv6 network of 64 bits counts as one address.
        rank: Of what rank it is now.
        close: Ends it at once.
    """

    number: int
    address: str
    rank: Callable[[], Rank]
    close: Callable[[], None]


class Admission:
    """Admits connections, and closes others for them.

    Args:
        total: How many there may be.
        of_address: How many of one address.
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
            address: From where it comes.
            rank: Gives its rank at any time.
            close: Ends it at once.
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
        """Forget a connection that has ended; nothing happens if it is forgotten already."""
        if self._places.pop(place.number, None) is not None:
            self._counts[place.address] -= 1
            if not self._counts[place.address]:
                del self._counts[place.address]

    def _close_one(self, address: str | None) -> None:
        """Close the connection that matters least, but not the one that has just come."""
        newest = max(self._places)
        least = min(
            (place for n, place in self._places.items() if n != newest and address in (None, place.address)),
            key=lambda place: (place.rank(), -self._counts[place.address], place.number),
        )
        self.leave(least)
        least.close()


def network_of(address: str) -> str:
    """Return the address, or of an IPv6 address the network of 64 bits, which one sender has to itself."""
    try:
        found = ipaddress.ip_address(address)
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv6Address):
        if found.ipv4_mapped is not None:
            return str(found.ipv4_mapped)
        return str(ipaddress.IPv6Network((int(found) >> 64 << 64, 64)))
    return address
