"""A Task's plan as a behavior tree: every node becomes a behavior that is named by the node's id and what it does."""

from __future__ import annotations

from typing import assert_never

from py_trees.behaviour import Behaviour

from fieldhand.execution.attempt import Attempt
from fieldhand.execution.behaviors.choices import ChooseBranch, DoInBestOrder, DoInOrder, TryElse
from fieldhand.execution.behaviors.leaves import DoAction, EndMission, GoToPlace
from fieldhand.execution.behaviors.loops import ForEachPlace, RepeatBody
from fieldhand.execution.behaviors.shedding import DoIfItFits
from fieldhand.task.frames import Task
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, Node, Optional, Repeat, Sequence, Stop, Try
from fieldhand.task.selectors import Selector
from fieldhand.task.words import say_action, say_times


def compile_tree(task: Task, attempt: Attempt) -> Behaviour:
    """The behavior tree of a Task.

    Args:
        task: What is to be done.
        attempt: The state that the behaviors share. A tree serves one attempt.

    Returns:
        The root. Tick it until it succeeds or fails, or until the attempt has an ending.
    """
    return _compile(task.composition.plan, attempt)


def _compile(node: Node, attempt: Attempt) -> Behaviour:
    name = f"{node.id} {say_node(node)}"
    match node:
        case Sequence(steps=steps):
            return DoInOrder(name, node, [_compile(s, attempt) for s in steps])
        case AnyOrder(steps=steps):
            return DoInBestOrder(name, node, attempt, [_compile(s, attempt) for s in steps])
        case ForEach(body=body):
            return ForEachPlace(name, node, attempt, _compile(body, attempt))
        case Repeat(body=body):
            return RepeatBody(name, node, attempt, _compile(body, attempt))
        case If(then=then, otherwise=otherwise):
            branches = [then] if otherwise is None else [then, otherwise]
            return ChooseBranch(name, node, attempt, [_compile(b, attempt) for b in branches])
        case Try(body=body, otherwise=otherwise):
            return TryElse(name, node, _compile(body, attempt), _compile(otherwise, attempt))
        case Optional(body=body):
            return DoIfItFits(name, node, attempt, _compile(body, attempt))
        case GoTo():
            return GoToPlace(name, node, attempt)
        case Act():
            return DoAction(name, node, attempt)
        case Stop():
            return EndMission(name, node, attempt)
        case _:
            assert_never(node)


def say_node(node: Node) -> str:
    """What a node does, in a few words; a place by the kind of its selector."""
    match node:
        case Sequence():
            return "in order"
        case AnyOrder():
            return "in the best order"
        case ForEach(select=select, optional=optional):
            return f"{'as many as fit of' if optional else 'at each of'} {_say_selector(select)}"
        case Repeat(times=times):
            return f"{'until it holds, at most ' if node.until else ''}{say_times(times)}"
        case If():
            return "if"
        case Try():
            return "try"
        case Optional():
            return "if the budget allows"
        case GoTo(place=place):
            return f"go to {_say_selector(place)}"
        case Act(at=at):
            there = "" if at is None else f" at {_say_selector(at)}"
            return f"{say_action(node.action, node.count)}{there}"
        case Stop(exit=leave):
            return f"stop ({leave} exit)"
        case _:
            assert_never(node)


def _say_selector(selector: Selector) -> str:
    from fieldhand.site.places.words import say_selector

    return say_selector(selector)
