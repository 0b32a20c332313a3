"""The cases that come along are as asked, and the judge says what the referee outside the project says."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest
import yaml

from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand_bench.missions.case_file import BUILTIN, load_cases
from fieldhand_bench.missions.case_form import PlaceForm
from fieldhand_bench.missions.case_site import load_case_site
from fieldhand_bench.missions.cases import Case
from fieldhand_bench.missions.judge import judge
from fieldhand_bench.missions.log import read_log
from fieldhand_bench.missions.trial import TrialSetup, try_all
from support.missions.outside_referee import HERE, SHARED, ground, referee
from support.missions.tampered import tampered

BUILT_IN = load_cases([BUILTIN])
FILES = sorted({case.source for case in BUILT_IN})
#: Positions of trees to which planted mistakes move a capture: one beside many others, one at a corner.
ELSEWHERE = (94, 18)


def degrees(case: Case, tree: int) -> tuple[float, float]:
    points = json.loads(case.site.read_text())["features"]
    kinds = [str(f["properties"].get("marker-symbol") or f["properties"].get("kind", "")) for f in points]
    trees = [f for f, kind in zip(points, kinds, strict=True) if "tree" in kind or kind == "vine"]
    lon, lat = trees[tree]["geometry"]["coordinates"]
    return lat, lon


def test_there_are_forty_of_each_kind_at_least() -> None:
    assert len([case for case in BUILT_IN if not case.asks]) >= 40
    assert sum(case.asks for case in BUILT_IN) >= 5
    assert sum(len(case.worlds) > 1 for case in BUILT_IN) >= 10


def test_the_page_and_the_changelog_say_how_many_there_are() -> None:
    root = Path(__file__).resolve().parents[2]
    driven, worlds = sum(not case.asks for case in BUILT_IN), sum(len(case.worlds) for case in BUILT_IN)
    page = (root / "docs" / "bench-missions.md").read_text()
    assert f"all {len(BUILT_IN)} ({driven} of them driven, in {worlds} worlds; {len(BUILT_IN) - driven} asked" in page
    assert f"{len(BUILT_IN)} cases" in (root / "CHANGELOG.md").read_text()


@pytest.mark.parametrize("file", FILES, ids=lambda f: Path(f).stem)
def test_every_case_is_as_asked_and_both_judges_agree_on_every_log(file: str) -> None:
    cases = [case for case in BUILT_IN if case.source == file]
    logs: list[tuple[Case, int, Sequence[str]]] = []
    setup = TrialSetup(
        planner=EnglishPlanner(),
        model=None,
        seed=0,
        clock=lambda: 0.0,
        keep=lambda case, world, lines: logs.append((case, world, tuple(lines))),
    )
    for trial in try_all(cases, setup):
        assert trial.as_asked, (trial.id, trial.why, trial.wrong)
    given = {f"{case.id}/task": len(case.worlds) for case in cases if case.task}
    assert Counter(case.id for case, _, _ in logs) == given | {c.id: len(c.worlds) for c in cases if c.worlds}
    if HERE:
        agree_on_every_mistake(logs, yaml.safe_load(Path(file).read_text()))


def agree_on_every_mistake(logs: list[tuple[Case, int, Sequence[str]]], book: dict) -> None:
    expects = {case["id"]: [world["expect"] for world in case.get("worlds", ())] for case in book["cases"]}
    known = cache(load_case_site)
    for number, (case, world, lines) in enumerate(logs):
        ours = known(case.site)
        expect = expects[case.id.removesuffix("/task")][world]
        elsewhere = degrees(case, ELSEWHERE[number // 2 % 2])
        mistakes = list(tampered(lines, elsewhere))[number % 2 :: 2]  # the other half at the next log
        for mistake, log in [("none", list(lines)), *mistakes]:
            wrong = judge(ours, case.worlds[world].expected, read_log(log, ours))
            said = referee().judge(ground(case.site), expect, [json.loads(line) for line in log])
            assert bool(wrong) is (said is not None), (case.id, world, mistake, wrong, said)


#: The two measure a degree in ways that differ by 1 in 1,000: a tree at just the distance asked for may go either way.
ON_THE_BORDER = 2

PLACES = [
    *({"corner": name} for name in ("nw", "ne", "sw", "se", "any")),
    *({"quarter": name} for name in ("nw", "ne", "sw", "se")),
    *({key: side} for key in ("half", "most", "mid_edge") for side in ("north", "south", "east", "west")),
    {"most": "east", "tol_m": 0.5},
    {"center": 0.25},
    {"center": 0.01},
    {"same": "A"},
    {"not": "A"},
    {"not": ["A", "B"]},
    {"next_to": "A"},
    {"next_to": "A", "rank": 2},
    {"near": "A"},
    {"near": "A", "rank": 12, "not": ["A", "B"]},
    {"far": "A"},
    {"far": "A", "fraction": 0.5},
    {"offset": {"from": "A", "trees": 5}, "toward": "north"},
    {"offset": {"from": "A", "trees": 2}},
    {"ids": [0, 3]},
    {"first": True},
    {"last": True},
    {"any": True},
]


@pytest.mark.skipif(not HERE, reason="the referee is not here")
@pytest.mark.parametrize("farm", ["reza_medium", "ucm_graph20", "ucm_graph40"])
def test_both_judges_see_the_same_trees_in_every_place(farm: str) -> None:
    path = SHARED / "data" / "farms" / f"{farm}.geojson"
    ours, theirs = load_case_site(path), ground(path)
    trees = range(len(theirs.trees))
    for place in PLACES:
        form = PlaceForm.model_validate(place).place()
        for a in trees[:: len(trees) // 4] if form.labels else trees[:1]:
            labels = {"A": a, "B": (a + 1) % len(trees)}
            seen = {tree for tree in trees if form.holds(ours, tree, labels)}
            meant = {tree for tree in trees if referee().place_holds(theirs, place, tree, labels)}
            assert len(seen ^ meant) <= ON_THE_BORDER, (place, a, seen ^ meant)
