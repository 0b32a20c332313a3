"""A mission that is killed with kill -9 is resumed to its end; it hears other processes while it is under way."""

from __future__ import annotations

import json
import signal
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from fieldhand.cli.app import assemble
from fieldhand.errors import FieldhandError
from support.processes.command import Run, Started, started

MISSION = ("run", "Take a thermal picture at every tree of row 2.", "--site", "demo", "--yes", "--confirm")


def fieldhand(*words: str) -> Run:
    """A command in this process."""
    done = CliRunner().invoke(assemble(), words)
    if isinstance(done.exception, FieldhandError):
        return Run(status=done.exception.exit_status, out=done.output, err=str(done.exception))
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return Run(status=done.exit_code, out=done.output, err="")


@pytest.fixture
def missions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("FIELDHAND_MISSIONS", str(tmp_path / "missions"))
    return tmp_path / "missions"


def under_way(*words: str, folder: Path, captures: int) -> Started:
    """A mission that has made so many captures, much slower than it could go on."""
    process = started(*words, folder=folder)
    for line in process.out:
        captures -= "°C" in line
        if captures == 0:
            return process
    pytest.fail("the mission ended too early")


def kill(process: Started) -> None:
    process.send_signal(signal.SIGKILL)
    process.end()


def status() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(fieldhand("status", "--json").out)
    return found


def test_paused_killed_twice_and_resumed(missions: Path, tmp_path: Path) -> None:
    process = under_way(*MISSION, "--speed", "10", folder=tmp_path, captures=2)
    assert "paused" in fieldhand("pause", "--because", "lunch").out
    assert status()["state"] == "paused"
    assert "continues" in fieldhand("resume").out
    assert status()["state"] == "running"
    kill(process)
    assert status()["state"] == "interrupted"
    assert "interrupted" in fieldhand("status").out
    unheard = fieldhand("pause")
    assert (unheard.status, "was interrupted; the order remains in force" in unheard.out) == (1, True)
    kill(under_way("resume", "--speed", "15", folder=tmp_path, captures=2))
    done = fieldhand("resume", "--json", "-o", str(tmp_path / "out"), "--events", str(tmp_path / "e.jsonl"))
    assert done.status == 0, (done.out, done.err)
    found = status()
    assert (found["state"], found["status"], found["captures"]) == ("ended", "completed", 18)
    (folder,) = missions.iterdir()
    log = (folder / "events.jsonl").read_text()
    assert log == (tmp_path / "e.jsonl").read_text() == (tmp_path / "out" / "events.jsonl").read_text()
    events = [json.loads(line) for line in log.splitlines()]
    made = [e["place"] for e in events if e["event"] == "action"]
    assert len(made) == len(set(made)) == 18
    assert [e["event"] for e in events].count("resumed") == 2
    assert (tmp_path / "out" / "report.html").exists()
    for late in (fieldhand(word) for word in ("pause", "return", "abort")):
        assert (late.status, "has ended" in late.err) == (1, True)
    again = fieldhand("resume")
    assert (again.status, "nothing is left to do" in again.out) == (0, True)


def test_what_is_no_mission_is_said(missions: Path, tmp_path: Path) -> None:
    for words in (("status",), ("resume",), ("pause", "nowhere"), ("abort", "--missions", str(tmp_path))):
        run = fieldhand(*words)
        assert run.status == 2, run
        assert "Traceback" not in run.err
        assert "mission" in run.err
