"""Waits: as steps at a place, and before captures."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.grammar.dialogue.capturing import capture
from fieldhand.planning.grammar.dialogue.plans import block_at, walk
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    Spans,
    with_step,
)
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    UNSAID_THING,
    CaptureCommand,
    Connective,
    SettleClause,
    wait_seconds,
)
from fieldhand.task import plan as p


def waited(setting: Setting, state: DialogueState, command: CaptureCommand, joint: Connective | None) -> DialogueState:
    """Return the state after a wait, which is placed as a capture is.

    What was captured before it stays what later clauses refer to. A wait without a place behind several places may be
    at each of them or once at the end.
    """
    if any(wait_seconds(thing.action) == 0.0 for thing in command.things):
        asked = message("'{said}': for how long?", said=setting.quoted(command.used))
        raise OpenQuestion(asked, command.used)
    place = command.place
    unplaced = place is None or place.shape == "here"
    loop = state.loop if state.lead is None and state.area is None else None
    ends = joint is not None and (joint.full or joint.then)
    if unplaced and loop is not None and block_at(state.plan, loop).steps:
        each = not ends and setting.either("at each of these places, or once behind them?", command.used, (True, False))
        if not each:
            state = replace(state, loop=None)
            command = replace(command, place=None)
            return _at_the_end(setting, state, command)
        command = replace(command, place=None)
    if place is not None and place.shape in ("several", "area") and state.plan.steps and not ends:
        raise NotComposed(message("it is not clear during which step it waits there", context="fault"))
    nowhere = state.where is None and state.lead is None and state.area is None and not state.plan.steps
    if place is None and nowhere:
        return _at_the_end(setting, state, command)  # at the start of the mission
    before = state
    state = capture(setting, state, replace(command, relation="at" if command.relation == "bare" else command.relation))
    return replace(state, things=before.things, captured=before.captured)


def _at_the_end(setting: Setting, state: DialogueState, command: CaptureCommand) -> DialogueState:
    """Return the state after a wait as the next step of the block that takes commands, wherever the robot is."""
    (thing,) = command.things
    act = p.Act(id="", action=thing.action, count=command.times, said=setting.spans_of(command.used))
    return replace(with_step(state, act), commands_in_sentence=state.commands_in_sentence + 1)


def with_settling(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state with the waits before captures in its plan.

    Raises:
        NotComposed: There is no such capture.
    """
    for clause in state.settles:
        actions = {*clause.actions} - {LAST_THING, UNSAID_THING}
        found = [
            node.act for _, node in walk(state.plan)
            if node.act is not None and wait_seconds(node.act.action) is None
            and (not actions or node.act.action in actions)
        ]  # fmt: skip
        if not found:
            raise NotComposed(message("nothing is captured that it could be before", context="fault"), clause.used)
        said = setting.spans_of(clause.used)
        steps = tuple(_settled(step, clause, actions, said) for step in state.plan.steps)
        plan = replace(state.plan, steps=steps)
        state = replace(state, plan=plan, captured=None, loop=None, choice=None)
    return state


def _settled(node: p.Node, clause: SettleClause, actions: set[str], said: Spans) -> p.Node:
    """Return a plan with a wait before each capture of some actions, of all if there are none."""
    act = node.act
    if act is None:
        return node.with_children([_settled(child, clause, actions, said) for child in node.children])
    if wait_seconds(act.action) is not None or (actions and act.action not in actions):
        return act
    wait = p.Wait(id="", seconds=clause.seconds, said=said)
    once = p.InOrder(id="", steps=(wait, replace(act, at=None, at_said=(), label="", count=1)))
    body = once if act.count == 1 else p.Repeat(id="", times=act.count, body=once)
    if act.at is None:
        return body
    go = p.GoTo(id="", place=act.at, label=act.label, said=act.at_said)
    return p.InOrder(id="", steps=(go, *(once.steps if act.count == 1 else (body,))))
