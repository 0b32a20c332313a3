"""Branches in words: which conditions went which way, with the nodes that they stand in."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.approval.clauses import say_condition
from fieldhand.forecast.figures import BranchEstimate
from fieldhand.forecast.steps import Decision
from fieldhand.language import joined, message, named
from fieldhand.robot.model import RobotProfile
from fieldhand.task import plan
from fieldhand.task.frames import Task
from fieldhand.task.words import listed, say_action, say_times

#: A branch that has more to say is cut there.
_MOST = 6


def say_branch(branch: BranchEstimate, task: Task, robot: RobotProfile) -> str:
    """Which way a branch goes, in one line: "the canopy temperature is below 33 °C (n4): 3 times yes, once no"."""
    said = say_decisions(branch.decisions, task, robot)
    if branch.fault is None:
        return said or message("the only one")
    last = branch.walk.steps[-1].node.id
    fault = message("{fault} ({node})", fault=named(branch.fault, "fault"), node=last)
    return message("{clause}; {other}", clause=said, other=fault) if said else fault


def say_decisions(decisions: Sequence[Decision], task: Task, robot: RobotProfile) -> str:
    """What was decided, node by node; empty where nothing was."""
    answers: dict[tuple[str, str], list[bool]] = {}
    for decision in decisions:
        answers.setdefault((decision.node, decision.kind), []).append(decision.answer)
    nodes = {node.id: node for node in plan.walk(task.composition.plan)}
    # What did not fail needs no word.
    told = {key: some for key, some in answers.items() if key[1] in ("holds", "taken") or any(some)}
    said = [_said(kind, nodes[node], some, robot) for (node, kind), some in list(told.items())[:_MOST]]
    if len(told) > _MOST:
        said.append(message("and {count} more", count=len(told) - _MOST))
    return joined("; ", said) if said else ""


def _said(kind: str, node: plan.Node, answers: Sequence[bool], robot: RobotProfile) -> str:
    match kind:
        case "holds":
            condition = plan.condition_of(node)
            assert condition is not None  # noqa: S101  only conditions hold
            what = say_condition(condition, robot=robot)
        case "fails":
            assert isinstance(node, plan.Act)  # noqa: S101  only actions fail
            what = message("“{action}” fails", action=say_action(node.action))
        case "blocked":
            what = message("the way there is blocked")
        case _:
            what = message("what the budget decides on is done")
    return message("{what} ({node}): {answers}", what=what, node=node.id, answers=_answers(answers))


def _answers(answers: Sequence[bool]) -> str:
    yes, no = sum(answers), len(answers) - sum(answers)
    if yes and no:
        return listed([message("{times} yes", times=say_times(yes)), message("{times} no", times=say_times(no))])
    if len(answers) == 1:
        return message("yes") if yes else message("no")
    times = say_times(len(answers))
    return message("{times} yes", times=times) if yes else message("{times} no", times=times)
