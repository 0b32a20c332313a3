"""A robot in a process of its own, as little of one as transports need: it answers, sends, and says what it hears.

    other_end.py TRANSPORT

Ends when its standard input does.
"""

from __future__ import annotations

import select
import sys

from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.rclpy import open_rclpy
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, STATUS_QOS, QosProfile, Transport

#: Services that every ROS with Nav2 has: one that computes, one whose request is deep, with an array of bytes.
TO_MAP, SEND = "robot_localization/srv/FromLL", "nav2_msgs/action/NavigateToPose_SendGoal"
DISTRO = "humble"


def opened(transport: str) -> Transport:
    """A node of the graph."""
    return open_rclpy() if transport == "rclpy" else open_dds(Interfaces.of(DISTRO))


def main() -> None:
    node = opened(sys.argv[1])
    to_map, send = node.serve("/to_map", TO_MAP), node.serve("/send", SEND)
    nothing = node.serve("/nothing", "std_srvs/srv/Empty")
    node.publish("/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS).send({"status_list": [{"status": 4}]})
    node.publish("/best_effort", "std_msgs/msg/String", SENSOR_QOS)
    node.publish("/number", "std_msgs/msg/Int32")
    echoes = [
        (node.subscribe(f"/say_{name}", kind, QosProfile()), node.publish(f"/echo_{name}", kind))
        for name, kind in (("text", "std_msgs/msg/String"), ("fix", "sensor_msgs/msg/NavSatFix"))
    ]
    print("ready", flush=True)
    while not select.select([sys.stdin], [], [], 0.002)[0]:
        for asked, request in to_map.requests():
            point = request["ll_point"]
            to_map.reply(asked, {"map_point": {"x": point["latitude"] + point["longitude"], "z": point["altitude"]}})  # type: ignore[index]
        for asked, request in send.requests():
            goal_id = request["goal_id"]["uuid"]  # type: ignore[index]
            accepted = request["goal"]["behavior_tree"] == "ü"  # type: ignore[index]
            send.reply(asked, {"accepted": accepted, "stamp": {"sec": sum(goal_id)}})
        for asked, _ in nothing.requests():
            nothing.reply(asked, {})
        for heard, echo in echoes:
            for message in heard.take():
                echo.send(message)
    node.close()


if __name__ == "__main__":
    main()
