"""Earlier missions are read from their store as they were done, and bad logs are left out with a word."""

from __future__ import annotations

import json
import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import datetime, timedelta
from importlib import import_module
from pathlib import Path

import pytest

from fieldhand import mission, missions
from fieldhand.approval.authorize import EveryWarning
from fieldhand.compatibility import UTC
from fieldhand.errors import InputError, TaskError
from fieldhand.exchange.btcpp import read_tree, write_tree
from fieldhand.execution.event_log import EventLog
from fieldhand.missions import earlier_missions
from fieldhand.places.selectors import DoneEarlier, Excluding, Rows, TopEarlier, TreeIs, Trees, UnionOf
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.loader import load_robot
from fieldhand.site.earlier_missions import EarlierCapture, EarlierMission, EarlierMissions
from fieldhand.site.model import Site
from fieldhand.task import earlier as task_earlier
from fieldhand.task.codec import decode, encode
from fieldhand.task.earlier import together, with_earlier
from fieldhand.task.frames import Task
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, Ended, Event, Started
from fieldhand.testing.small_orchard import husky, orchard, task_for
from support.missions.kept import inputs

NOW = datetime(2026, 6, 2, 12, tzinfo=UTC)
SITE, ROBOT = orchard(2, 5), husky()


def visiting(*trees: str, action: str = "read_co2") -> Task:
    of = UnionOf(parts=tuple(TreeIs(tree=tree) for tree in trees)) if len(trees) > 1 else TreeIs(tree=trees[0])
    return task_for(SITE, ForEach(id="", select=of, body=Act(id="", action=action)))


def flown(task: Task, seed: int = 1) -> mission.Run:
    review = mission.review(task, SITE, ROBOT)
    return mission.simulate(mission.authorize(review, by="a test", confirmed=EveryWarning()), seed=seed)


def done(events: tuple[Event, ...]) -> set[str]:
    return {event.place for event in events if isinstance(event, Acted) and event.status == "success"}


def places_of(known: EarlierMissions) -> set[str]:
    return {one.place for _, one in known.captures() if one.outcome == "done"}


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    """A store with one simulated mission: CO2 at tree 5 of the demo."""
    given = missions.begin(tmp_path / "missions", "20260601-080000-aaaaaa", inputs())
    missions.carry_out(given, emit=lambda _: None)
    return tmp_path / "missions"


def test_what_missions_did_is_what_is_counted() -> None:
    runs = [flown(visiting("2", "4")), flown(visiting("7", action="take_thermal_picture"))]
    known = earlier_missions(SITE, logs=[run.events for run in runs], now=NOW, simulated=True)
    assert places_of(known) == {"2", "4", "7"}
    assert len(earlier_missions(SITE, logs=[runs[0].events] * 3, now=NOW, simulated=True).missions) == 1
    assert earlier_missions(SITE, logs=[run.events for run in runs], now=NOW).simulations == 2


def test_preview_simulation_replay_and_tree_visit_the_same_places() -> None:
    first = flown(visiting("2", "4", "9"))
    known = earlier_missions(SITE, logs=[first.events], now=NOW, simulated=True)
    rest = Excluding(places=DoneEarlier(action="read_co2"), of=Trees())
    task = with_earlier(task_for(SITE, ForEach(id="", select=rest, body=Act(id="", action="read_co2"))), known)
    again = decode(encode(task))
    assert again == task
    run = flown(again)
    assert done(run.events) == {tree.place.id for tree in SITE.trees} - {"2", "4", "9"}
    assert run.success
    capabilities = capabilities_of(ROBOT)
    assert read_tree(write_tree(task, capabilities), capabilities) == task


def test_the_snapshot_is_part_of_what_is_approved() -> None:
    known = earlier_missions(SITE, logs=[flown(visiting("2")).events], now=NOW, simulated=True)
    plan = ForEach(id="", select=TopEarlier(quantity="co2", count=1), body=Act(id="", action="read_co2"))
    task = task_for(SITE, plan)
    other = replace(known, missions=())
    ids = {task.id, with_earlier(task, known).id, with_earlier(task, other).id}
    assert len(ids) == 3
    assert with_earlier(with_earlier(task, known), other) == with_earlier(task, other)
    assert with_earlier(with_earlier(task, known), None) == task
    assert encode(with_earlier(task, known)) != encode(with_earlier(task, other))


def test_a_task_without_records_is_refused_with_what_to_do() -> None:
    plan = ForEach(id="", select=TopEarlier(quantity="co2"), body=Act(id="", action="read_co2"))
    (error,) = mission.review(task_for(SITE, plan), SITE, ROBOT).errors
    assert "--missions" in error.line()


def test_nothing_left_out_has_to_be_confirmed() -> None:
    rest = Excluding(places=DoneEarlier(action="read_co2"), of=Trees())
    task = task_for(SITE, ForEach(id="", select=rest, body=Act(id="", action="read_co2")))
    review = mission.review(with_earlier(task, EarlierMissions(as_of=NOW.isoformat())), SITE, ROBOT)
    assert not review.errors
    assert any("all 10 trees count as not done" in warning for warning in review.warnings)


def test_missions_of_another_site_do_not_count() -> None:
    """Its trees have the same names and stand elsewhere."""
    elsewhere = [
        replace(event, lat=event.lat + 1, site="another")
        if isinstance(event, Started)
        else replace(event, lat=event.lat + 1)
        if isinstance(event, Acted)
        else event
        for event in flown(visiting("2", "4")).events
    ]
    known = earlier_missions(SITE, logs=[elsewhere], now=NOW, simulated=True)
    assert (known.missions, known.elsewhere, known.moved) == ((), 1, 0)
    moved = [replace(event, site="orchard") if isinstance(event, Started) else event for event in elsewhere]
    assert earlier_missions(SITE, logs=[moved], now=NOW, simulated=True).moved == 2


def test_an_interrupted_mission_counts_with_what_it_did_and_has_to_be_confirmed() -> None:
    events = flown(visiting("2", "4", "9")).events
    half = events[: next(k for k, event in enumerate(events) if isinstance(event, Acted)) + 1]
    known = earlier_missions(SITE, logs=[half], now=NOW, simulated=True)
    assert len(places_of(known)) == 1
    assert not [one for _, one in known.captures() if one.outcome == "left_out"]
    rest = Excluding(places=DoneEarlier(action="read_co2"), of=Trees())
    task = with_earlier(task_for(SITE, ForEach(id="", select=rest, body=Act(id="", action="read_co2"))), known)
    assert any("has not ended" in warning for warning in mission.review(task, SITE, ROBOT).warnings)
    ended = [
        *half,
        Ended(t=half[-1].t, status="aborted", reason="", travelled_m=1.0, charge_percent=90.0, lat=37.0, lon=-120.0),
    ]
    known = earlier_missions(SITE, logs=[ended], now=NOW, simulated=True)
    assert len([one for _, one in known.captures() if one.outcome == "left_out"]) == 2


def test_the_store_is_read_with_the_times_of_its_journals(stored: Path) -> None:
    known = earlier_missions(Site.demo(), stored, simulated=True)
    assert places_of(known) == {"5"}
    assert abs(known.time - known.missions[0].captures[0].time) < timedelta(minutes=10)
    assert known.missions[0].id == "20260601-080000-aaaaaa"


@pytest.mark.parametrize("broken", ["journal", "event", "about", "empty", "other", "text"])
def test_a_broken_mission_is_left_out_with_a_word(stored: Path, broken: str) -> None:
    folder = stored / "20260601-080000-aaaaaa"
    journal, about = folder / "journal.sqlite", folder / "mission.json"
    match broken:
        case "journal":
            journal.write_bytes(b"SQLite format 3\0" + b"\xff" * 5000)
        case "event":
            with closing(sqlite3.connect(journal)) as db, db:
                db.execute('UPDATE events SET line = replace(line, \'"place": "5"\', \'"place": "6"\')')
        case "about":
            about.write_bytes(about.read_bytes().replace(b'"seed": 3', b'"seed": 4'))
        case "empty":
            journal.unlink()
        case "other":
            about.write_text("[" * 100_000)
        case "text":
            about.write_bytes(b"\xff\xfe")
    said: list[str] = []
    known = earlier_missions(Site.demo(), stored, simulated=True, notice=said.append)
    assert (known.missions, known.damaged) == ((), 1)
    assert "20260601-080000-aaaaaa" in said[0]
    assert len(said) == 1


@pytest.mark.parametrize(
    "line",
    [
        "",
        "\x00" * 1000,
        "[" * 100_000,
        '{"event": "started"}',
        '{"event": "action", "t": "x"}',
        '{"event": "action", "readings": {"co2": 1e999}}',
    ],
)
def test_a_broken_log_among_the_missions_is_left_out_or_empty(tmp_path: Path, line: str) -> None:
    (tmp_path / "a.jsonl").write_text(line)
    (tmp_path / "b.mcap").write_bytes(line.encode())
    shutil.copytree(tmp_path, tmp_path / "c")
    assert earlier_missions(SITE, tmp_path, now=NOW, simulated=True).missions == ()


def test_a_log_that_is_too_large_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = EventLog(tmp_path / "a.jsonl")
    for event in flown(visiting("2")).events:
        log(event)
    log.close()
    assert places_of(earlier_missions(SITE, tmp_path, now=NOW, simulated=True)) == {"2"}
    monkeypatch.setattr(import_module("fieldhand.missions.earlier_missions"), "MOST_LOG_BYTES", 100)
    said: list[str] = []
    assert earlier_missions(SITE, tmp_path, now=NOW, simulated=True, notice=said.append).damaged == 1
    assert "larger than 100 bytes" in said[0]


def test_hostile_names_in_a_log_are_made_visible_and_short() -> None:
    hostile = "\x1b[31m\x00" + "x" * 100_000
    events = [
        replace(event, task=hostile, site=hostile, robot=hostile)
        if isinstance(event, Started)
        else replace(event, action=hostile, readings={hostile: 1.0}, units={hostile: hostile})
        if isinstance(event, Acted)
        else event
        for event in flown(visiting("2")).events
    ]
    known = earlier_missions(SITE, logs=[events], now=NOW, simulated=True)
    rest = Excluding(places=DoneEarlier(), of=Trees())
    task = with_earlier(task_for(SITE, ForEach(id="", select=rest, body=Act(id="", action="read_co2"))), known)
    document = encode(task)
    assert decode(document) == task
    assert len(document) < 10_000
    assert b"\x1b" not in document
    assert done(flown(task).events) == {tree.place.id for tree in SITE.trees} - {"2"}


def test_more_captures_than_a_task_can_contain_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(task_earlier, "MOST_CAPTURES", 2)
    known = earlier_missions(SITE, logs=[flown(visiting("2", "4", "9")).events], now=NOW, simulated=True)
    plan = ForEach(id="", select=DoneEarlier(), body=Act(id="", action="read_co2"))
    with pytest.raises(TaskError, match="shorter period"):
        with_earlier(task_for(SITE, plan), known)


def test_a_missing_folder_is_no_mission_and_a_time_needs_a_zone(tmp_path: Path) -> None:
    assert earlier_missions(SITE, tmp_path / "none", now=NOW).missions == ()
    with pytest.raises(InputError, match="time zone"):
        earlier_missions(SITE, tmp_path, now=datetime(2026, 1, 1))


def test_signed_and_own_missions_are_joined_without_doubles() -> None:
    def one(name: str, hour: int) -> EarlierMission:
        at = f"2026-06-01T{hour:02}:00:00+00:00"
        return EarlierMission(id=name, begun=at, captures=(EarlierCapture(place="1", at=at, action="x"),))

    signed = EarlierMissions(as_of=NOW.isoformat(), missions=(one("a", 5), one("b", 7)))
    own = EarlierMissions(as_of=(NOW + timedelta(days=1)).isoformat(), missions=(one("b in the robot", 7), one("c", 6)))
    joined = together(signed, own)
    assert [mission.id for mission in joined.missions] == ["a", "c", "b in the robot"]
    assert joined.as_of == own.as_of


def test_rows_without_the_ones_done(tmp_path: Path) -> None:
    """The demo's first row, after a mission of the store."""
    site, robot = Site.demo(), load_robot("husky")
    given = missions.begin(tmp_path, "one", inputs())
    missions.carry_out(given, emit=lambda _: None)
    known = earlier_missions(site, tmp_path, simulated=True)
    rest = Excluding(places=DoneEarlier(action="read_co2"), of=Rows(first="1", last="1"))
    task = with_earlier(task_for(site, ForEach(id="", select=rest, body=Act(id="", action="read_co2"))), known)
    review = mission.review(task, site, robot)
    assert not review.errors
    assert review.read_back is not None
    assert json.dumps([str(text) for text in review.read_back.earlier]).count("1 of 169") == 1
