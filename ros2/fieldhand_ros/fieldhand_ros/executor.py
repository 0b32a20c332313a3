"""Lifecycle node that takes one signed mission and carries it out on the robot of its ROS graph.

    configure    verify the mission and store it            refused: invalid signature, wrong robot or site
    activate     check that the robot responds              refused: parts of the robot are missing
    deactivate   stop the robot, pause the mission
    cleanup      forget the mission                         refused: it is under way

Service calls are handled like commands that an agent receives over the network (``fieldhand agent``); this node adds no
rules of its own. The mission controls the robot from its own thread and ROS context, so nothing that blocks this node's
executor can delay it.
"""

from __future__ import annotations

import json
import os
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from std_srvs.srv import Trigger

from fieldhand.delivery.json_models import mission_summary
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.delivery.received_status import ReceivedStatus
from fieldhand.errors import FieldhandError, InputError
from fieldhand.execution.operator_commands import AGENT_COMMANDS, AgentCommand
from fieldhand.execution.vehicle import Connection
from fieldhand.program.robot_agent import RobotAgent, compose_robot_agent

DONE, REFUSED = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE

#: Time limits in seconds for the robot to respond, a mission to read a command, and a robot to stop.
ANSWERS_WITHIN_S, HEARS_WITHIN_S, RESTS_WITHIN_S = 15.0, 5.0, 30.0
#: Seconds between two polls while waiting, and between two publications of status and diagnostics.
LOOK_S, TELL_S = 0.05, 1.0
#: Commands that are also accepted while the node is inactive.
_WHEN_INACTIVE = ("pause", "abort")


class Executor(LifecycleNode):
    """The node ``executor``."""

    def __init__(self) -> None:
        super().__init__("executor")
        for name, default in (
            ("mission", ""),
            ("robot", ""),
            ("sites", [""]),
            ("missions", ""),
            ("config", ""),
            ("robot_namespace", ""),
            ("seed", 0),
            ("go_on", False),
        ):
            self.declare_parameter(name, default)
        self._robot_agent: RobotAgent | None = None
        self._received: ReceivedMission | None = None
        self._active = False
        #: Why the last transition was refused.
        self._problem = ""
        #: Lifecycle callbacks and the status timer run in different threads.
        self._guard = threading.RLock()
        orders = ReentrantCallbackGroup()
        for command in AGENT_COMMANDS:
            self.create_service(Trigger, f"~/{command}", self._answer(command), callback_group=orders)
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._status = self.create_publisher(String, "~/status", kept)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._published = ""
        self.create_timer(TELL_S, self._tell, callback_group=MutuallyExclusiveCallbackGroup())

    # --- lifecycle -----------------------------------------------------------------------------------------------

    def on_configure(self, _: LifecycleState) -> TransitionCallbackReturn:
        """Verify the mission and store it."""
        return self._transition(self._configure)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Check that the robot responds; continue an interrupted mission if configured."""
        done = self._transition(self._activate)
        return super().on_activate(state) if done == DONE else done

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot."""
        self._active = False
        self._transition(self._rest)
        return super().on_deactivate(state)

    def on_cleanup(self, _: LifecycleState) -> TransitionCallbackReturn:
        """Forget the mission."""
        return self._transition(self._clean_up)

    def on_shutdown(self, _: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot and disconnect."""
        self.let_go()
        return DONE

    def on_error(self, _: LifecycleState) -> TransitionCallbackReturn:
        """After an internal error: stop the robot, so that the node can be configured again."""
        self.let_go()
        return DONE

    def let_go(self) -> None:
        """Stop the robot and disconnect; a mission under way is paused and can be continued."""
        with self._guard:
            robot_agent, self._robot_agent, self._received, self._active = self._robot_agent, None, None, False
        if robot_agent is not None:
            robot_agent.close()

    def _transition(self, make: Callable[[], None]) -> TransitionCallbackReturn:
        """Perform a transition; refuse it and log the reason if it fails."""
        try:
            make()
        except FieldhandError as error:
            self._problem = str(error)
            self.get_logger().error(self._problem)
            return REFUSED
        self._problem = ""
        return DONE

    def _configure(self) -> None:
        file, robot = self._text("mission"), self._text("robot")
        for name, value in (("mission", file), ("robot", robot)):
            if not value:
                raise InputError(f"the parameter {name} is not set", where=self.get_name(), advice="set it first")
        config, store, namespace = (self._text(name) for name in ("config", "missions", "robot_namespace"))
        robot_agent = compose_robot_agent(
            os.environ | ({"FIELDHAND_CONFIG": config} if config else {}),
            robot=robot,
            sites=tuple(site for site in self._value("sites") if site),
            store=Path(store) if store else None,
            seed=self._value("seed"),
            connection=Connection(
                transport="rclpy",
                domain=self.context.get_domain_id(),
                namespace=_namespace(namespace) if namespace else None,
                sim_time=self._value("use_sim_time"),
            ),
            warn=self.get_logger().warning,
        )
        try:
            received = robot_agent.take(Path(file))
        except FieldhandError:
            robot_agent.close()
            raise
        with self._guard:
            self._robot_agent, self._received = robot_agent, received
        self.get_logger().info(f"{received.name}, signed by {received.signer}: {received.request}")

    def _activate(self) -> None:
        robot_agent = self._configured_agent()
        until = time.monotonic() + ANSWERS_WITHIN_S
        while missing := robot_agent.missing():
            if time.monotonic() >= until:
                raise InputError(
                    f"of the robot is missing: {'; '.join(missing)}",
                    where=robot_agent.on,
                    advice="start it; if it runs, compare names, robot_namespace and ROS_DOMAIN_ID",
                )
            time.sleep(LOOK_S)
        robot_agent.supervisor.write_missing_report()
        self._active = True
        if self._value("go_on") and (cut := robot_agent.supervisor.continue_interrupted()):
            self.get_logger().info(f"going on with mission {cut[:16]}")

    def _rest(self) -> None:
        self._configured_agent().pause_for_exit(RESTS_WITHIN_S)

    def _clean_up(self) -> None:
        if self._configured_agent().supervisor.active is not None:
            raise InputError(
                "the mission is under way: it is paused",
                where=self.get_name(),
                advice="abort it; or end the node, it can be gone on with then",
            )
        self.let_go()

    # --- commands ------------------------------------------------------------------------------------------------

    def _answer(self, command: AgentCommand) -> Callable[[Any, Any], Any]:
        def answer(_: Any, response: Any) -> Any:
            try:
                response.success, response.message = self._tell_mission(command)
            except FieldhandError as error:
                response.success, response.message = False, str(error)
            if not response.success:
                self.get_logger().warning(f"{command}: {response.message}")
            return response

        return answer

    def _tell_mission(self, command: AgentCommand) -> tuple[bool, str]:
        robot_agent, received = self._configured_agent(), self._received
        if received is None or (not self._active and command not in _WHEN_INACTIVE):
            raise InputError(f"the node is not active: it cannot {command}", advice="activate it first")
        until = time.monotonic() + HEARS_WITHIN_S

        def wait() -> bool:
            time.sleep(LOOK_S)
            return time.monotonic() < until

        if not robot_agent.supervisor.give_command(received, command, f"{command} was called over ROS 2", wait=wait):
            return False, f"the mission has not heard it within {HEARS_WITHIN_S:g} s; it will"
        standing = robot_agent.supervisor.status_of(received)
        return True, standing.doing or standing.state

    def _configured_agent(self) -> RobotAgent:
        robot_agent = self._robot_agent
        if robot_agent is None:
            raise InputError("there is no mission", where=self.get_name(), advice="configure the node first")
        return robot_agent

    # --- status --------------------------------------------------------------------------------------------------

    def _tell(self) -> None:
        with self._guard:
            robot_agent, received = self._robot_agent, self._received
            standing = None if robot_agent is None or received is None else robot_agent.supervisor.status_of(received)
            missing = () if robot_agent is None else robot_agent.missing()
        words = {
            "robot": "" if robot_agent is None else robot_agent.robot.name,
            "on": "" if robot_agent is None else robot_agent.on,
            "active": self._active,
            "missing": list(missing),
            "problem": self._problem,
            "mission": None if standing is None else mission_summary(standing).model_dump(mode="json"),
        }
        text = json.dumps(words, ensure_ascii=False)
        if text != self._published:
            self._published = text
            self._status.publish(String(data=text))
        status = diagnosed(self.get_name(), standing, missing, self._problem)
        status.hardware_id = words["robot"]
        array = DiagnosticArray(status=[status])
        array.header.stamp = self.get_clock().now().to_msg()
        self._diagnostics.publish(array)

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _text(self, name: str) -> str:
        return str(self._value(name)).strip()


def diagnosed(node: str, standing: ReceivedStatus | None, missing: tuple[str, ...], problem: str) -> DiagnosticStatus:
    """Return the state of the mission as a diagnostic status."""
    level, message = DiagnosticStatus.OK, "no mission"
    values = {"missing": "; ".join(missing), "problem": problem}
    if standing is not None:
        message = standing.doing or standing.state
        values |= {
            "mission": standing.received.name,
            "state": standing.state,
            "status": standing.status,
            "reason": standing.reason,
            "travelled_m": f"{standing.travelled_m:.1f}",
        }
        if standing.charge_percent is not None:
            values["charge_percent"] = f"{standing.charge_percent:.1f}"
        if standing.state in ("paused", "interrupted") or missing:
            level = DiagnosticStatus.WARN
        if standing.state == "lost" or standing.status in ("exceeded", "faulted"):
            level = DiagnosticStatus.ERROR
    if missing:
        level, message = max(level, DiagnosticStatus.WARN), f"the robot does not answer: {missing[0]}"
    fault = problem or ("" if standing is None else standing.fault)
    if fault:
        level, message = DiagnosticStatus.ERROR, fault
    return DiagnosticStatus(
        level=level,
        name=f"{node}: mission",
        message=message,
        values=[KeyValue(key=key, value=value) for key, value in values.items() if value],
    )


def _namespace(text: str) -> str:
    from fieldhand.robot.bindings_document import as_namespace

    try:
        return as_namespace(text)
    except ValueError as error:
        what, _, advice = str(error).partition("; ")
        raise InputError(what, where="robot_namespace", advice=advice) from None


def main() -> None:
    """Run the node; entry point of ``ros2 run fieldhand_ros executor``."""
    rclpy.init()
    node = Executor()
    executor = MultiThreadedExecutor(8)
    executor.add_node(node)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()
    node.let_go()


if __name__ == "__main__":
    main()
