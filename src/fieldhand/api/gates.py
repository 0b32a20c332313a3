"""What every request passes before a route sees it, and what every response carries.

Without a login, the browser is the weak point: a page elsewhere must not be able to call this server, be it under its
own name (DNS rebinding: the Host header tells), be it across origins (the Origin header tells); and a page of this
server runs only scripts that came from this server (the content security policy).
"""

from __future__ import annotations

import logging
from dataclasses import dataclass
from urllib.parse import urlsplit

import anyio
from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from fieldhand.api.problems import problem, too_big

log = logging.getLogger("fieldhand.api")

SECURITY_HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self';"
        " base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}


class SecurityHeaders:
    """Puts the security headers on every response; what a route does not let be kept is kept nowhere."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in SECURITY_HEADERS.items():
                    headers[name] = value
                headers.setdefault("Cache-Control", "no-store")
            await send(message)

        await self._app(scope, receive, with_headers)


class LastResort:
    """Answers what no handler foresaw, and writes the traceback to the log, where it belongs."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        started = False

        async def noted(message: Message) -> None:
            nonlocal started
            started = True
            await send(message)

        try:
            await self._app(scope, receive, noted)
        except Exception:
            if started or scope["type"] != "http":
                raise
            log.exception("%s %s failed", scope["method"], scope["path"])
            response = problem(500, "the server made a mistake", advice="its log says more; please report it")
            await response(scope, receive, send)


class CallerGate:
    """Turns away who calls this server by a name that is not its own, or from a page that is not its own.

    Args:
        hosts: Names that are its own, without port; None for any.
    """

    def __init__(self, app: ASGIApp, hosts: frozenset[str] | None) -> None:
        self._app = app
        self._hosts = hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            headers = Headers(scope=scope)
            host, origin = headers.get("host", ""), headers.get("origin")
            if self._hosts is not None and _name(f"//{host}") not in self._hosts:
                response = problem(403, "this server is not known by that name", "Host", "call it as localhost")
                await response(scope, receive, send)
                return
            if origin is not None and _origin_host(origin) != host.lower():
                response = problem(403, "a page of another site may not use this server", "Origin")
                await response(scope, receive, send)
                return
        await self._app(scope, receive, send)


def _origin_host(origin: str) -> str:
    """The host and port of an ``Origin`` header; empty for one that is none."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return ""


@dataclass(frozen=True, kw_only=True)
class BodyTime:
    """Seconds that the body of a request may take.

    Attributes:
        start_s, bytes_s: It has so many seconds, and one more for each so many bytes that have come.
        idle_s: Without a byte.
    """

    start_s: float = 10.0
    bytes_s: float = 20_000.0
    idle_s: float = 10.0


#: Bytes of a body that are always taken: a request in words is far smaller.
_SMALL = 64_000


class BodyGate:
    """Turns away a body above a size, by its declared size and by counting; and one that comes too slowly.

    Large bodies together have a bound, too; small ones are taken all the same.

    Args:
        most: Bytes of one body.
        time: What it may take.
        together: Bytes of all bodies that are being read or worked on; by default of four of the largest.
    """

    def __init__(self, app: ASGIApp, most: int, time: BodyTime | None = None, together: int | None = None) -> None:
        self._app = app
        self._most, self._time = most, time or BodyTime()
        self._together, self._held = 4 * most if together is None else together, 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        told = Headers(scope=scope).get("content-length", "0")
        if not told.isascii() or not told.isdigit() or len(told) > 15 or int(told) > self._most:
            await too_big()(scope, receive, send)
            return
        taken, whole, begun = 0, False, anyio.current_time()

        async def counted() -> Message:
            nonlocal taken, whole
            if whole:
                return await receive()  # for the end of the connection
            now, time = anyio.current_time(), self._time
            try:
                with anyio.fail_after(min(time.idle_s, begun + time.start_s + taken / time.bytes_s - now)):
                    message = await receive()
            except TimeoutError:
                raise HTTPException(408) from None
            if message["type"] == "http.request":
                whole = not message.get("more_body", False)
                size = len(message.get("body", b""))
                taken, self._held = taken + size, self._held + size
                # This type alone passes through the reading of the body as it is.
                if taken > self._most:
                    raise HTTPException(413)
                if taken > _SMALL and self._held > self._together:
                    raise HTTPException(503)
            return message

        try:
            await self._app(scope, counted, send)
        finally:
            self._held -= taken


def _name(url: str) -> str | None:
    """The host's name in a URL, without port and brackets; None where it is none."""
    try:
        parts = urlsplit(url)
        _ = parts.port
    except ValueError:
        return None
    return parts.hostname if parts.username is None else None
