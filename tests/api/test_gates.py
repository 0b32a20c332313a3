"""What a request passes before any room sees it, and what every response carries."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import AsyncIterator
from typing import Any

import anyio
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.api.gates import SECURITY_HEADERS
from fieldhand.api.problems import RefusedRequest
from fieldhand.api.work import Limits, Workers
from support.processes.browser import Browser, Says, browser
from support.processes.patience import LONG_S

SMALL = Limits(body_bytes=1000)


def broken(request: str, site: Any, robot: Any) -> Any:
    raise ZeroDivisionError("a fault of the program, in /srv/somebody/secret.py")


def test_every_answer_carries_the_security_headers() -> None:
    web = browser(Says(outcome=broken), limits=SMALL)
    answers = [
        web.get("/api/robots"),
        web.get("/nothing/here"),
        web.get("/api/plan"),
        web.get("/api/robots", headers={"host": "evil.example"}),
        web.post("/api/plan", {"request": 3}),
        web.post("/api/plan", {"request": "x" * 2000}),
        web.post("/api/plan", {"request": "x"}),
    ]
    assert [a.status_code for a in answers] == [200, 404, 405, 403, 422, 413, 500]
    for answer in answers:
        for name, value in SECURITY_HEADERS.items():
            assert answer.headers[name] == value
        assert answer.headers["cache-control"] == "no-store"
        if answer.status_code != 200:
            assert answer.headers["content-type"] == "application/problem+json"
            assert set(answer.json()) == {"status", "what", "where", "advice"}


def test_no_script_runs_but_the_servers_own() -> None:
    policy = dict(part.strip().split(" ", 1) for part in SECURITY_HEADERS["Content-Security-Policy"].split(";"))
    assert policy["default-src"] == "'none'"
    assert policy["script-src"] == "'self'"
    assert policy["frame-ancestors"] == "'none'"


def test_a_fault_of_the_program_tells_its_log_alone(caplog: pytest.LogCaptureFixture) -> None:
    answer = browser(Says(outcome=broken)).post("/api/plan", {"request": "x"})
    assert answer.status_code == 500
    assert "secret" not in answer.text
    assert "ZeroDivision" not in answer.text
    assert "ZeroDivisionError" in caplog.text


@pytest.mark.parametrize("host", ["localhost", "localhost:8000", "127.0.0.1:1", "[::1]:8000", "LOCALHOST"])
def test_the_server_answers_to_its_own_names(host: str) -> None:
    assert browser().get("/api/robots", headers={"host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    ["evil.example", "localhost.evil.example", "localhost@evil.example", "", "127.0.0.1.nip.io:8000", "[::1", "a:b"],
)
def test_the_server_answers_to_no_other_name(host: str) -> None:
    assert browser().get("/api/robots", headers={"host": host}).status_code == 403


@pytest.mark.parametrize("origin", ["https://evil.example", "http://localhost:9000", "null"])
def test_a_page_of_another_origin_is_turned_away(origin: str) -> None:
    assert browser().post("/api/plan", {"request": "x"}, headers={"origin": origin}).status_code == 403


def test_a_page_of_this_origin_is_not() -> None:
    assert browser().post("/api/plan", {"request": "x"}, headers={"origin": "http://localhost:8000"}).status_code == 200


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"])
def test_what_a_form_of_another_page_could_send_is_not_read(kind: str) -> None:
    answer = browser().call("POST", "/api/plan", content='{"request": "x"}', headers={"content-type": kind})
    assert answer.status_code == 422


def test_a_body_is_refused_by_what_it_says_and_by_what_it_is() -> None:
    web = browser(limits=SMALL)
    body = json.dumps({"request": "x" * 2000}).encode()
    headers = {"content-type": "application/json"}
    assert web.call("POST", "/api/plan", content=body, headers=headers).status_code == 413

    sent = 0

    async def endless() -> AsyncIterator[bytes]:
        nonlocal sent
        while sent < 10_000_000:
            sent += 500
            yield b" " * 500

    assert web.call("POST", "/api/plan", content=endless(), headers=headers).status_code == 413
    # In this test the client collects the body first; that the server stops reading is held below.
    assert web.call("POST", "/api/plan", content=b"{}", headers={**headers, "content-length": "-5"}).status_code == 413


def test_the_server_stops_reading_a_body_that_grows_too_large() -> None:
    reads = 0

    async def receive() -> dict[str, Any]:
        nonlocal reads
        reads += 1
        return {"type": "http.request", "body": b" " * 400, "more_body": True}

    status: list[int] = []

    async def send(message: Any) -> None:
        if message["type"] == "http.response.start":
            status.append(message["status"])

    scope = {
        "type": "http",
        "method": "POST",
        "path": "/api/plan",
        "query_string": b"",
        "headers": [(b"host", b"localhost"), (b"content-type", b"application/json")],
    }
    asyncio.run(browser(limits=SMALL).app(scope, receive, send))
    assert status == [413]
    assert reads == 3


def test_a_body_of_the_largest_size_is_read() -> None:
    frame = len(json.dumps({"request": ""}))
    answer = browser(limits=SMALL).call(
        "POST",
        "/api/plan",
        content=json.dumps({"request": "x" * (1000 - frame)}),
        headers={"content-type": "application/json"},
    )
    assert answer.status_code == 200


def test_so_much_work_at_once_and_no_more() -> None:
    release = threading.Event()
    most = 0
    inside = 0
    lock = threading.Lock()

    def work() -> str:
        nonlocal inside, most
        with lock:
            inside += 1
            most = max(most, inside)
        assert release.wait(LONG_S)
        with lock:
            inside -= 1
        return "done"

    async def crowd() -> list[str]:
        workers = Workers(Limits(at_once=2, waiting=3))
        answers: list[str] = []

        async def one() -> None:
            try:
                answers.append(await workers.do(work))
            except RefusedRequest as turned:
                answers.append(str(turned.status))
                if answers.count("503") == 4:
                    release.set()

        async with anyio.create_task_group() as group:
            for _ in range(9):
                group.start_soon(one)
        return answers

    answers = asyncio.run(crowd())
    assert sorted(answers) == ["503"] * 4 + ["done"] * 5
    assert most <= 2


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=10), inner, max_size=3),
    max_leaves=10,
)
KEYS = st.sampled_from(["request", "site", "robot", "planner", "xml", "approved_by", "seed", "world", "text", "name"])
BROWSER: Browser = browser()


@settings(max_examples=60, deadline=None)
@given(
    path=st.sampled_from(["site", "plan", "check", "run"]),
    body=st.dictionaries(KEYS, JSON | st.just("demo") | st.just("husky"), max_size=6),
)
def test_no_body_breaks_the_program_and_every_problem_says_what(path: str, body: dict[str, Any]) -> None:
    text = json.dumps(body)
    answer = BROWSER.call("POST", f"/api/{path}", content=text, headers={"content-type": "application/json"})
    assert answer.status_code < 500, text
    if answer.status_code != 200:
        assert answer.json()["what"]
        assert "Traceback" not in answer.text
        assert "site-packages" not in answer.text
