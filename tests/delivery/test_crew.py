"""A robot runs what it was told to, one mission at a time, and each at most once."""

from __future__ import annotations

import json
import shutil
import threading
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.delivery.crew import Crew
from fieldhand.delivery.depot import Depot
from fieldhand.delivery.ledger import Ledger
from fieldhand.delivery.standing import Standing
from fieldhand.delivery.verified import sha256_of
from fieldhand.errors import ExecutionError, FieldhandError, InputError, OutputError, StoreError
from fieldhand.execution.journal import store
from fieldhand.execution.operator_commands import parse_agent_command
from support.missions.signed import NOW, good
from support.processes.patience import LONG_S, until
from support.processes.stations import Station, fly, other_mission, patient


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


@pytest.fixture
def station(tmp_path: Path) -> Station:
    """A robot at which two missions have arrived."""
    made = Station(tmp_path)
    made.upload(good())
    made.upload(other_mission())
    return made


def standing(station: Station, data: bytes) -> Standing:
    return station.crew.standing(station.depot.get(sha256_of(data)))


def tell(station: Station, data: bytes, said: str) -> bool:
    return station.crew.tell(station.depot.get(sha256_of(data)), parse_agent_command(said), "a test")


def test_a_mission_runs_once_however_often_it_is_sent_and_started(station: Station) -> None:
    for _ in range(3):
        tell(station, good(), "start")
        station.crew.join(LONG_S)
        assert station.upload(good()).json()["mission"]["state"] == "ended"
        station.again()
    found = standing(station, good())
    assert (found.state, found.status) == ("ended", "completed")
    assert [line for line in station.events(good()) if '"started"' in line] == station.events(good())[:1]
    assert standing(station, other_mission()).state == "waiting"


def test_one_at_a_time(station: Station) -> None:
    gate = threading.Event()
    station.carry = patient(fly, gate)
    tell(station, good(), "start")
    assert standing(station, good()).state == "running"
    tell(station, good(), "start")
    with pytest.raises(ExecutionError, match="another mission is under way"):
        tell(station, other_mission(), "start")
    gate.set()
    station.crew.join(LONG_S)
    tell(station, other_mission(), "start")
    station.crew.join(LONG_S)
    assert [standing(station, data).state for data in (good(), other_mission())] == ["ended", "ended"]


@pytest.mark.parametrize("by_itself", [True, False])
def test_after_a_power_cut_nothing_else_begins_and_the_mission_goes_on(station: Station, by_itself: bool) -> None:
    station.carry = lambda _: None  # the power is cut before the first tick
    tell(station, good(), "start")
    station.again()
    station.carry = fly
    assert standing(station, good()).state == "interrupted"
    assert tell(station, good(), "start")
    with pytest.raises(ExecutionError, match="was cut off"):
        tell(station, other_mission(), "start")
    if by_itself:
        assert station.crew.go_on() == sha256_of(good())
    else:
        tell(station, good(), "resume")
    station.crew.join(LONG_S)
    assert standing(station, good()).status == "completed"
    assert station.crew.go_on() is None


@pytest.mark.parametrize("changed", ["key", "byte", "unsigned"])
@pytest.mark.parametrize("by_itself", [True, False])
def test_a_mission_that_may_not_run_any_more_does_not_go_on_and_keeps_nobody_from_working(
    station: Station, changed: str, by_itself: bool
) -> None:
    station.carry = lambda _: None
    tell(station, good(), "start")
    station.again()
    station.carry = fly
    folder = station.depot.folder_of(station.depot.get(sha256_of(good())))
    if changed == "key":
        station.trusted.revoke(next(iter(station.trusted.known())), at=NOW)
    elif changed == "byte":
        (folder / "signed.mission").write_bytes(good()[:-1] + b"!")
    else:
        about = json.loads((folder / "mission.json").read_bytes())
        del about["files"]["signed.mission"]
        (folder / "mission.json").write_text(json.dumps(about))
    if by_itself:
        assert station.crew.go_on() is None
    else:
        with pytest.raises(FieldhandError, match=r"revoked|not the one that the mission began with|lacks the signed"):
            tell(station, good(), "resume")
    assert not missions.events_of(folder)
    if changed != "key":
        tell(station, other_mission(), "start")
        station.crew.join(LONG_S)
        assert standing(station, other_mission()).status == "completed"


@pytest.mark.parametrize(("said", "then"), [("return", "return_to_"), ("abort", "stay")])
def test_a_mission_that_was_cut_off_can_be_called_home(station: Station, said: str, then: str) -> None:
    station.carry = lambda _: None
    tell(station, good(), "start")
    station.again()
    station.carry = fly
    tell(station, good(), said)
    station.crew.join(LONG_S)
    assert standing(station, good()).status == "aborted"
    assert f'"then": "{then}' in "".join(station.events(good()))
    with pytest.raises(ExecutionError):
        tell(station, good(), "pause")


def test_pause_and_resume(station: Station) -> None:
    gate = threading.Event()
    station.carry = patient(fly, gate)
    tell(station, good(), "start")
    tell(station, good(), "pause")
    gate.set()
    until(lambda: standing(station, good()).state == "paused")
    assert tell(station, good(), "resume") in (True, False)
    station.crew.join(LONG_S)
    assert standing(station, good()).status == "completed"
    kinds = "".join(station.events(good()))
    assert '"paused"' in kinds
    assert '"continued"' in kinds


def test_an_agent_that_ends_lets_its_robot_stand_still(station: Station) -> None:
    # Slow enough to be ended under way, however long this thread waits for its turn.
    station.carry = lambda given: missions.carry_out(given, speed=0.5, emit=lambda _: None)
    tell(station, good(), "start")
    moment = threading.Event()
    until(lambda: missions.is_running(station.depot.folder_of(station.depot.get(sha256_of(good())))))
    station.crew.rest(lambda: not moment.wait(0.01))
    assert standing(station, good()).state == "paused"
    tell(station, good(), "abort")
    station.crew.join(LONG_S)
    station.crew.rest(lambda: pytest.fail("nothing is under way"))


def test_what_has_ended_is_reported_once_before_the_next_begins(station: Station) -> None:
    gate, reported = threading.Event(), list[str]()

    def conclude(given: missions.Mission) -> None:
        assert gate.wait(LONG_S)
        (given.folder / "report.html").write_text("done")
        reported.append(given.id)

    station.conclude = conclude
    first, second = (station.depot.folder_of(station.depot.get(sha256_of(d))) for d in (good(), other_mission()))
    tell(station, good(), "start")
    until(lambda: standing(station, good()).state == "ended")
    assert standing(station, good()).report == ""
    assert not station.call("GET", f"/agent/missions/{sha256_of(good())}/events").json()["idle"]
    threading.Timer(0.05, gate.set).start()
    tell(station, other_mission(), "start")
    assert standing(station, good()).report == str(first / "report.html")
    station.crew.join(LONG_S)
    station.again()
    station.crew.make_up()
    station.crew.join(LONG_S)
    assert reported == [first.name, second.name]


@pytest.mark.parametrize("cut", ["power", "disk"])
def test_a_report_that_could_not_be_written_is_made_up_for(station: Station, cut: str) -> None:
    def full(_: missions.Mission) -> None:
        if cut == "disk":
            raise OutputError("the disk is full")

    station.conclude = full
    tell(station, good(), "start")
    station.crew.join(LONG_S)
    found = standing(station, good())
    assert (found.state, found.status, found.report) == ("ended", "completed", "")
    assert ("the disk is full" in found.fault) == (cut == "disk")
    gate = threading.Event()
    station.conclude = lambda given: gate.wait(LONG_S) and (given.folder / "report.html").write_text("done")
    station.again()
    station.crew.make_up()
    assert standing(station, good()).report == "", "the agent answers while it is written"
    gate.set()
    station.crew.join(LONG_S)
    assert standing(station, good()).report.endswith("report.html")


def test_an_agent_on_which_nothing_ran_has_nothing_to_make_up_for(station: Station) -> None:
    station.conclude = lambda _: pytest.fail("there is nothing to report")
    station.crew.make_up()
    station.crew.join(LONG_S)
    station.carry = lambda _: None
    tell(station, good(), "start")
    station.again()
    station.crew.make_up()
    station.crew.join(LONG_S)


@pytest.mark.parametrize("said", ["pause", "resume", "return", "abort"])
def test_what_was_not_begun_can_only_be_started(station: Station, said: str) -> None:
    with pytest.raises(ExecutionError, match="was not begun"):
        tell(station, good(), said)
    with pytest.raises(InputError, match="no order"):
        parse_agent_command(f"{said}!")


def test_what_a_mission_did_is_not_forgotten_with_its_folder(station: Station) -> None:
    tell(station, good(), "start")
    station.crew.join(LONG_S)
    shutil.rmtree(station.depot.missions)
    station.again()
    assert standing(station, good()).state == "lost"
    with pytest.raises(ExecutionError, match="does not run twice"):
        tell(station, good(), "start")


def test_a_bundle_that_changed_on_the_disk_does_not_start(station: Station) -> None:
    path = station.store / "bundles" / f"{sha256_of(good())}.mission"
    path.write_bytes(other_mission())
    with pytest.raises(StoreError, match="not what arrived"):
        tell(station, good(), "start")
    path.unlink()
    with pytest.raises(StoreError, match="cannot be read"):
        tell(station, good(), "start")
    station.upload(good())
    tell(station, good(), "start")
    station.crew.join(LONG_S)
    assert standing(station, good()).status == "completed"


def test_a_fault_of_a_mission_leaves_the_agent_as_it_was(station: Station) -> None:
    def broken(_: object) -> None:
        raise ZeroDivisionError

    def stuck(_: object) -> None:
        raise StoreError("the disk is full")

    for carry, said in ((broken, "ZeroDivisionError"), (stuck, "the disk is full")):
        station.carry = carry
        tell(station, good(), "resume" if station.depot.last_begun() else "start")
        station.crew.join(LONG_S)
        assert said in standing(station, good()).fault
    station.carry = fly
    tell(station, other_mission(), "start")
    station.crew.join(LONG_S)
    assert standing(station, other_mission()).status == "completed"


def test_a_journal_that_is_damaged_keeps_no_robot_from_working(station: Station) -> None:
    station.carry = lambda _: None
    tell(station, good(), "start")
    station.crew.join(LONG_S)
    (station.store / "missions" / sha256_of(good())[:16] / "journal.sqlite").write_bytes(b"garbage" * 1000)
    station.again()
    station.carry = fly
    assert standing(station, good()).state == "lost"
    assert station.call("GET", "/agent").json()["missions"][0]["fault"]
    tell(station, other_mission(), "start")
    station.crew.join(LONG_S)
    assert standing(station, other_mission()).status == "completed"


def test_a_clock_that_was_set_back_is_said(station: Station) -> None:
    station.now = lambda: NOW - timedelta(days=30)
    with pytest.raises(FieldhandError, match="the clock of this machine says"):
        tell(station, good(), "start")
    station.now = lambda: NOW
    tell(station, good(), "start")
    station.crew.join(LONG_S)
    station.now = lambda: NOW - timedelta(hours=20)
    tell(station, other_mission(), "start")
    station.crew.join(LONG_S)
    last = station.depot.last_begun()
    assert last is not None
    assert last.sha256 == sha256_of(other_mission())


# --- the store -------------------------------------------------------------------------------------------------------


def test_two_agents_never_hold_one_store(station: Station) -> None:
    with pytest.raises(StoreError, match="another agent"):
        Depot(station.store, accept=lambda *_: pytest.fail("accepted"), now=lambda: NOW)
    assert station.upload(good()).status_code == 200


@pytest.mark.parametrize("garbage", [b"garbage" * 1000, b"SQLite format 3\x00" + b"\xff" * 5000])
def test_a_damaged_store_is_said(tmp_path: Path, garbage: bytes) -> None:
    (tmp_path / "depot.sqlite").write_bytes(garbage)
    with pytest.raises(StoreError, match="damaged"):
        Depot(tmp_path, accept=lambda *_: pytest.fail("accepted"), now=lambda: NOW)


def test_a_store_of_another_version_is_said(tmp_path: Path) -> None:
    ledger = Ledger(tmp_path / "depot.sqlite")
    ledger._db.execute("UPDATE about SET value = '99'")
    ledger.close()
    with pytest.raises(StoreError, match="format 99"):
        Ledger(tmp_path / "depot.sqlite")


def test_a_power_cut_within_an_arrival_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between the bundle on the disk and its line in the database."""
    station = Station(tmp_path)

    class PowerCut(BaseException):
        pass

    def cut(*_: object) -> None:
        raise PowerCut

    with monkeypatch.context() as patch:
        patch.setattr(Ledger, "note", cut)
        with station.depot.receiving() as part:
            part.write(good())
            with pytest.raises(PowerCut):
                station.depot.take(part, sha256_of(good()))
    (station.store / "incoming" / "half").write_bytes(good()[:1000])
    assert any((station.store / "bundles").iterdir())
    station.again()
    assert station.is_empty()


def test_a_power_cut_while_a_mission_begins_lets_it_begin_once(
    station: Station, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(Depot, "note_begun", lambda *_: (_ for _ in ()).throw(StoreError("power")))
        with pytest.raises(StoreError, match="power"):
            tell(station, good(), "start")
    station.again()
    assert standing(station, good()).state == "interrupted"
    assert station.crew.go_on() == sha256_of(good())
    station.crew.join(LONG_S)
    assert standing(station, good()).status == "completed"


def test_the_seed_and_the_date_are_kept(station: Station) -> None:
    held = station.depot.get(sha256_of(good()))
    assert datetime.fromisoformat(held.received_at) == NOW.replace(microsecond=0)
    assert (held.signer, held.request) == ("Ada", "Take 3 CO2 readings at tree 1.")
    assert isinstance(station.crew, Crew)
