"""Numbers of captures beside the steps of a request ("six samples in total"), and wishes for what is reported."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.grammar.dialogue.plans import as_for_each
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, Setting, Spans, with_assumption
from fieldhand.planning.grammar.meaning import Reported, Total, wait_seconds
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.task import plan as p


def with_total(setting: Setting, state: DialogueState, command: Total) -> DialogueState:
    """Return the state after a number of captures that agrees with the plan.

    Raises:
        NotComposed: It does not agree, or the number is not known before the mission.
    """
    if _number(setting, state.plan, command.action) != command.count:
        raise NotComposed(message("it gives two different numbers", context="fault"))
    last, said = state.plan.steps[-1], setting.spans_of(command.used)
    return replace(state, plan=replace(state.plan, steps=(*state.plan.steps[:-1], _also_said(last, said))))


def reported(setting: Setting, state: DialogueState, command: Reported) -> DialogueState:
    """Return the state after a wish to be told what the report says anyway.

    Raises:
        NotComposed: It depends on something, or nothing was read.
    """
    if state.open or not state.plan.steps:
        raise NotComposed(message("only after the mission does its report say this", context="fault"))
    said = setting.spans_of(command.used)
    sentence = message(
        "'{said}': the report lists each reading, and the lowest, mean, median and highest of all.",
        context="assumption",
        said=setting.quoted(command.used).rstrip(" .?"),
    )
    steps = state.plan.steps
    plan = replace(state.plan, steps=(*steps[:-1], _also_said(steps[-1], said)))
    return with_assumption(replace(state, plan=plan, asked_for=command.of), sentence)


def _also_said(step: p.Node, said: Spans) -> p.Node:
    """Return a step that further words say."""
    return replace(step, said=(*step.said, *said)) if step.act is None else replace(step.act, said=(*step.said, *said))


def _number(setting: Setting, node: p.Node, action: str) -> int | None:
    """Return the number of captures by an action, or by any; None if it depends on what the robot finds."""
    if node.act is not None and wait_seconds(node.act.action) is not None:
        return 0
    if node.act is not None:
        return node.act.count if action in ("", node.act.action) else 0
    inner = [_number(setting, child, action) for child in node.children]
    numbers = [one for one in inner if one is not None]
    if len(numbers) < len(inner) or not any(numbers):
        return None if len(numbers) < len(inner) else 0
    loop = as_for_each(node)
    if loop is not None:
        ids = ids_of(loop.select, setting.site)
        fixed = not loop.optional and loop.at_most is None and loop.until is None
        return len(ids) * sum(numbers) if ids and fixed else None
    if node.is_series:
        return sum(numbers)
    rounds = getattr(node, "times", None) if getattr(node, "until", None) is None else None
    return None if rounds is None else rounds * sum(numbers)
