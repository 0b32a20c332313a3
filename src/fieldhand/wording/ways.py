"""Word what a mission keeps away from, where it drives slowly, and which gates it may use."""

from __future__ import annotations

from fieldhand.forecast.closed_ground import say_avoidance
from fieldhand.forecast.slow_ground import say_slow_ground, slow_speed
from fieldhand.language import message
from fieldhand.language.words import listed, say_gate, say_number
from fieldhand.robot.bindings import EXACT_TYPES
from fieldhand.robot.model import RobotProfile
from fieldhand.task.frames import Constraints
from fieldhand.task.ways import Avoid


def say_ways(constraints: Constraints, robot: RobotProfile | None = None) -> tuple[str, ...]:
    """Return a sentence for each place that the mission keeps away from or drives slowly at, and one for its gates."""
    found: list[str] = []
    for avoid in constraints.avoid:
        rule = say_avoidance(avoid)
        if _is_beside_trees(avoid):
            found.append(message("the robot must {rule} (the aisles on both sides).", rule=rule))
        else:
            found.append(message("the robot must {rule}.", rule=rule))
    if constraints.only_gates:
        gates = listed(tuple(say_gate(only.gate) for only in constraints.only_gates))
        found.append(message("of the gates, the robot passes only {gates}.", gates=gates))
    for slow in constraints.slow:
        if robot is None and slow.speed_m_s is None:
            found.append(message("slowly {where}.", where=say_slow_ground(slow)))
            continue
        speed = (slow.speed_m_s or 0.0) if robot is None else slow_speed(slow.speed_m_s, robot)
        found.append(message("at most {speed} m/s {where}.", speed=say_number(speed, 3), where=say_slow_ground(slow)))
    return tuple(found)


def way_notes(constraints: Constraints, robot: RobotProfile) -> tuple[str, ...]:
    """Return what has to be known about a robot that plans its own way between the corners of a path."""
    if robot.ros2 is None or not (constraints.avoid or constraints.only_gates):
        return ()
    if robot.ros2.navigation.type in EXACT_TYPES:
        return ()  # it follows the path itself
    return (
        message(
            "Over ROS 2 the robot is sent from corner to corner of the path shown. Between them Nav2 plans the way, so"
            " it keeps to these rules only as far as the path does."
        ),
    )


def _is_beside_trees(avoid: Avoid) -> bool:
    """Return True if the robot keeps out of the aisles beside trees, not out of a zone or away from a place."""
    return not avoid.distance_m and not avoid.places.whole_zone
