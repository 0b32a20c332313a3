"""Single-use codes that open a session of the local administrator: whoever can read them started the server."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta

from sqlalchemy import delete, insert

from fieldhand.accounts.random_secrets import digest, new_secret
from fieldhand.database.connection import Database
from fieldhand.database.tables import LOGIN_CODES

#: Time in which a code can be used.
VALID = timedelta(hours=12)


class LoginCodes:
    """The login codes in a database.

    Args:
        database: The server's database.
        now: Returns the time.
    """

    def __init__(self, database: Database, now: Callable[[], datetime]) -> None:
        self._database, self._now = database, now

    def new(self) -> str:
        """Return a new code; delete those that have expired."""
        now, code = self._now(), new_secret()
        with self._database.transaction() as connection:
            connection.execute(delete(LOGIN_CODES).where(LOGIN_CODES.c.expires_at <= now))
            connection.execute(
                insert(LOGIN_CODES).values(secret_sha256=digest(code), created_at=now, expires_at=now + VALID)
            )
        return code

    def use(self, code: str) -> bool:
        """Return True for a valid code, which cannot be used again."""
        with self._database.transaction() as connection:
            used = connection.execute(
                delete(LOGIN_CODES).where(
                    LOGIN_CODES.c.secret_sha256 == digest(code), LOGIN_CODES.c.expires_at > self._now()
                )
            )
            return used.rowcount == 1
