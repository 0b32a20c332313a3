"""``fieldhand serve``: listens where it is told, says where, and warns where others can reach it."""

from __future__ import annotations

import json
import os
import signal
import socket
import ssl
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from fieldhand.api.serving import hosts_for, is_loopback
from support.missions.fleet import worker_pid
from support.missions.kept import inputs
from support.processes.certificates import certificate
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
        with pytest.raises(urllib.error.HTTPError, match="401"):
            fetch(port, "/api/v1/robots")


def test_ctrl_c_ends_the_server_and_not_its_missions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another server finds the mission, still carried out by the same process, and commands it."""
    monkeypatch.setenv("FIELDHAND_MISSIONS", str(tmp_path))
    body = {"xml": inputs().document.decode(), "confirmed": list(inputs().authorized.authorization.confirmed)}
    with serving() as (_, server):
        local = LocalCaller(server)
        name = local.call("missions", {**body, "approved_by": "Ana", "speed": 2})["id"]
        stream = local.open("stream")
        stream.readline()
        until(lambda: local.call(f"missions/{name}/events")["state"] == "running")
        pid = worker_pid(tmp_path / name)
        os.killpg(server.pid, signal.SIGINT)
        server.wait(LONG_S)
        stream.close()
    assert worker_pid(tmp_path / name) == pid
    with serving() as (_, server):
        local = LocalCaller(server)
        (found,) = local.call("missions")
        assert (found["id"], found["state"]) == (name, "running")
        assert worker_pid(tmp_path / name) == pid
        answer = local.call(f"missions/{name}/commands", {"command": "abort"})
        assert (answer["confirmed"], answer["by"]) == (True, name)
        until(lambda: local.call(f"missions/{name}/events")["state"] == "ended")


class LocalCaller:
    """Whoever opens the link that a server prints."""

    def __init__(self, server: subprocess.Popen[str]) -> None:
        self._url, code = link_of(server)
        port = int(self._url.rstrip("/").rpartition(":")[2])
        fetch(port, "/")
        cookies = list[str]()
        session = post(f"{self._url}api/v1/session/code", {"code": code}, cookies=cookies)
        self._headers = {"Cookie": cookies[0].partition(";")[0], "X-Fieldhand-CSRF": str(session["csrf"])}

    def open(self, path: str, body: object = None) -> Any:
        data = None if body is None else json.dumps(body).encode()
        headers = {**self._headers, "Content-Type": "application/json"}
        return urllib.request.urlopen(
            urllib.request.Request(f"{self._url}api/v1/{path}", data, headers), timeout=LONG_S
        )

    def call(self, path: str, body: object = None) -> Any:
        with self.open(path, body) as answer:
            return json.load(answer)


def post(
    url: str, body: dict[str, str], trusted: ssl.SSLContext | None = None, cookies: list[str] | None = None
) -> dict[str, object]:
    request = urllib.request.Request(url, json.dumps(body).encode(), {"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=LONG_S, context=trusted) as found:
        if cookies is not None:
            cookies.append(found.headers["Set-Cookie"])
        return dict(json.loads(found.read()))


def link_of(server: subprocess.Popen[str]) -> tuple[str, str]:
    """The address and the code of the link that a server prints below its address."""
    assert server.stderr is not None
    server.stderr.readline()
    url, _, code = server.stderr.readline().split()[-1].partition("#code=")
    return url, code


def test_others_can_reach_it_only_with_tls_or_where_somebody_accepts_the_danger() -> None:
    refused = fieldhand("serve", "--host", "0.0.0.0")
    assert refused.status == 2
    assert "--tls-cert" in refused.err
    assert "--insecure" in refused.err
    with serving("--host", "0.0.0.0", "--insecure") as (port, server):
        url, code = link_of(server)
        assert server.stderr is not None
        assert "without TLS" in server.stderr.readline()
        assert url == f"http://127.0.0.1:{port}/"
        fetch(port, "/api/v1/health")
        assert post(f"{url}api/v1/session/code", {"code": code})["name"] == "local"


def test_the_link_opens_a_session_once_over_tls(tmp_path: Path) -> None:
    cert, key, _ = certificate(tmp_path, "localhost")
    with serving("--tls-cert", str(cert), "--tls-key", str(key)) as (port, server):
        url, code = link_of(server)
        assert url == f"https://127.0.0.1:{port}/"
        trusted, cookies = ssl.create_default_context(cafile=str(cert)), list[str]()

        def session() -> dict[str, object] | None:
            try:
                return post(f"{url}api/v1/session/code", {"code": code}, trusted, cookies)
            except urllib.error.HTTPError:
                raise
            except OSError:
                return None

        assert until(session) is not None
        assert "Secure" in cookies[0]
        with pytest.raises(urllib.error.HTTPError, match="401"):
            post(f"{url}api/v1/session/code", {"code": code}, trusted)


def test_a_certificate_needs_its_key(tmp_path: Path) -> None:
    cert, _, _ = certificate(tmp_path, "localhost")
    refused = fieldhand("serve", "--tls-cert", str(cert))
    assert refused.status == 2
    assert "give both --tls-cert and --tls-key" in refused.err


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
        "heavy = {'fastapi', 'sqlalchemy', 'argon2', 'uvicorn', 'starlette', 'pydantic', 'shapely', 'numpy', 'lxml'}\n"
        "heavy &= set(sys.modules)\n"
        "print('loaded:', sorted(heavy))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=LONG_S, check=True)
    assert "serve" in done.stdout
    assert "loaded: []" in done.stdout
