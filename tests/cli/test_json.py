"""Commands that answer with facts answer in JSON when asked, and say the same."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from support.processes.command import fieldhand

REQUEST = "Take pictures of the 3 northernmost trees."


@pytest.mark.parametrize(
    "words",
    [
        ("site", "demo"),
        ("robot", "amiga"),
        ("plan", REQUEST, "--site", "demo"),
        ("run", REQUEST, "--site", "demo", "--yes"),
    ],
    ids=lambda w: w[0],
)
def test_prints_one_json_object_and_nothing_else(words: tuple[str, ...]) -> None:
    run = fieldhand(*words, "--json")
    assert run.status == 0, run.err
    assert isinstance(json.loads(run.out), dict)


def test_a_refusal_is_json_too() -> None:
    run = fieldhand("plan", "Dance with me.", "--site", "demo", "--planner", "english", "--json")
    assert run.status == 2
    assert json.loads(run.out)["outcome"] == "refused"


def test_same_seed_same_mission(tmp_path: Path) -> None:
    logs = []
    for name in ("a", "b"):
        log = tmp_path / f"{name}.jsonl"
        assert fieldhand("run", REQUEST, "--site", "demo", "--yes", "--seed", "5", "--events", str(log)).status == 0
        logs.append(log.read_text())
    assert logs[0] == logs[1]


def test_a_planned_task_runs_from_its_file_as_from_its_words(tmp_path: Path) -> None:
    task = tmp_path / "task.xml"
    assert fieldhand("plan", REQUEST, "--site", "demo", "-o", str(task)).status == 0
    assert fieldhand("check", str(task), "--site", "demo").status == 0
    logs = []
    for source in (str(task), REQUEST):
        log = tmp_path / f"{len(logs)}.jsonl"
        assert fieldhand("run", source, "--site", "demo", "--yes", "--events", str(log)).status == 0
        logs.append(log.read_text())
    assert logs[0] == logs[1]
