"""A sender loses no mission and believes no wrong acknowledgement, whatever becomes of the link."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import httpx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.approval.bundle.opening import unseal
from fieldhand.delivery.agent_token import read_token
from fieldhand.delivery.bundle_checks import Sendable, require_sendable, sha256_of
from fieldhand.delivery.follow_mission import follow
from fieldhand.delivery.json_models import EventLine
from fieldhand.delivery.outbox import Outbox, OutboxEntry
from fieldhand.delivery.outbox_sender import LONGEST_S, START_WITHIN_S, OutboxSender
from fieldhand.delivery.robot_client import RobotClient
from fieldhand.delivery.server_certificate import ServerTrust, parse_pin, require_address
from fieldhand.errors import DeliveryError, InputError, KeyFileError, NotTrustedError, StoreError, UnreachableError
from fieldhand.execution.journal import store
from support.examples import examples
from support.missions.signed import NOW, good, known
from support.processes.patience import LONG_S
from support.processes.robot_agents import RobotAgentInProcess, other_mission


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


def check(data: bytes, source: str) -> Sendable:
    return require_sendable(data, source=source, known={}, now=NOW)


class Sender:
    """A sender to a robot over a line that loses what it is told to."""

    def __init__(
        self, folder: Path, robot_agent: RobotAgentInProcess, lose: Callable[[httpx.Request], str] = lambda _: ""
    ) -> None:
        self.seconds, self.lose = 1000.0, lose
        self.outbox = Outbox(folder / "outbox")
        self.outbox_sender = OutboxSender(
            outbox=self.outbox,
            connect=lambda _: robot_agent.link(lambda request: self.lose(request)),
            check=check,
            clock=lambda: self.seconds,
            rng=random.Random(7),
        )

    def put(self, data: bytes, *, start: bool = False, url: str = "http://localhost") -> OutboxEntry:
        entry = OutboxEntry(
            sha256=sha256_of(data), url=url, name="m.mission", start=start, queued_at=self.seconds, next_at=self.seconds
        )
        return self.outbox.put(entry, data)


@pytest.fixture
def robot_agent(tmp_path: Path) -> RobotAgentInProcess:
    return RobotAgentInProcess(tmp_path)


def test_what_could_not_be_sent_is_sent_when_the_robot_is_back(
    tmp_path: Path, robot_agent: RobotAgentInProcess
) -> None:
    sender = Sender(tmp_path, robot_agent, lambda _: "request")
    sender.outbox_sender.post(sender.put(good()))
    waits = []
    for tries in range(1, 12):
        (entry,) = sender.outbox.waiting()
        assert entry.tries == tries
        assert "does not answer" in entry.response
        waits.append(entry.next_at - sender.seconds)
        assert sender.outbox_sender.next_s() == waits[-1]
        sender.seconds = entry.next_at - 0.001
        assert sender.outbox_sender.post_due() == ()
        sender.seconds = entry.next_at
        sender.outbox_sender.post_due()
    assert all(min(LONGEST_S, 4.0 * 2**k) / 2 <= wait <= min(LONGEST_S, 4.0 * 2**k) for k, wait in enumerate(waits))
    assert robot_agent.is_empty()
    sender.lose = lambda _: ""
    again = Sender(tmp_path, robot_agent)  # the first one was killed meanwhile
    (done,) = again.outbox_sender.post_due(all_of_them=True)
    assert done.state == "delivered"
    assert again.outbox.waiting() == ()
    assert again.outbox_sender.next_s() is None
    assert [path.name for path in (tmp_path / "outbox").glob("*.mission")] == []
    assert robot_agent.mission_store.find(sha256_of(good())) is not None


@settings(max_examples=examples(4, thorough=150), deadline=None)
@given(losses=st.lists(st.sampled_from(["", "request", "answer"]), max_size=8))
def test_however_the_link_is_lost_the_mission_arrives_and_runs_once(
    tmp_path_factory: pytest.TempPathFactory, losses: list[str]
) -> None:
    folder = tmp_path_factory.mktemp("robot")
    robot_agent, left = RobotAgentInProcess(folder), list(losses)
    sender = Sender(folder, robot_agent, lambda _: left.pop(0) if left else "")
    sender.put(good(), start=True)
    while sender.outbox.waiting():
        sender.outbox_sender.post_due(all_of_them=True)
    robot_agent.supervisor.join(LONG_S)
    assert [entry.state for entry in sender.outbox.entries()] == ["delivered"]
    lines = robot_agent.events(good())
    taken: list[EventLine] = []
    left[:] = losses
    last = follow(
        robot_agent.link(lambda _: left.pop(0) if left else ""),
        sha256_of(good()),
        take=taken.append,
        once=False,
        wait_s=0.0,
        lost=lambda *_: None,
        rng=random.Random(1),
    )
    assert [event.line for event in taken] == lines
    assert [event.n for event in taken] == list(range(1, len(lines) + 1))
    assert (last.state, last.status) == ("ended", "completed")
    assert sum('"started"' in line for line in lines) == 1
    robot_agent.mission_store.close()


def test_what_the_robot_refuses_is_not_sent_again(tmp_path: Path, robot_agent: RobotAgentInProcess) -> None:
    robot_agent.trusted.revoke(next(iter(robot_agent.trusted.known())), at=NOW)
    sender = Sender(tmp_path, robot_agent)
    done = sender.outbox_sender.post(sender.put(good()))
    assert done.state == "refused"
    assert "revoked" in done.response
    assert sender.outbox.waiting() == ()


@pytest.mark.parametrize("wrong", ["hash", "bundle", "missing", "nonsense", "huge", "html"])
def test_an_acknowledgement_of_something_else_is_not_believed(wrong: str, robot_agent: RobotAgentInProcess) -> None:
    honest = robot_agent.upload(good()).json()

    def answer(_: httpx.Request) -> httpx.Response:
        said = {**honest, "hashes": dict(honest["hashes"]), "mission": dict(honest["mission"])}
        if wrong == "hash":
            said["hashes"]["site.geojson"] = "0" * 64
        elif wrong == "missing":
            del said["hashes"]["robot.yaml"]
        elif wrong == "bundle":
            said["mission"]["bundle"] = "0" * 64
        else:
            return httpx.Response(200, content={"nonsense": b"{}", "huge": b" " * 17_000_000, "html": b"<html>"}[wrong])
        return httpx.Response(200, json=said)

    link = RobotClient(httpx.Client(transport=httpx.MockTransport(answer), base_url="http://robot"))
    with pytest.raises(DeliveryError) as caught:
        link.deliver(good(), unseal(good(), source="m").hashes)
    assert not isinstance(caught.value, UnreachableError)


@pytest.mark.parametrize(
    ("status", "later"), [(503, True), (507, True), (429, True), (408, True), (401, True), (403, False)]
)
def test_what_may_succeed_later_is_tried_later(status: int, later: bool) -> None:
    def answer(_: httpx.Request) -> httpx.Response:
        return httpx.Response(status, content=b"<html>")

    link = RobotClient(httpx.Client(transport=httpx.MockTransport(answer), base_url="http://robot"))
    with pytest.raises(DeliveryError) as caught:
        link.robot()
    assert isinstance(caught.value, UnreachableError) is later


def test_an_event_that_is_missing_is_noticed(robot_agent: RobotAgentInProcess) -> None:
    robot_agent.upload(good())
    robot_agent.call("POST", f"/agent/missions/{sha256_of(good())}/orders", json={"order": "start"})
    robot_agent.supervisor.join(LONG_S)
    path = f"/agent/missions/{sha256_of(good())}/events"
    found = robot_agent.call("GET", path).json()
    del found["events"][1]

    def answer(_: httpx.Request) -> httpx.Response:
        return httpx.Response(200, json=found)

    link = RobotClient(httpx.Client(transport=httpx.MockTransport(answer), base_url="http://robot"))
    with pytest.raises(DeliveryError, match="after number 0 is missing"):
        link.events(sha256_of(good()), 0, 0.0)


def test_a_mission_that_is_to_start_takes_the_place_of_another_that_waits(
    tmp_path: Path, robot_agent: RobotAgentInProcess
) -> None:
    sender = Sender(tmp_path, robot_agent)
    sender.put(good(), start=True)
    sender.put(other_mission(), start=True, url="http://another")
    assert [entry.start for entry in sender.outbox.entries()] == [True, True]
    sender.put(other_mission(), start=True)
    assert [entry.start for entry in sender.outbox.entries()] == [False, True, True]


@pytest.mark.parametrize("late", [START_WITHIN_S + 1.0, -1.0])
def test_nobody_is_surprised_by_a_mission_that_waited_too_long(
    tmp_path: Path, robot_agent: RobotAgentInProcess, late: float
) -> None:
    """Nor by one of which the clock says that it was sent tomorrow."""
    sender = Sender(tmp_path, robot_agent)
    entry = sender.put(good(), start=True)
    sender.seconds += late
    done = sender.outbox_sender.post(entry)
    assert done.state == "delivered"
    assert "was not started" in done.response
    assert not any(robot_agent.mission_store.missions.iterdir())


def test_a_clock_that_was_set_back_delays_nothing_for_long(tmp_path: Path, robot_agent: RobotAgentInProcess) -> None:
    sender = Sender(tmp_path, robot_agent, lambda _: "request")
    sender.outbox_sender.post(sender.put(good()))
    sender.seconds -= 500_000.0
    assert (sender.outbox_sender.next_s() or 0.0) <= LONGEST_S
    sender.lose = lambda _: ""
    assert [entry.state for entry in sender.outbox_sender.post_due()] == ["delivered"]


def test_an_outbox_that_was_meddled_with(tmp_path: Path, robot_agent: RobotAgentInProcess) -> None:
    sender = Sender(tmp_path, robot_agent)
    entry = sender.put(good())
    path = tmp_path / "outbox" / f"{entry.sha256}.mission"
    path.write_bytes(other_mission())
    assert "differs from what was queued" in sender.outbox_sender.post(entry).response
    assert robot_agent.is_empty()
    (tmp_path / "outbox" / "outbox.sqlite").write_bytes(b"garbage" * 999)
    with pytest.raises(StoreError, match="outbox cannot be used"):
        sender.outbox.entries()
    with pytest.raises(StoreError, match="outbox cannot be used"):
        sender.put(good())


def test_a_mission_sent_twice_waits_once(tmp_path: Path, robot_agent: RobotAgentInProcess) -> None:
    sender = Sender(tmp_path, robot_agent)
    first, second = sender.put(good()), sender.put(good())
    assert [entry.n for entry in sender.outbox.waiting()] == [second.n]
    sender.outbox.note(replace(first, state="delivered"))
    assert [entry.state for entry in sender.outbox.entries()] == ["waiting"]
    assert sender.outbox.bundle(second) == good()


def test_a_key_that_was_revoked_here_is_not_sent(tmp_path: Path) -> None:
    assert require_sendable(good(), source="m", known={}, now=NOW).sha256 == sha256_of(good())
    with pytest.raises(NotTrustedError, match="revoked"):
        require_sendable(good(), source="m", known=known(revoked="2026-05-01T00:00:00+00:00"), now=NOW)


@pytest.mark.parametrize(
    "url", ["", "robot", "ftp://robot", "https://", "http://robot:8443", "https://u:p@robot", "https://robot?x=1", "https://[::1"]
)  # fmt: skip
def test_an_address_that_is_none(url: str) -> None:
    with pytest.raises(InputError):
        require_address(url, ServerTrust())


def test_addresses_pins_and_tokens(tmp_path: Path) -> None:
    assert require_address("https://robot:8443/", ServerTrust()) == "https://robot:8443"
    assert require_address("http://localhost:8443", ServerTrust()) == "http://localhost:8443"
    assert require_address("http://robot:8443", ServerTrust(plain=True)) == "http://robot:8443"
    for trust in (ServerTrust(pin="ab" * 32), ServerTrust(ca="ca.crt")):
        with pytest.raises(InputError, match="only with TLS"):
            require_address("http://localhost:8443", trust)
    assert parse_pin("SHA256 Fingerprint=" + ":".join(["AB"] * 32)) == "ab" * 32
    for text in ("", "ab" * 31, "xy" * 32):
        with pytest.raises(InputError):
            parse_pin(text)
    assert read_token({}, None) is None
    assert read_token({"FIELDHAND_TOKEN": "a" * 24}, None) == "a" * 24
    file = tmp_path / "token"
    for text in ("short", "a b" * 20, "ä" * 40, "a" * 2000):
        file.write_text(text)
        file.chmod(0o600)
        with pytest.raises(InputError, match="letters and digits"):
            read_token({}, file)
    file.write_text("b" * 64 + "\n")
    assert read_token({"FIELDHAND_TOKEN": "a" * 24}, file) == "b" * 64
    file.chmod(0o644)
    with pytest.raises(KeyFileError, match="can be read by others"):
        read_token({}, file)
