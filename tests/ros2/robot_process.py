"""The scripted robot, or the simulated one, in a process of its own, over real DDS; it does a step when it is told to.

Lines of JSON come in, one goes out for each. What both ends have sent before a step has arrived when it begins: each
sends a number behind it, and waits for the other's.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.dds.transport import DdsTransport
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.simulated_robot.robot import GoalReport, SimulatedRobot, bindings_of
from fieldhand.execution.drivers.ros2.transport import QosProfile
from fieldhand.execution.drivers.simulation.world_file import parse_world
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from ros2.scripted import Script, ScriptedAction
from ros2.scripted_robot import INTERFACES, Robot, bindings, interfaces
from support.processes.patience import until

NUMBER, TO_ROBOT, FROM_ROBOT, ALL = "std_msgs/msg/Int32", "/to_robot", "/from_robot", QosProfile(depth=10)


class Process:
    """Carry out the lines, each done by the method of its name."""

    def __init__(self) -> None:
        self.clock = SimulatedClock()
        self.nodes: list[DdsTransport] = []
        self.robots: list[Robot | SimulatedRobot] = []

    def new(
        self,
        robots: int = 1,
        distro: Any = "jazzy",
        namespace: str = "/husky",
        definitions: Mapping[str, str] = {},
        hashes: bool = True,
        thermometer_type: str = "",
        **switches: Any,
    ) -> None:
        """Another robot in place of the one before, or several.

        Args:
            definitions: In place of those that the computer has.
            hashes: Say of which definition types are, those of ``definitions`` among them; before Iron nobody did.
            thermometer_type: Of this service, in place of what the computer has.
        """
        self.end()
        known = Interfaces.of(distro, INTERFACES | dict(definitions)) if definitions else interfaces(distro)
        if not hashes:
            known.type_hash = lambda _: ""  # type: ignore[method-assign]
        self.nodes = [open_dds(known) for _ in range(robots)]
        bound = bindings(distro=distro, namespace=namespace)
        made = [Robot(node, self.clock, bound) for node in self.nodes]
        self.robots = [*made]
        for robot in made:
            if thermometer_type:
                robot.thermometer.close()
                robot.thermometer = robot.node.serve("/thermometer", thermometer_type)
        self.change(**switches)
        self._listen()

    def new_simulated_robot(self, site: str, robot: str, seed: int, world: Mapping[str, Any] = {}) -> None:
        """The simulated robot of a site, a profile and a world, in place of the one before."""
        self.end()
        profile = load_robot(robot)
        bound = bindings_of(profile)
        known = Interfaces.of(bound.release, bound.interfaces)
        self.nodes = [open_dds(known)]
        self.said_of_goals: list[GoalReport] = []
        action = f"{bound.whole_name(bound.navigation.action)}/_action/send_goal"
        self.navigators = self.nodes[0].client(action, f"{bound.navigation.type}_SendGoal")
        simulated = SimulatedRobot(
            open_site(site),
            profile,
            parse_world(world),
            self.nodes[0],
            known,
            self.clock,
            seed=seed,
            sim_time=True,
            report=self.said_of_goals.append,
        )
        self.robots = [simulated]
        self._listen()

    def _listen(self) -> None:
        """Take the numbers of the other end, and send them back."""
        self.heard = self.nodes[0].subscribe(TO_ROBOT, NUMBER, ALL)
        self.said = self.nodes[0].publish(FROM_ROBOT, NUMBER, ALL)

    def change(
        self, *, without: str = "", blocked: Sequence[float] = (), thermometer: Any = "", **switches: Any
    ) -> None:
        """Switches of the robot.

        Args:
            without: The server of this ends.
            blocked: What stands in its way: x, y and radius.
            thermometer: What it answers; None for nothing.
        """
        for robot in self.robots:
            assert isinstance(robot, Robot)
            if without:
                getattr(robot, without).close()
            if blocked:
                robot.blocked = lambda xy: math.dist(xy, blocked[:2]) < blocked[2]
            if thermometer != "":
                robot.reading = lambda _: thermometer
            for name, value in switches.items():
                setattr(robot, name, set(value) if name == "silent" else value)

    def another(self) -> None:
        """A second robot is switched on, under the same names."""
        node = open_dds(self.nodes[0].interfaces)
        self.nodes.append(node)
        robot = self.robots[0]
        assert isinstance(robot, Robot)
        navigation = robot.bound.navigation
        whole = robot.bound.whole_name(navigation.action)
        ScriptedAction(node, whole, navigation.type, self.clock.now, lambda _: Script())

    def meet(self) -> None:
        """Until the computer is found."""
        until(lambda: self.heard.publishers() == 1 and self.said.subscribers() == 1)

    def step(self, seconds: float, number: int) -> None:
        """Let time pass."""
        until(lambda: {"data": number} in self.heard.take())
        self.clock.advance(seconds)
        for robot in self.robots:
            robot.step()
        self.said.send({"data": number})

    def end(self) -> None:
        """Leave the graph."""
        for node in self.nodes:
            node.close()

    def state(self) -> dict[str, object]:
        """Return the place at which the robot is; of the simulated one, its goals and how many navigators are there."""
        robot = self.robots[0]
        if isinstance(robot, SimulatedRobot):
            return {
                "made": [(said.name, said.place) for said in self.said_of_goals if said.end == "succeeded"],
                "ends": [(said.name, said.end) for said in self.said_of_goals],
                "driven_m": robot.platform.metres,
                "xy": robot.platform.true_position.xy,
                "believes": robot.platform.position.xy,
                "navigators": self.navigators.servers(),
            }
        return {"executing": len(robot.navigation.executing) + len(robot.sampler.executing), "xy": robot.xy,
                "goals": len(robot.navigation.received), "driven_m": robot.driven_m}  # fmt: skip


def main() -> None:
    process = Process()
    for line in sys.stdin:
        does, given = json.loads(line)
        getattr(process, does)(**given)
        print(json.dumps(process.state()), flush=True)
    process.end()


if __name__ == "__main__":
    main()
