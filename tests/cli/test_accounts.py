"""``fieldhand accounts``: manages who may log in, from the server's machine, and records it."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from fieldhand.accounts.accounts import open_accounts
from support.processes.command import Run, fieldhand


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    return dict(os.environ) | {"FIELDHAND_DATABASE": f"sqlite:///{tmp_path}/server/x.sqlite"}


def accounts(environment: dict[str, str], *words: str, **more: str) -> Run:
    return fieldhand("accounts", *words, env=environment | more)


def answer(environment: dict[str, str], *words: str, **more: str) -> dict[str, Any]:
    run = accounts(environment, *words, "--json", **more)
    assert run.status == 0, run.err
    return dict(json.loads(run.out))


def test_an_account_is_added_listed_changed_and_removed(environment: dict[str, str]) -> None:
    assert "accounts add" in accounts(environment, "list").out
    made = answer(environment, "add", "Ada", "--role", "approver", "--generate", "--language", "es")
    added = accounts(environment, "add", "Bob", FIELDHAND_PASSWORD="seven purple plums")
    assert added.out == "Added: Bob, viewer\n"
    assert answer(environment, "role", "ada", "admin")["role"] == "admin"
    changed = accounts(environment, "password", "bob", "--generate")
    with_new = changed.out.split()[-1]
    listed = answer(environment, "list")["accounts"]
    assert [(one["name"], one["role"], one["language"]) for one in listed] == [
        ("Ada", "admin", "es"),
        ("Bob", "viewer", "en"),
    ]
    store = open_accounts(environment)
    assert store.people.verify("Ada", made["password"]) is not None
    assert store.people.verify("Bob", "seven purple plums") is None
    assert store.people.verify("Bob", with_new) is not None
    store.close()
    assert accounts(environment, "remove", "Bob", "--lang", "es").out == "Eliminada: Bob\n"
    store = open_accounts(environment)
    entries = [(entry.who, entry.what, entry.about) for entry in reversed(store.audit.entries())]
    store.close()
    assert entries == [
        ("local", "account added", "Ada"),
        ("local", "account added", "Bob"),
        ("local", "role", "Ada"),
        ("local", "password", "Bob"),
        ("local", "account removed", "Bob"),
    ]


def test_a_link_and_a_token_open_what_they_should(environment: dict[str, str]) -> None:
    answer(environment, "add", "Ada", "--role", "planner", "--generate")
    link = answer(environment, "link", "--url", "https://farm.example:8000")["link"]
    made = answer(environment, "token", "cron", "--scopes", "read, plan,approve", "--owner", "ada", "--days", "3")
    assert made["scopes"] == "read, plan"
    store = open_accounts(environment)
    address, _, code = link.partition("#code=")
    assert address == "https://farm.example:8000/"
    assert store.codes.use(code)
    token = store.tokens.find(made["token"])
    assert token is not None
    assert (token.owner, token.name) == ("Ada", "cron")
    store.close()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("add", "Ada"), "without a terminal"),
        (("add", "Ada", "--role", "boss", "--generate"), "there is no role 'boss'"),
        (("add", "local", "--generate"), "administrator"),
        (("add", "Ada", "--language", "tlh", "--generate"), "there is no language 'tlh'"),
        (("role", "Zoe", "admin"), "there is no account"),
        (("password", "Zoe", "--generate"), "there is no account"),
        (("remove", "Zoe"), "there is no account"),
        (("token", "x", "--scopes", "fly"), "there is no scope 'fly'"),
        (("token", "x", "--owner", "Zoe"), "there is no account"),
    ],
)
def test_what_cannot_be_done_is_one_line(environment: dict[str, str], words: tuple[str, ...], said: str) -> None:
    run = accounts(environment, *words)
    assert run.status == 2
    assert len(run.err.splitlines()) == 1
    assert said in run.err


def test_a_database_that_cannot_be_used_is_one_line(environment: dict[str, str]) -> None:
    for url in ("mysql://me:secret@host/name", "nonsense"):
        run = accounts(environment, "list", FIELDHAND_DATABASE=url)
        assert run.status == 2
        assert len(run.err.splitlines()) == 1
        assert "secret" not in run.err
