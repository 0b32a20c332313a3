"""Readings of a mission as series: collected as they are taken, decided on, and kept across a power cut."""

from __future__ import annotations

from itertools import count
from pathlib import Path
from statistics import fmean

import pytest

from execution.journalled import Field, PowerCut
from fieldhand.evaluation.log_replay import replay_log
from fieldhand.execution import mission_clock
from fieldhand.execution.drivers.simulation.world import ActionFails, TreeRef, World
from fieldhand.execution.journal import store
from fieldhand.places.selectors import ByReading, TreeIs, UnionOf
from fieldhand.task.aggregates import Aggregate, CountReadings
from fieldhand.task.conditions import Compare
from fieldhand.task.plan import Act, ForEach, If, InOrder, Node, Repeat, Try
from fieldhand.task.results import Acted, Arrived, Decided
from support.missions.rig import Rig, captured, of_type, task_for

PICTURE, TREES = "take_thermal_picture", ("r0c0", "r0c2", "r1c1", "r2c3", "r3c0")
EACH = UnionOf(parts=tuple(TreeIs(tree=tree) for tree in TREES))


def warmer(value: float) -> Compare:
    return Compare(reading="t", quantity="canopy_temperature", test="gt", value=value, unit="degC")


def plan(body: Node, value: float = 32.0) -> InOrder:
    return InOrder(
        id="",
        steps=(
            ForEach(id="", select=EACH, body=body),
            If(
                id="",
                condition=Aggregate(of="mean", condition=warmer(value)),
                then=Act(id="", action="read_co2"),
                otherwise=Act(id="", action="read_ambient_temperature"),
            ),
            Act(id="", action=PICTURE, at=ByReading(reading="t", quantity="canopy_temperature")),
        ),
    )


SHOT = Act(id="", action=PICTURE, count=2, reading="t")


def test_a_mean_and_the_hottest_place_are_those_of_all_captures() -> None:
    events = Rig(seed=4).fly(plan(SHOT)).events
    taken = [e for e in of_type(events, Acted) if e.status == "success" and e.action == PICTURE][:10]
    values = [e.readings["canopy_temperature"] for e in taken]
    (decided,) = of_type(events, Decided)
    assert decided.holds == (fmean(values) > 32.0)
    assert f"mean canopy temperature (of {len(values)})" in decided.why
    means = {tree: fmean(e.readings["canopy_temperature"] for e in taken if e.place == tree) for tree in TREES}
    assert of_type(events, Arrived)[-2].place == max(means, key=lambda tree: means[tree])


def test_failed_readings_are_left_out() -> None:
    world = World(faults=tuple(ActionFails(action=PICTURE, at=TreeRef(id=tree)) for tree in TREES[1:]))
    tried = Try(id="", body=SHOT, otherwise=Act(id="", action="read_co2"))
    events = Rig(world=world).fly(plan(tried)).events
    assert "(of 2)" in of_type(events, Decided)[0].why
    assert of_type(events, Acted)[-1].place == TREES[0]


def test_without_any_reading_the_condition_does_not_hold() -> None:
    world = World(faults=(ActionFails(action=PICTURE, at=TreeRef(id=TREES[0])),))
    tried = Try(id="", body=SHOT, otherwise=Act(id="", action="read_co2"))
    above = If(
        id="",
        condition=CountReadings(test="eq", number=0.0, condition=warmer(0.0)),
        then=Act(id="", action="read_ambient_temperature"),
    )
    whole = InOrder(id="", steps=(ForEach(id="", select=TreeIs(tree=TREES[0]), body=tried), above))
    events = Rig(world=world).fly(whole).events
    assert [(e.holds, e.why) for e in of_type(events, Decided)] == [
        (False, "there is no reading of canopy temperature")
    ]


def test_a_loop_that_collects_begins_anew_each_time() -> None:
    inner = Repeat(id="", times=2, body=Act(id="", action=PICTURE, reading="t"), collects="t")
    test = If(id="", condition=Aggregate(of="mean", condition=warmer(0.0)), then=Act(id="", action="read_co2"))
    whole = ForEach(id="", select=EACH, body=InOrder(id="", steps=(inner, test)))
    events = Rig().fly(whole).events
    assert [e.why.partition(", ")[0] for e in of_type(events, Decided)] == ["mean canopy temperature (of 2)"] * 5


def test_cut_at_every_commit_the_series_is_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    monkeypatch.setattr(mission_clock.time, "sleep", lambda seconds: None)
    short = plan(Act(id="", action=PICTURE, reading="t"))
    whole = Field(tmp_path / "whole").fly(short)
    for n in count(2, 3):
        field, done = Field(tmp_path / f"{n}", outlives=True), False
        try:
            field.fly(short, cut=n)
            done = True
        except PowerCut:
            pass
        result = field.fly(short)
        assert captured(result.events) == captured(whole.events)
        assert [e.holds for e in of_type(result.events, Decided)] == [e.holds for e in of_type(whole.events, Decided)]
        assert "(of 5)" in of_type(result.events, Decided)[0].why
        if done:
            break
    assert n > 8


def test_a_replay_takes_the_branch_of_the_log() -> None:
    for value in (0.0, 60.0):
        task = task_for(plan(SHOT, value))
        counts = replay_log(task.composition.plan, Rig().fly(task).events)
        made = {name: count.done for name, count in counts.items()}
        assert sorted(made.values()) == [0, 1, 1, 10]
        branch = next(node for node in task.composition.plan.children if node.is_choice)
        assert [made[child.id] for child in branch.children] == ([1, 0] if value == 0.0 else [0, 1])
