"""Missions in which battery, distance or time runs out: docs/faults.md has the figures of two hundred."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from missions import battery_flights
from support.missions.faulted_flights import Flown


@pytest.fixture(scope="module")
def flights() -> list[Flown]:
    return [battery_flights.fly(seed) for seed in (0, 1, 4, 7, 9, 17, 20, 36, 53, 64, 73, 77)]


def test_no_level_is_passed_in_silence_and_nothing_beyond_a_limit_is_a_success(flights: list[Flown]) -> None:
    assert {f.task.id: found for f in flights if (found := battery_flights.problems(f))} == {}
    levels = {e["level"] for f in flights for e in f.log if e["event"] == "limit"}
    assert levels == {"warn", "return", "reserve", "stop", "limit", "way_home", "out_of_reach"}
    assert {"exceeded", "faulted", "returned"} <= {f.log[-1]["status"] for f in flights}


def test_the_judge_of_these_missions_sees_what_is_wrong(flights: list[Flown]) -> None:
    stopped = next(f for f in flights if f.log[-1]["charge_percent"] < battery_flights.levels(f)["stop"] - 1e-3)
    silent = replace(stopped, log=[e for e in stopped.log if e.get("level") != "stop"])
    assert any("nothing said so before" in found for found in battery_flights.problems(silent))
    limit = next(e for e in stopped.log if e.get("level") == "stop")
    twice = replace(stopped, log=[*stopped.log[:-1], limit, stopped.log[-1]])
    assert any("times" in found for found in battery_flights.problems(twice))
    exceeded = next(f for f in flights if f.log[-1]["status"] == "exceeded")
    log = json.loads(json.dumps(exceeded.log))
    log[-1]["status"] = "completed"
    met = tuple(replace(o, outcome="success") for o in exceeded.outcomes)
    called = battery_flights.problems(replace(exceeded, log=log, outcomes=met))
    assert any("a success beyond" in found for found in called)
