"""The page about Spanish requests: every example on it has the result that it states."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from fieldhand.planning.builtin import BuiltinPlanner
from fieldhand.planning.planner import Clarify, Planned, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from planning.english.outlines import outline

PAGE = Path(__file__).parents[3] / "docs" / "spanish.md"
EXAMPLES = re.findall(r"^> (.+)\n  (plan|asks|refuses): (.+)$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)


def test_the_page_has_examples() -> None:
    assert len(EXAMPLES) > 8


@pytest.mark.parametrize(("request_", "kind", "result"), EXAMPLES)
def test_an_example_has_its_result(request_: str, kind: str, result: str) -> None:
    outcome = BuiltinPlanner().plan(request_, open_site("demo"), load_robot("husky"))
    if kind == "plan":
        assert isinstance(outcome, Planned), outcome
        assert outline(outcome.task) == result
    elif kind == "asks":
        assert isinstance(outcome, Clarify), outcome
        assert outcome.question == result
    else:
        assert isinstance(outcome, Refused)
        assert result in outcome.reasons[0].what
