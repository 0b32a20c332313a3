"""Recorded transcripts: what a model once answered still makes a plan today, and each says how it was made."""

from __future__ import annotations

from pathlib import Path

import pytest

from fieldhand.planning.llm.replay import replay
from fieldhand.planning.llm.transcript import Session, read_transcript
from fieldhand.planning.planner import Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import load_site, open_site
from fieldhand.site.model import Site

ROOT = Path(__file__).resolve().parents[3]
TRANSCRIPTS = sorted((ROOT / "tests" / "data" / "transcripts").glob("*.jsonl"))


def site_of(session: Session) -> Site:
    """The site that a session was about: the built-in one, or a file of the shared data where that is at hand."""
    name = session.about["site"]["name"]
    demo = open_site("demo")
    if name == demo.name:
        return demo
    for path in (ROOT.parent / "shared" / "data").glob(f"**/{name}.geojson"):
        return load_site(path)
    pytest.skip(f"the site {name} is not at hand")


@pytest.mark.parametrize("path", TRANSCRIPTS, ids=lambda p: p.stem)
def test_a_recorded_answer_still_makes_a_plan(path: Path) -> None:
    for session in read_transcript(path):
        site, robot = site_of(session), load_robot(session.about["robot"]["name"])
        outcome = replay(session, site, robot)
        assert type(outcome).__name__.lower() == session.outcome
        if isinstance(outcome, Planned):
            assert outcome.task.command.request == session.request
            assert outcome.planner == session.about["planner"]
            assert mismatches(outcome.task, site, robot) == ()


@pytest.mark.parametrize("path", TRANSCRIPTS, ids=lambda p: p.stem)
def test_a_transcript_says_how_it_was_made(path: Path) -> None:
    assert all(session.about["note"].strip() for session in read_transcript(path))
