"""The command line with a language model: found by configuration, its talk kept, its failures one line each."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from fieldhand.planning.llm.scripted import ScriptedEndpoint
from fieldhand.planning.llm.transcript import read_transcript
from support.processes.command import Run, fieldhand

REQUEST = "Kindly portray the leafiest specimen."
ANSWER = """<task xmlns="urn:fieldhand:task:1"><task-composition><plan>
<act><take_thermal_picture/><at><middle/></at></act>
</plan><exits/></task-composition></task>"""


def with_model(tmp_path: Path, *words: str, **settings: str) -> Run:
    """Run with a state folder of the test's own, and these settings of a model."""
    keep = {k: v for k, v in os.environ.items() if not k.startswith(("FIELDHAND_", "OPENAI_"))}
    return fieldhand(*words, env=keep | {"XDG_STATE_HOME": str(tmp_path)} | settings)


def one_line(run: Run) -> str:
    assert run.status == 2, (run.status, run.out, run.err)
    assert "Traceback" not in run.err
    said = [line for line in run.err.splitlines() if line.startswith("fieldhand: ")]
    assert len(said) == 1, run.err
    return said[0]


def test_without_a_model_llm_says_how_to_configure_one(tmp_path: Path) -> None:
    line = one_line(with_model(tmp_path, "plan", REQUEST, "--site", "demo", "--planner", "llm"))
    assert "FIELDHAND_MODEL" in line


def test_an_endpoint_that_is_not_there_is_named(tmp_path: Path) -> None:
    with ScriptedEndpoint([]) as endpoint:
        url = endpoint.url
    run = with_model(
        tmp_path,
        *("plan", REQUEST, "--site", "demo", "--planner", "llm"),
        FIELDHAND_MODEL="openai-compatible:none",
        FIELDHAND_BASE_URL=url,
    )
    assert url.removeprefix("http://").split("/")[0] in one_line(run)


@pytest.mark.parametrize("planner", ["llm", "auto"])
def test_a_plan_of_a_model_is_a_plan_and_its_talk_is_kept(planner: str, tmp_path: Path) -> None:
    with ScriptedEndpoint([ANSWER]) as endpoint:
        run = with_model(
            tmp_path,
            *("plan", REQUEST, "--site", "demo", "--planner", planner),
            FIELDHAND_MODEL="openai-compatible:scripted",
            FIELDHAND_BASE_URL=endpoint.url,
        )
    assert run.status == 0, run.err
    (session,) = read_transcript(tmp_path / "fieldhand" / "transcripts.jsonl")
    assert session.request == REQUEST
