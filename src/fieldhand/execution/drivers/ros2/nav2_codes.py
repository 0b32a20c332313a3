"""Error codes of Nav2 and the faults they mean.

From Iron on, the result of a navigation action carries the code of the server that failed. Each server has a range of a
hundred codes: controller 100, planner 200, planner through poses 300, route 400, smoother 500, waypoints 600, behaviors
700, the navigator itself 9000 and 9100 (Kilted). Taken from the constants of nav2_msgs/action/*.action on the branches
iron, jazzy, kilted and main of github.com/ros-navigation/navigation2. Humble reports no codes.
"""

from __future__ import annotations

from collections.abc import Mapping

from fieldhand.robot.bindings import NavigationFault

_NO_TRANSFORM = "the robot's pose in its map is not known (no transform)"
_COLLISION = "a recovery stopped to avoid a collision"
_PLANNER: Mapping[int, tuple[str, NavigationFault]] = {
    0: ("the planner failed", "failed"),
    1: ("the planner that is configured does not exist", "failed"),
    2: (_NO_TRANSFORM, "lost"),
    3: ("the robot stands outside of its map", "failed"),
    4: ("the goal lies outside of its map", "failed"),
    5: ("the robot stands in an obstacle of its map", "blocked"),
    6: ("the goal lies in an obstacle", "blocked"),
    7: ("the planner took too long", "failed"),
    8: ("no way to the goal was found", "blocked"),
    9: ("the planner was given no poses", "failed"),
}
_NAVIGATOR: Mapping[int, tuple[str, NavigationFault]] = {
    0: ("the navigator failed", "failed"),
    1: ("its behavior tree could not be loaded", "failed"),
    2: (_NO_TRANSFORM, "lost"),
    3: ("the navigator took too long", "failed"),
}

#: Description and kind of fault of each code.
CODES: Mapping[int, tuple[str, NavigationFault]] = {
    100: ("the controller failed", "failed"),
    101: ("the controller that is configured does not exist", "failed"),
    102: (_NO_TRANSFORM, "lost"),
    103: ("the controller cannot use the path", "failed"),
    104: ("the controller found no valid command for too long", "blocked"),
    105: ("the robot made no progress", "blocked"),
    106: ("the controller found no valid command", "blocked"),
    107: ("the controller took too long", "failed"),
    108: ("following the path took too long", "failed"),
    **{200 + n: meaning for n, meaning in _PLANNER.items() if n != 9},
    **{300 + n: meaning for n, meaning in _PLANNER.items()},
    400: ("the route server failed", "failed"),
    401: (_NO_TRANSFORM, "lost"),
    402: ("the route server has no valid graph", "failed"),
    403: ("robot or goal is not near a node of the route graph", "failed"),
    404: ("the route server took too long", "failed"),
    405: ("no route to the goal was found", "blocked"),
    406: ("an operation of the route failed", "failed"),
    407: ("the route server is misconfigured (edge scorers)", "failed"),
    500: ("the smoother failed", "failed"),
    501: ("the smoother that is configured does not exist", "failed"),
    502: ("the smoother took too long", "failed"),
    503: ("the smoothed path leads through an obstacle", "blocked"),
    504: ("the path could not be smoothed", "failed"),
    505: ("the smoother cannot use the path", "failed"),
    600: ("the waypoint follower failed", "failed"),
    601: ("the waypoint follower's task at a waypoint failed", "failed"),
    602: ("the waypoint follower received no valid waypoint", "failed"),
    700: ("a recovery (spin) failed", "failed"),
    701: ("a recovery (spin) took too long", "blocked"),
    702: (_NO_TRANSFORM, "lost"),
    703: (_COLLISION, "blocked"),
    710: ("a recovery (back up) failed", "failed"),
    711: ("a recovery (back up) took too long", "blocked"),
    712: (_NO_TRANSFORM, "lost"),
    713: ("a recovery (back up) received an invalid command", "failed"),
    714: (_COLLISION, "blocked"),
    720: ("a recovery (drive on heading) failed", "failed"),
    721: ("a recovery (drive on heading) took too long", "blocked"),
    722: (_NO_TRANSFORM, "lost"),
    723: (_COLLISION, "blocked"),
    724: ("a recovery (drive on heading) received an invalid command", "failed"),
    730: ("teleoperation failed", "failed"),
    731: ("teleoperation took too long", "failed"),
    732: (_NO_TRANSFORM, "lost"),
    **{base + n: meaning for base in (9000, 9100) for n, meaning in _NAVIGATOR.items()},
}

#: Only reports that a waypoint was missed; the code of the waypoint gives the cause.
MISSED_WAYPOINT = 603
#: The goal itself lies in an obstacle.
OCCUPIED_GOAL = (206, 306)
