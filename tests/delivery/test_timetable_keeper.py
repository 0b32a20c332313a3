"""The agent keeps timetables: each due run begins once, whatever happens to its power and its clock."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any
from zoneinfo import ZoneInfo

import pytest

from fieldhand import missions
from fieldhand.compatibility import UTC
from fieldhand.delivery.bundle_checks import sha256_of
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.delivery.robot_client import RobotClient
from fieldhand.errors import DeliveryError, ExecutionError, JournalError
from fieldhand.execution.journal import store
from fieldhand.task.timing import DayTime, MissedRule, Schedule, StartTime, Timing
from support.missions.signed import orchard_files, pack_mission
from support.processes.patience import LONG_S
from support.processes.robot_agents import RobotAgentInProcess, fly

ROME = ZoneInfo("Europe/Rome")


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


class PowerCut(BaseException):
    """The process ends here."""


@cache
def mission(timing: Timing, approved: datetime, trees: int = 6) -> bytes:
    at = approved.isoformat()
    return pack_mission(orchard_files(trees), timing=timing, at=at, valid_for=timedelta(days=60))


@dataclass
class Farm:
    """A robot with a simulated date and time, whose power can fail.

    Attributes:
        on: Instants at which the agent looked at the clock.
        cut: Number of writes to the store after which the power fails; 0 for never.
    """

    folder: Path
    now: datetime
    on: list[datetime] = field(default_factory=list)
    cut: int = 0

    def __post_init__(self) -> None:
        self.agent = RobotAgentInProcess(self.folder, now=lambda: self.now, zone=ROME)
        self._watch_writes()

    def upload(self, data: bytes, *, start: bool = True) -> ReceivedMission:
        assert self.agent.upload(data).status_code == 201
        received = self.agent.mission_store.get(sha256_of(data))
        if start:
            self.agent.supervisor.give_command(received, "start", "a test")
        return received

    def look(self) -> None:
        self.on.append(self.now)
        self.agent.supervisor.timetables.look()
        self.agent.supervisor.join(LONG_S)

    def restart(self) -> None:
        """Start the agent again, which goes on with an interrupted mission."""
        self.cut = 0
        self.agent.again()
        self._watch_writes()
        self.agent.carry = fly
        self.agent.supervisor.continue_interrupted()
        self.agent.supervisor.join(LONG_S)

    def runs(self, received: ReceivedMission) -> list[ReceivedMission]:
        return list(self.agent.mission_store.runs(received, 10_000))

    def starts(self, run: ReceivedMission) -> int:
        """How often the log of a run says that it started; 0 if it never did."""
        folder = self.agent.mission_store.folder_of(run)
        return sum(event.event == "started" for event in missions.events_of(folder)) if missions.exists(folder) else 0

    def _watch_writes(self) -> None:
        """Let the power fail before or after a write to the store's database."""
        database = self.agent.mission_store._database

        def failing(write: Callable[..., Any]) -> Callable[..., Any]:
            def written(*args: Any) -> Any:
                self._count()
                result = write(*args)
                self._count()
                return result

            return written

        for name in ("note", "note_begun", "miss", "end"):
            setattr(database, name, failing(getattr(database, name)))

    def _count(self) -> None:
        if self.cut:
            self.cut -= 1
            if not self.cut:
                raise PowerCut


def local(text: str) -> datetime:
    return datetime.fromisoformat(text).replace(tzinfo=ROME).astimezone(UTC)


def hours(first: datetime, days: int, every: int) -> Iterator[datetime]:
    """The instants at which the clock of Rome shows the hours of a schedule, the first of each."""
    day = first.astimezone(ROME).date()
    for n in range(days):
        for hour in range(0, 24, every):
            at = day + timedelta(days=n)
            yield datetime(at.year, at.month, at.day, hour, 30, tzinfo=ROME).astimezone(UTC)


@pytest.mark.parametrize(("approved", "missed"), [("2027-03-10T12:00", "skip"), ("2027-10-14T12:00", "late")])
def test_thirty_days_with_power_cuts_and_a_change_of_the_clock(
    tmp_path: Path, approved: str, missed: MissedRule
) -> None:
    """The clock of Rome is changed in the nights of 28 March and 31 October 2027."""
    rng = random.Random(f"{approved} {missed}")
    begin = local(approved)
    farm = Farm(tmp_path, begin)
    schedule = Schedule(at=(DayTime(clock="00:30"),), every_min=240, late_min=45, missed=missed)
    received = farm.upload(mission(schedule, begin))
    end = begin + timedelta(days=30)
    cuts = 0
    while farm.now < end:
        if rng.random() < 0.03:
            # The power fails in the middle of the next look, or the robot is interrupted before its first tick.
            farm.cut, farm.agent.carry = (rng.randrange(1, 7), fly) if rng.random() < 0.6 else (0, lambda _: None)
        try:
            farm.look()
            cut = farm.agent.carry is not fly
        except PowerCut:
            cut = True
        if cut:
            cuts += 1
            farm.now += timedelta(minutes=rng.choice([1, 10, 60, 300, 1200]))
            farm.restart()
        farm.cut = 0
        farm.now += timedelta(minutes=15)
    farm.look()
    assert cuts >= 20
    dues = [due for due in hours(begin, 33, 4) if begin < due <= farm.now]
    runs = farm.runs(received)
    assert [run.run.due for run in runs if run.run] == sorted({due.timestamp() for due in dues})
    begun = [run for run in runs if run.begun_at is not None]
    assert Counter(farm.starts(run) for run in begun) == {1: len(begun)}
    assert all(farm.starts(run) == 0 for run in runs if run.begun_at is None)
    # A run is missed only if the robot was off, or did not look at its clock, as long as the run could have begun.
    following = dict(pairwise(dues))
    for run in runs:
        assert run.run is not None
        due = datetime.fromtimestamp(run.run.due, UTC)
        latest = due + timedelta(minutes=45)
        if missed == "late":
            latest = max(latest, following.get(due, latest))
        chances = [at for at in farm.on if due <= at <= latest]
        if run.begun_at is None and run.run.missed:
            # A look that the power cut ended before it came to this run is no chance.
            assert len(chances) <= 1, (due, run.run.missed)
    assert len(begun) > 0.7 * len(dues)


def test_a_run_waits_for_the_mission_under_way_and_is_missed_when_it_is_too_late(tmp_path: Path) -> None:
    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    first = farm.upload(mission(Schedule(at=(DayTime(clock="14:00"),), late_min=30), begin))
    farm.agent.upload(mission(StartTime(), begin, 7))  # not started
    farm.agent.carry = lambda _: None  # it never comes to an end
    farm.now = local("2027-05-03T14:05")
    farm.look()
    (run,) = farm.runs(first)
    assert farm.agent.supervisor.status_of(run).state == "interrupted"
    second = farm.upload(mission(Schedule(at=(DayTime(clock="14:10"),), late_min=30), begin, 8))
    farm.now = local("2027-05-03T14:11")
    farm.look()
    (waiting,) = farm.runs(second)
    assert farm.agent.supervisor.status_of(waiting).state == "waiting"
    farm.now = local("2027-05-03T14:50")
    farm.look()
    found = farm.agent.supervisor.status_of(farm.runs(second)[0])
    assert found.state == "missed"
    assert "another mission was interrupted" in found.reason


def test_a_clock_that_is_set_back_makes_no_run_due_again(tmp_path: Path) -> None:
    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    received = farm.upload(mission(Schedule(at=(DayTime(clock="06:00"),)), begin))
    for at in ("2027-05-04T06:10", "2027-05-04T05:00", "2027-05-04T06:20", "2027-05-03T13:00", "2027-05-05T06:00"):
        farm.now = local(at)
        farm.look()
    assert [farm.starts(run) for run in farm.runs(received)] == [1, 1]


def test_a_single_mission_begins_at_its_time_and_its_timetable_ends(tmp_path: Path) -> None:
    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    start = StartTime(day="tomorrow", not_before=DayTime(clock="06:00"), not_after=DayTime(clock="06:15"))
    received = farm.upload(mission(start, begin))
    assert farm.agent.supervisor.status_of(received).state == "scheduled"
    for at in ("2027-05-03T18:00", "2027-05-04T05:59", "2027-05-04T06:00", "2027-05-04T06:10", "2027-05-05T06:00"):
        farm.now = local(at)
        farm.look()
    (run,) = farm.runs(received)
    assert (run.begun_at, farm.starts(run)) == (local("2027-05-04T06:00").isoformat(timespec="seconds"), 1)
    assert run.sha256 != received.sha256
    again = farm.agent.mission_store.get(received.sha256)
    assert farm.agent.supervisor.status_of(again).state == "ended"
    with pytest.raises(ExecutionError, match="no longer kept"):
        farm.agent.supervisor.give_command(again, "start", "a test")


def test_a_mission_whose_time_has_passed_is_not_started(tmp_path: Path) -> None:
    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    past = StartTime(day="today", not_before=DayTime(clock="06:00"), not_after=DayTime(clock="06:15"))
    with pytest.raises(ExecutionError, match="no run of it lies ahead"):
        farm.upload(mission(past, begin))


def test_a_revoked_key_ends_the_runs(tmp_path: Path) -> None:
    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    received = farm.upload(mission(Schedule(at=(DayTime(clock="06:00"),)), begin))
    farm.now = local("2027-05-04T06:00")
    farm.look()
    farm.agent.trusted.revoke(next(iter(farm.agent.trusted.known())), at=farm.now)
    farm.now = local("2027-05-05T06:00")
    farm.look()
    first, second = farm.runs(received)
    assert (farm.starts(first), farm.starts(second)) == (1, 0)
    assert "revoked" in farm.agent.supervisor.status_of(second).reason


# --- over HTTP ----------------------------------------------------------------------------------------------------


def test_runs_are_listed_left_out_and_cancelled(tmp_path: Path) -> None:
    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    data = mission(Schedule(at=(DayTime(clock="06:00"),)), begin)
    farm.upload(data, start=False)
    client: RobotClient = farm.agent.link()
    sha256 = sha256_of(data)
    assert client.order(sha256, "start").mission.state == "scheduled"
    runs = client.runs(sha256)
    assert [run.due for run in runs.next][:2] == ["2027-05-04T04:00:00+00:00", "2027-05-05T04:00:00+00:00"]
    left_out = client.order(sha256, "cancel", "rain", due=datetime.fromisoformat(runs.next[0].due)).mission
    assert (left_out.state, left_out.reason, left_out.of) == ("missed", "rain", sha256)
    assert client.runs(sha256).next[0].due == "2027-05-05T04:00:00+00:00"
    with pytest.raises(DeliveryError, match="no run is due"):
        client.order(sha256, "cancel", due=datetime.fromisoformat(runs.next[0].due) + timedelta(hours=1))
    for day in ("04", "05"):
        farm.now = local(f"2027-05-{day}T06:00")
        farm.look()
    found = client.runs(sha256)
    assert [run.state for run in found.last] == ["missed", "ended"]
    assert len({run.bundle for run in found.last}) == 2
    assert client.events(found.last[1].bundle, 0, 0.0).events
    assert client.order(sha256, "cancel", "the season is over").mission.state == "ended"
    assert client.runs(sha256).next == []
    farm.now = local("2027-05-06T06:00")
    farm.look()
    assert len(client.runs(sha256).last) == 2


def test_only_missions_with_a_timetable_are_cancelled(tmp_path: Path) -> None:
    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    plain = pack_mission(at=begin.isoformat())
    farm.upload(plain, start=False)
    with pytest.raises(DeliveryError, match="no timetable"):
        farm.agent.link().order(sha256_of(plain), "cancel")


def test_a_store_of_the_first_format_is_read(tmp_path: Path) -> None:
    """The store of an earlier version keeps its missions."""
    import sqlite3
    from contextlib import closing

    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    data = pack_mission(at=begin.isoformat())
    farm.upload(data)
    farm.agent.supervisor.join(LONG_S)
    farm.agent.mission_store.close()
    with closing(sqlite3.connect(farm.agent.store / "depot.sqlite")) as old:
        for column in ("bundle", "due", "latest", "done_by", "missed", "kept_from", "ended"):
            old.execute(f"ALTER TABLE held DROP COLUMN {column}")
        old.execute("UPDATE about SET value = '1' WHERE key = 'format'")
        old.commit()
    farm.agent.begin()
    received = farm.agent.mission_store.get(sha256_of(data))
    assert farm.agent.supervisor.status_of(received).state == "ended"
    assert received.run is None


def test_a_disk_that_fails_leaves_the_run_for_the_next_look(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begin = local("2027-05-03T12:00")
    farm = Farm(tmp_path, begin)
    received = farm.upload(mission(Schedule(at=(DayTime(clock="06:00"),)), begin))
    farm.now = local("2027-05-04T06:00")

    def full(*_: object, **__: object) -> None:
        raise JournalError("the disk is full", where="missions", advice="free some space")

    with monkeypatch.context() as patched:
        patched.setattr(missions, "begin", full)
        farm.look()
    assert [farm.starts(run) for run in farm.runs(received)] == [0]
    farm.now += timedelta(minutes=10)
    farm.look()
    assert [farm.starts(run) for run in farm.runs(received)] == [1]
