"""Log in and out: sessions in a cookie that no script can read."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Request, Response
from pydantic import Field

from fieldhand.accounts.people import LOCAL, Account, key_of
from fieldhand.accounts.random_secrets import csrf_of, new_secret, same
from fieldhand.accounts.roles import sorted_scopes
from fieldhand.accounts.sessions import LoginSession
from fieldhand.api.account_service import AccountService
from fieldhand.api.callers import COOKIE, Caller, Scope, cookie_of, require, secret_of
from fieldhand.api.inputs import Body, Lang, Text
from fieldhand.api.problems import RefusedRequest
from fieldhand.language import message

#: A password as it was typed; the largest that can be right is shorter.
Password = Annotated[Text, Field(max_length=1000)]
#: Cookie of a browser in which an account has logged in, and the time for which it is kept.
DEVICE_COOKIE = "fieldhand_device"
_DEVICE = timedelta(days=400)
_SESSION_PATH = "/api/v1/session"
_CodeText = Annotated[Text, Field(max_length=200)]


class LoginBody(Body):
    """Name and password of an account."""

    name: Annotated[Text, Field(max_length=200)]
    password: Password


class CodeBody(Body):
    """A code that was printed by the server, or by ``fieldhand accounts link``."""

    code: _CodeText


class LanguageBody(Body):
    """A language for messages."""

    language: Lang


class OwnPasswordBody(Body):
    """A new password of the caller, and the present one."""

    present: Password
    new: Password


def router(service: AccountService) -> APIRouter:
    """``POST /session``, ``POST /session/code``, and the session of the caller."""
    routes = APIRouter(tags=["session"], prefix="/session")
    accounts = service.accounts

    @routes.post("")
    async def login(body: LoginBody, request: Request, response: Response) -> dict[str, Any]:
        """Open a session with name and password."""
        account = await _attempt(service, request, body.name, body.password)
        if account is None:
            raise RefusedRequest(
                401,
                message("the name or the password is wrong"),
                message("try again; an administrator can set another password"),
            )
        return await _open(service, request, response, account)

    @routes.post("/code")
    async def login_by_code(body: CodeBody, request: Request, response: Response) -> dict[str, Any]:
        """Open a session of the local administrator with a single-use code."""

        async def verify() -> bool | None:
            return await service.do(lambda: accounts.codes.use(body.code)) or None

        if not await service.throttle.attempt(_address(request), "", verify):
            raise RefusedRequest(
                401,
                message("this link was used already, or has expired"),
                message("type {command} where the server runs, for another one", command="fieldhand accounts link"),
            )
        return await _open(service, request, response, None)

    @routes.get("")
    async def session(request: Request, caller: Annotated[Caller, Depends(require(Scope.READ))]) -> dict[str, Any]:
        """Return who calls, with which rights."""
        return _answer(caller.name, caller.role, caller.language, caller.scopes, _csrf(request, caller))

    @routes.delete("")
    async def logout(
        request: Request, response: Response, caller: Annotated[Caller, Depends(require(Scope.READ))]
    ) -> dict[str, Any]:
        """End the session."""
        _require_session(caller)
        await service.do(lambda: accounts.sessions.close(secret_of(request)))
        await service.do(lambda: accounts.audit.add(caller.name, "logout", address=caller.address))
        response.delete_cookie(COOKIE, path="/", secure=_is_tls(request), httponly=True, samesite="strict")
        return {"outcome": "logged out"}

    @routes.patch("")
    async def change_language(
        body: LanguageBody, request: Request, caller: Annotated[Caller, Depends(require(Scope.READ))]
    ) -> dict[str, Any]:
        """Change the language of the caller."""
        _require_session(caller)
        if caller.account is None:
            await service.do(lambda: accounts.sessions.set_language(secret_of(request), body.language))
        else:
            await service.do(lambda: accounts.people.change(caller.name, language=body.language))
        return _answer(caller.name, caller.role, body.language, caller.scopes, _csrf(request, caller))

    @routes.put("/password")
    async def change_password(
        body: OwnPasswordBody,
        request: Request,
        response: Response,
        caller: Annotated[Caller, Depends(require(Scope.READ))],
    ) -> dict[str, Any]:
        """Change the password of the caller, end all sessions of the account, and open another one."""
        _require_session(caller)
        if caller.account is None:
            raise RefusedRequest(
                409,
                message("the local administrator has no password"),
                message("add an account for yourself"),
            )
        if await _attempt(service, request, caller.name, body.present) is None:
            raise RefusedRequest(403, message("the present password is wrong"), message("try again"))
        account = await service.do(lambda: accounts.people.set_password(caller.name, body.new))
        await service.do(lambda: accounts.audit.add(caller.name, "password", caller.name, address=caller.address))
        return await _open(service, request, response, account)

    return routes


async def _attempt(service: AccountService, request: Request, name: str, password: str) -> Account | None:
    """Verify name and password, and record it if they are wrong."""
    address, people = _address(request), service.accounts.people
    nonce, _, proof = cookie_of(request.headers, DEVICE_COOKIE).partition(".")
    known = bool(proof) and same(proof, await service.do(lambda: people.device_proof(name, nonce)))

    async def verify() -> Account | None:
        return await service.do(lambda: people.verify(name, password))

    async def record(count: int) -> None:
        # The log grows with the logarithm of the number of guesses, so that a guesser cannot fill the disk.
        if count & (count - 1) == 0:
            log = service.accounts.audit
            await service.do(lambda: log.add(name, "login failed", address=address, wrong_from_this_address=count))

    return await service.throttle.attempt(f"device {nonce}" if known else address, key_of(name), verify, record)


async def _open(
    service: AccountService, request: Request, response: Response, account: Account | None
) -> dict[str, Any]:
    """Open a session, set its cookie, and record the login."""
    accounts, address = service.accounts, _address(request)
    secret, session = await service.do(lambda: accounts.sessions.open(account))
    means = "code" if account is None else "password"
    if account is not None:
        nonce = new_secret()
        proof = await service.do(lambda: accounts.people.device_proof(account.name, nonce))
        _set_cookie(request, response, DEVICE_COOKIE, f"{nonce}.{proof}", session.expires_at + _DEVICE, _SESSION_PATH)
    await service.do(lambda: accounts.audit.add(session.name, "login", address=address, means=means))
    _set_cookie(request, response, COOKIE, secret, session.expires_at)
    return _session_answer(session, secret)


def _set_cookie(
    request: Request, response: Response, name: str, value: str, expires_at: datetime, path: str = "/"
) -> None:
    secure = _is_tls(request)
    response.set_cookie(name, value, expires=expires_at, path=path, secure=secure, httponly=True, samesite="strict")


def _session_answer(session: LoginSession, secret: str) -> dict[str, Any]:
    return _answer(session.name, session.role, session.language, session.role.scopes, csrf_of(secret))


def _answer(name: str, role: Any, language: str, scopes: frozenset[Scope], csrf: str) -> dict[str, Any]:
    return {
        "name": name,
        "local": name == LOCAL,
        "role": role.value,
        "language": language,
        "scopes": list(sorted_scopes(scopes)),
        "csrf": csrf,
    }


def _csrf(request: Request, caller: Caller) -> str:
    return csrf_of(secret_of(request)) if caller.means == "session" else ""


def _require_session(caller: Caller) -> None:
    """Require that the caller has logged in.

    Raises:
        RefusedRequest: The request has a token instead.
    """
    if caller.means != "session":
        raise RefusedRequest(403, message("this needs a session, not a token"), message("log in with your password"))


def _address(request: Request) -> str:
    return request.client.host if request.client else ""


def _is_tls(request: Request) -> bool:
    return request.url.scheme == "https"
