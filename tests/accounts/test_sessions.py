"""Sessions, tokens and codes end when they should, and their secrets are stored nowhere."""

from __future__ import annotations

import threading
from datetime import timedelta

import pytest
from sqlalchemy import select

from fieldhand.accounts.accounts import Accounts
from fieldhand.accounts.random_secrets import csrf_of, new_password, new_secret, same
from fieldhand.accounts.roles import Role, Scope
from fieldhand.accounts.sessions import SessionLimits
from fieldhand.database.connection import Database
from fieldhand.database.tables import LOGIN_CODES, SESSIONS, TOKENS
from fieldhand.errors import InputError
from support.databases import PASSWORD, Calendar, accounts_at

LIMITS = SessionLimits(idle=timedelta(hours=2), absolute=timedelta(hours=5))


@pytest.fixture
def calendar() -> Calendar:
    return Calendar()


@pytest.fixture
def accounts(database: Database, calendar: Calendar) -> Accounts:
    return accounts_at(database, calendar, LIMITS)


def test_a_session_that_is_used_lasts_until_its_absolute_end(accounts: Accounts, calendar: Calendar) -> None:
    secret, opened = accounts.sessions.open(accounts.people.add("Ada", PASSWORD, Role.PLANNER))
    for _ in range(4):
        calendar.advance(hours=1)
        assert accounts.sessions.find(secret) == opened
    calendar.advance(minutes=59)
    assert accounts.sessions.find(secret) == opened
    calendar.advance(minutes=1)
    assert accounts.sessions.find(secret) is None


def test_a_session_that_is_not_used_ends_earlier(accounts: Accounts, calendar: Calendar) -> None:
    secret, _ = accounts.sessions.open(None)
    calendar.advance(hours=1, minutes=59)
    assert accounts.sessions.find(secret) is not None
    calendar.advance(hours=2)
    assert accounts.sessions.find(secret) is None


def test_ended_sessions_are_deleted(accounts: Accounts, calendar: Calendar, database: Database) -> None:
    for _ in range(3):
        accounts.sessions.open(None)
    calendar.advance(hours=3)
    accounts.sessions.open(None)
    with database.transaction(reading=True) as connection:
        assert len(connection.execute(select(SESSIONS.c.id)).all()) == 1


def test_a_closed_session_is_closed_and_others_are_not(accounts: Accounts) -> None:
    (first, _), (second, _) = accounts.sessions.open(None), accounts.sessions.open(None)
    accounts.sessions.close(first)
    assert accounts.sessions.find(first) is None
    assert accounts.sessions.find(second) is not None


def test_a_session_has_the_role_of_the_moment(accounts: Accounts) -> None:
    secret, _ = accounts.sessions.open(accounts.people.add("Ada", PASSWORD, Role.ADMIN))
    accounts.people.change("Ada", role=Role.VIEWER, language="es")
    found = accounts.sessions.find(secret)
    assert found is not None
    assert (found.role, found.language) == (Role.VIEWER, "es")


def test_the_local_administrator_is_nobodys_account(accounts: Accounts) -> None:
    secret, session = accounts.sessions.open(None)
    assert (session.account, session.name, session.role) == (None, "local", Role.ADMIN)
    accounts.sessions.set_language(secret, "es")
    found = accounts.sessions.find(secret)
    assert found is not None
    assert found.language == "es"


def test_a_code_opens_one_session_for_a_time(accounts: Accounts, calendar: Calendar) -> None:
    code, other = accounts.codes.new(), accounts.codes.new()
    assert not accounts.codes.use(code + "x")
    assert accounts.codes.use(code)
    assert not accounts.codes.use(code)
    calendar.advance(hours=12)
    assert not accounts.codes.use(other)


def test_a_code_that_many_use_at_once_opens_one_session(accounts: Accounts) -> None:
    code = accounts.codes.new()
    used: list[bool] = []
    threads = [threading.Thread(target=lambda: used.append(accounts.codes.use(code))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(used) == [False] * 7 + [True]


def test_a_token_has_no_more_rights_than_its_owner(accounts: Accounts) -> None:
    ada = accounts.people.add("Ada", PASSWORD, Role.APPROVER)
    secret, token = accounts.tokens.add(ada.id, "cron", frozenset({Scope.READ, Scope.COMMAND}), None)
    assert token.effective_scopes == {Scope.READ, Scope.COMMAND}
    accounts.people.change("Ada", role=Role.PLANNER)
    found = accounts.tokens.find(secret)
    assert found is not None
    assert found.effective_scopes == {Scope.READ}
    assert found.owner == "Ada"


def test_a_token_expires_and_is_revoked(accounts: Accounts, calendar: Calendar) -> None:
    secret, token = accounts.tokens.add(None, "cron", frozenset({Scope.READ}), timedelta(days=2))
    forever, _ = accounts.tokens.add(None, "cron", frozenset({Scope.READ}), None)
    assert token.used_at is None
    accounts.tokens.find(secret)
    assert accounts.tokens.all()[0].used_at == calendar.at
    calendar.advance(days=2)
    assert accounts.tokens.find(secret) is None
    kept = accounts.tokens.find(forever)
    assert kept is not None
    accounts.tokens.revoke(kept.id)
    assert accounts.tokens.find(forever) is None
    with pytest.raises(InputError, match="no such token"):
        accounts.tokens.revoke(kept.id)


def test_an_account_has_only_so_many_tokens(accounts: Accounts) -> None:
    ada = accounts.people.add("Ada", PASSWORD, Role.VIEWER)
    for _ in range(100):
        accounts.tokens.add(ada.id, "x", frozenset({Scope.READ}), None)
    with pytest.raises(InputError, match="at most 100"):
        accounts.tokens.add(ada.id, "x", frozenset({Scope.READ}), None)
    accounts.tokens.add(None, "x", frozenset({Scope.READ}), None)


def test_no_secret_is_stored(accounts: Accounts, database: Database) -> None:
    secrets = [
        accounts.sessions.open(None)[0],
        accounts.tokens.add(None, "cron", frozenset({Scope.READ}), None)[0],
        accounts.codes.new(),
    ]
    with database.transaction(reading=True) as connection:
        stored = [str(row) for table in (SESSIONS, TOKENS, LOGIN_CODES) for row in connection.execute(select(table))]
    assert len(stored) == 3
    assert not any(secret in row for secret in secrets for row in stored)


def test_secrets_are_long_and_never_the_same() -> None:
    made = {new_secret() for _ in range(200)}
    assert len(made) == 200
    assert all(len(secret) == 43 for secret in made)
    assert len({new_password() for _ in range(200)}) == 200
    assert csrf_of("a") != csrf_of("b")
    assert same("ä\ud800", "ä") is False
    assert same(csrf_of("a"), csrf_of("a"))
