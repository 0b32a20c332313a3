"""Roles of people, and the scopes that each role includes."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from fieldhand.errors import InputError
from fieldhand.language import message


class Scope(str, Enum):
    """A right that a route requires.

    ``READ``: see sites, robots, missions and results. ``PLAN``: plan requests and check plans. ``APPROVE``: approve
    plans. ``COMMAND``: start, pause and stop missions. ``ADMIN``: manage accounts and read the audit log.
    """

    READ = "read"
    PLAN = "plan"
    APPROVE = "approve"
    COMMAND = "command"
    ADMIN = "admin"


class Role(str, Enum):
    """The role of a person; each includes the ones before it."""

    VIEWER = "viewer"
    PLANNER = "planner"
    APPROVER = "approver"
    ADMIN = "admin"

    @property
    def scopes(self) -> frozenset[Scope]:
        """The scopes of the role."""
        roles = tuple(Role)
        return frozenset().union(*(_ADDED[role] for role in roles[: roles.index(self) + 1]))


#: Scopes of a role beyond those of the role before it.
_ADDED: dict[Role, frozenset[Scope]] = {
    Role.VIEWER: frozenset({Scope.READ}),
    Role.PLANNER: frozenset({Scope.PLAN}),
    Role.APPROVER: frozenset({Scope.APPROVE, Scope.COMMAND}),
    Role.ADMIN: frozenset({Scope.ADMIN}),
}


def parse_role(text: str) -> Role:
    """Return the role of a name.

    Raises:
        InputError: There is no such role.
    """
    try:
        return Role(text)
    except ValueError:
        raise InputError(
            message("there is no role '{role}'", role=text),
            where=message("role"),
            advice=message("choose one of {names}", names=", ".join(role.value for role in Role)),
        ) from None


def parse_scopes(names: Iterable[str]) -> frozenset[Scope]:
    """Return the scopes of these names.

    Raises:
        InputError: There is no such scope, or no name.
    """
    found = set()
    for name in names:
        try:
            found.add(Scope(name))
        except ValueError:
            raise InputError(
                message("there is no scope '{scope}'", scope=name), where=message("scopes"), advice=_choose_scopes()
            ) from None
    if not found:
        raise InputError(message("no scope is given"), where=message("scopes"), advice=_choose_scopes())
    return frozenset(found)


def sorted_scopes(scopes: Iterable[Scope]) -> tuple[str, ...]:
    """Return the names of scopes, from the least to the most powerful."""
    there = set(scopes)
    return tuple(scope.value for scope in Scope if scope in there)


def _choose_scopes() -> str:
    return message("choose from {names}", names=", ".join(scope.value for scope in Scope))
