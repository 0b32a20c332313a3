"""A robot on ROS 2 as ROS's own tutorials make one: rclpy's action server and executor, and nothing of ours.

    . /opt/ros/jazzy/setup.bash
    python tests/ros2/rclpy_robot.py --lat 37.0 --lon -120.0 --speed 20

It serves what ``standard_husky`` in ``sourced.py`` binds: Nav2's NavigateToPose (a newer goal pre-empts the one before,
as Nav2 has it), ``fromLL``, fix, odometry, battery, emergency stop, a camera that is triggered, air and CO2. Its map
begins where it stands. It prints one JSON object a line: that it is ready, and each goal that has ended.
"""

from __future__ import annotations

import argparse
import json
import math
import threading
import time
from contextlib import suppress

import rclpy
from geometry_msgs.msg import Point
from nav2_msgs.action import NavigateToPose
from nav2_msgs.msg import SpeedLimit
from nav_msgs.msg import Odometry
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_localization.srv import FromLL
from sensor_msgs.msg import BatteryState, NavSatFix, NavSatStatus, Temperature
from std_msgs.msg import Bool, Float64
from std_srvs.srv import Trigger

RATE_S = 0.05
#: Of WGS 84: half the longer axis, and the square of the eccentricity.
AXIS_M, ECCENTRICITY_2 = 6378137.0, 0.00669437999014


class Robot(Node):
    """Drives in straight lines at one speed."""

    def __init__(self, lat: float, lon: float, speed: float, abort: int) -> None:
        super().__init__("robot")
        self._lat, self._lon, self._speed, self._abort = lat, lon, speed, abort
        sine = math.sin(math.radians(lat))
        across = AXIS_M / math.sqrt(1 - ECCENTRICITY_2 * sine**2)
        self._north_m = math.radians(across * (1 - ECCENTRICITY_2) / (1 - ECCENTRICITY_2 * sine**2))
        self._east_m = math.radians(across * math.cos(math.radians(lat)))
        self._x = self._y = 0.0
        self._charge = 1.0
        self._guard, self._latest, self._goals = threading.Lock(), None, 0
        group = ReentrantCallbackGroup()
        self._server = ActionServer(
            self,
            NavigateToPose,
            "navigate_to_pose",
            self._drive,
            goal_callback=lambda goal: (
                GoalResponse.ACCEPT if goal.pose.header.frame_id == "map" else GoalResponse.REJECT
            ),
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=group,
        )
        self.create_service(FromLL, "fromLL", self._from_ll, callback_group=group)
        self.create_service(Trigger, "thermal_camera/trigger", self._trigger, callback_group=group)
        self.create_subscription(SpeedLimit, "speed_limit", lambda _: None, 10)
        self._fix = self.create_publisher(NavSatFix, "gps/fix", qos_profile_sensor_data)
        self._odometry = self.create_publisher(Odometry, "odometry/filtered", 10)
        self._battery = self.create_publisher(BatteryState, "battery_state", 10)
        self._stop = self.create_publisher(Bool, "platform/emergency_stop", 10)
        self._canopy = self.create_publisher(Temperature, "thermal_camera/mean", 10)
        self._air = self.create_publisher(Temperature, "air_temperature", qos_profile_sensor_data)
        self._co2 = self.create_publisher(Float64, "co2", qos_profile_sensor_data)
        self.create_timer(RATE_S, self._tell, callback_group=group)

    def _drive(self, handle):  # type: ignore[no-untyped-def]
        with self._guard:
            self._latest, self._goals = handle, self._goals + 1
            number = self._goals
        end = handle.request.pose.pose.position
        while (left := math.hypot(end.x - self._x, end.y - self._y)) > 1e-3:
            if handle.is_cancel_requested:
                handle.canceled()
                return self._ended("canceled")
            if self._latest is not handle or number == self._abort:
                handle.abort()
                return self._ended("aborted")
            time.sleep(RATE_S)
            part = min(1.0, self._speed * RATE_S / left)
            self._x += part * (end.x - self._x)
            self._y += part * (end.y - self._y)
            self._charge -= 1e-4 * part * left
            feedback = NavigateToPose.Feedback(distance_remaining=left * (1 - part))
            handle.publish_feedback(feedback)
        handle.succeed()
        return self._ended("succeeded")

    def _ended(self, how: str) -> NavigateToPose.Result:
        print(json.dumps({"event": "goal", "end": how, "x": self._x, "y": self._y}), flush=True)
        return NavigateToPose.Result()

    def _from_ll(self, request, response):  # type: ignore[no-untyped-def]
        north = (request.ll_point.latitude - self._lat) * self._north_m
        response.map_point = Point(x=(request.ll_point.longitude - self._lon) * self._east_m, y=north, z=0.0)
        return response

    def _trigger(self, _, response):  # type: ignore[no-untyped-def]
        response.success = True
        return response

    def _tell(self) -> None:
        now = self.get_clock().now().to_msg()
        fix = NavSatFix(latitude=self._lat + self._y / self._north_m, longitude=self._lon + self._x / self._east_m)
        fix.header.stamp, fix.status.status = now, NavSatStatus.STATUS_GBAS_FIX
        fix.position_covariance[0] = fix.position_covariance[4] = 1e-4
        fix.position_covariance_type = NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN
        self._fix.publish(fix)
        odometry = Odometry()
        odometry.header.stamp, odometry.header.frame_id = now, "odom"
        odometry.pose.pose.position.x, odometry.pose.pose.position.y = self._x, self._y
        self._odometry.publish(odometry)
        self._battery.publish(BatteryState(percentage=self._charge, present=True))
        self._stop.publish(Bool(data=False))
        self._canopy.publish(Temperature(temperature=31.5))
        self._air.publish(Temperature(temperature=24.25))
        self._co2.publish(Float64(data=405.0))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lat", type=float, required=True, help="where it stands, in degrees")
    parser.add_argument("--lon", type=float, required=True)
    parser.add_argument("--speed", type=float, default=1.0, help="metres in a second")
    parser.add_argument("--abort", type=int, default=0, help="which goal it gives up, counted from 1")
    given = parser.parse_args()
    rclpy.init()
    robot = Robot(given.lat, given.lon, given.speed, given.abort)
    executor = MultiThreadedExecutor(8)
    executor.add_node(robot)
    print(json.dumps({"event": "ready", "rmw": rclpy.get_rmw_implementation_identifier()}), flush=True)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()


if __name__ == "__main__":
    main()
