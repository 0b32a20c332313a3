"""No reader of a stream misses an event or gets one twice, whatever it does, and none makes another one wait."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import httpx
import pytest
from fastapi import FastAPI

from fieldhand import missions
from fieldhand.accounts.accounts import Accounts
from fieldhand.accounts.roles import Role
from fieldhand.api import event_stream
from fieldhand.api.event_stream import MissionStream, cursor_of
from fieldhand.api.problems import RefusedRequest
from fieldhand.fleet import Fleet
from fieldhand.fleet.worker_folder import WorkerFolder
from fieldhand.language import ENGLISH
from support.missions.fleet import FAST, SLOW, begun, kill_worker, until_over, until_state
from support.missions.kept import inputs
from support.processes.browser import browser
from support.processes.crowds import served
from support.processes.logins import logged_in, server_of
from support.processes.patience import LONG_S, until


@dataclass
class Reader:
    """A page that reads a stream, and connects again with the id of its last message.

    Attributes:
        enough: Return True to break off, after each message.
    """

    app: FastAPI
    query: str = ""
    enough: Callable[[dict[str, Any]], bool] = lambda message: False
    messages: list[dict[str, Any]] = field(default_factory=list)
    last_id: str = ""
    gate: asyncio.Event | None = None
    headers: tuple[tuple[bytes, bytes], ...] = ()

    async def read(self) -> None:
        """Read until there was enough."""
        rest, done = b"", asyncio.Event()

        async def send(message: Any) -> None:
            nonlocal rest
            if message["type"] == "http.response.start":
                assert message["status"] == 200
                return
            *whole, rest = (rest + message.get("body", b"")).split(b"\n\n")
            for one in whole:
                if done.is_set():
                    return
                self._take(one.decode())
                if self.messages and self.enough(self.messages[-1]):
                    done.set()
            if self.gate is not None:
                await self.gate.wait()

        request = [{"type": "http.request", "body": b"", "more_body": False}]

        async def receive() -> Any:
            if request:
                return request.pop()
            await asyncio.sleep(LONG_S)
            return {"type": "http.disconnect"}

        headers = [(b"host", b"localhost"), *self.headers] + (
            [(b"last-event-id", self.last_id.encode())] if self.last_id else []
        )
        scope = {
            "type": "http",
            "asgi": {"version": "3.0"},
            "http_version": "1.1",
            "method": "GET",
            "scheme": "http",
            "path": "/api/v1/stream",
            "raw_path": b"/api/v1/stream",
            "query_string": self.query.encode(),
            "root_path": "",
            "headers": headers,
            "client": ("127.0.0.1", 5),
            "server": ("localhost", 80),
        }
        call = asyncio.create_task(self.app(scope, receive, send))
        await asyncio.wait(
            {call, asyncio.create_task(done.wait())}, return_when=asyncio.FIRST_COMPLETED, timeout=LONG_S
        )
        assert done.is_set() or call.done(), call
        call.cancel()
        await asyncio.gather(call, return_exceptions=True)

    def _take(self, text: str) -> None:
        fields = dict(line.split(": ", 1) for line in text.splitlines())
        if "event" in fields:
            self.last_id = fields.get("id", self.last_id)
            self.messages.append({"kind": fields["event"], **json.loads(fields["data"])})

    def of(self, kind: str, name: str | None = None) -> list[dict[str, Any]]:
        """Return the messages of a kind, about one mission."""
        key = "id" if kind == "mission" else "mission"
        return [m for m in self.messages if m["kind"] == kind and name in (None, m.get(key))]


def journal(folder: Path) -> list[tuple[int, str, Any]]:
    return [(n, at, json.loads(line)) for n, at, line in missions.lines_after(folder, 0, 10**6)]


def received(reader: Reader, name: str) -> list[tuple[int, str, Any]]:
    return [(m["n"], m["at"], m["event"]) for m in reader.of("event", name)]


def ends(*names: str) -> Callable[[dict[str, Any]], bool]:
    """Return a function that is true once each of some missions was said to have ended."""
    left = set(names)

    def seen(message: dict[str, Any]) -> bool:
        if message["kind"] == "mission" and message["state"] == "ended":
            left.discard(message["id"])
        return not left

    return seen


def test_several_readers_of_several_missions_miss_nothing(tmp_path: Path) -> None:
    fleet = Fleet(tmp_path)
    app = browser(fleet=fleet).app
    names = [begun(fleet), begun(fleet), begun(fleet, replace(SLOW, speed=15.0))]

    async def breaking_off(reader: Reader, every: int) -> None:
        """Read until all has ended, and connect again after every few messages."""
        over = ends(*names)
        while True:
            count = 0

            def enough(message: dict[str, Any]) -> bool:
                nonlocal count
                count += 1
                finished = over(message)
                return finished or count >= every

            reader.enough = enough
            await reader.read()
            if over({"kind": ""}):
                return

    whole, single = Reader(app, enough=ends(*names)), Reader(app, f"missions={names[1]}", enough=ends(names[1]))
    named, spanish = Reader(app, f"missions={','.join(names)}"), Reader(app, "lang=es", enough=ends(*names))

    def cut_off() -> None:
        """Kill the process of the slowest mission while it drives, and let another one go on."""
        until(lambda: len(missions.events_of(tmp_path / names[2])) >= 3)
        kill_worker(fleet, names[2])
        assert names[2] in fleet.continue_interrupted()

    async def all_of_them() -> None:
        await asyncio.gather(
            whole.read(), single.read(), spanish.read(), breaking_off(named, 9), asyncio.to_thread(cut_off)
        )

    asyncio.run(all_of_them())
    for name in names:
        wanted = journal(tmp_path / name)
        assert len(wanted) > 5
        for reader in (whole, named, spanish):
            assert received(reader, name) == wanted
            states = [m["state"] for m in reader.of("mission", name)]
            assert states[-1] == "ended"
        until_over(fleet, name)
    assert received(single, names[1]) == journal(tmp_path / names[1])
    assert {m.get("mission") for m in single.of("event")} == {names[1]}
    told = [m["told"] for m in spanish.of("event", names[0]) if m["told"]]
    assert told
    assert not set(told) & {m["told"] for m in whole.of("event", names[0])}
    assert any(m["event"]["event"] == "resumed" for m in whole.of("event", names[2]))
    positions = [m["at"] for m in whole.of("position", names[2])]
    assert positions
    assert positions == sorted(positions)
    assert whole.of("heartbeat")


def carried_out(folder: Path, name: str) -> Path:
    """Carry a mission out in this process, and return its folder."""
    stored = missions.begin(folder, name, inputs())
    WorkerFolder(stored.folder).create(FAST)
    missions.carry_out(stored, speed=None, emit=lambda _: None)
    return stored.folder


def test_a_reader_that_stands_still_makes_nobody_wait_and_is_read_for_no_further(tmp_path: Path) -> None:
    carried_out(tmp_path, "one")
    app, calls = browser(fleet=Fleet(tmp_path)).app, list[str]()
    slow = Reader(app, "missions=one", enough=ends("one"))
    other = Reader(app, "missions=one&lang=es", enough=lambda m: len(other.of("heartbeat")) == 3)
    read = MissionStream.messages

    def counted(self: MissionStream) -> Any:
        calls.append(self.language.code)
        return read(self)

    async def both() -> None:
        slow.gate = asyncio.Event()
        standing = asyncio.create_task(slow.read())
        await other.read()
        assert calls.count("es") > calls.count("en") <= 1
        slow.gate.set()
        await standing

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(MissionStream, "messages", counted)
        asyncio.run(both())
    assert received(slow, "one") == received(other, "one") == journal(tmp_path / "one")


def test_an_answer_is_bounded_and_the_rest_follows_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folders = [carried_out(tmp_path, name) for name in ("one", "two")]
    monkeypatch.setattr(event_stream, "_MOST_EVENTS", 4)
    stream = MissionStream(Fleet(tmp_path), ENGLISH, ("one", "two"), {})
    sizes, text = [], ""
    while True:
        messages = list(stream.messages())
        text += "".join(messages)
        sizes.append(sum(m.startswith("event: event") for m in messages))
        if not stream.behind:
            break
    assert max(sizes) <= 4
    assert sum(sizes) == sum(len(journal(folder)) for folder in folders)
    assert text.count("event: mission") == 2
    assert list(stream.messages()) == []


def test_a_mission_that_is_removed_is_gone_and_the_others_go_on(tmp_path: Path) -> None:
    one, _ = carried_out(tmp_path, "one"), carried_out(tmp_path, "two")
    stream = MissionStream(Fleet(tmp_path), ENGLISH, ("one", "two"), {})
    list(stream.messages())
    (one / "mission.json").unlink()
    assert [m for m in stream.messages() if m.startswith("event: gone")]
    assert list(stream.messages()) == []
    damaged = MissionStream(Fleet(tmp_path), ENGLISH, ("two",), {})
    (tmp_path / "two" / "journal.sqlite").write_bytes(b"nothing")
    (gone,) = damaged.messages()
    assert gone.startswith("event: gone")
    assert json.loads(gone.splitlines()[1].removeprefix("data: "))["why"]


def test_without_names_it_follows_what_is_under_way_and_what_begins(tmp_path: Path) -> None:
    carried_out(tmp_path, "done-before")
    fleet = Fleet(tmp_path)
    stream = MissionStream(fleet, ENGLISH, None, {})
    assert list(stream.messages()) == []
    carried_out(tmp_path, "new")
    messages = list(stream.messages())
    assert all("done-before" not in message for message in messages)
    assert any("new" in message for message in messages)
    # Whoever comes back gets the rest of what was followed before, also of a mission that has ended meanwhile.
    back = MissionStream(fleet, ENGLISH, None, {"done-before": 2})
    (first, *_) = [m for m in back.messages() if m.startswith("event: event")]
    assert "id: done-before:3\n" in first


def test_an_interrupted_mission_is_followed_again_when_it_is_resumed(tmp_path: Path) -> None:
    fleet = Fleet(tmp_path)
    name = begun(fleet, SLOW)
    until_state(fleet, name, "running")
    kill_worker(fleet, name)
    stream = MissionStream(fleet, ENGLISH, None, {})
    assert list(stream.messages()) == []
    assert fleet.continue_interrupted() == (name,)
    assert any(name in message for message in stream.messages())
    kill_worker(fleet, name)


@pytest.mark.parametrize("text", ["x", "a:b", "a:-1", "a:1;b:2", "a:1" + "0" * 13, "../x:1", "é:1"])
def test_a_wrong_id_is_refused(text: str, tmp_path: Path) -> None:
    with pytest.raises(RefusedRequest):
        cursor_of(text)
    assert browser(fleet=Fleet(tmp_path)).get("/api/v1/stream", params={"after": text}).status_code == 422


def test_a_mission_that_does_not_exist_cannot_be_followed(tmp_path: Path) -> None:
    web = browser(fleet=Fleet(tmp_path))
    assert web.get("/api/v1/stream?missions=nothing").status_code == 404
    many = ",".join(f"m{k}" for k in range(event_stream.MOST_MISSIONS + 1))
    assert web.get("/api/v1/stream", params={"missions": many}).status_code == 422


def test_a_server_that_ends_ends_its_streams(tmp_path: Path) -> None:
    carried_out(tmp_path, "one")
    app = browser(fleet=Fleet(tmp_path)).app
    first, ended = threading.Event(), threading.Event()

    def follow(port: int) -> None:
        with httpx.stream("GET", f"http://localhost:{port}/api/v1/stream?missions=one", trust_env=False) as answer:
            for line in answer.iter_lines():
                if line:
                    first.set()
        ended.set()  # and not with an error, as where a connection breaks

    with served(app) as port:
        reader = threading.Thread(target=follow, args=(port,))
        reader.start()
        assert first.wait(LONG_S)
    assert ended.wait(LONG_S)
    reader.join()


def test_a_stream_ends_with_the_session_that_opened_it(
    tmp_path: Path, accounts: Accounts, monkeypatch: pytest.MonkeyPatch
) -> None:
    carried_out(tmp_path / "missions", "one")
    monkeypatch.setattr(event_stream, "ALLOWED_EVERY_S", 0.1)
    visitor = logged_in(server_of(accounts, fleet=Fleet(tmp_path / "missions")), accounts, Role.VIEWER)
    cookie = (b"cookie", visitor.headers()["cookie"].encode())
    reader = Reader(visitor.app, "missions=one", headers=(cookie,))

    async def until_it_ends() -> None:
        reading = asyncio.create_task(reader.read())
        while not reader.of("heartbeat"):
            await asyncio.sleep(0.01)
        assert (await visitor.send("DELETE", "/session")).status_code < 300
        await reading

    asyncio.run(until_it_ends())
    assert received(reader, "one") == journal(tmp_path / "missions" / "one")
