"""Drives by FollowPath and by Nav2's route server: the approved way is the one that is driven."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import shapely
import yaml

from fieldhand.errors import ProfileError
from fieldhand.execution.drivers.ros2.route_drive import joined_way
from fieldhand.execution.drivers.ros2.simulated_robot.route_server import NO_VALID_ROUTE
from fieldhand.execution.drivers.simulation.world import Blocked, TreeRef
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import run
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.places.selectors import TreeIs, UnionOf
from fieldhand.robot.bindings import Datum
from fieldhand.robot.loader import load_robot, parse_profile, profile_bytes
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Driving, Event, Faulted, Obstructed, Strayed
from ros2.nav2_rig import Nav2Rig, profile
from ros2.simulated_robot_rig import SITE
from ros2.test_headings_over_ros2 import OFF_DEG, rigged
from support.missions.cameras import looking, off_view, pictures
from support.missions.rig import authorized, captured, of_type, task_for

TREES = ("r1c3", "r3c1", "r0c4")
DATUM = Datum(lat=SITE.start.lat, lon=SITE.start.lon, heading_deg=37.0)
FOLLOW: dict[str, Any] = {"type": "nav2_msgs/action/FollowPath", "action": "follow_path"}
ROUTES: dict[str, Any] = {
    "type": "nav2_msgs/action/ComputeAndTrackRoute",
    "action": "compute_and_track_route",
    "working": "nav2_msgs/action/FollowPath",
    "working_action": "follow_path",
    "nodes": ("route_server", "controller_server"),
}
EITHER = pytest.mark.parametrize("navigation", [FOLLOW, ROUTES], ids=["path", "route"])


def each(*trees: str, action: str = "read_co2") -> ForEach:
    where = UnionOf(parts=tuple(TreeIs(tree=tree) for tree in trees))
    return ForEach(id="", select=where, body=Act(id="", action=action))


def robot_of(navigation: dict[str, Any], *, corridor_m: float | None = None, **more: Any) -> RobotProfile:
    return replace(profile(**navigation, **more), corridor_m=corridor_m)


class Watched(Nav2Rig):
    """A rig that records where its robot has been."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.trace: list[tuple[float, float]] = []
        self.clock.steps.append(lambda: self.trace.append(self.simulated.platform.position.xy))


def approved(events: tuple[Event, ...], site: Site = SITE) -> shapely.MultiLineString:
    """The ways that the log says were to be driven."""
    lines = [site.projection.metres(*zip(*d.path, strict=True)) for d in of_type(events, Driving)]
    return shapely.MultiLineString([shapely.LineString(line) for line in lines])


def farthest_m(trace: list[tuple[float, float]], ways: shapely.Geometry) -> float:
    return max(float(ways.distance(shapely.Point(at))) for at in trace)


@EITHER
@pytest.mark.parametrize("datum", [None, DATUM])
def test_the_robot_drives_the_approved_way(navigation: dict[str, Any], datum: Datum | None) -> None:
    more: dict[str, Any] = {} if datum is None else {"from_ll": "", "datum": datum}
    rig = Watched(robot=robot_of(navigation, corridor_m=1.0, **more))
    result = rig.fly(each(*TREES))
    assert result.status == "completed", [e.what for e in of_type(result.events, Faulted)]
    assert {place for _, place in captured(result.events)} == set(TREES)
    # A node of the graph is at every stand, so a route is the approved way but for a few decimetres at the headland.
    assert farthest_m(rig.trace, approved(result.events)) < 0.3
    assert set(rig.ends("follow_path")) == {"succeeded"}
    if navigation is ROUTES:
        assert set(rig.ends("compute_and_track_route")) == {"succeeded"}


@EITHER
@pytest.mark.parametrize("distro", ["jazzy", "kilted"])
def test_the_controller_ends_at_the_heading_of_the_camera(navigation: dict[str, Any], distro: Any) -> None:
    robot = looking("left", 45.0, robot=robot_of(navigation, distro=distro))
    rig, noted = rigged(robot)
    result = rig.fly(each("r1c3", "r1c1", action="take_thermal_picture"))
    taken = pictures(result.events)
    assert {event.place for event in taken} == {"r1c3", "r1c1"}
    # The feedback of FollowPath contains no pose, so the log has no heading; the robot itself knows it.
    true = {place: heading for name, place, heading in noted.headings if name.endswith("take_picture")}
    for event in taken:
        assert event.heading_deg is None
        assert off_view(SITE, replace(event, heading_deg=true[f"tree {event.place}"]), "left") <= OFF_DEG


@EITHER
def test_an_obstacle_leads_to_another_way_of_fieldhands_own(navigation: dict[str, Any]) -> None:
    # In an aisle from which the tree is worked on.
    there = (TreeRef(id="r1c1"), TreeRef(id="r2c1"))
    other = (TreeRef(id="r2c1"), TreeRef(id="r3c1"))
    faults = tuple(Blocked(between=trees, within_m=1.0) for trees in (there, other))
    rig = Watched(robot=robot_of(navigation), faults=faults)
    result = rig.fly(each("r2c3"))
    assert captured(result.events) == [("read_co2", "r2c3")], [e.what for e in of_type(result.events, Faulted)]
    assert of_type(result.events, Obstructed)
    assert rig.ends("follow_path")[0] == "failed"
    assert rig.ends("follow_path")[-1] == "succeeded"


@contextmanager
def while_driving(rig: Nav2Rig, after_m: float, do: Callable[[], None]) -> Iterator[None]:
    done: list[bool] = []

    def look() -> None:
        if not done and rig.simulated.platform.driving and rig.simulated.platform.metres >= after_m:
            done.append(True)
            do()

    rig.clock.steps.append(look)
    yield
    assert done


def test_a_route_that_the_server_changes_is_followed_anew() -> None:
    rig = Watched(robot=robot_of(ROUTES))
    assert rig.simulated.routes is not None
    with while_driving(rig, 8.0, rig.simulated.routes.reroute):
        result = rig.fly(each("r3c1"))
    assert captured(result.events) == [("read_co2", "r3c1")], [e.what for e in of_type(result.events, Faulted)]
    assert "cancelled" in rig.ends("follow_path")
    assert not of_type(result.events, Faulted)
    assert farthest_m(rig.trace, approved(result.events)) < 1.0


@pytest.mark.parametrize(
    ("code", "words"),
    [(NO_VALID_ROUTE, "no route to the goal was found (code 405 of Nav2)"),
     (406, "an operation of the route failed (code 406 of Nav2)")],
)  # fmt: skip
def test_a_route_that_fails_stops_the_controller_and_is_tried_again(code: int, words: str) -> None:
    rig = Watched(robot=robot_of(ROUTES, distro="kilted"))
    routes = rig.simulated.routes
    assert routes is not None
    with while_driving(rig, 8.0, lambda: routes.fail(code, "a door is shut")):
        result = rig.fly(each("r3c1"))
    assert "cancelled" in rig.ends("follow_path")
    whats = [e.what for e in of_type(result.events, Faulted)]
    if code == NO_VALID_ROUTE:
        assert captured(result.events) == [("read_co2", "r3c1")] or any(words in what for what in whats)
    else:
        assert any(f"{words}: a door is shut; trying again" in what for what in whats), whats
        assert captured(result.events) == [("read_co2", "r3c1")]


def test_an_abort_ends_route_and_path() -> None:
    rig = Watched(robot=robot_of(ROUTES))
    wanted: list[OperatorCommand | None] = [None]

    def abort() -> None:
        wanted[0] = OperatorCommand(number=1, wanted="abort", reason="enough")

    with while_driving(rig, 8.0, abort):
        result = rig.fly(each("r3c1"), orders=lambda: wanted[0])
    assert result.status == "aborted"
    assert rig.ends("follow_path")[0] == "cancelled"
    assert rig.ends("compute_and_track_route")[0] == "cancelled"
    assert not rig.simulated.platform.driving


def test_without_a_node_at_the_goal_the_approved_way_is_followed() -> None:
    rig = Watched(robot=robot_of(ROUTES))
    routes = rig.simulated.routes
    assert routes is not None
    routes._nodes = routes._nodes[-1:]  # a marker only
    result = rig.fly(each("r1c3"))
    assert captured(result.events) == [("read_co2", "r1c3")], [e.what for e in of_type(result.events, Faulted)]
    assert farthest_m(rig.trace, approved(result.events)) < 0.3


def test_a_route_that_leaves_the_approved_way_is_not_followed() -> None:
    rig = Watched(robot=robot_of(ROUTES))
    routes = rig.simulated.routes
    assert routes is not None

    def detour() -> None:
        goal, here = routes._goal, rig.simulated.platform.position.xy
        assert goal is not None
        routes._publish(goal, [here, (here[0], here[1] - 12.0), (5.0, 16.5)], rerouted=True)

    with while_driving(rig, 8.0, detour):
        result = rig.fly(each("r3c1"))
    obstructed = of_type(result.events, Obstructed)
    assert "chose a route that leaves the approved way by" in obstructed[0].what
    assert farthest_m(rig.trace, approved(result.events)) < 1.0


@pytest.mark.parametrize(
    ("route", "begin", "way"),
    [
        ([(0.0, 0.0), (0.0, 4.0)], (0.0, 0.0), [(0.0, 0.0), (0.0, 4.0)]),
        # It begins at the next node ahead, and ends before the goal: the approved way is kept to before and after it.
        ([(0.0, 2.0), (0.0, 3.0)], (0.0, 0.0), [(0.0, 0.0), (0.0, 1.0), (0.0, 2.0), (0.0, 3.0), (0.0, 4.0)]),
        # It begins at a node behind the robot.
        ([(0.0, 0.0), (0.0, 4.0)], (0.0, 2.0), [(0.0, 2.0), (0.0, 1.0), (0.0, 0.0), (0.0, 4.0)]),
        ([(0.0, 3.0)], (0.0, 3.0), [(0.0, 3.0), (0.0, 4.0)]),
        ([(0.0, 4.0)], (0.0, 4.0), [(0.0, 4.0), (0.0, 4.0)]),
        # Beside the way, such as beyond the row: it would cut through it.
        ([(0.0, 0.0), (3.0, 4.0)], (0.0, 0.0), None),
        ([(3.0, 0.0), (0.0, 4.0)], (0.0, 0.0), None),
    ],
)
def test_a_route_is_joined_to_the_approved_way(
    route: list[tuple[float, float]], begin: tuple[float, float], way: list[tuple[float, float]] | None
) -> None:
    line = [(0.0, float(k)) for k in range(5)]
    found = joined_way(line, route, begin)
    assert found == way


def _profile(**navigation: Any) -> dict[str, Any]:
    values: dict[str, Any] = yaml.safe_load(profile_bytes("husky")[0])
    values["ros2"]["distro"] = navigation.pop("distro", "jazzy")
    values["ros2"]["navigation"] |= navigation
    return values


def test_the_profile_says_how_the_robot_drives() -> None:
    path = parse_profile(yaml.safe_dump(_profile(type="FollowPath", distro="humble")).encode()).ros2
    route = parse_profile(yaml.safe_dump(_profile(type="ComputeAndTrackRoute", goal_checker="precise")).encode()).ros2
    assert path is not None
    assert route is not None
    assert (path.navigation.action, path.navigation.nodes) == ("follow_path", ("controller_server",))
    assert route.navigation.action == "compute_and_track_route"
    assert (route.navigation.working_action, route.navigation.goal_checker) == ("follow_path", "precise")
    assert route.navigation.nodes == ("route_server", "controller_server")


@pytest.mark.parametrize(
    ("navigation", "why"),
    [
        ({"type": "ComputeAndTrackRoute", "distro": "humble"}, "Nav2 of humble has no route server"),
        ({"type": "ComputeAndTrackRoute", "working": "NavigateThroughPoses"}, "the controller follows every path"),
    ],
)
def test_what_no_robot_can_do_is_refused(navigation: dict[str, Any], why: str) -> None:
    with pytest.raises(ProfileError, match=why):
        parse_profile(yaml.safe_dump(_profile(**navigation)).encode())


@pytest.mark.parametrize("kind", ["FollowPath", "ComputeAndTrackRoute"])
def test_whole_missions_over_dds_drive_the_approved_way(tmp_path: Path, kind: str) -> None:
    pytest.importorskip("cyclonedds")
    from ros2.robot_in_process import connected_simulated_robot

    values = _profile(type=kind) | {"corridor_m": 1.0}
    values["ros2"]["actions"] = {"read_co2": values["ros2"]["actions"]["read_co2"]}
    path = tmp_path / "husky.yaml"
    path.write_text(yaml.safe_dump(values, sort_keys=False))
    site, robot, task = open_site("demo"), load_robot(str(path)), task_for(each("4", "37", "41"))
    with connected_simulated_robot("demo", str(path), task, seed=0, tick_s=0.5, world={}) as (vehicle, _):
        result = run(
            authorized(task, site, robot),
            site=site,
            robot=robot,
            driver=vehicle.driver,
            guard=NoGuard(),
            clock=vehicle.clock,
            emit=lambda _: None,
        )
    assert result.status == "completed", [e.what for e in of_type(result.events, Faulted)]
    assert {place for _, place in captured(result.events)} == {"4", "37", "41"}
    assert not of_type(result.events, Strayed)
