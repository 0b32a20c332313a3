"""The person or program that sends a request, and what each route requires of it."""

from __future__ import annotations

import getpass
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from fastapi import Request

from fieldhand.api.problems import RefusedRequest
from fieldhand.api.serving import is_loopback


class Scope(str, Enum):
    """A right that a route requires."""

    READ = "read"
    PLAN = "plan"
    APPROVE = "approve"
    COMMAND = "command"
    ADMIN = "admin"


@dataclass(frozen=True, kw_only=True)
class Caller:
    """The person or program that sends a request.

    Attributes:
        name: Name, as approvals and logs state it.
        role: Name of its role.
        scopes: What it may do.
    """

    name: str
    role: str
    scopes: frozenset[Scope]


def require(scope: Scope) -> Callable[[Request], Caller]:
    """Return a FastAPI dependency that returns the caller, or refuses the request if it lacks a scope.

    Requests from this machine come from its user, who may do everything; those from other machines are refused.
    """

    def caller(request: Request) -> Caller:
        if request.client is None or not is_loopback(request.client.host):
            raise RefusedRequest(403, f"only this machine may do this ({scope.value})", "open the page on the server")
        return Caller(name=_user_name(), role="admin", scopes=frozenset(Scope))

    return caller


def _user_name() -> str:
    """Return the name of the user who runs the server."""
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return "unknown"
