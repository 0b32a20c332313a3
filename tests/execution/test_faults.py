"""What the robot does about each fault that a world file can script."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from fieldhand import mission
from fieldhand.errors import OutputError
from fieldhand.execution.drivers.protocol import ActionGoal
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    ClockJumps,
    DiskFull,
    DriveFails,
    LocalisationLost,
    SensorAbsurd,
    TreeRef,
    World,
    WorldFault,
)
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.places.selectors import TreeIs, Trees, UnionOf
from fieldhand.robot.model import Patience
from fieldhand.site.model import Site
from fieldhand.task.build import FAULTED_EXITS
from fieldhand.task.conditions import Compare, Not
from fieldhand.task.event_lines import to_json
from fieldhand.task.frames import FaultedExit
from fieldhand.task.plan import Act, ForEach, GoTo, If, InOrder, OptionalStep, Try
from fieldhand.task.results import (
    Acted,
    Arrived,
    ClockSet,
    Decided,
    Driving,
    Ended,
    Event,
    Faulted,
    Obstructed,
    Shed,
    Started,
    Waited,
)
from fieldhand.testing.driver_contract import finish
from support.missions.rig import Rig, approved, captured, husky, of_type, orchard, task_for
from support.sites.planted import upright

CO2 = "read_co2"


def act(tree: str | None = None, **more: object) -> Act:
    return Act(id="", action=CO2, at=None if tree is None else TreeIs(tree=tree), **more)  # type: ignore[arg-type]


def each(*trees: str, **more: object) -> ForEach:
    of = UnionOf(parts=tuple(TreeIs(tree=t) for t in trees))
    return ForEach(id="", select=of, body=act(), **more)  # type: ignore[arg-type]


def world(*faults: WorldFault, **more: object) -> World:
    return World(faults=faults, **more)  # type: ignore[arg-type]


def walled(rows: int = 3, trees: int = 6) -> Site:
    """Rows that run north, 6 m apart, trees every 4 m, in a fence so tight that all aisles are blind in the north."""
    from shapely.geometry import box

    from fieldhand.site.model import Zone

    made = upright(rows, trees)
    deep = (trees - 1) * 4.0
    fence = Zone(name="fence", kind="boundary", polygon=box(-4.0, -12.0, (rows - 1) * 6.0 + 4.0, deep + 0.6))
    planting = made.planting
    site = replace(made, zones=(fence,))
    vars(site)["planting"] = planting
    return site


# --- action fails --------------------------------------------------------------------------------------------------


def test_an_action_has_retries_and_a_wait_of_its_own() -> None:
    robot = husky(retries=0)
    patient = replace(robot.action[CO2], retries=3, retry_wait_s=20.0)
    robot = replace(robot, actions=tuple(patient if a.name == CO2 else a for a in robot.actions))
    result = Rig(robot=robot, world=world(ActionFails(action=CO2, times=3))).fly(act("r0c0"))
    tries = of_type(result.events, Acted)
    assert [(e.attempt, e.status) for e in tries] == [(1, "failed"), (2, "failed"), (3, "failed"), (4, "success")]
    apart = [b.t - a.t for a, b in itertools.pairwise(tries)]
    assert apart == pytest.approx([20.0 + patient.duration_s] * 3)
    picture = Act(id="", action="take_thermal_picture", at=TreeIs(tree="r0c0"))
    once = Rig(robot=robot, world=world(ActionFails(action="take_thermal_picture", times=1))).fly(picture)
    assert once.status == "faulted"


def test_an_absurd_value_decides_nothing() -> None:
    low = Compare(reading="r", quantity="co2", test="lt", value=1e9, unit="ppm")
    for value in (math.nan, math.inf, -1e9, 99999.0):
        for condition in (low, Not(condition=low)):
            read = Try(id="", body=act("r0c0", reading="r"), otherwise=GoTo(id="", place=TreeIs(tree="r0c1")))
            plan = InOrder(id="", steps=(read, If(id="", condition=condition, then=act("r0c2"))))
            events = Rig(world=world(SensorAbsurd(quantity="co2", value=value))).fly(plan).events
            assert [e.holds for e in of_type(events, Decided)] == [False]


# --- blocked -------------------------------------------------------------------------------------------------------


def test_a_blocked_aisle_is_driven_around_and_the_tree_worked_on_from_its_other_side() -> None:
    site = upright(4, 8)
    tree = site.trees[8 + 4].place  # in the middle of the second row
    rig = Rig(site=site)
    near = next(e for e in rig.fly(act(tree.id)).events if isinstance(e, Arrived))
    side = 0 if site.projection.metres(near.lat, near.lon)[0][0] < tree.x else 2
    beside = site.trees[8 * side + 2].place
    blocked = Blocked(between=(TreeRef(id=site.trees[8 + 2].place.id), TreeRef(id=beside.id)), within_m=1.5)
    result = Rig(site=site, world=world(blocked)).fly(act(tree.id))
    assert result.status == "completed"
    (found,) = of_type(result.events, Obstructed)
    assert (found.place, found.unreachable, len(found.blocked)) == (tree.id, (), 1)
    first, second = of_type(result.events, Arrived)[0], of_type(result.events, Driving)[1]
    assert second.planned_m > 10
    assert first.place == tree.id


@pytest.mark.parametrize("order", ["best", "given"])
def test_what_a_blocked_aisle_closes_off_is_named_and_all_else_is_done(order: str) -> None:
    """Three rows in a dead-end orchard: the aisle between the first two is blocked, and so is that beside the first."""
    site = walled()
    ids = [t.place.id for t in site.trees]
    row, k = 1, 3  # the second row; its fourth tree and those behind it
    faults = [
        Blocked(between=(TreeRef(id=ids[row * 6 + k]), TreeRef(id=ids[other * 6 + k])), within_m=2.4)
        for other in (0, 2)
    ]
    wanted = [ids[row * 6 + j] for j in range(6)]
    result = Rig(site=site, world=world(*faults)).fly(each(*wanted, order=order))
    assert result.status == "faulted"
    done = [tree for _, tree in captured(result.events)]
    shed = of_type(result.events, Shed)
    assert {e.cause for e in shed} == {"unreachable"}
    assert not any(e.optional for e in shed)
    given_up = [tree for e in shed for tree in e.places]
    assert sorted(done + given_up) == sorted(wanted)
    assert set(done) >= set(wanted[:k])
    assert set(given_up) >= set(wanted[k + 1 :])
    named = {tree for e in of_type(result.events, Obstructed) for tree in e.unreachable}
    assert set(given_up) <= named
    assert all(tree in result.reason for tree in given_up)


def test_the_way_that_is_blocked_is_never_tried_again_where_there_is_another() -> None:
    site = upright(4, 8)
    ids = [t.place.id for t in site.trees]
    faults = [Blocked(between=(TreeRef(id=ids[8 + 4]), TreeRef(id=ids[16 + 4])), within_m=2.0)]
    rig = Rig(site=site, world=world(*faults))
    plan = InOrder(id="", steps=tuple(act(ids[k]) for k in (8 + 6, 16 + 1, 16 + 6, 8 + 1, 16 + 7)))
    result = rig.fly(plan)
    assert result.status == "completed"
    assert len(of_type(result.events, Obstructed)) <= 2  # once from either end of the aisle


def test_what_stands_in_the_only_way_for_a_while_is_waited_for() -> None:
    site = walled(rows=2)
    ids = [t.place.id for t in site.trees]
    both = [Blocked(at=TreeRef(id=ids[k]), within_m=3.6, until_s=60.0) for k in (3, 9)]
    result = Rig(site=site, world=world(*both)).fly(act(ids[5]))
    assert result.status == "completed"
    (waited,) = of_type(result.events, Waited)
    assert (waited.wanted, waited.over, waited.seconds) == ("way", True, 60.0)
    assert of_type(result.events, Obstructed)[-1].free
    hasty = replace(husky(), patience=Patience(blocked_wait_s=5.0))
    result = Rig(site=site, robot=hasty, world=world(*both)).fly(act(ids[5]))
    assert result.status == "faulted"
    assert f"tree {ids[5]} cannot be reached" in result.reason


def test_a_robot_that_is_enclosed_ends_where_it_stands_and_says_why() -> None:
    """In the middle of a blind aisle, something comes up behind it while it reads."""
    site = walled(rows=2)
    ids = [t.place.id for t in site.trees]
    behind = [Blocked(at=TreeRef(id=ids[k]), within_m=4.5, from_s=40.0) for k in (1, 7)]
    task = task_for(act(ids[4], count=9), nominal="return_to_start")
    result = Rig(site=site, world=world(*behind)).fly(task)
    assert len(captured(result.events)) == 9
    assert result.status == "faulted"
    assert "cannot be reached" in result.reason
    assert of_type(result.events, Ended) == [result.events[-1]]


def test_optional_work_out_of_reach_is_left_out_and_the_mission_completes() -> None:
    site = walled()
    ids = [t.place.id for t in site.trees]
    faults = [Blocked(between=(TreeRef(id=ids[6 + 3]), TreeRef(id=ids[j * 6 + 3])), within_m=2.4) for j in (0, 2)]
    step = OptionalStep(id="", body=InOrder(id="", steps=(act(ids[6 + 5]), act(ids[6 + 4]))))
    for plan in (each(ids[6], ids[6 + 5], ids[6 + 1], optional=True), InOrder(id="", steps=(step, act(ids[6])))):
        result = Rig(site=site, world=world(*faults)).fly(plan)
        assert result.status == "completed"
        assert ids[6 + 5] not in [tree for _, tree in captured(result.events)]
        assert ids[6] in [tree for _, tree in captured(result.events)]
        assert [e.cause for e in of_type(result.events, Shed) if e.optional][:1] == ["unreachable"]


def test_an_otherwise_stands_in_for_work_out_of_reach() -> None:
    site = walled(rows=2)
    ids = [t.place.id for t in site.trees]
    both = [Blocked(at=TreeRef(id=ids[k]), within_m=3.6) for k in (3, 9)]
    result = Rig(site=site, world=world(*both)).fly(Try(id="", body=act(ids[5]), otherwise=act(ids[0])))
    assert result.status == "completed"
    assert captured(result.events) == [(CO2, ids[0])]
    fault = of_type(result.events, Faulted)[-1]
    assert (fault.fault, fault.handled) == ("blocked", True)


# --- localisation --------------------------------------------------------------------------------------------------


def test_a_robot_that_gets_lost_stands_still_and_goes_on_when_it_knows_where_it_is() -> None:
    plain = Rig().fly(each("r0c0", "r2c3"))
    result = Rig(world=world(LocalisationLost(at_s=3.0, for_s=25.0))).fly(each("r0c0", "r2c3"))
    assert result.status == "completed"
    (waited,) = of_type(result.events, Waited)
    assert (waited.wanted, waited.over) == ("position", True)
    assert waited.seconds == pytest.approx(25.0, abs=1.0)
    assert result.spent.metres == pytest.approx(plain.spent.metres)
    assert captured(result.events) == captured(plain.events)


@pytest.mark.parametrize("lost", [LocalisationLost(at_s=9.0), LocalisationLost(at=TreeRef(id="r2c3"), within_m=4.0)])
def test_a_robot_that_stays_lost_ends_the_mission_where_it_stands(lost: LocalisationLost) -> None:
    robot = replace(husky(), patience=Patience(lost_wait_s=30.0))
    exits = tuple(FaultedExit(fault=e.fault, then="return_to_start") for e in FAULTED_EXITS)
    result = Rig(robot=robot, world=world(lost)).fly(task_for(each("r0c0", "r2c3"), faulted=exits))
    assert result.status == "faulted"
    assert "does not know where it is" in result.reason
    assert {e.over for e in of_type(result.events, Waited)} == {False}
    last = of_type(result.events, Waited)[0]
    assert not [e for e in of_type(result.events, Acted) if e.t > last.t and e.status == "success"]


def test_no_capture_is_made_while_lost_and_none_that_is_broken_off_counts_as_a_try() -> None:
    """Lost for a while just as it reads; the profile gives no second try."""
    begun = next(e for e in Rig().fly(act("r0c0")).events if isinstance(e, Arrived)).t
    lost = LocalisationLost(at_s=begun + 1.0, for_s=12.0)
    result = Rig(robot=husky(retries=0), world=world(lost)).fly(act("r0c0"))
    assert result.status == "completed"
    failed, done = of_type(result.events, Acted)
    assert (failed.status, done.status) == ("failed", "success")
    assert done.t - husky().action[CO2].duration_s >= begun + 13.0 - 1e-6


# --- energy, clock, disk -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("factor", [1.5, 2.0])
def test_a_battery_that_empties_faster_than_modelled_is_learned_of(factor: float) -> None:
    """As many trees as fit, of more than fit by far: the guard or the watch brings it home with the reserve."""
    site = orchard(rows=14, columns=14)
    plan = ForEach(id="", select=Trees(), body=act(), optional=True)
    low = husky(alpha=1.0)
    low = replace(low, energy=replace(low.energy, capacity_j=low.energy.capacity_j / 4))
    seen: list[Event] = []
    mission.simulate(
        approved(task_for(plan, nominal="return_to_start"), site, low),
        world=world(BatteryDrains(factor=factor), charge_percent=40.0), seed=1, speed=None, emit=seen.append,
    )  # fmt: skip
    ended = seen[-1]
    assert isinstance(ended, Ended)
    assert ended.status in ("completed", "returned")
    exits = (site.start, site.markers["end"])
    assert any((ended.lat, ended.lon) == pytest.approx((exit_.lat, exit_.lon), abs=1e-6) for exit_ in exits)
    assert ended.charge_percent >= low.energy.reserve_percent
    assert "as fast as its model says" in "; ".join(e.reason for e in of_type(seen, Shed))


def test_setting_the_wall_clock_changes_nothing_but_is_written_down() -> None:
    site, robot = orchard(), husky(alpha=0.5)
    given_mission = approved(task_for(each("r0c0", "r2c3")), site, robot)

    def flown(*faults: WorldFault) -> list[Event]:
        seen: list[Event] = []
        morning = parse_world({"begins": "2026-05-01T06:00:00+02:00"}).begins
        given = world(*faults, begins=morning)
        mission.simulate(given_mission, world=given, seed=3, speed=None, emit=seen.append)
        return seen

    plain, jumped = flown(), flown(ClockJumps(at_s=5.0, by_s=-7200.0), ClockJumps(at_s=30.0, by_s=86400.0))
    assert [round(e.by_s) for e in of_type(jumped, ClockSet)] == [-7200, 86400]
    assert [to_json(e) for e in jumped if not isinstance(e, ClockSet)] == [to_json(e) for e in plain]
    (started,) = of_type(plain, Started)
    assert started.at == "2026-05-01T04:00:00.000+00:00"


def test_a_full_disk_stops_the_robot_and_comes_out() -> None:
    site, robot = orchard(), husky()
    seen: list[Event] = []
    with pytest.raises(OutputError, match="no space left on the disk") as caught:
        mission.simulate(
            approved(task_for(each("r0c0", "r2c3")), site, robot),
            world=world(DiskFull(at_s=20.0)), seed=0, speed=None, emit=seen.append,
        )  # fmt: skip
    assert "the robot was stopped" in caught.value.advice
    assert seen
    assert max(e.t for e in seen) < 20.0


def test_a_drive_that_fails_by_itself_is_tried_again_and_then_ends_the_mission() -> None:
    once = Rig(world=world(DriveFails(at=TreeRef(id="r2c3"), times=1))).fly(act("r2c3"))
    assert once.status == "completed"
    assert [(e.fault, e.handled) for e in of_type(once.events, Faulted)] == [("drive_failed", True)]
    often = Rig(world=world(DriveFails(at=TreeRef(id="r2c3")))).fly(act("r2c3"))
    assert (often.status, of_type(often.events, Obstructed)) == ("faulted", [])


# --- the simulated robot -------------------------------------------------------------------------------------------


def test_a_lost_robot_refuses_every_goal_at_once() -> None:
    rig = Rig(world=world(LocalisationLost(at_s=0.0, for_s=10.0)))
    driver = rig.driver()
    assert driver.lost() is not None
    driver.start_action(ActionGoal(action=CO2, place=rig.site.trees[0].place))
    progress = finish(driver, rig.clock)
    assert (progress.state, progress.fault, progress.seconds) == ("failed", "lost", 0.0)
    rig.clock.advance(10.0)
    assert driver.lost() is None


def test_a_drain_that_begins_later_counts_from_then_on() -> None:
    def used(*faults: WorldFault) -> Callable[[float], float]:
        rig = Rig(world=world(*faults))
        driver = rig.driver()

        def after(seconds: float) -> float:
            rig.clock.advance(seconds - rig.clock.now())
            return 100.0 - driver.charge_percent()

        return after

    plain, later = used(), used(BatteryDrains(factor=3.0, from_s=100.0))
    before, (first, second) = plain(100.0), (later(100.0), later(300.0))
    assert first == pytest.approx(before)
    assert second == pytest.approx(before + 3 * (plain(300.0) - before))
