"""``fieldhand serve``: listens where it is told, says where, and warns where others can reach it."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from fieldhand.api.serving import hosts_for, is_loopback
from support.missions.fleet import worker_pid
from support.missions.kept import inputs
from support.processes.command import fieldhand
from support.processes.patience import LONG_S, until


def free_port() -> int:
    with socket.socket() as tried:
        tried.bind(("127.0.0.1", 0))
        return int(tried.getsockname()[1])


@contextmanager
def serving(*words: str) -> Iterator[tuple[int, subprocess.Popen[str]]]:
    port = free_port()
    command = [sys.executable, "-m", "fieldhand", "serve", "--port", str(port), *words]
    server = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)
    try:
        yield port, server
    finally:
        server.terminate()
        server.communicate(timeout=LONG_S)


def fetch(port: int, path: str) -> bytes:
    # The address is printed before the first connection is taken; how long that is, is the machine's business.
    def answer() -> bytes | None:
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=LONG_S) as found:
                return bytes(found.read())
        except OSError as error:
            if not isinstance(getattr(error, "reason", error), ConnectionRefusedError):
                raise
            return None

    read = until(answer)
    assert read is not None
    return read


def test_serves_page_and_api_on_this_machine_alone() -> None:
    with serving() as (port, server):
        assert server.stderr is not None
        said = server.stderr.readline()
        assert f"http://127.0.0.1:{port}/" in said
        assert b"<title>Fieldhand</title>" in fetch(port, "/")
        assert {robot["name"] for robot in json.loads(fetch(port, "/api/robots"))} >= {"husky", "amiga"}


def test_ctrl_c_ends_the_server_and_not_its_missions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another server finds the mission, still carried out by the same process, and commands it."""
    monkeypatch.setenv("FIELDHAND_MISSIONS", str(tmp_path))
    body = {"xml": inputs().document.decode(), "confirmed": list(inputs().authorized.authorization.confirmed)}
    with serving() as (port, server):
        assert server.stderr is not None
        server.stderr.readline()
        fetch(port, "/")
        name = send(port, "missions", {**body, "approved_by": "Ana", "speed": 2})["id"]
        stream = urllib.request.urlopen(f"http://127.0.0.1:{port}/api/v1/stream", timeout=LONG_S)
        stream.readline()
        until(lambda: json.loads(fetch(port, f"/api/v1/missions/{name}/events"))["state"] == "running")
        pid = worker_pid(tmp_path / name)
        os.killpg(server.pid, signal.SIGINT)
        server.wait(LONG_S)
        stream.close()
    assert worker_pid(tmp_path / name) == pid
    with serving() as (port, _):
        (found,) = json.loads(fetch(port, "/api/v1/missions"))
        assert (found["id"], found["state"]) == (name, "running")
        assert worker_pid(tmp_path / name) == pid
        answer = send(port, f"missions/{name}/commands", {"command": "abort"})
        assert (answer["confirmed"], answer["by"]) == (True, name)
        until(lambda: json.loads(fetch(port, f"/api/v1/missions/{name}/events"))["state"] == "ended")


def send(port: int, path: str, body: object) -> Any:
    request = urllib.request.Request(f"http://127.0.0.1:{port}/api/v1/{path}", json.dumps(body).encode())
    request.add_header("Content-Type", "application/json")
    with urllib.request.urlopen(request, timeout=LONG_S) as answer:
        return json.load(answer)


def test_warns_where_others_can_reach_it() -> None:
    with serving("--host", "0.0.0.0") as (port, server):
        assert server.stderr is not None
        assert str(port) in server.stderr.readline()
        assert "no login" in server.stderr.readline()


def test_an_address_that_is_taken_is_one_clear_line() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        run = fieldhand("serve", "--port", str(taken.getsockname()[1]))
    assert run.status == 2
    assert len(run.err.splitlines()) == 1
    assert "cannot listen" in run.err


@pytest.mark.parametrize(
    ("host", "own"),
    [("127.0.0.1", True), ("localhost", True), ("::1", True), ("0.0.0.0", False), ("192.168.1.4", False)],
)
def test_names_are_held_to_where_only_this_machine_can_call(host: str, own: bool) -> None:
    assert is_loopback(host) is own
    hosts = hosts_for(host)
    assert (hosts is not None) is own
    assert hosts is None or host in hosts


def test_help_knows_serve_and_loads_no_server() -> None:
    script = (
        "import sys; sys.argv = ['fieldhand', '--help']\n"
        "from fieldhand.program import main\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "heavy = {'fastapi', 'uvicorn', 'starlette', 'pydantic', 'shapely', 'numpy', 'lxml'} & set(sys.modules)\n"
        "print('loaded:', sorted(heavy))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=LONG_S, check=True)
    assert "serve" in done.stdout
    assert "loaded: []" in done.stdout
