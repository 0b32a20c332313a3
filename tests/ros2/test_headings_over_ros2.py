"""Over ROS 2 the goals of a mission carry the heading at their end, and the simulated robot turns to it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from fieldhand.execution.drivers.protocol import DriveGoal
from fieldhand.execution.drivers.ros2.map_frame import aimed, orientation, yaw_in
from fieldhand.execution.drivers.ros2.simulated_robot.robot import YAW_TOLERANCE_DEG, GoalReport
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import run
from fieldhand.places.selectors import TreeIs, UnionOf
from fieldhand.robot.bindings import Datum
from fieldhand.robot.camera import CameraSide
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.robot.model import RobotProfile
from fieldhand.site.bearings import apart_deg, bearing_of
from fieldhand.site.loader import open_site
from fieldhand.task.plan import Act, ForEach, InOrder
from fieldhand.task.results import Acted, Driving, Faulted
from ros2.nav2_rig import Nav2Rig, profile
from ros2.simulated_robot_rig import SITE
from support.missions.cameras import PICTURE, looking, off_view, pictures
from support.missions.rig import authorized, of_type, task_for

#: Its map is turned against north, as most are.
DATUM = Datum(lat=SITE.start.lat, lon=SITE.start.lon, heading_deg=37.0)
TREES = ("r1c3", "r1c1", "r2c2")
OFF_DEG = YAW_TOLERANCE_DEG + 1.0


@dataclass
class Noted(list[GoalReport]):
    """What the robot says of its goals, and its heading then."""

    headings: list[tuple[str, str, float]] = field(default_factory=list)
    rig: Nav2Rig | None = None

    def append(self, report: GoalReport) -> None:
        super().append(report)
        if self.rig is not None:
            self.headings.append((report.name, report.place, self.rig.simulated.platform.heading_deg))


def rigged(robot: RobotProfile) -> tuple[Nav2Rig, Noted]:
    noted = Noted()
    noted.rig = rig = Nav2Rig(robot=robot, reports=noted)
    return rig, noted


def each(*trees: str, action: str = PICTURE) -> ForEach:
    where = UnionOf(parts=tuple(TreeIs(tree=tree) for tree in trees))
    return ForEach(id="", select=where, body=Act(id="", action=action))


@pytest.mark.parametrize("side", ["left", "front"])
@pytest.mark.parametrize(
    "navigation",
    [
        {"type": "nav2_msgs/action/NavigateToPose"},
        {"type": "nav2_msgs/action/NavigateToPose", "from_ll": "", "datum": DATUM},
        {"type": "nav2_msgs/action/NavigateThroughPoses", "distro": "kilted", "action": "navigate_through_poses"},
        {"type": "nav2_msgs/action/FollowGPSWaypoints", "from_ll": "", "action": "follow_gps_waypoints"},
    ],
    ids=lambda keys: "-".join(str(value).rsplit("/")[-1][:20] for value in keys.values()),
)
def test_the_camera_sees_every_plant_by_the_robots_own_account(navigation: dict[str, Any], side: CameraSide) -> None:
    robot = looking(side, 45.0, robot=profile(**navigation))
    rig, noted = rigged(robot)
    result = rig.fly(each(*TREES))
    assert result.status == "completed", [e.what for e in of_type(result.events, Faulted)]
    taken = pictures(result.events)
    assert {event.place for event in taken} == set(TREES)
    true = {place: heading for name, place, heading in noted.headings if name.endswith("take_picture")}
    by_degrees = navigation["type"].endswith("FollowGPSWaypoints")
    for event in taken:
        heading = true[f"tree {event.place}"]
        assert off_view(SITE, replace(event, heading_deg=heading), side) <= OFF_DEG
        if by_degrees:  # its feedback contains no pose
            assert event.heading_deg is None
        else:
            assert event.heading_deg is not None
            assert apart_deg(event.heading_deg, heading) < 0.5


@pytest.mark.parametrize("datum", [None, DATUM])
def test_without_a_camera_the_robot_stands_along_the_row(datum: Datum | None) -> None:
    navigation: dict[str, Any] = {} if datum is None else {"from_ll": "", "datum": datum}
    rig, noted = rigged(profile(**navigation))
    result = rig.fly(each(*TREES, action="read_co2"))
    drives = {d.place: d.heading_deg for d in of_type(result.events, Driving)}
    for name, place, heading in noted.headings:
        if not name.endswith("read"):
            continue
        commanded = drives[place.removeprefix("tree ")]
        assert commanded is not None
        assert min(apart_deg(commanded, 90.0), apart_deg(commanded, 270.0)) < 1.0
        assert apart_deg(heading, commanded) <= OFF_DEG
    for event in of_type(result.events, Acted):
        assert event.heading_deg is not None
        assert min(apart_deg(event.heading_deg, 90.0), apart_deg(event.heading_deg, 270.0)) <= OFF_DEG


def test_a_robot_that_does_not_turn_to_its_goal_fails_before_the_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = looking("front", 45.0, robot=profile())
    rig, _ = rigged(replace(robot, retries=0))
    # Its goal checker takes any yaw.
    monkeypatch.setattr(rig.simulated.platform._driver, "_yaw_tolerance_deg", 360.0)
    result = rig.fly(Act(action=PICTURE, at=TreeIs(tree="r1c3")))
    (fault,) = of_type(result.events, Faulted)
    assert "off the" in fault.what
    assert "at which its camera sees the plant; check the yaw tolerance of Nav2's goal checker" in fault.what
    assert not pictures(result.events)


def test_two_cameras_at_one_tree_send_a_goal_between_the_pictures() -> None:
    robot = looking("left", 45.0, robot=profile())
    camera = replace(robot.action[PICTURE].camera, side="back")  # type: ignore[type-var]
    robot = replace(
        robot, actions=tuple(replace(a, camera=camera) if a.name == "read_co2" else a for a in robot.actions)
    )
    rig, noted = rigged(robot)
    result = rig.fly(InOrder(steps=(Act(action=PICTURE, at=TreeIs(tree="r1c3")), Act(action="read_co2"))))
    one, two = of_type(result.events, Acted)
    assert off_view(SITE, one, "left") <= OFF_DEG
    assert off_view(SITE, two, "back") <= OFF_DEG
    assert len([r for r in noted if r.name.endswith("navigate_to_pose") and r.metres == 0.0]) == 1


@pytest.mark.parametrize("heading", [0.0, 83.0, 128.0, 270.0])
def test_the_corner_ahead_of_a_goal_lies_in_its_heading(heading: float) -> None:
    path = ((0.0, 0.0), (3.0, 4.0))
    goal = DriveGoal(
        place=SITE.trees[0].place, path_m=path, path_degrees=SITE.projection.lat_lon(path), length_m=5.0, speed_m_s=1.0
    )
    found = aimed(goal, heading)
    lat, lon = zip(*found.path_degrees, strict=True)
    *_, end, ahead = (tuple(point) for point in SITE.projection.metres(lat, lon))
    assert apart_deg(bearing_of(end, ahead), heading) < 0.3
    assert apart_deg(bearing_of(*found.path_m[-2:]), heading) < 1e-6
    yaw = math.radians(heading)
    assert yaw_in({"pose": orientation(yaw)}, "pose") == pytest.approx(math.remainder(yaw, math.tau))
    assert yaw_in({"pose": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 0.0}}, "pose") is None


def test_over_dds_the_log_has_the_heading_at_each_picture(tmp_path: Path) -> None:
    pytest.importorskip("cyclonedds")
    from ros2.robot_in_process import connected_simulated_robot

    values = yaml.safe_load(profile_bytes("husky")[0])
    values |= {"turn_deg_s": 45}
    values["actions"][PICTURE]["camera"] = {"side": "right"}
    values["ros2"]["actions"] = {PICTURE: values["ros2"]["actions"][PICTURE]}
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
    taken = pictures(result.events)
    assert len(taken) == 3
    assert max(off_view(site, event, "right") for event in taken) <= OFF_DEG + 5.0
