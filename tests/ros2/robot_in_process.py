"""A robot in another process, over real DDS, on a time of its own that a test lets pass: no machine is too slow for it.

While the robot lives both do their steps in turn. Once it was killed time passes five times as fast as on the wall, and
so does the lease by which DDS forgets it: two seconds are as good as its ten.
"""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.dds.transport import DdsTransport
from fieldhand.execution.drivers.ros2.driver import Ros2Driver
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.robot_connection import needed_actions
from fieldhand.execution.drivers.ros2.simulated_robot.robot import bindings_of
from fieldhand.execution.drivers.ros2.transport import Client
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import Result, run
from fieldhand.execution.vehicle import Connection, Vehicle
from fieldhand.robot.bindings import Ros2Bindings
from fieldhand.robot.loader import load_robot
from fieldhand.robot.model import Patience, RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node
from ros2.conftest import LOOPBACK
from ros2.robot_process import ALL, FROM_ROBOT, NUMBER, TO_ROBOT
from ros2.scripted_robot import SITE, SPEED, TICK_S, bindings, interfaces
from support.missions.rig import authorized, husky, task_for
from support.processes.patience import LONG_S, until

_FASTER = 5.0
_LEASE = "<Discovery><LeaseDuration>2s</LeaseDuration></Discovery></Domain>"
#: So that a mission need not wait for minutes.
_PATIENCE = Patience(blocked_wait_s=2.0, lost_wait_s=4.0, navigation_wait_s=4.0)


class RobotInProcess:
    """The process."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("robot_process.py"))],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ
            | {
                "PYTHONPATH": os.pathsep.join(p for p in sys.path if p),
                "CYCLONEDDS_URI": LOOPBACK.replace("</Domain>", _LEASE),
            },
        )
        self.state: dict[str, Any] = {}

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def tell(self, what: str, **given: object) -> None:
        self.begin(what, **given)
        self.ended()

    def begin(self, what: str, **given: object) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps([what, given]) + "\n")
        self._process.stdin.flush()

    def ended(self) -> None:
        assert self._process.stdout is not None
        self.state = json.loads(self._process.stdout.readline())

    def end(self) -> None:
        """Have it leave the graph, as one that is switched off: nobody takes it for the next."""
        try:
            self._process.communicate(timeout=LONG_S)  # closes what it reads its lines from
        finally:
            self._process.kill()

    def kill(self) -> None:
        """As ``kill -9``."""
        self._process.kill()
        self._process.communicate()


class Lockstep(SimulatedClock):
    """Time that passes at both ends at once, at most ``tick_s`` in a step."""

    def __init__(self, robot: RobotInProcess, node: DdsTransport, tick_s: float = TICK_S) -> None:
        super().__init__()
        self._tick_s = tick_s
        #: What happens once, when something holds.
        self.meanwhile: tuple[Callable[[], bool], Callable[[], None]] | None = None
        #: True once the computer knows which servers the robot has begun or ended in the last step.
        self.settled: Callable[[], bool] = lambda: True
        self._robot, self._numbers = robot, itertools.count(1)
        self._said = node.publish(TO_ROBOT, NUMBER, ALL)
        self._heard = node.subscribe(FROM_ROBOT, NUMBER, ALL)
        robot.begin("meet")
        until(lambda: self._heard.publishers() == 1 and self._said.subscribers() == 1)
        robot.ended()

    def advance(self, seconds: float) -> None:
        until_s = self.now() + max(0.0, seconds)
        while self.now() < until_s - 1e-9:
            if self.meanwhile is not None and self.meanwhile[0]():
                (_, then), self.meanwhile = self.meanwhile, None
                then()
            step_s = min(self._tick_s, until_s - self.now())
            if self._robot.alive:
                number = next(self._numbers)
                self._said.send({"data": number})
                self._robot.tell("step", seconds=step_s, number=number)
                until(lambda number=number: {"data": number} in self._heard.take())  # type: ignore[misc]
                until(self.settled)
            else:
                time.sleep(step_s / _FASTER)
            super().advance(step_s)


class Meeting:
    """A computer and a robot that have found each other.

    Args:
        robot: Made anew with these switches (:meth:`ros2.robot_process.Process.new`).
        bound: What the computer takes the robot for.
    """

    def __init__(self, robot: RobotInProcess, bound: Ros2Bindings | None = None, **switches: Any) -> None:
        bound = bound or bindings(distro=switches.get("distro", "jazzy"))
        robot.tell("new", **switches)
        self.robot = robot
        self.profile: RobotProfile = replace(husky(), ros2=bound, speed_m_s=SPEED, patience=_PATIENCE)
        self._interfaces = interfaces(bound.release)
        self.node = open_dds(self._interfaces)
        self.clock = Lockstep(robot, self.node)

    def connect(self, within_s: float = 1.0, **options: Any) -> Ros2Driver:
        return Ros2Driver.connect(
            self.node,
            self._interfaces,
            SITE,
            self.profile,
            clock=self.clock,
            steady=self.clock.now,
            sleep=self.clock.advance,
            look_every_s=0.2,
            within_s=within_s,
            **options,
        )

    def fly(self, plan: Node | Task, driver: Ros2Driver | None = None) -> Result:
        """A whole mission."""
        task = plan if isinstance(plan, Task) else task_for(plan)
        return run(
            authorized(task, SITE, self.profile),
            site=SITE,
            robot=self.profile,
            driver=driver or self.connect(),
            guard=NoGuard(),
            clock=self.clock,
            emit=lambda _: None,
        )


def _client_of(node: DdsTransport, bound: Ros2Bindings, name: str, kind: str) -> Client:
    """Return a client that sees the servers of an action."""
    return node.client(f"{bound.whole_name(name)}/_action/send_goal", f"{kind}_SendGoal")


@contextmanager
def connected_simulated_robot(
    site: str, robot: str, task: Task, *, seed: int, tick_s: float, world: Mapping[str, Any] = {}, truth: str = ""
) -> Iterator[tuple[Vehicle, RobotInProcess]]:
    """A simulated robot in another process, as the vehicle of a mission: both live on one time.

    Args:
        truth: Profile of the robot as it is, if the mission takes it for another.
    """
    far, profile = RobotInProcess(), load_robot(robot)
    node: DdsTransport | None = None
    try:
        bound = bindings_of(profile)
        known = Interfaces.of(bound.release, bound.interfaces)
        node = open_dds(known)
        # The robot before may have been driven by another action; every one has a controller.
        controller = _client_of(node, bound, "follow_path", "nav2_msgs/action/FollowPath")
        navigator = _client_of(node, bound, bound.navigation.action, bound.navigation.type)
        # One that was killed is seen until its lease ends, whatever the clock says.
        until(lambda: controller.servers() == navigator.servers() == 0)
        far.tell("new_simulated_robot", site=site, robot=truth or robot, seed=seed, world=world)
        clock = Lockstep(far, node, tick_s)
        until(lambda: controller.servers() == navigator.servers() == 1)
        controller.close()
        # News of servers that end or begin travels as fast as the machine lets it, not as fast as time passes.
        clock.settled = lambda: navigator.servers() == far.state["navigators"]
        driver = Ros2Driver.connect(
            node,
            known,
            open_site(site),
            profile,
            clock=clock,
            steady=clock.now,
            sleep=clock.advance,
            look_every_s=tick_s,
            actions=needed_actions(task, profile),
        )
        by = Connection(transport="dds", sim_time=True)
        yield Vehicle(driver=driver, clock=clock, charge_percent=driver.charge_percent(), by=by), far
    finally:
        if node is not None:
            node.close()
        far.end()
