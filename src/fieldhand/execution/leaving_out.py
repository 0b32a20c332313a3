"""Steps of a plan that can be left out because something stands where the robot would stand."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.task.plan import Node
from fieldhand.task.run import PlanRun


def can_leave_out(run: PlanRun) -> bool:
    """Return True if the current step can be left out: there is other work later, and it does not depend on the step.

    A step depends on another if it is done where that leaves the robot. A step of a loop is not left out.
    """
    around = run.frames[:-1]
    if run.is_caught or not all(frame.node.is_series for frame in around):
        return False
    later = [step for frame in reversed(around) for step in frame.left]
    return bool(later) and _stand_alone(later)


def _stand_alone(steps: Sequence[Node]) -> bool:
    """Return True if steps are done in the same places wherever the robot is before."""
    for step in steps:
        if step.ends_plan:
            return True
        if step.selector is not None:
            return not step.selector.relative
        if not step.children or not all(_stand_alone((child,)) for child in step.children):
            return False
    return True
