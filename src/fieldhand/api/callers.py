"""Callers of the API: who they are by session, token or address, and the dependency that guards every route.

:class:`CredentialGate` identifies the caller before any byte of a body is read; :func:`require` decides.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from typing import Any, Literal

from fastapi import Request
from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Send
from starlette.types import Scope as ConnectionScope

from fieldhand.accounts.people import LOCAL
from fieldhand.accounts.random_secrets import TOKEN_PREFIX, csrf_of, same
from fieldhand.accounts.roles import Role, Scope
from fieldhand.api.account_service import AccountService
from fieldhand.api.admission import Rank, set_rank
from fieldhand.api.gates import BodyGate, host_name
from fieldhand.api.problems import RefusedRequest
from fieldhand.api.serving import is_loopback
from fieldhand.errors import FieldhandError
from fieldhand.language import message

__all__ = [
    "COOKIE",
    "CSRF_HEADER",
    "Caller",
    "CredentialGate",
    "Scope",
    "approver",
    "cookie_of",
    "is_still_allowed",
    "require",
    "secret_of",
]

COOKIE = "fieldhand_session"
CSRF_HEADER = "X-Fieldhand-CSRF"
#: Prefix of the routes that need a credential.
GUARDED = "/api/v1/"
#: Addresses of the logins.
LOGIN = (f"{GUARDED}session", f"{GUARDED}session/code")
#: Prefix of the routes that serve this machine alone.
_UNVERSIONED = "/api/"
#: Largest body of a caller without a credential, in bytes.
_STRANGERS_BODY = 64_000
#: Methods that change nothing.
_SAFE = frozenset({"GET", "HEAD", "OPTIONS"})
#: Keys in a request's state.
_CALLER, _SERVICE = "fieldhand.caller", "fieldhand.accounts"


@dataclass(frozen=True, kw_only=True)
class Caller:
    """The identified sender of a request.

    Attributes:
        name: Name of the account; ``local`` for the local administrator.
        role: Role of the account.
        scopes: Rights of this request, which a token may limit further than the role.
        account: Number of the account; None for the local administrator.
        language: Code of the account's language.
        address: Address of the client.
        means: How the caller was identified.
    """

    name: str
    role: Role
    scopes: frozenset[Scope]
    account: int | None = None
    language: str = "en"
    address: str = ""
    means: Literal["session", "token", "address"] = "address"


class CredentialGate:
    """Middleware that identifies the caller of each request, and limits the bodies of strangers.

    Below ``/api/v1`` a session or a token is required; without accounts, only this machine may call. The other
    addresses below ``/api`` are for this machine alone.

    Args:
        service: Accounts of the server; None for none.
    """

    def __init__(self, app: ASGIApp, service: AccountService | None) -> None:
        self._app, self._service = app, service
        self._strangers = BodyGate(app, _STRANGERS_BODY)

    async def __call__(self, scope: ConnectionScope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or not scope["path"].startswith(_UNVERSIONED):
            await self._app(scope, receive, send)
            return
        state: dict[str, Any] = scope.setdefault("state", {})
        found = state[_CALLER] = await _identified(scope, self._service)
        state[_SERVICE] = self._service
        if not isinstance(found, Caller) and scope["path"] not in LOGIN:
            set_rank(scope, Rank.WAITING)
        elif isinstance(found, Caller) and scope["method"] == "POST" and scope["path"].endswith("/commands"):
            set_rank(scope, Rank.OPERATOR)
        await (self._app if isinstance(found, Caller) else self._strangers)(scope, receive, send)


def require(scope: Scope) -> Callable[[Request], Awaitable[Caller]]:
    """Return the dependency of a route that admits callers with a scope, and returns who calls.

    Raises (in the dependency):
        RefusedRequest: There is no valid credential (status 401), it has not the scope, or the request may come from
            another site's page (403).
    """

    async def guard(request: Request) -> Caller:
        return _admitted(getattr(request.state, _CALLER, None), scope)

    guard.required_scope = scope  # type: ignore[attr-defined]
    return guard


def approver(caller: Caller, named: str | None) -> str:
    """Return the name under which a caller approves: the name of the account, or the one that a local caller gives.

    Args:
        caller: Who calls.
        named: Name in the request, if any.

    Raises:
        RefusedRequest: The name is another account's (status 403), or missing (422).
    """
    if caller.account is None:
        if named is None:
            raise RefusedRequest(
                422, message("this is missing"), message("give the name of who approves"), "approved_by"
            )
        return named
    if named is not None and named != caller.name:
        raise RefusedRequest(
            403,
            message("you are logged in as {name}, and approve under this name alone", name=caller.name),
            message("leave {field} out, or log in as somebody else", field="approved_by"),
            "approved_by",
        )
    return caller.name


async def is_still_allowed(request: Request, scope: Scope) -> bool:
    """Return True if the caller of a long response, such as a stream, still has a scope: sessions and tokens end."""
    try:
        _admitted(await _identified(request.scope, getattr(request.state, _SERVICE, None)), scope)
    except RefusedRequest:
        return False
    return True


def secret_of(request: Request) -> str:
    """Return the secret of the session in a request's cookie; empty if there is none."""
    return cookie_of(request.headers, COOKIE)


def _admitted(found: object, scope: Scope) -> Caller:
    """Return the caller if the scope is there.

    Raises:
        RefusedRequest: It is not.
    """
    if isinstance(found, RefusedRequest):
        raise found
    if not isinstance(found, Caller):
        raise _login_first()
    if scope not in found.scopes:
        raise RefusedRequest(
            403,
            message(
                "this needs the right '{scope}', which {name} does not have here", scope=scope.value, name=found.name
            ),
            message("ask an administrator for another role, or take a token with this scope"),
        )
    return found


async def _identified(scope: ConnectionScope, service: AccountService | None) -> Caller | RefusedRequest:
    """Return the caller of a request, or the reason why nobody is identified."""
    address = (scope.get("client") or ("", 0))[0]
    if service is None or not scope["path"].startswith(GUARDED):
        # A page whose name leads to this machine (DNS rebinding) calls from here, but under that name.
        if is_loopback(address) and is_loopback(host_name(Headers(scope=scope).get("host", "")) or ""):
            return Caller(name=LOCAL, role=Role.ADMIN, scopes=Role.ADMIN.scopes, address=address)
        return RefusedRequest(
            403,
            message("this address of the API is for the server's own machine alone"),
            message("log in, and use the addresses below {prefix}", prefix=GUARDED),
        )
    headers = Headers(scope=scope)
    kind, _, given = headers.get("authorization", "").partition(" ")
    try:
        if kind.lower() == "bearer":
            return await _by_token(given.strip(), address, service)
        return await _by_cookie(scope["method"], headers, address, service)
    except FieldhandError as error:  # the database
        return RefusedRequest(503, error.what, error.advice)


async def _by_token(secret: str, address: str, service: AccountService) -> Caller | RefusedRequest:
    token = await service.do(lambda: service.accounts.tokens.find(secret))
    if token is None:
        return RefusedRequest(
            401,
            message("this token is unknown, revoked or expired"),
            message("create another one; a token begins with {prefix}", prefix=TOKEN_PREFIX),
        )
    return Caller(
        name=token.owner,
        role=token.role,
        scopes=token.effective_scopes,
        account=token.account,
        address=address,
        means="token",
    )


async def _by_cookie(method: str, headers: Headers, address: str, service: AccountService) -> Caller | RefusedRequest:
    secret = cookie_of(headers, COOKIE)
    session = await service.do(lambda: service.accounts.sessions.find(secret)) if secret else None
    if session is None:
        return _login_first()
    if method not in _SAFE and not same(headers.get(CSRF_HEADER, ""), csrf_of(secret)):
        return RefusedRequest(
            403,
            message("the header {header} is missing or wrong", header=CSRF_HEADER),
            message("send the csrf that {route} returns", route="GET /api/v1/session"),
        )
    return Caller(
        name=session.name,
        role=session.role,
        scopes=session.role.scopes,
        account=session.account,
        language=session.language,
        address=address,
        means="session",
    )


def _login_first() -> RefusedRequest:
    return RefusedRequest(
        401,
        message("you are not logged in, or your session has ended"),
        message("log in, or send a token as Authorization: Bearer {prefix}...", prefix=TOKEN_PREFIX),
    )


def cookie_of(headers: Headers, name: str) -> str:
    """Return the value of a cookie; empty if there is none."""
    try:
        found = SimpleCookie(headers.get("cookie", "")).get(name)
    except CookieError:
        return ""
    return "" if found is None else found.value
