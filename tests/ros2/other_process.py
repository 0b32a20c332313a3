"""A robot in a process of its own, as little of one as transports need: it answers, sends, and says what it hears.

Ends when its standard input does.
"""

from __future__ import annotations

import select
import sys

from fieldhand.execution.drivers.ros2.dds import open_dds
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, STATUS_QOS, QosProfile

SUM = {"test_msgs/srv/Sum": "float64[] terms\nuint8[4] mark\n---\nfloat64 sum\nuint8[4] mark\n"}


def main() -> None:
    node = open_dds(Interfaces.of("jazzy", SUM))
    sums = node.serve("/sum", "test_msgs/srv/Sum")
    nothing = node.serve("/nothing", "std_srvs/srv/Empty")
    node.publish("/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS).send({"status_list": [{"status": 4}]})
    node.publish("/best_effort", "std_msgs/msg/String", SENSOR_QOS)
    node.publish("/number", "std_msgs/msg/Int32")
    heard = node.subscribe("/say", "std_msgs/msg/String", QosProfile(depth=1000))
    echo = node.publish("/echo", "std_msgs/msg/String", QosProfile(depth=1000))
    print("ready", flush=True)
    while not select.select([sys.stdin], [], [], 0.002)[0]:
        for asked, request in sums.requests():
            terms = request["terms"]
            assert isinstance(terms, tuple)
            sums.reply(asked, {"sum": sum(terms), "mark": request["mark"]})
        for asked, _ in nothing.requests():
            nothing.reply(asked, {})
        for message in heard.take():
            echo.send(message)
    node.close()


if __name__ == "__main__":
    main()
