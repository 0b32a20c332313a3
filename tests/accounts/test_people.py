"""Accounts are found by name without differences of case, and no password but the right one opens them."""

from __future__ import annotations

from itertools import pairwise

import pytest
from argon2 import PasswordHasher
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sqlalchemy import select

from fieldhand.accounts.accounts import Accounts, accounts_in
from fieldhand.accounts.passwords import LONGEST, SHORTEST, Passwords
from fieldhand.accounts.people import key_of
from fieldhand.accounts.roles import Role, Scope, parse_role, parse_scopes
from fieldhand.database.connection import Database
from fieldhand.database.tables import ACCOUNTS
from fieldhand.errors import InputError
from support.databases import CHEAP, PASSWORD, Calendar, accounts_at


@pytest.fixture
def accounts(database: Database) -> Accounts:
    return accounts_at(database, Calendar())


def test_the_right_password_opens_an_account_and_no_other(accounts: Accounts) -> None:
    added = accounts.people.add("Ada", PASSWORD, Role.APPROVER, "es")
    assert accounts.people.verify("Ada", PASSWORD) == added
    assert accounts.people.verify(" aDA ", PASSWORD) == added
    for name, password in (
        ("Ada", PASSWORD + " "),
        ("Ada", ""),
        ("Bob", PASSWORD),
        ("", PASSWORD),
        ("Ada\0", PASSWORD),
    ):
        assert accounts.people.verify(name, password) is None
    assert accounts.people.verify("Ada", PASSWORD * 1000) is None
    assert accounts.people.verify("\ud800", "\ud800") is None


def test_a_password_is_the_same_on_every_keyboard(accounts: Accounts) -> None:
    accounts.people.add("Ana", "camión de la huerta", Role.VIEWER)
    assert accounts.people.verify("Ana", "camio\u0301n de la huerta") is not None


@pytest.mark.parametrize("name", ["ADA", "ada", "\uff21da", "A\u0064a"])
def test_a_name_is_given_once(accounts: Accounts, name: str) -> None:
    accounts.people.add("Ada", PASSWORD, Role.VIEWER)
    with pytest.raises(InputError, match="already an account"):
        accounts.people.add(name, PASSWORD, Role.ADMIN)
    assert [account.role for account in accounts.people.all()] == [Role.VIEWER]


@pytest.mark.parametrize("name", ["", "  ", "a\u202eb", "a\nb", "a\0b", "x" * 101, "local", "LOCAL "])
def test_a_name_that_misleads_is_refused(accounts: Accounts, name: str) -> None:
    with pytest.raises(InputError):
        accounts.people.add(name, PASSWORD, Role.VIEWER)
    assert accounts.people.all() == ()


@pytest.mark.parametrize("password", ["", "x" * (SHORTEST - 1), "aaaaaaaaaaaa", "Margarethe", "y" * (LONGEST + 1)])
def test_a_password_that_is_easily_guessed_is_refused(accounts: Accounts, password: str) -> None:
    with pytest.raises(InputError) as error:
        accounts.people.add("margarethe", password, Role.VIEWER)
    assert password == "" or password not in str(error.value)


def test_another_password_ends_every_session(accounts: Accounts) -> None:
    ada, bob = (accounts.people.add(name, PASSWORD, Role.VIEWER) for name in ("Ada", "Bob"))
    (first, _), (second, _), (other, _) = map(accounts.sessions.open, (ada, ada, bob))
    accounts.people.set_password("Ada", "another five tomatoes")
    assert accounts.people.verify("Ada", PASSWORD) is None
    assert accounts.people.verify("Ada", "another five tomatoes") is not None
    assert accounts.sessions.find(first) is None
    assert accounts.sessions.find(second) is None
    assert accounts.sessions.find(other) is not None


def test_an_account_that_is_removed_leaves_no_way_in(accounts: Accounts) -> None:
    ada = accounts.people.add("Ada", PASSWORD, Role.ADMIN)
    session, _ = accounts.sessions.open(ada)
    token, _ = accounts.tokens.add(ada.id, "cron", frozenset({Scope.READ}), None)
    accounts.audit.add("Ada", "plan", "a row")
    accounts.people.remove("ada")
    assert accounts.sessions.find(session) is None
    assert accounts.tokens.find(token) is None
    assert [entry.who for entry in accounts.audit.entries()] == ["Ada"]
    # One of the same name is another person.
    accounts.people.add("Ada", PASSWORD, Role.VIEWER)
    assert accounts.sessions.find(session) is None
    assert accounts.tokens.find(token) is None


def test_what_is_asked_of_nobody_is_an_error(accounts: Accounts) -> None:
    for ask in (
        lambda: accounts.people.find("Zoe"),
        lambda: accounts.people.remove("Zoe"),
        lambda: accounts.people.change("Zoe", role=Role.ADMIN),
        lambda: accounts.people.set_password("Zoe", PASSWORD),
    ):
        with pytest.raises(InputError, match="there is no account"):
            ask()


def test_no_password_is_stored_and_equal_ones_look_different(accounts: Accounts, database: Database) -> None:
    for name in ("Ada", "Bob"):
        accounts.people.add(name, PASSWORD, Role.VIEWER)
    with database.transaction(reading=True) as connection:
        rows = [tuple(map(str, row)) for row in connection.execute(select(ACCOUNTS))]
        hashes = [row.password_hash for row in connection.execute(select(ACCOUNTS))]
    assert not any(PASSWORD in value for row in rows for value in row)
    assert len(set(hashes)) == 2
    assert all(one.startswith("$argon2id$") for one in hashes)


def test_a_hash_of_lower_costs_is_replaced_at_the_next_login(database: Database) -> None:
    accounts_at(database, Calendar()).people.add("Ada", PASSWORD, Role.VIEWER)
    costlier = Passwords(PasswordHasher(time_cost=2, memory_cost=16, parallelism=1))
    later = accounts_in(database, passwords=costlier)
    assert later.people.verify("Ada", "wrong password") is None
    for _ in range(2):
        assert later.people.verify("Ada", PASSWORD) is not None
    with database.transaction(reading=True) as connection:
        stored = connection.execute(select(ACCOUNTS.c.password_hash)).scalar_one()
    assert not costlier.outdated(stored)
    assert CHEAP.outdated(stored)


def test_real_passwords_cost_what_the_standard_asks() -> None:
    hashed = Passwords().hashed(PASSWORD)
    assert hashed.startswith("$argon2id$v=19$m=65536,t=3,p=4$")


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.text(max_size=300))
def test_any_text_can_be_looked_up(accounts: Accounts, text: str) -> None:
    assert accounts.people.verify(text, text) is None
    assert key_of(key_of(text)) == key_of(text) or len(text) > 100


def test_each_role_includes_the_one_before() -> None:
    roles = tuple(Role)
    assert [role.value for role in roles] == ["viewer", "planner", "approver", "admin"]
    for less, more in pairwise(roles):
        assert less.scopes < more.scopes
    assert Role.ADMIN.scopes == frozenset(Scope)
    assert Role.VIEWER.scopes == {Scope.READ}
    assert Scope.COMMAND not in Role.PLANNER.scopes


def test_roles_and_scopes_that_do_not_exist_are_errors() -> None:
    with pytest.raises(InputError, match="viewer, planner, approver, admin"):
        parse_role("boss")
    with pytest.raises(InputError, match="read, plan, approve, command, admin"):
        parse_scopes(["read", "fly"])
    with pytest.raises(InputError, match="no scope"):
        parse_scopes([])
