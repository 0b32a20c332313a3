"""Admit callers to a robot by its token."""

from __future__ import annotations

import hashlib
import hmac
import math
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from dataclasses import dataclass

from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from fieldhand.api.admission import Rank, network_of, set_rank
from fieldhand.api.gates import BodyGate
from fieldhand.api.problems import problem


@dataclass(frozen=True, kw_only=True)
class WrongTokenLimits:
    """Limits on wrong tokens. The right token is always accepted.

    Attributes:
        delay_s: Seconds before the response to a wrong token.
        tries: Number of wrong tokens from an address before it is locked out.
        lockout_s: Seconds of the first lockout, doubled with each further one.
        longest_s: Seconds of the longest lockout.
        addresses: Number of addresses that are remembered; the oldest is removed.
    """

    delay_s: float = 0.5
    tries: int = 5
    lockout_s: float = 30.0
    longest_s: float = 900.0
    addresses: int = 1000


class TokenGate:
    """Middleware that admits requests with the right token, before any byte of a body is read.

    The right token is accepted even from a locked out address, which others may share. The length of the token
    (:data:`fieldhand.delivery.agent_token.SHORTEST`) prevents guessing; delays only save the robot work.

    Args:
        token: The token; None if none is required.
        guessing: Limits on wrong tokens.
        clock: Returns monotonic seconds.
        sleep: Waits a number of seconds.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        token: str | None,
        guessing: WrongTokenLimits,
        clock: Callable[[], float],
        sleep: Callable[[float], Awaitable[None]],
    ) -> None:
        self._app, self._guessing, self._clock, self._sleep = app, guessing, clock, sleep
        self._wanted = None if token is None else _digest(token)
        #: Wrong tokens so far, and end of the lockout, by address.
        self._wrong: OrderedDict[str, tuple[int, float]] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        kind, _, given = Headers(scope=scope).get("authorization", "").partition(" ")
        right = kind.lower() == "bearer" and hmac.compare_digest(_digest(given.strip()), self._wanted or b"")
        if right or self._wanted is None:
            set_rank(scope, Rank.OPERATOR if is_order(scope) else Rank.WORKING)
            await self._app(scope, receive, send)
            return
        set_rank(scope, Rank.WAITING)
        response = self._refusal((scope.get("client") or ("", 0))[0], is_given=bool(given))
        await self._sleep(self._guessing.delay_s)
        await response(scope, receive, send)

    def _refusal(self, client: str, *, is_given: bool) -> Response:
        """Count a wrong token before the response, so that simultaneous guesses are counted, too."""
        address = network_of(client)
        wrong, until = self._wrong.get(address, (0, -math.inf))
        left = until - self._clock()
        if left > 0:
            response = problem(429, "too many wrong tokens", "Authorization", f"try again in {math.ceil(left)} seconds")
            response.headers["Retry-After"] = str(math.ceil(left))
            return response
        self._note(address, wrong + 1)
        what = "this is not the robot's token" if is_given else "the robot's token is missing"
        response = problem(401, what, "Authorization", "give its file with --token-file, or set FIELDHAND_TOKEN")
        response.headers["WWW-Authenticate"] = "Bearer"
        return response

    def _note(self, address: str, wrong: int) -> None:
        rules = self._guessing
        rounds = wrong // rules.tries
        lock = wrong % rules.tries == 0
        until = self._clock() + min(rules.longest_s, rules.lockout_s * 2 ** min(rounds - 1, 20)) if lock else -math.inf
        self._wrong[address] = (wrong, until)
        self._wrong.move_to_end(address)
        while len(self._wrong) > rules.addresses:
            self._wrong.popitem(last=False)


def is_order(scope: Scope) -> bool:
    """Return True for a request that contains a command to a mission."""
    return bool(scope["method"] == "POST" and scope["path"].endswith("/orders"))


class SmallBodyGate:
    """Refuses large bodies of all requests but uploads, which have limits of their own.

    Args:
        most: Largest size of a body, in bytes.
    """

    def __init__(self, app: ASGIApp, most: int) -> None:
        self._app, self._small = app, BodyGate(app, most)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await (self._app if scope.get("method") == "PUT" else self._small)(scope, receive, send)


def _digest(text: str) -> bytes:
    """Return a digest of constant length, so that the comparison does not reveal the length of the token."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).digest()
