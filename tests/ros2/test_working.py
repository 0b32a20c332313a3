"""Work along paths over ROS 2: the implement is on where the path says so, and off at every end, also after a kill."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import replace

import pytest

import ros2.test_simulated_robot_contract as contract
from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.driver import Ros2Driver
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.profile_check import check_types
from fieldhand.execution.drivers.ros2.robot_connection import needed_actions
from fieldhand.execution.drivers.ros2.simulated_robot.robot import GoalReport, SimulatedRobot
from fieldhand.execution.drivers.simulation.world import ActionFails, Blocked, TreeRef, World
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import Result, run
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.plan import InOrder, Node, WorkAlong
from fieldhand.task.results import Ended, Worked
from ros2.in_memory import Graph
from ros2.simulated_robot_rig import interfaces_of
from support.missions.rig import Rig, authorized, of_type, task_for
from support.missions.working import along, gappy, tractor

SITE = gappy()
SWITCHES = {"mow": "/mower/enable", "spray": "/sprayer/set", "film": "/side_camera/record"}


def robot_with(**navigation: object) -> RobotProfile:
    robot = tractor()
    assert robot.ros2 is not None
    changed = replace(robot.ros2.navigation, **navigation)  # type: ignore[arg-type]
    return replace(robot, ros2=replace(robot.ros2, navigation=changed))


def without(robot: RobotProfile, action: str) -> RobotProfile:
    """The robot without the binding of an action."""
    assert robot.ros2 is not None
    left = {name: bound for name, bound in robot.ros2.actions.items() if name != action}
    return replace(robot, ros2=replace(robot.ros2, actions=left))


class Field:
    """A simulated tractor and a driver that is connected to it, in memory or over DDS."""

    def __init__(
        self, robot: RobotProfile, world: World | None = None, *, dds: bool = False, site: Site = SITE
    ) -> None:
        self.robot, self.site, self.said = robot, site, list[GoalReport]()
        self.clock = contract.SharedClock()
        bound = robot.ros2
        assert bound is not None
        self.interfaces = interfaces_of(bound.release, tuple(bound.interfaces.items()))
        self.opened: list[object] = []
        if dds:
            over = contract.TestOverDds()
            over.robot = robot  # type: ignore[misc]
            over.opened = []
            far, self.node, _ = over.nodes(self.clock)
            self.opened = list(over.opened)
        else:
            graph = Graph(self.clock.now, complete=self.interfaces.complete)
            far, self.node = graph.node(), graph.node()
        self.simulated = SimulatedRobot(
            site, robot, world or World(), far, self.interfaces, self.clock, seed=0, speed=10.0, wall=self.clock.now,
            report=self.said.append,
        )  # fmt: skip
        self.clock.lives = self.simulated.step

    def connect(self, actions: Collection[str] | None = None) -> Ros2Driver:
        driver = Ros2Driver.connect(
            self.node, self.interfaces, self.site, self.robot, clock=self.clock, steady=self.clock.now,
            sleep=self.clock.advance, look_every_s=1.0, actions=actions,
        )  # fmt: skip
        self.clock.looks = driver.poll
        return driver

    def fly(self, plan: Node, *, interrupted: Callable[[], str | None] = lambda: None) -> Result:
        task = task_for(InOrder(steps=(plan,)))
        result = run(
            authorized(task, self.site, self.robot), site=self.site, robot=self.robot,
            driver=self.connect(needed_actions(task, self.robot)), guard=NoGuard(), clock=self.clock,
            emit=lambda _: None, interrupted=interrupted,
        )  # fmt: skip
        self.clock.advance(2.0)
        return result

    def switched(self, action: str) -> list[str]:
        """Return the changes of an implement's switch."""
        return [said.end for said in self.said if said.name == SWITCHES[action]]

    def close(self) -> None:
        for node in self.opened:
            node.close()  # type: ignore[attr-defined]


def test_the_bindings_of_the_tractor_fit_their_types() -> None:
    bound = tractor().ros2
    assert bound is not None
    report = check_types(tractor(), Interfaces.of(bound.release, bound.interfaces))
    assert report.missing == ()
    assert {e.binding.name for e in report.endpoints} >= {*SWITCHES.values(), "/follow_path"}


@pytest.mark.parametrize("distro", ["humble", "iron", "jazzy", "kilted"])
def test_every_release_has_the_action_that_follows_a_path(distro: str) -> None:
    assert Interfaces.of(distro).knows("nav2_msgs/action/FollowPath")  # type: ignore[arg-type]


@pytest.mark.parametrize("action", ["spray", "mow", "film"])
def test_it_is_on_from_the_first_to_the_last_plant_and_off_in_the_gap(action: str) -> None:
    field = Field(tractor())
    result = field.fly(along("r1", action=action))
    assert result.status == "completed", result.reason
    assert field.switched(action) == ["on", "off", "on", "off"]
    (worked,) = of_type(result.events, Worked)
    (simulated,) = of_type(
        Rig(site=SITE, robot=tractor()).fly(InOrder(steps=(along("r1", action=action),))).events, Worked
    )
    assert (worked.stretch, worked.status) == (simulated.stretch, "success")
    assert worked.worked_m == pytest.approx(simulated.worked_m)
    assert worked.leg_m == pytest.approx(simulated.leg_m, rel=0.05)


@pytest.mark.parametrize(
    "navigation",
    [
        {"working": "", "working_action": ""},
        {"working": "nav2_msgs/action/NavigateThroughPoses", "working_action": "drive_through"},
        {"type": "nav2_msgs/action/NavigateToPose", "action": "navigate_to_pose", "working": "", "working_action": ""},
    ],
)
def test_the_path_is_driven_as_the_profile_says(navigation: dict[str, object]) -> None:
    field = Field(robot_with(**navigation))
    result = field.fly(along("r0"))
    assert result.status == "completed", result.reason
    assert field.switched("spray") == ["on", "off"]
    assert of_type(result.events, Worked)[0].worked_m == pytest.approx(20.0, abs=0.2)


def test_a_drive_without_an_action_switches_nothing() -> None:
    field = Field(tractor())
    assert field.fly(along("r0", action="")).status == "completed"
    assert [said for said in field.said if said.end in ("on", "off")] == []


def test_a_switch_that_fails_is_tried_again_and_then_ends_the_plan() -> None:
    once = Field(tractor(), World(faults=(ActionFails(action="spray", times=1),)))
    assert once.fly(along("r0")).status == "completed"
    assert once.switched("spray") == ["failed", "on", "off"]
    always = Field(tractor(), World(faults=(ActionFails(action="spray"),)))
    result = always.fly(along("r0"))
    assert result.status == "faulted"
    assert "spray gave an error" in result.reason
    assert "on" not in always.switched("spray")


def test_it_is_off_before_an_obstacle() -> None:
    field = Field(tractor(), World(faults=(Blocked(at=TreeRef(id="r1c3"), within_m=1.6),)))
    result = field.fly(along("r1"))
    ends = field.switched("spray")
    assert ends[-1] == "off"
    assert ends.count("on") == ends.count("off") >= 2
    assert of_type(result.events, Ended)[0].status == "faulted"


def test_an_operator_stops_it_and_it_is_off() -> None:
    field = Field(tractor())
    result = field.fly(along("r0"), interrupted=lambda: "enough" if "on" in field.switched("spray") else None)
    assert result.status == "aborted"
    assert field.switched("spray") == ["on", "off"]


@pytest.mark.parametrize("needed", [None, {"read_soil_moisture"}])
def test_after_a_kill_the_next_start_switches_it_off(needed: set[str] | None) -> None:
    field = Field(tractor())

    class KilledError(BaseException):
        pass

    def kill() -> str | None:
        if "on" in field.switched("spray"):
            raise KilledError
        return None

    driver = field.connect()
    goal_driver = driver
    with pytest.raises((KilledError, SystemExit)):
        run(
            authorized(task_for(InOrder(steps=(along("r0"),))), SITE, field.robot),
            site=SITE, robot=field.robot, driver=_Dying(goal_driver), guard=NoGuard(), clock=field.clock,
            emit=lambda _: None, interrupted=kill,
        )  # fmt: skip
    assert field.switched("spray") == ["on"]
    field.clock.looks = lambda: None
    driver.close()
    field.connect(needed)
    field.clock.advance(1.0)
    assert field.switched("spray") == ["on", "off"]


def test_an_implement_that_the_mission_does_not_need_may_be_missing() -> None:
    field = Field(without(tractor(), "spray"))
    field.robot = tractor()
    assert field.fly(WorkAlong(action="mow", along=along("r0").along)).status == "completed"
    with pytest.raises(Ros2Error, match="spray"):
        field.connect({"spray"})


class _Dying:
    """A driver whose process is gone: cancelling has no effect any more."""

    def __init__(self, driver: Ros2Driver) -> None:
        self._driver = driver

    def __getattr__(self, name: str) -> object:
        return getattr(self._driver, name)

    def cancel(self) -> None:
        raise SystemExit("killed")


def test_a_mission_over_dds_works_where_the_simulation_works() -> None:
    pytest.importorskip("cyclonedds")
    plan = InOrder(steps=(along("r0"), WorkAlong(action="mow", mode="aisles", along=along("r0", "r1").along)))
    field = Field(tractor(), dds=True)
    try:
        result = field.fly(plan)
        assert result.status == "completed", result.reason
        here = of_type(Rig(site=SITE, robot=tractor()).fly(InOrder(steps=(plan,))).events, Worked)
        there = of_type(result.events, Worked)
        assert [(w.action, w.stretch, w.status) for w in there] == [(w.action, w.stretch, w.status) for w in here]
        assert [w.worked_m for w in there] == pytest.approx([w.worked_m for w in here])
        assert field.switched("spray") == ["on", "off"]
        assert field.switched("mow") == ["on", "off"] * (len(there) - 1)
    finally:
        field.close()
