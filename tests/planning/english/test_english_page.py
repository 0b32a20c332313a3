"""Every example of docs/english.md becomes what the page says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Clarify, Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline
from support.requests.planned import outcome_of

PAGE = Path(__file__).resolve().parents[3] / "docs" / "english.md"
EXAMPLES = re.findall(
    r"^(amiga|tractor|vineyard)?> (.+)\n  (plan|asks|refuses): (.+)$", PAGE.read_text(encoding="utf-8"), re.MULTILINE
)


def test_the_page_has_examples() -> None:
    assert len(EXAMPLES) >= 30


@pytest.mark.parametrize(("robot", "request_", "kind", "words"), EXAMPLES, ids=lambda v: str(v)[:50])
def test_an_example_becomes_what_the_page_says(robot: str, request_: str, kind: str, words: str) -> None:
    if robot == "vineyard":
        outcome = EnglishPlanner().plan(request_, open_site("vineyard"), load_robot("amiga"))
    else:
        outcome = outcome_of(robot or "husky", request_)
    if isinstance(outcome, Planned):
        assert (kind, words) == ("plan", outline(outcome.task))
    elif isinstance(outcome, Clarify):
        assert (kind, words) == ("asks", outcome.question)
    else:
        assert (kind, words) == ("refuses", outcome.reasons[0].what)
