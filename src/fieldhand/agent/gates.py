"""Who may talk to a robot: whoever has its token. Guessing it is slow, and soon ends."""

from __future__ import annotations

import hashlib
import hmac
import math
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from dataclasses import dataclass

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from fieldhand.api.gates import BodyGate
from fieldhand.api.problems import problem


@dataclass(frozen=True, kw_only=True)
class Guessing:
    """What is done about wrong tokens.

    Attributes:
        delay_s: Before a wrong one is answered.
        tries: Wrong ones of an address until it is locked out.
        lockout_s: For how long; doubled with each further round, up to ``longest_s``.
        addresses: How many are remembered; the oldest is forgotten.
    """

    delay_s: float = 0.5
    tries: int = 5
    lockout_s: float = 30.0
    longest_s: float = 900.0
    addresses: int = 1000


class TokenGate:
    """Lets through who says the token, before a byte of a body is read.

    Args:
        token: None where nobody has to say one.
        clock: Seconds, never set back.
        sleep: Waits so many seconds.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        token: str | None,
        guessing: Guessing,
        clock: Callable[[], float],
        sleep: Callable[[float], Awaitable[None]],
    ) -> None:
        self._app, self._guessing, self._clock, self._sleep = app, guessing, clock, sleep
        self._wanted = None if token is None else _digest(token)
        #: By address: wrong tokens so far, and until when it is locked out.
        self._wrong: OrderedDict[str, tuple[int, float]] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or self._wanted is None:
            await self._app(scope, receive, send)
            return
        address = (scope.get("client") or ("", 0))[0]
        wrong, until = self._wrong.get(address, (0, -math.inf))
        left = until - self._clock()
        if left > 0:
            response = problem(429, "too many wrong tokens", "Authorization", f"try again in {math.ceil(left)} seconds")
            response.headers["Retry-After"] = str(math.ceil(left))
            await response(scope, receive, send)
            return
        kind, _, said = Headers(scope=scope).get("authorization", "").partition(" ")
        if kind.lower() == "bearer" and hmac.compare_digest(_digest(said.strip()), self._wanted):
            self._wrong.pop(address, None)
            await self._app(scope, receive, send)
            return
        self._note(address, wrong + 1)
        await self._sleep(self._guessing.delay_s)
        what = "this is not the robot's token" if said else "the robot's token is missing"
        response = problem(401, what, "Authorization", "give its file with --token-file, or set FIELDHAND_TOKEN")
        response.headers["WWW-Authenticate"] = "Bearer"
        await response(scope, receive, send)

    def _note(self, address: str, wrong: int) -> None:
        """Remember a wrong token, before it is answered: many guesses at once are counted, too."""
        rules = self._guessing
        rounds = wrong // rules.tries
        lock = wrong % rules.tries == 0
        until = self._clock() + min(rules.longest_s, rules.lockout_s * 2 ** min(rounds - 1, 20)) if lock else -math.inf
        self._wrong[address] = (wrong, until)
        self._wrong.move_to_end(address)
        while len(self._wrong) > rules.addresses:
            self._wrong.popitem(last=False)


class SmallBodies:
    """Turns away a large body of every request but an upload, which counts its own.

    Args:
        most: Bytes.
    """

    def __init__(self, app: ASGIApp, most: int) -> None:
        self._app, self._small = app, BodyGate(app, most)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await (self._app if scope.get("method") == "PUT" else self._small)(scope, receive, send)


def _digest(text: str) -> bytes:
    """Of one length for every token, so that comparing tells nothing of it."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).digest()
