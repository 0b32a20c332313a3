"""``fieldhand agent`` as a process: the page on delivery, killed while a mission arrives, refused unguarded."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shlex
import signal
import socket
import ssl
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing, suppress
from pathlib import Path

import pytest

from fieldhand.delivery.bundle_checks import sha256_of
from fieldhand.evaluation.calibration.history import load_missions
from support.missions.signed import good
from support.processes.certificates import certificate
from support.processes.command import Run, fieldhand
from support.processes.patience import LONG_S, until

TOKEN = "a-token-that-nobody-guesses-0123456789"


def free_port() -> int:
    with socket.socket() as tried:
        tried.bind(("127.0.0.1", 0))
        return int(tried.getsockname()[1])


PAGE = Path(__file__).resolve().parents[2] / "docs" / "delivery.md"


def test_every_command_of_the_page(tmp_path: Path) -> None:
    """In the order in which they stand, robot and laptop on one machine; and what nobody should be able to do."""
    port, lines = str(free_port()), "\n".join(re.findall(r"^```sh\n(.*?)^```", PAGE.read_text(), re.M | re.S))
    env = os.environ | {"FIELDHAND_CONFIG": str(tmp_path / "config"), "FIELDHAND_OUTBOX": str(tmp_path / "outbox")}
    watched, url, agents = "", f"https://localhost:{port}", list[subprocess.Popen[str]]()

    def run(*words: str) -> Run:
        return fieldhand(*words, cwd=tmp_path, env=env)

    try:
        for line in lines.replace("8443", port).splitlines():
            words = shlex.split(line, comments=True)
            if line.startswith("fieldhand agent "):
                waits = run("send", "tree4.mission", "--to", url, "--token-file", "token", "--ca", "robot.crt")
                assert waits.status == 1
                assert "waiting" in waits.out
                command = [sys.executable, "-m", *words, "--store", "store", "--speed", "8"]
                of_robot = env | {"XDG_STATE_HOME": str(tmp_path / "robot")}
                agents.append(subprocess.Popen(command, cwd=tmp_path, env=of_robot, stderr=subprocess.PIPE, text=True))
                _await(agents[0], int(port))
                _try_what_is_refused(tmp_path, url, run)
            elif line.startswith("fieldhand "):
                done = run(*words[1:])
                watched = done.out if line.startswith("fieldhand watch ") else watched
                assert done.status == 0, f"{line}\n{done.out[-2000:]}\n{done.err[-2000:]}"
            else:
                subprocess.run(line, shell=True, cwd=tmp_path, check=True, capture_output=True)
        late = run("order", url, "abort", "tree4.mission", "--token-file", "token", "--ca", "robot.crt")
        assert late.status == 1
        assert "has ended" in late.err
    finally:
        for agent in agents:
            agent.terminate()
            agent.communicate(timeout=LONG_S)
    (log,) = (tmp_path / "store" / "missions").glob("*/events.jsonl")
    assert (tmp_path / "events.jsonl").read_bytes() == log.read_bytes()
    page = log.parent / "report.html"
    assert "Take a thermal picture of tree 4" in page.read_text()
    assert f"its report on the robot: {Path('store', *page.parts[-3:])}" in " ".join(watched.split())
    assert [mission.simulated for mission in load_missions(tmp_path / "robot" / "fieldhand" / "history", "husky")] == [
        True
    ]
    kinds = [json.loads(line)["event"] for line in log.read_text().splitlines()]
    assert {"paused", "continued"} <= set(kinds)
    assert kinds[-1] == "mission"


def _await(agent: subprocess.Popen[str], port: int) -> None:
    """Wait until an agent answers."""
    assert agent.stderr is not None
    assert f":{port}" in agent.stderr.readline()

    def answers() -> bool:
        with suppress(OSError), closing(socket.create_connection(("127.0.0.1", port), timeout=1)):
            return True
        assert agent.poll() is None, "the agent has ended"
        return False

    until(answers)


def _try_what_is_refused(folder: Path, url: str, run: Callable[..., Run]) -> None:
    """Another certificate than the robot's, and a second agent on its store."""
    _, _, other = certificate(folder, "other")
    for wrong, said in ((("--pin", other), "a different certificate"), (("--ca", "other.crt"), "not trusted")):
        refused = run("send", "tree4.mission", "--to", url, "--token-file", "token", *wrong)
        assert refused.status == 1
        assert said in refused.out
    pinned = hashlib.sha256(ssl.PEM_cert_to_DER_cert((folder / "robot.crt").read_text())).hexdigest()
    by_address = url.replace("localhost", "127.0.0.1")
    assert run("watch", by_address, "--once", "--token-file", "token", "--pin", pinned).err.endswith("send it one\n")
    second = run("agent", "--robot", "husky", "--store", "store", "--port", str(free_port()))
    assert second.status == 2
    assert "another agent has this store open" in second.err


def test_an_agent_that_is_killed_within_an_upload_has_nothing(tmp_path: Path) -> None:
    port = free_port()
    env = os.environ | {"FIELDHAND_CONFIG": str(tmp_path / "config"), "FIELDHAND_TOKEN": TOKEN}
    command = [sys.executable, "-m", "fieldhand", "agent", "--robot", "husky", "--store", "store", "--port", str(port)]
    agent = subprocess.Popen(command, cwd=tmp_path, env=env, stderr=subprocess.PIPE, text=True)
    try:
        _await(agent, port)
        with closing(socket.create_connection(("127.0.0.1", port), timeout=LONG_S)) as link:
            head = f"PUT /agent/missions/{sha256_of(good())} HTTP/1.1\r\nHost: localhost\r\n"
            head += f"Authorization: Bearer {TOKEN}\r\nContent-Length: {len(good())}\r\n\r\n"
            link.sendall(head.encode() + good()[:-1])
            until(lambda: any((tmp_path / "store" / "incoming").iterdir()))
            agent.send_signal(signal.SIGKILL)
            agent.wait(LONG_S)
    finally:
        agent.kill()
        agent.communicate(timeout=LONG_S)
    assert not any((tmp_path / "store" / "bundles").iterdir())
    assert not any((tmp_path / "store" / "missions").iterdir())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--host", "0.0.0.0"), "no token and TLS"),
        (("--host", "0.0.0.0", "--token-file", "token"), "no TLS"),
        (("--cert", "robot.crt"), "needs a certificate and its key"),
        (("--cert", "robot.crt", "--key", "other.key"), "cannot be used"),
        (("--cert", "robot.crt", "--key", "wide.key"), "can be read by others"),
        (("--token-file", "wide.key"), "can be read by others"),
        (("--robot", "combine"), "combine"),
        (("--site", "nowhere.geojson"), "nowhere.geojson"),
        (("--store", "token"), "cannot be written"),
        (("--world", "robot.crt"), "robot.crt"),
        (("--speed", "-1"), "not a valid speed"),
    ],
)
def test_what_would_be_unguarded_or_cannot_be_used_is_refused(
    tmp_path: Path, words: tuple[str, ...], said: str
) -> None:
    certificate(tmp_path, "robot")
    certificate(tmp_path, "other")
    (tmp_path / "token").write_text(TOKEN)
    (tmp_path / "token").chmod(0o600)
    (tmp_path / "wide.key").write_bytes((tmp_path / "robot.key").read_bytes())
    (tmp_path / "wide.key").chmod(0o644)
    env = os.environ | {"FIELDHAND_CONFIG": str(tmp_path / "config")}
    given = ("agent", "--robot", "husky", "--store", "store", "--port", str(free_port()))
    run = fieldhand(*given, *words, cwd=tmp_path, env=env)
    assert run.status == 2
    assert said in run.err
    assert len(run.err.strip().splitlines()) == 1
