"""The page and the API answer whoever asks, whatever others do to the server."""

from __future__ import annotations

import asyncio
from typing import Any

import httpx
import pytest
from starlette.responses import Response

from fieldhand.api.app import create_app
from fieldhand.api.gates import BodyGate, BodyTime
from fieldhand.mission import make_planner
from support.processes.crowds import SENT, crowd, served

#: More than the server has room for.
MANY = 270


@pytest.mark.parametrize("kind", SENT)
def test_a_plan_is_made_whoever_else_is_connected(kind: str) -> None:
    app = create_app(lambda name: make_planner(name, {}), hosts=frozenset({"127.0.0.1", "localhost"}))
    with served(app) as port, crowd(port, kind, MANY), httpx.Client(trust_env=False, timeout=60) as client:
        answer = client.post(
            f"http://127.0.0.1:{port}/api/plan",
            json={"request": "Take a thermal picture of tree 4.", "planner": "english"},
        )
        assert answer.json()["outcome"] == "planned"


async def _reads_it_all(scope: Any, receive: Any, send: Any) -> None:
    while (await receive()).get("more_body"):
        pass
    await Response("whole")(scope, receive, send)


def _gated(gate: BodyGate, *chunks: bytes, pause_s: float = 0.0, last: bool = True) -> int:
    """The status for a body that comes in these chunks, with a pause before each."""
    left, status = list(chunks), list[int]()

    async def receive() -> dict[str, Any]:
        await asyncio.sleep(pause_s if left else 3600)
        chunk = left.pop(0)
        return {"type": "http.request", "body": chunk, "more_body": bool(left) or not last}

    async def send(message: Any) -> None:
        if message["type"] == "http.response.start":
            status.append(message["status"])

    from starlette.exceptions import HTTPException

    async def call() -> None:
        try:
            await gate({"type": "http", "method": "POST", "path": "/", "headers": []}, receive, send)
        except HTTPException as turned:
            status.append(turned.status_code)

    asyncio.run(call())
    return status[0]


def test_a_body_that_stands_still_or_drips_is_given_up() -> None:
    still = BodyGate(_reads_it_all, most=1000, time=BodyTime(idle_s=0.01))
    assert _gated(still, b"x", last=False) == 408
    drip = BodyGate(_reads_it_all, most=1000, time=BodyTime(start_s=0.05, bytes_s=1e9, idle_s=1e9))
    assert _gated(drip, *[b"x"] * 500, pause_s=0.001) == 408
    whole = BodyGate(_reads_it_all, most=1000, time=BodyTime())
    assert _gated(whole, *[b"x"] * 500) == 200


def test_large_bodies_are_bounded_together_and_small_ones_pass() -> None:
    large, small = [b"x" * 50_000] * 3, [b"x" * 50_000]
    gate = BodyGate(_reads_it_all, most=1_000_000, together=100_000)
    assert _gated(gate, *large) == 503
    assert _gated(gate, *small) == 200
    # What was turned away, or answered, counts no more.
    assert _gated(gate, *small) == 200
    assert gate._held == 0
