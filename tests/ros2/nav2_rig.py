"""Missions on the simulated robot with what its Nav2 does, on a graph in memory: all of it on one time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.ros2.driver import Ros2Driver
from fieldhand.execution.drivers.ros2.simulated_robot.robot import GoalReport, SimulatedRobot
from fieldhand.execution.drivers.simulation.world import World, WorldFault
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import Result, nobody, run
from fieldhand.execution.operator_commands import OperatorCommand
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.bindings import Distro
from fieldhand.robot.model import RobotProfile
from fieldhand.task.plan import Act, GoTo, InOrder, Node
from ros2.in_memory import Graph
from ros2.in_memory import Node as GraphNode
from ros2.simulated_robot_rig import SITE, bindings, interfaces_of, reached_by
from support.missions.rig import authorized, husky, task_for

TICK_S = 0.1


class SteppingClock(SimulatedClock):
    """A clock that lets the robot step while time passes.

    Attributes:
        steps: Called after each step.
    """

    def __init__(self) -> None:
        super().__init__()
        self.steps: list[Callable[[], None]] = []

    def advance(self, seconds: float) -> None:
        until = self.now() + max(0.0, seconds)
        while self.now() < until - 1e-9:
            super().advance(min(TICK_S, until - self.now()))
            for step in self.steps:
                step()


def profile(*, distro: Distro = "jazzy", patience: dict[str, float] | None = None, **navigation: Any) -> RobotProfile:
    """The built-in robot, with other keys of its navigation and of its patience."""
    robot = reached_by(husky(), distro=distro, **navigation)
    return replace(robot, patience=replace(robot.patience, **(patience or {})))


@dataclass
class Nav2Rig:
    """A simulated robot and a computer that finds it.

    Attributes:
        reports: What the robot says of its goals.
    """

    faults: tuple[WorldFault, ...] = ()
    robot: RobotProfile = field(default_factory=profile)
    reports: list[GoalReport] = field(default_factory=list)

    def __post_init__(self) -> None:
        ros2 = bindings(self.robot)
        self.interfaces = interfaces_of(ros2.release, tuple(ros2.interfaces.items()))
        self.clock = SteppingClock()
        self.graph = Graph(self.clock.now, complete=self.interfaces.complete)
        self.simulated = SimulatedRobot(
            SITE,
            self.robot,
            World(faults=self.faults),
            self.graph.node(),
            self.interfaces,
            self.clock,
            seed=0,
            sim_time=True,
            report=self.reports.append,
        )
        self.computer: GraphNode = self.graph.node()
        self.clock.steps.append(self.simulated.step)

    def connect(self, within_s: float = 3.0) -> Ros2Driver:
        return Ros2Driver.connect(
            self.computer,
            self.interfaces,
            SITE,
            self.robot,
            clock=self.clock,
            steady=self.clock.now,
            sleep=self.clock.advance,
            look_every_s=0.2,
            within_s=within_s,
        )

    def fly(self, *plan: Node, orders: Callable[[], OperatorCommand | None] = nobody) -> Result:
        """A whole mission."""
        return run(
            authorized(task_for(plan[0] if len(plan) == 1 else InOrder(id="", steps=plan)), SITE, self.robot),
            site=SITE,
            robot=self.robot,
            driver=self.connect(),
            guard=NoGuard(),
            clock=self.clock,
            emit=lambda _: None,
            orders=orders,
        )

    def ends(self, of: str = "navigate_to_pose") -> list[str]:
        """Return how the goals of one of its actions ended."""
        return [report.end for report in self.reports if report.name.endswith(of)]


def go(tree: str) -> GoTo:
    return GoTo(id="", place=TreeIs(tree=tree))


def act(tree: str, action: str = "read_co2") -> Act:
    return Act(id="", action=action, at=TreeIs(tree=tree))
