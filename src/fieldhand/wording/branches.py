"""Text of branches: the outcome of each condition, with the id of its node."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

from fieldhand.forecast.branch_estimate import BranchEstimate
from fieldhand.forecast.walk_steps import Decision
from fieldhand.language import joined, message
from fieldhand.language.words import listed, say_action, say_times
from fieldhand.robot.model import RobotProfile
from fieldhand.task import plan
from fieldhand.task.frames import Fault, Task
from fieldhand.wording.conditions import say_condition

FAULTS: dict[Fault, str] = {
    "action_failed": message("an action fails for good"),
    "drive_failed": message("a way cannot be driven"),
    "low_budget": message("what is left is only just enough for the way home"),
    "aborted": message("someone aborts the mission"),
}

#: Maximum number of decisions described for a branch.
_MOST = 6


def say_branch(branch: BranchEstimate, task: Task, robot: RobotProfile) -> str:
    """Return a branch in one line: "the canopy temperature is below 33 °C (n4): 3 times yes, once no"."""
    text = say_decisions(branch.decisions, task, robot)
    if branch.fault is None:
        return text or message("the only one")
    last = branch.walk.steps[-1].node.id
    fault = message("{fault} ({node})", fault=FAULTS[branch.fault], node=last)
    return message("{clause}; {other}", clause=text, other=fault) if text else fault


def say_decisions(decisions: Sequence[Decision], task: Task, robot: RobotProfile) -> str:
    """Return the decisions of a branch, node by node, or an empty string if there are none."""
    answers: dict[tuple[str, str], list[Decision]] = {}
    for decision in decisions:
        answers.setdefault((decision.node, decision.kind), []).append(decision)
    nodes = {node.id: node for node in plan.walk(task.composition.plan)}
    # Actions that never failed are not mentioned.
    decided = {
        key: some for key, some in answers.items() if key[1] in ("holds", "taken") or any(d.answer for d in some)
    }
    taken = {node.reading: message("of {node}", node=node.id) for node in reversed(nodes.values()) if node.reading}
    parts = [
        _say_answers(kind, nodes[node], some, taken, robot) for (node, kind), some in list(decided.items())[:_MOST]
    ]
    if len(decided) > _MOST:
        parts.append(message("and {count} more", count=len(decided) - _MOST))
    return joined("; ", parts) if parts else ""


def _say_answers(
    kind: str, node: plan.Node, answers: Sequence[Decision], taken: Mapping[str, str], robot: RobotProfile
) -> str:
    match kind:
        case "holds":
            condition = node.tested
            assert condition is not None  # noqa: S101  only conditions hold
            what = say_condition(condition, taken, robot)
        case "fails":
            assert node.act is not None  # noqa: S101  only actions fail
            what = message("“{action}” fails", action=say_action(node.act.action))
        case "blocked":
            what = message("the way there is blocked")
        case _:
            what = message("an optional step is done")
    return message("{what} ({node}): {answers}", what=what, node=node.id, answers=_answers(answers))


def _answers(decisions: Sequence[Decision]) -> str:
    yes, no = ([d for d in decisions if d.answer is answer] for answer in (True, False))
    if yes and no:
        return listed([_times(yes, "yes", places=len(yes) <= len(no)), _times(no, "no", places=len(no) < len(yes))])
    if len(decisions) == 1:
        return message("yes") if yes else message("no")
    return _times(decisions, "yes" if yes else "no", places=False)


def _times(decisions: Sequence[Decision], answer: Literal["yes", "no"], *, places: bool) -> str:
    """Return the number of times, and the places if these distinguish the branch from others."""
    times = say_times(len(decisions))
    text = message("{times} yes", times=times) if answer == "yes" else message("{times} no", times=times)
    where = ", ".join(dict.fromkeys(d.place for d in decisions))
    if not places or not where or len(decisions) > _MOST:
        return text
    return message("{what} (at {places})", what=text, places=where)
