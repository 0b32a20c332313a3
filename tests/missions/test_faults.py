"""Simulated missions with random faults do what no fault excuses: docs/faults.md has the figures of a thousand."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from support.missions import faulted_flights


@pytest.fixture(scope="module")
def flights() -> list[faulted_flights.Flown]:
    return [faulted_flights.fly(seed, demo=False) for seed in range(16)]


def test_no_fault_brings_a_mission_into_a_keep_out_or_to_an_end_that_is_no_exit(
    flights: list[faulted_flights.Flown],
) -> None:
    assert {seed: found for seed, flown in enumerate(flights) if (found := faulted_flights.problems(flown))} == {}
    assert {e["event"] for flown in flights for e in flown.log} >= {"obstacle", "fault", "shed", "wait", "exit"}


def test_the_judge_of_these_missions_sees_what_is_wrong(flights: list[faulted_flights.Flown]) -> None:
    flown = next(f for f in flights if f.log[-1]["status"] == "completed" and len(f.task.command.goals) > 1)
    twice = replace(flown, log=[*flown.log, flown.log[-1]])
    less = replace(flown, log=[e for e in flown.log if e["event"] != "action"])
    astray = [json.loads(json.dumps(e)) for e in flown.log]
    drive = next(e for e in astray if e["event"] == "drive")
    drive["path"] = [[lat + 0.01, lon] for lat, lon in drive["path"]]
    for wrong in (twice, less, replace(flown, log=astray)):
        assert faulted_flights.problems(wrong)
