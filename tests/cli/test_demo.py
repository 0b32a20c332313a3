"""The demo's missions complete, and what it suggests to try next works."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from fieldhand.cli.demo import MISSIONS, DemoName
from support.processes.command import fieldhand


@pytest.mark.parametrize("name", DemoName)
def test_a_demo_completes_its_mission(name: DemoName, tmp_path: Path) -> None:
    run = fieldhand("demo", name, "-o", str(tmp_path / "out"))
    assert run.status == 0, run.err
    assert "Mission completed" in run.out
    assert (tmp_path / "out" / "report.html").is_file()


def test_the_mowing_demo_waits_for_somebody_near(tmp_path: Path) -> None:
    run = fieldhand("demo", "mowing", "-o", str(tmp_path / "out"))
    assert "it stands still" in run.out
    assert "until it was over" in run.out


@pytest.mark.parametrize("command", sorted({line for mission in MISSIONS.values() for line in mission.commands}))
def test_what_a_demo_suggests_works(command: str, tmp_path: Path) -> None:
    program, *words = shlex.split(command)
    assert program == "fieldhand"
    if words[0] in ("serve", "demo"):
        words = [words[0], "--help"]
    if words[0] == "run":
        words.append("--yes")
    run = fieldhand(*[str(tmp_path / word) if word.endswith(".png") else word for word in words])
    assert run.status == 0, run.err
