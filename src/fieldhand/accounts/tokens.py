"""API tokens: secrets for programs, each with a name, scopes and an expiry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import Row, delete, insert, select, update

from fieldhand.accounts.people import LOCAL
from fieldhand.accounts.random_secrets import TOKEN_PREFIX, digest, new_secret
from fieldhand.accounts.roles import Role, Scope, parse_scopes, sorted_scopes
from fieldhand.database.connection import Database
from fieldhand.database.tables import ACCOUNTS, TOKENS
from fieldhand.errors import InputError
from fieldhand.language import message

#: Smallest time between two records of a token's use.
_NOTED = timedelta(minutes=1)
#: Largest number of tokens of an account.
_MOST = 100


@dataclass(frozen=True, kw_only=True)
class ApiToken:
    """An API token, without its secret.

    Attributes:
        id: Number in the database.
        name: What it is for, as its owner wrote it.
        account: Number of its owner's account; None for the local administrator.
        owner: Name of its owner.
        role: Role of its owner at present.
        scopes: Scopes that it was given.
        created_at, used_at, expires_at: Time of creation, of its last use if any, and at which it expires, if ever.
    """

    id: int
    name: str
    account: int | None
    owner: str
    role: Role
    scopes: frozenset[Scope]
    created_at: datetime
    used_at: datetime | None
    expires_at: datetime | None

    @property
    def effective_scopes(self) -> frozenset[Scope]:
        """The scopes of the token that its owner still has."""
        return self.scopes & self.role.scopes


_QUERY = select(TOKENS, ACCOUNTS.c.name.label("owner"), ACCOUNTS.c.role).select_from(TOKENS.outerjoin(ACCOUNTS))


class Tokens:
    """The API tokens in a database.

    Args:
        database: The server's database.
        now: Returns the time.
    """

    def __init__(self, database: Database, now: Callable[[], datetime]) -> None:
        self._database, self._now = database, now

    def add(
        self, account: int | None, name: str, scopes: frozenset[Scope], valid: timedelta | None
    ) -> tuple[str, ApiToken]:
        """Add a token, and return its secret and the token.

        Args:
            account: Number of its owner's account; None for the local administrator.
            name: What it is for.
            scopes: Its scopes.
            valid: Time in which it can be used; None for any.

        Raises:
            InputError: The account has too many tokens.
        """
        now, secret = self._now(), TOKEN_PREFIX + new_secret()
        with self._database.transaction() as connection:
            held = len(
                connection.execute(select(TOKENS.c.id).where(TOKENS.c.account.is_not_distinct_from(account))).all()
            )
            if held >= _MOST:
                raise InputError(
                    message("an account has at most {most} tokens", most=_MOST), advice=message("revoke one")
                )
            connection.execute(
                insert(TOKENS).values(
                    secret_sha256=digest(secret),
                    account=account,
                    name=name,
                    scopes=" ".join(sorted_scopes(scopes)),
                    created_at=now,
                    expires_at=None if valid is None else now + valid,
                )
            )
            row = connection.execute(_QUERY.where(TOKENS.c.secret_sha256 == digest(secret))).one()
            return secret, _token(row)

    def all(self) -> tuple[ApiToken, ...]:
        """Return all tokens, the oldest first."""
        with self._database.transaction(reading=True) as connection:
            return tuple(map(_token, connection.execute(_QUERY.order_by(TOKENS.c.id))))

    def find(self, secret: str) -> ApiToken | None:
        """Return the token of a secret, and record its use; None if it has expired or never was."""
        if not secret.startswith(TOKEN_PREFIX):
            return None
        now = self._now()
        with self._database.transaction(reading=True) as connection:
            row = connection.execute(_QUERY.where(TOKENS.c.secret_sha256 == digest(secret))).first()
        if row is None or (row.expires_at is not None and row.expires_at <= now):
            return None
        if row.used_at is None or now - row.used_at >= _NOTED:
            with self._database.transaction() as connection:
                connection.execute(update(TOKENS).where(TOKENS.c.id == row.id).values(used_at=now))
        return _token(row)

    def revoke(self, number: int) -> ApiToken:
        """Delete a token.

        Raises:
            InputError: There is none of this number.
        """
        with self._database.transaction() as connection:
            row = connection.execute(_QUERY.where(TOKENS.c.id == number)).first()
            if row is None:
                raise InputError(message("there is no such token"), where=str(number))
            connection.execute(delete(TOKENS).where(TOKENS.c.id == number))
            return _token(row)


def _token(row: Row[Any]) -> ApiToken:
    return ApiToken(
        id=row.id,
        name=row.name,
        account=row.account,
        owner=LOCAL if row.account is None else row.owner,
        role=Role.ADMIN if row.account is None else Role(row.role),
        scopes=parse_scopes(row.scopes.split()),
        created_at=row.created_at,
        used_at=row.used_at,
        expires_at=row.expires_at,
    )
