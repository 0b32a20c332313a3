"""Nothing runs that nobody approved; what runs is told as it happened, the same for the same seed."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any

import pytest

from fieldhand import mission
from fieldhand.api.work import Limits
from fieldhand.planning.planner import Reason, Refused
from fieldhand.robot.loader import load_robot
from fieldhand.task.event_lines import from_json
from support.processes.browser import Says, browser, corner_warnings, corner_xml

XML = corner_xml()


def run(**body: Any) -> dict[str, Any]:
    whole = {"xml": XML, "approved_by": "Ana", "confirmed": corner_warnings(), "seed": 3, **body}
    answer = browser().post("/api/run", whole)
    assert answer.status_code == 200, answer.text
    result: dict[str, Any] = answer.json()
    return result


@pytest.fixture(scope="module")
def done() -> dict[str, Any]:
    return run()


@pytest.mark.parametrize("name", [None, "", "   ", 7, "x" * 101, "a\nb"])
def test_nothing_unapproved_runs(name: object, monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[object] = []
    monkeypatch.setattr(mission, "carry_out", lambda *a, **k: started.append(a))
    body = {"xml": XML} if name is None else {"xml": XML, "approved_by": name}
    answer = browser().post("/api/run", body)
    assert answer.status_code == 422
    assert not started


def test_who_approved_stands_in_the_answer(done: dict[str, Any]) -> None:
    assert done["authorization"]["by"] == "Ana"
    assert done["authorization"]["robot_sha256"] == load_robot("husky").sha256


def test_the_same_seed_is_the_same_mission_and_another_is_not(done: dict[str, Any]) -> None:
    assert run(approved_by="Bob")["events"] == done["events"]
    assert run(seed=4)["events"] != done["events"]


def test_events_are_those_of_an_event_log(done: dict[str, Any]) -> None:
    events = [from_json(json.dumps(event)) for event in done["events"]]
    assert None not in events
    assert len(done["told"]) == len(events)
    assert any("at tree" in words for words in done["told"])


def test_the_path_is_driven_without_a_gap_until_the_end(done: dict[str, Any]) -> None:
    features = done["map"]["features"]
    legs = [f for f in features if f["properties"]["role"] == "leg"]
    for one, other in pairwise(legs):
        assert one["geometry"]["coordinates"][-1] == pytest.approx(other["geometry"]["coordinates"][0], abs=2e-7)
        assert one["properties"]["t"] <= one["properties"]["until"] <= other["properties"]["t"]
    (end,) = [f for f in features if f["properties"]["role"] == "end"]
    assert legs[-1]["geometry"]["coordinates"][-1] == pytest.approx(end["geometry"]["coordinates"], abs=2e-7)


def test_each_goal_is_said_and_judged(done: dict[str, Any]) -> None:
    assert done["goals"]
    for goal in done["goals"]:
        assert goal["outcome"] in ("success", "failure", "indeterminate")
        assert goal["name"]
        assert goal["node"]


def test_the_world_says_what_sensors_read() -> None:
    hot = run(world={"readings": {"canopy_temperature": {"default": 39.5}}})
    readings = [f["properties"]["readings"] for f in hot["map"]["features"] if f["properties"]["role"] == "capture"]
    assert readings
    assert all(reading["canopy_temperature"] == 39.5 for reading in readings)


def test_a_fault_of_the_world_is_a_failure_that_is_told() -> None:
    broken = run(world={"faults": [{"fault": "action_fails", "action": "take_thermal_picture"}]})
    assert not broken["success"]
    assert any(goal["outcome"] != "success" for goal in broken["goals"])


def test_a_mission_that_is_cut_off_says_so_and_its_path_ends_where_it_stands() -> None:
    web = browser(limits=Limits(run_s=0.0))
    cut = web.post("/api/run", {"xml": XML, "approved_by": "Ana", "confirmed": corner_warnings()}).json()
    assert cut["status"] == "aborted"
    assert "longer than" in cut["reason"]
    assert not cut["success"]


def test_a_request_is_planned_and_run(done: dict[str, Any]) -> None:
    # Another request is another Task, but this planner gives the same plan.
    body = {"request": "corners", "approved_by": "Ana", "confirmed": corner_warnings(), "seed": 3}
    assert browser().post("/api/run", body).json()["events"] == done["events"]


@pytest.mark.parametrize("what", [{"xml": XML}, {"request": "corners"}], ids=["document", "request"])
def test_a_warning_that_is_not_confirmed_stops_it_and_is_said(
    what: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[object] = []
    monkeypatch.setattr(mission, "carry_out", lambda *a, **k: started.append(a))
    first, *others = corner_warnings()
    for confirmed, left in (([], [first, *others]), ([first], others), (["all of them"], [first, *others])):
        answer = browser().post("/api/run", {**what, "approved_by": "Ana", "confirmed": confirmed})
        assert answer.status_code == 422
        assert answer.json()["warnings"] == left
        assert first in answer.json()["what"] or confirmed == [first]
    assert not started


def test_what_was_confirmed_stands_in_the_answer(done: dict[str, Any]) -> None:
    assert done["authorization"]["confirmed"] == list(corner_warnings())


def test_a_request_that_is_refused_runs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[object] = []
    monkeypatch.setattr(mission, "carry_out", lambda *a, **k: started.append(a))
    refuses = Says(outcome=lambda r, s, p: Refused(reasons=(Reason(what="no"),)))
    answer = browser(refuses).post("/api/run", {"request": "dance", "approved_by": "Ana"})
    assert answer.json()["outcome"] == "refused"
    assert not started


def test_a_task_for_another_robot_is_not_run() -> None:
    answer = browser().post("/api/run", {"xml": XML, "robot": "amiga", "approved_by": "Ana"})
    assert answer.status_code in (400, 422)
    assert answer.json()["what"]


@pytest.mark.parametrize(
    "more",
    [
        {"request": "corners"},
        {"xml": None},
        {"seed": -1},
        {"seed": 2**32},
        {"seed": "many"},
        {"speed": 1},
        {"world": []},
        {"confirmed": True},
        {"confirmed": [7]},
    ],
)
def test_a_fault_of_shape_is_said(more: dict[str, Any]) -> None:
    answer = browser().post("/api/run", {"xml": XML, "approved_by": "Ana", **more})
    assert answer.status_code == 422
    assert answer.json()["what"]


def test_a_world_that_is_none_is_said() -> None:
    answer = browser().post("/api/run", {"xml": XML, "approved_by": "Ana", "world": {"reading": {}}})
    assert answer.status_code == 400
    assert "reading" in answer.json()["what"] + answer.json()["where"]


def test_a_run_is_told_in_the_language_asked_for() -> None:
    body = {"xml": corner_xml(), "approved_by": "Ana", "lang": "es"}
    warnings = browser().post("/api/check", {"xml": corner_xml(), "lang": "es"}).json()["warnings"]
    spanish = browser().post("/api/run", {**body, "confirmed": warnings}).json()
    english = browser().post("/api/run", {**body, "lang": "en", "confirmed": list(corner_warnings())}).json()
    assert spanish["told"] != english["told"]
    assert any("árbol" in line for line in spanish["told"])
    assert [goal["outcome"] for goal in spanish["goals"]] == [goal["outcome"] for goal in english["goals"]]
    assert spanish["goals"][0]["why"] != english["goals"][0]["why"]
    assert spanish["events"] == english["events"]
