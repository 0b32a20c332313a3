"""What arrives at a robot is whole, signed and meant for it, or it is not there."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand import missions
from fieldhand.agent.uploads import UploadLimits
from fieldhand.approval.bundle.opening import unseal
from fieldhand.delivery import incoming_file
from fieldhand.delivery.bundle_checks import sha256_of
from support.examples import examples
from support.missions.signed import KEY, NOW, good, opened, orchard_files, pack_mission, signing_key
from support.processes.robot_agents import RobotAgentInProcess, other_mission


def test_a_whole_mission_is_acknowledged_with_what_was_verified_and_waits(tmp_path: Path) -> None:
    robot_agent = RobotAgentInProcess(tmp_path)
    first, again = robot_agent.upload(good()), robot_agent.upload(good())
    assert (first.status_code, again.status_code) == (201, 200)
    assert first.json()["hashes"] == again.json()["hashes"] == dict(unseal(good(), source="m").hashes)
    assert (first.json()["new"], again.json()["new"]) == (True, False)
    assert first.json()["mission"]["state"] == again.json()["mission"]["state"] == "waiting"
    assert len(robot_agent.mission_store.latest(9)) == 1
    assert not any(robot_agent.mission_store.missions.iterdir())


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> RobotAgentInProcess:
    return RobotAgentInProcess(tmp_path_factory.mktemp("robot"))


@settings(max_examples=examples(12, thorough=400), deadline=None)
@given(point=st.integers(0, len(good()) - 1), size=st.integers(1, 9000), stall=st.booleans())
def test_what_is_cut_off_leaves_nothing(empty: RobotAgentInProcess, point: int, size: int, stall: bool) -> None:
    empty.uploads.__dict__["idle_s"] = 0.001 if stall else 20.0
    chunks = [good()[k : min(k + size, point)] for k in range(0, point, size)]
    length = {"Content-Length": str(len(good()))}
    status, _ = empty.receive(length, *chunks, sha256=sha256_of(good()), stall=stall)
    assert status == (408 if stall else 400)
    assert empty.is_empty()


@settings(max_examples=examples(12, thorough=400), deadline=None)
@given(bits=st.sets(st.integers(0, len(good()) * 8 - 1), min_size=1, max_size=4), sender_knows=st.booleans())
def test_what_is_corrupted_leaves_nothing(empty: RobotAgentInProcess, bits: set[int], sender_knows: bool) -> None:
    """Be it on the way, or before the sender computed its SHA-256."""
    body = bytearray(good())
    for bit in bits:
        body[bit // 8] ^= 1 << bit % 8
    answer = empty.upload(bytes(body), None if sender_knows else sha256_of(good()))
    assert answer.status_code in (400, 422)
    assert empty.is_empty()


@settings(max_examples=examples(4, thorough=100), deadline=None)
@given(more=st.binary(min_size=1, max_size=50), told=st.booleans())
def test_what_is_longer_leaves_nothing(empty: RobotAgentInProcess, more: bytes, told: bool) -> None:
    length = len(good()) + len(more) * told
    sent = {"Content-Length": str(length)}
    status, _ = empty.receive(sent, good(), more, sha256=sha256_of(good()))
    assert status == 400
    assert empty.is_empty()


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({}, 411),
        ({"Content-Length": "5", "Transfer-Encoding": "chunked"}, 411),
        ({"Content-Length": "-5"}, 413),
        ({"Content-Length": "٣"}, 413),
        ({"Content-Length": "999999999999"}, 413),
        ({"Content-Length": "9" * 400}, 413),
        ({"Content-Length": "5", "Authorization": "Bearer wrong"}, 401),
    ],
)
def test_nothing_is_read_of_what_is_not_taken(empty: RobotAgentInProcess, headers: dict[str, str], status: int) -> None:
    assert empty.receive(headers, b"PK", sha256="0" * 64) == (status, 0)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (pack_mission(key=signing_key(2, "Eve")), "not trusted here"),
        (b"", "is empty"),
        (b"PK\x03\x04", "truncated"),
        (pack_mission(at="2026-05-03T00:00:00+00:00"), "the clock of this machine shows"),
    ],
)
def test_what_may_not_run_here_is_not_kept(empty: RobotAgentInProcess, data: bytes, said: str) -> None:
    answer = empty.upload(data)
    assert answer.status_code in (400, 422)
    assert said in answer.json()["what"]
    assert empty.is_empty()


def test_a_mission_for_another_robot_or_site_is_not_kept(tmp_path: Path) -> None:
    for robot_agent in (
        RobotAgentInProcess(tmp_path / "a", robot="amiga"),
        RobotAgentInProcess(tmp_path / "b", sites=(opened(other_mission()).site,)),
    ):
        answer = robot_agent.upload(good())
        assert answer.status_code == 400
        assert "was approved for another" in answer.json()["what"]
        assert robot_agent.is_empty()
    assert RobotAgentInProcess(tmp_path / "c", sites=(opened(good()).site,)).upload(good()).status_code == 201


def test_a_revoked_signer_is_refused_at_arrival_and_at_the_start(tmp_path: Path) -> None:
    robot_agent = RobotAgentInProcess(tmp_path)
    robot_agent.upload(good())
    robot_agent.trusted.revoke(KEY.public.fingerprint, at=NOW)
    assert robot_agent.upload(other_mission()).status_code == 422
    answer = robot_agent.call("POST", f"/agent/missions/{sha256_of(good())}/orders", json={"order": "start"})
    assert answer.status_code == 422
    assert "revoked" in answer.json()["what"]
    assert not any(robot_agent.mission_store.missions.iterdir())


@pytest.mark.parametrize("where", ["write", "fsync", "replace"])
def test_a_full_disk_is_said_and_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str) -> None:
    robot_agent = RobotAgentInProcess(tmp_path)

    def full(*_: Any, **__: Any) -> Any:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        if where == "write":
            patch.setattr(
                incoming_file.IncomingFile,
                "write",
                lambda part, _: incoming_file.IncomingFile.drop(part) or _raise(part.path),
            )
        elif where == "fsync":
            patch.setattr(incoming_file.os, "fsync", full)
        else:
            patch.setattr(Path, "replace", full)
        answer = robot_agent.upload(good())
    assert answer.status_code == 507
    assert "No space left" in answer.json()["what"]
    assert robot_agent.is_empty()
    assert robot_agent.upload(good()).status_code == 201


def _raise(path: Path) -> Any:
    raise incoming_file.unwritable(path, OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))


def test_so_many_uploads_at_once(tmp_path: Path) -> None:
    robot_agent = RobotAgentInProcess(tmp_path, uploads=UploadLimits(at_once=0))
    assert robot_agent.upload(good()).status_code == 503


@pytest.mark.parametrize(
    "name", ["../../../etc/passwd", "..%2f..%2fetc%2fpasswd", "x", "0" * 63, "0" * 65, "A" * 64, f"{'0' * 64}/../x"]
)
def test_no_name_from_outside_is_a_name_of_a_file(empty: RobotAgentInProcess, name: str) -> None:
    for method in ("GET", "PUT"):
        assert empty.call(method, f"/agent/missions/{name}").status_code in (404, 405, 422)
    assert empty.is_empty()


def test_an_older_approval_of_a_mission_does_not_come_back(tmp_path: Path) -> None:
    """A bundle that was replaced by a later approval is neither taken nor started, wherever it is."""
    robot_agent = RobotAgentInProcess(tmp_path)
    old, new = pack_mission(at="2026-04-30T08:00:00+02:00"), good()
    robot_agent.upload(old)
    assert robot_agent.upload(new).status_code == 201
    answer = robot_agent.call("POST", f"/agent/missions/{sha256_of(old)}/orders", json={"order": "start"})
    assert answer.status_code == 409
    assert "later approval" in answer.json()["what"]
    oldest = pack_mission(at="2026-04-01T08:00:00+02:00")
    assert robot_agent.upload(oldest).status_code == 409
    assert not any(robot_agent.mission_store.missions.iterdir())
    assert robot_agent.upload(pack_mission(orchard_files(7), at="2026-04-01T08:00:00+02:00")).status_code == 201
    assert missions.all_missions(robot_agent.mission_store.missions) == ()
