"""``fieldhand bench forecast`` flies one request many times and says whether its forecast came true."""

from __future__ import annotations

import json

import pytest

from support.processes.command import fieldhand

REQUEST = "Take thermal pictures of as many trees as you can without driving more than 100 meters."


def test_forecast_and_missions_stand_side_by_side() -> None:
    run = fieldhand("bench", "forecast", REQUEST, "--site", "demo", "--missions", "2", "--json")
    record = json.loads(run.out)
    assert run.status == (0 if record["kept"] and record["agrees"] else 1), run.err
    assert [one["seed"] for one in record["each"]] == [1, 2]
    assert record["accepted"] == 0.1
    assert {"forecast", "interval", "visits_forecast", "machine", "warnings"} <= record.keys()


def test_a_generated_site_stands_in_for_a_file() -> None:
    run = fieldhand("bench", "forecast", REQUEST, "--made", "curved:60", "--missions", "1")
    assert "exceeded: " in run.out, run.err
    assert "accepted 10.0%" in run.out


@pytest.mark.parametrize("words", [("--made", "curved"), ("--made", "round:100"), ("--site", "nowhere")])
def test_what_cannot_be_flown_is_refused(words: tuple[str, ...]) -> None:
    assert fieldhand("bench", "forecast", REQUEST, *words).status == 2
