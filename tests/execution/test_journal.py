"""A mission that is cut off at any instant goes on from there: no capture is lost, none made twice but one in doubt."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from dataclasses import replace
from itertools import count
from pathlib import Path

import pytest

from execution.journalled import PICTURE, Field, PowerCut
from fieldhand.clock import SimulatedClock
from fieldhand.errors import JournalError
from fieldhand.evaluation.outcome import judge
from fieldhand.evaluation.report.observations import observations_csv
from fieldhand.execution import mission_clock, recorded_inputs
from fieldhand.execution.journal import store
from fieldhand.execution.journal.store import Journal
from fieldhand.execution.operator_commands import CommandFile, OperatorCommand
from fieldhand.places.selectors import TreeIs
from fieldhand.task.event_lines import from_json, to_json
from fieldhand.task.plan import Act
from fieldhand.task.results import Acted, Continued, Ended, Event, Exited, InDoubt, Paused, Resumed, Shed
from support.missions.rig import BudgetOf, captured, husky, of_type, orchard, task_for


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    monkeypatch.setattr(mission_clock.time, "sleep", lambda seconds: None)


@pytest.mark.parametrize("outlives", [False, True])
def test_cut_at_every_commit(tmp_path: Path, outlives: bool) -> None:
    whole = Field(tmp_path / "whole").fly()
    assert whole.status == "completed"
    doubts = 0
    for n in count(1):
        done = False
        for behind in (False, True):
            field = Field(tmp_path / f"{n}{behind}", outlives=outlives)
            try:
                field.fly(cut=n, behind=behind)
                done = True
            except PowerCut:
                pass
            result = field.fly()
            assert field.lines == [to_json(e) for e in result.events]
            assert [e for e in result.events if isinstance(e, Ended)] == [result.events[-1]]
            assert captured(result.events) == captured(whole.events)
            assert len(of_type(result.events, Resumed)) <= 1
            doubts += len(of_type(result.events, InDoubt))
        if done:
            break
    assert n > 10
    # Between the commit before a capture and the one behind it, each was in the air.
    assert doubts >= len(captured(whole.events))


def test_cut_again_and_again(tmp_path: Path) -> None:
    """A mission that gets ahead by one commit each time is done all the same, and each event stands once."""
    field = Field(tmp_path)
    result = None
    while result is None:
        try:
            result = field.fly(cut=4)
        except PowerCut:
            assert len(of_type([from_json(line) for line in field.lines], Resumed)) < 50
    assert result.status == "completed"
    assert len(of_type(result.events, Resumed)) > 3
    made = [(e.node, e.place, e.t) for e in of_type(result.events, Acted)]
    assert len(made) == len(set(made)) == len(captured(Field(tmp_path / "whole").fly().events))


def test_what_the_profile_says_is_done_about_a_capture_in_doubt(tmp_path: Path) -> None:
    leaf = husky()
    actions = tuple(replace(a, in_doubt="skip", measures=()) if a.name == PICTURE else a for a in leaf.actions)
    field = Field(tmp_path, robot=replace(leaf, actions=actions))
    plan = Act(id="", action=PICTURE, at=TreeIs(tree="r1c1"), count=3)
    with pytest.raises(PowerCut):
        field.fly(plan, cut=2, behind=True)
    result = field.fly(plan)
    (doubt,) = of_type(result.events, InDoubt)
    assert (doubt.then, doubt.place, result.status) == ("skip", "r1c1", "completed")
    assert len(captured(result.events)) == 2
    (outcome,) = judge(task_for(plan), result.events)
    assert outcome.outcome == "indeterminate"
    assert "in doubt" in outcome.why
    assert ",in_doubt," in observations_csv(result.events)
    assert from_json(to_json(doubt)) == doubt


def test_what_the_guard_said_holds(tmp_path: Path) -> None:
    """On another machine the guard may decide otherwise: what it decided before the cut stands."""
    field = Field(tmp_path)
    with pytest.raises(PowerCut):
        field.fly(cut=9, guard=BudgetOf(100))
    before = field.lines
    result = field.fly(guard=BudgetOf(0))
    assert [to_json(e) for e in result.events][: len(before)] == before
    assert not any('"shed"' in line for line in before)
    assert of_type(result.events, Shed)


def test_a_mission_of_a_version_whose_events_lacked_a_field_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def as_before(event: Event) -> str:
        return to_json(event).replace(', "names_places": false', "")

    field = Field(tmp_path)
    with monkeypatch.context() as earlier:
        earlier.setattr(recorded_inputs, "to_json", as_before)
        with pytest.raises(PowerCut):
            field.fly(cut=2, guard=BudgetOf(0))
    before = field.lines
    assert any('"shed"' in line and "names_places" not in line for line in before)
    result = field.fly(guard=BudgetOf(0))
    assert result.status == Field(tmp_path / "whole").fly(guard=BudgetOf(0)).status
    assert field.lines[: len(before)] == before


def test_another_task_or_journal_is_refused(tmp_path: Path) -> None:
    field = Field(tmp_path)
    with pytest.raises(PowerCut):
        field.fly(cut=6)
    with pytest.raises(JournalError, match="does not proceed as the journal records it"):
        field.fly(Act(id="", action="read_co2", at=TreeIs(tree="r3c3")))
    with pytest.raises(JournalError, match="another mission"):
        Journal(tmp_path / "journal.sqlite", "other", tmp_path / "log", print)


@pytest.mark.parametrize("harm", [lambda b: b"garbage" * 999, lambda b: b[:5000], lambda b: b""])
def test_a_damaged_journal_is_refused(tmp_path: Path, harm: Callable[[bytes], bytes]) -> None:
    field, path = Field(tmp_path), tmp_path / "journal.sqlite"
    field.fly()
    path.write_bytes(harm(path.read_bytes()))
    with pytest.raises(JournalError):
        field.fly()
    path.unlink()
    with pytest.raises(JournalError, match="no journal"):
        field.fly()


def test_a_journal_cut_in_mid_write_is_gone_on_with(tmp_path: Path) -> None:
    """Half a transaction at the end of the write-ahead log never happened."""
    field = Field(tmp_path)
    held = sqlite3.connect(tmp_path / "journal.sqlite")
    held.execute("SELECT * FROM tape").fetchall()  # keeps the write-ahead log from being folded in
    with pytest.raises(PowerCut):
        field.fly(cut=8)
    wal = tmp_path / "journal.sqlite-wal"
    left, base = wal.read_bytes(), (tmp_path / "journal.sqlite").read_bytes()
    held.close()
    for name in ("journal.sqlite-wal", "journal.sqlite-shm"):
        (tmp_path / name).unlink(missing_ok=True)
    (tmp_path / "journal.sqlite").write_bytes(base)
    wal.write_bytes(left + left[32:1000])
    assert field.fly().status == "completed"


@pytest.mark.parametrize("tail", ["", '{"event": "acti', "\0\0\0\0\0\n\0", "noise\n"])
def test_the_log_is_completed_from_the_journal(tmp_path: Path, tail: str) -> None:
    field = Field(tmp_path)
    whole = [to_json(e) for e in field.fly().events]
    for kept in (0, 3, len(whole)):
        (tmp_path / "log").write_text("".join(f"{line}\n" for line in whole[:kept]) + tail)
        field.fly()
        assert field.lines == whole


def test_a_journal_older_than_the_log_is_refused(tmp_path: Path) -> None:
    """Steps that it lacks were done: they would be done again."""
    field = Field(tmp_path)
    with pytest.raises(PowerCut):
        field.fly(cut=9)
    with (tmp_path / "log").open("a") as log:
        log.write('{"event": "action", "node": "n1"}\n')
    with pytest.raises(JournalError, match="older than the mission"):
        field.fly()


def test_a_full_disk_stops_the_robot_and_the_mission_goes_on_later(tmp_path: Path) -> None:
    field = Field(tmp_path, outlives=True)

    class Full(Journal):
        def commit(self, *, order: int = 0) -> None:
            self._db.execute("PRAGMA max_page_count = 1")
            super().commit(order=order)

    with Full(tmp_path / "journal.sqlite", "mission", tmp_path / "log", print) as journal:
        for _ in range(40):
            journal.event("x" * 4000)
        with pytest.raises(JournalError, match=r"full.*free some space"):
            journal.commit()
    assert field.fly().status == "completed"


def test_the_disk_is_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "FULL")
    Field(tmp_path)
    with Journal(tmp_path / "journal.sqlite", "mission", tmp_path / "log", print) as journal:
        assert journal._db.execute("PRAGMA synchronous").fetchone() == (2,)
        assert journal._db.execute("PRAGMA journal_mode").fetchone() == ("wal",)


def test_a_clock_that_is_set_back() -> None:
    class Jumpy(SimulatedClock):
        def now(self) -> float:
            return -1000.0 if 50 < super().now() < 90 else super().now()

    clock = mission_clock.MissionClock(Jumpy())
    seen = []
    for _ in range(30):
        clock.advance(7.0)
        seen.append(clock.look())
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx(210.0)


def says(*orders: tuple[int, OperatorCommand | None]) -> Callable[[], OperatorCommand | None]:
    """Orders from the n-th look on."""
    looks = count()

    def standing() -> OperatorCommand | None:
        look = next(looks)
        return next((order for n, order in reversed(orders) if look >= n), None)

    return standing


def test_a_pause_at_any_look_changes_nothing_but_the_time(tmp_path: Path) -> None:
    whole, pauses = Field(tmp_path / "whole").fly(), 0
    for n in range(0, 40, 5):
        field = Field(tmp_path / str(n))
        result = field.fly(orders=says((n, OperatorCommand(wanted="pause", reason="lunch", number=1)), (n + 9, None)))
        assert captured(result.events) == captured(whole.events)
        assert len(of_type(result.events, Paused)) == len(of_type(result.events, Continued)) <= 1
        pauses += len(of_type(result.events, Paused))
        again = field.fly()
        assert again.events == result.events
    assert result.status == "completed"
    assert pauses > 4


@pytest.mark.parametrize(("wanted", "then"), [("abort", "stay"), ("return", "return_to_end")])
def test_stop_here_and_come_home(tmp_path: Path, wanted: str, then: str) -> None:
    for n in range(1, 40, 4):
        field = Field(tmp_path / str(n))
        result = field.fly(orders=says((n, OperatorCommand(wanted=wanted, reason="rain", number=1))))  # type: ignore[arg-type]
        (way,) = of_type(result.events, Exited)
        if result.status == "completed":
            break
        assert (result.status, result.reason, way.then) == ("aborted", "rain", then)
        end = result.events[-1]
        assert isinstance(end, Ended)
        if wanted == "return":
            home = orchard().markers["end"]
            assert (end.lat, end.lon) == pytest.approx((home.lat, home.lon))
        assert field.fly().events == result.events
    assert n > 12


def test_a_paused_mission_that_is_cut_off_is_paused_again(tmp_path: Path) -> None:
    field, pause = Field(tmp_path), OperatorCommand(wanted="pause", reason="lunch", number=1)
    with pytest.raises(PowerCut):
        field.fly(cut=4, orders=says((8, pause)))
    result = field.fly(orders=says((0, pause), (5, None)))
    assert of_type(result.events, Paused)
    assert result.status == "completed"
    assert captured(result.events) == captured(Field(tmp_path / "whole").fly().events)


def test_a_mission_that_pauses_by_itself_can_be_told_to_go_on(tmp_path: Path) -> None:
    order_file = CommandFile(tmp_path / "orders.sqlite")
    order_file.create()
    assert order_file.give("continue", "the operator") == 1
    assert order_file.give("pause", "lunch") == 2


def test_orders_lie_where_another_process_finds_them(tmp_path: Path) -> None:
    order_file = CommandFile(tmp_path / "orders.sqlite")
    order_file.create()
    assert order_file.current() is None
    assert order_file.give("pause", "lunch") == 1
    assert order_file.current() == OperatorCommand(wanted="pause", reason="lunch", number=1)
    order_file.give("abort", "rain")
    with pytest.raises(Exception, match="already told to abort"):
        order_file.give("continue", "")
    order_file.close()
    (tmp_path / "orders.sqlite").write_bytes(b"garbage" * 99)
    for name in ("orders.sqlite-wal", "orders.sqlite-shm"):
        (tmp_path / name).unlink(missing_ok=True)
    stop = CommandFile(tmp_path / "orders.sqlite").current()
    assert stop is not None
    assert stop.wanted == "abort"
