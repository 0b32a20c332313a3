"""Every route is guarded by one dependency: without the right credential and scope, nothing is done."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from datetime import timedelta
from typing import Any

import httpx
import pytest
from fastapi import FastAPI, Request
from fastapi.routing import APIRoute
from sqlalchemy import text

from fieldhand.accounts.accounts import Accounts
from fieldhand.accounts.roles import Role, Scope
from fieldhand.api.account_service import AccountService
from fieldhand.api.app import create_app
from fieldhand.api.callers import Caller, is_still_allowed
from fieldhand.api.problems import RefusedRequest
from support.databases import Calendar
from support.processes.browser import Browser, Says, browser, corner_warnings, corner_xml
from support.processes.logins import Visitor, logged_in

#: Whoever calls these has no credential yet.
OPEN = {("POST", "/session"), ("POST", "/session/code"), ("GET", "/health")}


def operations(app: FastAPI) -> Iterator[tuple[str, str, Any]]:
    """Every method and address below /api/v1, as the schema lists them."""
    for path, methods in app.openapi()["paths"].items():
        for method, operation in methods.items():
            if path.startswith("/api/v1/"):
                yield method.upper(), path.removeprefix("/api/v1"), operation


def filled(path: str) -> str:
    return path.replace("{name}", "Nobody").replace("{number}", "77")


def routes_of(routes: Any) -> Iterator[APIRoute]:
    """Every route of an application, also of the routers that it includes."""
    for route in routes:
        if isinstance(route, APIRoute):
            yield route
        yield from routes_of(getattr(getattr(route, "original_router", route), "routes", ()))


def test_every_route_has_the_guard_and_no_other_way_in(app: FastAPI) -> None:
    listed = {(method, path) for method, path, _ in operations(app)}
    assert len(listed) > 20
    for method, path in listed - OPEN:
        answer = Visitor(app).call(method, filled(path), {})
        assert answer.status_code == 401, (method, path, answer.text)
        assert answer.headers["www-authenticate"] == "Bearer"
    for method, path in OPEN:
        assert Visitor(app).call(method, path, {} if method == "POST" else None).status_code in (200, 422)


#: The least role that may call each route; what is not named here may be called by every account.
LEAST = {
    ("POST", "/plan"): Role.PLANNER,
    ("POST", "/check"): Role.PLANNER,
    ("POST", "/run"): Role.APPROVER,
    ("GET", "/accounts"): Role.ADMIN,
    ("POST", "/accounts"): Role.ADMIN,
    ("PATCH", "/accounts/{name}"): Role.ADMIN,
    ("DELETE", "/accounts/{name}"): Role.ADMIN,
    ("GET", "/audit"): Role.ADMIN,
}


@pytest.mark.parametrize("role", Role)
def test_a_role_calls_what_it_may_and_nothing_else(app: FastAPI, accounts: Accounts, role: Role) -> None:
    visitor = logged_in(app, accounts, role)
    roles = tuple(Role)
    last = [("DELETE", "/session")]  # ends the session
    for method, path in sorted(({(m, p) for m, p, _ in operations(app)} - OPEN) - set(last)) + last:
        answer = visitor.call(method, filled(path), {})
        allowed = roles.index(role) >= roles.index(LEAST.get((method, path), Role.VIEWER))
        assert (answer.status_code not in (401, 403)) is allowed, (method, path, answer.text)
        if not allowed:
            assert "right" in answer.json()["what"]


def test_no_route_is_hidden_from_the_schema_that_these_tests_walk(app: FastAPI) -> None:
    routes = list(routes_of(app.routes))
    assert len(routes) > 20
    assert all(route.include_in_schema for route in routes)


@pytest.mark.parametrize("csrf", [None, "", "wrong", "0" * 64])
def test_a_cookie_alone_changes_nothing(app: FastAPI, accounts: Accounts, csrf: str | None) -> None:
    visitor = logged_in(app, accounts, Role.ADMIN)
    body = {"name": "Eve", "password": "sixteen pears", "role": "admin"}
    headers = {"cookie": visitor.headers()["cookie"]} | ({} if csrf is None else {"x-fieldhand-csrf": csrf})
    stranger = Visitor(app)
    assert stranger.call("POST", "/accounts", body, headers=headers).status_code == 403
    assert stranger.call("GET", "/accounts", headers=headers).status_code == 200
    assert [one.name for one in accounts.people.all()] == ["Admin"]
    assert visitor.call("POST", "/accounts", body).status_code == 201


def test_the_csrf_of_one_session_is_not_that_of_another(app: FastAPI, accounts: Accounts) -> None:
    one, other = logged_in(app, accounts, Role.PLANNER, "A"), logged_in(app, accounts, Role.PLANNER, "B")
    assert one.csrf != other.csrf
    one.csrf = other.csrf
    assert one.call("POST", "/plan", {"request": "x"}).status_code == 403


def test_a_page_of_another_origin_cannot_use_a_session(app: FastAPI, accounts: Accounts) -> None:
    visitor = logged_in(app, accounts, Role.ADMIN)
    for origin in ("https://evil.example", "null", "http://localhost:8001"):
        assert visitor.call("GET", "/accounts", headers={"origin": origin}).status_code == 403


def test_a_token_needs_no_csrf_and_has_its_scopes_alone(app: FastAPI, accounts: Accounts, calendar: Calendar) -> None:
    ada = accounts.people.add("Ada", "four green pears", Role.ADMIN)
    visitor = Visitor(app)
    visitor.token, token = accounts.tokens.add(ada.id, "cron", frozenset({Scope.PLAN}), timedelta(days=1))
    assert visitor.call("POST", "/plan", {"request": "x"}).json()["outcome"] == "planned"
    assert visitor.call("GET", "/robots").status_code == 403
    assert visitor.call("GET", "/accounts").status_code == 403
    calendar.advance(days=1)
    assert visitor.call("POST", "/plan", {"request": "x"}).status_code == 401
    assert token.owner == "Ada"


@pytest.mark.parametrize(
    "given", ["", "Bearer", "Bearer ", "Bearer fh_", "Bearer fh_wrong", "Basic YTpi", "bearer x y", "Bearer fh_\u00e9"]
)
def test_what_is_no_token_admits_nobody(app: FastAPI, given: str) -> None:
    answer = Visitor(app).call("GET", "/robots", headers={"authorization": given.encode()})
    assert answer.status_code == 401


@pytest.mark.parametrize(
    "cookie", ["", "fieldhand_session", "fieldhand_session=", "fieldhand_session=x", "a=b;;=;\x01"]
)
def test_what_is_no_session_admits_nobody(app: FastAPI, cookie: str) -> None:
    assert Visitor(app).call("GET", "/robots", headers={"cookie": cookie.encode()}).status_code == 401


def test_a_wrong_token_is_not_rescued_by_a_session(app: FastAPI, accounts: Accounts) -> None:
    visitor = logged_in(app, accounts, Role.ADMIN)
    visitor.token = "fh_wrong"
    assert visitor.call("GET", "/robots").status_code == 401


@pytest.mark.parametrize("address", ["10.0.0.7", "fe80::1", "", "::ffff:10.0.0.7"])
def test_the_unversioned_addresses_are_for_this_machine_alone(app: FastAPI, address: str) -> None:
    async def call(client: str, path: str) -> int:
        transport = httpx.ASGITransport(app=app, client=(client, 4000))
        async with httpx.AsyncClient(transport=transport, base_url="http://localhost:8000") as browser:
            return (await browser.get(path)).status_code

    assert asyncio.run(call(address, "/api/robots")) == 403
    assert asyncio.run(call(address, "/api/v1/robots")) == 401
    assert asyncio.run(call("127.0.0.1", "/api/robots")) == 200
    assert asyncio.run(call("127.0.0.1", "/api/v1/robots")) == 401


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8000", "10.0.0.7:8000", "", "[::1"])
def test_a_page_whose_name_leads_to_this_machine_is_not_this_machine(accounts: Accounts, host: str) -> None:
    """Where others can reach the server, it answers under any name."""
    app = create_app(lambda name: Says(outcome=lambda r, s, p: None), hosts=None, accounts=AccountService(accounts))
    headers = {"host": host, "origin": f"http://{host}"}
    assert Browser(app).get("/api/robots", headers=headers).status_code == 403
    assert Browser(app).get("/api/robots").status_code == 200


def test_without_accounts_this_machine_is_admitted_and_no_other() -> None:
    app = browser().app
    assert Visitor(app).call("GET", "/robots").status_code == 200
    assert Visitor(app, address="10.0.0.7").call("GET", "/robots").status_code == 403


def test_a_stranger_sends_no_large_body(app: FastAPI, accounts: Accounts) -> None:
    body = {"request": "x", "site": {"type": "x" * 100_000}}
    assert Visitor(app).call("POST", "/plan", body).status_code == 413
    assert Visitor(app).call("POST", "/session", {"name": "x" * 100_000, "password": ""}).status_code == 413
    visitor = logged_in(app, accounts, Role.PLANNER)
    assert visitor.call("POST", "/plan", body).status_code == 400  # no site
    assert json.loads(visitor.call("POST", "/plan", {"request": "x"}).text)["outcome"] == "planned"


def test_a_broken_database_admits_nobody_and_says_so(app: FastAPI, accounts: Accounts) -> None:
    visitor = logged_in(app, accounts, Role.ADMIN)
    assert Visitor(app).call("GET", "/health").json() == {"status": "ok"}
    with accounts.database.transaction() as connection:
        for table in ("tokens", "sessions", "login_codes", "audit"):
            connection.execute(text(f"drop table {table}"))
    for path in ("/robots", "/session", "/accounts"):
        answer = visitor.call("GET", path)
        assert answer.status_code == 503, path
        assert "database" in answer.json()["what"]
    assert Visitor(app).login("Admin").status_code == 503
    assert "Traceback" not in answer.text


def test_a_stream_ends_with_its_session(app: FastAPI, accounts: Accounts) -> None:
    visitor = logged_in(app, accounts, Role.PLANNER)
    allowed: list[bool] = []
    kept: list[Request] = []

    async def still() -> None:
        allowed.append(await is_still_allowed(kept[0], Scope.PLAN))

    class Keeping:
        """Keeps a request as a stream does."""

        def __init__(self, inner: Any) -> None:
            self.inner = inner

        async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
            if scope["type"] == "http" and not kept:
                kept.append(Request(scope))
            await self.inner(scope, receive, send)

    visitor.app = Keeping(app)  # type: ignore[assignment]
    visitor.call("GET", "/robots")
    asyncio.run(still())
    accounts.people.change("Planner", role=Role.VIEWER)
    asyncio.run(still())
    accounts.people.change("Planner", role=Role.PLANNER)
    accounts.people.set_password("Planner", "another four pears")
    asyncio.run(still())
    assert allowed == [True, False, False]


def run_body(**more: Any) -> dict[str, Any]:
    return {"xml": corner_xml(), "confirmed": list(corner_warnings()), **more}


def test_who_approves_is_who_logged_in(app: FastAPI, accounts: Accounts) -> None:
    visitor = logged_in(app, accounts, Role.APPROVER, "Ada")
    done = visitor.call("POST", "/run", run_body()).json()
    assert done["authorization"]["by"] == "Ada"
    assert visitor.call("POST", "/run", run_body(approved_by="Ada")).status_code == 200
    answer = visitor.call("POST", "/run", run_body(approved_by="Bob"))
    assert answer.status_code == 403
    assert answer.json()["where"] == "approved_by"
    first, second = (entry for entry in accounts.audit.entries() if entry.what == "approve and simulate")
    assert (first.who, first.details["approved_by"]) == ("Ada", "Ada")
    assert first.about == second.about == done["authorization"]["task_sha256"]


def test_the_local_administrator_gives_a_name_to_approve(app: FastAPI, accounts: Accounts) -> None:
    visitor = Visitor(app)
    assert visitor.call("POST", "/session/code", {"code": accounts.codes.new()}).status_code == 200
    assert visitor.call("POST", "/run", run_body()).status_code == 422
    done = visitor.call("POST", "/run", run_body(approved_by="Ana")).json()
    assert done["authorization"]["by"] == "Ana"
    (entry,) = (entry for entry in accounts.audit.entries() if entry.what == "approve and simulate")
    assert (entry.who, entry.details["approved_by"]) == ("local", "Ana")


def test_who_planned_what_is_recorded(app: FastAPI, accounts: Accounts) -> None:
    visitor = logged_in(app, accounts, Role.PLANNER, "Ada")
    visitor.call("POST", "/plan", {"request": "look at the corners"})
    entry = accounts.audit.entries()[0]
    assert (entry.who, entry.what, entry.about) == ("Ada", "plan", "look at the corners")
    assert entry.details["outcome"] == "planned"
    assert entry.address == "127.0.0.1"


def test_a_caller_is_plain_data() -> None:
    caller = Caller(name="Ada", role=Role.PLANNER, scopes=Role.PLANNER.scopes)
    assert (caller.address, caller.account) == ("", None)
    assert RefusedRequest(401, "x").where == ""
