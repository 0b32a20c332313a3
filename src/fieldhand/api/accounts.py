"""Manage accounts: for administrators."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Depends
from pydantic import Field

from fieldhand.accounts.people import Account
from fieldhand.accounts.roles import Role
from fieldhand.api.account_service import AccountService
from fieldhand.api.callers import Caller, Scope, require
from fieldhand.api.inputs import Body, Lang, Text
from fieldhand.api.session import Password

Admin = Annotated[Caller, Depends(require(Scope.ADMIN))]


class NewAccountBody(Body):
    """An account to add."""

    name: Annotated[Text, Field(max_length=200)]
    password: Password
    role: Role
    language: Lang = "en"


class AccountChangeBody(Body):
    """Changes of an account; what is left out remains."""

    role: Role | None = None
    language: Lang | None = None
    password: Password | None = None


def router(service: AccountService) -> APIRouter:
    """``GET /accounts``, ``POST /accounts``, ``PATCH`` and ``DELETE /accounts/{name}``."""
    routes = APIRouter(tags=["accounts"], prefix="/accounts")
    accounts = service.accounts

    @routes.get("")
    async def listed(_: Admin) -> list[dict[str, Any]]:
        """List the accounts."""
        return [account_record(one) for one in await service.do(accounts.people.all)]

    @routes.post("", status_code=201)
    async def add(body: NewAccountBody, caller: Admin) -> dict[str, Any]:
        """Add an account."""

        def work() -> Account:
            account = accounts.people.add(body.name, body.password, body.role, body.language)
            accounts.audit.add(
                caller.name, "account added", account.name, address=caller.address, role=account.role.value
            )
            return account

        return account_record(await service.do(work))

    @routes.patch("/{name}")
    async def change(name: str, body: AccountChangeBody, caller: Admin) -> dict[str, Any]:
        """Change role, language or password; a new password ends the sessions of the account."""

        def work() -> Account:
            if body.password is not None:
                account = accounts.people.set_password(name, body.password)
                accounts.audit.add(caller.name, "password", account.name, address=caller.address)
            account = accounts.people.change(name, role=body.role, language=body.language)
            if body.role is not None:
                accounts.audit.add(caller.name, "role", account.name, address=caller.address, role=body.role.value)
            return account

        return account_record(await service.do(work))

    @routes.delete("/{name}")
    async def remove(name: str, caller: Admin) -> dict[str, Any]:
        """Remove an account with its sessions and tokens."""

        def work() -> Account:
            account = accounts.people.remove(name)
            accounts.audit.add(caller.name, "account removed", account.name, address=caller.address)
            return account

        return account_record(await service.do(work))

    return routes


def account_record(account: Account) -> dict[str, Any]:
    """Return an account as JSON."""
    return {
        "name": account.name,
        "role": account.role.value,
        "language": account.language,
        "created_at": account.created_at.isoformat(),
    }
