"""Battery, distance and time are watched while the robot drives and works: each crossing once, acted on at once."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.evaluation.battery_drain import BatteryDrain
from fieldhand.evaluation.failsafe import BudgetFailsafe
from fieldhand.execution.drivers.simulation.world import BatteryDrains, World
from fieldhand.forecast.mission_state import Spent
from fieldhand.language import open_language
from fieldhand.places.selectors import TreeIs, Trees
from fieldhand.robot.model import RobotProfile
from fieldhand.site.drives import Drives
from fieldhand.site.stopping import CLEAR_M, safe_stop
from fieldhand.task.frames import Budget, Constraints, FaultedExit
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, Driving, Ended, Event, Exited, LimitCrossed, Shed, Started
from fieldhand.wording.events import EventText
from fieldhand.wording.limits import say_crossing
from support.missions.rig import Rig, husky, of_type, orchard, task_for

PLAN = ForEach(id="", select=Trees(), body=Act(id="", action="read_co2"))


def small_battery(share: float, reserve: float = 20.0) -> RobotProfile:
    robot = husky()
    energy = replace(robot.energy, capacity_j=share * robot.energy.capacity_j, reserve_percent=reserve)
    return replace(robot, energy=energy)


def crossed(events: tuple[Event, ...]) -> list[tuple[str, str]]:
    return [(e.quantity, e.level) for e in of_type(events, LimitCrossed)]


def end(events: tuple[Event, ...]) -> Ended:
    last = events[-1]
    assert isinstance(last, Ended)
    return last


@settings(max_examples=25, deadline=None)
@given(
    factor=st.floats(1.0, 15.0),
    begins=st.floats(0.0, 120.0),
    charge=st.floats(21.0, 100.0),
    step=st.sampled_from([0.0, 1.0]),
    share=st.floats(0.05, 0.4),
)
def test_every_level_is_said_once_in_order_and_before_anything_else_shows_it(factor, begins, charge, step, share):
    """Without a guard: the watch alone keeps the robot from going on below its return level."""
    robot = small_battery(share)
    world = World(
        charge_percent=charge,
        meter_step_percent=step,
        faults=(BatteryDrains(factor=factor, from_s=begins),),
    )
    events = Rig(robot=robot, world=world).fly(task_for(PLAN)).events
    levels = {"warn": 30.0, "return": 20.0, "reserve": 20.0, "stop": 10.0}
    said: list[str] = []
    for event in events:
        if isinstance(event, LimitCrossed):
            assert event.level not in said
            said.append(event.level)
        read = getattr(event, "charge_percent", 100.0)
        if not isinstance(event, LimitCrossed | Started):
            assert all(level in said for level, at in levels.items() if read < at - 1e-6), (event, said)
    assert said == [level for level in ("warn", "return", "reserve", "stop") if level in said]
    if "return" in said:
        turned = next(k for k, e in enumerate(events) if isinstance(e, LimitCrossed) and e.level == "return")
        assert not of_type(events[turned:], Acted)
        assert all(e.kind != "tree" for e in of_type(events[turned:], Driving))
    if "stop" in said:
        assert end(events).status == "faulted"
        assert "stop level" in end(events).reason
        stopped = next(e for e in of_type(events, LimitCrossed) if e.level == "stop")
        assert stopped.then == "stop"
        assert math.isclose(stopped.travelled_m, end(events).travelled_m, abs_tol=0.01)
    if end(events).charge_percent < 20.0 - 1e-6:
        assert end(events).status in ("exceeded", "faulted")


@pytest.mark.parametrize(("kind", "limit"), [("distance_m", 60.0), ("duration_s", 90.0), ("energy_percent", 2.0)])
def test_a_limit_that_is_crossed_on_a_drive_turns_the_robot_home_at_once(kind, limit):
    budget = Budget(kind=kind, limit=limit)
    task = task_for(PLAN, constraints=Constraints(budgets=(budget,)))
    result = Rig(robot=small_battery(0.3)).fly(task)
    (event,) = of_type(result.events, LimitCrossed)
    assert (event.quantity, event.level, event.then) == (kind, "limit", "return")
    assert limit <= event.value < 1.2 * limit
    (left,) = of_type(result.events, Exited)
    assert (left.exit, left.then, left.t) == ("faulted", "return_to_end", event.t)
    assert result.status == "exceeded"
    named = {place for e in of_type(result.events, Shed) for place in e.places}
    made = {e.place for e in of_type(result.events, Acted)}
    assert named | made == {tree.place.id for tree in orchard().trees}
    assert not named & made


@pytest.mark.parametrize("low_budget", ["stay", "return_to_start"])
def test_a_mission_with_an_open_end_drives_no_way_home_when_its_limit_is_reached(low_budget):
    budget = Budget(kind="distance_m", limit=60.0)
    task = task_for(
        PLAN,
        nominal="stay",
        constraints=Constraints(budgets=(budget,)),
        faulted=(FaultedExit(fault="low_budget", then=low_budget),),
    )
    result = Rig(robot=small_battery(0.3)).fly(task)
    (event,) = of_type(result.events, LimitCrossed)
    assert (event.level, event.then) == ("limit", "end")
    assert of_type(result.events, Exited)[-1].then == "stay"
    assert end(result.events).travelled_m < 1.2 * 60.0


def flown_with_lookout(world: World, robot: RobotProfile, tree: str = "r3c4") -> tuple[Event, ...]:
    """One mandatory capture far away, without a guard: only the failsafe foresees the way home."""
    from fieldhand.clock import SimulatedClock
    from fieldhand.execution.guard import NoGuard
    from fieldhand.execution.mission_runner import run
    from support.missions.rig import authorized

    task = task_for(Act(id="", action="read_co2", at=TreeIs(tree=tree)), nominal="return_to_start")
    task = replace(
        task,
        composition=replace(
            task.composition,
            faulted=tuple(replace(f, then="return_to_start") for f in task.composition.faulted),
        ),
    )
    rig = Rig(robot=robot, world=world, clock=SimulatedClock())
    return run(
        authorized(task, rig.site, robot),
        site=rig.site,
        robot=robot,
        driver=rig.driver(),
        guard=NoGuard(),
        clock=rig.clock,
        emit=lambda event: None,
        failsafe=BudgetFailsafe(task, robot, BatteryDrain(robot)),
    ).events


def test_a_battery_that_goes_bad_on_a_long_drive_brings_the_robot_home_with_its_reserve():
    robot = small_battery(0.12)
    events = flown_with_lookout(World(charge_percent=36.0, faults=(BatteryDrains(factor=4.0),)), robot)
    foreseen = next(e for e in of_type(events, LimitCrossed) if e.level == "way_home")
    assert foreseen.then == "return"
    assert foreseen.value > foreseen.threshold > 0.0
    assert end(events).status == "returned"
    assert end(events).charge_percent >= 20.0
    assert "the way home takes" in end(events).reason
    # The same battery as its model says: the drive is made.
    assert end(flown_with_lookout(World(charge_percent=36.0), robot)).status == "completed"


def test_where_home_is_out_of_reach_the_robot_stops_in_an_aisle_while_there_is_charge():
    robot = small_battery(0.05, reserve=10.0)
    world = World(charge_percent=60.0, faults=(BatteryDrains(factor=15.0, from_s=30.0),))
    events = flown_with_lookout(world, robot)
    levels = [level for _, level in crossed(events)]
    assert "out_of_reach" in levels
    assert end(events).status == "faulted"
    assert "it stands in" in end(events).reason
    assert end(events).charge_percent > 4.0


def test_a_safe_place_is_inside_an_aisle_clear_of_its_ends():
    site, robot = orchard(), husky()
    drives = Drives(site, robot.width_m / 2.0, robot.standoff_m)
    way = drives.between(site.by_id["r2c2"].place, site.markers["end"])
    metres = safe_stop(drives, way, 8.0)
    assert metres is not None
    at = way.at(metres)
    assert drives.layout.aisle(at) is not None
    entries = np.concatenate([aisle.entries for aisle in drives.layout.aisles.all])
    assert all(math.dist(at, entry) >= CLEAR_M for entry in entries.tolist())
    # As far as the charge lasts, and nothing beyond.
    assert 0.0 <= metres <= 8.0
    assert safe_stop(drives, way, way.length_m) == pytest.approx(way.length_m)  # at the marker itself


@settings(max_examples=40, deadline=None)
@given(factor=st.floats(1.0, 15.0), start=st.floats(30.0, 100.0), coarse=st.booleans())
def test_the_drain_is_found_from_a_few_percent_and_never_made_up(factor, start, coarse):
    robot, drain = husky(), BatteryDrain(husky())
    by_model = robot.percent(1.0, 1.0)
    full = round(start) if coarse else start
    for metres in range(1, 2000):
        spent = factor * by_model * metres
        left = round(start - spent) if coarse else start - spent
        drain.learn(Spent(metres=float(metres), seconds=float(metres), percent=full - left))
        assert drain.factor <= 1.0 + 1.1 * (factor - 1.0) + 1e-6 or coarse
        if spent >= 20.0:
            break
    assert drain.factor >= 1.0 + 0.75 * (factor - 1.0) - 0.1
    if factor == 1.0:
        assert drain.factor <= 1.1


def test_crossings_are_told_in_both_languages():
    for event in (
        LimitCrossed(
            t=60.0, quantity=quantity, level=level, value=24.5, threshold=25.0, then=then, lat=0, lon=0,
            travelled_m=10.0, charge_percent=24.5, cleared=cleared,
        )
        for quantity, level, then, cleared in (
            ("charge_percent", "warn", "go_on", False),
            ("charge_percent", "return", "return", False),
            ("charge_percent", "stop", "stop", False),
            ("charge_percent", "reserve", "go_on", False),
            ("charge_percent", "way_home", "return", False),
            ("charge_percent", "out_of_reach", "stop", False),
            ("charge_percent", "costly_drive", "return", False),
            ("distance_m", "way_home", "return", False),
            ("duration_s", "way_home", "return", False),
            ("energy_percent", "way_home", "return", False),
            ("distance_m", "limit", "return", False),
            ("duration_s", "limit", "go_on", False),
            ("energy_percent", "limit", "return", False),
            ("charge_percent", "warn", "go_on", True),
        )
    ):  # fmt: skip
        english = say_crossing(event)
        assert "24.5" in english
        spanish = open_language("es").say(english)
        assert "24,5" in spanish
        assert spanish != english
        assert english in (EventText(husky()).line(event) or "")


def test_the_page_names_every_level():
    page = (Path(__file__).resolve().parents[2] / "docs" / "formats.md").read_text()
    for level in ("warn", "return", "stop", "reserve", "limit", "way_home", "out_of_reach", "costly_drive"):
        assert f"`{level}`" in page
