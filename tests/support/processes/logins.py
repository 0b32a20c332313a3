"""Callers of an application with accounts: each keeps a cookie, as a browser does, or a token."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from http.cookies import SimpleCookie
from typing import Any

import anyio
import httpx
from fastapi import FastAPI

from fieldhand.accounts.accounts import Accounts
from fieldhand.accounts.roles import Role
from fieldhand.api.account_service import AccountService
from fieldhand.api.app import create_app
from fieldhand.api.login_throttle import LoginThrottle
from fieldhand.fleet import Fleet
from fieldhand.planning.planner import Planned
from support.databases import PASSWORD
from support.processes.browser import LOCAL, Says, corner_task

COOKIE, DEVICE = "fieldhand_session", "fieldhand_device"


async def no_time(_: float) -> None:
    """Let others run, and no time pass."""
    await anyio.sleep(0)


def server_of(
    accounts: Accounts, sleep: Callable[[float], Awaitable[None]] = no_time, fleet: Fleet | None = None
) -> FastAPI:
    """The API with these accounts, and one planner for every name."""
    planner = Says(outcome=lambda r, s, p: Planned(task=corner_task(r, s, p), planner="hand"))
    service = AccountService(accounts, LoginThrottle(sleep=sleep))
    return create_app(lambda name: planner, hosts=LOCAL, accounts=service, fleet=fleet)


class Visitor:
    """A caller at some address, over HTTP or TLS."""

    def __init__(self, app: FastAPI, *, address: str = "127.0.0.1", scheme: str = "http") -> None:
        self.app, self.address, self.scheme = app, address, scheme
        self.cookie, self.csrf, self.token = "", "", ""
        self.device = ""

    def headers(self) -> dict[str, str]:
        cookies = {COOKIE: self.cookie, DEVICE: self.device}
        found = {"cookie": "; ".join(f"{name}={value}" for name, value in cookies.items() if value)}
        if self.cookie:
            found["x-fieldhand-csrf"] = self.csrf
        if self.token:
            found["authorization"] = f"Bearer {self.token}"
        return found

    def call(self, method: str, path: str, body: Any = None, **options: Any) -> httpx.Response:
        async def send() -> httpx.Response:
            return await self.send(method, path, body, **options)

        return asyncio.run(send())

    async def send(self, method: str, path: str, body: Any = None, **options: Any) -> httpx.Response:
        headers = self.headers() | options.pop("headers", {})
        if body is not None:
            options["json"] = body
        transport = httpx.ASGITransport(app=self.app, client=(self.address, 4000))
        async with httpx.AsyncClient(transport=transport, base_url=f"{self.scheme}://localhost:8000") as client:
            answer = await client.request(method, f"/api/v1{path}", headers=headers, **options)
        # A cookie jar would drop a cookie that has expired by the computer's clock.
        for text in answer.headers.get_list("set-cookie"):
            for name, cookie in SimpleCookie(text).items():
                if name == COOKIE:
                    self.cookie, self.csrf = cookie.value, answer.json().get("csrf", "")
                else:
                    self.device = cookie.value
        return answer

    def login(self, name: str, password: str = PASSWORD) -> httpx.Response:
        return self.call("POST", "/session", {"name": name, "password": password})


def logged_in(app: FastAPI, accounts: Accounts, role: Role, name: str = "") -> Visitor:
    """A visitor with a new account of this role."""
    name = name or role.value.title()
    accounts.people.add(name, PASSWORD, role)
    visitor = Visitor(app)
    assert visitor.login(name).status_code == 200
    return visitor
