"""The driver keeps its contract with a simulated robot: all corners at once in memory, one by one over real DDS."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import ClassVar

import pytest

from fieldhand.clock import Clock, SimulatedClock
from fieldhand.execution.drivers.protocol import Driver
from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.driver import Ros2Driver
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.simulated_robot.robot import SimulatedRobot
from fieldhand.execution.drivers.ros2.transport import QosProfile, Transport
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    Blocked,
    LocalisationLost,
    SensorSilent,
    TreeRef,
    World,
)
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import Result, run
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.results import Acted
from fieldhand.testing.driver_contract import DriverContract, drive_goal, finish
from ros2.in_memory import Graph
from ros2.simulated_robot_rig import SITE, interfaces_of, reached_by
from support.missions.rig import Rig, authorized, husky, of_type
from support.processes.patience import until

DEMO = open_site("demo")
FAR = SITE.trees[-1].place
#: Seconds of the robot between two looks at everything, and of the mission between two looks at its goal.
SLICE_S, LOOK_S = 0.4, 3.0


class SharedClock(SimulatedClock):
    """The robot's clock and the mission's: while it is advanced, the robot lives and the mission looks at its goal."""

    def __init__(self) -> None:
        super().__init__()
        self.lives: Callable[[], object] = lambda: None
        self.looks: Callable[[], object] = lambda: None
        self.carries: Callable[[], object] = lambda: None

    def advance(self, seconds: float) -> None:
        until = self.now() + seconds
        while (left := until - self.now()) > 1e-9:
            super().advance(min(left, SLICE_S))
            self.lives()
            self.carries()
            self.looks()


def only(action: str) -> RobotProfile:
    """The robot, bound to no other action."""
    robot = husky(alpha=0.5)
    assert robot.ros2 is not None
    return replace(robot, ros2=replace(robot.ros2, actions={action: robot.ros2.actions[action]}))


class OverSimulatedRobot(DriverContract):
    """Above any transport."""

    robot: ClassVar[RobotProfile] = husky(alpha=0.5)

    def make(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(World())

    def make_blocked(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(World(faults=(Blocked(at=TreeRef(id=FAR.id), within_m=2.0),)))

    def make_lost(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(World(faults=(LocalisationLost(at_s=8.0, for_s=20.0),)))

    def make_broken(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(World(faults=(ActionFails(action=self.action),)))

    def make_in(self, world: World, site: Site = SITE) -> tuple[Driver, Clock, Site]:
        clock = SharedClock()
        robot, mission, interfaces = self.nodes(clock)
        simulated = SimulatedRobot(
            site, self.robot, world, robot, interfaces, clock, seed=0, speed=10.0, wall=clock.now
        )
        clock.lives = simulated.step
        driver = Ros2Driver.connect(
            mission,
            interfaces,
            site,
            self.robot,
            clock=clock,
            steady=self.steady(clock),
            sleep=clock.advance,
            look_every_s=LOOK_S,
        )
        clock.looks = driver.poll
        return driver, clock, site

    def nodes(self, clock: SharedClock) -> tuple[Transport, Transport, Interfaces]:
        """Of the robot and of the mission."""
        interfaces = self.interfaces()
        graph = Graph(clock.now, complete=interfaces.complete)
        return graph.node(), graph.node(), interfaces

    def steady(self, clock: SharedClock) -> Callable[[], float]:
        return clock.now

    def interfaces(self) -> Interfaces:
        assert self.robot.ros2 is not None
        return interfaces_of(self.robot.ros2.release, tuple(self.robot.ros2.interfaces.items()))


class TestAllCornersAtOnce(OverSimulatedRobot):
    """By the codes of newer releases."""

    robot: ClassVar[RobotProfile] = reached_by(
        husky(alpha=0.5), distro="jazzy", type="nav2_msgs/action/NavigateThroughPoses"
    )


class TestOverDds(OverSimulatedRobot):
    """Time passes when all messages of the moment before have arrived; it has what the contract asks for, no more."""

    robot: ClassVar[RobotProfile] = only("read_co2")

    @pytest.fixture(autouse=True)
    def _closed(self) -> Iterator[None]:
        self.opened: list[Transport] = []
        yield
        for node in self.opened:
            node.close()

    def nodes(self, clock: SharedClock) -> tuple[Transport, Transport, Interfaces]:
        interfaces = self.interfaces()
        robot, mission = open_dds(interfaces), open_dds(interfaces)
        self.opened = [robot, mission]
        number, everything = "std_msgs/msg/Int32", QosProfile(depth=10)
        ends = [
            (writer.publish(topic, number, everything), reader.subscribe(topic, number, everything))
            for topic, writer, reader in (("/to_mission", robot, mission), ("/to_robot", mission, robot))
        ]
        until(lambda: all(said.subscribers() == 1 == heard.publishers() for said, heard in ends))
        numbers = itertools.count()

        def carry() -> None:
            """Wait until what both have sent so far has arrived: each sends a number behind it."""
            behind = {"data": next(numbers)}
            for said, _ in ends:
                said.send(behind)
            for _, heard in ends:
                until(lambda heard=heard: behind in heard.take())  # type: ignore[misc]

        clock.carries = carry
        return robot, mission, interfaces


def test_a_mission_captures_on_the_robot_what_it_captures_in_simulation() -> None:
    """With a failed call, a sensor that is silent once, and a reading that decides what is done."""
    request = (
        "Measure the CO2 and the ambient temperature at every fourth tree of row 3."
        " If the ambient temperature is low, take a thermal picture."
    )
    planned = EnglishPlanner().plan(request, DEMO, husky(alpha=0.5))
    assert isinstance(planned, Planned)
    faults = (ActionFails(action="read_co2", times=1), SensorSilent(quantity="ambient_temperature", times=1))
    world = World(faults=faults)
    robot = OverSimulatedRobot()
    driver, clock, _ = robot.make_in(world, DEMO)
    flown = run(
        authorized(planned.task, DEMO, robot.robot),
        site=DEMO,
        robot=robot.robot,
        driver=driver,
        guard=NoGuard(),
        clock=clock,
        emit=lambda event: None,
    )
    simulated = Rig(site=DEMO, robot=robot.robot, world=world).fly(planned.task)
    assert _captures(flown) == _captures(simulated)
    assert {"failed", "success"} == {status for _, _, _, status, _ in _captures(flown)}


def _captures(result: Result) -> list[tuple[str, str, str, str, dict[str, float]]]:
    """Node, action, place, how it ended, and its readings."""
    return [
        (e.node, e.action, e.place, e.status, {name: round(value, 6) for name, value in e.readings.items()})
        for e in of_type(result.events, Acted)
    ]


def waiting_long(robot: RobotProfile) -> RobotProfile:
    """The robot, believed for a minute after its last message."""
    ros2 = robot.ros2
    assert ros2 is not None
    assert ros2.odometry is not None
    fix = replace(ros2.position.fix, stale_s=60.0)
    odometry = replace(ros2.odometry, stale_s=60.0)
    return replace(robot, ros2=replace(ros2, position=replace(ros2.position, fix=fix), odometry=odometry))


class HeardLate(OverSimulatedRobot):
    """By one goal, its position believed for long."""

    robot: ClassVar[RobotProfile] = waiting_long(
        reached_by(husky(alpha=0.5), distro="jazzy", type="nav2_msgs/action/NavigateThroughPoses")
    )


def test_a_position_from_before_the_robot_drove_on_is_no_sign_of_a_wrong_map(monkeypatch: pytest.MonkeyPatch) -> None:
    """A busy computer takes feedback some seconds after the position; both say when they are from."""
    driver, clock, site = HeardLate().make_in(World(), DEMO)
    driver.start_drive(drive_goal(site.start, site.trees[0].place))
    clock.advance(2.0)
    with monkeypatch.context() as held:
        held.setattr(driver._telemetry, "listen", lambda: None)  # type: ignore[attr-defined]
        clock.advance(9.0)
    progress = finish(driver, clock)
    assert (progress.state, progress.what) == ("succeeded", "")
