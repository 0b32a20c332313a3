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
from fieldhand.delivery.link import RobotLink
from fieldhand.delivery.verified import sha256_of
from fieldhand.delivery.wire import LONGEST_WAIT_S
from fieldhand.errors import DeliveryError
from support.missions.signed import good
from support.processes.certificates import certificate
from support.processes.crowds import SENT, crowd, is_closed, served, until
from support.processes.stations import TOKEN, Station, other_mission

#: More than the agent has room for from one address.
MANY = 150


def drive(given: missions.Mission) -> object:
    """Carry a mission out in real time: it is under way until it is told to stop."""
    return missions.carry_out(given, speed=1.0, emit=lambda _: None)


@pytest.fixture
def station(tmp_path: Path) -> Iterator[Station]:
    made = Station(tmp_path, carry=drive)
    yield made
    with suppress(Exception):
        made.crew.tell(made.depot.get(sha256_of(good())), "abort", "the test ends")
    made.crew.join(30)


@contextmanager
def linked(port: int, token: str | None = TOKEN, tls: ssl.SSLContext | None = None) -> Iterator[RobotLink]:
    with httpx.Client(
        base_url=f"{'https' if tls else 'http'}://127.0.0.1:{port}",
        headers={"Host": "localhost", "Authorization": f"Bearer {token}"},
        timeout=httpx.Timeout(10.0, read=30.0 + LONGEST_WAIT_S),
        trust_env=False,
        verify=tls or True,
    ) as client:
        yield RobotLink(client)


def command(port: int, tls: ssl.SSLContext | None = None) -> None:
    """Send a mission and tell it everything that it can be told, each over a connection of its own."""
    with linked(port, tls=tls) as link:
        sent = link.deliver(good(), dict(unseal(good(), source="m").hashes))
    bundle = sent.mission.bundle
    for said, state in (("start", "running"), ("pause", "paused"), ("resume", "running"), ("abort", "ended")):
        with linked(port, tls=tls) as link:
            assert link.order(bundle, said).heard  # type: ignore[arg-type]
        with linked(port, tls=tls) as link:
            until(lambda state=state, link=link: link.robot().missions[0].state == state)  # type: ignore[misc]


@pytest.mark.parametrize("kind", SENT)
def test_orders_get_through_whoever_else_is_connected(station: Station, kind: str) -> None:
    with served(station.app) as port, crowd(port, kind, MANY):
        command(port)
    station.crew.join(30)
    assert station.crew.active is None


@pytest.mark.parametrize("kind", ["silent", "no HTTP"])
def test_orders_get_through_tls_whoever_else_is_connected(station: Station, tmp_path: Path, kind: str) -> None:
    cert, key, _ = certificate(tmp_path, "robot")
    trusting = ssl.create_default_context(cafile=str(cert))
    with served(station.app, tls=(cert, key)) as port, crowd(port, kind, MANY):
        command(port, tls=trusting)


def test_orders_get_through_those_who_hold_the_token_and_wait(station: Station) -> None:
    """Watchers and uploads without end, with the right token, from the same address."""
    bundle = sha256_of(good())
    head = f"Host: localhost\r\nAuthorization: Bearer {TOKEN}\r\n"
    watch = f"GET /agent/missions/{bundle}/events?after=999999&wait=25 HTTP/1.1\r\n{head}\r\n".encode()
    upload = f"PUT /agent/missions/{bundle} HTTP/1.1\r\n{head}Content-Length: 100000\r\n\r\n".encode() + b"x" * 100
    station.upload(good())
    assert station.crew.tell(station.depot.get(bundle), "start", "a test")
    with served(station.app) as port, ExitStack() as stack:
        for k in range(MANY):
            link = stack.enter_context(closing(socket.create_connection(("127.0.0.1", port), timeout=30)))
            with suppress(ConnectionError):
                link.sendall(upload if k % 3 == 0 else watch)
        with linked(port) as link:
            heard = link.order_now("abort")
        assert heard is not None
        assert heard.heard
    station.crew.join(30)
    assert station.crew.standing(station.depot.get(bundle)).status == "aborted"


def test_wrong_tokens_from_the_same_address_keep_no_order_out(station: Station) -> None:
    with served(station.app) as port:
        for _ in range(6):
            with linked(port, token="w" * 30) as link, pytest.raises(DeliveryError):
                link.robot()
        command(port)


def test_no_connection_waits_for_ever(station: Station) -> None:
    """However the other end drags it out; with a byte now and then, too."""
    limits = Connections(header_s=0.2, idle_s=0.2)
    with served(station.app, limits) as port:
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


def test_a_handshake_that_does_not_come_ends(station: Station, tmp_path: Path) -> None:
    cert, key, _ = certificate(tmp_path, "robot")
    limits = Connections(header_s=0.2, idle_s=0.2)
    with served(station.app, limits, (cert, key)) as port, crowd(port, "silent", 3) as links:
        for link in links:
            until(lambda link=link: is_closed(link))  # type: ignore[misc]


@pytest.mark.parametrize("said", ["pause", "return", "abort"])
def test_an_order_reaches_the_mission_while_its_folder_and_the_store_cannot_be_written(
    station: Station, said: str
) -> None:
    bundle = sha256_of(good())
    station.upload(good())
    held = station.depot.get(bundle)
    assert station.crew.tell(held, "start", "a test")
    folder = station.depot.folder_of(held)
    until(lambda: bool(missions.events_of(folder)))
    with served(station.app) as port, closing(sqlite3.connect(folder / "orders.sqlite", isolation_level=None)) as disk:
        disk.execute("BEGIN IMMEDIATE")
        with station.depot._guard, station.depot._ledger._guard, linked(port) as link:
            heard = link.order_now(said)  # type: ignore[arg-type]
            assert heard is not None
            assert heard.heard
        disk.execute("ROLLBACK")
    if said == "pause":
        until(lambda: station.crew.standing(held).state == "paused")
        assert station.crew.tell(held, "resume", "a test", wait=lambda: True)
        assert station.crew.tell(held, "abort", "a test", wait=lambda: True)
    station.crew.join(60)
    found = station.crew.standing(held)
    assert (found.state, found.status) == ("ended", "aborted")


def test_an_order_reaches_the_mission_while_another_one_is_verified(station: Station) -> None:
    """A second mission arrives, and its verification does not come to an end."""
    bundle, gate, inside = sha256_of(good()), threading.Event(), threading.Event()
    station.upload(good())
    accept = station.depot._accept

    def slow(data: bytes, source: str) -> object:
        inside.set()
        assert gate.wait(60)
        return accept(data, source)

    assert station.crew.tell(station.depot.get(bundle), "start", "a test")
    station.depot._accept = slow  # type: ignore[assignment]
    with served(station.app) as port, linked(port) as sender, linked(port) as operator:
        sent = dict(unseal(other_mission(), source="m").hashes)
        second = threading.Thread(target=lambda: sender.deliver(other_mission(), sent))
        second.start()
        assert inside.wait(60)
        heard = operator.order_now("abort")
        assert heard is not None
        assert heard.heard
        gate.set()
        second.join(60)
    station.crew.join(30)
    assert station.crew.standing(station.depot.get(bundle)).status == "aborted"
