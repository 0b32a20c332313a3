"""The end of a drive, from the outcome of a goal of Nav2."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fieldhand.execution.drivers.protocol import GoalFault
from fieldhand.execution.drivers.ros2.action_outcome import ActionOutcome, GoalEnd
from fieldhand.execution.drivers.ros2.nav2_codes import CODES, MISSED_WAYPOINT, OCCUPIED_GOAL
from fieldhand.execution.drivers.ros2.transport import RosMessage
from fieldhand.execution.robot_text import robot_text
from fieldhand.robot.bindings import NavigationBinding


def ended_without_code(outcome: ActionOutcome) -> bool:
    """Return True if Nav2 aborted the goal and gave no reason."""
    return outcome.how == "aborted" and not _code(outcome.result) and not outcome.result.get("missed_waypoints")


def end_of(
    outcome: ActionOutcome, binding: NavigationBinding, *, cancelled: bool, has_codes: bool, near: bool = False
) -> GoalEnd:
    """Return the end of a drive from the outcome of a Nav2 goal.

    Args:
        cancelled: True if cancellation was requested.
        has_codes: True if the robot's release gives a code with every failure.
        near: True if the robot came near the end of the whole drive.
    """
    missed = outcome.result.get("missed_waypoints")
    if outcome.how == "succeeded" and not (isinstance(missed, Sequence) and missed):
        return GoalEnd(state="succeeded")
    if outcome.moving:
        advice = "check whether Nav2 runs on the robot; if it drives still, use its emergency stop"
        return GoalEnd(state="failed", fault="failed", what=f"{outcome.what}; {advice}")
    if cancelled and outcome.how != "succeeded":
        return GoalEnd(state="cancelled")
    if outcome.how in ("succeeded", "aborted"):
        if ended_without_code(outcome) and has_codes and binding.without_code is None:
            return GoalEnd(state="failed", fault="interrupted", what="navigation ended the drive without an error code")
        return _failed(outcome.result, binding, near=near)
    if outcome.how == "cancelled" and not outcome.what:
        return GoalEnd(state="failed", fault="interrupted", what="another client cancelled the drive")
    advice = "; check whether Nav2 is active on the robot" if outcome.how in ("rejected", "untold") else ""
    return GoalEnd(state="failed", fault="failed", what=f"{outcome.what}{advice}")


def _failed(result: RosMessage, binding: NavigationBinding, *, near: bool) -> GoalEnd:
    """Return a failure described by the error code of Nav2, if it has one."""
    code, words = _code(result), _message_of_nav2(result)
    fault: GoalFault
    if code == 0 or (code == MISSED_WAYPOINT and code not in binding.codes):
        meaning, fault = "navigation failed without an error code", binding.without_code or "blocked"
        meaning = "navigation missed a waypoint" if result.get("missed_waypoints") else meaning
    else:
        meaning, known = CODES.get(code, ("navigation failed", "failed"))
        fault = binding.codes.get(code, "occupied" if near and code in OCCUPIED_GOAL else known)
        meaning = f"{meaning} (code {code} of Nav2)"
    return GoalEnd(state="failed", fault=fault, what=f"{meaning}: {words}" if words else meaning)


def _code(result: RosMessage) -> int:
    """Return the error code; that of the first missed waypoint is more specific than the overall code."""
    missed = result.get("missed_waypoints")
    for entry in missed if isinstance(missed, Sequence) else ():
        if isinstance(entry, Mapping) and isinstance(code := entry.get("error_code"), int) and code:
            return code
    code = result.get("error_code")
    return code if isinstance(code, int) else 0


def _message_of_nav2(result: RosMessage) -> str:
    text = result.get("error_msg")
    return robot_text(text.strip()) if isinstance(text, str) else ""
