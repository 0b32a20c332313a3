"""Goals that end for no reason of the drive, navigators that restart, and places that are taken: whole missions on the
simulated robot, with what its Nav2 does.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import Ros2Error
from fieldhand.evaluation.outcome import judge
from fieldhand.execution.drivers.protocol import DriveGoal
from fieldhand.execution.drivers.ros2 import action_client
from fieldhand.execution.drivers.ros2.headway import Headway
from fieldhand.execution.drivers.ros2.profile_check import check_live
from fieldhand.execution.drivers.ros2.service_call import TimeLimit
from fieldhand.execution.drivers.simulation.world import (
    Blocked,
    GoalClicked,
    GoalUnexplained,
    NavigatorDies,
    TreeRef,
    World,
)
from fieldhand.execution.mission_runner import Result
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.places.selectors import TreeIs, UnionOf
from fieldhand.task.plan import ForEach, InOrder, Node, Try, Wait
from fieldhand.task.results import Driving, Faulted, Obstructed, Paused, Shed, Waited
from ros2.nav2_rig import SITE, Nav2Rig, act, profile
from support.examples import examples
from support.missions.rig import Rig, captured, of_type, task_for

CLICKED = GoalClicked(at=TreeRef(id="r3c4"), after_m=5.0)
DIES = NavigatorDies(after_m=5.0, down_s=2.0, inactive_s=5.0)


def visits(*trees: str) -> ForEach:
    return ForEach(id="", select=UnionOf(parts=tuple(TreeIs(tree=t) for t in trees)), body=act_here())


def act_here() -> Node:
    return replace(act("r0c0"), at=None)


def whats(result: Result) -> str:
    return "\n".join(e.what for e in of_type(result.events, Faulted))


PLAIN_M = Nav2Rig().fly(act("r0c3")).spent.metres


# --- goals that end without a code -----------------------------------------------------------------------------------


@pytest.mark.parametrize("distro", ["humble", "jazzy", "kilted"])
def test_a_goal_of_another_client_pauses_the_mission_and_is_no_obstacle(distro: Any) -> None:
    rig = Nav2Rig((CLICKED,), profile(distro=distro))
    result = rig.fly(act("r0c3"))
    assert (result.status, captured(result.events)) == ("completed", [("read_co2", "r0c3")])
    assert "a goal of another client took the place of this drive's, such as one clicked in RViz" in whats(result)
    (paused,) = of_type(result.events, Paused)
    assert "drives the robot, such as one clicked in RViz; the mission goes on in 300 s, or when it is" in paused.reason
    assert not of_type(result.events, Obstructed)
    # Only ours was pre-empted: the other one was driven to its end.
    assert rig.ends().count("pre-empted") == 1
    nearest = min(math.dist(SITE.by_id["r3c4"].place.xy, _xy(r.place)) for r in rig.reports if r.end == "succeeded")
    assert nearest == 0.0
    (at_s,) = {e.t for e in result.events if e.event == "continued"}
    assert at_s - paused.t < 60.0


def _xy(place: str) -> tuple[float, float]:
    tree = SITE.by_id.get(place.removeprefix("tree "))
    return (math.inf, math.inf) if tree is None else tree.place.xy


@pytest.mark.parametrize("by_hand", [False, True])
def test_it_is_overridden_once_the_pause_is_over_or_ended_by_a_person(by_hand: bool) -> None:
    waits = {} if by_hand else {"taken_wait_s": 3.0}
    rig = Nav2Rig((CLICKED,), profile(patience=waits))
    resumed = OperatorCommand(wanted="continue", reason="the operator", number=1)

    def orders() -> OperatorCommand | None:
        return resumed if by_hand and rig.clock.now() > 10.0 else None

    result = rig.fly(act("r0c3"), orders=orders)
    assert result.status == "completed"
    (paused,) = of_type(result.events, Paused)
    (at_s,) = [e.t for e in result.events if e.event == "continued"]
    assert at_s - paused.t == pytest.approx(2.5 if by_hand else 3.0, abs=1.5)
    assert rig.ends().count("pre-empted") == 2


def test_a_goal_that_ends_unprovoked_is_tried_again() -> None:
    result = Nav2Rig((GoalUnexplained(after_m=5.0),)).fly(act("r0c3"))
    assert (result.status, captured(result.events)) == ("completed", [("read_co2", "r0c3")])
    assert "navigation ended the drive without an error code; trying again" in whats(result)
    assert not of_type(result.events, Obstructed)
    assert result.spent.metres == pytest.approx(PLAIN_M, abs=0.5)


def test_goals_that_end_unprovoked_without_end_fail_the_drive() -> None:
    result = Nav2Rig((GoalUnexplained(after_m=5.0, times=1000),)).fly(act("r0c3"))
    assert result.status == "faulted"
    assert "navigation ended the drive without an error code; interrupted 3 times" in result.reason
    assert len(of_type(result.events, Driving)) == 3
    assert result.spent.metres < PLAIN_M


def test_a_phantom_is_no_obstacle_where_failures_have_no_code() -> None:
    result = Nav2Rig((GoalUnexplained(after_m=5.0),), profile(distro="humble")).fly(act("r0c3"))
    assert result.status == "completed"
    assert not of_type(result.events, Obstructed)
    assert result.spent.metres == pytest.approx(PLAIN_M, abs=0.5)
    twice = Nav2Rig((GoalUnexplained(after_m=5.0, times=2),), profile(distro="humble")).fly(act("r0c3"))
    assert [e.what for e in of_type(twice.events, Obstructed)] == ["navigation failed without an error code"]


# --- restarts --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("distro", ["humble", "jazzy"])
def test_a_navigator_that_restarts_inactive_is_waited_for_and_its_controller_stopped(distro: Any) -> None:
    rig = Nav2Rig((DIES,), profile(distro=distro))
    result = rig.fly(act("r0c3"), act("r1c0"))
    assert (result.status, len(captured(result.events))) == ("completed", 2)
    said = whats(result)
    assert "/navigate_to_pose no longer knows the goal: it was restarted; /follow_path has confirmed that its" in said
    assert "bt_navigator is inactive: activate it (ros2 lifecycle set /bt_navigator activate)" in said
    assert rig.ends("follow_path") == ["cancelled"]
    assert [(e.wanted, e.over) for e in of_type(result.events, Waited)] == [("navigation", True)]
    assert not of_type(result.events, Obstructed)
    assert "rejected" not in rig.ends()


def test_a_restart_that_only_the_cancelled_goal_shows_stops_the_controller(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a bad link no result may arrive: the goal is given up because navigation is silent."""
    monkeypatch.setattr(action_client, "RESULT_AGAIN_S", math.inf)
    rig = Nav2Rig((replace(DIES, down_s=1.0, inactive_s=30.0),), profile(quiet_s=4.0))
    result = rig.fly(act("r3c4"))
    assert result.status == "completed"
    said = whats(result)
    assert "/navigate_to_pose was silent for 4 s; /follow_path has confirmed that its controller follows" in said
    assert rig.ends("follow_path") == ["cancelled"]


def test_a_drive_that_is_cancelled_after_a_restart_stops_the_controller() -> None:
    rig = Nav2Rig((replace(DIES, down_s=1.0, inactive_s=None),))
    driver = rig.connect()
    tree = SITE.by_id["r3c4"].place
    path, ends = (SITE.start.xy, tree.xy), ((SITE.start.lat, SITE.start.lon), (tree.lat, tree.lon))
    driver.start_drive(DriveGoal(place=tree, path_m=path, path_degrees=ends, speed_m_s=1.0, length_m=math.dist(*path)))
    while not rig.simulated.platform.metres > 5.0:
        rig.clock.advance(0.2)
        driver.poll()
    rig.clock.advance(1.4)  # its navigator is back, and knows no goal
    driver.cancel()
    until = rig.clock.now() + 30.0
    while not driver.poll().over and rig.clock.now() < until:
        rig.clock.advance(0.2)
    assert driver.poll().state == "cancelled"
    stood = rig.simulated.platform.position
    rig.clock.advance(20.0)
    assert (rig.simulated.platform.position, rig.ends("follow_path")) == (stood, ["cancelled"])


def test_a_navigator_that_is_gone_for_longer_than_its_clients_notice() -> None:
    rig = Nav2Rig((replace(DIES, down_s=20.0),))
    result = rig.fly(act("r0c3"))
    assert result.status == "completed"
    assert "/navigate_to_pose is gone: nothing answers any more; /follow_path has confirmed" in whats(result)
    assert "the robot's navigation is not ready (nothing answers /navigate_to_pose)" in whats(result)


def test_a_navigator_that_nobody_activates_fails_the_drive_in_time() -> None:
    rig = Nav2Rig((replace(DIES, inactive_s=None),), profile(patience={"navigation_wait_s": 12.0}))
    result = rig.fly(act("r0c3"))
    assert result.status == "faulted"
    assert "navigation was not ready within 12 s (bt_navigator is inactive: activate it" in result.reason
    (waited,) = of_type(result.events, Waited)
    assert (waited.over, waited.seconds) == (False, pytest.approx(12.0, abs=0.1))


def test_a_robot_whose_controller_is_not_visible_may_drive_still() -> None:
    rig = Nav2Rig((replace(DIES, down_s=None),), profile(follow_path="", patience={"navigation_wait_s": 5.0}))
    result = rig.fly(act("r0c3"))
    assert result.status == "faulted"
    said = whats(result)
    assert "/navigate_to_pose is gone: nothing answers any more; check whether Nav2 runs on the robot; if it" in said


def test_a_controller_that_is_told_to_stop_when_its_navigator_has_died_stops() -> None:
    rig = Nav2Rig((replace(DIES, down_s=None),), profile(patience={"navigation_wait_s": 5.0}))
    result = rig.fly(act("r3c4"))
    assert result.status == "faulted"
    stood = rig.simulated.platform.position
    rig.clock.advance(20.0)
    assert rig.simulated.platform.position == stood
    assert result.spent.metres == pytest.approx(rig.simulated.platform.metres, abs=0.5)


def inactive() -> Nav2Rig:
    """A robot whose navigator nobody has activated."""
    rig = Nav2Rig()
    client = rig.graph.node().client("/bt_navigator/change_state", "lifecycle_msgs/srv/ChangeState")
    client.ask({"transition": {"id": 4}})
    rig.clock.advance(1.0)
    assert client.replies()[0][1]["success"] is True
    return rig


def test_an_inactive_node_is_named_before_a_mission_begins_and_by_the_check() -> None:
    rig = inactive()
    with pytest.raises(Ros2Error, match="bt_navigator is inactive; activate it"):
        rig.connect()
    report = check_live(
        rig.robot, rig.graph.node(), rig.interfaces, within_s=3.0, steady=rig.clock.now, sleep=rig.clock.advance
    )
    (missing,) = report.missing
    assert (missing.binding.part, missing.what) == ("navigation: bt_navigator", "bt_navigator is inactive")
    assert missing.advice == "activate it (ros2 lifecycle set /bt_navigator activate)"
    assert {e.what for e in report.endpoints if "server" in e.binding.part} == {"active"}


AFTER = st.floats(0.0, 45.0)
NAV2 = st.one_of(
    st.builds(GoalClicked, at=st.sampled_from(["r0c0", "r3c4", "r2c2"]).map(lambda t: TreeRef(id=t)), after_m=AFTER),
    st.builds(GoalUnexplained, after_m=AFTER, times=st.integers(1, 3)),
    st.builds(NavigatorDies, after_m=AFTER, down_s=st.none() | st.floats(0.0, 20.0), inactive_s=st.none() | AFTER),
)


@settings(max_examples=examples(8, thorough=80), deadline=None)
@given(st.lists(NAV2, min_size=1, max_size=3), st.sampled_from(["humble", "jazzy"]), st.integers(0, 2))
def test_whatever_nav2_does_the_mission_ends_and_the_robot_stands(faults: list[Any], distro: Any, retries: int) -> None:
    waits = {"navigation_wait_s": 20.0, "taken_wait_s": 30.0}
    rig = Nav2Rig(tuple(faults), replace(profile(distro=distro, patience=waits), retries=retries))
    result = rig.fly(visits("r1c1", "r3c3"))
    assert result.status in ("completed", "faulted")
    assert result.status == "completed" or result.reason
    assert len(captured(result.events)) == 2 or result.status == "faulted"
    rig.clock.advance(60.0)  # a goal of another client may be driven to its end
    stood = rig.simulated.platform.position
    rig.clock.advance(30.0)
    assert rig.simulated.platform.position == stood
    # Where failures have codes, none of this looks like an obstacle.
    assert distro == "humble" or not of_type(result.events, Obstructed)


# --- places that are taken -------------------------------------------------------------------------------------------


def on_stand(tree: str, north_m: float, **change: Any) -> Blocked:
    """An obstacle beside a tree, at which Nav2 recovers for ever."""
    return Blocked(at=TreeRef(id=tree), north_m=north_m, within_m=0.8, recovers=True, **change)


NORTH, SOUTH = on_stand("r1c2", 1.2), on_stand("r1c2", -1.2)


@pytest.mark.parametrize("distro", ["humble", "jazzy"])
def test_a_tree_with_a_taken_stand_is_visited_from_its_other_side(distro: Any) -> None:
    rig = Nav2Rig((SOUTH,), profile(distro=distro))
    result = rig.fly(visits("r1c1", "r1c2", "r1c4"))
    assert result.status == "completed"
    assert sorted(place for _, place in captured(result.events)) == ["r1c1", "r1c2", "r1c4"]
    assert {e.what for e in of_type(result.events, Obstructed)} == {"it came no nearer to its goal in 6 recoveries"}
    assert not of_type(result.events, Shed)


@pytest.mark.parametrize("on", ["robot", "simulation"])
def test_a_tree_whose_stands_are_all_taken_is_left_out_and_the_mission_goes_on(on: str) -> None:
    plan = (visits("r1c1", "r1c2", "r1c4"), act("r0c0"))
    result = _flown(on, NORTH, SOUTH, plan=plan)
    assert result.status == "completed", result.reason
    assert sorted(place for _, place in captured(result.events)) == ["r0c0", "r1c1", "r1c4"]
    (shed,) = of_type(result.events, Shed)
    assert (shed.places, shed.optional, shed.cause) == (("r1c2",), False, "unreachable")
    assert shed.reason.startswith("something stands where the robot would stand at tree r1c2; ")


def test_its_goal_is_not_met() -> None:
    task = task_for(visits("r1c1", "r1c2", "r1c4"))
    result = Rig(world=World(faults=(NORTH, SOUTH))).fly(task)
    assert result.status == "completed"
    assert [(o.outcome, o.done, o.wanted) for o in judge(task, result.events)] == [("failure", 2, 3)]


@pytest.mark.parametrize("on", ["robot", "simulation"])
def test_where_there_is_no_other_work_the_mission_fails_and_a_try_goes_on_as_it_says(on: str) -> None:
    result = _flown(on, NORTH, SOUTH, plan=(visits("r1c2"),))
    assert result.status == "faulted"
    assert "something stands where the robot would stand at tree r1c2" in result.reason
    tried = Try(id="", body=visits("r1c2", "r1c4"), otherwise=act("r3c0"))
    result = _flown(on, NORTH, SOUTH, plan=(tried,))
    assert [place for _, place in captured(result.events)] == ["r1c4", "r3c0"]


@pytest.mark.parametrize(
    ("later", "status", "places"),
    [
        ((act("r0c0"),), "completed", ["r0c0"]),
        ((visits("r1c4", "r3c0"),), "completed", ["r1c4", "r3c0"]),
        ((act_here(), act("r0c0")), "faulted", []),
        ((Wait(id="", seconds=5.0), act("r0c0")), "faulted", []),
        ((act("r0c0"), act_here()), "completed", ["r0c0", "r0c0"]),
    ],
)
def test_a_single_step_is_left_out_if_what_follows_is_done_elsewhere(
    later: tuple[Node, ...], status: str, places: list[str]
) -> None:
    task = task_for(InOrder(id="", steps=(act("r1c2"), *later)))
    result = Rig(world=World(faults=(NORTH, SOUTH))).fly(task)
    assert (result.status, sorted(place for _, place in captured(result.events))) == (status, places), result.reason
    goals = judge(task, result.events)
    assert goals[0].outcome == "failure"
    if status == "completed":
        assert [o.outcome for o in goals[1:]] == ["success"] * (len(goals) - 1)


def test_a_taken_stand_that_comes_free_is_visited_last() -> None:
    passing = (replace(NORTH, until_s=150.0), replace(SOUTH, until_s=150.0))
    result = Nav2Rig(passing, profile(most_recoveries=2)).fly(visits("r1c1", "r1c2", "r1c4"))
    assert result.status == "completed"
    assert [place for _, place in captured(result.events)] == ["r1c1", "r1c4", "r1c2"]
    assert [e.wanted for e in of_type(result.events, Waited)] == ["way"]


def test_a_drive_that_comes_no_nearer_in_time_counts_as_blocked() -> None:
    rig = Nav2Rig((SOUTH,), profile(stuck_s=20.0, most_recoveries=1000))
    result = rig.fly(visits("r1c2"))
    assert result.status == "completed"
    assert "it came no nearer to its goal for 20 s, with 2 recoveries" in {
        e.what for e in of_type(result.events, Obstructed)
    }
    rig = Nav2Rig((SOUTH,), profile(stuck_s=3600.0, most_recoveries=1000, slower=1.0, extra_s=30.0))
    result = rig.fly(visits("r1c2"))
    assert result.status == "completed"
    assert all("the drive did not end within" in e.what for e in of_type(result.events, Obstructed))


def _flown(on: str, *faults: Blocked, plan: tuple[Node, ...]) -> Result:
    if on == "robot":
        return Nav2Rig(faults, profile(most_recoveries=2)).fly(*plan)
    rig = Rig(world=World(faults=faults))
    return rig.fly(plan[0] if len(plan) == 1 else InOrder(id="", steps=plan))


# --- headway ---------------------------------------------------------------------------------------------------------


def watch(left: list[tuple[float, float, int]], *, stuck_s: float = 30.0, recoveries: int = 5) -> float | None:
    """Return when a drive is stuck, by times, metres left and recoveries."""
    now = [0.0]
    headway = Headway(TimeLimit(stuck_s, lambda: now[0], lambda: now[0]), recoveries)
    for at_s, left_m, count in left:
        now[0] = at_s
        if headway.look({"distance_remaining": left_m, "number_of_recoveries": count}) is not None:
            return at_s
    return None


def test_the_distance_that_a_controller_reports_is_no_measure_of_progress() -> None:
    """Nav2 computes it from a position in the frame of odometry and a path in that of the map."""
    now = [0.0]
    headway = Headway(TimeLimit(30.0, lambda: now[0], lambda: now[0]), 5)
    for at_s in range(0, 200, 5):
        now[0] = float(at_s)
        assert headway.look({"distance_to_goal": 12.0, "speed": 1.0}) is None
    assert headway.least_m == math.inf


@settings(max_examples=examples(30, thorough=500))
@given(st.lists(st.floats(0.55, 5.0), min_size=1, max_size=60), st.integers(0, 4))
def test_a_drive_that_comes_nearer_is_never_stuck(steps: list[float], recoveries: int) -> None:
    total = sum(steps)
    left, at = [], 0.0
    for n, step in enumerate(steps):
        at += step
        left.append((n * 29.0, total - at + 1.0, n * recoveries))
    assert watch(left) is None


@settings(max_examples=examples(30, thorough=500))
@given(st.lists(st.floats(0.0, 4.0), min_size=2, max_size=40), st.floats(0.6, 50.0))
def test_one_that_goes_to_and_fro_is_stuck_after_the_time_at_the_latest(offsets: list[float], nearest_m: float) -> None:
    """Going to and fro by less than another way is long, it is stuck once it has been as near as it gets."""
    left = [(float(n), nearest_m + offset, 0) for n, offset in enumerate(offsets)]
    left += [(len(left) + float(n), nearest_m + offsets[n % len(offsets)], 0) for n in range(80)]
    stuck_s = watch(left)
    assert stuck_s is not None
    assert stuck_s <= len(offsets) * 2 + 32.0


def test_another_way_counts_a_few_times_and_an_unknown_rest_not_at_all() -> None:
    assert watch([(n * 20.0, 10.0 + 40.0 * (n % 2), 0) for n in range(3)]) is None
    assert watch([(n * 20.0, 10.0 + 40.0 * (n % 2), 0) for n in range(20)]) is not None
    assert watch([(n * 20.0, 0.0, n) for n in range(20)]) is None
    assert watch([(0.0, 5.0, 3), (1.0, 5.0, 7), (2.0, 5.0, 8)], recoveries=5) == 2.0
