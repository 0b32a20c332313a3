"""The accounts of a server: everything that its database holds about people and programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime

from fieldhand.accounts.audit_log import AuditLog
from fieldhand.accounts.login_codes import LoginCodes
from fieldhand.accounts.passwords import Passwords
from fieldhand.accounts.people import People
from fieldhand.accounts.sessions import SessionLimits, Sessions
from fieldhand.accounts.tokens import Tokens
from fieldhand.compatibility import UTC
from fieldhand.database.connection import Database, open_database


@dataclass(frozen=True, kw_only=True)
class Accounts:
    """People, their sessions and tokens, login codes and the audit log, in one database.

    Attributes:
        database: The database.
        people: People who may log in.
        sessions: Open sessions.
        tokens: API tokens.
        codes: Single-use login codes.
        audit: The audit log.
    """

    database: Database
    people: People
    sessions: Sessions
    tokens: Tokens
    codes: LoginCodes
    audit: AuditLog

    def close(self) -> None:
        """Close the database."""
        self.database.close()


def open_accounts(environ: Mapping[str, str]) -> Accounts:
    """Open the accounts in the database that the environment names.

    Raises:
        InputError: The environment names no database that can be used.
        DatabaseError: The database cannot be opened.
    """
    return accounts_in(open_database(environ))


def accounts_in(
    database: Database,
    *,
    passwords: Passwords | None = None,
    now: Callable[[], datetime] = lambda: datetime.now(UTC),
    limits: SessionLimits | None = None,
) -> Accounts:
    """Return the accounts in an opened database.

    Args:
        database: The database.
        passwords: Hashes passwords.
        now: Returns the time.
        limits: Times after which a session ends.
    """
    return Accounts(
        database=database,
        people=People(database, passwords or Passwords(), now),
        sessions=Sessions(database, now, limits),
        tokens=Tokens(database, now),
        codes=LoginCodes(database, now),
        audit=AuditLog(database, now),
    )
