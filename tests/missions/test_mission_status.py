"""The folder of a mission holds every byte that it needs, and no other byte will do."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import pytest

from fieldhand import mission, missions
from fieldhand.errors import ExecutionError, FieldhandError, JournalError, NotApprovedError
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.journal import store
from fieldhand.robot.loader import parse_profile
from fieldhand.site.loader import site_of
from fieldhand.task.results import Event
from support.missions.kept import inputs


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


def test_a_mission_from_its_folder_alone(tmp_path: Path) -> None:
    folder = missions.begin(tmp_path, "m1", inputs()).folder
    assert missions.status(folder).now.state == "interrupted"
    given, events = missions.open_mission(folder), list[Event]()
    result = missions.carry_out(given, speed=None, emit=events.append)
    assert tuple(events) == result.events == missions.events_of(folder)
    plain: list[Event] = []
    assert given.world != World()
    mission.simulate(
        mission.ApprovedMission(authorized=given.authorized, site=given.site, robot=given.robot),
        world=given.world,
        seed=3,
        speed=None,
        emit=plain.append,
    )
    assert plain == events
    again = missions.carry_out(given, speed=None, emit=lambda event: pytest.fail(f"told twice: {event}"))
    assert again == result
    assert missions.status(folder).now.state == "ended"
    assert missions.find(tmp_path, None) == missions.find(tmp_path, "m1") == missions.find(tmp_path, str(folder))
    with pytest.raises(ExecutionError, match="has ended"):
        missions.send_command(folder, "pause", "")
    with pytest.raises(JournalError, match="already a mission with this name"):
        missions.begin(tmp_path, "m1", inputs())


@pytest.mark.parametrize("file", ["task.xml", "robot.yaml", "world.yaml", "site/demo.geojson", "mission.json"])
def test_another_byte_is_refused(tmp_path: Path, file: str) -> None:
    folder = missions.begin(tmp_path, "m1", inputs()).folder
    (folder / file).write_bytes((folder / file).read_bytes() + b"\n")
    with pytest.raises(JournalError, match=r"not the file that the mission started with|another mission"):
        missions.carry_out(missions.open_mission(folder), speed=None, emit=print)


def test_the_journal_of_another_mission_is_refused(tmp_path: Path) -> None:
    one = missions.begin(tmp_path, "m1", inputs()).folder
    other = missions.begin(tmp_path, "m2", replace(inputs(), seed=4)).folder
    (one / "journal.sqlite").write_bytes((other / "journal.sqlite").read_bytes())
    with pytest.raises(JournalError, match="another mission"):
        missions.carry_out(missions.open_mission(one), speed=None, emit=print)


def test_what_was_not_approved_is_refused(tmp_path: Path) -> None:
    """A folder that was made by hand, around another Task than the one that was approved."""
    folder = missions.begin(tmp_path, "m1", inputs()).folder
    task = (folder / "task.xml").read_bytes().replace(b"Measure CO2 at tree 5.", b"Measure CO2 at tree 6.")
    about = json.loads((folder / "mission.json").read_bytes())
    about["files"]["task.xml"] = hashlib.sha256(task).hexdigest()
    (folder / "mission.json").write_text(json.dumps(about))
    (folder / "task.xml").write_bytes(task)
    with pytest.raises(FieldhandError, match="not the one that was approved"):
        missions.open_mission(folder)


def test_nothing_begins_with_other_bytes_than_were_approved() -> None:
    given = inputs()
    other = replace(given.authorized.task, id="other")
    files = replace(given.files, parts={"demo.geojson": given.files.parts["demo.geojson"] + b" "})
    for changed in (
        {"profile": given.profile + b"\n"},
        {"files": files},
        {"site": site_of(files)},
        {"robot": parse_profile(given.profile + b"\n")},
        {"authorized": replace(given.authorized, task=other)},
    ):
        with pytest.raises(NotApprovedError, match="not the one that was approved"):
            replace(given, **changed)  # type: ignore[arg-type]


def spoil(folder: Path) -> None:
    """Put another mission's bytes in the place of every file that says what the mission is."""
    for file in ("task.xml", "robot.yaml", "world.yaml", "site/demo.geojson", "mission.json"):
        (folder / file).write_bytes(b"<not what was approved>")


def test_what_is_carried_out_is_what_was_given_whatever_lies_in_the_folder_by_then(tmp_path: Path) -> None:
    plain = missions.carry_out(missions.begin(tmp_path, "m1", inputs()), speed=None, emit=lambda _: None)
    given = missions.begin(tmp_path, "m2", inputs())
    spoil(given.folder)
    assert missions.carry_out(given, speed=None, emit=lambda _: None).events == plain.events
    again = missions.begin(tmp_path, "m3", inputs()).folder
    contents = missions.read_folder(again)
    spoil(again)
    assert missions.carry_out(contents.mission(), speed=None, emit=lambda _: None).events == plain.events


@pytest.mark.parametrize("about", [b"", b"garbage", b"[]", b'{"format": 99}', b'{"format": 1}', b"[" * 100_000])
def test_a_folder_that_is_no_mission_is_refused(tmp_path: Path, about: bytes) -> None:
    folder = missions.begin(tmp_path, "m1", inputs()).folder
    (folder / "mission.json").write_bytes(about)
    with pytest.raises(JournalError, match="not a mission"):
        missions.open_mission(folder)


def test_a_file_that_leads_elsewhere_is_refused(tmp_path: Path) -> None:
    folder = missions.begin(tmp_path, "m1", inputs()).folder
    about = json.loads((folder / "mission.json").read_bytes())
    about["files"]["../secret"] = about["files"]["task.xml"]
    (folder / "mission.json").write_text(json.dumps(about))
    (tmp_path / "secret").write_bytes(inputs().document)
    with pytest.raises(JournalError, match="points outside"):
        missions.open_mission(folder)


def test_a_folder_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(JournalError, match="cannot be written"):
        missions.begin(tmp_path / "file", "m1", inputs())


def test_an_order_to_a_mission_that_is_cut_off_holds_when_it_goes_on(tmp_path: Path) -> None:
    folder = missions.begin(tmp_path, "m1", inputs()).folder
    assert not missions.send_command(folder, "return", "rain is coming")
    assert missions.status(folder).order == "return"
    result = missions.carry_out(missions.open_mission(folder), speed=None, emit=list[Event]().append)
    assert (result.status, result.reason) == ("aborted", "rain is coming")
    assert missions.status(folder).order == ""
