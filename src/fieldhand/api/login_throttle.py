"""Pacing of logins: wrong passwords cost more and more time, and the right one always gets its turn.

Nobody is locked out. Attempts on one account from one address take turns, and after a wrong one the next turn waits.
So whoever guesses is slow, and delays only those who try the same account from the same address; they are served in
random order, so that no number of guesses keeps the right password away. A browser in which the account has logged in
before counts as an address of its own ("device cookies"), and does not wait for guesses at all.
"""

from __future__ import annotations

import random
import time
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import TypeVar

import anyio

from fieldhand.api.admission import network_of
from fieldhand.api.problems import RefusedRequest
from fieldhand.language import message

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class LoginLimits:
    """Limits on wrong logins. The right one is answered at once when it has its turn.

    Attributes:
        delay_s: Seconds after the first wrong attempt, doubled with each further one.
        longest_s: Largest number of these seconds.
        forgotten_s: Seconds after which wrong attempts no longer count.
        at_once: Largest number of passwords that are verified at the same time, one of an address.
        waiting: Largest number of waiting attempts from an address; beyond, a random one of them is refused.
        remembered: Largest number of addresses and accounts whose wrong attempts are counted.
    """

    delay_s: float = 0.25
    longest_s: float = 1.0
    forgotten_s: float = 900.0
    at_once: int = 2
    waiting: int = 64
    remembered: int = 4000


@dataclass(eq=False)
class _LoginAttempt:
    """An attempt in the queue of its account and address."""

    account: str
    turn: anyio.Event = field(default_factory=anyio.Event)
    refused: bool = False


class LoginThrottle:
    """Paces attempts to log in.

    Args:
        limits: Limits.
        clock: Returns monotonic seconds.
        sleep: Waits a number of seconds.
        chance: Chooses among waiting attempts.
    """

    def __init__(
        self,
        limits: LoginLimits | None = None,
        *,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], Awaitable[None]] = anyio.sleep,
        chance: random.Random | None = None,
    ) -> None:
        self._limits = limits or LoginLimits()
        self._clock, self._sleep = clock, sleep
        self._chance = chance or random.SystemRandom()
        #: Attempts by address; the first one of each account has its turn.
        self._queues: dict[str, list[_LoginAttempt]] = {}
        self._busy: dict[str, anyio.Lock] = {}
        self._verifying = anyio.Semaphore(self._limits.at_once)
        #: Number of wrong attempts of an address or on an account, and the time of the last one.
        self._wrong: OrderedDict[tuple[str, str], tuple[int, float]] = OrderedDict()

    async def attempt(
        self,
        address: str,
        account: str,
        verify: Callable[[], Awaitable[T | None]],
        wrong: Callable[[int], Awaitable[None]] | None = None,
    ) -> T | None:
        """Verify a credential when it has its turn; return what ``verify`` returns, None if it is wrong.

        Args:
            address: Address of the client.
            account: Name of the account, in the form by which it is found.
            verify: Verifies the credential.
            wrong: Called after a wrong attempt with the number of recent ones from the address.

        Raises:
            RefusedRequest: Too many attempts from the address are waiting (status 429).
        """
        network = network_of(address)
        attempt = _LoginAttempt(account)
        try:
            await self._await_turn(network, attempt)
            async with self._busy.setdefault(network, anyio.Lock()), self._verifying:
                found = await verify()
            if found is None:
                count, delay_s = self._counted(network, account)
                if wrong is not None:
                    await wrong(count)
                await self._sleep(delay_s)
            else:
                self._wrong.pop(("account", account), None)
            return found
        finally:
            self._leave(network, attempt)

    async def _await_turn(self, network: str, attempt: _LoginAttempt) -> None:
        queue = self._queues.setdefault(network, [])
        alone = all(other.account != attempt.account for other in queue)
        queue.append(attempt)
        if alone:
            attempt.turn.set()
            return
        waiting = [one for one in queue if not one.turn.is_set()]
        if len(waiting) > self._limits.waiting:
            refused = self._chance.choice(waiting)
            refused.refused = True
            queue.remove(refused)
            refused.turn.set()
        await attempt.turn.wait()
        if attempt.refused:
            raise RefusedRequest(
                429, message("too many attempts to log in from your address"), message("try again in a moment")
            )

    def _leave(self, network: str, attempt: _LoginAttempt) -> None:
        """Remove an attempt, and give the turn to another one on the same account."""
        queue = self._queues.get(network, [])
        if attempt in queue:
            queue.remove(attempt)
            same = [other for other in queue if other.account == attempt.account]
            if same and not any(other.turn.is_set() for other in same):
                self._chance.choice(same).turn.set()
        if not queue:
            self._queues.pop(network, None)
            self._busy.pop(network, None)

    def _counted(self, network: str, account: str) -> tuple[int, float]:
        """Count a wrong attempt; return the number from its address, and the seconds that it costs."""
        counts = []
        for key in (("address", network), ("account", account)):
            counts.append(self._count(key) + 1)
            self._wrong[key] = (counts[-1], self._clock())
            self._wrong.move_to_end(key)
        while len(self._wrong) > self._limits.remembered:
            self._wrong.popitem(last=False)
        return counts[0], min(self._limits.longest_s, self._limits.delay_s * 2.0 ** min(max(counts) - 1, 20))

    def _count(self, key: tuple[str, str]) -> int:
        count, at = self._wrong.get(key, (0, 0.0))
        return count if self._clock() - at < self._limits.forgotten_s else 0
