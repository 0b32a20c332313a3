"""Replay: a recorded session makes the same plan again, and says so when it no longer does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from fieldhand.errors import ModelError
from fieldhand.planning.llm.replay import record, replay
from fieldhand.planning.llm.scripted import ScriptedEndpoint
from fieldhand.planning.llm.transcript import Session, read_transcript
from fieldhand.planning.planner import Outcome, Planned
from fieldhand.robot.loader import load_robot
from support.sites.grids import grid

SITE, HUSKY = grid(4, 6), load_robot("husky")
REQUEST = "Take a picture of the first tree."
GOOD = """<task xmlns="urn:fieldhand:task:1"><task-composition><plan>
<act><take_thermal_picture/><at><first/></at></act>
</plan></task-composition></task>"""
BAD = GOOD.replace("<first/>", '<tree-is tree="999"/>')


def recorded(path: Path, *answers: str) -> tuple[Outcome, Session]:
    with ScriptedEndpoint(answers) as endpoint:
        outcome = record(REQUEST, SITE, HUSKY, path, settings=endpoint.settings(), note="written for this test")
    (session,) = read_transcript(path)
    return outcome, session


def test_a_replay_with_its_repairs_makes_the_same_plan(tmp_path: Path) -> None:
    outcome, session = recorded(tmp_path / "t.jsonl", BAD, GOOD)
    assert isinstance(outcome, Planned)
    assert session.about["note"] == "written for this test"
    assert replay(session, SITE, HUSKY) == outcome


def test_recording_again_replaces_the_file(tmp_path: Path) -> None:
    recorded(tmp_path / "t.jsonl", BAD, GOOD)
    _, session = recorded(tmp_path / "t.jsonl", GOOD)
    assert len(session.exchanges) == 1


def test_an_answer_that_is_no_longer_good_fails(tmp_path: Path) -> None:
    # The request names no tree 20, so the plan is doubted and given again.
    answer = GOOD.replace("<first/>", '<tree-is tree="20"/>')
    _, session = recorded(tmp_path / "t.jsonl", answer, answer)
    with pytest.raises(ModelError, match="20"):
        replay(session, grid(2, 2), HUSKY)


def test_an_answer_that_is_no_longer_needed_fails(tmp_path: Path) -> None:
    _, session = recorded(tmp_path / "t.jsonl", GOOD)
    twice = replace(session, exchanges=session.exchanges * 2)
    with pytest.raises(ModelError, match="not needed"):
        replay(twice, SITE, HUSKY)
