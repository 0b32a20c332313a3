"""What a person at a terminal gets beside results: completion by the shell, and word that the program is at work."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cli.terminal import screen
from support.processes.command import fieldhand

WORDS = ("plan", "Read CO2 at tree 4.", "--site", "demo")


def completed(shell: str, line: str) -> str:
    """Return the completions that a shell is offered behind a line."""
    env = {
        "_FIELDHAND_COMPLETE": f"complete_{shell}",
        "COMP_WORDS": line,
        "COMP_CWORD": str(len(line.split(" ")) - 1),
        "_TYPER_COMPLETE_ARGS": line,
        "_TYPER_COMPLETE_FISH_ACTION": "get-args",
        "_TYPER_COMPLETE_WORD_TO_COMPLETE": line.rpartition(" ")[2],
    }
    ran = fieldhand(env=os.environ | env)
    assert "Traceback" not in ran.err
    return ran.out


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_shell_completes_commands_options_and_values(shell: str) -> None:
    assert "plan" in completed(shell, "fieldhand pl")
    assert "--robot" in completed(shell, "fieldhand plan --ro")
    assert "husky" in completed(shell, "fieldhand plan --robot hu")
    assert "es" in completed(shell, "fieldhand plan --lang e")
    assert "english" in completed(shell, "fieldhand plan --planner en")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_of_a_shell_is_printed(shell: str) -> None:
    ran = fieldhand(env=os.environ | {"_FIELDHAND_COMPLETE": f"source_{shell}"})
    assert ran.status == 0
    assert "_FIELDHAND_COMPLETE=complete_" in ran.out


def test_a_terminal_is_told_that_the_program_plans_and_a_pipe_is_not(tmp_path: Path) -> None:
    status, rows = screen(*WORDS, "--lang", "es", cwd=tmp_path)
    assert status == 0
    assert any("Planificando" in row for row in rows)
    piped = fieldhand(*WORDS)
    assert "Planning" not in piped.out + piped.err
    _, rows = screen(*WORDS, "--json", cwd=tmp_path)
    assert not any("Planning" in row for row in rows)


def test_an_answer_that_nothing_asks_for_is_refused(tmp_path: Path) -> None:
    run = fieldhand(*WORDS, "--answer", "2")
    assert run.status == 2
    assert "--answer: no question was asked to which '2' is an answer" in run.err
    assert fieldhand(*WORDS, "-o", str(tmp_path / "task.xml")).status == 0
    run = fieldhand("run", str(tmp_path / "task.xml"), "--site", "demo", "--yes", "--answer", "2")
    assert run.status == 2
    assert "is already planned" in run.err


@pytest.mark.parametrize("more", [(), ("--task", "task.xml", "--site", "demo")])
def test_a_report_of_a_file_that_is_not_there_names_the_file(more: tuple[str, ...], tmp_path: Path) -> None:
    run = fieldhand("report", "events.jsonl", *more, cwd=tmp_path)
    assert run.status == 2
    assert run.err.startswith("fieldhand: events.jsonl: there is no such file; give")
