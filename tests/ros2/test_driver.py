"""A robot over ROS 2 keeps the driver's contract, and every fault of it is one that a mission knows."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.clock import Clock, SimulatedClock
from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal, Driver
from fieldhand.execution.drivers.ros2.action_client import CANCEL_S, ActionClient
from fieldhand.execution.drivers.ros2.driver import LOST_S, Ros2Driver
from fieldhand.execution.drivers.ros2.telemetry import JUMPED_S, Telemetry
from fieldhand.site.model import Place, Site
from fieldhand.testing.driver_contract import DriverContract, drive_goal, finish
from ros2.in_memory import Disturbed, Graph, Node
from ros2.scripted import Script, ScriptedAction
from ros2.scripted_robot import ACTIONS, SAMPLED, SITE, World, bindings, navigating, world
from support.examples import examples
from support.missions.rig import husky

NEAR, FAR = SITE.trees[0].place, SITE.trees[-1].place


def capture(action: str = "read_co2", **parameters: str | float) -> ActionGoal:
    return ActionGoal(action=action, place=NEAR, parameters=parameters)


def drive(to: Place = FAR) -> DriveGoal:
    return drive_goal(SITE.start, to)


class TestOverAGraphInMemory(DriverContract):
    def make(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(world())

    def make_blocked(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(world(blocked=lambda xy: math.dist(xy, FAR.xy) < 3.0))

    def make_lost(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(world(lost=lambda robot: robot.driven_m > 5.0 and robot.clock.now() < 60.0))

    def make_broken(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(world(sample=Script(lasts_s=1.0, ends="aborted", result={"words": "no probe"})))

    def make_in(self, w: World) -> tuple[Driver, Clock, Site]:
        return w.connect(look_every_s=0.25), w.clock, SITE


# --- drives ----------------------------------------------------------------------------------------------------------


def bent() -> DriveGoal:
    """A drive around a corner."""
    path = (SITE.start.xy, (-5.0, 8.0), (10.0, 8.0))
    degrees = tuple((float(a), float(b)) for a, b in SITE.projection.degrees(path))
    return DriveGoal(place=NEAR, path_m=path, path_degrees=degrees, length_m=23.0, speed_m_s=1.0)


@pytest.mark.parametrize("distro", ["humble", "jazzy", "kilted"])
@pytest.mark.parametrize(
    ("kind", "goals"),
    [
        ({}, 2),
        ({"datum": None, "from_ll": "fromLL"}, 2),
        ({"type": "nav2_msgs/action/NavigateThroughPoses"}, 1),
        ({"type": "nav2_msgs/action/FollowGPSWaypoints", "datum": None}, 1),
    ],
)
def test_every_kind_of_navigation_drives_through_the_corners_and_looks_along_the_legs(
    kind: dict[str, Any], goals: int, distro: Any
) -> None:
    if distro == "humble" and "FollowGPS" in kind.get("type", ""):
        return  # Nav2 of humble has none, and the profile refuses it
    w = world(bindings(distro=distro, navigation=navigating(**kind)))
    driver = w.connect()
    driver.start_drive(bent())
    passed = []
    while not driver.poll().over:
        w.clock.advance(0.5)
        passed.append(math.dist(w.robot.xy, (-5.0, 8.0)))
    progress = driver.poll()
    assert progress.state == "succeeded", progress.what
    assert math.dist(w.robot.xy, (10.0, 8.0)) < 0.05
    assert min(passed) < 0.6
    assert progress.metres == pytest.approx(23.0, abs=0.5)
    assert len(w.robot.navigation.received) == goals
    last: Any = w.robot.navigation.received[-1]
    if "gps_poses" in last:
        turn, facing = 0.0, last["gps_poses"][-1]["orientation"]
    else:
        poses = last.get("poses", (last.get("pose"),))
        facing = (poses["goals"] if isinstance(poses, dict) else poses)[-1]["pose"]["orientation"]
        turn = 90.0 - 30.0  # the leg leads east, and the map's x axis 30 degrees from north
    yaw = math.degrees(2.0 * math.atan2(facing["z"], facing["w"]))
    assert (yaw + turn + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=0.1)


def test_a_map_service_that_is_not_ready_begins_no_drive() -> None:
    w = world(bindings(navigation=navigating(datum=None, from_ll="fromLL")))
    driver = w.connect()
    w.graph.disturb("*fromLL request", Disturbed(loss=1.0))
    driver.start_drive(drive())
    progress = finish(driver, w.clock)
    assert (progress.state, progress.what[:46]) == ("failed", "/husky/fromLL did not answer within 5 s; check")
    assert w.robot.navigation.received == []


def test_points_that_do_not_fit_the_way_begin_no_drive() -> None:
    w = world(bindings(navigation=navigating(datum=None, from_ll="fromLL")))
    driver = w.connect()
    server = w.robot.from_ll
    reply = server.reply
    server.reply = lambda to, response: reply(to, {"map_point": {}})  # type: ignore[method-assign]
    driver.start_drive(drive())
    assert "its points do not fit the path" in finish(driver, w.clock).what
    assert w.robot.navigation.received == []


def test_a_robot_that_says_it_has_arrived_and_stands_elsewhere_has_failed() -> None:
    w = world(shift_m=2.0)
    driver = w.connect()
    driver.start_drive(drive(NEAR))
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault) == ("failed", "failed")
    assert "says that it has arrived, but the robot stands 2.0 m away, at most 0.3 m are allowed" in progress.what


@pytest.mark.parametrize("kind", ["NavigateToPose", "NavigateThroughPoses"])
def test_a_map_that_is_turned_otherwise_than_the_profile_says_is_found_before_it_leads_astray(kind: Any) -> None:
    w = world(bindings(navigation=navigating(type=f"nav2_msgs/action/{kind}")), map_turned_deg=90.0)
    driver = w.connect()
    driver.start_drive(drive())
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault) == ("failed", "failed")
    assert re.match(r"the robot's fix is \d+ m from its position in /husky/navigate_to_pose", progress.what)
    assert not w.robot.navigation.executing
    assert w.robot.driven_m < 1.5


@pytest.mark.parametrize(
    ("code", "changes", "fault", "words"),
    [
        (208, {}, "blocked", "no way to the goal was found (code 208 of Nav2)"),
        (105, {}, "blocked", "the robot made no progress (code 105 of Nav2)"),
        (202, {}, "lost", "the robot's pose in its map is not known (no transform) (code 202 of Nav2)"),
        (201, {}, "failed", "the planner that is configured does not exist (code 201 of Nav2)"),
        (4711, {}, "failed", "navigation failed (code 4711 of Nav2)"),
        (4711, {"codes": {4711: "blocked"}}, "blocked", "navigation failed (code 4711 of Nav2)"),
        (0, {}, "interrupted", "navigation ended the drive without an error code"),
        (0, {"without_code": "blocked"}, "blocked", "navigation failed without an error code"),
        (0, {"without_code": "failed"}, "failed", "navigation failed without an error code"),
    ],
)
def test_a_failure_of_nav2_is_a_fault_by_its_code(code: int, changes: dict[str, Any], fault: str, words: str) -> None:
    w = world(bindings(navigation=navigating(**changes)), ends="aborted", result={"error_code": code})
    driver = w.connect()
    driver.start_drive(drive(NEAR))
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault, progress.what) == ("failed", fault, words)
    if fault == "lost":
        assert driver.lost() == words
        w.clock.advance(LOST_S + 0.1)
        assert driver.lost() is None


def test_what_nav2_says_beside_its_code_is_told_and_a_goal_that_others_cancel_has_failed() -> None:
    w = world(ends="aborted", result={"error_code": 105, "error_msg": "stuck in mud"})
    driver = w.connect()
    driver.start_drive(drive(NEAR))
    assert finish(driver, w.clock).what == "the robot made no progress (code 105 of Nav2): stuck in mud"
    w.robot.ends = "cancelled"
    driver.start_drive(drive(NEAR))
    progress = finish(driver, w.clock)
    assert (progress.state, progress.what) == ("failed", "another client cancelled the drive")
    assert progress.fault == "interrupted"


def test_a_missed_waypoint_is_no_success() -> None:
    gps = navigating(type="nav2_msgs/action/FollowGPSWaypoints", datum=None)
    missed = {"missed_waypoints": ({"index": 0, "error_code": 206},)}
    w = world(bindings(navigation=gps), result=missed)
    driver = w.connect()
    driver.start_drive(drive(NEAR))
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault, progress.what) == (
        "failed", "occupied", "the goal lies in an obstacle (code 206 of Nav2)"
    )  # fmt: skip


def test_a_drive_that_takes_too_long_is_cancelled_and_has_failed() -> None:
    w = world(bindings(navigation=navigating(slower=1.0, extra_s=2.0)))
    driver = w.connect()
    slow = replace(drive(), length_m=5.0)
    driver.start_drive(slow)
    progress = finish(driver, w.clock)
    assert (progress.state, progress.what) == ("failed", "the drive did not end within 7 s")
    assert not w.robot.navigation.executing


def test_a_slow_drive_is_told_to_the_controller_or_not_begun() -> None:
    w = world(bindings(navigation=navigating(speed_limit="speed_limit")))
    driver = w.connect()
    driver.start_drive(replace(drive(NEAR), speed_m_s=0.4))
    assert finish(driver, w.clock).state == "succeeded"
    assert w.robot.limits == [0.4]
    w = world()
    driver = w.connect()
    driver.start_drive(replace(drive(NEAR), speed_m_s=0.4))
    assert "limited to 0.4 m/s, but the robot accepts no speed limit" in finish(driver, w.clock).what
    assert w.robot.navigation.received == []


# --- captures --------------------------------------------------------------------------------------------------------


def test_a_capture_by_an_action_has_its_request_and_its_readings() -> None:
    w = world()
    driver = w.connect()
    driver.start_action(capture())
    progress = finish(driver, w.clock)
    assert progress.readings == {"co2": pytest.approx(411.0)}
    assert w.robot.sampler.received == [{"place": NEAR.id, "lat": NEAR.lat, "depth": 3, "wet": True}]
    assert progress.seconds >= 2.0
    assert progress.metres == 0.0


@pytest.mark.parametrize(
    ("result", "state", "readings", "what"),
    [
        ({"ok": True, "co2": (0.0, math.nan)}, "succeeded", {}, ""),
        ({"ok": True, "co2": (0.0,)}, "succeeded", {}, ""),
        ({"ok": False, "words": "dirty", "co2": (0.0, 1.0)}, "failed", {}, "/husky/sample did not succeed: dirty"),
    ],
)
def test_what_the_result_lacks_is_absent_and_what_it_says_of_itself_counts(
    result: dict[str, object], state: str, readings: dict[str, float], what: str
) -> None:
    w = world(sample=Script(lasts_s=0.5, result=result))
    driver = w.connect()
    driver.start_action(capture())
    progress = finish(driver, w.clock)
    assert (progress.state, dict(progress.readings), progress.what) == (state, readings, what)


def test_a_parameter_goes_into_the_request_and_one_that_is_missing_is_named() -> None:
    call = ACTIONS["read_co2"].call
    assert call is not None
    bound = {"read_co2": replace(ACTIONS["read_co2"], call=replace(call, request={"depth": "$depth_cm"}))}
    w = world(bindings(actions=bound))
    driver = w.connect()
    driver.start_action(capture(depth_cm=30.0))
    assert finish(driver, w.clock).state == "succeeded"
    assert w.robot.sampler.received[0]["depth"] == 30
    driver.start_action(capture())
    assert finish(driver, w.clock).what == "read_co2 has no parameter 'depth_cm', which its request needs"
    driver.start_action(capture(depth_cm=30.5))
    progress = finish(driver, w.clock)
    assert progress.state == "failed"
    assert "depth" in progress.what


def test_a_service_answers_or_is_said_to_be_silent() -> None:
    w = world()
    driver = w.connect()
    driver.start_action(capture("read_ambient_temperature"))
    assert finish(driver, w.clock).readings == {"ambient_temperature": pytest.approx(25.0)}
    w.robot.reading = lambda request: None
    driver.start_action(capture("read_ambient_temperature"))
    progress = finish(driver, w.clock)
    assert progress.what == "/thermometer did not answer within 5 s; check whether it runs on the robot"
    w.robot.reading = lambda request: {"ok": False, "words": "broken"}
    driver.start_action(capture("read_ambient_temperature"))
    assert finish(driver, w.clock).what == "/thermometer did not succeed: broken"


def test_a_late_reply_is_not_taken_for_that_of_the_next_request() -> None:
    w = world()
    driver = w.connect()
    kelvin = iter([300.0, 290.0])
    w.robot.reading = lambda request: {"ok": True, "kelvin": next(kelvin)}
    w.graph.disturb("/thermometer reply", Disturbed(delay_s=(6.0, 6.0)))
    driver.start_action(capture("read_ambient_temperature"))
    assert finish(driver, w.clock).state == "failed"
    w.graph.disturb("/thermometer reply", Disturbed(delay_s=(2.0, 2.0)))
    driver.start_action(capture("read_ambient_temperature"))
    assert finish(driver, w.clock).readings == {"ambient_temperature": pytest.approx(290.0 - 273.15)}


def test_a_topic_gives_the_next_message_not_one_that_was_there() -> None:
    w = world(canopy=20.0)
    driver = w.connect()
    w.clock.advance(3.0)
    w.robot.canopy = 40.0
    driver.start_action(capture("take_thermal_picture"))
    assert finish(driver, w.clock).readings == {"canopy_temperature": 40.0}
    w.robot.canopy = math.nan
    w.clock.advance(2.0)
    driver.start_action(capture("take_thermal_picture"))
    progress = finish(driver, w.clock)
    assert (progress.state, dict(progress.readings)) == ("succeeded", {})
    w.robot.canopy = None
    w.clock.advance(2.0)
    driver.start_action(capture("take_thermal_picture"))
    said = "no message on /husky/canopy within 4 s, so there is no canopy_temperature"
    assert finish(driver, w.clock).what == said


@pytest.mark.parametrize("kind", ["action", "service"])
@settings(max_examples=examples(10, thorough=200))
@given(after_s=st.floats(0.0, 5.0), late=st.booleans())
def test_a_sensor_that_is_triggered_may_send_before_it_answers(kind: str, after_s: float, late: bool) -> None:
    """And what was sent before it was triggered is none of its readings, though it has to be waited for."""
    name = {"action": "read_co2", "service": "read_ambient_temperature"}[kind]
    call, topics = ACTIONS[name].call, ACTIONS["take_thermal_picture"].topics
    assert call is not None
    binding = replace(ACTIONS[name], call=replace(call, readings={}), topics=topics)
    w = world(bindings(actions={name: binding}), canopy=20.0)
    driver = w.connect()

    def triggered(asked: Any) -> None:
        w.robot.canopy = None
        w.graph.disturb("/husky/canopy", Disturbed(delay_s=(after_s, after_s)))
        w.robot.topics["canopy"].send({"temperature": 40.0})

    def read(request: Any) -> dict[str, object]:
        triggered(request)
        return {"ok": True}

    def sample(goal: Any) -> Script:
        triggered(goal)
        return SAMPLED

    w.robot.reading, w.robot.sampler.script = read, sample
    w.graph.disturb("/thermometer reply", Disturbed(delay_s=(2.0, 2.0)))
    if late:
        w.robot.sampler.close()
        w.robot.thermometer.close()
    driver.start_action(capture(name))
    if late:
        for _ in range(10):
            assert not driver.poll().over
            w.clock.advance(0.2)
        w.robot.sampler = ScriptedAction(w.robot.node, "/husky/sample", call.type, w.clock.now, sample)
        w.robot.thermometer = w.robot.node.serve("/thermometer", call.type)
    progress = finish(driver, w.clock)
    assert (progress.what, dict(progress.readings)) == ("", {"canopy_temperature": 40.0})


def test_a_sensor_that_sends_all_the_time_is_read_when_it_has_measured() -> None:
    call, topics = ACTIONS["read_co2"].call, ACTIONS["take_thermal_picture"].topics
    assert call is not None
    binding = replace(ACTIONS["read_co2"], call=replace(call, readings={}), topics=topics)
    w = world(bindings(actions={"read_co2": binding}), canopy=20.0)

    def measured(goal: Any, part: float) -> None:
        w.robot.canopy = 20.0 if part < 1.0 else 40.0

    w.robot.sample = replace(SAMPLED, on_step=measured)
    driver = w.connect()
    driver.start_action(capture())
    assert finish(driver, w.clock).readings == {"canopy_temperature": 40.0}


def test_a_capture_that_is_not_bound_fails_and_is_named_before_a_mission_that_needs_it() -> None:
    w = world(bindings(actions={}))
    driver = w.connect()
    driver.start_action(capture())
    said = "the profile does not define how read_co2 is done over ROS 2"
    assert finish(driver, w.clock).what == said
    with pytest.raises(Ros2Error, match="does not define how the robot does read_co2"):
        w.connect(actions=["read_co2"])


def test_an_action_that_takes_too_long_is_cancelled() -> None:
    w = world(sample=Script(lasts_s=1000.0))
    driver = w.connect()
    driver.start_action(capture())
    progress = finish(driver, w.clock)
    assert (progress.state, progress.what) == ("failed", "/husky/sample did not end within 20 s")
    assert not w.robot.sampler.executing


# --- the robot itself ------------------------------------------------------------------------------------------------


def test_the_emergency_stop_cancels_what_is_under_way_and_everything_after() -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(3.0)
    w.robot.pressed = True
    progress = finish(driver, w.clock)
    said = "the emergency stop was pressed (/husky/stop)"
    assert (progress.state, progress.what, driver.stopped()) == ("cancelled", said, said)
    w.robot.pressed = False
    w.clock.advance(3.0)
    driver.start_action(capture())
    assert (driver.poll().state, driver.stopped()) == ("cancelled", said)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"fix_status": -1}, "no satellite fix"),
        ({"sigma_m": 1.6}, "the position is uncertain by 1.6 m, at most 1 m are allowed"),
        ({"silent": {"fix"}}, "no message on /husky/fix for 2 s"),
    ],
)
def test_a_fix_that_cannot_be_believed_ends_the_drive_as_lost(change: dict[str, Any], said: str) -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(3.0)
    for name, value in change.items():
        setattr(w.robot, name, value)
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault, progress.what) == ("failed", "lost", said)
    assert not w.robot.navigation.executing
    stood = driver.position()
    assert math.dist((stood.x, stood.y), w.robot.xy) < 1.0 + 2.1


def test_a_capture_that_a_robot_makes_while_it_is_lost_does_not_count() -> None:
    w = world(sample=replace(SAMPLED, lasts_s=4.0, cancels=False))
    driver = w.connect()
    driver.start_action(capture())
    w.clock.advance(1.0)
    w.robot.lost = lambda robot: True
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault, dict(progress.readings)) == ("failed", "lost", {})
    assert progress.what == "no satellite fix"
    assert [g.state for g in w.robot.sampler.goals.values()] == ["succeeded"]


def test_a_silent_battery_ends_the_goal_and_lets_none_begin_until_it_speaks() -> None:
    w = world()
    driver = w.connect()
    charge = driver.charge_percent()
    driver.start_drive(drive())
    w.robot.silent = {"battery"}
    progress = finish(driver, w.clock)
    said = "the battery is silent: no message on /husky/battery for 5 s"
    assert (progress.state, progress.fault, progress.what) == ("failed", "failed", said)
    driver.start_action(capture())
    assert driver.poll().state == "failed"
    assert driver.charge_percent() == pytest.approx(charge, abs=0.1)
    w.robot.silent = set()
    w.clock.advance(1.0)
    driver.start_action(capture())
    assert finish(driver, w.clock).state == "succeeded"


def test_a_battery_that_says_nan_keeps_its_last_charge() -> None:
    w = world(percentage=0.75)
    driver = w.connect()
    w.robot.percentage = math.nan
    w.clock.advance(2.0)
    assert driver.charge_percent() == pytest.approx(75.0, abs=0.1)


def test_a_battery_that_says_the_impossible_has_said_nothing() -> None:
    w = world(percentage=0.4)
    driver = w.connect()
    driver.start_drive(drive())
    w.robot.percentage = 87.0
    progress = finish(driver, w.clock)
    assert (progress.state, progress.what[:21]) == ("failed", "the battery is silent")
    assert driver.charge_percent() == pytest.approx(40.0, abs=0.1)
    assert not w.robot.navigation.executing


def test_odometry_that_falls_silent_ends_the_drive_for_nobody_counts_its_metres() -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.robot.silent = {"odom"}
    progress = finish(driver, w.clock)
    assert progress.what == "the odometry is silent: no message on /husky/odom for 2 s"
    assert not w.robot.navigation.executing


def test_a_position_that_jumps_is_lost_until_it_stays_there() -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(3.0)
    driver.poll()
    stood = driver.position()
    w.robot.fix_shift_m = 40.0
    w.clock.advance(0.2)
    progress = finish(driver, w.clock)
    said = "the position jumped by 40 m, farther than the robot drives in that time"
    assert (progress.state, progress.fault, progress.what) == ("failed", "lost", said)
    assert not w.robot.navigation.executing
    assert math.dist((stood.x, stood.y), (driver.position().x, driver.position().y)) < 1.0
    begun = w.clock.now()
    while driver.lost() is not None:
        w.clock.advance(0.2)
    assert w.clock.now() - begun <= JUMPED_S
    assert driver.position().x == pytest.approx(w.robot.xy[0] + 40.0, abs=0.5)


def test_the_fixes_of_two_robots_on_one_topic_are_no_position() -> None:
    w = world()
    driver = w.connect()
    here = w.robot.xy
    seen = set()
    for n in range(100):
        w.robot.fix_shift_m = 40.0 * (n % 2)
        w.clock.advance(0.1)
        seen.add(driver.lost())
        assert math.dist(here, (driver.position().x, driver.position().y)) < 0.1
    assert "the position jumped by 40 m, farther than the robot drives in that time" in seen


def test_a_robot_whose_fix_turns_out_to_be_on_another_site_is_lost() -> None:
    w = world()
    driver = w.connect()
    w.robot.fix_shift_m = 90_000.0
    for _ in range(100):
        w.clock.advance(0.1)
        driver.lost()
    assert driver.lost() == "the robot stands 90 km from the start of grid: it is on another site"
    driver.start_drive(drive())
    assert driver.poll().fault == "lost"


def test_metres_along_the_fixes_where_there_is_no_odometry() -> None:
    w = world(bindings(odometry=None))
    driver = w.connect()
    driver.start_drive(drive())
    progress = finish(driver, w.clock)
    assert progress.metres == pytest.approx(w.robot.driven_m, abs=0.3)


def test_odometry_that_is_set_anew_has_driven_nothing() -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(3.0)
    driver.poll()
    w.robot.driven_m -= 500.0
    progress = finish(driver, w.clock)
    assert progress.metres == pytest.approx(w.robot.driven_m + 500.0, abs=1.0)


def test_messages_that_are_taken_together_were_not_sent_together() -> None:
    """The way driven between them is told from a jump by their own stamps."""
    clock = SimulatedClock()
    graph = Graph(clock.now)
    telemetry = Telemetry(graph.node(), bindings(), SITE.projection, speed_m_s=1.0, clock=clock.now, steady=clock.now)
    topic = graph.node().publish("/husky/odom", "nav_msgs/msg/Odometry")
    for seconds, x in ((0, 0.0), (5, 5.0), (10, 10.0), (11, 500.0), (16, 505.0)):
        topic.send(
            {"header": {"stamp": {"sec": seconds, "nanosec": 0}}, "pose": {"pose": {"position": {"x": x, "y": 0.0}}}}
        )
    telemetry.listen()
    assert telemetry.metres == pytest.approx(15.0)


def test_metres_that_are_told_late_count() -> None:
    """Nobody listened for a while, and the last of them come after the drive is over."""
    w = world()
    w.graph.disturb("*odom", Disturbed(delay_s=(0.3, 0.3)))
    driver = w.connect()
    driver.start_drive(drive())
    for _ in range(3):
        for _ in range(20):
            w.clock.advance(0.25)
            w.robot.step()
    progress = finish(driver, w.clock)
    assert progress.state == "succeeded"
    assert progress.metres == pytest.approx(w.robot.driven_m, abs=0.1)


def test_a_robot_that_is_killed_in_mid_drive_fails_the_drive() -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(3.0)
    w.robot.node.vanish()
    begun = w.clock.now()
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault) == ("failed", "lost")
    assert "no message on /husky/fix" in progress.what
    assert "is gone: nothing answers any more" in progress.what
    assert w.clock.now() - begun < 20.0


def test_a_server_killed_in_mid_goal_while_the_sensors_live() -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(3.0)
    w.robot.navigation.step = lambda: None  # type: ignore[method-assign]
    progress = finish(driver, w.clock)
    assert progress.fault == "failed"
    assert "/husky/navigate_to_pose was silent for 15 s; then" in progress.what
    assert "does not confirm that it was cancelled" in progress.what
    assert "use its emergency stop" in progress.what


def test_a_navigator_that_is_killed_and_started_again_is_two_servers_for_a_while() -> None:
    w = world()
    kind, nodes = w.robot.bound.navigation.type, [w.graph.node(), w.graph.node()]

    def serve(node: Node) -> None:
        name = "/husky/navigate_to_pose"
        w.robot.navigation = ScriptedAction(node, name, kind, w.clock.now, w.robot._set_out)

    w.robot.navigation.close()
    serve(nodes[0])
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(3.0)
    nodes[0].vanish()
    w.clock.advance(2.0)
    serve(nodes[1])
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault) == ("failed", "interrupted")
    assert "/husky/navigate_to_pose no longer knows the goal: it was restarted" in progress.what
    assert driver.away() == "2 servers answer it"
    begun = w.clock.now()
    while driver.away() is not None:
        w.clock.advance(0.2)
        driver.poll()
    assert w.clock.now() - begun < 15.0
    driver.start_drive(drive_goal(driver.position().as_place(), FAR))
    assert finish(driver, w.clock).state == "succeeded"


def test_what_the_network_does_not_take_is_sent_again(monkeypatch: pytest.MonkeyPatch) -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(2.0)

    def refuses(_: object) -> int:
        raise Ros2Error("DDS does not send this message")

    with monkeypatch.context() as broken:
        for client in driver._navigation.client._clients:
            broken.setattr(client, "ask", refuses)
        driver.cancel()
        w.clock.advance(2.0)
        assert driver.poll().state == "running"
        assert w.robot.navigation.executing
    assert finish(driver, w.clock).state == "cancelled"
    assert not w.robot.navigation.executing


def test_who_looks_no_more_leaves_no_goal_behind() -> None:
    w = world()
    driver = w.connect()
    driver.start_drive(drive())
    w.clock.advance(2.0)
    driver.leave(sleep=w.clock.advance)
    assert not w.robot.navigation.executing
    begun = w.clock.now()
    driver.leave(sleep=w.clock.advance)
    assert w.clock.now() == begun


def test_a_robot_that_does_not_stop_is_not_said_to_stand() -> None:
    w = world(refuses_cancel=True)
    driver = w.connect()
    driver.start_drive(replace(drive(), speed_m_s=1.0))
    w.clock.advance(1.0)
    begun = w.clock.now()
    w.robot.blocked = lambda xy: False
    w.robot.way.append((500.0, 0.0))
    driver.cancel()
    progress = finish(driver, w.clock)
    assert (progress.state, progress.fault) == ("failed", "failed")
    assert "refuses to be cancelled" in progress.what
    assert w.clock.now() - begun == pytest.approx(CANCEL_S, abs=1.0)


GOALS = {"near": drive(NEAR), "far": drive(), "sample": capture(), "picture": capture("take_thermal_picture")}


@settings(max_examples=examples(15, thorough=500), deadline=None)
@given(
    plan=st.lists(
        st.tuples(st.sampled_from(sorted(GOALS)), st.none() | st.floats(0.0, 6.0)),
        min_size=2,
        max_size=4,
    ),
    loss=st.sampled_from([0.0, 0.1, 0.4]),
    delay_s=st.sampled_from([0.0, 0.5, 3.0]),
    lost_s=st.none() | st.floats(0.0, 20.0),
    seed=st.integers(0, 999),
)
def test_every_goal_ends_and_a_new_one_begins_only_when_the_robot_is_at_no_other(
    plan: list[tuple[str, float | None]], loss: float, delay_s: float, lost_s: float | None, seed: int
) -> None:
    w = world(seed=seed)
    driver = w.connect()
    for part in ("feedback", "*reply", "*request"):
        w.graph.disturb(f"*/_action/{part}", Disturbed(loss=loss, delay_s=(0.0, delay_s)))
    begun = w.clock.now()
    if lost_s is not None:
        w.robot.lost = lambda robot: lost_s <= w.clock.now() - begun < lost_s + 4.0
    for what, cancel_s in plan:
        since = w.clock.now()
        goal = GOALS[what]
        if isinstance(goal, DriveGoal):
            driver.start_drive(goal)
        else:
            driver.start_action(goal)
        while not driver.poll().over:
            assert len(w.robot.navigation.executing) + len(w.robot.sampler.executing) <= 1
            if cancel_s is not None and w.clock.now() - since >= cancel_s:
                driver.cancel()
            w.clock.advance(0.25)
            assert w.clock.now() - since < 120.0
        progress = driver.poll()
        assert (progress.fault == "none") == (progress.state in ("succeeded", "cancelled"))
        assert progress.state == "succeeded" or progress.what
        if progress.state == "succeeded" and isinstance(goal, DriveGoal):
            assert math.dist(w.robot.xy, goal.path_m[-1]) < 0.3
        if "emergency stop" not in progress.what:
            assert not w.robot.navigation.executing
            assert not w.robot.sampler.executing


# --- before a mission ------------------------------------------------------------------------------------------------


def why(w: World, **changes: Any) -> str:
    with pytest.raises(Ros2Error) as caught:
        w.connect(within_s=3.0, **changes)
    return str(caught.value)


def test_everything_that_is_missing_is_named_at_once() -> None:
    w = world()
    w.clock.robots.clear()
    w.robot.node.close()
    said = why(w)
    for name in ("navigation /husky/navigate_to_pose: there is no server",
                 "the position /husky/fix: there is no publisher",
                 "the battery /husky/battery", "the odometry /husky/odom", "the emergency stop /husky/stop",
                 "read_co2 /husky/sample", "read_ambient_temperature /thermometer",
                 "canopy_temperature of take_thermal_picture /husky/canopy"):  # fmt: skip
        assert name in said, name
    advised = [part.strip() for part in said.split(";") if "ROS_DOMAIN_ID" in part]
    assert len(advised) == len(set(advised)) == 1


def test_only_what_the_mission_needs_must_be_there() -> None:
    w = world()
    for server in [e for e in w.graph.ends if "sample" in e.name]:
        server.close()
    assert "read_co2 /husky/sample: there is no server" in why(w)
    assert isinstance(w.connect(actions=["read_ambient_temperature"]), Ros2Driver)


def test_a_wrong_type_or_quality_is_said_with_what_there_is() -> None:
    fix = replace(bindings().position.fix, reliable=True)
    w = world(bindings(position=replace(bindings().position, fix=fix)))
    w.graph.ends = [e for e in w.graph.ends if e.name != "/thermometer"]
    w.robot.node.serve("/thermometer", "std_srvs/srv/Trigger")
    said = why(w)
    assert "the position /husky/fix: it is sent best effort and read reliably" in said
    assert (
        "read_ambient_temperature /thermometer: it is answered as std_srvs/srv/Trigger, not as farm_msgs/srv/Read"
        in said
    )


def test_two_robots_under_one_name_are_refused() -> None:
    w = world()
    bound = w.robot.bound.navigation
    ScriptedAction(w.graph.node(), "/husky/navigate_to_pose", bound.type, w.clock.now, lambda goal: Script())
    assert "2 servers answer it" in why(w)


def test_services_of_another_middleware_are_refused_with_what_to_set() -> None:
    w = world()
    w.robot.node.rmw = "fastrtps"
    assert "set RMW_IMPLEMENTATION=rmw_cyclonedds_cpp on the robot" in why(w)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"percentage": 87.0},
            "the battery /husky/battery: it says 8700 percent, which is not a valid charge; correct its scale",
        ),
        ({"percentage": math.nan}, "the battery /husky/battery: it has no number at percentage"),
        ({"fix_status": -1}, "the position /husky/fix: no satellite fix"),
        ({"pressed": True}, "the emergency stop was pressed (/husky/stop); release it"),
        ({"xy": (90_000.0, 0.0)}, "the robot stands 90 km from the start of grid: it is on another site"),
        ({"silent": {"battery"}}, "the battery /husky/battery: no message yet"),
    ],
)
def test_a_robot_that_is_not_ready_is_said_to_be(change: dict[str, Any], said: str) -> None:
    assert said in why(world(**change))


def test_an_emergency_stop_that_cannot_be_read_is_none_that_is_not_pressed() -> None:
    stop = bindings().stop
    assert stop is not None
    w = world(bindings(stop=replace(stop, path="pressed")))
    assert "the emergency stop /husky/stop: pressed is None, neither true nor false" in why(w)


def test_a_profile_that_says_nothing_of_ros_is_refused() -> None:
    w = world()
    w.profile = replace(husky(), ros2=None)
    with pytest.raises(Ros2Error, match="does not define how the robot is reached over ROS 2"):
        Ros2Driver(w.computer, SITE, w.profile, clock=w.clock)


def test_a_goal_that_an_earlier_mission_left_behind_is_over_before_the_driver_is_there() -> None:
    w = world()
    earlier = ActionClient(
        w.graph.node(), "/husky/navigate_to_pose", w.robot.bound.navigation.type, steady=w.clock.now, accept_s=5.0
    )
    earlier.start({"pose": {"pose": {"position": {"x": 500.0}}}})
    earlier.step()
    w.clock.advance(2.0)
    assert w.robot.navigation.executing
    driver = w.connect()
    assert not w.robot.navigation.executing
    assert driver.poll().state == "idle"


@pytest.mark.parametrize("refuses", [False, True])
def test_a_goal_that_was_left_behind_is_waited_for_even_if_nobody_tells_of_it(refuses: bool) -> None:
    w = world(refuses_cancel=refuses)
    earlier = ActionClient(
        w.graph.node(), "/husky/navigate_to_pose", w.robot.bound.navigation.type, steady=w.clock.now, accept_s=5.0
    )
    earlier.start({"pose": {"pose": {"position": {"x": 500.0}}}})
    earlier.step()
    w.clock.advance(2.0)
    w.graph.disturb("*/_action/status", Disturbed(delay_s=(8.0, 8.0)))
    w.robot.navigation._tell()
    if refuses:
        assert "did not confirm within 15 s that all goals are cancelled; check which other program" in why(w)
    else:
        w.connect()
        assert not w.robot.navigation.executing
