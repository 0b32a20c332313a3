"""Whole missions: what is refused, which exit follows from what, what the budget guard does, and that seeds decide.

Longer than other files: whole missions on one small site, told one after the other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from fieldhand.clock import Clock, ScaledClock
from fieldhand.errors import NotApprovedError, OutputError
from fieldhand.execution.drivers.protocol import DriveGoal
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    Blocked,
    DriveFails,
    RobotStops,
    SensorAbsurd,
    SensorSilent,
    TreeRef,
    World,
)
from fieldhand.execution.mission_runner import run
from fieldhand.forecast.mission_state import MissionState, Verdict, Visit, VisitChoice
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Half, TreeIs, Trees, UnionOf
from fieldhand.task.conditions import Compare
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import Constraints, FaultedExit
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, Node, Repeat, StopMission, Try
from fieldhand.task.plan import InOrder as Steps
from fieldhand.task.results import (
    Acted,
    Arrived,
    Driving,
    Ended,
    Event,
    Exited,
    Faulted,
    Shed,
    Started,
    Waited,
)
from support.missions.rig import BudgetOf, Rig, authorized, captured, husky, of_type, orchard, task_for

PICTURE, CO2 = "take_thermal_picture", "read_co2"
SITE = orchard()
NEVER_READ = Compare(reading="r", quantity="co2", test="lt", value=1, unit="ppm")


def act(action: str = PICTURE, at: str = "", **more: object) -> Act:
    return Act(id="", action=action, at=TreeIs(tree=at) if at else None, **more)


def seq(*steps: Node) -> Steps:
    return Steps(id="", steps=steps)


def each(*names: str, body: Node | None = None, **more: object) -> ForEach:
    select: Selector = UnionOf(parts=tuple(TreeIs(tree=n) for n in names))
    return ForEach(id="", select=select, body=body or act(), order="given", **more)


def end_of(events: Sequence[Event]) -> Ended:
    (ended,) = of_type(events, Ended)
    assert events[-1] is ended
    return ended


def at(event: Ended | Arrived, place: str) -> bool:
    """Return True if the robot stands at a marker, or beside a tree at its standoff."""
    spot = SITE.markers.get(place) or SITE.by_id[place].place
    away = math.dist(SITE.projection.metres(event.lat, event.lon)[0], spot.xy)
    return abs(away - (husky().standoff_m if spot.kind == "tree" else 0.0)) < 0.01


# --- authorization ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("other", ["site", "robot"])
def test_another_site_or_profile_than_approved_is_refused_before_anything_happens(other: str) -> None:
    rig, events = Rig(), []
    approved = authorized(task_for(act(at="r0c0")), rig.site, rig.robot)
    site = replace(rig.site, sha256="other") if other == "site" else rig.site
    robot = replace(rig.robot, sha256="other") if other == "robot" else rig.robot
    with pytest.raises(NotApprovedError, match=f"{other}.*is not the one that was approved.*approve the Task again"):
        run(
            approved,
            site=site,
            robot=robot,
            driver=rig.driver(),
            guard=rig.guard,
            clock=rig.clock,
            emit=events.append,
        )
    assert events == []


# --- the course of a mission -----------------------------------------------------------------------------------------


def test_a_mission_begins_with_started_and_ends_at_the_end_marker() -> None:
    events: list[Event] = []
    result = Rig(world=World(charge_percent=90), seed=5).fly(act(at="r0c0"), emit=events.append)
    started = events[0]
    assert isinstance(started, Started)
    assert (started.robot, started.site, started.seed, started.charge_percent) == ("husky", "grid", 5, 90)
    assert at(end_of(events), "end")
    assert tuple(events) == result.events
    assert result.status == "completed"
    assert result.reason == ""


@pytest.mark.parametrize("then", ["return_to_end", "return_to_start", "stay"])
def test_the_nominal_exit_goes_where_the_task_says(then: str) -> None:
    result = Rig().fly(task_for(act(at="r0c0"), nominal=then))
    where = {"return_to_end": "end", "return_to_start": "start", "stay": "r0c0"}[then]
    assert at(end_of(result.events), where)
    (exited,) = of_type(result.events, Exited)
    assert (exited.exit, exited.then) == ("nominal", then)


def test_metres_seconds_and_charge_add_up() -> None:
    rig = Rig(robot=husky(alpha=0.5), seed=9)
    result = rig.fly(seq(act(at="r0c0", count=2), each("r1c1", "r3c3", body=act(CO2)), act(at="r0c4")))
    legs = [e.leg_m for e in of_type(result.events, Arrived)]
    assert of_type(result.events, Arrived)[-1].travelled_m == pytest.approx(sum(legs))
    actions = [rig.robot.action[e.action] for e in of_type(result.events, Acted)]
    seconds = sum(legs) / rig.robot.speed_m_s + sum(a.duration_s for a in actions)
    assert end_of(result.events).t == pytest.approx(seconds)
    percent = rig.robot.percent(sum(legs), seconds, sum(a.energy_j for a in actions))
    assert 100 - end_of(result.events).charge_percent == pytest.approx(percent)
    assert result.spent.percent == pytest.approx(percent)
    assert result.spent.metres == pytest.approx(sum(legs))


def test_time_never_runs_backwards() -> None:
    result = Rig(robot=husky(alpha=0.5)).fly(ForEach(id="", select=Trees(), body=act()))
    assert all(a.t <= b.t for a, b in pairwise(result.events))


def test_a_task_can_ask_for_less_speed() -> None:
    slow = Rig().fly(task_for(act(at="r0c0"), constraints=Constraints(speed_m_s=0.25)))
    fast = Rig().fly(task_for(act(at="r0c0"), constraints=Constraints(speed_m_s=99.0)))
    first = [of_type(r.events, Arrived)[0] for r in (slow, fast)]
    assert [e.t for e in first] == pytest.approx([first[0].leg_m / 0.25, first[1].leg_m / 1.0])


@pytest.mark.parametrize("seed", [0, 1])
def test_the_same_seed_gives_the_same_events(seed: int) -> None:
    def lines(seed: int) -> list[str]:
        rig = Rig(robot=husky(alpha=0.3), seed=seed)
        return [to_json(e) for e in rig.fly(ForEach(id="", select=Half(side="north"), body=act())).events]

    assert lines(seed) == lines(seed)
    assert lines(seed) != lines(seed + 10)


def test_a_clock_that_takes_real_time_gives_the_same_captures() -> None:
    clock: Clock = ScaledClock(speed=5000)
    plan = each("r0c0", "r1c1", "r2c2")
    slow, fast = Rig(clock=clock).fly(plan), Rig().fly(plan)
    assert captured(slow.events) == captured(fast.events)
    assert slow.spent.metres == pytest.approx(fast.spent.metres)


# --- faults ----------------------------------------------------------------------------------------------------------


def test_a_capture_is_tried_again_as_often_as_the_profile_says() -> None:
    rig = Rig(robot=husky(retries=2), world=World(faults=(ActionFails(action=PICTURE, times=2),)))
    result = rig.fly(act(at="r0c0"))
    assert result.status == "completed"
    assert [(e.status, e.attempt) for e in of_type(result.events, Acted)] == [
        ("failed", 1),
        ("failed", 2),
        ("success", 3),
    ]
    assert of_type(result.events, Faulted) == []


def test_an_action_that_fails_for_good_ends_the_mission_at_the_start() -> None:
    rig = Rig(world=World(faults=(ActionFails(action=CO2, at=TreeRef(id="r1c1")),)))
    result = rig.fly(each("r0c0", "r1c1", "r2c2", body=act(CO2)))
    ended = end_of(result.events)
    assert ended.status == "faulted"
    assert ended.reason == "tree r1c1: read_co2 failed 2 times: read_co2 gave an error"
    assert at(ended, "start")
    assert captured(result.events) == [(CO2, "r0c0")]
    (fault,) = of_type(result.events, Faulted)
    assert (fault.fault, fault.handled) == ("action_failed", False)
    (exited,) = of_type(result.events, Exited)
    assert (exited.exit, exited.then) == ("faulted", "return_to_start")


@pytest.mark.parametrize(
    ("fault", "says"),
    [
        (SensorSilent(quantity="co2"), "the sensor gave no co2"),
        (SensorAbsurd(quantity="co2", value=1e6), "co2 1e+06 ppm is outside 200 to 5000 ppm"),
        (SensorAbsurd(quantity="co2", value=math.nan), "co2 nan ppm is outside"),
    ],
)
def test_a_reading_that_cannot_be_believed_is_a_failed_capture(fault: SensorSilent | SensorAbsurd, says: str) -> None:
    result = Rig(world=World(faults=(replace(fault, times=1),))).fly(act(CO2, at="r0c0"))
    failed, done = of_type(result.events, Acted)
    assert (failed.status, done.status) == ("failed", "success")
    assert failed.what.startswith(says.removesuffix(" ppm"))
    assert failed.readings == {}
    assert 200 <= done.readings["co2"] <= 5000


def test_a_tree_out_of_reach_is_left_until_the_others_are_done_and_then_ends_the_mission() -> None:
    rig = Rig(world=World(faults=(Blocked(at=TreeRef(id="r0c2"), within_m=2.0),)))
    result = rig.fly(each("r0c0", "r0c2", "r0c4"))
    ended = end_of(result.events)
    assert ended.status == "faulted"
    assert "something stands in the way at tree r0c2" in ended.reason
    assert [place for _, place in captured(result.events)] == ["r0c0", "r0c4"]
    here = SITE.projection.metres(ended.lat, ended.lon)[0]
    blocked = SITE.by_id["r0c2"].place
    assert math.dist(here, blocked.xy) == pytest.approx(2.0, abs=0.01)


def test_a_drive_is_tried_again_from_where_it_stopped() -> None:
    rig = Rig(world=World(faults=(DriveFails(at=TreeRef(id="r0c2"), times=1),)))
    result = rig.fly(seq(act(at="r0c0"), act(at="r0c2")))
    assert result.status == "completed"
    assert [p for _, p in captured(result.events)] == ["r0c0", "r0c2"]
    drives = of_type(result.events, Driving)
    assert drives[2].planned_m == pytest.approx(drives[1].planned_m / 2)
    (fault,) = of_type(result.events, Faulted)
    assert (fault.fault, fault.handled) == ("drive_failed", True)
    first, second, _, home = (e.planned_m for e in drives)
    assert result.spent.metres == pytest.approx(first + second + home)


def test_a_task_chooses_its_faulted_exits() -> None:
    exits = (FaultedExit(fault="drive_failed", then="return_to_start"),)
    rig = Rig(robot=husky(retries=0), world=World(faults=(DriveFails(at=TreeRef(id="r0c2"), times=1),)))
    result = rig.fly(task_for(each("r0c0", "r0c2"), faulted=exits))
    assert at(end_of(result.events), "start")
    assert result.status == "faulted"


def test_a_place_that_is_not_there_is_a_fault_not_a_traceback() -> None:
    result = Rig().fly(seq(act(at="r0c0"), act(at="oak")))
    assert result.status == "faulted"
    (fault,) = of_type(result.events, Faulted)
    assert (fault.node, fault.fault) == ("n3", "no_place")
    assert "oak" in result.reason
    assert at(end_of(result.events), "start")


def test_a_way_home_that_is_blocked_ends_the_mission_faulted_on_the_way() -> None:
    rig = Rig(world=World(faults=(Blocked(at=TreeRef(id="r0c4"), within_m=7.0),)))
    result = rig.fly(act(at="r0c2"))
    assert captured(result.events) == [(PICTURE, "r0c2")]
    assert result.status == "faulted"
    assert "r0c4" in result.reason
    assert {e.node for e in of_type(result.events, Faulted)} == {""}
    assert [e.wanted for e in of_type(result.events, Waited)] == ["way"]
    assert not at(end_of(result.events), "end")


def test_an_empty_battery_is_a_fault_and_the_mission_still_ends_in_order() -> None:
    # Without a reserve there is no level at which it would stop before.
    robot = replace(husky(), energy=replace(husky().energy, reserve_percent=0.0))
    result = Rig(robot=robot, world=World(charge_percent=0.2)).fly(ForEach(id="", select=Trees(), body=act()))
    ended = end_of(result.events)
    assert ended.status == "faulted"
    assert "the battery is empty" in ended.reason
    assert ended.charge_percent == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("second", [2.0, 7.5, 13.0, 40.0])
def test_a_power_cut_aborts_where_the_robot_stands(second: float) -> None:
    rig = Rig(world=World(faults=(RobotStops(at_s=second, why="power cut"),)))
    result = rig.fly(ForEach(id="", select=Trees(), body=act()))
    ended = end_of(result.events)
    assert (ended.status, ended.reason) == ("aborted", "power cut")
    assert ended.t == pytest.approx(second)
    assert of_type(result.events, Exited)[0].then == "stay"


def test_events_that_cannot_be_written_stop_the_robot_and_come_out() -> None:
    rig = Rig()
    driver = rig.driver()

    def full(event: Event) -> None:
        if isinstance(event, Driving):
            raise OutputError("disk full")

    with pytest.raises(OutputError, match="disk full"):
        run(
            authorized(task_for(act(at="r0c0")), rig.site, rig.robot),
            site=rig.site,
            robot=rig.robot,
            driver=driver,
            guard=rig.guard,
            clock=rig.clock,
            emit=full,
        )
    assert driver.next_event_in() is None


# --- the budget ------------------------------------------------------------------------------------------------------


def test_without_budget_for_mandatory_work_it_is_shed_aloud_and_the_robot_returns() -> None:
    plan = seq(
        act(at="r0c0"),
        each("r0c1", "r0c2", "r0c3"),
        AnyOrder(id="", steps=(act(CO2, at="r3c3"), GoTo(id="", place=TreeIs(tree="r3c4")))),
        Repeat(id="", times=2, body=act()),
    )
    # r0c0 to drive and act there is one question; each visit of the loop is one, and one more for the act in it.
    result = Rig(guard=BudgetOf(3)).fly(plan)
    assert captured(result.events) == [(PICTURE, "r0c0"), (PICTURE, "r0c1")]
    shed = [(e.node, e.places, e.optional) for e in of_type(result.events, Shed)]
    assert shed == [
        ("n3", ("r0c2", "r0c3"), False),
        ("n6", ("r3c3",), False),
        ("n7", ("r3c4",), False),
        ("n8", (), False),
    ]
    assert all("too little left" in e.reason and e.chance_short == 0.4 for e in of_type(result.events, Shed))
    ended = end_of(result.events)
    assert (ended.status, ended.reason) == ("returned", "too little left")
    assert at(ended, "end")
    (exited,) = of_type(result.events, Exited)
    assert (exited.exit, exited.then) == ("faulted", "return_to_end")


def test_an_act_in_place_is_asked_for_too_and_what_follows_in_the_loops_is_shed() -> None:
    body = seq(act(), act(CO2))
    result = Rig(guard=BudgetOf(2)).fly(Repeat(id="", times=3, body=each("r0c0", "r0c1", body=body)))
    assert captured(result.events) == [(PICTURE, "r0c0")]
    shed = [(e.node, e.places) for e in of_type(result.events, Shed)]
    assert shed == [("n5", ("r0c0",)), ("n2", ("r0c1",)), ("n1", ())]


def test_a_try_does_not_catch_the_budget() -> None:
    result = Rig(guard=BudgetOf(0)).fly(seq(Try(id="", body=act(at="r0c0"), otherwise=act(CO2)), act()))
    assert captured(result.events) == []
    assert result.status == "returned"


def test_branches_that_were_not_taken_are_not_shed() -> None:
    plan = If(id="", condition=NEVER_READ, then=act(at="r0c0"), otherwise=act(at="r0c1"))
    result = Rig(guard=BudgetOf(0)).fly(plan)
    assert [e.places for e in of_type(result.events, Shed)] == [("r0c1",)]


def test_the_guard_sees_the_work_and_what_is_still_to_come() -> None:
    visits_seen: list[Visit] = []
    states: list[MissionState] = []

    class Watching(BudgetOf):
        def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
            visits_seen.append(visit)
            states.append(state)
            return super().admit(state, visit, still_to_come)

    guard = Watching(99)
    rig = Rig(guard=guard)
    rig.fly(each("r0c0", "r0c1", "r0c2", body=act(count=2), at_most=2))
    picture = rig.robot.action[PICTURE]
    assert guard.asked == [
        ("n1", "r0c0", ("r0c1",)),
        ("n2", "r0c0", ("r0c1",)),
        ("n1", "r0c1", ()),
        ("n2", "r0c1", ()),
    ]
    assert {(v.service_s, v.service_j) for v in visits_seen} == {(2 * picture.duration_s, 2 * picture.energy_j)}
    third = states[2]
    assert third.context.here.id == "r0c0"
    assert third.context.visited == ("r0c0",)
    assert third.spent.metres > 0
    assert third.spent.seconds == pytest.approx(third.spent.metres + 2 * picture.duration_s)
    assert third.charge_percent == pytest.approx(100 - third.spent.percent)


def test_optional_visits_that_do_not_fit_are_shed_with_the_reason_and_the_mission_completes() -> None:
    result = Rig(guard=BudgetOf(4)).fly(each("r0c0", "r0c1", "r0c2", "r0c3", optional=True))
    # Each visit asks once to choose and once for the act there.
    assert [p for _, p in captured(result.events)] == ["r0c0", "r0c1"]
    (shed,) = of_type(result.events, Shed)
    assert (shed.node, shed.places, shed.optional, shed.reason) == ("n1", ("r0c2", "r0c3"), True, "too little left")
    assert result.status == "completed"


def test_the_guard_chooses_among_optional_visits_and_sheds_some() -> None:
    class LastFirst(BudgetOf):
        def choose(
            self,
            state: MissionState,
            candidates: Sequence[Visit],
            *,
            at_most: int | None = None,
            still_to_come: Sequence[Visit] = (),
        ) -> VisitChoice:
            rewards = [c.reward for c in candidates]
            best = rewards.index(max(rewards))
            worthless = tuple(i for i, r in enumerate(rewards) if r == 0.0)
            return VisitChoice(index=best, shed=worthless, reason="worth nothing")

    plan = each("r0c0", "r0c1", "r0c2", "r0c3", optional=True, reward="reward")
    result = Rig(guard=LastFirst(99)).fly(plan)
    assert [p for _, p in captured(result.events)] == ["r0c3", "r0c2", "r0c1"]
    (shed,) = of_type(result.events, Shed)
    assert (shed.places, shed.reason) == (("r0c0",), "worth nothing")


def test_the_guard_is_told_how_many_optional_visits_may_still_be_made() -> None:
    told: list[int | None] = []

    class Counting(BudgetOf):
        def choose(
            self,
            state: MissionState,
            candidates: Sequence[Visit],
            *,
            at_most: int | None = None,
            still_to_come: Sequence[Visit] = (),
        ) -> VisitChoice:
            told.append(at_most)
            return super().choose(state, candidates)

    Rig(guard=Counting(99)).fly(each("r0c0", "r0c1", "r0c2", "r0c3", optional=True, at_most=2))
    Rig(guard=Counting(99)).fly(each("r0c0", optional=True))
    assert told == [2, 1, None]


def test_work_that_does_not_fit_inside_an_optional_visit_costs_only_that_visit() -> None:
    class NoCo2At(BudgetOf):
        def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
            go = not (state.node == "n4" and visit.place.id == "r0c1")
            return Verdict(go=go, reason="" if go else "no time for it")

    plan = each("r0c0", "r0c1", "r0c2", optional=True, body=Try(id="", body=seq(act(CO2)), otherwise=act()))
    result = Rig(guard=NoCo2At(99)).fly(plan)
    assert captured(result.events) == [(CO2, "r0c0"), (CO2, "r0c2")]
    (shed,) = of_type(result.events, Shed)
    assert (shed.node, shed.places, shed.optional, shed.reason) == ("n1", ("r0c1",), True, "no time for it")
    assert result.status == "completed"


def test_mandatory_loops_inside_optional_visits_cost_only_the_visit() -> None:
    class NotFar(BudgetOf):
        def admit(self, state: MissionState, visit: Visit, still_to_come: Sequence[Visit] = ()) -> Verdict:
            return Verdict(go=visit.place.id != "r3c4", reason="too far")

    inner = each("r1c0", "r3c4", body=act(CO2))
    result = Rig(guard=NotFar(99)).fly(each("r0c0", "r0c1", optional=True, body=seq(act(), inner)))
    assert result.status == "completed"
    assert [p for a, p in captured(result.events) if a == PICTURE] == ["r0c0", "r0c1"]
    assert [(e.places, e.optional) for e in of_type(result.events, Shed)] == [(("r0c0",), True), (("r0c1",), True)]


# --- work at the place in hand ---------------------------------------------------------------------------------------


def _picture_else_air() -> Steps:
    """A picture at r0c0; then one at r3c4, and where that fails a reading at the place in hand."""
    return seq(act(at="r0c0"), Try(id="", body=act(at="r3c4"), otherwise=act(CO2)))


def test_after_a_failed_drive_work_at_the_place_in_hand_is_done_there() -> None:
    world = World(faults=(Blocked(at=TreeRef(id="r3c4"), within_m=2.0),))
    guard = BudgetOf(visits=99)
    result = Rig(world=world, guard=guard).fly(_picture_else_air())
    assert captured(result.events) == [(PICTURE, "r0c0"), (CO2, "r0c0")]
    reading = next(e for e in result.events if isinstance(e, Acted) and e.action == CO2)
    before = result.events[: result.events.index(reading)]
    arrived = before[-1]
    assert isinstance(arrived, Arrived)
    assert (arrived.node, arrived.place) == (reading.node, "r0c0")
    assert arrived.leg_m > 1
    assert (reading.node, "r0c0") in [(node, place) for node, place, _ in guard.asked]
    assert result.status == "completed"


class NoWayBack(SimulatedDriver):
    """Once it has left r0c0, its drives back there fail as those to r3c4 do."""

    def start_drive(self, goal: DriveGoal) -> None:
        first = goal.path_m[0]
        if goal.place.id == "r0c0" and math.dist(first, SITE.start.xy) > 1:
            goal = replace(goal, place=SITE.by_id["r3c4"].place)
        super().start_drive(goal)


class RigOfNoWayBack(Rig):
    def driver(self) -> SimulatedDriver:
        return NoWayBack(self.site, self.robot, self.world, self.clock, np.random.default_rng(self.seed))


def test_work_at_the_place_in_hand_fails_where_the_robot_cannot_drive_back() -> None:
    world = World(faults=(DriveFails(at=TreeRef(id="r3c4")),))
    result = RigOfNoWayBack(world=world).fly(_picture_else_air())
    assert [(e.action, e.place) for e in of_type(result.events, Acted)] == [(PICTURE, "r0c0")]
    assert result.status == "faulted"
    fault = of_type(result.events, Faulted)[-1]
    assert (fault.node, fault.fault, fault.handled) == ("n5", "drive_failed", False)


def test_the_guard_is_asked_before_the_robot_drives_back_to_the_place_in_hand() -> None:
    world = World(faults=(DriveFails(at=TreeRef(id="r3c4")),))
    result = Rig(world=world, guard=BudgetOf(visits=2)).fly(_picture_else_air())
    assert captured(result.events) == [(PICTURE, "r0c0")]
    assert result.status == "returned"
    assert [(e.node, e.places) for e in of_type(result.events, Shed)] == [("n5", ("r0c0",))]


def test_the_exit_names_the_stop_that_took_it() -> None:
    stop = Try(id="", body=act(at="r0c0"), otherwise=StopMission(id="", exit="faulted"))
    world = World(faults=(ActionFails(action=PICTURE),))
    result = Rig(world=world).fly(seq(stop, act(CO2)))
    (exited,) = of_type(result.events, Exited)
    assert (exited.node, exited.exit) == ("n4", "faulted")
    (exited,) = of_type(Rig().fly(act(at="r0c0")).events, Exited)
    assert exited.node == ""
