"""A robot's release of ROS 2 is heard; a profile that names one insists on it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.profile_check import bindings_of
from fieldhand.execution.drivers.ros2.release import heard_releases, sourced_release, wait_for_release
from fieldhand.execution.drivers.ros2.transport import Peer, QosProfile
from fieldhand.robot.bindings import Distro, Ros2Bindings
from fieldhand.robot.loader import load_robot, profile_bytes
from ros2.sim_robots import SimRobot, patient, sim_robot
from support.processes.command import fieldhand

HUSKY = bindings_of(load_robot("husky"))
#: What is heard of the built-in husky: Kilted has the same NavigateToPose as Jazzy.
HEARD = {"humble": ["humble"], "iron": ["iron"], "jazzy": ["jazzy", "kilted"], "kilted": ["jazzy", "kilted"]}


class Network:
    """A graph in which the servers of actions appear one after the other, one each time that one looks.

    Args:
        hashes: Hashes of the messages that they announce; none at all of a robot with Humble.
    """

    def __init__(self, bindings: Ros2Bindings, hashes: Mapping[str, str], *, after: int = 0) -> None:
        self.bindings, self.hashes, self.looks = bindings, hashes, -after
        self.now_s = 0.0

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        self.looks += 1
        navigation = self.bindings.navigation
        name, _, part = service.rpartition("/_action/")
        of = f"{navigation.type}_{'SendGoal' if part == 'send_goal' else 'GetResult'}"
        if name != self.bindings.whole_name(navigation.action) or self.looks <= 0:
            return ()
        reply = self.hashes.get(f"{of}_Response", "") if self.looks > 8 else ""  # its endpoints come one by one
        asked = self.hashes.get(f"{of}_Request", "")
        return (Peer(participant="a", rmw="cyclonedds", type=of, qos=QosProfile(), type_hash=asked, reply_hash=reply),)

    def wait(self, within_s: float = 10.0) -> Distro | None:
        return wait_for_release(
            self,  # type: ignore[arg-type]
            self.bindings,
            within_s=within_s,
            steady=lambda: self.now_s,
            sleep=self.sleep,
        )

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds


def hashes_of(release: Distro, kind: str) -> dict[str, str]:
    known = Interfaces.of(release)
    parts = [f"{kind}_{service}_{way}" for service in ("SendGoal", "GetResult") for way in ("Request", "Response")]
    return {part: known.type_hash(part) for part in parts}


def bindings(kind: str = "NavigateToPose") -> Ros2Bindings:
    return replace(HUSKY, navigation=replace(HUSKY.navigation, type=f"nav2_msgs/action/{kind}"))


@pytest.mark.parametrize("kind", ["NavigateToPose", "NavigateThroughPoses"])
@pytest.mark.parametrize("release", ["iron", "jazzy", "kilted"])
def test_a_release_is_told_by_the_definitions_of_its_actions(release: Distro, kind: str) -> None:
    bound = bindings(kind)
    network = Network(bound, hashes_of(release, bound.navigation.type), after=50)
    heard = network.wait()
    alike = release == "kilted" and kind == "NavigateToPose"  # which Jazzy defines in the same way
    assert heard == ("jazzy" if alike else release)
    assert release in list(heard_releases(network, bound) or ())  # type: ignore[arg-type]


def test_a_robot_that_announces_no_definition_has_humble() -> None:
    network = Network(HUSKY, {}, after=50)
    assert network.wait() == "humble"
    assert network.now_s < 5.0


def test_nothing_is_heard_of_a_robot_that_is_off() -> None:
    network = Network(HUSKY, {}, after=10**9)
    assert network.wait(within_s=3.0) is None
    assert 3.0 <= network.now_s < 3.1


def test_definitions_of_no_known_release_are_named() -> None:
    strange = dict.fromkeys(hashes_of("jazzy", HUSKY.navigation.type), "RIHS01_00")
    with pytest.raises(Ros2Error, match=r"known here \(humble, iron, jazzy, kilted\); set the nearest one"):
        Network(HUSKY, strange).wait()


@pytest.mark.parametrize(
    ("sourced", "known"), [("jazzy", "jazzy"), (" humble ", "humble"), ("rolling", None), ("", None)]
)
def test_a_sourced_ros_has_a_release(monkeypatch: pytest.MonkeyPatch, sourced: str, known: str | None) -> None:
    monkeypatch.setenv("ROS_DISTRO", sourced)
    assert sourced_release() == known


@pytest.fixture(scope="module", params=["humble", "iron", "jazzy", "kilted"])
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, SimRobot]]:
    pytest.importorskip("cyclonedds")
    folder = tmp_path_factory.mktemp(request.param)
    with sim_robot(folder, "--site", "demo", "--distro", request.param) as found:  # it publishes no /clock
        yield request.param, found


def check(robot: SimRobot, profile: str) -> tuple[int, dict[str, Any]]:
    namespace = str(robot.by.namespace)
    done = fieldhand("robot", "check", profile, "--live", "--namespace", namespace, "--within", "60", "--json")
    return done.status, json.loads(done.out)


def insisting(folder: Path, distro: str) -> str:
    values = yaml.safe_load(profile_bytes("husky")[0])
    values["ros2"]["distro"] = distro
    path = folder / f"{distro}.yaml"
    path.write_text(yaml.safe_dump(values, sort_keys=False))
    return str(path)


def test_the_built_in_husky_fits_a_robot_of_each_release(robot: tuple[str, SimRobot]) -> None:
    distro, there = robot
    status, found = check(there, "husky")
    assert (status, found["usable"]) == (0, True), found
    assert found["distro"] == {"profile": None, "heard": HEARD[distro]}


def test_a_profile_that_insists_on_another_release_is_contradicted(robot: tuple[str, SimRobot], tmp_path: Path) -> None:
    distro, there = robot
    agreed, found = check(there, insisting(tmp_path, distro))
    assert (agreed, found["distro"]) == (0, {"profile": distro, "heard": HEARD[distro]})
    other = "jazzy" if distro == "humble" else "humble"
    namespace = str(there.by.namespace)
    done = fieldhand("robot", "check", insisting(tmp_path, other), "--live", "--namespace", namespace, "--within", "60")
    assert done.status == 1
    heard = " or ".join(HEARD[distro])
    assert f"the profile insists on ROS 2 {other}, and the robot has {heard}" in " ".join(done.out.split())
    assert f"leave distro out of the profile, or set it to {HEARD[distro][0]}" in " ".join(done.out.split())


@pytest.mark.parametrize("distro", ["humble", "kilted"])
def test_a_mission_uses_the_messages_of_the_release_that_it_heard(tmp_path: Path, distro: str) -> None:
    """Goals of Kilted hold the poses in another field than those of the releases before."""
    pytest.importorskip("cyclonedds")
    profile = str(patient(tmp_path, type="NavigateThroughPoses"))
    words = ("--site", "demo", "--robot", profile, "--speed", "50", "--distro", distro)
    with sim_robot(tmp_path, *words) as there:
        request = ("run", "Measure the temperature at tree 4.", "--site", "demo", "--robot", profile, "--yes")
        done = fieldhand(*request, *there.reached)
        assert done.status == 0, done.out + done.err
        assert there.made("navigate_through_poses")


def test_sim_robot_refuses_an_unknown_release() -> None:
    refused = fieldhand("sim-robot", "--site", "demo", "--distro", "foxy")
    assert refused.status == 2
    assert "there is no release 'foxy'" in refused.err
