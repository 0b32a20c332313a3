"""Administrators manage accounts, everybody the own tokens, and the audit log tells what was done."""

from __future__ import annotations

from typing import Any

import pytest
from fastapi import FastAPI

from fieldhand.accounts.accounts import Accounts
from fieldhand.accounts.roles import Role, Scope
from support.databases import PASSWORD
from support.processes.logins import Visitor, logged_in


@pytest.fixture
def admin(app: FastAPI, accounts: Accounts) -> Visitor:
    return logged_in(app, accounts, Role.ADMIN, "Root")


def recorded(accounts: Accounts) -> list[tuple[str, str, str]]:
    """What the log tells, the first first, without logins."""
    entries = reversed(accounts.audit.entries())
    return [(entry.who, entry.what, entry.about) for entry in entries if entry.what != "login"]


def test_an_account_is_added_changed_and_removed(app: FastAPI, accounts: Accounts, admin: Visitor) -> None:
    body = {"name": "Ana", "password": PASSWORD, "role": "viewer", "language": "es"}
    added = admin.call("POST", "/accounts", body)
    assert added.status_code == 201
    assert added.json()["role"] == "viewer"
    assert PASSWORD not in added.text
    ana = Visitor(app)
    assert ana.login("ana").json()["language"] == "es"
    assert admin.call("PATCH", "/accounts/ana", {"role": "planner"}).json()["role"] == "planner"
    assert ana.call("GET", "/session").json()["role"] == "planner"
    assert [one["name"] for one in admin.call("GET", "/accounts").json()] == ["Ana", "Root"]
    assert admin.call("PATCH", "/accounts/Ana", {"password": "another four pears"}).status_code == 200
    assert ana.call("GET", "/session").status_code == 401
    assert ana.login("Ana", "another four pears").status_code == 200
    assert admin.call("DELETE", "/accounts/Ana").status_code == 200
    assert ana.call("GET", "/session").status_code == 401
    assert ana.login("Ana", "another four pears").status_code == 401
    done = [entry for entry in recorded(accounts) if entry[1] != "login failed"]
    assert done == [
        ("Root", "account added", "Ana"),
        ("Root", "role", "Ana"),
        ("Root", "password", "Ana"),
        ("Root", "account removed", "Ana"),
    ]


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({"name": "Root", "password": PASSWORD, "role": "viewer"}, 400),
        ({"name": "a\u202eb", "password": PASSWORD, "role": "viewer"}, 400),
        ({"name": "Ana", "password": "short", "role": "viewer"}, 400),
        ({"name": "Ana", "password": PASSWORD, "role": "boss"}, 422),
        ({"name": "Ana", "password": PASSWORD, "role": "viewer", "language": "tlh"}, 422),
        ({"name": "Ana", "password": PASSWORD}, 422),
    ],
)
def test_what_cannot_be_an_account_is_refused(
    accounts: Accounts, admin: Visitor, body: dict[str, Any], status: int
) -> None:
    answer = admin.call("POST", "/accounts", body)
    assert answer.status_code == status
    assert answer.json()["what"]
    assert [one.name for one in accounts.people.all()] == ["Root"]


def test_a_token_is_shown_once_and_works_until_it_is_revoked(app: FastAPI, accounts: Accounts) -> None:
    planner, program = logged_in(app, accounts, Role.PLANNER, "Ada"), Visitor(app)
    made = planner.call("POST", "/tokens", {"name": "cron", "scopes": ["read"], "days": 5}).json()
    program.token = made["token"]
    assert made["token"].startswith("fh_")
    assert program.call("GET", "/robots").status_code == 200
    assert program.call("POST", "/plan", {"request": "x"}).status_code == 403
    listed = planner.call("GET", "/tokens")
    assert [(one["name"], one["owner"], one["scopes"]) for one in listed.json()] == [("cron", "Ada", ["read"])]
    assert made["token"] not in listed.text
    assert planner.call("DELETE", f"/tokens/{made['id']}").status_code == 200
    assert program.call("GET", "/robots").status_code == 401
    assert recorded(accounts) == [("Ada", "token created", "cron"), ("Ada", "token revoked", "cron")]


def test_nobody_makes_a_token_with_more_rights(app: FastAPI, accounts: Accounts) -> None:
    planner, program = logged_in(app, accounts, Role.PLANNER), Visitor(app)
    for scopes in (["approve"], ["read", "admin"]):
        assert planner.call("POST", "/tokens", {"name": "x", "scopes": scopes}).status_code == 403
    for scopes in ([], ["fly"], ["read"] * 9):
        assert planner.call("POST", "/tokens", {"name": "x", "scopes": scopes}).status_code == 422
    program.token, _ = accounts.tokens.add(None, "x", frozenset(Scope), None)
    assert program.call("POST", "/tokens", {"name": "x", "scopes": ["read"]}).status_code == 403
    assert len(accounts.tokens.all()) == 1


def test_the_tokens_of_others_are_the_administrators_business(app: FastAPI, accounts: Accounts, admin: Visitor) -> None:
    ada, bob = (logged_in(app, accounts, Role.VIEWER, name) for name in ("Ada", "Bob"))
    made = ada.call("POST", "/tokens", {"name": "x", "scopes": ["read"]}).json()
    assert bob.call("GET", "/tokens").json() == []
    assert bob.call("DELETE", f"/tokens/{made['id']}").status_code == 404
    assert [one["owner"] for one in admin.call("GET", "/tokens").json()] == ["Ada"]
    assert admin.call("DELETE", f"/tokens/{made['id']}").status_code == 200
    assert admin.call("DELETE", f"/tokens/{made['id']}").status_code == 404


def test_the_audit_log_is_read_in_pages(accounts: Accounts, admin: Visitor) -> None:
    for k in range(7):
        accounts.audit.add("Ada", "plan", f"row {k}")
    first = admin.call("GET", "/audit?most=3&who=Ada").json()
    assert [one["about"] for one in first] == ["row 6", "row 5", "row 4"]
    rest = admin.call("GET", f"/audit?who=Ada&before={first[-1]['id']}").json()
    assert [one["about"] for one in rest] == ["row 3", "row 2", "row 1", "row 0"]
    assert first[0]["at"] == "2026-06-01T12:00:00+00:00"
    assert admin.call("GET", "/audit?what=login").json()[0]["who"] == "Root"
    for wrong in ("most=0", "most=501", "before=-1", f"before={2**31}", "before=x"):
        assert admin.call("GET", f"/audit?{wrong}").status_code == 422
