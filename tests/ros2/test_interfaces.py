"""Definitions of messages: each release has them, what fits them is completed, what does not is named by its field."""

from __future__ import annotations

from typing import get_args

import pytest

from fieldhand.errors import ProfileError, Ros2Error
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.message_fields import value_at
from fieldhand.robot.bindings import Distro, NavigationType

DISTROS: tuple[Distro, ...] = get_args(Distro)


@pytest.fixture(scope="module")
def jazzy() -> Interfaces:
    return Interfaces.of("jazzy")


@pytest.mark.parametrize("distro", DISTROS)
def test_every_message_of_a_release_has_a_default_that_fits_it(distro: Distro) -> None:
    interfaces = Interfaces.of(distro)
    names = [d for d in interfaces.names() if "/msg/" in d or "/srv/" in d or "/action/" in d]
    assert len(names) > 150
    for name in names:
        assert interfaces.complete(name, interfaces.default(name)) == interfaces.default(name)


@pytest.mark.parametrize("distro", DISTROS)
def test_navigation_is_known_as_each_release_has_it(distro: Distro) -> None:
    interfaces = Interfaces.of(distro)
    known = [n for n in get_args(NavigationType) if interfaces.knows(n) and interfaces.knows(f"{n}_SendGoal")]
    # Degrees came with Iron, the route server with Jazzy.
    assert len(known) == {"humble": 3, "iron": 4}.get(distro, 5)
    result = interfaces.fields("nav2_msgs/action/NavigateToPose_Result")
    assert ("error_code" in result, "error_msg" in result) == (distro != "humble", distro in ("jazzy", "kilted"))
    assert interfaces.field_at("robot_localization/srv/FromLL_Request", "ll_point.latitude").base == "float64"
    for name in ("std_srvs/srv/Trigger", "action_msgs/srv/CancelGoal", "rosgraph_msgs/msg/Clock"):
        assert interfaces.knows(name)


def test_hashes_are_those_that_ros_computes(jazzy: Interfaces) -> None:
    """As ``ros2 topic info --verbose`` prints them."""
    assert (
        jazzy.type_hash("std_msgs/msg/String")
        == "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
    )
    assert (
        jazzy.type_hash("geometry_msgs/msg/Twist")
        == "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"
    )


def test_defaults_of_the_text_count() -> None:
    own = Interfaces.of("humble", {"a_msgs/msg/A": "int8 n -3\nstring s 'ab'\nfloat32[] v [1, 2.5]\nint8 LEAST=-7\n"})
    assert own.default("a_msgs/msg/A") == {"n": -3, "s": "ab", "v": (1.0, 2.5)}
    assert own.constants("a_msgs/msg/A") == {"LEAST": -7}
    assert value_at(own.default("geometry_msgs/msg/Pose"), "orientation.w") == 1.0


def test_a_profile_may_bring_another_version_of_a_known_interface() -> None:
    own = Interfaces.of("jazzy", {"nav2_msgs/action/NavigateToPose": "string where\n---\n---\nfloat32 left\n"})
    assert own.default("nav2_msgs/action/NavigateToPose_SendGoal_Request")["goal"] == {"where": ""}
    assert own.default("nav2_msgs/action/NavigateToPose_FeedbackMessage")["feedback"] == {"left": 0.0}


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a_msgs/msg/A", "float64 x\nfloat65 y\n", "float65 is unknown in humble"),
        ("a_msgs/msg/A", "float64 x\nfloat64 = 3\n", "'float64 = 3'"),
        ("a_msgs/msg/A", "wstring x\n", "x is a wide string"),
        ("a_msgs/msg/A", "int8 x\nint8 x\n", "two fields"),
        ("a_msgs/msg/A", "B b\n", "a_msgs/msg/B is unknown"),
        ("a_msgs/msg/A", "A a\n", "contains itself"),
        ("a_msgs/msg/A", "A[] a\n", "contains itself"),
        ("a_msgs/msg/A", "float64[1000000000] x\n", "more than"),
        ("a_msgs/msg/A", "geometry_msgs/Pose[30000] x\n", "more than"),
        ("a_msgs/msg/A", "uint8[0] x\n", "no values"),
        ("a_msgs/msg/A", "int8 x 1000\n", "1000 does not fit in int8"),
        ("a_msgs/srv/A", "int8 x\n", "1 parts"),
        ("a_msgs/action/A", "int8 x\n---\nint8 y\n", "2 parts"),
        ("a_msgs/A", "int8 x\n", "not an interface"),
        ("a_msgs/msg/A", "#" * 100_001, "100001 characters"),
    ],
)
def test_a_definition_that_cannot_be_used_is_refused_in_words(name: str, text: str, says: str) -> None:
    with pytest.raises(ProfileError, match=says) as refused:
        Interfaces.of("humble", {name: text})
    assert "ros2: interfaces" in refused.value.where


@pytest.mark.parametrize(
    ("message", "given_", "says"),
    [
        ("sensor_msgs/msg/NavSatFix", {"lat": 1.0}, "has no field 'lat'; it has header, status, latitude"),
        (
            "sensor_msgs/msg/NavSatFix",
            {"status": {"status": 200}},
            "^status.status: 200 does not fit in int8, which ranges from -128 to",
        ),
        ("sensor_msgs/msg/NavSatFix", {"status": {"service": -1}}, "^status.service: -1 does not fit in uint16"),
        ("sensor_msgs/msg/NavSatFix", {"latitude": "north"}, "^latitude: 'north' \\(str\\) is not a float64"),
        ("sensor_msgs/msg/NavSatFix", {"latitude": True}, "^latitude: 'True' \\(bool\\) is not a float64"),
        ("sensor_msgs/msg/NavSatFix", {"status": 3}, "^status: '3' \\(int\\) is not a sensor_msgs/msg/NavSatStatus"),
        ("sensor_msgs/msg/NavSatFix", {"position_covariance": [1.0]}, "^position_covariance: 1 values: .* has 9"),
        ("sensor_msgs/msg/NavSatFix", {"header": {"frame_id": "a\0b"}}, "^header.frame_id: this text contains a null"),
        ("sensor_msgs/msg/NavSatFix", {"header": {"frame_id": "\ud800"}}, "^header.frame_id: this text contains half"),
        ("sensor_msgs/msg/BatteryState", {"percentage": 1e39}, "^percentage: 1e\\+39 is too large for a float32"),
        ("sensor_msgs/msg/BatteryState", {"present": 1}, "^present: '1' \\(int\\) is not a bool"),
        ("geometry_msgs/msg/PoseArray", {"poses": [{}, {"position": {"x": None}}]}, "^poses\\[1\\].position.x: "),
        ("unique_identifier_msgs/msg/UUID", {"uuid": b"short"}, "^uuid: 5 values: uint8\\[16\\] has 16"),
        ("unique_identifier_msgs/msg/UUID", {"uuid": [256] * 16}, "^uuid\\[0\\]: 256 does not fit in uint8"),
        ("std_msgs/msg/Empty", {"x": 1}, "it has none at all"),
        ("no_msgs/msg/Such", {}, "the type no_msgs/msg/Such is not known here; "),
    ],
)
def test_what_does_not_fit_is_named_by_its_path(jazzy: Interfaces, message: str, given_: dict, says: str) -> None:
    with pytest.raises(Ros2Error, match=says):
        jazzy.complete(message, given_)


def test_whole_numbers_and_lists_stand_for_floats_and_tuples(jazzy: Interfaces) -> None:
    fix = jazzy.complete("sensor_msgs/msg/NavSatFix", {"latitude": 52, "position_covariance": [1] * 9})
    assert fix["latitude"] == 52.0
    assert fix["position_covariance"] == (1.0,) * 9
    assert jazzy.complete("unique_identifier_msgs/msg/UUID", {"uuid": [7] * 16}) == {"uuid": b"\x07" * 16}


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ("pose.pose.position.q", "geometry_msgs/msg/Point has no 'q'; it has x, y, z"),
        ("pose.pose.position.x.y", "float64 has no fields"),
        ("pose.covariance.x", "say which of the float64\\[36\\]"),
        ("pose.covariance[36]", "has no \\[36\\]"),
        ("pose[0]", "is a single value"),
        ("pose..x", "not a path"),
        ("", "not a path"),
        ("a[-1]", "not a path"),
    ],
)
def test_a_path_that_leads_nowhere_says_where_it_ends(jazzy: Interfaces, path: str, says: str) -> None:
    assert jazzy.field_at("nav_msgs/msg/Odometry", "pose.covariance[35]").base == "float64"
    with pytest.raises(Ros2Error, match=says):
        jazzy.field_at("nav_msgs/msg/Odometry", path)
