"""Whatever ends a mission from outside, it ends in order: what was gathered is kept, and the log says how it ended."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

from ros2.sim_robots import patient
from support.processes.command import started
from support.processes.patience import LONG_S


def mission(tmp_path: Path, speed: int) -> list[str]:
    """A mission of many captures, so many times faster than it would be driven; its battery loses nothing meanwhile."""
    words = ["run", "Take a picture of every tree.", "--site", "demo", "--yes", "--speed", str(speed)]
    words += ["--robot", str(patient(tmp_path))]
    return [*words, "--out", str(tmp_path / "out"), "--events", str(tmp_path / "e.jsonl")]


def until_a_capture(lines: Iterable[str]) -> None:
    for line in lines:
        if "thermal picture" in line and "°C" in line:
            return
    pytest.fail("no capture was told")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_keeps_what_was_gathered(number: signal.Signals, tmp_path: Path) -> None:
    # Slow enough to be ended under way, also where this process has to wait for its turn.
    process = started(*mission(tmp_path, 20), folder=tmp_path)
    until_a_capture(process.out)
    process.send_signal(number)
    run = process.end()
    assert "Traceback" not in run.err, run.err
    assert run.status == 1, run
    events = [json.loads(line) for line in (tmp_path / "e.jsonl").read_text().splitlines()]
    assert events[-1]["event"] == "mission"
    assert events[-1]["status"] == "aborted"
    assert any(e["event"] == "action" and e["status"] == "success" for e in events)
    assert (tmp_path / "out" / "report.html").exists()


def test_a_mission_in_the_background_is_ended_by_a_kill_alone(tmp_path: Path) -> None:
    process = started(*mission(tmp_path, 20), folder=tmp_path, deaf=True)
    until_a_capture(process.out)
    process.send_signal(signal.SIGINT)
    until_a_capture(process.out)
    process.send_signal(signal.SIGTERM)
    assert process.end().status == 1
    last = json.loads((tmp_path / "e.jsonl").read_text().splitlines()[-1])
    assert (last["status"], "SIGTERM" in json.dumps(last)) == ("aborted", True)


def test_a_reader_that_goes_away_ends_no_mission(tmp_path: Path) -> None:
    """A program that starts anew, since at its end the interpreter writes what is left."""
    process = subprocess.Popen(
        [sys.executable, "-u", "-m", "fieldhand", *mission(tmp_path, 2000)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=dict(os.environ),
    )
    assert process.stdout is not None
    until_a_capture(process.stdout)
    process.stdout.close()
    process.stdout = None
    _, err = process.communicate(timeout=LONG_S)
    assert "Traceback" not in err, err
    last = json.loads((tmp_path / "e.jsonl").read_text().splitlines()[-1])
    assert (last["event"], last["status"]) == ("mission", "completed")
    assert (tmp_path / "out" / "report.html").exists()
