"""``fieldhand bench site`` measures what it says it measures; how long anything takes is never tested."""

from __future__ import annotations

import json

import pytest

from support.processes.command import fieldhand


@pytest.fixture(scope="module")
def measured():
    run = fieldhand("bench", "site", "--trees", "60", "--repeats", "2", "--seed", "3", "--json")
    assert run.status == 0, run.err
    return json.loads(run.out)


def test_the_record_holds_what_was_measured_and_on_what(measured):
    assert (measured["trees"], measured["repeats"], measured["seed"], measured["robot"]) == (60, 2, 3, "husky")
    assert measured["rows"] > 1
    assert {"machine", "cpu", "cores", "load", "software"} <= measured["machine"].keys()
    assert [step["name"] for step in measured["steps"]][-1] == "all of it"
    assert len(measured["selectors"]) > 35


def test_every_figure_is_a_time_and_a_median_is_no_more_than_the_worst(measured):
    for timing in [*measured["steps"], *measured["selectors"], measured["drives"]]:
        assert 0.0 < timing["median_s"] <= timing["worst_s"], timing["name"]


def test_all_of_it_is_the_sum_of_its_parts(measured):
    *parts, whole = measured["steps"]
    assert sum(p["first_s"] for p in parts) == pytest.approx(whole["first_s"])


def test_memory_is_that_of_a_process_of_its_own(measured):
    # Python with the libraries that reading a site needs takes tens of megabytes, a site of 60 trees next to nothing.
    assert 20e6 < measured["peak_bytes"] < 600e6


def test_the_table_names_the_slowest_selectors_and_the_machine():
    run = fieldhand("bench", "site", "--trees", "40", "--repeats", "1")
    assert run.status == 0, run.err
    for word in (
        "read the file",
        "find the rows",
        "drivable graph",
        "all of it",
        "selector: ",
        "a drive between two trees",
    ):
        assert word in run.out
    assert "numpy" in run.out


@pytest.mark.parametrize("words", [("--trees", "5"), ("--repeats", "0"), ("--robot", "no-such-robot")])
def test_what_cannot_be_measured_is_refused(words):
    run = fieldhand("bench", "site", *words)
    assert run.status == 2
    assert "Traceback" not in run.err
