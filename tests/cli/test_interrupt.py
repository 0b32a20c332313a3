"""Whatever ends a mission from outside, it ends in order: what was gathered is kept, and the log says how it ended."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest


def start(tmp_path: Path, speed: int) -> subprocess.Popen[str]:
    """A mission of many captures, so many times faster than it would be driven."""
    words = ["run", "Take a picture of every tree.", "--site", "demo", "--yes", "--speed", str(speed)]
    files = ["--out", str(tmp_path / "out"), "--events", str(tmp_path / "e.jsonl")]
    return subprocess.Popen(
        [sys.executable, "-u", "-m", "fieldhand", *words, *files],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=dict(os.environ),
    )


def until_a_capture(process: subprocess.Popen[str]) -> None:
    assert process.stdout is not None
    for line in process.stdout:
        if "thermal picture" in line and "°C" in line:
            return
    pytest.fail("no capture was told")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_keeps_what_was_gathered(number: signal.Signals, tmp_path: Path) -> None:
    # Slow enough to be ended under way, also where this process has to wait for its turn.
    process = start(tmp_path, 150)
    until_a_capture(process)
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert "Traceback" not in err, err
    assert process.returncode == 1, (out, err)
    events = [json.loads(line) for line in (tmp_path / "e.jsonl").read_text().splitlines()]
    assert events[-1]["event"] == "mission"
    assert events[-1]["status"] == "aborted"
    assert any(e["event"] == "action" and e["status"] == "success" for e in events)
    assert (tmp_path / "out" / "report.md").exists()


def test_a_reader_that_goes_away_ends_no_mission(tmp_path: Path) -> None:
    process = start(tmp_path, 2000)
    until_a_capture(process)
    assert process.stdout is not None
    process.stdout.close()
    process.stdout = None
    _, err = process.communicate(timeout=120)
    assert "Traceback" not in err, err
    last = json.loads((tmp_path / "e.jsonl").read_text().splitlines()[-1])
    assert (last["event"], last["status"]) == ("mission", "completed")
    assert (tmp_path / "out" / "report.md").exists()
