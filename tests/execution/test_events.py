"""Events are watched while the robot drives, works and waits; each occurrence causes its response once."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from execution.journalled import Cut, PowerCut
from fieldhand.clock import SimulatedClock
from fieldhand.evaluation.outcome import judge
from fieldhand.execution import mission_clock
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import ScriptedEvent, TreeRef, World
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.journal import store
from fieldhand.execution.journal.store import create
from fieldhand.execution.mission_runner import Result, run
from fieldhand.places.selectors import Rows, TreeIs, Trees
from fieldhand.task.frames import Task
from fieldhand.task.plan import Act, ForEach, GoTo, InOrder
from fieldhand.task.results import (
    Acted,
    Arrived,
    Driving,
    Ended,
    EventBegan,
    EventEnded,
    Exited,
    Shed,
    Waited,
)
from fieldhand.task.watches import ReadingBeyond, Watch
from support.missions.rig import Rig, authorized, captured, of_type, orchard
from support.missions.watched import watch, watchful, watching, windy

PLAN = ForEach(select=Trees(), body=Act(action="read_co2"))
#: The seconds that the robot needs for the plan without events.
CLEAR_S = watchful().event["person_near"].clear_s


def flown(task: Task, *scripted: ScriptedEvent, seed: int = 0) -> Result:
    """Carry a Task out in a world with these events."""
    return Rig(robot=watchful(), world=World(events=scripted), seed=seed).fly(task)


def outcome(task: Task, result: Result) -> tuple[str, int, str]:
    (one,) = judge(task, result.events)
    return one.outcome, one.done, one.why


def test_waits_until_it_is_over_and_goes_on():
    result = flown(watching(PLAN, watch("rain", "wait")), ScriptedEvent(event="rain", from_s=60, until_s=300))
    assert result.status == "completed"
    assert len(captured(result.events)) == 20
    (began,), (ended,), (waited,) = (of_type(result.events, kind) for kind in (EventBegan, EventEnded, Waited))
    assert (began.name, began.response, began.value) == ("rain", "wait", 1.0)
    assert 60 <= began.t <= 61
    assert waited.over
    assert waited.seconds == pytest.approx(240 + CLEAR_S, abs=2)
    assert ended.seconds == pytest.approx(240, abs=2)


def test_turns_home_and_says_what_it_gave_up():
    task = watching(PLAN, watch("rain", "return_to_end"))
    result = flown(task, ScriptedEvent(event="rain", from_s=60))
    assert result.status == "returned"
    assert result.reason == "it rains"
    (exited,) = of_type(result.events, Exited)
    assert exited.then == "return_to_end"
    shed = of_type(result.events, Shed)
    assert {e.cause for e in shed} == {"event"}
    assert len({p for e in shed for p in e.places} | {p for _, p in captured(result.events)}) == 20
    assert outcome(task, result)[0] == "failure"


def test_ends_where_it_is():
    result = flown(watching(PLAN, watch("person_near", "end")), ScriptedEvent(event="person_near", from_s=30))
    assert result.status == "returned"
    (exited,), (began,) = of_type(result.events, Exited), of_type(result.events, EventBegan)
    assert exited.then == "stay"
    assert not [e for e in result.events if isinstance(e, Driving) and e.t > began.t]


def test_leaves_out_the_visit_and_goes_on():
    task = watching(PLAN, watch("gate_closed", "skip"))
    result = flown(task, ScriptedEvent(event="gate_closed", at=TreeRef(id="r1c2"), within_m=2.0, for_s=2))
    assert result.status == "completed"
    (shed,) = of_type(result.events, Shed)
    assert (shed.cause, shed.optional, len(shed.places)) == ("event", True, 1)
    assert len(captured(result.events)) == 19
    assert outcome(task, result) == ("success", 19, "19 of 19 CO₂ readings; 1 place left out (the gate is closed)")


def test_leaves_out_the_rest_of_the_row():
    plan = ForEach(select=Rows(first="2", last="3"), body=Act(action="read_co2"), order="given")
    task = watching(plan, watch("gate_closed", "skip_row"))
    result = flown(task, ScriptedEvent(event="gate_closed", at=TreeRef(id="r2c2"), within_m=2.0, for_s=2))
    (shed,) = of_type(result.events, Shed)
    assert set(shed.places) == {"r2c2", "r2c3", "r2c4"}
    assert len(captured(result.events)) == 7
    assert outcome(task, result)[:2] == ("success", 7)


def test_a_wait_ends_after_its_maximum():
    lasting = ScriptedEvent(event="rain", from_s=60)
    home = flown(watching(PLAN, watch("rain", "wait", at_most_s=120)), lasting)
    assert (home.status, of_type(home.events, Waited)[0].over) == ("returned", False)
    assert of_type(home.events, Waited)[0].seconds == pytest.approx(120, abs=1)
    on = flown(watching(PLAN, watch("rain", "wait", at_most_s=120, fallback="go_on")), lasting)
    assert (on.status, len(captured(on.events))) == ("completed", 20)
    skip = flown(watching(PLAN, watch("rain", "wait", at_most_s=120, fallback="skip")), lasting)
    assert (skip.status, len(captured(skip.events))) == ("completed", 19)
    end = flown(watching(PLAN, watch("rain", "wait", at_most_s=120, fallback="end")), lasting)
    assert of_type(end.events, Exited)[0].then == "stay"


def test_a_wait_without_a_maximum_has_that_of_the_profile():
    result = flown(watching(PLAN, watch("rain", "wait")), ScriptedEvent(event="rain", from_s=60))
    assert of_type(result.events, Waited)[0].seconds == pytest.approx(watchful().patience.event_wait_s, abs=1)
    assert result.status == "returned"


def test_waits_on_the_way_home_too():
    task = watching(GoTo(place=TreeIs(tree="r3c0")), watch("person_near", "wait"))
    free = flown(task)
    (home,) = [e for e in free.events if isinstance(e, Driving) and e.place == "end"]
    result = flown(task, ScriptedEvent(event="person_near", from_s=home.t + 5, until_s=home.t + 65))
    assert result.status == "completed"
    assert result.spent.seconds == pytest.approx(free.spent.seconds + 60 + CLEAR_S, abs=2)


def test_going_home_beats_waiting():
    task = watching(PLAN, watch("person_near", "wait"), watch("rain", "return_to_end"))
    result = flown(
        task,
        ScriptedEvent(event="person_near", from_s=30, until_s=90),
        ScriptedEvent(event="rain", from_s=40, until_s=50),
    )
    assert result.status == "returned"
    (exited,) = of_type(result.events, Exited)
    assert exited.t < 50
    # It still waits for the person before it drives.
    assert not [e for e in result.events if isinstance(e, Driving) and 31 < e.t < 90]


def test_a_measured_event_has_the_limit_of_the_task_or_the_profile():
    gust = ScriptedEvent(event="wind", value=7.5, from_s=60, until_s=120)
    assert of_type(flown(watching(PLAN, windy(5.0, "wait")), gust).events, Waited)
    assert not of_type(flown(watching(PLAN, windy(8.0, "wait")), gust).events, Waited)
    assert not of_type(flown(watching(PLAN, watch("wind", "wait")), gust).events, Waited)
    assert of_type(flown(watching(PLAN, watch("wind", "wait")), replace(gust, value=9.0)).events, Waited)


def test_a_silent_sensor_counts_as_its_profile_says():
    silent = [ScriptedEvent(event=name, silent=True, from_s=60, until_s=90) for name in ("person_near", "rain")]
    assert not of_type(flown(watching(PLAN, watch("rain", "wait")), *silent).events, Waited)
    (began,) = of_type(flown(watching(PLAN, watch("person_near", "wait")), *silent).events, EventBegan)
    assert began.value is None
    assert began.what == "someone is near, or its sensor is silent"


def test_a_reading_over_its_limit_turns_home():
    limit = Watch(condition=ReadingBeyond(quantity="co2", test="gt", value=100.0, unit="ppm"), response="return_to_end")
    result = flown(watching(PLAN, limit))
    assert len(captured(result.events)) == 1
    assert result.status == "returned"


def test_an_event_with_a_chance_depends_on_the_seed_alone():
    task = watching(PLAN, watch("rain", "wait"))
    shower = ScriptedEvent(event="rain", chance=0.3, every_s=60, for_s=20)
    began = [[e.t for e in of_type(flown(task, shower, seed=s).events, EventBegan)] for s in (1, 1, 2)]
    assert began[0] == began[1] != began[2]
    assert began[0]


@settings(max_examples=60, deadline=None)
@given(
    spans=st.lists(st.tuples(st.floats(0, 400), st.floats(1, 120)), min_size=1, max_size=4),
    response=st.sampled_from(["wait", "skip", "skip_row"]),
    steps=st.booleans(),
    seed=st.integers(0, 5),
)
def test_nothing_begins_while_it_holds(spans, response, steps, seed):
    """No drive or capture begins during a wait, and no capture during an event that leaves out visits."""
    body = (
        InOrder(steps=(Act(action="read_co2"), Act(action="take_thermal_picture"))) if steps else Act(action="read_co2")
    )
    task = watching(ForEach(select=Trees(), body=body), watch("person_near", response))
    scripted = [ScriptedEvent(event="person_near", from_s=at, until_s=at + for_s) for at, for_s in spans]
    result = flown(task, *scripted, seed=seed)
    assert isinstance(result.events[-1], Ended)
    began = of_type(result.events, EventBegan)
    ended = of_type(result.events, EventEnded)
    for one in began:
        over = min((e.t for e in ended if e.t >= one.t), default=result.events[-1].t)
        duration = {a.name: a.duration_s for a in watchful().actions}
        for event in result.events:
            if isinstance(event, Driving) and response == "wait":
                assert not one.t + 1e-6 < event.t < over - 1e-6
            if isinstance(event, Acted):
                assert not one.t + 1e-6 < event.t - duration[event.action] < over - 1e-6
    # Every place is either worked on or named as left out, and the replay of the log agrees.
    shed = [p for e in of_type(result.events, Shed) for p in e.places]
    assert len(shed) == len(set(shed))
    for one in judge(task, result.events):
        assert one.outcome == "success"
        assert one.done == one.wanted
    assert {e.place for e in of_type(result.events, Acted)} | set(shed) == {t.place.id for t in orchard().trees}
    assert len(of_type(result.events, Arrived)) >= 1


def flown_with_a_journal(folder: Path, *, cut: int = 0, behind: bool = False) -> Result:
    """Carry a mission that waits and skips out, or what is left of it."""
    task = watching(PLAN, watch("rain", "wait", at_most_s=90, fallback="go_on"), watch("person_near", "skip"))
    world = World(
        events=(
            ScriptedEvent(event="rain", from_s=40, until_s=100),
            ScriptedEvent(event="rain", at=TreeRef(id="r1c2"), within_m=3.0, for_s=30),
            ScriptedEvent(event="person_near", at=TreeRef(id="r2c2"), within_m=3.0, for_s=20),
        )
    )
    clock = mission_clock.MissionClock(SimulatedClock())
    with Cut(folder / "journal.sqlite", "mission", folder / "log", lambda line: None) as journal:
        journal.at, journal.behind = cut, behind
        return run(
            authorized(task, orchard(), watchful()),
            site=orchard(),
            robot=watchful(),
            driver=SimulatedDriver(orchard(), watchful(), world, clock, np.random.default_rng(2)),
            guard=NoGuard(),
            clock=clock,
            emit=lambda event: None,
            log=journal,
            simulated=True,
        )


def test_cut_at_every_commit_it_goes_on_as_it_would_have_gone(tmp_path, monkeypatch):
    """Also in the middle of a wait, and of an event that began when the robot came to a tree."""
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    monkeypatch.setattr(mission_clock.time, "sleep", lambda seconds: None)

    def began_in(folder: Path) -> Path:
        folder.mkdir()
        create(folder / "journal.sqlite", "mission")
        return folder

    def told(result: Result) -> list[tuple[str, int]]:
        found = [e for e in result.events if isinstance(e, EventBegan | EventEnded)]
        return [(type(e).__name__, e.watch) for e in found]

    whole = flown_with_a_journal(began_in(tmp_path / "whole"))
    assert len(of_type(whole.events, Waited)) == 2
    assert of_type(whole.events, Shed)
    for n in count(1, 3):
        folder, done = began_in(tmp_path / f"{n}"), False
        try:
            flown_with_a_journal(folder, cut=n)
            done = True
        except PowerCut:
            resumed = flown_with_a_journal(folder)
            assert told(resumed) == told(whole)
            assert sorted(captured(resumed.events)) == sorted(captured(whole.events))
        if done:
            break
