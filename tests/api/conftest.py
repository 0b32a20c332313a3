"""An application with accounts in a SQLite file."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi import FastAPI

from fieldhand.accounts.accounts import Accounts
from fieldhand.database.connection import open_database
from support.databases import Calendar, accounts_at
from support.processes.logins import server_of


@pytest.fixture
def calendar() -> Calendar:
    """The clock of the accounts."""
    return Calendar()


@pytest.fixture
def accounts(tmp_path: Path, calendar: Calendar) -> Iterator[Accounts]:
    """Accounts in a new database."""
    opened = accounts_at(open_database({"FIELDHAND_DATABASE": f"sqlite:///{tmp_path}/server/x.sqlite"}), calendar)
    yield opened
    opened.close()


@pytest.fixture
def app(accounts: Accounts) -> FastAPI:
    """The API with these accounts."""
    return server_of(accounts)
