"""Each run of a standing mission chooses its places by what the robot itself did in earlier runs."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.approval.authorize import EveryWarning, approve
from fieldhand.approval.bundle.packing import pack
from fieldhand.approval.checks import examine
from fieldhand.compatibility import UTC
from fieldhand.delivery.bundle_checks import sha256_of
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.errors import JournalError, NotApprovedError
from fieldhand.execution.journal import store
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import DoneEarlier, Excluding, Period, Take, Trees
from fieldhand.robot.loader import parse_profile, profile_bytes
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.loader import site_of
from fieldhand.task.earlier import with_earlier
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, Visiting
from fieldhand.task.timing import DayTime, Schedule
from fieldhand.testing.small_orchard import task_for
from support.missions.signed import KEY, orchard_files
from support.processes.patience import LONG_S
from support.processes.robot_agents import RobotAgentInProcess

BEGIN = datetime(2027, 3, 1, 7, tzinfo=UTC)
DAILY = Schedule(at=(DayTime(clock="06:00"),))


class _SimulatedTime(datetime):
    """Time of the journal, which is that of the machine."""

    at = BEGIN

    @classmethod
    def now(cls, tz: object = None) -> datetime:  # type: ignore[override]
        return cls.at


@pytest.fixture(autouse=True)
def _clock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    monkeypatch.setattr(store, "datetime", _SimulatedTime)
    _SimulatedTime.at = BEGIN


def standing(select: Selector, trees: int = 6) -> bytes:
    files = orchard_files(trees)
    profile, source = profile_bytes("husky")
    robot, site = parse_profile(profile, source=source), site_of(files, lenient=False)
    plan = ForEach(id="", select=select, body=Act(id="", action="take_thermal_picture"), said=((0, 4),))
    task = replace(task_for(site, plan, "Skip what was done."), timing=DAILY)
    task = with_earlier(task, EarlierMissions(as_of=BEGIN.isoformat()))
    authorized = approve(examine(task, site, robot), by="Ada", at=BEGIN.isoformat(), confirmed=EveryWarning())
    return pack(
        authorized,
        site,
        robot,
        files=files,
        lenient=False,
        profile=profile,
        key=KEY,
        planner="english",
        valid_for=timedelta(days=60),
    )


class Robot:
    """A robot that simulates its missions, whose clock the test sets."""

    def __init__(self, folder: Path) -> None:
        self.agent = RobotAgentInProcess(folder, now=lambda: _SimulatedTime.at, simulated=True)

    def start(self, data: bytes) -> ReceivedMission:
        assert self.agent.upload(data).status_code == 201
        received = self.agent.mission_store.get(sha256_of(data))
        self.agent.supervisor.give_command(received, "start", "a test")
        return received

    def days(self, count: int) -> None:
        for _ in range(count):
            _SimulatedTime.at = _SimulatedTime.at.replace(hour=6) + timedelta(days=1)
            self.agent.supervisor.timetables.look()
            self.agent.supervisor.join(LONG_S)

    def folders(self, received: ReceivedMission) -> list[Path]:
        runs = self.agent.mission_store.runs(received, 100)
        return [self.agent.mission_store.folder_of(run) for run in runs]

    def pictured(self, received: ReceivedMission) -> list[list[str]]:
        """The trees that each run took a picture of."""
        return [
            sorted(event.place for event in missions.events_of(folder) if isinstance(event, Acted))
            for folder in self.folders(received)
        ]


def without(period: Period) -> Excluding:
    return Excluding(places=DoneEarlier(action="take_thermal_picture", period=period), of=Trees())


def test_two_new_trees_each_morning_until_none_is_left(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    received = robot.start(standing(Take(count=2, of=without(Period()))))
    robot.days(5)
    assert robot.pictured(received) == [["1", "2"], ["3", "4"], ["5", "6"], [], []]
    states = [robot.agent.supervisor.status_of(run) for run in robot.agent.mission_store.runs(received, 9)]
    assert [(found.state, found.status) for found in states] == [("ended", "completed")] * 5


def test_every_morning_those_that_were_not_pictured_yesterday(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    received = robot.start(standing(Take(count=4, of=without(Period(calendar="yesterday")))))
    robot.days(4)
    assert robot.pictured(received) == [["1", "2", "3", "4"], ["5", "6"], ["1", "2", "3", "4"], ["5", "6"]]


def test_a_run_is_resumed_with_the_missions_that_it_counted(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    received = robot.start(standing(Take(count=2, of=without(Period()))))
    robot.days(2)
    folder = robot.folders(received)[1]
    stored = missions.open_mission(folder, robot.agent.mission_store.verify)
    assert stored.site.earlier is not None
    assert {one.place for _, one in stored.site.earlier.captures()} == {"1", "2"}
    result = missions.carry_out(stored, emit=lambda _: None)
    assert [sorted(event.places) for event in result.events if isinstance(event, Visiting)] == [["3", "4"]]


def test_counted_missions_that_were_changed_or_damaged_are_not_used(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    received = robot.start(standing(without(Period(calendar="yesterday"))))
    robot.days(1)
    folder = robot.folders(received)[0]
    counted = folder / "earlier.json"
    assert json.loads(counted.read_bytes())["missions"] == []
    counted.write_bytes(counted.read_bytes().replace(b"2027-03-02", b"2027-03-09"))
    with pytest.raises(JournalError, match=r"earlier\.json"):
        missions.open_mission(folder, robot.agent.mission_store.verify)


def test_records_beside_a_mission_that_is_not_a_standing_one_are_refused(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    received = robot.start(standing(without(Period(calendar="yesterday"))))
    robot.days(1)
    contents = missions.read_folder(robot.folders(received)[0])
    once = replace(
        contents,
        files={
            **contents.files,
            "task.xml": contents.files["task.xml"].replace(b"<timing>", b"<!--").replace(b"</timing>", b"-->"),
        },
    )
    with pytest.raises(NotApprovedError):
        once.mission()


def test_a_period_without_work_does_not_stop_a_timetable(tmp_path: Path) -> None:
    """The run is left out with the reason, and the next one begins."""
    robot = Robot(tmp_path)
    received = robot.start(standing(DoneEarlier(action="take_thermal_picture", period=Period(calendar="yesterday"))))
    robot.days(2)
    assert [run.run.missed for run in robot.agent.mission_store.runs(received, 9) if run.run] == ["", ""]
    assert robot.pictured(received) == [[], []]
