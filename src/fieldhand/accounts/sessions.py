"""Sessions of people who logged in, with an idle and an absolute expiry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import delete, insert, or_, select, update

from fieldhand.accounts.people import LOCAL, Account
from fieldhand.accounts.random_secrets import digest, new_secret
from fieldhand.accounts.roles import Role
from fieldhand.database.connection import Database
from fieldhand.database.tables import ACCOUNTS, SESSIONS


@dataclass(frozen=True, kw_only=True)
class SessionLimits:
    """Times after which a session ends.

    Attributes:
        idle: Time without a request.
        absolute: Time since the login.
        noted: Smallest time between two records of a request, so that not every request writes.
    """

    idle: timedelta = timedelta(hours=12)
    absolute: timedelta = timedelta(days=7)
    noted: timedelta = timedelta(minutes=1)


@dataclass(frozen=True, kw_only=True)
class LoginSession:
    """An open session.

    Attributes:
        account: Number of the account; None for the local administrator.
        name: Name of the account.
        role: Its role at present.
        language: Code of its language.
        expires_at: Time at which the session ends at the latest.
    """

    account: int | None
    name: str
    role: Role
    language: str
    expires_at: datetime


class Sessions:
    """The sessions in a database.

    Args:
        database: The server's database.
        now: Returns the time.
        limits: Times after which a session ends.
    """

    def __init__(self, database: Database, now: Callable[[], datetime], limits: SessionLimits | None = None) -> None:
        self._database, self._now, self._limits = database, now, limits or SessionLimits()

    def open(self, account: Account | None, language: str = "en") -> tuple[str, LoginSession]:
        """Open a session, and return its secret and the session; delete those that have ended.

        Args:
            account: Account; None for the local administrator.
            language: Language of the local administrator.
        """
        now, secret = self._now(), new_secret()
        session = LoginSession(
            account=None if account is None else account.id,
            name=LOCAL if account is None else account.name,
            role=Role.ADMIN if account is None else account.role,
            language=language if account is None else account.language,
            expires_at=now + self._limits.absolute,
        )
        with self._database.transaction() as connection:
            ended = or_(SESSIONS.c.expires_at <= now, SESSIONS.c.used_at <= now - self._limits.idle)
            connection.execute(delete(SESSIONS).where(ended))
            connection.execute(
                insert(SESSIONS).values(
                    secret_sha256=digest(secret),
                    account=session.account,
                    language=session.language,
                    created_at=now,
                    used_at=now,
                    expires_at=session.expires_at,
                )
            )
        return secret, session

    def find(self, secret: str) -> LoginSession | None:
        """Return the session of a secret, and record its use; None if it has ended or never was."""
        now = self._now()
        query = (
            select(SESSIONS, ACCOUNTS.c.name, ACCOUNTS.c.role, ACCOUNTS.c.language.label("own_language"))
            .select_from(SESSIONS.outerjoin(ACCOUNTS))
            .where(SESSIONS.c.secret_sha256 == digest(secret))
        )
        with self._database.transaction(reading=True) as connection:
            row = connection.execute(query).first()
        if row is None or row.expires_at <= now or row.used_at <= now - self._limits.idle:
            return None
        if now - row.used_at >= self._limits.noted:
            with self._database.transaction() as connection:
                connection.execute(update(SESSIONS).where(SESSIONS.c.id == row.id).values(used_at=now))
        local = row.account is None
        return LoginSession(
            account=row.account,
            name=LOCAL if local else row.name,
            role=Role.ADMIN if local else Role(row.role),
            language=row.language if local else row.own_language,
            expires_at=row.expires_at,
        )

    def set_language(self, secret: str, language: str) -> None:
        """Change the language of a session of the local administrator."""
        with self._database.transaction() as connection:
            connection.execute(
                update(SESSIONS).where(SESSIONS.c.secret_sha256 == digest(secret)).values(language=language)
            )

    def close(self, secret: str) -> None:
        """End a session."""
        with self._database.transaction() as connection:
            connection.execute(delete(SESSIONS).where(SESSIONS.c.secret_sha256 == digest(secret)))
