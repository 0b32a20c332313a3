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
    """Limits on wrong tokens. A right one passes at any time.

    Attributes:
        delay_s: Before a wrong one is answered.
        tries: Wrong ones of an address until it is told to wait.
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

    The right token passes whatever came before it from its address, which others may share. So the length of the token
    (:data:`fieldhand.delivery.agent_token.SHORTEST`) keeps it from being guessed; delays only spare the robot work.

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
        guessing: WrongTokenLimits,
        clock: Callable[[], float],
        sleep: Callable[[float], Awaitable[None]],
    ) -> None:
        self._app, self._guessing, self._clock, self._sleep = app, guessing, clock, sleep
        self._wanted = None if token is None else _digest(token)
        #: By address: wrong tokens so far, and until when it has to wait.
        self._wrong: OrderedDict[str, tuple[int, float]] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        kind, _, said = Headers(scope=scope).get("authorization", "").partition(" ")
        right = kind.lower() == "bearer" and hmac.compare_digest(_digest(said.strip()), self._wanted or b"")
        if right or self._wanted is None:
            set_rank(scope, Rank.OPERATOR if is_order(scope) else Rank.WORKING)
            await self._app(scope, receive, send)
            return
        set_rank(scope, Rank.WAITING)
        response = self._refusal((scope.get("client") or ("", 0))[0], said=bool(said))
        await self._sleep(self._guessing.delay_s)
        await response(scope, receive, send)

    def _refusal(self, client: str, *, said: bool) -> Response:
        """Count a wrong token, before it is answered: many guesses at once are counted, too."""
        address = network_of(client)
        wrong, until = self._wrong.get(address, (0, -math.inf))
        left = until - self._clock()
        if left > 0:
            response = problem(429, "too many wrong tokens", "Authorization", f"try again in {math.ceil(left)} seconds")
            response.headers["Retry-After"] = str(math.ceil(left))
            return response
        self._note(address, wrong + 1)
        what = "this is not the robot's token" if said else "the robot's token is missing"
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
    """Return True for a request that tells a mission something."""
    return bool(scope["method"] == "POST" and scope["path"].endswith("/orders"))


class SmallBodyGate:
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
