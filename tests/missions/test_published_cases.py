"""The published requests end as they were meant, judged by a referee that knows nothing of this package.

The cases and the referee stand beside the project, not in it; without them there is nothing to judge by. The same
requests are flown as the English planner plans them, and as a language model once did (``tests/data/transcripts``).
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from fieldhand.execution.drivers.simulation.world import World
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.planning.llm.replay import replay
from fieldhand.planning.llm.transcript import read_transcript
from fieldhand.planning.planner import Planned
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task.frames import Task
from fieldhand_bench.missions.case_file import load_cases
from fieldhand_bench.missions.case_site import load_case_site
from fieldhand_bench.missions.cases import Expected
from fieldhand_bench.missions.judge import judge
from fieldhand_bench.missions.log import read_log
from support.missions.flights import fly_request, fly_task
from support.missions.outside_referee import CASES, HERE, ground, referee
from support.missions.tampered import tampered

ROOT = Path(__file__).resolve().parents[2]
TRANSCRIPTS = ROOT / "tests" / "data" / "transcripts"


def cases() -> list[Any]:
    """Each world of each case."""
    if not HERE:
        return [pytest.param(None, 0, "", marks=pytest.mark.skip(reason="the published cases are not here"))]
    book = yaml.safe_load(CASES.read_text())
    return [
        pytest.param(case, k, book["site"], id=f"{case['id']}[{k}]")
        for case in book["cases"]
        for k in range(len(case["worlds"]))
    ]


@pytest.fixture(scope="module")
def expected() -> dict[str, tuple[Expected, ...]]:
    """Return what the bench's judge expects of each world of each case."""
    return {case.id: tuple(world.expected for world in case.worlds) for case in load_cases([str(CASES)])}


def problem_of(lines: list[str], site: Path, meant: dict[str, Any]) -> str | None:
    """Return what the referee finds wrong with a log; None if it is as asked."""
    found: str | None = referee().judge(ground(site), meant["expect"], [json.loads(line) for line in lines])
    return found


def agree(lines: list[str], site: Path, meant: dict[str, Any], expected: Expected) -> None:
    """The bench's judge and the referee find a log right or wrong alike, whatever mistake is planted in it."""
    ours = load_case_site(site)
    points = [f for f in json.loads(site.read_text())["features"] if f["geometry"]["type"] == "Point"]
    lon, lat = points[len(points) // 2]["geometry"]["coordinates"]
    for mistake, log in [("none", lines), *tampered(lines, (lat, lon))]:
        wrong, said = judge(ours, expected, read_log(log, ours)), problem_of(log, site, meant)
        assert bool(wrong) is (said is not None), (mistake, wrong, said)


@pytest.mark.parametrize(("case", "world", "default_site"), cases())
def test_plain_english_ends_as_it_was_meant_and_both_judges_agree(
    case: dict[str, Any], world: int, default_site: str, expected: dict[str, tuple[Expected, ...]]
) -> None:
    site = (CASES.parent / case.get("site", default_site)).resolve()
    meant = case["worlds"][world]
    flight = fly_request(
        case["request"], site=str(site), robot=case.get("robot", "husky"), readings=meant.get("readings", {})
    )
    assert problem_of(flight.lines, site, meant) is None
    agree(flight.lines, site, meant, expected[case["id"]][world])


@cache
def model_planned(case: str, site: Path, robot: str) -> Task:
    """Return the outcome of a language model's recorded answer today."""
    (session,) = read_transcript(TRANSCRIPTS / f"{case}.jsonl")
    outcome = replay(session, open_site(str(site)), load_robot(robot))
    assert isinstance(outcome, Planned), outcome
    return outcome.task


def model_flown(case: dict[str, Any], world: int, default_site: str, expected: Expected) -> tuple[Task, str | None]:
    """Return what a model planned, and what the referee finds wrong with its log, as the bench's judge does."""
    site = (CASES.parent / case.get("site", default_site)).resolve()
    meant, robot = case["worlds"][world], case.get("robot", "husky")
    task, readings = model_planned(case["id"], site, robot), meant.get("readings")
    world_of = parse_world({"readings": readings}) if readings else World()
    lines = fly_task(task, open_site(str(site)), robot, world=world_of).lines
    ours, said = load_case_site(site), problem_of(lines, site, meant)
    assert bool(judge(ours, expected, read_log(lines, ours))) is (said is not None), said
    return task, said


@pytest.mark.skipif(not HERE, reason="the published cases are not here")
def test_every_case_was_once_planned_by_a_language_model() -> None:
    assert {path.stem for path in TRANSCRIPTS.glob("*.jsonl")} == {case.id for case in load_cases([str(CASES)])}


@pytest.mark.parametrize(("case", "world", "default_site"), cases())
def test_what_a_language_model_planned_ends_as_it_was_meant(
    case: dict[str, Any], world: int, default_site: str, expected: dict[str, tuple[Expected, ...]]
) -> None:
    _, said = model_flown(case, world, default_site, expected[case["id"]][world])
    assert said is None
