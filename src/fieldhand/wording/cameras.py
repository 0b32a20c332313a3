"""Word how a robot stands for its cameras."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from fieldhand.forecast.walk_steps import Walk
from fieldhand.language import counted, message
from fieldhand.language.words import capitalised, say_action
from fieldhand.robot.camera import Camera, CameraSide
from fieldhand.robot.model import RobotProfile

_VIEWS: dict[CameraSide, str] = {
    "left": message("to the left"),
    "right": message("to the right"),
    "front": message("ahead"),
    "back": message("backwards"),
}
_PLACES: dict[CameraSide, str] = {
    "left": message("on its left"),
    "right": message("on its right"),
    "front": message("in front of it"),
    "back": message("behind it"),
}


def say_view(camera: Camera) -> str:
    """Return where a camera looks: "to the right"."""
    return _VIEWS[camera.side]


def camera_notes(walks: Iterable[Walk], robot: RobotProfile) -> tuple[str, ...]:
    """Return a sentence for each action with a camera: on which side of the robot the plants are, and why they are."""
    most: dict[str, int] = {}
    for walked in walks:
        acts = Counter(step.node.act.action for step in walked.steps if step.sees and step.node.act is not None)
        most |= {name: max(most.get(name, 0), stops) for name, stops in acts.items()}
    return tuple(_say(name, robot, stops) for name, stops in most.items())


def _say(name: str, robot: RobotProfile, stops: int) -> str:
    camera = robot.action[name].camera
    side = _PLACES["front" if camera is None else camera.side]
    action = capitalised(say_action(name))
    if robot.turn_deg_s is not None:
        return counted(
            "{action}: at {count} stop the robot stands with the plant {side}; it turns on the spot where it must.",
            "{action}: at {count} stops the robot stands with the plant {side}; it turns on the spot where it must.",
            stops,
            action=action,
            side=side,
        )
    return counted(
        "{action}: at {count} stop the robot comes in so that the plant is {side}.",
        "{action}: at {count} stops the robot comes in so that the plant is {side}.",
        stops,
        action=action,
        side=side,
    )
