"""``fieldhand bench guard`` says what the experiment found, and replays any of its missions."""

from __future__ import annotations

import json

import pytest

from support.processes.command import fieldhand


def test_the_record_holds_the_figures_and_every_mission() -> None:
    run = fieldhand("bench", "guard", "--missions", "4", "--trees", "20", "--jobs", "1", "--worst", "2", "--json")
    assert run.status in (0, 1), run.err
    record = json.loads(run.out)
    assert record["passed"] is (run.status == 0)
    assert [m["seed"] for m in record["missions"]] == [0, 1, 2, 3]
    assert record["summary"]["promises"][0]["missions"] == 4
    assert {"cpu", "load", "software"} <= record["machine"].keys()


def test_the_tables_show_families_limits_and_probabilities_of_the_missions_flown() -> None:
    run = fieldhand(
        "bench", "guard", "--missions", "2", "--family", "mandatory", "--trees", "20", "--jobs", "1", "--seed", "3"
    )
    assert run.status in (0, 1), run.err
    for words in ("By family", "mandatory", "home alone is safe", "in silence", "first decision", "seed 3"):
        assert words in run.out
    assert "two-optional" not in run.out


def test_a_mission_is_replayed_in_words() -> None:
    run = fieldhand("bench", "guard", "--only", "1", "--trees", "20")
    assert run.status == 0, run.err
    for words in ("seed 1: mandatory-and-optional", "What will be done", "mission ", "How it is judged"):
        assert words in run.out


@pytest.mark.parametrize("words", [("--family", "nonsense"), ("--missions", "0"), ("--trees", "3")])
def test_what_cannot_be_run_is_refused(words: tuple[str, ...]) -> None:
    run = fieldhand("bench", "guard", *words)
    assert run.status == 2
    assert "Traceback" not in run.err
