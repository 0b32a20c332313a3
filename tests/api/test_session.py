"""Logging in and out: cookies that no script and no other site can use, and errors that give nothing away."""

from __future__ import annotations

import asyncio
from http.cookies import SimpleCookie

import anyio
import pytest
from fastapi import FastAPI

from fieldhand.accounts.accounts import Accounts
from fieldhand.accounts.roles import Role, Scope
from support.databases import PASSWORD, Calendar
from support.processes.logins import COOKIE, DEVICE, Visitor, logged_in, server_of
from support.processes.patience import LONG_S


def test_name_and_password_open_a_session(app: FastAPI, accounts: Accounts) -> None:
    accounts.people.add("Ada", PASSWORD, Role.PLANNER, "es")
    visitor = Visitor(app)
    answer = visitor.login("ada")
    assert answer.json() == {
        "name": "Ada",
        "local": False,
        "role": "planner",
        "language": "es",
        "scopes": ["read", "plan"],
        "csrf": visitor.csrf,
    }
    assert visitor.call("GET", "/session").json() == answer.json()
    assert [entry.what for entry in accounts.audit.entries()] == ["login"]


@pytest.mark.parametrize(("scheme", "secure"), [("http", False), ("https", True)])
def test_no_script_and_no_other_site_has_the_cookie(
    app: FastAPI, accounts: Accounts, scheme: str, secure: bool
) -> None:
    accounts.people.add("Ada", PASSWORD, Role.PLANNER)
    visitor = Visitor(app, scheme=scheme)
    given = [SimpleCookie(text) for text in visitor.login("Ada").headers.get_list("set-cookie")]
    cookies = {name: cookie for one in given for name, cookie in one.items()}
    assert {name: cookie["path"] for name, cookie in cookies.items()} == {COOKIE: "/", DEVICE: "/api/v1/session"}
    shown = visitor.call("GET", "/session").text
    for cookie in cookies.values():
        assert cookie["httponly"] is True
        assert cookie["samesite"] == "strict"
        assert bool(cookie["secure"]) is secure
        assert cookie["domain"] == ""
        assert cookie.value not in shown


@pytest.mark.parametrize(("name", "password"), [("Ada", "wrong"), ("Bob", PASSWORD), ("", ""), ("local", PASSWORD)])
def test_a_wrong_login_does_not_say_what_was_wrong(app: FastAPI, accounts: Accounts, name: str, password: str) -> None:
    accounts.people.add("Ada", PASSWORD, Role.PLANNER)
    visitor = Visitor(app)
    answer = visitor.login(name, password)
    assert answer.status_code == 401
    assert answer.json()["what"] == "the name or the password is wrong"
    assert "set-cookie" not in answer.headers
    assert [entry.what for entry in accounts.audit.entries()] == ["login failed"]


def test_guesses_do_not_fill_the_log_and_lock_nobody_out(app: FastAPI, accounts: Accounts) -> None:
    accounts.people.add("Ada", PASSWORD, Role.PLANNER)
    visitor = Visitor(app)
    for _ in range(40):
        assert visitor.login("Ada", "wrong").status_code == 401
    recorded = [e.details["wrong_from_this_address"] for e in accounts.audit.entries() if e.what == "login failed"]
    assert recorded == [32, 16, 8, 4, 2, 1]
    assert visitor.login("Ada").status_code == 200


def test_a_browser_that_was_logged_in_before_does_not_wait_for_guesses(accounts: Accounts) -> None:
    """A guess from the same address on the same account is never answered, and what comes after it waits."""

    async def never(_: float) -> None:
        await anyio.sleep_forever()

    app = server_of(accounts, never)
    for name in ("Ada", "Bob"):
        accounts.people.add(name, PASSWORD, Role.PLANNER)
    known, stranger = Visitor(app), Visitor(app)
    assert known.login("Ada").status_code == 200
    known.cookie = ""
    nonce, _, proof = known.device.partition(".")
    right = {"name": "ada", "password": PASSWORD}

    async def both() -> None:
        async with anyio.create_task_group() as group:
            group.start_soon(stranger.send, "POST", "/session", {"name": "Ada", "password": "wrong"})
            with anyio.move_on_after(LONG_S):
                while not accounts.audit.entries(what="login failed"):
                    await anyio.sleep(0.01)
            for device in ("", "x", ".", f"{nonce}.", f".{proof}", f"{nonce}x.{proof}", f"{nonce}.{proof[::-1]}"):
                stranger.device = device
                with anyio.move_on_after(0.3) as kept_waiting:
                    await stranger.send("POST", "/session", right)
                assert kept_waiting.cancelled_caught, device
            assert (await known.send("POST", "/session", right)).status_code == 200
            group.cancel_scope.cancel()

    asyncio.run(asyncio.wait_for(both(), LONG_S))


def test_what_proves_a_browser_is_of_one_account_and_one_password(accounts: Accounts) -> None:
    for name in ("Ada", "Bob"):
        accounts.people.add(name, PASSWORD, Role.PLANNER)
    proof = accounts.people.device_proof("Ada", "n")
    assert accounts.people.device_proof("ADA", "n") == proof
    assert accounts.people.device_proof("Ada", "m") != proof
    assert accounts.people.device_proof("Bob", "n") != proof
    assert accounts.people.device_proof("Zoe", "n") != accounts.people.device_proof("Zoe", "n")
    accounts.people.set_password("Ada", "another four pears")
    assert accounts.people.device_proof("Ada", "n") != proof


def test_errors_are_in_the_language_that_the_browser_asks_for(app: FastAPI) -> None:
    for asked, said in {
        "es-MX,es;q=0.9,en;q=0.8": "el nombre o la contraseña no es correcto",
        "fr, es": "el nombre o la contraseña no es correcto",
        "en, es": "the name or the password is wrong",
        "x" * 5000: "the name or the password is wrong",
        "../es": "the name or the password is wrong",
    }.items():
        answer = Visitor(app).call(
            "POST", "/session", {"name": "x", "password": "y"}, headers={"accept-language": asked}
        )
        assert answer.json()["what"] == said


def test_a_code_opens_a_session_of_the_local_administrator_once(app: FastAPI, accounts: Accounts) -> None:
    code = accounts.codes.new()
    visitor, late = Visitor(app), Visitor(app)
    answer = visitor.call("POST", "/session/code", {"code": code})
    assert answer.json()["name"] == "local"
    assert answer.json()["local"] is True
    assert answer.json()["scopes"] == [scope.value for scope in Scope]
    assert visitor.call("GET", "/accounts").status_code == 200
    assert late.call("POST", "/session/code", {"code": code}).status_code == 401
    assert late.call("POST", "/session/code", {"code": "x"}).status_code == 401
    assert late.cookie == ""


def test_logging_out_ends_the_session_on_the_server(app: FastAPI, accounts: Accounts) -> None:
    visitor = logged_in(app, accounts, Role.VIEWER)
    other = Visitor(app)
    other.cookie, other.csrf = visitor.cookie, visitor.csrf
    answer = visitor.call("DELETE", "/session")
    assert answer.status_code == 200
    assert f"{COOKIE}=" in answer.headers["set-cookie"]
    assert other.call("GET", "/session").status_code == 401


def test_a_session_ends_by_itself(app: FastAPI, accounts: Accounts, calendar: Calendar) -> None:
    visitor = logged_in(app, accounts, Role.VIEWER)
    calendar.advance(hours=11)
    assert visitor.call("GET", "/session").status_code == 200
    calendar.advance(hours=12)
    assert visitor.call("GET", "/session").status_code == 401


def test_everybody_chooses_a_language(app: FastAPI, accounts: Accounts) -> None:
    visitor, local = logged_in(app, accounts, Role.VIEWER), Visitor(app)
    local.call("POST", "/session/code", {"code": accounts.codes.new()})
    for one in (visitor, local):
        assert one.call("PATCH", "/session", {"language": "es"}).json()["language"] == "es"
        assert one.call("GET", "/session").json()["language"] == "es"
        assert one.call("PATCH", "/session", {"language": "tlh"}).status_code == 422
    assert accounts.people.find("Viewer").language == "es"


def test_everybody_changes_the_own_password_and_stays_logged_in(app: FastAPI, accounts: Accounts) -> None:
    visitor = logged_in(app, accounts, Role.VIEWER, "Ada")
    elsewhere = Visitor(app)
    elsewhere.login("Ada")
    new = "another four pears"
    assert visitor.call("PUT", "/session/password", {"present": "wrong", "new": new}).status_code == 403
    assert visitor.call("PUT", "/session/password", {"present": PASSWORD, "new": "short"}).status_code == 400
    before = visitor.cookie
    assert visitor.call("PUT", "/session/password", {"present": PASSWORD, "new": new}).status_code == 200
    assert visitor.cookie != before
    assert visitor.call("GET", "/session").status_code == 200
    assert elsewhere.call("GET", "/session").status_code == 401
    assert elsewhere.login("Ada").status_code == 401
    assert elsewhere.login("Ada", new).status_code == 200


def test_a_token_is_no_session(app: FastAPI, accounts: Accounts) -> None:
    visitor = Visitor(app)
    visitor.token, _ = accounts.tokens.add(None, "cron", frozenset(Scope), None)
    session = visitor.call("GET", "/session").json()
    assert (session["name"], session["csrf"]) == ("local", "")
    for method, path, body in (
        ("DELETE", "", None),
        ("PATCH", "", {"language": "es"}),
        ("PUT", "/password", {"present": "x", "new": "y"}),
    ):
        assert visitor.call(method, f"/session{path}", body).status_code == 403


@pytest.mark.parametrize(
    "body",
    [{}, {"name": "x"}, {"name": 3, "password": []}, {"name": "x", "password": "y", "role": "admin"}, [], None, "x"],
)
def test_a_body_of_another_form_is_refused(app: FastAPI, body: object) -> None:
    assert Visitor(app).call("POST", "/session", body).status_code == 422
