"""Whoever has the token can stop the robot, whatever others do to its agent, and however slow its disk is."""

from __future__ import annotations

import socket
import sqlite3
import ssl
import threading
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path

import httpx
import pytest

from fieldhand import missions
from fieldhand.api.connections import Connections
from fieldhand.approval.bundle.opening import unseal
from fieldhand.delivery.bundle_checks import sha256_of
from fieldhand.delivery.json_models import LONGEST_WAIT_S
from fieldhand.delivery.robot_client import RobotClient
from fieldhand.errors import DeliveryError
from support.missions.signed import good
from support.processes.certificates import certificate
from support.processes.crowds import SENT, crowd, is_closed, served, until
from support.processes.robot_agents import TOKEN, RobotAgentInProcess, other_mission

#: More than the agent has room for from one address.
MANY = 150


def drive(given: missions.StoredMission) -> object:
    """Carry a mission out in real time: it is under way until it is told to stop."""
    return missions.carry_out(given, speed=1.0, emit=lambda _: None)


@pytest.fixture
def robot_agent(tmp_path: Path) -> Iterator[RobotAgentInProcess]:
    made = RobotAgentInProcess(tmp_path, carry=drive)
    yield made
    with suppress(Exception):
        made.supervisor.give_command(made.mission_store.get(sha256_of(good())), "abort", "the test ends")
    made.supervisor.join(30)


@contextmanager
def linked(port: int, token: str | None = TOKEN, tls: ssl.SSLContext | None = None) -> Iterator[RobotClient]:
    with httpx.Client(
        base_url=f"{'https' if tls else 'http'}://127.0.0.1:{port}",
        headers={"Host": "localhost", "Authorization": f"Bearer {token}"},
        timeout=httpx.Timeout(10.0, read=30.0 + LONGEST_WAIT_S),
        trust_env=False,
        verify=tls or True,
    ) as client:
        yield RobotClient(client)


def command(port: int, tls: ssl.SSLContext | None = None) -> None:
    """Send a mission and tell it everything that it can be told, each over a connection of its own."""
    with linked(port, tls=tls) as link:
        sent = link.deliver(good(), dict(unseal(good(), source="m").hashes))
    bundle = sent.mission.bundle
    for said, state in (("start", "running"), ("pause", "paused"), ("resume", "running"), ("abort", "ended")):
        with linked(port, tls=tls) as link:
            link.order(bundle, said)  # type: ignore[arg-type]  # heard later than it waits on a busy machine
        with linked(port, tls=tls) as link:
            until(lambda state=state, link=link: link.robot().missions[0].state == state)  # type: ignore[misc]


@pytest.mark.parametrize("kind", SENT)
def test_orders_get_through_whoever_else_is_connected(robot_agent: RobotAgentInProcess, kind: str) -> None:
    with served(robot_agent.app) as port, crowd(port, kind, MANY):
        command(port)
    robot_agent.supervisor.join(30)
    assert robot_agent.supervisor.active is None


@pytest.mark.parametrize("kind", ["silent", "no HTTP"])
def test_orders_get_through_tls_whoever_else_is_connected(
    robot_agent: RobotAgentInProcess, tmp_path: Path, kind: str
) -> None:
    cert, key, _ = certificate(tmp_path, "robot")
    trusting = ssl.create_default_context(cafile=str(cert))
    with served(robot_agent.app, tls=(cert, key)) as port, crowd(port, kind, MANY):
        command(port, tls=trusting)


def test_orders_get_through_those_who_hold_the_token_and_wait(robot_agent: RobotAgentInProcess) -> None:
    """Watchers and uploads without end, with the right token, from the same address."""
    bundle = sha256_of(good())
    head = f"Host: localhost\r\nAuthorization: Bearer {TOKEN}\r\n"
    watch = f"GET /agent/missions/{bundle}/events?after=999999&wait=25 HTTP/1.1\r\n{head}\r\n".encode()
    upload = f"PUT /agent/missions/{bundle} HTTP/1.1\r\n{head}Content-Length: 100000\r\n\r\n".encode() + b"x" * 100
    robot_agent.upload(good())
    assert robot_agent.supervisor.give_command(robot_agent.mission_store.get(bundle), "start", "a test")
    with served(robot_agent.app) as port, ExitStack() as stack:
        for k in range(MANY):
            link = stack.enter_context(closing(socket.create_connection(("127.0.0.1", port), timeout=30)))
            with suppress(ConnectionError):
                link.sendall(upload if k % 3 == 0 else watch)
        with linked(port) as link:
            heard = link.order_now("abort")
        assert heard is not None
        assert heard.heard
    robot_agent.supervisor.join(30)
    assert robot_agent.supervisor.status_of(robot_agent.mission_store.get(bundle)).status == "aborted"


def test_wrong_tokens_from_the_same_address_keep_no_order_out(robot_agent: RobotAgentInProcess) -> None:
    with served(robot_agent.app) as port:
        for _ in range(6):
            with linked(port, token="w" * 30) as link, pytest.raises(DeliveryError):
                link.robot()
        command(port)


def test_no_connection_waits_for_ever(robot_agent: RobotAgentInProcess) -> None:
    """However the other end drags it out; with a byte now and then, too."""
    limits = Connections(header_s=0.2, idle_s=0.2)
    with served(robot_agent.app, limits) as port:
        for kind in SENT:
            with crowd(port, kind, 3) as links:
                for link in links:
                    until(lambda link=link: _dripped(link) or is_closed(link))  # type: ignore[misc]


def _dripped(link: socket.socket) -> bool:
    """Send one more byte; True if the connection has ended."""
    try:
        link.send(b"x", socket.MSG_DONTWAIT)
    except BlockingIOError:
        return False
    except OSError:
        return True
    return False


def test_a_handshake_that_does_not_come_ends(robot_agent: RobotAgentInProcess, tmp_path: Path) -> None:
    cert, key, _ = certificate(tmp_path, "robot")
    limits = Connections(header_s=0.2, idle_s=0.2)
    with served(robot_agent.app, limits, (cert, key)) as port, crowd(port, "silent", 3) as links:
        for link in links:
            until(lambda link=link: is_closed(link))  # type: ignore[misc]


@pytest.mark.parametrize("said", ["pause", "return", "abort"])
def test_an_order_reaches_the_mission_while_its_folder_and_the_store_cannot_be_written(
    robot_agent: RobotAgentInProcess, said: str
) -> None:
    bundle = sha256_of(good())
    robot_agent.upload(good())
    held = robot_agent.mission_store.get(bundle)
    assert robot_agent.supervisor.give_command(held, "start", "a test")
    folder = robot_agent.mission_store.folder_of(held)
    until(lambda: bool(missions.events_of(folder)))
    with (
        served(robot_agent.app) as port,
        closing(sqlite3.connect(folder / "orders.sqlite", isolation_level=None)) as disk,
    ):
        disk.execute("BEGIN IMMEDIATE")
        with robot_agent.mission_store._lock, robot_agent.mission_store._database._thread_lock, linked(port) as link:
            heard = link.order_now(said)  # type: ignore[arg-type]
            assert heard is not None
            assert heard.heard
        disk.execute("ROLLBACK")
    if said == "pause":
        until(lambda: robot_agent.supervisor.status_of(held).state == "paused")
        assert robot_agent.supervisor.give_command(held, "resume", "a test", wait=lambda: True)
        assert robot_agent.supervisor.give_command(held, "abort", "a test", wait=lambda: True)
    robot_agent.supervisor.join(60)
    found = robot_agent.supervisor.status_of(held)
    assert (found.state, found.status) == ("ended", "aborted")


def test_an_order_reaches_the_mission_while_another_one_is_verified(robot_agent: RobotAgentInProcess) -> None:
    """A second mission arrives, and its verification does not come to an end."""
    bundle, gate, inside = sha256_of(good()), threading.Event(), threading.Event()
    robot_agent.upload(good())
    accept = robot_agent.mission_store._accept

    def slow(data: bytes, source: str) -> object:
        inside.set()
        assert gate.wait(60)
        return accept(data, source)

    assert robot_agent.supervisor.give_command(robot_agent.mission_store.get(bundle), "start", "a test")
    robot_agent.mission_store._accept = slow  # type: ignore[assignment]
    with served(robot_agent.app) as port, linked(port) as sender, linked(port) as operator:
        sent = dict(unseal(other_mission(), source="m").hashes)
        second = threading.Thread(target=lambda: sender.deliver(other_mission(), sent))
        second.start()
        assert inside.wait(60)
        heard = operator.order_now("abort")
        assert heard is not None
        assert heard.heard
        gate.set()
        second.join(60)
    robot_agent.supervisor.join(30)
    assert robot_agent.supervisor.status_of(robot_agent.mission_store.get(bundle)).status == "aborted"
