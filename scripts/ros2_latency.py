"""Measure the latency of service calls and goals over DDS, and count those that are lost.

    python scripts/ros2_latency.py --calls 1000 --goals 200

A second process provides the two interfaces that a mission uses: ``robot_localization/srv/FromLL``, which returns the
latitude and longitude as metres, and ``nav2_msgs/action/NavigateToPose``, whose goals send some messages of feedback
and then succeed. A call is lost if no correct reply arrives within 10 s. Only the loopback interface is used unless
CYCLONEDDS_URI selects another.
"""

from __future__ import annotations

import argparse
import os
import platform
import select
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import closing
from typing import TypeVar

from fieldhand.execution.drivers.ros2.action_client import ActionClient
from fieldhand.execution.drivers.ros2.action_outcome import EXECUTING, SUCCEEDED
from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.dds.transport import DdsTransport
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.message_fields import value_at
from fieldhand.execution.drivers.ros2.transport import STATUS_QOS, RosMessage

FROM_LL, NAVIGATE = "robot_localization/srv/FromLL", "nav2_msgs/action/NavigateToPose"
DISTRO, LIMIT_S, LOOK_S = "humble", 10.0, 0.0005
LOOPBACK = (
    "<CycloneDDS><Domain><General><Interfaces>"
    '<NetworkInterface name="lo"/>'
    "</Interfaces></General></Domain></CycloneDDS>"
)

_Seen = TypeVar("_Seen")


def main() -> int:
    """Start the other process, measure, and print the results."""
    options = _options()
    os.environ.setdefault("CYCLONEDDS_URI", LOOPBACK)
    os.environ["ROS_DOMAIN_ID"] = str(options.domain)
    if options.answer:
        answer(options.feedback)
        return 0
    calls, goals = measured(options.calls, options.goals, options.feedback)
    print(f"{platform.node()}: {os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()}")
    _print_times("calls of a service", calls)
    _print_times(f"goals of {options.feedback} feedback each", goals)
    return 1 if None in calls + goals else 0


def measured(calls: int, goals: int, feedback: int) -> tuple[list[float | None], list[float | None]]:
    """Return the duration of each call and each goal to another process, seconds; None for one that was lost."""
    own = [sys.executable, __file__, "--answer", "--domain", os.environ["ROS_DOMAIN_ID"], "--feedback", str(feedback)]
    with subprocess.Popen(own, stdin=subprocess.PIPE) as other, closing(open_dds(Interfaces.of(DISTRO))) as node:
        assert other.stdin is not None  # noqa: S101 - it is a pipe
        taken = _times(calls, _caller(node)), _times(goals, _goal_sender(node))
        other.stdin.close()
    return taken


def _times(many: int, done: Callable[[int], bool]) -> list[float | None]:
    times: list[float | None] = []
    for number in range(many):
        begun = time.perf_counter()
        times.append(time.perf_counter() - begun if done(number) else None)
    return times


def answer(feedback: int) -> None:
    """Serve calls and goals as the robot until the standard input ends."""
    with closing(open_dds(Interfaces.of(DISTRO))) as node:
        from_ll = node.serve("/fromLL", FROM_LL)
        send = node.serve("/navigate/_action/send_goal", f"{NAVIGATE}_SendGoal")
        result = node.serve("/navigate/_action/get_result", f"{NAVIGATE}_GetResult")
        node.serve("/navigate/_action/cancel_goal", "action_msgs/srv/CancelGoal")
        progress = node.publish("/navigate/_action/feedback", f"{NAVIGATE}_FeedbackMessage")
        status = node.publish("/navigate/_action/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS)
        running: dict[bytes, object] = {}
        while not select.select([sys.stdin], [], [], LOOK_S)[0]:
            for asked, request in from_ll.requests():
                place = {"x": value_at(request, "ll_point.latitude"), "y": value_at(request, "ll_point.longitude")}
                from_ll.reply(asked, {"map_point": place})
            for asked, request in send.requests():
                goal_id = value_at(request, "goal_id.uuid")
                running[goal_id] = value_at(request, "goal.pose.pose.position.x")
                send.reply(asked, {"accepted": True})
                status.send(_status(goal_id, EXECUTING))
                for left in range(feedback, 0, -1):
                    progress.send({"goal_id": {"uuid": goal_id}, "feedback": {"distance_remaining": left}})
                status.send(_status(goal_id, SUCCEEDED))
            for asked, request in result.requests():
                known = running.pop(value_at(request, "goal_id.uuid"), None) is not None
                result.reply(asked, {"status": SUCCEEDED if known else 0})


def _caller(node: DdsTransport) -> Callable[[int], bool]:
    client = node.client("/fromLL", FROM_LL)
    _until(lambda: client.servers() == 1)

    def call(number: int) -> bool:
        asked = client.ask({"ll_point": {"latitude": number, "longitude": -number}})
        replies = _until(client.replies)
        return replies == ((asked, {"map_point": {"x": float(number), "y": float(-number), "z": 0.0}}),)

    return call


def _goal_sender(node: DdsTransport) -> Callable[[int], bool]:
    client = ActionClient(node, "/navigate", NAVIGATE, steady=time.monotonic, accept_s=LIMIT_S, quiet_s=LIMIT_S)
    _until(lambda: client.servers() == 1)

    def send(number: int) -> bool:
        client.start({"pose": {"header": {"frame_id": "map"}, "pose": {"position": {"x": number}}}})
        outcome = _until(client.step)
        return outcome is not None and outcome.how == "succeeded"

    return send


def _status(goal_id: object, code: int) -> RosMessage:
    return {"status_list": [{"goal_info": {"goal_id": {"uuid": goal_id}}, "status": code}]}


def _until(seen: Callable[[], _Seen]) -> _Seen | None:
    end = time.perf_counter() + LIMIT_S
    while time.perf_counter() < end:
        if found := seen():
            return found
        time.sleep(LOOK_S)
    return None


def _print_times(what: str, times: list[float | None]) -> None:
    took = [t for t in times if t is not None]
    lost, ordered = len(times) - len(took), sorted(took) or [float("nan")]
    figures = (statistics.median(ordered), ordered[int(0.99 * (len(ordered) - 1))], ordered[-1])
    median, most, last = (1000 * s for s in figures)
    print(
        f"{len(took)} {what}, {lost} lost: median {median:.1f} ms, 99 % within {most:.1f} ms, all within {last:.1f} ms"
    )


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--calls", type=int, default=1000)
    parser.add_argument("--goals", type=int, default=200)
    parser.add_argument("--feedback", type=int, default=5, help="messages of feedback of each goal")
    parser.add_argument("--domain", type=int, default=99, help="ROS_DOMAIN_ID of both processes")
    parser.add_argument("--answer", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
