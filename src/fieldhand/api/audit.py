"""The audit log: who asked, planned, approved and sent what."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import asdict
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Query

from fieldhand.accounts.audit_log import MOST
from fieldhand.api.account_service import AccountService
from fieldhand.api.callers import Caller, Scope, require

#: Records what a caller did: ``await record(caller, "approve", task, site="demo")``.
Record = Callable[..., Awaitable[None]]


def recorder(service: AccountService | None) -> Record:
    """Return a function that adds an entry to the audit log; without accounts, one that does nothing."""

    async def record(caller: Caller, what: str, about: str = "", **details: Any) -> None:
        if service is not None:
            log = service.accounts.audit
            await service.do(lambda: log.add(caller.name, what, about, address=caller.address, **details))

    return record


def router(service: AccountService) -> APIRouter:
    """``GET /audit``."""
    routes = APIRouter(tags=["audit"])

    @routes.get("/audit")
    async def entries(
        _: Annotated[Caller, Depends(require(Scope.ADMIN))],
        before: Annotated[int | None, Query(ge=0, lt=2**31)] = None,
        who: Annotated[str | None, Query(max_length=200)] = None,
        what: Annotated[str | None, Query(max_length=100)] = None,
        most: Annotated[int, Query(ge=1, le=MOST)] = 100,
    ) -> list[dict[str, Any]]:
        """Return the latest entries, the last first; ``before`` continues with older ones."""
        log = service.accounts.audit
        found = await service.do(lambda: log.entries(before=before, who=who, what=what, most=most))
        return [{**asdict(entry), "at": entry.at.isoformat()} for entry in found]

    return routes
