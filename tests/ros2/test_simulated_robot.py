"""A simulated robot on ROS 2 does what Nav2 and a robot's own nodes do, with what its world says."""

from __future__ import annotations

import itertools
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import InputError, OutputError
from fieldhand.execution.drivers.ros2.map_frame import degrees_to_map, map_to_degrees
from fieldhand.execution.drivers.ros2.simulated_robot.state_file import Identity, read_state, write_state
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    Blocked,
    DriveFails,
    LocalisationLost,
    RobotStops,
    SensorSilent,
    TreeRef,
    Truth,
    World,
)
from fieldhand.robot.bindings import Datum, FieldBinding
from fieldhand.robot.loader import load_robot
from fieldhand.site.projection import Projection
from ros2.simulated_robot_rig import SITE, STEP_S, SimulatedRobotRig, bindings, pose, reached_by
from support.examples import examples
from support.missions.rig import husky

TO_POSE, THROUGH, GPS = (
    f"nav2_msgs/action/{name}" for name in ("NavigateToPose", "NavigateThroughPoses", "FollowGPSWaypoints")
)
FAR = SITE.trees[4].place
START = SITE.start.xy
WAY = ((10.0, -3.0), (10.0, 2.5), (2.5, 2.5))
PICTURE = ("thermal_camera/take_picture", "fieldhand_husky/action/TakeThermalPicture")
CO2 = ("co2_sensor/read", "fieldhand_husky/srv/ReadCo2")
AIR = ("air_temperature", "sensor_msgs/msg/Temperature")


def length(*path: tuple[float, float]) -> float:
    return sum(math.dist(a, b) for a, b in itertools.pairwise(path))


@pytest.mark.parametrize(
    ("distro", "kind", "from_ll"),
    [
        ("humble", THROUGH, "fromLL"),
        ("jazzy", THROUGH, "fromLL"),
        ("kilted", THROUGH, "fromLL"),
        ("iron", GPS, ""),
        ("kilted", GPS, ""),
    ],
)
def test_it_drives_through_every_corner_and_takes_what_its_profile_says(distro: str, kind: str, from_ll: str) -> None:
    rig = SimulatedRobotRig(robot=reached_by(husky(), distro=distro, type=kind, from_ll=from_ll))
    charged = rig.charge()
    begun = rig.clock.now()
    odometry = [
        (m["pose"]["pose"]["position"]["x"], m["pose"]["pose"]["position"]["y"])
        for m in _while_driving(rig, *WAY, topic=("odometry/filtered", "nav_msgs/msg/Odometry"))
    ]
    took = rig.clock.now() - begun
    metres = length(START, *WAY)
    assert rig.here() == pytest.approx(WAY[-1], abs=1e-6)
    assert took == pytest.approx(metres, abs=1.0)  # at 1 m/s
    assert length(*odometry) == pytest.approx(metres, abs=0.1)
    assert charged - rig.charge() == pytest.approx(husky().percent(metres, took), rel=0.1)
    assert [(said.end, said.name.split("/")[-1]) for said in rig.said] == [("succeeded", rig.navigation.name[1:])]


def _while_driving(rig: SimulatedRobotRig, *way: tuple[float, float], topic: tuple[str, str]) -> list[dict]:
    subscription = rig.client.subscribe(bindings(rig.robot).whole_name(topic[0]), topic[1])
    rig.navigation.start(rig.goal(*way))
    messages: list[dict] = []
    while rig.navigation.step() is None:
        rig.step()
        messages += subscription.take()
    rig.step(0.2)
    assert rig.navigation.step().how == "succeeded"
    return [*messages, *subscription.take()]


@pytest.mark.parametrize(
    ("percentage", "limit", "speed"), [(False, 0.5, 0.5), (True, 25.0, 0.25), (False, 9.0, 1.0), (True, 0.0, 1.0)]
)
def test_it_drives_no_faster_than_it_is_told(percentage: bool, limit: float, speed: float) -> None:
    rig = SimulatedRobotRig(robot=reached_by(husky(), speed_limit="speed_limit"))
    told = rig.client.publish("/speed_limit", "nav2_msgs/msg/SpeedLimit")
    told.send({"percentage": percentage, "speed_limit": limit})
    rig.drive((0.0, -3.0))
    assert rig.said[0].took_s == pytest.approx(rig.said[0].metres / speed)


def test_feedback_says_how_far_it_is() -> None:
    rig = SimulatedRobotRig(robot=reached_by(husky(), type=THROUGH))
    rig.navigation.start(rig.goal(*WAY))
    left, ahead = [], []
    while rig.navigation.step() is None:
        rig.step()
        if rig.navigation.feedback:
            left.append(rig.navigation.feedback["distance_remaining"])
            ahead.append(rig.navigation.feedback["number_of_poses_remaining"])
    assert left == sorted(left, reverse=True)
    assert left[0] == pytest.approx(length(START, *WAY), abs=0.2)
    assert left[-1] < 0.3
    assert [n for k, n in enumerate(ahead) if k == 0 or ahead[k - 1] != n] == [3, 2, 1]


@pytest.mark.parametrize(
    ("kind", "goal"),
    [
        (TO_POSE, {"pose": pose(1.0, 1.0, frame="odom")}),
        (TO_POSE, {"pose": pose(math.nan, 1.0)}),
        (TO_POSE, {"pose": pose(1.0, 1.0, x=0.0, y=0.0, z=0.0, w=0.0)}),
        (TO_POSE, {"pose": pose(1.0, 1.0, x=0.0, y=0.0, z=0.0, w=math.nan)}),
        (TO_POSE, {}),
        (THROUGH, {"poses": []}),
        (THROUGH, {"poses": [pose(1.0, 1.0), pose(math.inf, 1.0)]}),
        (GPS, {"gps_poses": []}),
        (GPS, {"gps_poses": [{"position": {"latitude": 91.0}, "orientation": {"w": 1.0}}]}),
        (GPS, {"gps_poses": [{"position": {"latitude": 37.0, "longitude": -120.0}}], "number_of_loops": 2}),
        (GPS, {"gps_poses": [{"position": {"latitude": 37.0, "longitude": -120.0}}], "goal_index": 1}),
    ],
)
def test_a_malformed_goal_is_rejected_and_nothing_moves(kind: str, goal: dict) -> None:
    rig = SimulatedRobotRig(
        robot=reached_by(husky(), distro="jazzy", type=kind, from_ll="" if kind == GPS else "fromLL")
    )
    rig.navigation.start(goal)
    assert rig.finish(rig.navigation).how == "rejected"
    assert rig.here() == pytest.approx(START, abs=1e-6)
    assert [(said.end, bool(said.why)) for said in rig.said] == [("rejected", True)]


def test_a_newer_goal_takes_over_where_the_robot_is_and_the_older_is_aborted() -> None:
    rig = SimulatedRobotRig()
    older, newer = rig.navigation, rig.action("navigate_to_pose", TO_POSE)
    older.start(rig.goal(FAR.xy))
    rig.during(5.0, older)
    newer.start(rig.goal((0.0, -3.0)))
    assert rig.finish(newer).how == "succeeded"
    assert older.step().how == "aborted"
    assert [said.end for said in rig.said] == ["pre-empted", "succeeded"]
    assert rig.here() == pytest.approx((0.0, -3.0), abs=1e-6)
    assert rig.said[1].metres == pytest.approx(math.dist((-5.0 + rig.said[0].metres, 0.0), (0.0, -3.0)), abs=0.1)


def test_a_cancelled_drive_stands_still_where_it_was() -> None:
    rig = SimulatedRobotRig()
    rig.navigation.start(rig.goal(FAR.xy))
    rig.during(5.0, rig.navigation)
    rig.navigation.cancel()
    assert rig.finish(rig.navigation).how == "cancelled"
    stood = rig.here()
    rig.step(5.0)
    assert rig.here() == stood
    assert START[0] + 3.0 < stood[0] < START[0] + 7.0


@pytest.mark.parametrize(
    ("distro", "fault", "code"),
    [
        ("humble", Blocked(at=TreeRef(id=FAR.id), within_m=2.0), None),
        ("jazzy", Blocked(at=TreeRef(id=FAR.id), within_m=2.0), 105),
        ("kilted", LocalisationLost(at_s=3.0, for_s=20.0), 102),
        ("jazzy", DriveFails(at=TreeRef(id=FAR.id)), 100),
        ("jazzy", RobotStops(at_s=3.0), 100),
    ],
)
def test_a_drive_that_fails_is_aborted_with_the_code_of_nav2(distro: str, fault: object, code: int | None) -> None:
    rig = SimulatedRobotRig(world=World(faults=(fault,)), robot=reached_by(husky(), distro=distro))
    outcome = rig.drive(FAR.xy)
    assert outcome.how == "aborted"
    assert outcome.result.get("error_code") == code
    assert bool(outcome.result.get("error_msg")) == (distro in ("jazzy", "kilted") and "error_msg" in outcome.result)


def test_a_waypoint_that_is_missed_is_named_with_the_code_of_nav2() -> None:
    world = World(faults=(Blocked(at=TreeRef(id=FAR.id), within_m=2.0),))
    rig = SimulatedRobotRig(world=world, robot=reached_by(husky(), distro="kilted", type=GPS, from_ll=""))
    outcome = rig.drive((0.0, -2.5), FAR.xy)
    assert (outcome.how, outcome.result["error_code"]) == ("aborted", 603)
    (missed,) = outcome.result["missed_waypoints"]
    assert (missed["waypoint_index"], missed["error_code"]) == (1, 105)


def test_a_goal_outside_of_the_map_is_aborted() -> None:
    rig = SimulatedRobotRig(robot=reached_by(husky(), distro="jazzy"))
    assert rig.drive((50_000.0, 0.0)).result["error_code"] == 204


def test_a_lost_robot_has_no_fix_until_it_is_found() -> None:
    rig = SimulatedRobotRig(world=World(faults=(LocalisationLost(at_s=3.0, for_s=5.0),)))
    fixes = rig.heard("gps/fix", "sensor_msgs/msg/NavSatFix", seconds=10.0)
    lost = [_seconds(fix["header"]["stamp"]) for fix in fixes if fix["status"]["status"] == -1]
    assert (min(lost), max(lost)) == pytest.approx((3.0, 8.0), abs=1.5 * STEP_S)
    assert all(math.isnan(f["latitude"]) == (f["status"]["status"] == -1) for f in fixes)


def test_an_emergency_stop_is_said_on_its_topic() -> None:
    rig = SimulatedRobotRig(world=World(faults=(RobotStops(at_s=3.0),)))
    said = [m["data"] for m in rig.heard("platform/emergency_stop", "std_msgs/msg/Bool", seconds=6.0)]
    assert said == sorted(said)
    assert set(said) == {False, True}


TRUTH = World(
    readings={
        name: Truth(default=20.0 + k, trees=((TreeRef(id="r1c1"), 30.0 + k),))
        for k, name in enumerate(("canopy_temperature", "ambient_temperature"))
    }
    | {"co2": Truth(default=400.0, trees=((TreeRef(id="r1c1"), 390.0),))}
)


def test_a_capture_is_made_at_the_place_that_its_request_names() -> None:
    rig = SimulatedRobotRig(world=TRUTH)
    picture = rig.action(*PICTURE)
    for place, kelvin, ppm in (("r1c1", 303.15, 390.0), ("r0c0", 293.15, 400.0)):
        picture.start({"place": place, "kind": "tree"})
        outcome = rig.finish(picture)
        assert (outcome.how, outcome.result["mean_temperature"]) == ("succeeded", pytest.approx(kelvin))
        answer = rig.ask(*CO2, place=place, kind="tree")
        assert (answer["success"], answer["co2_ppm"]) == (True, ppm)
    assert [said.place for said in rig.said] == ["tree r1c1"] * 2 + ["tree r0c0"] * 2
    assert [said.took_s for said in rig.said] == [pytest.approx(s) for s in (8, 15, 8, 15)]


def test_a_sensor_that_is_only_listened_to_measures_where_the_robot_stands() -> None:
    rig = SimulatedRobotRig(world=TRUTH)
    assert {m["temperature"] for m in rig.heard(*AIR, seconds=5.0)} == {21.0}
    driving = [m["temperature"] for m in _while_driving(rig, (5.0, 3.5), topic=AIR)]
    assert driving == []
    assert {m["temperature"] for m in rig.heard(*AIR, seconds=5.0)} == {31.0}


def test_a_capture_that_fails_says_so_and_the_next_may_not() -> None:
    fails = tuple(ActionFails(action=name, times=1) for name in ("take_thermal_picture", "read_co2"))
    rig = SimulatedRobotRig(world=World(faults=fails))
    picture = rig.action(*PICTURE)
    for how, success in (("aborted", False), ("succeeded", True)):
        picture.start({"place": "r0c0", "kind": "tree"})
        outcome = rig.finish(picture)
        assert (outcome.how, outcome.result["success"], bool(outcome.result["message"])) == (how, success, not success)
        answer = rig.ask(*CO2, place="r0c0", kind="tree")
        assert (answer["success"], bool(answer["message"])) == (success, not success)


def test_a_silent_sensor_gives_nan_where_it_is_asked_and_nothing_for_a_while_where_it_is_listened_to() -> None:
    silent = tuple(SensorSilent(quantity=name, times=1) for name in ("co2", "ambient_temperature"))
    rig = SimulatedRobotRig(world=World(faults=silent))
    assert len(rig.heard(*AIR, seconds=2.0)) > 0  # beside no tree a fault waits
    rig.drive((0.0, -1.5))
    within_s = bindings(rig.robot).actions["read_ambient_temperature"].topics["ambient_temperature"].within_s
    assert rig.heard(*AIR, seconds=within_s) == ()
    assert len(rig.heard(*AIR, seconds=within_s)) > 0
    answer = rig.ask(*CO2, place="r0c0", kind="tree")
    assert answer["success"]
    assert math.isnan(answer["co2_ppm"])


def test_a_silent_sensor_whose_type_cannot_say_so_fails() -> None:
    robot = husky()
    ros2 = bindings(robot)
    action = ros2.actions["read_co2"]
    call = replace(action.call, type="test_msgs/srv/Whole", readings={"co2": FieldBinding(path="ppm", scale=2.0)})
    own = {
        **ros2.interfaces,
        "test_msgs/srv/Whole": "string place\nstring kind\n---\nbool success\nstring message\nuint16 ppm\n",
    }
    actions = {**ros2.actions, "read_co2": replace(action, call=call)}
    robot = replace(robot, ros2=replace(ros2, actions=actions, interfaces=own))
    truth = {"co2": Truth(default=401.0)}
    rig = SimulatedRobotRig(robot=robot, world=World(readings=truth, faults=(SensorSilent(quantity="co2", times=1),)))
    first, second = (rig.ask(CO2[0], "test_msgs/srv/Whole", place="r0c0", kind="tree") for _ in range(2))
    assert not first["success"]
    assert (second["success"], second["ppm"]) == (True, 200)


def test_one_thing_at_a_time() -> None:
    rig = SimulatedRobotRig()
    picture = rig.action(*PICTURE)
    picture.start({"place": "r0c0", "kind": "tree"})
    rig.during(1.0, picture)
    assert rig.drive(FAR.xy).how == "rejected"
    assert "take_thermal_picture" in rig.ask(*CO2, place="r0c0")["message"]
    assert rig.finish(picture).how == "succeeded"
    assert rig.drive(FAR.xy).how == "succeeded"


def test_a_cancelled_capture_is_over_at_once_and_says_nothing_measured() -> None:
    rig = SimulatedRobotRig()
    picture = rig.action(*PICTURE)
    picture.start({"place": "r0c0", "kind": "tree"})
    rig.during(1.0, picture)
    picture.cancel()
    assert rig.finish(picture).how == "cancelled"
    assert rig.clock.now() < 2.0
    assert rig.drive(FAR.xy).how == "succeeded"


UUIDS = st.binary(min_size=16, max_size=16).filter(any)


@settings(max_examples=examples(6, thorough=100), deadline=None)
@given(
    goals=st.lists(UUIDS, min_size=1, max_size=4, unique=True),
    other=UUIDS,
    picked=st.integers(0, 3),
    all_=st.booleans(),
)
def test_requests_to_cancel_keep_to_the_rules_of_ros(goals: list[bytes], other: bytes, picked: int, all_: bool) -> None:
    rig = SimulatedRobotRig()
    send = rig.client.client("/navigate_to_pose/_action/send_goal", f"{TO_POSE}_SendGoal")
    for identity in (*goals, goals[0]):
        send.ask({"goal_id": {"uuid": identity}, "goal": {"pose": pose(20.0, 0.0)}})
        rig.step()
    assert [reply["accepted"] for _, reply in send.replies()] == [True] * len(goals) + [False]

    def cancel(identity: bytes) -> tuple[int, list[bytes]]:
        asked = {"goal_id": {"uuid": identity}}
        answer = rig.ask("navigate_to_pose/_action/cancel_goal", "action_msgs/srv/CancelGoal", goal_info=asked)
        return answer["return_code"], [info["goal_id"]["uuid"] for info in answer["goals_canceling"]]

    def status(identity: bytes) -> int:
        asked = {"uuid": identity}
        return rig.ask("navigate_to_pose/_action/get_result", f"{TO_POSE}_GetResult", goal_id=asked)["status"]

    running, chosen = goals[-1], goals[picked % len(goals)]
    assert cancel(other) == (2, []) or other in goals
    if chosen != running:
        assert cancel(chosen) == (3, [])  # pre-empted before: it is over
        assert status(chosen) == 6
    assert cancel(bytes(16) if all_ else running) == (0, [running])
    assert status(running) == 5
    assert cancel(running) == (3, [])
    assert cancel(bytes(16)) == (0, [])
    assert status(other) == 0 or other in goals


@settings(max_examples=examples(30, thorough=300), deadline=None)
@given(st.floats(-80, 80), st.floats(-179, 179), st.floats(-360, 360), st.floats(-4000, 4000), st.floats(-4000, 4000))
def test_a_map_frame_leads_to_degrees_and_back_and_keeps_lengths(
    lat: float, lon: float, heading: float, x: float, y: float
) -> None:
    datum = Datum(lat=lat, lon=lon, heading_deg=heading)
    there = map_to_degrees(datum, (x, y))
    assert degrees_to_map(datum, [there])[0] == pytest.approx((x, y), abs=1e-3)
    east, north = Projection(lat, lon).metres(*there)[0]
    assert math.hypot(east, north) == pytest.approx(math.hypot(x, y), abs=1e-3)


def test_the_x_axis_of_a_map_leads_where_its_datum_says() -> None:
    for heading, point in ((90.0, (10.0, 0.0)), (0.0, (0.0, 10.0)), (180.0, (0.0, -10.0))):
        there = map_to_degrees(Datum(lat=37.0, lon=-120.0, heading_deg=heading), (10.0, 0.0))
        assert Projection(37.0, -120.0).metres(*there)[0] == pytest.approx(point, abs=1e-6)


@settings(max_examples=examples(3, thorough=40), deadline=None)
@given(cut=st.integers(0, 4), seed=st.integers(0, 99))
def test_a_robot_that_was_killed_between_goals_goes_on_as_if_nothing_had_been(cut: int, seed: int) -> None:
    faults = (ActionFails(action="read_co2", times=1), Blocked(at=TreeRef(id="r0c2"), within_m=1.0, times=1))
    world = World(faults=faults)

    def do(rig: SimulatedRobotRig, number: int) -> None:
        if number % 2:
            rig.drive((2.5 + 2.5 * number, -0.5 if number == 1 else -2.5))
        else:
            rig.ask(*CO2, place="r0c0", kind="tree")

    whole = SimulatedRobotRig(world=world, robot=husky(alpha=0.5), seed=seed)
    first = SimulatedRobotRig(world=world, robot=husky(alpha=0.5), seed=seed)
    for number in range(4):
        do(whole, number)
    for number in range(cut):
        do(first, number)
    second = SimulatedRobotRig(world=world, robot=husky(alpha=0.5), seed=seed + 1, state=first.simulated.state())
    for number in range(cut, 4):
        do(second, number)
    ends = [(s.name, s.end, s.readings, s.place, pytest.approx(s.metres)) for s in whole.said]
    assert [(s.name, s.end, s.readings, s.place, s.metres) for s in (*first.said, *second.said)] == ends
    assert second.here() == pytest.approx(whole.here(), abs=1e-6)
    assert second.charge() == pytest.approx(whole.charge(), abs=0.05)


IDENTITY = Identity(site="a", robot="b", world="c")


def test_what_is_written_of_a_robot_is_read_again(tmp_path: Path) -> None:
    rig = SimulatedRobotRig(world=World(faults=(LocalisationLost(at=TreeRef(id="r0c0"), within_m=2.0),)))
    rig.ask(*CO2, place="r0c0", kind="tree")
    assert rig.drive(FAR.xy).how == "aborted"
    path = tmp_path / "state.json"
    assert read_state(path, IDENTITY) is None
    write_state(path, rig.simulated.state(), IDENTITY)
    assert read_state(path, IDENTITY) == rig.simulated.state()
    assert rig.simulated.state().lost == ((math.inf, "no position at tree r0c0"),)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"robot": "x"}, "of a robot with another robot"),
        ({"format": 2}, "is not the state of a simulated robot: format"),
        ({"charge_percent": 101}, "is not the state of a simulated robot: charge_percent"),
        ({"x": "east"}, "is not the state of a simulated robot: x"),
        ({"more": 1}, "is not the state of a simulated robot: more"),
    ],
)
def test_what_is_no_state_of_this_robot_is_refused(tmp_path: Path, change: dict, said: str) -> None:
    path = tmp_path / "state.json"
    write_state(path, SimulatedRobotRig().simulated.state(), IDENTITY)
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(InputError, match=said):
        read_state(path, IDENTITY)


def test_a_state_that_cannot_be_read_or_written_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is not a file"):
        read_state(tmp_path, IDENTITY)
    with pytest.raises(OutputError, match="cannot be written"):
        write_state(tmp_path / "no" / "state.json", SimulatedRobotRig().simulated.state(), IDENTITY)
    with pytest.raises(ValueError, match="generator"):
        SimulatedRobotRig(state=replace(SimulatedRobotRig().simulated.state(), generator={"bit_generator": "dice"}))


def test_the_time_is_on_the_clock_and_goes_on_after_a_new_beginning() -> None:
    first = SimulatedRobotRig()
    said = [_seconds(m["clock"]) for m in first.heard("/clock", "rosgraph_msgs/msg/Clock")]
    assert said == pytest.approx([STEP_S * n for n in range(len(said))])
    second = SimulatedRobotRig(state=first.simulated.state())
    (later,) = second.heard("/clock", "rosgraph_msgs/msg/Clock", seconds=STEP_S)
    assert _seconds(later["clock"]) == pytest.approx(2.0)


def _seconds(stamp: dict[str, int]) -> float:
    return stamp["sec"] + 1e-9 * stamp["nanosec"]


def test_both_builtin_robots_can_be_simulated_and_do_all_that_they_can() -> None:
    robot = load_robot("amiga")
    rig = SimulatedRobotRig(robot=robot)
    assert rig.drive((10.0, -3.0)).how == "succeeded"
    for name, bound in bindings(robot).actions.items():
        call = bound.call
        assert call is not None
        request = {"place": "r0c3", "kind": "tree"}
        if call.kind == "service":
            assert rig.ask(call.name, call.type, view="trunk", **request)["success"]
        else:
            action = rig.action(call.name, call.type)
            action.start(request)
            outcome = rig.finish(action)
            assert outcome.how == "succeeded", name
            for quantity, binding in call.readings.items():
                value = outcome.result["value"] * binding.scale
                assert robot.quantity[quantity].minimum <= value <= robot.quantity[quantity].maximum
