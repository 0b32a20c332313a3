"""The accounts as the API uses them: in threads, with paced logins."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from anyio import CapacityLimiter, to_thread

from fieldhand.accounts.accounts import Accounts
from fieldhand.api.login_throttle import LoginThrottle

T = TypeVar("T")
#: Largest number of transactions at once.
_AT_ONCE = 8


class AccountService:
    """The accounts of a server, for asynchronous callers.

    Args:
        accounts: The accounts.
        throttle: Paces logins.

    Attributes:
        accounts, throttle: As above.
    """

    def __init__(self, accounts: Accounts, throttle: LoginThrottle | None = None) -> None:
        self.accounts = accounts
        self.throttle = throttle or LoginThrottle()
        self._limiter = CapacityLimiter(_AT_ONCE)

    async def do(self, work: Callable[[], T]) -> T:
        """Call a function that uses the database in a thread, and return its result."""
        return await to_thread.run_sync(work, limiter=self._limiter)
