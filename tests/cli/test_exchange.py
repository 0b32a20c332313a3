"""``export``, ``import`` and ``replay``: bad input gets one line and status 2, facts come as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import pytest
import typer
from mcap.reader import make_reader

from fieldhand.cli.export import export
from fieldhand.cli.export_nav2 import export_site
from fieldhand.cli.import_tree import import_tree
from fieldhand.cli.replay import replay
from fieldhand.cli.report import report
from fieldhand.compatibility import UTC
from fieldhand.errors import InputError
from fieldhand.task.codec import encode
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Started
from support.missions.exported import STRAIGHT, flight, task_of
from support.processes.command import fieldhand

Command = Callable[..., None]


def call(command: Command, **given: object) -> None:
    """Run a command in this process; options that are not given have their defaults."""
    import inspect

    known = {name: p.default for name, p in inspect.signature(command).parameters.items() if p.default is not p.empty}
    assert not any(isinstance(default, typer.models.ParameterInfo) for default in known.values())
    command(**(known | given))


@pytest.fixture
def files(tmp_path: Path) -> Path:
    (tmp_path / "task.xml").write_bytes(encode(task_of(STRAIGHT)))
    (tmp_path / "events.jsonl").write_text("\n".join(flight().lines) + "\n")
    (tmp_path / "empty.jsonl").write_text("")
    (tmp_path / "binary.jsonl").write_bytes(b"\x00\xff")
    (tmp_path / "text.mcap").write_bytes(b"\x89MCAP0\r\n" + bytes(9))
    return tmp_path


@pytest.mark.parametrize(
    ("command", "given", "said"),
    [
        (export, {"source": "task.xml", "to": "pdf"}, "no format 'pdf'; choose one of btcpp"),
        (export, {"source": "task.xml", "to": "mcap"}, "a Task cannot be written as mcap"),
        (export, {"source": "events.jsonl", "to": "btcpp"}, "an event log cannot be written as btcpp"),
        (export, {"source": "task.xml", "to": "kml"}, "needs its site"),
        (export, {"source": "none.xml", "to": "btcpp"}, "none.xml: there is no such file"),
        (export, {"source": "task.xml", "to": "btcpp", "robot": "amiga"}, "not valid for this robot"),
        (export, {"source": "empty.jsonl", "to": "csv"}, "contains no events"),
        (export, {"source": "binary.jsonl", "to": "csv"}, "cannot be read"),
        (export, {"source": "text.mcap", "to": "csv"}, "no event|damaged"),
        (
            replay,
            {"source": "events.jsonl", "site": "demo", "output": Path("m.avi")},
            ".avi is not a supported animation format",
        ),
        (import_tree, {"tree": "none.xml"}, "cannot be read"),
        (import_tree, {"tree": "task.xml"}, "is not a tree of BehaviorTree.CPP"),
    ],
)
def test_bad_input_gets_one_line(files: Path, command: Command, given: dict[str, object], said: str) -> None:
    paths: dict[str, object] = {"source": str(files / str(given["source"]))} if "source" in given else {}
    paths |= {"tree": files / str(given["tree"])} if "tree" in given else {}
    with pytest.raises(InputError, match=said) as caught:
        call(command, **({"output": files / "out"} | given | paths))
    assert caught.value.exit_status == 2
    assert "\n" not in str(caught.value)
    assert not (files / "out").exists()


def test_a_task_goes_out_and_comes_back(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call(export, source=str(files / "task.xml"), to="btcpp", output=files / "tree.xml", json=True)
    call(import_tree, tree=files / "tree.xml", output=files / "again.xml", site="demo")
    assert (files / "again.xml").read_bytes() == (files / "task.xml").read_bytes()
    assert json.loads(capsys.readouterr().out.split("\n}")[0] + "\n}")["task"] == task_of(STRAIGHT).id


def test_a_log_goes_out_as_mcap_and_comes_back(files: Path) -> None:
    call(export, source=str(files / "events.jsonl"), to="mcap", output=files / "log.mcap", site="demo")
    call(export, source=str(files / "log.mcap"), to="events", output=files / "back.jsonl")
    assert (files / "back.jsonl").read_bytes() == (files / "events.jsonl").read_bytes()


def test_facts_come_as_json(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call(export, source=str(files / "task.xml"), to="qgc", output=files / "m.plan", site="demo", json=True)
    facts = json.loads(capsys.readouterr().out)
    assert (facts["stops"], facts["left_out"], facts["driven"]) == (5, 0, False)
    call(replay, source=str(files / "events.jsonl"), site="demo", output=files / "m.html", json=True)
    facts = json.loads(capsys.readouterr().out)
    assert (facts["events"], facts["captures"]) == (len(flight().events), 8)


def test_a_tree_that_reads_after_it_tests_is_refused(files: Path) -> None:
    tested = '<CompareReading reading="{r}" quantity="co2" test="lt" value="1" unit="ppm"/>'
    inside = f"<IfThenElse>{tested}<read_co2/><AlwaysSuccess/></IfThenElse>"
    text = f'<root BTCPP_format="4"><BehaviorTree ID="A">{inside}</BehaviorTree></root>'
    (files / "tree.xml").write_text(text)
    with pytest.raises(InputError, match=r"tree\.xml: .*n1"):
        call(import_tree, tree=files / "tree.xml", output=files / "out.xml")
    assert not (files / "out.xml").exists()


def test_a_log_that_was_cut_off_is_written_and_drawn_as_far_as_it_goes(files: Path) -> None:
    whole = (files / "events.jsonl").read_text()
    (files / "cut.jsonl").write_text(whole[: len(whole) // 2])
    call(export, source=str(files / "cut.jsonl"), to="events", output=files / "again.jsonl")
    kept = (files / "again.jsonl").read_text()
    assert kept
    assert whole.startswith(kept)
    call(replay, source=str(files / "cut.jsonl"), site="demo", output=files / "cut.html")
    assert "cut off" in (files / "cut.html").read_text()


def test_a_report_reads_mcap_as_it_reads_json_lines(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call(export, source=str(files / "events.jsonl"), to="mcap", output=files / "log.mcap", site="demo")
    capsys.readouterr()
    said = []
    for log in ("events.jsonl", "log.mcap"):
        with pytest.raises(SystemExit):
            call(
                report, source=str(files / log), task=files / "task.xml", site="demo", output=files / log[:3], json=True
            )
        said.append(json.loads(capsys.readouterr().out)["goals"])
    assert said[0] == said[1]


def test_an_mcap_file_that_is_made_of_a_log_begins_when_the_mission_did(files: Path) -> None:
    began = datetime(2026, 5, 4, 6, 30, tzinfo=UTC)
    events = flight().events
    dated = [replace(e, at=began.isoformat()) if isinstance(e, Started) else e for e in events]
    (files / "dated.jsonl").write_text("".join(to_json(e) + "\n" for e in dated))
    call(export, source=str(files / "dated.jsonl"), to="mcap", output=files / "log.mcap")
    with (files / "log.mcap").open("rb") as file:
        first = min(message.log_time for _, _, message in make_reader(file).iter_messages())
    assert first == pytest.approx((began.timestamp() + events[0].t) * 1e9)


AT_DEMO = "37.0708,-120.2579"


def test_a_site_goes_to_a_folder_for_nav2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "task.xml").write_bytes(encode(task_of(STRAIGHT)))
    given = {"site": "demo", "datum": AT_DEMO, "resolution": 0.5, "output": tmp_path / "out"}
    call(export_site, **(given | {"json": True}))
    facts = json.loads(capsys.readouterr().out)
    assert sorted(facts["files"]) == sorted(path.name for path in (tmp_path / "out").iterdir())
    assert "path.yaml" not in facts["files"]
    assert facts["datum"] == {"lat": 37.0708, "lon": -120.2579, "heading_deg": 90.0}
    assert f"{facts['columns']} {facts['rows']}".encode() in (tmp_path / "out" / "map.pgm").read_bytes()[:20]
    features = json.loads((tmp_path / "out" / "route.geojson").read_text())["features"]
    assert len(features) == facts["nodes"] + facts["edges"]
    call(export_site, **(given | {"task": str(tmp_path / "task.xml"), "datum": f"{AT_DEMO},0"}))
    said = capsys.readouterr().out
    assert "All drives are clear of the map" in said
    assert (tmp_path / "out" / "path.yaml").exists()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "--site: no site is given; give the site's file, or demo"),
        ({"site": "demo"}, "--datum: the profile of husky does not state"),
        ({"site": "demo", "datum": "here"}, "--datum: here is no position in degrees; give latitude and longitude"),
        ({"site": "demo", "datum": "37,-120,90,4"}, "is no position"),
        ({"site": "demo", "datum": "nan,-120"}, "is no position"),
        ({"site": "demo", "datum": "91,-120"}, "is no position"),
        ({"site": "demo", "datum": "38,-120"}, "km from the site"),
        ({"task": "none.xml", "site": "demo"}, "there is no such file"),
    ],
)
def test_bad_input_for_nav2_gets_one_line(tmp_path: Path, given: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said) as caught:
        call(export_site, **(given | {"output": tmp_path / "out"}))
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_a_command_is_not_named_for_a_mission() -> None:
    run = fieldhand("export", "none.jsonl", "--to", "events", "-o", "-")
    assert run.status == 2
    assert run.err.startswith("fieldhand: none.jsonl: there is no such file; give the event log of a mission")
    assert "nav2" in fieldhand("export", "--help").out
