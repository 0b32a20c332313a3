"""Whoever has no token learns nothing, and cannot guess it."""

from __future__ import annotations

from pathlib import Path

import pytest

from fieldhand.api.gates import SECURITY_HEADERS
from support.missions.signed import good
from support.processes.robot_agents import RobotAgentInProcess

WRONG = {"Authorization": "Bearer wrong"}


@pytest.fixture
def robot_agent(tmp_path: Path) -> RobotAgentInProcess:
    return RobotAgentInProcess(tmp_path)


def test_every_answer_carries_the_security_headers(robot_agent: RobotAgentInProcess) -> None:
    answers = [
        robot_agent.call("GET", "/agent"),
        robot_agent.call("GET", "/"),
        robot_agent.call("GET", "/agent/missions/"),
        robot_agent.call("GET", "/agent", headers=WRONG),
        robot_agent.call("GET", "/agent", headers={"Host": "evil.example"}),
        robot_agent.call("POST", f"/agent/missions/{'0' * 64}/orders", content=b"x" * 70_000),
        robot_agent.upload(b"no mission"),
    ]
    assert [answer.status_code for answer in answers] == [200, 404, 404, 401, 403, 413, 400]
    for answer in answers:
        for name, value in SECURITY_HEADERS.items():
            assert answer.headers[name] == value
        assert answer.headers["cache-control"] == "no-store"


@pytest.mark.parametrize(
    "said", ["", "Bearer", "Bearer ", "Basic abc", "Bearer a", "Bearer \xff", "bearer " + "a" * 60]
)
def test_no_token_no_answer(robot_agent: RobotAgentInProcess, said: str) -> None:
    answer = robot_agent.call("GET", "/agent", headers={"Authorization": said.encode("latin-1")})
    assert answer.status_code == 401
    assert answer.headers["www-authenticate"] == "Bearer"
    assert robot_agent.slept == [0.5]


def test_guessing_is_slow_and_ends_and_never_locks_the_right_token_out(robot_agent: RobotAgentInProcess) -> None:
    """Somebody who guesses tokens may share an address with somebody who has one."""

    def guess() -> int:
        return robot_agent.call("GET", "/agent", headers=WRONG).status_code

    assert [guess() for _ in range(7)] == [401] * 5 + [429] * 2
    assert robot_agent.slept == [0.5] * 7
    assert robot_agent.call("GET", "/agent").status_code == 200
    assert robot_agent.upload(good()).status_code == 201
    assert guess() == 429
    robot_agent.seconds = 31.0
    assert [guess() for _ in range(6)] == [401] * 5 + [429]
    robot_agent.seconds += 31.0
    assert robot_agent.call("GET", "/agent", headers=WRONG).headers["retry-after"] == "29"
    assert robot_agent.call("GET", "/agent").status_code == 200
    robot_agent.seconds += 30.0
    assert guess() == 401


def test_another_page_cannot_use_a_browser_to_tell_the_robot(tmp_path: Path) -> None:
    robot_agent = RobotAgentInProcess(tmp_path, token=None)
    assert robot_agent.call("GET", "/agent").status_code == 200
    assert robot_agent.upload(good(), headers={"Origin": "https://evil.example"}).status_code == 403
    assert robot_agent.is_empty()


@pytest.mark.parametrize(
    "body", [b"", b"[]", b"{", b'{"order": "fly"}', b'{"order": "start", "x": 1}', b'{"order": "abort", "because": 3}']
)
def test_an_order_that_is_none(robot_agent: RobotAgentInProcess, body: bytes) -> None:
    robot_agent.upload(good())
    bundle = robot_agent.mission_store.latest(1)[0].sha256
    answer = robot_agent.call("POST", f"/agent/missions/{bundle}/orders", content=body)
    assert answer.status_code == 422
    assert set(answer.json()) == {"status", "what", "where", "advice"}
    for query in ("after=-1", "wait=nan", "wait=99", "after=x"):
        assert robot_agent.call("GET", f"/agent/missions/{bundle}/events?{query}").status_code == 422
