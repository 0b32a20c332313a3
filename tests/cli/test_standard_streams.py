"""``-`` is standard input where a file is read, and standard output where one is written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fieldhand.robot.loader import profile_bytes
from support.processes.command import fieldhand

REQUEST = "Read CO2 at tree 4."


def test_data_goes_to_standard_output_alone_and_words_to_standard_error(tmp_path: Path) -> None:
    run = fieldhand("robot", "husky", "--yaml", "-", cwd=tmp_path)
    assert run.status == 0
    assert run.out.encode() == profile_bytes("husky")[0]
    assert "husky" in run.err
    run = fieldhand("robot", "husky", "--xsd", "-", cwd=tmp_path)
    assert run.out.startswith("<?xml")
    task = fieldhand("plan", REQUEST, "--site", "demo", "-o", "-", cwd=tmp_path)
    assert task.out.startswith("<?xml")
    assert task.out.endswith("</task>\n")
    assert "Return to the end marker" in task.err
    events = fieldhand(
        "run", REQUEST, "--site", "demo", "--yes", "--events", "-", "--missions", str(tmp_path / "m"), cwd=tmp_path
    )
    assert events.status == 0, events.err
    assert [json.loads(line)["event"] for line in events.out.splitlines()][-1] == "mission"
    assert "mission completed" in events.err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m"]


@pytest.mark.parametrize("words", [("-o", "-", "--json"), ("--transcript", "-"), ("--picture", "-")])
def test_what_cannot_go_there_is_refused_before_anything_is_done(words: tuple[str, ...], tmp_path: Path) -> None:
    run = fieldhand("plan", REQUEST, "--site", "demo", *words, cwd=tmp_path)
    assert run.status == 2
    assert "standard output" in run.err
    assert run.out == ""
    assert list(tmp_path.iterdir()) == []


def test_two_files_cannot_share_standard_output(tmp_path: Path) -> None:
    run = fieldhand("robot", "husky", "--xsd", "-", "--yaml", "-", cwd=tmp_path)
    assert (run.status, run.out) == (2, "")
    assert "--xsd" in run.err
    assert "--yaml" in run.err


def test_requests_tasks_and_profiles_are_read_from_standard_input(tmp_path: Path) -> None:
    task = fieldhand("plan", "-", "--site", "demo", "-o", "-", stdin=f"{REQUEST}\n", cwd=tmp_path)
    assert task.out.startswith("<?xml"), task.err
    assert fieldhand("check", "-", "--site", "demo", stdin=task.out, cwd=tmp_path).status == 0
    ran = fieldhand(
        "run", "-", "--site", "demo", "--yes", "--missions", str(tmp_path / "m"), stdin=task.out, cwd=tmp_path
    )
    assert ran.status == 0, ran.err
    profile = profile_bytes("amiga")[0].decode()
    assert "amiga" in fieldhand("robot", "-", stdin=profile, cwd=tmp_path).out
    empty = fieldhand("plan", "-", "--site", "demo", stdin="", cwd=tmp_path)
    assert empty.status == 2
    assert "the request is empty" in empty.err
