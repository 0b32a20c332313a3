"""The audit log keeps who did what, in order, and what strangers wrote is text."""

from __future__ import annotations

import pytest

from fieldhand.accounts.accounts import Accounts
from fieldhand.database.connection import Database
from support.databases import Calendar, accounts_at


@pytest.fixture
def calendar() -> Calendar:
    return Calendar()


@pytest.fixture
def accounts(database: Database, calendar: Calendar) -> Accounts:
    return accounts_at(database, calendar)


def test_the_last_entry_comes_first_and_older_ones_follow(accounts: Accounts, calendar: Calendar) -> None:
    for k in range(10):
        calendar.advance(minutes=1)
        accounts.audit.add("Ada" if k % 2 else "Bob", "plan", f"row {k}", address="10.0.0.1", number=k)
    latest = accounts.audit.entries(most=4)
    assert [entry.about for entry in latest] == ["row 9", "row 8", "row 7", "row 6"]
    assert latest[0].at == calendar.at
    assert latest[0].details == {"number": 9}
    older = accounts.audit.entries(before=latest[-1].id)
    assert [entry.about for entry in older] == [f"row {k}" for k in (5, 4, 3, 2, 1, 0)]
    assert {entry.who for entry in accounts.audit.entries(who="Bob")} == {"Bob"}
    assert accounts.audit.entries(what="approve") == ()


def test_hidden_characters_are_visible_and_long_texts_are_cut(accounts: Accounts) -> None:
    accounts.audit.add("A\x1b[2Jda\0", "login failed", "x" * 5000, address="a" * 300, note="\u202eb", list=[1])
    (entry,) = accounts.audit.entries()
    assert "\x1b" not in entry.who
    assert "\\u{001b}" in entry.who
    assert len(entry.about) == 2000
    assert entry.about.endswith("...")
    assert entry.details == {"note": "\\u{202e}b", "list": [1]}
    assert accounts.audit.entries(who="A\x1b[2Jda\0") == (entry,)
