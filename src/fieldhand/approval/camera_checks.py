"""Checks of cameras: every plant of which a picture is taken is in view where the robot stands."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.approval.problem import PlanProblem
from fieldhand.forecast.estimate import Estimate
from fieldhand.language import message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place
from fieldhand.task.plan import Act
from fieldhand.wording.cameras import say_view
from fieldhand.wording.steps import say_place


def camera_problems(robot: RobotProfile, forecast: Estimate) -> Iterator[PlanProblem]:
    """Yield a warning for each action whose camera does not see a plant from the stand, on any branch."""
    unseen: dict[str, tuple[Act, dict[tuple[str, str, str], Place]]] = {}
    for step in (step for branch in forecast.branches for step in branch.walk.steps):
        if step.sees is False and step.node.act is not None:
            _, places = unseen.setdefault(step.node.id, (step.node.act, {}))
            places[step.places[0].key] = step.places[0]
    for node, (act, places) in unseen.items():
        camera = robot.action[act.action].camera
        if camera is None:  # pragma: no cover  only actions with one see
            continue
        first, *others = places.values()
        view = say_view(camera)
        if others:
            what = message(
                "the camera of {action} looks {view} and does not see {place}, nor {count} more, from where the robot"
                " stands",
                action=act.action,
                view=view,
                place=say_place(first),
                count=len(others),
            )
        else:
            what = message(
                "the camera of {action} looks {view} and does not see {place} from where the robot stands",
                action=act.action,
                view=view,
                place=say_place(first),
            )
        if robot.turn_deg_s is None:
            advice = message("if the robot can turn on the spot, give turn_deg_s in its profile; else leave them out")
        else:
            advice = message("correct side and view_deg of the camera in the profile, or leave them out")
        yield PlanProblem(node=node, where=message("plan"), what=what, advice=advice, severity="warning")
