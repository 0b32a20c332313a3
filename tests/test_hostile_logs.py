"""Whatever a robot, an operator or a stranger wrote into an event log: no output of it holds a hidden character."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from support.processes.command import fieldhand
from test_hidden_characters import hidden

HOSTILE = "\x1b[2J\x9b3A\u202etxt\u2066\u200b\u2028\x85\r\n=1+1[red]:warning:$x$"
#: Names that a plan and a site give; a log that has others is not one of this mission.
KEPT = ("event", "node", "action", "kind", "place", "status", "exit", "then", "fault", "t", "task", "robot", "site")


def flown(folder: Path) -> None:
    """Leave a Task and the log of its mission in a folder."""
    words = ("Read CO2 at tree 4 and take a thermal picture of tree 5.", "--site", "demo", "--yes", "-o", "left")
    run = fieldhand("run", *words, "--missions", str(folder / "missions"), cwd=folder)
    assert run.status == 0, run.err


def poisoned(value: Any, key: str = "") -> Any:
    """An event with hostile text behind each of its own."""
    if isinstance(value, dict):
        return {name: poisoned(part, name) for name, part in value.items()}
    if isinstance(value, list):
        return [poisoned(part, key) for part in value]
    return f"{value}{HOSTILE}" if isinstance(value, str) and key not in KEPT else value


@pytest.fixture(scope="module")
def left(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("flown")
    flown(folder)
    events = [json.loads(line) for line in (folder / "left" / "events.jsonl").read_text().splitlines()]
    fault = {"event": "fault", "t": 1.0, "node": "n1", "fault": "action_failed", "what": "x", "handled": True}
    whole = [poisoned(event) for event in (*events[:-1], fault, events[-1])]
    (folder / "events.jsonl").write_text("".join(json.dumps(event) + "\n" for event in whole))
    return folder


def require_visible(text: str) -> None:
    assert not hidden(text, "\n\t"), hidden(text, "\n\t")


@pytest.mark.parametrize("to", ["csv", "kml", "geojson", "events"])
def test_an_export_hides_nothing(to: str, left: Path) -> None:
    run = fieldhand("export", "events.jsonl", "--to", to, "-o", f"out.{to}", "--site", "demo", cwd=left)
    assert run.status == 0, run.err
    require_visible((left / f"out.{to}").read_text(encoding="utf-8").replace("\r\n", "\n"))
    require_visible(run.out + run.err)


def test_a_report_and_a_replay_hide_nothing(left: Path) -> None:
    beside = ("--task", "left/task.xml", "--site", "demo")
    run = fieldhand("report", "events.jsonl", *beside, "-o", "report", cwd=left)
    assert run.status in (0, 1), run.err
    require_visible(run.out + run.err)
    for path in sorted((left / "report").iterdir()):
        require_visible(path.read_text(encoding="utf-8").replace("\r\n", "\n"))
    run = fieldhand("replay", "events.jsonl", "-o", "replay.html", "--site", "demo", cwd=left)
    assert run.status == 0, run.err
    page = (left / "replay.html").read_text(encoding="utf-8")
    require_visible(page)
    data = page.partition('id="film"')[2].partition(">")[2].partition("</script>")[0]
    require_visible(json.dumps(json.loads(data), ensure_ascii=False))
