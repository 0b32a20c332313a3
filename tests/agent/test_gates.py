"""Whoever has no token learns nothing, and cannot guess it."""

from __future__ import annotations

from pathlib import Path

import pytest

from fieldhand.api.gates import SECURITY_HEADERS
from support.missions.signed import good
from support.processes.stations import Station

WRONG = {"Authorization": "Bearer wrong"}


@pytest.fixture
def station(tmp_path: Path) -> Station:
    return Station(tmp_path)


def test_every_answer_carries_the_security_headers(station: Station) -> None:
    answers = [
        station.call("GET", "/agent"),
        station.call("GET", "/"),
        station.call("GET", "/agent/missions/"),
        station.call("GET", "/agent", headers=WRONG),
        station.call("GET", "/agent", headers={"Host": "evil.example"}),
        station.call("POST", f"/agent/missions/{'0' * 64}/orders", content=b"x" * 70_000),
        station.upload(b"no mission"),
    ]
    assert [answer.status_code for answer in answers] == [200, 404, 404, 401, 403, 413, 400]
    for answer in answers:
        for name, value in SECURITY_HEADERS.items():
            assert answer.headers[name] == value
        assert answer.headers["cache-control"] == "no-store"


@pytest.mark.parametrize(
    "said", ["", "Bearer", "Bearer ", "Basic abc", "Bearer a", "Bearer \xff", "bearer " + "a" * 60]
)
def test_no_token_no_answer(station: Station, said: str) -> None:
    answer = station.call("GET", "/agent", headers={"Authorization": said.encode("latin-1")})
    assert answer.status_code == 401
    assert answer.headers["www-authenticate"] == "Bearer"
    assert station.slept == [0.5]


def test_guessing_is_slow_and_ends_and_never_locks_the_right_token_out(station: Station) -> None:
    """Who guesses may share an address with who may give orders."""

    def guess() -> int:
        return station.call("GET", "/agent", headers=WRONG).status_code

    assert [guess() for _ in range(7)] == [401] * 5 + [429] * 2
    assert station.slept == [0.5] * 7
    assert station.call("GET", "/agent").status_code == 200
    assert station.upload(good()).status_code == 201
    assert guess() == 429
    station.seconds = 31.0
    assert [guess() for _ in range(6)] == [401] * 5 + [429]
    station.seconds += 31.0
    assert station.call("GET", "/agent", headers=WRONG).headers["retry-after"] == "29"
    assert station.call("GET", "/agent").status_code == 200
    station.seconds += 30.0
    assert guess() == 401


def test_another_page_cannot_use_a_browser_to_tell_the_robot(tmp_path: Path) -> None:
    station = Station(tmp_path, token=None)
    assert station.call("GET", "/agent").status_code == 200
    assert station.upload(good(), headers={"Origin": "https://evil.example"}).status_code == 403
    assert station.is_empty()


@pytest.mark.parametrize(
    "body", [b"", b"[]", b"{", b'{"order": "fly"}', b'{"order": "start", "x": 1}', b'{"order": "abort", "because": 3}']
)
def test_an_order_that_is_none(station: Station, body: bytes) -> None:
    station.upload(good())
    bundle = station.depot.latest(1)[0].sha256
    answer = station.call("POST", f"/agent/missions/{bundle}/orders", content=body)
    assert answer.status_code == 422
    assert set(answer.json()) == {"status", "what", "where", "advice"}
    for query in ("after=-1", "wait=nan", "wait=99", "after=x"):
        assert station.call("GET", f"/agent/missions/{bundle}/events?{query}").status_code == 422
