"""How a robot is reached over ROS 2 is read as it stands, with its short cuts; what does not fit is told, all of it."""

from __future__ import annotations

import copy
from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.errors import ProfileError
from fieldhand.robot.bindings import ActionBinding, CallBinding, Datum, FieldBinding, NextMessage, Ros2Bindings
from fieldhand.robot.loader import load_robot, parse_profile, profile_bytes, robot_names
from fieldhand.robot.units import conversion, known_units
from support.processes.command import fieldhand

PROBE = "string place\nfloat64 depth\n---\nbool ok\nstring why\nfloat64 value\n---\nfloat32 progress\n"
ROVER = {
    "name": "rover",
    "speed_m_s": 1,
    "width_m": 0.5,
    "energy": {"capacity_j": 1e6, "drive_j_per_m": 50, "idle_w": 10, "reserve_percent": 20},
    "leg_cost": {"alpha": 0.5},
    "quantities": {
        name: {"unit": unit, "words": [word], "minimum": 0, "maximum": 50, "typical": 20, "spread": 1}
        for name, unit, word in (("moisture", "percent", "moisture"), ("air", "degC", "air"))
    },
    "actions": {
        "probe_soil": {
            "words": ["probe"],
            "measures": ["moisture", "air"],
            "parameters": {"depth_cm": {"default": 10, "minimum": 5, "maximum": 50, "unit": "cm"}},
            "duration_s": 20,
            "energy_j": 100,
        }
    },
    "ros2": {
        "distro": "jazzy",
        "namespace": "rover_1",
        "navigation": {"datum": {"lat": 37.2, "lon": -120.4}},
        "position": {"topic": "gps/fix"},
        "battery": {"topic": "battery_state"},
        "actions": {
            "probe_soil": {
                "action": {
                    "name": "/probe/measure",
                    "type": "rover_probe/action/Measure",
                    "request": {"place": "$place", "depth": "$depth_cm", "fast": True, "tries": 3},
                    "readings": {"moisture": "value"},
                    "success": "ok",
                    "message": "why",
                },
                "topics": {"air": {"topic": "air", "type": "sensor_msgs/msg/Temperature"}},
            }
        },
        "interfaces": {"rover_probe/action/Measure": PROBE},
    },
}
MEASURE = "actions.probe_soil.action"
AIR = "actions.probe_soil.topics.air"


def changed(**values: object) -> bytes:
    """ROVER with keys of its ``ros2`` part changed, by their paths with ``__`` for dots; ``...`` takes one out."""
    document = copy.deepcopy(ROVER)
    for path, value in values.items():
        *parents, last = path.split("__")
        inside = document["ros2"]
        for key in parents:
            inside = inside[key]
        if value is ...:
            del inside[last]
        else:
            inside[last] = value
    return yaml.safe_dump(document).encode()


def bound(**values: object) -> Ros2Bindings:
    ros2 = parse_profile(changed(**values)).ros2
    assert ros2 is not None
    return ros2


def test_bindings_are_read_with_their_short_cuts() -> None:
    ros2 = bound()
    assert ros2.whole_name(ros2.navigation.action) == "/rover_1/navigate_to_pose"
    assert ros2.navigation.type == "nav2_msgs/action/NavigateToPose"
    assert ros2.navigation.datum == Datum(lat=37.2, lon=-120.4, heading_deg=90.0)
    assert ros2.battery.value == FieldBinding(path="percentage", scale=100.0)
    assert ros2.battery.topic.type == "sensor_msgs/msg/BatteryState"
    assert (ros2.odometry, ros2.stop, ros2.use_sim_time) == (None, None, False)
    assert ros2.interfaces == {"rover_probe/action/Measure": PROBE}
    assert ros2.actions["probe_soil"] == ActionBinding(
        call=CallBinding(
            kind="action",
            name="/probe/measure",
            type="rover_probe/action/Measure",
            request={"place": "$place", "depth": "$depth_cm", "fast": True, "tries": 3},
            readings={"moisture": FieldBinding(path="value")},
            success="ok",
            message="why",
            within_s=60.0,
        ),
        topics={
            "air": NextMessage(
                topic="air", type="sensor_msgs/msg/Temperature", value=FieldBinding(path="temperature"), within_s=60.0
            )
        },
    )


def test_a_constant_of_a_request_stays_what_it_is() -> None:
    call = bound().actions["probe_soil"].call
    assert call is not None
    assert [type(value) for value in call.request.values()] == [str, bool, str, int]


def test_a_robot_without_the_part_is_only_simulated() -> None:
    document = {key: value for key, value in ROVER.items() if key != "ros2"}
    assert parse_profile(yaml.safe_dump(document).encode()).ros2 is None


@pytest.mark.parametrize(
    ("battery", "value"),
    [
        ({"unit": "percent"}, FieldBinding(path="percentage")),
        ({"scale": 1.0}, FieldBinding(path="percentage")),
        ({"type": "std_msgs/msg/Float32"}, FieldBinding(path="data")),
        ({"type": "std_msgs/msg/Float32", "unit": "fraction"}, FieldBinding(path="data", scale=100.0)),
        (
            {"path": "voltage", "scale": 20, "offset": -400},
            FieldBinding(path="voltage", scale=20.0, offset=-400.0),
        ),
    ],
)
def test_the_charge_comes_in_percent_however_it_is_sent(battery: dict[str, object], value: FieldBinding) -> None:
    assert bound(battery={"topic": "b", **battery}).battery.value == value


@given(st.sampled_from(known_units()), st.sampled_from(known_units()), st.floats(-1e6, 1e6))
def test_a_unit_turned_into_another_and_back_is_what_it_was(one: str, other: str, value: float) -> None:
    there, back = conversion(one, other), conversion(other, one)
    assert (there is None) == (back is None)
    if there is not None and back is not None:
        turned = (value * there[0] + there[1]) * back[0] + back[1]
        assert turned == pytest.approx(value, rel=1e-9, abs=1e-6 * abs(back[0]) + 1e-9)


def test_units_are_those_of_physics() -> None:
    for given_, wanted, value, turned in (
        ("K", "degC", 300.0, 26.85),
        ("degF", "degC", 212.0, 100.0),
        ("degC", "K", 0.0, 273.15),
        ("fraction", "percent", 0.25, 25.0),
        ("percent", "ppm", 1.0, 10_000.0),
        ("S/m", "dS/m", 0.2, 2.0),
        ("mS/cm", "dS/m", 2.0, 2.0),
        ("km/h", "m/s", 36.0, 10.0),
    ):
        scale, offset = conversion(given_, wanted) or (0.0, 0.0)
        assert value * scale + offset == pytest.approx(turned)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ({"distro": "foxy"}, "ros2.distro: must be 'humble', 'iron', 'jazzy' or 'kilted', is foxy"),
        ({"navigation": ...}, "ros2: the key 'navigation' is missing"),
        ({"batery": {}}, "ros2: unknown key 'batery'; did you mean 'battery'?"),
        ({"namespace": "a b"}, "ros2.namespace: 'a b' is not a ROS name"),
        ({"position__topic": "gps//fix"}, "ros2.position.topic: 'gps//fix' is not a ROS name"),
        ({"position__type": "sensor_msgs/msg/Imu"}, "ros2.position.type: must be 'sensor_msgs/msg/NavSatFix'"),
        ({"position__stale_s": 0}, "ros2.position.stale_s: must be greater than 0, is 0"),
        ({"position__most_sigma_m": 1e9}, "ros2.position.most_sigma_m: must be less than or equal to 100"),
        ({"position__transient": True}, "ros2.position: transient needs reliable; add reliable: true"),
        ({"navigation__type": "Spin"}, "ros2.navigation.type: must be 'nav2_msgs/action/NavigateToPose'"),
        ({"navigation__from_ll": "fromLL"}, "ros2.navigation: give either datum (where the map frame lies) or from_ll"),
        ({"navigation__datum": ...}, "ros2.navigation: give either datum (where the map frame lies) or from_ll"),
        ({"navigation__type": "FollowGPSWaypoints"}, "takes degrees; leave datum and from_ll out"),
        (
            {"distro": "humble", "navigation": {"type": "FollowGPSWaypoints"}},
            "Nav2 of humble has no FollowGPSWaypoints; use another type, or one of iron",
        ),
        ({"navigation__datum__lat": 91}, "ros2.navigation.datum.lat: must be less than or equal to 90, is 91"),
        ({"navigation__codes": {70_000: "lost"}}, "ros2.navigation.codes.70000: must be less than or equal to 65535"),
        ({"navigation__codes": {203: "stuck"}}, "ros2.navigation.codes.203: must be 'failed', 'blocked' or 'lost'"),
        ({"navigation__slower": 0.5}, "ros2.navigation.slower: must be greater than or equal to 1"),
        ({"battery__path": "cells[x]"}, "ros2.battery.path: 'cells[x]' is not a path to a field"),
        ({"battery__scale": 0}, "ros2.battery: scale is 0; every reading would be the same"),
        ({"battery__unit": "V"}, "ros2.battery: V cannot be turned into percent; give scale and offset"),
        ({"battery": {"topic": "b", "type": "my_msgs/msg/Pack"}}, "ros2.battery: the key 'path' is missing"),
        ({"battery__type": "my_msgs/Pack"}, "'my_msgs/Pack' is not a type here; write package/msg/Name"),
        ({"stop": {"topic": "stop", "stopped": "maybe"}}, "ros2.stop.stopped: "),
        ({"actions__probe": ROVER["ros2"]["actions"]["probe_soil"]}, "no action 'probe'; did you mean 'probe_soil'?"),
        ({"actions__probe_soil": {}}, "nothing performs the action; give action, service, topics or images"),
        (
            {"actions__probe_soil__service": {"name": "p", "type": "std_srvs/srv/Trigger"}},
            "both action and service are given; give only one of them",
        ),
        (
            {"actions__probe_soil__action__request": {"depth": "$depth"}},
            f"ros2.{MEASURE}.request.depth: '$depth' is neither a parameter of the action nor the place; did you mean",
        ),
        (
            {"actions__probe_soil__action__request": {"depth": [1]}},
            f"ros2.{MEASURE}.request.depth: must be a text of at most 255 characters, a number, true or false",
        ),
        ({"actions__probe_soil__action__request": {"Depth": 1}}, "'Depth' is not a path to a field"),
        ({"actions__probe_soil__action__type": "a/srv/B"}, "'a/srv/B' is not a type here; write package/action/Name"),
        (
            {"actions__probe_soil__action__readings": {}},
            "no source is given for 'moisture'; add it to the readings",
        ),
        (
            {"actions__probe_soil__action__readings": {"moisture": "value", "air": "air"}},
            "'air' is read twice; keep it either in readings or in topics",
        ),
        (
            {"actions__probe_soil__action__readings": {"moisture": "value", "co2": "ppm"}},
            "does not measure 'co2'; it measures moisture, air",
        ),
        (
            {"actions__probe_soil__action__readings": {"moisture": {"path": "value", "unit": "V"}}},
            f"ros2.{MEASURE}.readings.moisture: V cannot be turned into percent",
        ),
        (
            {"actions__probe_soil__topics__air__type": "sensor_msgs/msg/Illuminance"},
            f"ros2.{AIR}: lx cannot be turned into degC; give scale and offset, or one of the units degC, K",
        ),
        (
            {"actions__probe_soil__topics__air__unit": "K", "actions__probe_soil__topics__air__offset": 1},
            f"ros2.{AIR}: unit conflicts with scale and offset; give either the unit, or scale and offset",
        ),
        ({"actions__probe_soil__topics__air__within_s": 4000}, f"ros2.{AIR}.within_s: must be less than or equal"),
        ({"interfaces": {"rover_probe/action/Measure": "int8 a\n---\n"}}, "has 1 lines of ---; a .action file has 2"),
        ({"interfaces": {"rover_probe/msg/M": " "}}, "is not a definition; give the lines of its file"),
        ({"interfaces": {"rover_probe/msg/M": "int8 a # " + "x" * 20_000}}, "at most 20000 characters"),
        ({"interfaces": {f"rover_probe/msg/M{n}": "int8 a" for n in range(51)}}, "ros2.interfaces: "),
        ({"interfaces": {"Measure": "int8 a"}}, "'Measure' is not a type here"),
        ({"actions__probe_soil__images": {"rgb": {"topic": "c", "type": "std_msgs/msg/Bool"}}}, "images.rgb.type: "),
        ({"actions__probe_soil__images": {"../x": {"topic": "c"}}}, "ros2.actions.probe_soil.images"),
        ({"actions__probe_soil__images": {f"c{n}": {"topic": "c"} for n in range(9)}}, "images: "),
        (
            {
                "actions__probe_soil__images": {"rgb": {"topic": "c"}},
                "actions__probe_soil__action__images": {"rgb": "image"},
            },
            "the image rgb is given twice",
        ),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(values: dict[str, object], expected: str) -> None:
    with pytest.raises(ProfileError) as error:
        parse_profile(changed(**values), source="rover.yaml")
    message = str(error.value)
    assert message.startswith("rover.yaml: ros2")
    assert expected in message
    assert "\n" not in message


def test_every_problem_is_told_at_once() -> None:
    data = changed(
        battery__unit="V", actions__probe_soil__action__request={"a": "$b"}, actions__probe_soil__action__readings={}
    )
    with pytest.raises(ProfileError) as error:
        parse_profile(data)
    for part in (
        "V cannot be turned",
        "'$b' is neither",
        "no source is given for 'moisture'",
        "(and 2 more after it: ",
    ):
        assert part in str(error.value)


@pytest.mark.parametrize("name", robot_names())
def test_the_builtin_robots_can_be_reached_for_everything_they_do(name: str) -> None:
    robot = load_robot(name)
    assert robot.ros2 is not None
    charging = {"dock", "undock"} if robot.energy.charging is not None else set()
    assert set(robot.ros2.actions) == {action.name for action in robot.actions} | charging
    bound = [action for name, action in robot.ros2.actions.items() if name not in charging]
    own = {b.call.type for b in bound if b.call is not None} | {b.switch.type for b in bound if b.switch is not None}
    assert own - {"std_srvs/srv/SetBool", "std_msgs/msg/Bool"} == set(robot.ros2.interfaces)


def test_fieldhand_robot_shows_how_it_is_reached(tmp_path: Path) -> None:
    path = tmp_path / "rover.yaml"
    path.write_bytes(changed(battery__scale=2, battery__offset=-1, stop={"topic": "/stop"}))
    said = fieldhand("robot", str(path)).out
    for part in (
        "ROS 2: jazzy, names below /rover_1",
        "drives by /rover_1/navigate_to_pose (nav2_msgs/action/NavigateToPose) in map, whose origin is 37.2, -120.4",
        "battery /rover_1/battery_state (sensor_msgs/msg/BatteryState), stale after 30 s: percentage · 2 - 1",
        "stop /stop (std_msgs/msg/Bool)",
        "probe_soil: action /probe/measure (rover_probe/action/Measure) with depth = $depth_cm, fast = True",
        "probe_soil: air = temperature of the next /rover_1/air (sensor_msgs/msg/Temperature) within 60 s",
    ):
        assert part in said
    document = yaml.safe_load(profile_bytes("husky")[0])
    del document["ros2"]
    path.write_text(yaml.safe_dump(document))
    assert "ROS 2: the profile does not define how the robot is reached" in fieldhand("robot", str(path)).out
