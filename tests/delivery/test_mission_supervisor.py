"""A robot runs what it was told to, one mission at a time, and each at most once."""

from __future__ import annotations

import json
import shutil
import threading
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.delivery.bundle_checks import sha256_of
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import MissionSupervisor
from fieldhand.delivery.received_missions import ReceivedMissions
from fieldhand.delivery.received_status import ReceivedStatus
from fieldhand.errors import ExecutionError, FieldhandError, InputError, OutputError, StoreError
from fieldhand.execution.journal import store
from fieldhand.execution.operator_commands import parse_agent_command
from support.missions.signed import NOW, good
from support.processes.patience import LONG_S, until
from support.processes.robot_agents import RobotAgentInProcess, fly, other_mission, patient


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


@pytest.fixture
def robot_agent(tmp_path: Path) -> RobotAgentInProcess:
    """A robot at which two missions have arrived."""
    made = RobotAgentInProcess(tmp_path)
    made.upload(good())
    made.upload(other_mission())
    return made


def standing(robot_agent: RobotAgentInProcess, data: bytes) -> ReceivedStatus:
    return robot_agent.supervisor.status_of(robot_agent.mission_store.get(sha256_of(data)))


def tell(robot_agent: RobotAgentInProcess, data: bytes, said: str) -> bool:
    return robot_agent.supervisor.give_command(
        robot_agent.mission_store.get(sha256_of(data)), parse_agent_command(said), "a test"
    )


def test_a_mission_runs_once_however_often_it_is_sent_and_started(robot_agent: RobotAgentInProcess) -> None:
    for _ in range(3):
        tell(robot_agent, good(), "start")
        robot_agent.supervisor.join(LONG_S)
        assert robot_agent.upload(good()).json()["mission"]["state"] == "ended"
        robot_agent.again()
    found = standing(robot_agent, good())
    assert (found.state, found.status) == ("ended", "completed")
    assert [line for line in robot_agent.events(good()) if '"started"' in line] == robot_agent.events(good())[:1]
    assert standing(robot_agent, other_mission()).state == "waiting"


def test_one_at_a_time(robot_agent: RobotAgentInProcess) -> None:
    gate = threading.Event()
    robot_agent.carry = patient(fly, gate)
    tell(robot_agent, good(), "start")
    assert standing(robot_agent, good()).state == "running"
    tell(robot_agent, good(), "start")
    with pytest.raises(ExecutionError, match="another mission is under way"):
        tell(robot_agent, other_mission(), "start")
    gate.set()
    robot_agent.supervisor.join(LONG_S)
    tell(robot_agent, other_mission(), "start")
    robot_agent.supervisor.join(LONG_S)
    assert [standing(robot_agent, data).state for data in (good(), other_mission())] == ["ended", "ended"]


@pytest.mark.parametrize("by_itself", [True, False])
def test_after_a_power_cut_nothing_else_begins_and_the_mission_goes_on(
    robot_agent: RobotAgentInProcess, by_itself: bool
) -> None:
    robot_agent.carry = lambda _: None  # the power is cut before the first tick
    tell(robot_agent, good(), "start")
    robot_agent.again()
    robot_agent.carry = fly
    assert standing(robot_agent, good()).state == "interrupted"
    assert tell(robot_agent, good(), "start")
    with pytest.raises(ExecutionError, match="was interrupted"):
        tell(robot_agent, other_mission(), "start")
    if by_itself:
        assert robot_agent.supervisor.continue_interrupted() == sha256_of(good())
    else:
        tell(robot_agent, good(), "resume")
    robot_agent.supervisor.join(LONG_S)
    assert standing(robot_agent, good()).status == "completed"
    assert robot_agent.supervisor.continue_interrupted() is None


@pytest.mark.parametrize("changed", ["key", "byte", "unsigned"])
@pytest.mark.parametrize("by_itself", [True, False])
def test_a_mission_that_may_not_run_any_more_does_not_go_on_and_keeps_nobody_from_working(
    robot_agent: RobotAgentInProcess, changed: str, by_itself: bool
) -> None:
    robot_agent.carry = lambda _: None
    tell(robot_agent, good(), "start")
    robot_agent.again()
    robot_agent.carry = fly
    folder = robot_agent.mission_store.folder_of(robot_agent.mission_store.get(sha256_of(good())))
    if changed == "key":
        robot_agent.trusted.revoke(next(iter(robot_agent.trusted.known())), at=NOW)
    elif changed == "byte":
        (folder / "signed.mission").write_bytes(good()[:-1] + b"!")
    else:
        about = json.loads((folder / "mission.json").read_bytes())
        del about["files"]["signed.mission"]
        (folder / "mission.json").write_text(json.dumps(about))
    if by_itself:
        assert robot_agent.supervisor.continue_interrupted() is None
    else:
        with pytest.raises(
            FieldhandError, match=r"revoked|not the file that the mission started with|lacks the signed"
        ):
            tell(robot_agent, good(), "resume")
    assert not missions.events_of(folder)
    if changed != "key":
        tell(robot_agent, other_mission(), "start")
        robot_agent.supervisor.join(LONG_S)
        assert standing(robot_agent, other_mission()).status == "completed"


@pytest.mark.parametrize(("said", "then"), [("return", "return_to_"), ("abort", "stay")])
def test_a_mission_that_was_cut_off_can_be_called_home(robot_agent: RobotAgentInProcess, said: str, then: str) -> None:
    robot_agent.carry = lambda _: None
    tell(robot_agent, good(), "start")
    robot_agent.again()
    robot_agent.carry = fly
    tell(robot_agent, good(), said)
    robot_agent.supervisor.join(LONG_S)
    assert standing(robot_agent, good()).status == "aborted"
    assert f'"then": "{then}' in "".join(robot_agent.events(good()))
    with pytest.raises(ExecutionError):
        tell(robot_agent, good(), "pause")


def test_pause_and_resume(robot_agent: RobotAgentInProcess) -> None:
    gate = threading.Event()
    robot_agent.carry = patient(fly, gate)
    tell(robot_agent, good(), "start")
    tell(robot_agent, good(), "pause")
    gate.set()
    until(lambda: standing(robot_agent, good()).state == "paused")
    assert tell(robot_agent, good(), "resume") in (True, False)
    robot_agent.supervisor.join(LONG_S)
    assert standing(robot_agent, good()).status == "completed"
    kinds = "".join(robot_agent.events(good()))
    assert '"paused"' in kinds
    assert '"continued"' in kinds


def test_an_agent_that_ends_lets_its_robot_stand_still(robot_agent: RobotAgentInProcess) -> None:
    # Slow enough to be ended under way, however long this thread waits for its turn.
    robot_agent.carry = lambda given: missions.carry_out(given, speed=0.5, emit=lambda _: None)
    tell(robot_agent, good(), "start")
    moment = threading.Event()
    until(
        lambda: missions.is_running(
            robot_agent.mission_store.folder_of(robot_agent.mission_store.get(sha256_of(good())))
        )
    )
    robot_agent.supervisor.pause_for_exit(lambda: not moment.wait(0.01))
    assert standing(robot_agent, good()).state == "paused"
    tell(robot_agent, good(), "abort")
    robot_agent.supervisor.join(LONG_S)
    robot_agent.supervisor.pause_for_exit(lambda: pytest.fail("nothing is under way"))


def test_what_has_ended_is_reported_once_before_the_next_begins(robot_agent: RobotAgentInProcess) -> None:
    gate, reported = threading.Event(), list[str]()

    def conclude(given: missions.StoredMission) -> None:
        assert gate.wait(LONG_S)
        (given.folder / "report.html").write_text("done")
        reported.append(given.id)

    robot_agent.conclude = conclude
    first, second = (
        robot_agent.mission_store.folder_of(robot_agent.mission_store.get(sha256_of(d)))
        for d in (good(), other_mission())
    )
    tell(robot_agent, good(), "start")
    until(lambda: standing(robot_agent, good()).state == "ended")
    assert standing(robot_agent, good()).report == ""
    assert not robot_agent.call("GET", f"/agent/missions/{sha256_of(good())}/events").json()["idle"]
    threading.Timer(0.05, gate.set).start()
    tell(robot_agent, other_mission(), "start")
    assert standing(robot_agent, good()).report == str(first / "report.html")
    robot_agent.supervisor.join(LONG_S)
    robot_agent.again()
    robot_agent.supervisor.write_missing_report()
    robot_agent.supervisor.join(LONG_S)
    assert reported == [first.name, second.name]


@pytest.mark.parametrize("cut", ["power", "disk"])
def test_a_report_that_could_not_be_written_is_made_up_for(robot_agent: RobotAgentInProcess, cut: str) -> None:
    def full(_: missions.StoredMission) -> None:
        if cut == "disk":
            raise OutputError("the disk is full")

    robot_agent.conclude = full
    tell(robot_agent, good(), "start")
    robot_agent.supervisor.join(LONG_S)
    found = standing(robot_agent, good())
    assert (found.state, found.status, found.report) == ("ended", "completed", "")
    assert ("the disk is full" in found.fault) == (cut == "disk")
    gate = threading.Event()
    robot_agent.conclude = lambda given: gate.wait(LONG_S) and (given.folder / "report.html").write_text("done")
    robot_agent.again()
    robot_agent.supervisor.write_missing_report()
    assert standing(robot_agent, good()).report == "", "the agent answers while it is written"
    gate.set()
    robot_agent.supervisor.join(LONG_S)
    assert standing(robot_agent, good()).report.endswith("report.html")


def test_an_agent_on_which_nothing_ran_has_nothing_to_make_up_for(robot_agent: RobotAgentInProcess) -> None:
    robot_agent.conclude = lambda _: pytest.fail("there is nothing to report")
    robot_agent.supervisor.write_missing_report()
    robot_agent.supervisor.join(LONG_S)
    robot_agent.carry = lambda _: None
    tell(robot_agent, good(), "start")
    robot_agent.again()
    robot_agent.supervisor.write_missing_report()
    robot_agent.supervisor.join(LONG_S)


@pytest.mark.parametrize("said", ["pause", "resume", "return", "abort"])
def test_what_was_not_begun_can_only_be_started(robot_agent: RobotAgentInProcess, said: str) -> None:
    with pytest.raises(ExecutionError, match="has not been started"):
        tell(robot_agent, good(), said)
    with pytest.raises(InputError, match="no order"):
        parse_agent_command(f"{said}!")


def test_what_a_mission_did_is_not_forgotten_with_its_folder(robot_agent: RobotAgentInProcess) -> None:
    tell(robot_agent, good(), "start")
    robot_agent.supervisor.join(LONG_S)
    shutil.rmtree(robot_agent.mission_store.missions)
    robot_agent.again()
    assert standing(robot_agent, good()).state == "lost"
    with pytest.raises(ExecutionError, match="does not run twice"):
        tell(robot_agent, good(), "start")


def test_a_bundle_that_changed_on_the_disk_does_not_start(robot_agent: RobotAgentInProcess) -> None:
    path = robot_agent.store / "bundles" / f"{sha256_of(good())}.mission"
    path.write_bytes(other_mission())
    with pytest.raises(StoreError, match="differs from what arrived"):
        tell(robot_agent, good(), "start")
    path.unlink()
    with pytest.raises(StoreError, match="cannot be read"):
        tell(robot_agent, good(), "start")
    robot_agent.upload(good())
    tell(robot_agent, good(), "start")
    robot_agent.supervisor.join(LONG_S)
    assert standing(robot_agent, good()).status == "completed"


def test_a_fault_of_a_mission_leaves_the_agent_as_it_was(robot_agent: RobotAgentInProcess) -> None:
    def broken(_: object) -> None:
        raise ZeroDivisionError

    def stuck(_: object) -> None:
        raise StoreError("the disk is full")

    for carry, said in ((broken, "ZeroDivisionError"), (stuck, "the disk is full")):
        robot_agent.carry = carry
        tell(robot_agent, good(), "resume" if robot_agent.mission_store.last_begun() else "start")
        robot_agent.supervisor.join(LONG_S)
        assert said in standing(robot_agent, good()).fault
    robot_agent.carry = fly
    tell(robot_agent, other_mission(), "start")
    robot_agent.supervisor.join(LONG_S)
    assert standing(robot_agent, other_mission()).status == "completed"


def test_a_journal_that_is_damaged_keeps_no_robot_from_working(robot_agent: RobotAgentInProcess) -> None:
    robot_agent.carry = lambda _: None
    tell(robot_agent, good(), "start")
    robot_agent.supervisor.join(LONG_S)
    (robot_agent.store / "missions" / sha256_of(good())[:16] / "journal.sqlite").write_bytes(b"garbage" * 1000)
    robot_agent.again()
    robot_agent.carry = fly
    assert standing(robot_agent, good()).state == "lost"
    assert robot_agent.call("GET", "/agent").json()["missions"][0]["fault"]
    tell(robot_agent, other_mission(), "start")
    robot_agent.supervisor.join(LONG_S)
    assert standing(robot_agent, other_mission()).status == "completed"


def test_a_clock_that_was_set_back_is_said(robot_agent: RobotAgentInProcess) -> None:
    robot_agent.now = lambda: NOW - timedelta(days=30)
    with pytest.raises(FieldhandError, match="the clock of this machine shows"):
        tell(robot_agent, good(), "start")
    robot_agent.now = lambda: NOW
    tell(robot_agent, good(), "start")
    robot_agent.supervisor.join(LONG_S)
    robot_agent.now = lambda: NOW - timedelta(hours=20)
    tell(robot_agent, other_mission(), "start")
    robot_agent.supervisor.join(LONG_S)
    last = robot_agent.mission_store.last_begun()
    assert last is not None
    assert last.sha256 == sha256_of(other_mission())


# --- the store -------------------------------------------------------------------------------------------------------


def test_two_agents_never_hold_one_store(robot_agent: RobotAgentInProcess) -> None:
    with pytest.raises(StoreError, match="another agent"):
        MissionStore(robot_agent.store, accept=lambda *_: pytest.fail("accepted"), now=lambda: NOW)
    assert robot_agent.upload(good()).status_code == 200


@pytest.mark.parametrize("garbage", [b"garbage" * 1000, b"SQLite format 3\x00" + b"\xff" * 5000])
def test_a_damaged_store_is_said(tmp_path: Path, garbage: bytes) -> None:
    (tmp_path / "depot.sqlite").write_bytes(garbage)
    with pytest.raises(StoreError, match="damaged"):
        MissionStore(tmp_path, accept=lambda *_: pytest.fail("accepted"), now=lambda: NOW)


def test_a_store_of_another_version_is_said(tmp_path: Path) -> None:
    ledger = ReceivedMissions(tmp_path / "depot.sqlite")
    ledger._db.execute("UPDATE about SET value = '99'")
    ledger.close()
    with pytest.raises(StoreError, match="format 99"):
        ReceivedMissions(tmp_path / "depot.sqlite")


def test_a_power_cut_within_an_arrival_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between the bundle on the disk and its line in the database."""
    robot_agent = RobotAgentInProcess(tmp_path)

    class PowerCut(BaseException):
        pass

    def cut(*_: object) -> None:
        raise PowerCut

    with monkeypatch.context() as patch:
        patch.setattr(ReceivedMissions, "note", cut)
        with robot_agent.mission_store.receiving() as part:
            part.write(good())
            with pytest.raises(PowerCut):
                robot_agent.mission_store.take(part, sha256_of(good()))
    (robot_agent.store / "incoming" / "half").write_bytes(good()[:1000])
    assert any((robot_agent.store / "bundles").iterdir())
    robot_agent.again()
    assert robot_agent.is_empty()


def test_a_power_cut_while_a_mission_begins_lets_it_begin_once(
    robot_agent: RobotAgentInProcess, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(MissionStore, "note_begun", lambda *_: (_ for _ in ()).throw(StoreError("power")))
        with pytest.raises(StoreError, match="power"):
            tell(robot_agent, good(), "start")
    robot_agent.again()
    assert standing(robot_agent, good()).state == "interrupted"
    assert robot_agent.supervisor.continue_interrupted() == sha256_of(good())
    robot_agent.supervisor.join(LONG_S)
    assert standing(robot_agent, good()).status == "completed"


def test_the_seed_and_the_date_are_kept(robot_agent: RobotAgentInProcess) -> None:
    held = robot_agent.mission_store.get(sha256_of(good()))
    assert datetime.fromisoformat(held.received_at) == NOW.replace(microsecond=0)
    assert (held.signer, held.request) == ("Ada", "Take 3 CO2 readings at tree 1.")
    assert isinstance(robot_agent.supervisor, MissionSupervisor)
