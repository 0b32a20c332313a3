"""``fieldhand report`` and ``fieldhand robot calibrate`` as a user runs them."""

from __future__ import annotations

import json
import os

from command import fieldhand

REQUEST = "Take a thermal picture of every tree of row 2 and row 3."


def test_a_mission_is_reported_again_from_its_log_and_the_robot_calibrated_from_it(tmp_path):
    env = dict(os.environ) | {"XDG_STATE_HOME": str(tmp_path / "state")}

    def run(*words):
        done = fieldhand(*words, cwd=tmp_path, env=env)
        assert done.status == 0, done.err
        return done.out

    run("run", REQUEST, "--site", "demo", "--planner", "english", "--seed", "3", "-y", "--confirm", "-o", "out")
    assert [p.name for p in (tmp_path / "state").rglob("*.sqlite")] == ["husky.sqlite"]
    again = ("report", "out/events.jsonl", "--task", "out/task.xml", "--site", "demo", "-o", "again", "--json")
    assert json.loads(run(*again))["status"] == "completed"
    for name in ("observations.csv", "observations.geojson"):
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "out" / name).read_bytes()
    assert "must be approved again" in run("robot", "calibrate", "husky", "--simulated", "-o", "new.yaml")
    assert json.loads(run("robot", "new.yaml", "--json"))["name"] == "husky"
    refused = fieldhand("robot", "calibrate", cwd=tmp_path, env=env)
    assert refused.status == 2
    assert "no driven missions of husky were kept (1 simulated ones are: --simulated takes them)" in refused.err


def test_nothing_is_kept_of_a_mission_where_that_is_not_wanted(tmp_path):
    env = dict(os.environ) | {"XDG_STATE_HOME": str(tmp_path)}
    words = ("run", "Take a picture of the middle tree.", "--site", "demo", "--planner", "english", "--yes")
    assert fieldhand(*words, "--no-history", env=env).status == 0
    assert not list(tmp_path.rglob("*.sqlite"))
