"""Goals without a reason, restarts and taken places, over real DDS with the simulated robot in another process."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from fieldhand.execution.drivers.ros2.action_client import ActionClient
from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.map_frame import degrees_to_map, pose
from fieldhand.execution.drivers.ros2.simulated_robot.robot import bindings_of
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import Result, run
from fieldhand.forecast.visit_order import drives_for
from fieldhand.places.selectors import TreeIs, UnionOf
from fieldhand.robot.bindings import Datum
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.site.loader import open_site
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Faulted, Obstructed, Paused, Shed, Waited
from ros2.robot_in_process import Lockstep, RobotInProcess, connected_simulated_robot
from support.missions.rig import authorized, captured, of_type, task_for

pytest.importorskip("cyclonedds")

SITE = open_site("demo")
TREES = ("4", "5", "6")
TICK_S = 0.5
#: What a test does with robot and clock before the mission begins.
Prepare = Callable[[RobotInProcess, Lockstep], None]


def visits(*trees: str) -> ForEach:
    where = UnionOf(parts=tuple(TreeIs(tree=t) for t in trees))
    return ForEach(id="", select=where, body=Act(id="", action="read_ambient_temperature"))


def profile(folder: Path, **navigation: Any) -> str:
    """Write the profile of the built-in robot for a release that gives codes."""
    values = yaml.safe_load(profile_bytes("husky")[0])
    values["ros2"]["distro"] = "jazzy"
    values["ros2"]["navigation"] |= navigation
    values["ros2"]["actions"] = {name: values["ros2"]["actions"][name] for name in ("read_ambient_temperature",)}
    path = folder / "husky.yaml"
    path.write_text(yaml.safe_dump(values, sort_keys=False))
    return str(path)


def flown(
    folder: Path, *faults: dict[str, Any], trees: tuple[str, ...] = TREES, prepare: Prepare = lambda *_: None
) -> tuple[Result, RobotInProcess]:
    """A mission over DDS on a robot in a world with faults."""
    robot, task = profile(folder), task_for(visits(*trees))
    world = {"faults": list(faults)}
    with connected_simulated_robot("demo", robot, task, seed=0, tick_s=TICK_S, world=world) as (vehicle, far):
        assert isinstance(vehicle.clock, Lockstep)
        prepare(far, vehicle.clock)
        known = load_robot(robot)
        result = run(
            authorized(task, SITE, known),
            site=SITE,
            robot=known,
            driver=vehicle.driver,
            guard=NoGuard(),
            clock=vehicle.clock,
            emit=lambda _: None,
        )
        return result, far


def whats(result: Result) -> str:
    return "\n".join(e.what for e in of_type(result.events, Faulted))


def visited(result: Result) -> list[str]:
    return sorted(place for _, place in captured(result.events))


def ends(far: RobotInProcess, action: str) -> list[str]:
    return [end for name, end in far.state["ends"] if name.endswith(action)]


def test_a_goal_of_another_client_is_left_alone_until_it_is_over(tmp_path: Path) -> None:
    ros2 = bindings_of(load_robot(profile(tmp_path)))
    node = open_dds(Interfaces.of(ros2.release, ros2.interfaces))
    name = ros2.whole_name(ros2.navigation.action)

    def prepare(far: RobotInProcess, clock: Lockstep) -> None:
        client = ActionClient(node, name, ros2.navigation.type, steady=clock.now, accept_s=5.0)
        start, tree = SITE.start, SITE.by_id["20"].place
        ((x, y),) = degrees_to_map(Datum(lat=start.lat, lon=start.lon), [(tree.lat, tree.lon)])

        def click() -> None:
            client.start({"pose": pose("map", (x - 1.0, y), (x, y))})
            client.step()

        clock.meanwhile = lambda: far.state.get("driven_m", 0.0) > 5.0 and client.servers() == 1, click

    result, far = flown(tmp_path, prepare=prepare)
    node.close()
    assert (result.status, visited(result)) == ("completed", list(TREES))
    assert "a goal of another client took the place of this drive's, such as one clicked in RViz" in whats(result)
    assert len(of_type(result.events, Paused)) == 1
    assert not of_type(result.events, Obstructed)
    assert ends(far, "navigate_to_pose").count("pre-empted") == 1
    assert [name, "tree 20"] in far.state["made"]


def test_a_goal_that_ends_unprovoked_is_no_obstacle(tmp_path: Path) -> None:
    result, _ = flown(tmp_path, {"fault": "goal_unexplained", "after_m": 5})
    assert (result.status, visited(result)) == ("completed", list(TREES))
    assert "navigation ended the drive without an error code; trying again" in whats(result)
    assert not of_type(result.events, Obstructed)


def test_a_navigator_that_restarts_inactive_does_not_end_the_mission(tmp_path: Path) -> None:
    result, far = flown(tmp_path, {"fault": "navigator_dies", "after_m": 5, "down_s": 2, "inactive_s": 20})
    assert (result.status, visited(result)) == ("completed", list(TREES))
    # A busy machine may not answer in the time of the simulation; what is said of an answer is tested in memory.
    inactive = "bt_navigator is inactive: activate it (ros2 lifecycle set /bt_navigator activate)"
    assert any(said in whats(result) for said in (inactive, "bt_navigator does not answer /bt_navigator/get_state"))
    assert [(e.wanted, e.over) for e in of_type(result.events, Waited)] == [("navigation", True)]
    assert ends(far, "follow_path") == ["cancelled"]


def on_stands(tree: str, within_m: float) -> list[dict[str, Any]]:
    """Obstacles where a robot stands to work on a tree, on either side, at which Nav2 recovers for ever."""
    place = SITE.by_id[tree].place
    (sides,) = drives_for(SITE, load_robot("husky")).sides([place])
    return [
        {
            "fault": "blocked", "at": {"id": tree}, "within_m": within_m, "recovers": True,
            "east_m": side.xy[0] - place.x, "north_m": side.xy[1] - place.y,
        }
        for side in sides
    ]  # fmt: skip


def test_a_tree_with_a_taken_place_is_visited_from_its_other_side(tmp_path: Path) -> None:
    for taken in on_stands("5", 0.7):
        result, _ = flown(tmp_path, taken)
        assert (result.status, visited(result)) == ("completed", list(TREES)), result.reason


def test_a_tree_all_of_whose_places_are_taken_is_left_out_and_the_mission_goes_on(tmp_path: Path) -> None:
    result, _ = flown(tmp_path, *on_stands("5", 1.3))
    assert (result.status, visited(result)) == ("completed", ["4", "6"]), result.reason
    (shed,) = of_type(result.events, Shed)
    assert (shed.places, shed.cause) == (("5",), "unreachable")
    assert "something stands where the robot would stand at tree 5; it came no nearer to its goal in" in shed.reason
