"""Work that is done only if the budget allows it, or if a command before it fails."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.grammar.dialogue.fitting import is_spoken_of
from fieldhand.planning.grammar.dialogue.plans import EMPTY, Path, block_at, node_at, with_node
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    Setting,
    with_assumption,
    with_last_step,
    with_step,
)
from fieldhand.planning.grammar.meaning import LAST_THING, Allowed, CaptureCommand, Connective, Failing, LinkedCommand
from fieldhand.task import plan as p


def allowed(
    setting: Setting,
    state: DialogueState,
    command: Allowed,
    following: Sequence[LinkedCommand],
    joint: Connective | None,
) -> DialogueState:
    """Return the state in which the commands that follow are optional, or the one before if none follows.

    Args:
        setting: Robot and site that the request is read for.
        state: State before it.
        command: The words that say so.
        following: Further commands of the sentence.
        joint: Connective before these words.

    Raises:
        NotComposed: What may be left out is unclear.
    """
    said, steps = setting.spans_of(command.used), state.block.steps
    if command.unsaid:
        taken = message(
            "'{said}' is taken as: if the battery and the budget allow it.",
            context="assumption",
            said=setting.quoted(command.used),
        )
        state = with_assumption(state, taken)
    if state.awaits_command:
        raise NotComposed(message("does it apply to all these places together, or to each of them?", context="fault"))
    optional = bool(state.scope) and node_at(state.plan, state.scope[:-1]).is_optional_step
    if optional or (state.commands_in_sentence and any(one.visits_each and one.is_optional for one in steps[-1:])):
        raise NotComposed(message("what it applies to may already be left out", context="fault"))
    after_and = joint is None or joint.both or joint.then or joint.full
    if following and state.commands_in_sentence and not after_and:
        of_last = setting.either("what is left out if the budget is short?", command.used, (True, False))
        following = () if of_last else following
    loop: Path | None = None
    next_command = following[0].command if following else None
    if state.loop is not None and isinstance(next_command, CaptureCommand) and is_spoken_of(next_command.place):
        loop = state.loop  # "at every yellow tree a picture and, if ..., a CO2 reading"
        state = replace(state, scope=state.loop)
    if following:
        inside = (*state.next_step, "body")
        state = with_step(state, p.OptionalStep(id="", body=EMPTY, said=said))
        return replace(state, scope=inside, open=True, loop=loop)
    own_place = bool(steps) and (steps[-1].visits_each or (steps[-1].act is not None and steps[-1].act.at is not None))
    if not steps or not state.commands_in_sentence or (state.commands_in_sentence > 1 and not own_place):
        raise NotComposed(message("it is not clear what is left out if the budget is short", context="fault"))
    body = p.InOrder(id="", steps=steps[-1:])
    return replace(with_last_step(state, p.OptionalStep(id="", body=body, said=said)), loop=None, captured=None)


def failing(setting: Setting, state: DialogueState, command: Failing) -> DialogueState:
    """Return the state in which the next commands are done if the last one fails."""
    steps = state.block.steps
    if not steps:
        raise NotComposed(message("it is not clear what may fail", context="fault"))
    if command.place is not None and command.place.selector not in [node.selector for node in p.walk(steps[-1])]:
        raise NotComposed(message("it is not clear what may fail", context="fault"))
    if (command.action or command.at_one) and state.loop is not None and state.captured is not None:
        return _failing_at_each(setting, state, command, state.captured)
    last = steps[-1].act
    if command.at_one or (command.action and (last is None or command.action not in (LAST_THING, last.action))):
        raise NotComposed(message("it is not clear what may fail", context="fault"))
    inside = (*state.scope, len(steps) - 1, "otherwise")
    body = p.InOrder(id="", steps=steps[-1:])
    state = with_last_step(state, p.Try(id="", body=body, otherwise=EMPTY, said=setting.spans_of(command.used)))
    return replace(state, scope=inside, open=True, loop=None, captured=None, choice=None)


def _failing_at_each(setting: Setting, state: DialogueState, command: Failing, captured: Path) -> DialogueState:
    """Return the state in which the next commands are done at each of several places where the last capture fails.

    Raises:
        NotComposed: Another capture than the last one there is meant.
    """
    block, act = block_at(state.plan, captured[:-1]), node_at(state.plan, captured).act
    is_last = captured[-1] == len(block.steps) - 1 and captured[:-1] == state.loop
    if act is None or not is_last or command.action not in ("", LAST_THING, act.action):
        raise NotComposed(message("it is not clear what may fail", context="fault"))
    body = p.InOrder(id="", steps=(act,))
    tried = p.Try(id="", body=body, otherwise=EMPTY, said=setting.spans_of(command.used))
    plan = with_node(state.plan, captured, tried)
    return replace(state, plan=plan, scope=(*captured, "otherwise"), open=True, captured=None, choice=None)
