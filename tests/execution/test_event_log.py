"""Event logs: what is written is read back, line by line, and what cannot be written or read is said."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fieldhand.errors import InputError, OutputError, TaskError
from fieldhand.execution.event_log import EventLog, read_events
from fieldhand.places.selectors import Half, TreeIs
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Ended
from support.missions.rig import Rig

PLAN = ForEach(id="", select=Half(side="north"), body=Act(id="", action="take_thermal_picture"), optional=True)


def test_a_log_holds_the_mission(tmp_path: Path) -> None:
    path = tmp_path / "new" / "folder" / "events.jsonl"
    with EventLog(path) as log:
        result = Rig().fly(PLAN, emit=log)
    assert read_events(path) == result.events


def test_each_event_is_on_its_line_as_soon_as_it_happens(tmp_path: Path) -> None:
    path = tmp_path / "events.jsonl"
    lines: list[int] = []
    with EventLog(path) as log:

        def take(event: object) -> None:
            log(event)  # type: ignore[arg-type]
            lines.append(len(path.read_text().splitlines()))

        result = Rig().fly(PLAN, emit=take)
    assert lines == list(range(1, len(result.events) + 1))


def test_the_lines_hold_what_the_referee_reads(tmp_path: Path) -> None:
    """Actions at the tree, arrivals with the metres so far, one closing mission event."""
    path = tmp_path / "events.jsonl"
    rig = Rig()
    with EventLog(path) as log:
        rig.fly(Act(id="", action="read_co2", at=TreeIs(tree="r1c1"), count=2), emit=log)
    records = [json.loads(line) for line in path.read_text().splitlines()]
    tree = rig.site.by_id["r1c1"].place
    actions = [r for r in records if r["event"] == "action"]
    assert [(a["action"], a["status"], a["lat"], a["lon"], a["count"]) for a in actions] == [
        ("read_co2", "success", tree.lat, tree.lon, 1)
    ] * 2
    assert [r["travelled_m"] for r in records if r["event"] == "arrive"] == sorted(
        r["travelled_m"] for r in records if r["event"] == "arrive"
    )
    assert [r["status"] for r in records if r["event"] == "mission"] == ["completed"]


def test_a_place_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match=r"the event log cannot be written: its folder is a file"):
        EventLog(tmp_path / "file" / "events.jsonl")
    with pytest.raises(OutputError, match="Is a directory"):
        EventLog(tmp_path)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_full_disk_is_said_when_it_fills() -> None:
    log = EventLog(Path("/dev/full"))
    with pytest.raises(OutputError, match="No space left"):
        log(Ended(t=0, status="completed", lat=0, lon=0, travelled_m=0, charge_percent=1))
    with pytest.raises(OutputError, match=r"/dev/full: the event log cannot be written: No space left"):
        log.close()


def test_logs_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        read_events(tmp_path / "none.jsonl")
    cut = tmp_path / "cut.jsonl"
    cut.write_text('{"event": "from the future", "t": 1}\n\n{"event": "mission", "t": 3')
    with pytest.raises(TaskError, match=r"cut.jsonl, line 3: not an event"):
        read_events(cut)
    cut.write_text('{"event": "from the future", "t": 1}\n')
    assert read_events(cut) == ()
