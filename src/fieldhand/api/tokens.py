"""API tokens of the caller; administrators see and revoke those of everybody."""

from __future__ import annotations

from datetime import timedelta
from typing import Annotated, Any

from fastapi import APIRouter, Depends
from pydantic import Field

from fieldhand.accounts.roles import sorted_scopes
from fieldhand.accounts.tokens import ApiToken
from fieldhand.api.account_service import AccountService
from fieldhand.api.callers import Caller, Scope, require
from fieldhand.api.inputs import Body, Name
from fieldhand.api.problems import RefusedRequest
from fieldhand.language import message

Reader = Annotated[Caller, Depends(require(Scope.READ))]


class NewTokenBody(Body):
    """A token to create: what it is for, its scopes, and the days in which it can be used."""

    name: Name
    scopes: Annotated[list[Scope], Field(min_length=1, max_length=len(Scope))]
    days: Annotated[int, Field(ge=1, le=3650)] | None = 90


def router(service: AccountService) -> APIRouter:
    """``GET /tokens``, ``POST /tokens``, ``DELETE /tokens/{id}``."""
    routes = APIRouter(tags=["tokens"], prefix="/tokens")
    accounts = service.accounts

    @routes.get("")
    async def listed(caller: Reader) -> list[dict[str, Any]]:
        """List the tokens of the caller, or of everybody for an administrator, without their secrets."""
        return [token_record(one) for one in await service.do(accounts.tokens.all) if _may_see(caller, one)]

    @routes.post("", status_code=201)
    async def add(body: NewTokenBody, caller: Reader) -> dict[str, Any]:
        """Create a token with scopes that the caller has; only this response contains its secret."""
        scopes = frozenset(body.scopes)
        if caller.means == "token":
            raise RefusedRequest(
                403, message("a token cannot create another one"), message("log in with your password")
            )
        if not scopes <= caller.scopes:
            raise RefusedRequest(
                403,
                message("you do not have these rights yourself: {names}", names=", ".join(_beyond(scopes, caller))),
                message("leave them out"),
            )
        valid = None if body.days is None else timedelta(days=body.days)

        def work() -> dict[str, Any]:
            secret, token = accounts.tokens.add(caller.account, body.name, scopes, valid)
            accounts.audit.add(
                caller.name,
                "token created",
                token.name,
                address=caller.address,
                id=token.id,
                scopes=" ".join(sorted_scopes(scopes)),
            )
            return {"token": secret, **token_record(token)}

        return await service.do(work)

    @routes.delete("/{number}")
    async def revoke(number: Annotated[int, Field(ge=0, lt=2**31)], caller: Reader) -> dict[str, Any]:
        """Revoke a token of the caller, or of anybody for an administrator."""

        def work() -> dict[str, Any]:
            # A token of somebody else looks like one that does not exist.
            if not any(token.id == number and _may_see(caller, token) for token in accounts.tokens.all()):
                raise RefusedRequest(404, message("there is no such token"), message("see the list of tokens"))
            token = accounts.tokens.revoke(number)
            accounts.audit.add(
                caller.name, "token revoked", token.name, address=caller.address, id=token.id, owner=token.owner
            )
            return token_record(token)

        return await service.do(work)

    return routes


def token_record(token: ApiToken) -> dict[str, Any]:
    """Return a token as JSON, without its secret."""
    return {
        "id": token.id,
        "name": token.name,
        "owner": token.owner,
        "scopes": list(sorted_scopes(token.scopes)),
        "created_at": token.created_at.isoformat(),
        "used_at": None if token.used_at is None else token.used_at.isoformat(),
        "expires_at": None if token.expires_at is None else token.expires_at.isoformat(),
    }


def _may_see(caller: Caller, token: ApiToken) -> bool:
    return Scope.ADMIN in caller.scopes or token.account == caller.account


def _beyond(scopes: frozenset[Scope], caller: Caller) -> tuple[str, ...]:
    return sorted_scopes(scopes - caller.scopes)
