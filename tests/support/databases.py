"""Databases of tests: a SQLite file, or one of a PostgreSQL server where that is installed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from datetime import datetime, timedelta
from functools import cache
from pathlib import Path

import pytest
from argon2 import PasswordHasher

from fieldhand.accounts.accounts import Accounts, accounts_in
from fieldhand.accounts.passwords import Passwords
from fieldhand.accounts.sessions import SessionLimits
from fieldhand.compatibility import UTC
from fieldhand.database.connection import Database, open_database
from support.processes import postgresql

#: Costs next to nothing; what a real one costs is the product's choice.
CHEAP = Passwords(PasswordHasher(time_cost=1, memory_cost=8, parallelism=1))
PASSWORD = "four green tomatoes"


class Servers:
    """The PostgreSQL server of this process, started when the first test needs it."""

    def __init__(self) -> None:
        self._open = ExitStack()

    @cache  # noqa: B019  one object lives as long as the tests
    def databases(self) -> Iterator[str]:
        return self._open.enter_context(postgresql.server())

    def close(self) -> None:
        self._open.close()


@pytest.fixture(scope="session")
def servers() -> Iterator[Servers]:
    """The servers that these tests start."""
    started = Servers()
    yield started
    started.close()


@pytest.fixture(params=["sqlite", "postgresql"])
def url(request: pytest.FixtureRequest, tmp_path: Path, servers: Servers) -> str:
    """The URL of an empty database, as the environment gives it."""
    if request.param == "sqlite":
        return f"sqlite:///{tmp_path}/server/fieldhand.sqlite"
    if postgresql.why_none():
        pytest.skip(postgresql.why_none())
    return next(servers.databases())


@pytest.fixture
def database(url: str) -> Iterator[Database]:
    """An opened database."""
    opened = open_database({"FIELDHAND_DATABASE": url})
    yield opened
    opened.close()


class Calendar:
    """A clock that a test sets."""

    def __init__(self) -> None:
        self.at = datetime(2026, 6, 1, 12, tzinfo=UTC)

    def now(self) -> datetime:
        return self.at

    def advance(self, **more: float) -> None:
        self.at += timedelta(**more)


def accounts_at(database: Database, calendar: Calendar, limits: SessionLimits | None = None) -> Accounts:
    """Accounts whose passwords cost nothing, at the time of a calendar."""
    return accounts_in(database, passwords=CHEAP, now=calendar.now, limits=limits)
