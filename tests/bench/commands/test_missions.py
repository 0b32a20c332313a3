"""``fieldhand bench missions`` and ``bench planning`` say what came of each request, and how long planning took."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from fieldhand.planning.llm.scripted import ScriptedAnswer, ScriptedEndpoint
from fieldhand.program import main
from fieldhand_bench.missions.case_file import load_cases
from fieldhand_bench.missions.published import published
from support.missions.outside_referee import CASES, HERE
from support.processes.command import Run, fieldhand

RIGHT = """<task xmlns="urn:fieldhand:task:1"><task-composition><plan>
<act><take_thermal_picture/><at><tree-is tree="7"/></at></act>
</plan><exits/></task-composition></task>"""
WRONG = RIGHT.replace('"7"', '"8"')

BOOK = """
site: builtin:demo
robot: husky
cases:
- id: one-tree
  request: take a picture of tree 7
  worlds:
  - readings: {canopy_temperature: 30}
    expect: {steps: [{do: take_thermal_picture, at: {attribute: {id: 7}}}]}
  - expect: {steps: [{do: take_thermal_picture, at: {attribute: {id: 8}}}]}
- id: corners-absolute
  request: Take a picture at the north-west, then the north-east corner of the farm.
  worlds:
  - expect:
      steps:
      - {do: take_thermal_picture, at: {corner: nw}}
      - {do: take_thermal_picture, at: {corner: ne}}
- id: a-question
  request: take a picture of the yellow tree
  ask: true
- id: no-question
  request: take a picture of tree 7
  ask: true
- id: not-understood
  request: dig a hole at tree 4
  worlds:
  - expect: {steps: []}
"""


@pytest.fixture
def book(tmp_path: Path) -> str:
    file = tmp_path / "book.yaml"
    file.write_text(BOOK)
    return str(file)


Bench = Callable[..., Run]


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Bench:
    """Run ``fieldhand bench`` in this process: most of what it does is loading libraries."""

    def run(*words: str) -> Run:
        monkeypatch.setattr(sys, "argv", ["fieldhand", "bench", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        said = capsys.readouterr()
        return Run(status=int(ended.value.code or 0), out=said.out, err=said.err)

    return run


def model(endpoint: ScriptedEndpoint, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Configure the scripted model."""
    monkeypatch.setenv("FIELDHAND_MODEL", "openai-compatible:scripted")
    monkeypatch.setenv("FIELDHAND_BASE_URL", endpoint.url)
    monkeypatch.setenv("XDG_STATE_HOME", str(folder))


def record(run: Run) -> dict[str, Any]:
    assert run.status in (0, 1), run.err
    found: dict[str, Any] = json.loads(run.out)
    assert found["passed"] is (run.status == 0)
    return found


def test_cases_that_are_as_asked_end_with_status_0() -> None:
    run = fieldhand("bench", "missions", "builtin", "--only", "tree-by-id", "--only", "which-of-two")
    assert run.status == 0, run.out + run.err
    for words in (
        "tree-by-id",
        "as asked",
        "1/1",
        "which-of-two",
        "as asked: asked back",
        "all: 2 of 2 as asked, 1 of 1",
    ):
        assert words in run.out
    assert "Not as asked" not in run.out


def test_what_is_not_as_asked_is_said_with_why_and_the_published_row_comes_first(book: str, bench: Bench) -> None:
    run = bench("missions", book)
    assert run.status == 1, run.err
    assert run.out.index("corners-absolute") < run.out.index("one-tree")
    for words in (
        "The published experiment",
        "published, spatial: 1 of 1 as asked; published: 0 right",
        "world 1: step 1 was to be take_thermal_picture x1 at {attribute: {id: 8}}, and was take_thermal_picture x1",
        "planned where a question was due",
        "refused: husky cannot dig: no action 'dig'",
        "all: 2 of 5 as asked, 2 of 4 worlds",
    ):
        assert words in run.out, words


def test_the_record_holds_everything_and_the_same_seed_gives_the_same(book: str, bench: Bench) -> None:
    first, again = (record(bench("missions", book, "--seed", "3", "--json")) for _ in range(2))
    for one in (first, again):
        del one["machine"]
        for case in one["cases"]:
            assert case.pop("plan_s") > 0
    assert first == again
    cases = {case["id"]: case for case in first["cases"]}
    assert list(cases) == ["corners-absolute", "one-tree", "a-question", "no-question", "not-understood"]
    assert cases["corners-absolute"]["published"]["verdict"] == "wrong"
    assert cases["one-tree"]["worlds_right"] == 1
    assert [bool(wrong) for wrong in cases["one-tree"]["wrong"]] == [False, True]
    assert [cases[name]["answer"] for name in ("a-question", "no-question", "not-understood")] == [
        "asked",
        "planned",
        "refused",
    ]
    assert first["totals"] | {"published": None} == {
        "cases": 5, "as_asked": 2, "worlds": 4, "worlds_right": 2, "tokens": 0, "published": None
    }  # fmt: skip


def test_logs_are_kept_where_they_are_wanted(book: str, tmp_path: Path, bench: Bench) -> None:
    run = bench("missions", book, "--only", "one-tree", "--logs", str(tmp_path / "logs"))
    assert run.status == 1, run.err
    logs = sorted((tmp_path / "logs").iterdir())
    assert [log.name for log in logs] == ["one-tree.0.jsonl", "one-tree.1.jsonl"]
    assert json.loads(logs[0].read_text().splitlines()[-1])["event"] == "mission"


def test_a_language_model_is_tried_with_its_tokens_and_tries_counted(
    book: str, tmp_path: Path, bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    with ScriptedEndpoint(["no plan at all", RIGHT]) as endpoint:
        model(endpoint, tmp_path, monkeypatch)
        found = record(bench("missions", book, "--planner", "llm", "--only", "one-tree", "--json"))
    (case,) = found["cases"]
    assert (case["tries"], case["tokens"]) == (2, 4)
    assert case["worlds_right"] == 1


def test_a_model_that_gives_no_usable_answer_fails_that_case_alone(
    book: str, tmp_path: Path, bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    failing = ScriptedAnswer(text="not this one", status=400)
    with ScriptedEndpoint([failing, WRONG, WRONG]) as endpoint:
        model(endpoint, tmp_path, monkeypatch)
        run = bench("missions", book, "--planner", "llm", "--only", "one-tree", "--only", "no-question")
    assert run.status == 1
    for words in ("no answer", "planned where a question was due", "tries"):
        assert words in run.out


@pytest.mark.parametrize(
    "words",
    [("nowhere.yaml",), ("builtin", "--only", "nonsense"), ("builtin", "--planner", "oracle"), (),
     ("builtin", "builtin")],
)  # fmt: skip
def test_what_cannot_be_tried_is_refused(words: tuple[str, ...], bench: Bench) -> None:
    run = bench("missions", *words)
    assert run.status == 2
    assert run.err


@pytest.mark.skipif(not HERE, reason="the published cases are not here")
def test_every_row_of_the_published_table_is_one_of_the_published_cases() -> None:
    known = {case.id for case in load_cases([str(CASES)])}
    assert {row.case for row in published()} <= known
    assert [sum(row.spatial is spatial for row in published()) for spatial in (False, True)] == [5, 6]


def test_planning_is_timed_request_by_request(bench: Bench) -> None:
    run = bench("planning", "--trees", "400", "--repeats", "2", "--json")
    assert run.status == 0, run.err
    found = json.loads(run.out)
    assert (found["trees"], found["repeats"], found["seed"]) == (400, 2, 1)
    assert len(found["requests"]) >= 20
    for timing in found["requests"]:
        assert timing["answer"] == "planned", timing
        assert 0 < timing["median_s"] <= timing["worst_s"] <= found["worst_s"]
    assert found["median_s"] <= found["slowest_s"]


def test_the_table_of_planning_names_the_slowest_requests_and_the_machine(bench: Bench) -> None:
    run = bench("planning", "--trees", "60", "--repeats", "1", "--cpu-time")
    assert run.status == 0, run.err
    for words in ("60 trees", "median", "at most 50 ms", "first request of the process", "numpy"):
        assert words in run.out


GIVEN = """
site: builtin:demo
robot: tractor
cases:
- id: given
  request: take a picture of tree 7, and charge the battery
  task: <task><task-composition><plan><act words="take a picture of tree 7"><take_picture/><at><tree-is
    tree="{tree}"/></at></act></plan></task-composition></task>
  worlds:
  - events: [{{event: person_near, from_s: 1, until_s: 30}}]
    expect: {{steps: [{{do: take_picture, at: {{attribute: {{id: 7}}}}}}], charges: [{charges}, 1], waited_s: [0, 0]}}
"""


@pytest.mark.parametrize(("tree", "charges", "right"), [(7, 0, True), (8, 0, False), (7, 1, False)])
def test_the_draft_of_a_case_is_driven_and_judged_too(
    bench: Bench, tmp_path: Path, tree: int, charges: int, right: bool
) -> None:
    file = tmp_path / "given.yaml"
    file.write_text(GIVEN.format(tree=tree, charges=charges))
    trials = json.loads(bench("missions", str(file), "--json").out)["cases"]
    assert [trial["id"] for trial in trials] == ["given", "given/task"]
    assert trials[1]["as_asked"] is right
    assert trials[1]["answer"] == "planned"
