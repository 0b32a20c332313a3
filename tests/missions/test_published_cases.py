"""The published requests end as they were meant, judged by a referee that knows nothing of this package.

The cases and the referee stand beside the project, not in it; without them there is nothing to judge by. The same
requests are flown as the English planner plans them, and as a language model once did (``tests/data/transcripts``).
"""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import yaml

from fieldhand.execution.world import World, parse_world
from fieldhand.planning.llm.replay import replay
from fieldhand.planning.llm.transcript import read_transcript
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.geojson import open_site
from flights import Flight, fly_request, fly_task

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared"
CASES = SHARED / "data" / "missions" / "orchard.yaml"
TRANSCRIPTS = ROOT / "tests" / "data" / "transcripts"


def cases(names: tuple[str, ...] | None = None) -> list[Any]:
    """Each world of the cases of these names, of all cases by default."""
    if not CASES.exists():
        return [pytest.param(None, 0, "", marks=pytest.mark.skip(reason="the published cases are not here"))]
    book = yaml.safe_load(CASES.read_text())
    return [
        pytest.param(case, k, book["site"], id=f"{case['id']}[{k}]")
        for case in book["cases"]
        if names is None or case["id"] in names
        for k in range(len(case["worlds"]))
    ]


@pytest.fixture(scope="module")
def referee() -> ModuleType:
    spec = importlib.util.spec_from_file_location("referee", SHARED / "tools" / "referee.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def problem_of(flight: Flight, site: Path, meant: dict[str, Any], referee: ModuleType) -> str | None:
    """What the referee finds wrong with a flight; None if it is as asked."""
    found: str | None = referee.judge(referee.Site(site), meant["expect"], [json.loads(line) for line in flight.lines])
    return found


@pytest.mark.parametrize(("case", "world", "default_site"), cases())
def test_plain_english_ends_as_it_was_meant(
    case: dict[str, Any], world: int, default_site: str, referee: ModuleType
) -> None:
    site = (CASES.parent / case.get("site", default_site)).resolve()
    meant = case["worlds"][world]
    flight = fly_request(
        case["request"], site=str(site), robot=case.get("robot", "husky"), readings=meant.get("readings", {})
    )
    assert problem_of(flight, site, meant, referee) is None


@pytest.mark.parametrize(("case", "world", "default_site"), cases(tuple(p.stem for p in TRANSCRIPTS.glob("*.jsonl"))))
def test_what_a_language_model_planned_ends_as_it_was_meant(
    case: dict[str, Any], world: int, default_site: str, referee: ModuleType
) -> None:
    site = (CASES.parent / case.get("site", default_site)).resolve()
    meant = case["worlds"][world]
    (session,) = read_transcript(TRANSCRIPTS / f"{case['id']}.jsonl")
    robot = case.get("robot", "husky")
    outcome = replay(session, open_site(str(site)), load_robot(robot))
    assert isinstance(outcome, Planned)
    readings = meant.get("readings")
    flight = fly_task(
        outcome.task, open_site(str(site)), robot, world=parse_world({"readings": readings}) if readings else World()
    )
    assert problem_of(flight, site, meant, referee) is None
