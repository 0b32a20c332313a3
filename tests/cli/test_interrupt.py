"""Ctrl-C ends a mission in order: what was gathered is kept, and the log says how it ended."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path


def test_ctrl_c_keeps_what_was_gathered(tmp_path: Path) -> None:
    log = tmp_path / "e.jsonl"
    process = subprocess.Popen(
        [
            sys.executable,
            "-u",
            "-m",
            "fieldhand",
            "run",
            "Take a picture of every tree.",
            "--site",
            "demo",
            "--yes",
            "--speed",
            "400",
            "--out",
            str(tmp_path / "out"),
            "--events",
            str(log),
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    for line in process.stdout:
        if "thermal picture" in line and "°C" in line:
            break
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert "Traceback" not in err, err
    assert process.returncode == 1, (out, err)
    events = [json.loads(line) for line in log.read_text().splitlines()]
    assert events[-1]["event"] == "mission"
    assert events[-1]["status"] == "aborted"
    assert any(e["event"] == "action" and e["status"] == "success" for e in events)
    assert (tmp_path / "out" / "report.md").exists()
