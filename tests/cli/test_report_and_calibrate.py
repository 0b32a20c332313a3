"""``fieldhand report`` and ``fieldhand robot calibrate`` as a user runs them."""

from __future__ import annotations

import json
import os

import pytest

from fieldhand.task.event_lines import to_json
from support.missions.measured import mission
from support.processes.command import fieldhand

WORDS = ("run", "Take a picture of the middle tree.", "--site", "demo", "--planner", "english", "--yes")


@pytest.mark.parametrize("keep", [True, False])
def test_a_mission_is_kept_unless_that_is_not_wanted_and_reported_again_from_its_log(tmp_path, keep):
    env = dict(os.environ) | {"XDG_STATE_HOME": str(tmp_path / "state")}
    more = () if keep else ("--no-history",)
    assert fieldhand(*WORDS, "-o", "out", *more, cwd=tmp_path, env=env).status == 0
    assert [p.name for p in (tmp_path / "state").rglob("*.sqlite")] == ["husky.sqlite"] * keep
    if keep:
        words = ("report", "out/events.jsonl", "--task", "out/task.xml", "--site", "demo", "-o", "again", "--json")
        again = fieldhand(*words, cwd=tmp_path)
        assert again.status == 0, again.err
        assert json.loads(again.out)["status"] == "completed"
        for name in ("observations.csv", "observations.geojson"):
            assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "out" / name).read_bytes()


def test_a_robot_is_calibrated_from_logs_and_its_new_profile_is_shown(tmp_path):
    env = dict(os.environ) | {"XDG_STATE_HOME": str(tmp_path)}
    for seed in range(2):
        (tmp_path / f"{seed}.jsonl").write_text("".join(f"{to_json(e)}\n" for e in mission(seed)))
    words = ("robot", "calibrate", "husky", "0.jsonl", "1.jsonl", "-o", "new.yaml")
    run = fieldhand(*words, cwd=tmp_path, env=env)
    assert run.status == 0, run.err
    assert "husky: 2 missions, 60 legs, 60 captures" in run.out
    assert "must be approved again" in run.out
    record = json.loads(fieldhand(*words, "--json", cwd=tmp_path, env=env).out)
    assert record["figures"]["speed"]["value"] == pytest.approx(0.8)
    shown = json.loads(fieldhand("robot", "new.yaml", "--json", cwd=tmp_path).out)
    assert (shown["name"], shown["speed_m_s"]) == ("husky", 0.8)
    refused = fieldhand("robot", "calibrate", cwd=tmp_path, env=env)
    assert refused.status == 2
    assert "no driven missions of husky are stored" in refused.err


def test_a_mission_beyond_its_limit_is_no_success_though_every_goal_is_met(tmp_path):
    request = "Take a picture of the middle tree without driving more than 500 meters."
    words = ("run", request, "--site", "demo", "--planner", "english", "--yes", "-o", "out")
    assert fieldhand(*words, cwd=tmp_path).status == 0
    log = tmp_path / "out" / "events.jsonl"
    *before, end = [json.loads(line) for line in log.read_text().splitlines()]
    assert (end["event"], end["status"]) == ("mission", "completed")
    # As an earlier version wrote it: the figures alone say that it went too far.
    log.write_text("".join(f"{json.dumps(line)}\n" for line in [*before, end | {"t": 752.0, "travelled_m": 500.5}]))
    again = ("report", "out/events.jsonl", "--task", "out/task.xml", "--site", "demo", "-o", "again")
    said = fieldhand(*again, cwd=tmp_path)
    assert said.status == 1, said.err
    assert "✗ 500.5 m of 500 m driven: limit exceeded at 12:32, at the end" in said.out
    assert "Mission ended, limit exceeded." in said.out
    record = json.loads(fieldhand(*again, "--json", cwd=tmp_path).out)
    assert (record["status"], record["success"]) == ("exceeded", False)
    assert [(one["kind"], one["used"], one["limit"]) for one in record["exceeded"]] == [("distance_m", 500.5, 500.0)]
    assert [goal["outcome"] for goal in record["goals"]] == ["success"]
    page = (tmp_path / "again" / "report.html").read_text()
    assert (
        "Ended, limit exceeded (500.5 m of 500 m driven: limit exceeded at 12:32, at the end): 1 of 1 goal met." in page
    )
