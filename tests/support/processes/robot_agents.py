"""Robots that wait for missions, in this process: their agent is called without a socket."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field
from datetime import datetime, tzinfo
from functools import cache
from pathlib import Path
from typing import Any

import httpx
from fastapi import FastAPI

from fieldhand import missions
from fieldhand.agent.app import create_agent
from fieldhand.agent.routes import RobotIdentity
from fieldhand.agent.token_gate import WrongTokenLimits
from fieldhand.agent.uploads import UploadLimits
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.compatibility import UTC
from fieldhand.delivery.bundle_checks import acceptance, sha256_of
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import Carry, MissionSupervisor
from fieldhand.delivery.robot_client import RobotClient
from fieldhand.robot.loader import load_robot
from fieldhand.site.model import Site
from support.missions.signed import KEY, NOW, orchard_files, pack_mission
from support.processes.patience import LONG_S

TOKEN = "a-token-that-nobody-guesses-0123456789"
HEADERS = {"Authorization": f"Bearer {TOKEN}", "Host": "localhost"}


def fly(given: missions.StoredMission) -> object:
    """Carry a mission out, as fast as it goes."""
    return missions.carry_out(given, speed=None, emit=lambda _: None)


@cache
def other_mission() -> bytes:
    """Another mission than :func:`signed.good`, in a larger orchard."""
    return pack_mission(orchard_files(7))


@dataclass
class RobotAgentInProcess:
    """A robot with its agent.

    Attributes:
        slept: Seconds that the agent let callers with a wrong token wait.
        seconds: On the clock of its gate.
        simulated: It counts simulated missions among the earlier ones.
    """

    folder: Path
    now: Callable[[], datetime] = lambda: NOW
    zone: tzinfo = UTC
    sites: tuple[Site, ...] = ()
    robot: str = "husky"
    carry: Carry = fly
    conclude: Carry = lambda _: None
    uploads: UploadLimits = field(default_factory=UploadLimits)
    token: str | None = TOKEN
    slept: list[float] = field(default_factory=list)
    seconds: float = 0.0
    simulated: bool = False

    def __post_init__(self) -> None:
        self.trusted = TrustStore(self.folder / "config")
        self.trusted.trust(KEY.public, name="Ada", at=NOW)
        self.begin()

    def begin(self) -> None:
        """Start the agent on what lies in its store."""
        profile = load_robot(self.robot)
        accept = acceptance(robot=profile, sites=self.sites, trusted=self.trusted, now=lambda: self.now())
        self.mission_store = MissionStore(self.store, accept=accept, now=lambda: self.now())
        self.supervisor = MissionSupervisor(
            self.mission_store,
            carry=lambda given: self.carry(given),
            conclude=lambda given: self.conclude(given),
            now=lambda: self.now(),
            zone=self.zone,
            simulated=self.simulated,
        )
        self.app: FastAPI = create_agent(
            self.mission_store,
            self.supervisor,
            RobotIdentity(robot=profile.name, robot_sha256=profile.sha256, sites=()),
            token=self.token,
            hosts=frozenset({"localhost"}),
            uploads=self.uploads,
            guessing=WrongTokenLimits(),
            clock=lambda: self.seconds,
            sleep=self._sleep,
        )

    @property
    def store(self) -> Path:
        return self.folder / "store"

    def again(self) -> None:
        """End the agent, and start it anew."""
        self.supervisor.join(LONG_S)
        self.mission_store.close()
        self.begin()

    def link(self, lose: Callable[[httpx.Request], str] = lambda _: "") -> RobotClient:
        """A sender's link; ``lose`` says of each request whether ``request`` or ``answer`` is lost."""
        transport = LossyTransport(self.app, lose)
        return RobotClient(
            httpx.Client(
                transport=transport, base_url="http://localhost", headers={"Authorization": f"Bearer {self.token}"}
            )
        )

    def call(self, method: str, path: str, **more: Any) -> httpx.Response:
        """One request with the token."""
        with httpx.Client(transport=LossyTransport(self.app, lambda _: ""), base_url="http://localhost") as client:
            return client.request(method, path, headers=HEADERS | more.pop("headers", {}), **more)

    def upload(self, data: bytes, sha256: str | None = None, **more: Any) -> httpx.Response:
        return self.call("PUT", f"/agent/missions/{sha256 or sha256_of(data)}", content=data, **more)

    def receive(self, headers: dict[str, str], *chunks: bytes, sha256: str, stall: bool = False) -> tuple[int, int]:
        """An upload whose connection ends, or stands still, after these bytes: status, and how often it was read."""
        reads, said, left = 0, list[int](), list(chunks)

        async def receive() -> dict[str, Any]:
            nonlocal reads
            reads += 1
            if left:
                return {"type": "http.request", "body": left.pop(0), "more_body": True}
            if stall:
                await asyncio.sleep(3600)
            return {"type": "http.disconnect"}

        async def send(message: Any) -> None:
            if message["type"] == "http.response.start":
                said.append(message["status"])

        scope = {
            "type": "http",
            "asgi": {"version": "3.0"},
            "http_version": "1.1",
            "method": "PUT",
            "scheme": "http",
            "path": f"/agent/missions/{sha256}",
            "raw_path": b"",
            "query_string": b"",
            "root_path": "",
            "headers": [(k.lower().encode(), v.encode()) for k, v in (HEADERS | headers).items()],
            "client": ("127.0.0.1", 5),
            "server": ("localhost", 80),
        }
        asyncio.run(self.app(scope, receive, send))
        return (said or [0])[0], reads

    def is_empty(self) -> bool:
        """Return True if no mission is stored."""
        folders = [self.store / name for name in ("bundles", "incoming", "missions")]
        return not any(any(folder.iterdir()) for folder in folders) and not self.mission_store.latest(9)

    def events(self, data: bytes) -> list[str]:
        """The lines of a mission's log."""
        return (self.store / "missions" / sha256_of(data)[:16] / "events.jsonl").read_text().splitlines()

    async def _sleep(self, seconds: float) -> None:
        self.slept.append(seconds)


class LossyTransport(httpx.BaseTransport):
    """The line between sender and agent."""

    def __init__(self, app: FastAPI, lose: Callable[[httpx.Request], str]) -> None:
        self._app, self._lose = app, lose

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        body, lost = request.read(), self._lose(request)
        if lost == "request":
            raise httpx.ConnectError("no link")
        answer = asyncio.run(self._answer(request, body))
        if lost == "answer":
            raise httpx.ReadError("the link is lost")
        return answer

    async def _answer(self, request: httpx.Request, body: bytes) -> httpx.Response:
        async def once() -> AsyncIterator[bytes]:
            yield body

        asked = httpx.Request(request.method, request.url, headers=request.headers, content=once())
        asked.headers.pop("transfer-encoding", None)
        found = await httpx.ASGITransport(app=self._app).handle_async_request(asked)
        return httpx.Response(found.status_code, headers=found.headers, content=await found.aread())


def patient(carry: Carry, gate: Any) -> Carry:
    """Carries a mission out once the gate is open."""

    def wait(given: missions.StoredMission) -> object:
        assert gate.wait(LONG_S)
        return carry(given)

    return wait
