"""Each simulated robot is a process that outlives the server; its folder is all that a server needs to find it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.errors import ExecutionError
from fieldhand.fleet import Fleet, MissionFeed
from fieldhand.fleet.worker_folder import WorkerFolder
from fieldhand.task.results import Acted, Continued, Ended, Paused
from support.missions.fleet import (
    FAST,
    SLOW,
    begun,
    kill_worker,
    patience,
    state_of,
    until_over,
    until_state,
    worker_pid,
)
from support.missions.kept import inputs
from support.processes.patience import until

pytestmark = pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="processes are found below /proc")


@pytest.fixture
def fleet(tmp_path: Path) -> Iterator[Fleet]:
    made = Fleet(tmp_path)
    yield made
    for name in made.under_way():
        kill_worker(made, name)


def test_a_mission_is_that_of_the_same_seed_and_is_reported(fleet: Fleet, tmp_path: Path) -> None:
    name = begun(fleet)
    plain = missions.begin(tmp_path / "plain", "one", inputs())
    result = missions.carry_out(plain, speed=None, emit=lambda _: None)
    until_over(fleet, name)
    assert missions.events_of(tmp_path / name) == result.events
    for file in ("report.html", "observations.csv", "observations.geojson"):
        assert (tmp_path / name / file).stat().st_size
    assert fleet.ids() == (name,)
    again = fleet.command(tmp_path / name, "pause", "Ana", wait=patience())
    assert (again.confirmed, again.sent) == (False, False)
    assert "has ended" in again.why


def test_another_server_finds_commands_and_ends_it(fleet: Fleet, tmp_path: Path) -> None:
    name = begun(fleet, SLOW)
    until_state(fleet, name, "running")
    pid = worker_pid(tmp_path / name)
    other = Fleet(tmp_path)
    assert other.continue_interrupted() == ()
    assert other.under_way() == (name,)
    feed = other.feed(name)
    assert feed is not None
    until(lambda: feed.position() is not None)
    for command, kind in (("pause", Paused), ("resume", Continued), ("abort", Ended)):
        answer = other.command(tmp_path / name, command, "Bob", wait=patience())  # type: ignore[arg-type]
        assert (answer.confirmed, answer.by) == (True, name)
        until(lambda kind=kind: any(isinstance(e, kind) for e in missions.events_of(tmp_path / name)))
    assert any("Bob" in str(getattr(e, "reason", "")) for e in missions.events_of(tmp_path / name))
    until_over(other, name)
    assert feed.summary().now.status == "aborted"
    assert pid
    assert feed.position() is None


def test_a_killed_worker_leaves_a_mission_that_goes_on_where_it_was(fleet: Fleet, tmp_path: Path) -> None:
    name = begun(fleet, replace(SLOW, speed=15.0))
    until(lambda: len(missions.events_of(tmp_path / name)) >= 2)
    kill_worker(fleet, name)
    before = missions.events_of(tmp_path / name)
    until_state(fleet, name, "interrupted")
    paused = fleet.command(tmp_path / name, "pause", "Ana", wait=patience())
    assert (paused.confirmed, paused.sent) == (False, False)
    assert "resume it first" in paused.why
    assert Fleet(tmp_path).continue_interrupted() == (name,)
    answer = fleet.command(tmp_path / name, "return", "Ana", wait=patience())
    assert answer.confirmed
    until_over(fleet, name)
    after = missions.events_of(tmp_path / name)
    assert after[: len(before)] == before
    assert isinstance(after[-1], Ended)
    assert sum(isinstance(event, Acted) for event in after) <= 1


def test_a_paused_mission_stays_where_it_is_until_someone_resumes_it(fleet: Fleet, tmp_path: Path) -> None:
    name = begun(fleet, SLOW)
    assert fleet.command(tmp_path / name, "pause", "Ana", wait=patience()).confirmed
    until_state(fleet, name, "paused")
    kill_worker(fleet, name)
    assert fleet.continue_interrupted() == ()
    assert fleet.command(tmp_path / name, "resume", "Ana", wait=patience()).confirmed
    until_state(fleet, name, "running")
    kill_worker(fleet, name)
    assert fleet.continue_interrupted() == (name,)


def test_no_mission_has_two_workers_and_no_more_run_than_may(tmp_path: Path, fleet: Fleet) -> None:
    small = Fleet(tmp_path, at_once=1)
    name = begun(small, SLOW)
    pid = worker_pid(tmp_path / name)
    for _ in range(3):
        fleet._start(tmp_path / name)
    assert worker_pid(tmp_path / name) == pid
    with pytest.raises(ExecutionError, match="1 mission is running"):
        begun(small)
    assert small.ids() == (name,)


def test_a_worker_that_cannot_go_on_says_why(fleet: Fleet, tmp_path: Path) -> None:
    name = begun(fleet, SLOW)
    until_state(fleet, name, "running")
    kill_worker(fleet, name)
    (tmp_path / name / "site" / "demo.geojson").write_bytes(b"")
    answer = fleet.command(tmp_path / name, "resume", "Ana", wait=patience())
    assert (answer.confirmed, answer.sent) == (False, True)
    assert "demo.geojson" in answer.why
    assert fleet.continue_interrupted() == ()


def test_missions_of_others_are_left_alone(fleet: Fleet, tmp_path: Path) -> None:
    stored = missions.begin(tmp_path, "by-hand", inputs())
    assert fleet.ids() == ()
    assert fleet.folder("by-hand") is None
    assert fleet.feed("by-hand") is None
    assert fleet.continue_interrupted() == ()
    for name in ("..", ".", "", "by-hand/../by-hand", "\0", "a" * 300):
        assert fleet.folder(name) is None
    assert missions.status(stored.folder).now.state == "interrupted"


def test_readers_behind_what_is_kept_read_the_journal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = missions.begin(tmp_path, "one", inputs()).folder
    WorkerFolder(folder).create(FAST)
    missions.carry_out(missions.open_mission(folder), speed=None, emit=lambda _: None)
    whole = missions.lines_after(folder, 0, 1000)
    monkeypatch.setattr("fieldhand.fleet.mission_feed.KEPT", 3)
    feed = MissionFeed(folder)
    for most in (1, 2, 5, 1000):
        got: list[tuple[int, str, str]] = []
        while lines := feed.lines_after(len(got), most):
            assert len(lines) <= most
            got += [(line.n, line.at, line.line) for line in lines]
        assert tuple(got) == whole
    assert feed.lines_after(10**12) == ()
    assert state_of(Fleet(tmp_path), "one") == "ended"
