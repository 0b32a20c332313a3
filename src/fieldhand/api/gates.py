"""Middleware: host and origin checks, limits on bodies, security headers, and the response to unexpected errors.

The server has no login, so a page of another site must not be able to call it, neither by DNS rebinding (the Host
header is checked) nor across origins (the Origin header is checked). The content security policy restricts a page of
this server to scripts of this server.
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
    """Adds the security headers to every response, unless the route has its own, and forbids caching likewise."""

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
                    headers.setdefault(name, value)
                headers.setdefault("Cache-Control", "no-store")
            await send(message)

        await self._app(scope, receive, with_headers)


class LastResort:
    """Responds to unexpected errors with status 500, and logs the traceback."""

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
            response = problem(
                500, "an internal error occurred in the server", advice="see its log, and please report it"
            )
            await response(scope, receive, send)


class CallerGate:
    """Refuses requests to other host names, and requests from pages of other sites.

    Args:
        hosts: Host names of the server, without port; None for any.
    """

    def __init__(self, app: ASGIApp, hosts: frozenset[str] | None) -> None:
        self._app = app
        self._hosts = hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            headers = Headers(scope=scope)
            host, origin = headers.get("host", ""), headers.get("origin")
            if self._hosts is not None and host_name(host) not in self._hosts:
                response = problem(403, "this server does not answer under that name", "Host", "call it as localhost")
                await response(scope, receive, send)
                return
            if origin is not None and _origin_host(origin) != host.lower():
                response = problem(403, "a page of another site may not use this server", "Origin")
                await response(scope, receive, send)
                return
        await self._app(scope, receive, send)


def _origin_host(origin: str) -> str:
    """Return host and port of an ``Origin`` header; empty for an invalid one."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return ""


@dataclass(frozen=True, kw_only=True)
class BodyTime:
    """Time limits on the body of a request.

    Attributes:
        start_s: Seconds for any body.
        bytes_s: Received bytes for which it has one more second.
        idle_s: Seconds without a byte.
    """

    start_s: float = 10.0
    bytes_s: float = 20_000.0
    idle_s: float = 10.0


#: Size of a body, in bytes, that is always accepted; a request in words is far smaller.
_SMALL = 64_000


class BodyGate:
    """Refuses bodies that are too large, by their declared and their counted size, and bodies that are too slow.

    The total size of all bodies is limited, too, except for small ones.

    Args:
        most: Largest size of a body, in bytes.
        time: Time limits.
        together: Largest total size of all bodies in memory; by default that of four of the largest.
    """

    def __init__(self, app: ASGIApp, most: int, time: BodyTime | None = None, together: int | None = None) -> None:
        self._app = app
        self._most, self._time = most, time or BodyTime()
        self._together, self._held = 4 * most if together is None else together, 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        declared = Headers(scope=scope).get("content-length", "0")
        if not declared.isascii() or not declared.isdigit() or len(declared) > 15 or int(declared) > self._most:
            await too_big()(scope, receive, send)
            return
        taken, whole, begun = 0, False, anyio.current_time()

        async def counted() -> Message:
            nonlocal taken, whole
            if whole:
                return await receive()  # waits for the end of the connection
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
                # Starlette lets only exceptions of this type pass through the reading of a body.
                if taken > self._most:
                    raise HTTPException(413)
                if taken > _SMALL and self._held > self._together:
                    raise HTTPException(503)
            return message

        try:
            await self._app(scope, counted, send)
        finally:
            self._held -= taken


def host_name(host: str) -> str | None:
    """Return the name in a ``Host`` header, without port and brackets; None for an invalid one."""
    try:
        parts = urlsplit(f"//{host}")
        _ = parts.port
    except ValueError:
        return None
    return parts.hostname if parts.username is None else None
