"""Commands to work along rows, through aisles, over areas and along their edges."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, Setting, Spans, with_step
from fieldhand.planning.grammar.dialogue.that_ground import ground_spoken_of
from fieldhand.planning.grammar.meaning import DriveCommand, WorkCommand
from fieldhand.planning.selections import are_rows
from fieldhand.task import plan as p


def work_along(setting: Setting, state: DialogueState, command: WorkCommand) -> DialogueState:
    """Return the state after work along rows or over an area, which may be that to which the robot was just sent.

    Raises:
        NotComposed: It does not say where, or the place before it has its own work to come.
    """
    said: Spans = setting.spans_of(command.used)
    along, mode = command.along, command.mode
    if along is None:
        before = state.area or state.lead
        named = before is not None and before.place.shape == "area" and not before.place.selector.relative
        ground = before.place.selector if before is not None and named else None if before else ground_spoken_of(state)
        if ground is None or (before is None and not command.it):
            raise NotComposed(
                message("it does not say where", context="fault"),
                advice=message("say along which rows, between which rows, or over which area"),
            )
        along, said = ground, (*(() if before is None else setting.spans_of(before.used)), *said)
        state = replace(state, area=None, lead=None)
        implement = setting.robot.action[command.action].implement
        if not are_rows(along) and implement is not None and implement.covers:
            mode = "area"
    elif state.awaits_command:
        area = state.area or state.lead
        if area is None or area.place.shape != "area" or area.place.selector != along:
            raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
        said = (*setting.spans_of(area.used), *said)
        state = replace(state, area=None, lead=None)
    node = p.WorkAlong(
        action=command.action,
        parameters=command.parameters,
        along=along,
        mode=mode,
        sides=command.sides,
        every=command.every,
        heading=command.heading,
        laps=command.laps,
        optional=command.optional,
        said=said,
    )
    state = _with_rests(state, replace(node, laps=1), command, said) if command.rest_s else with_step(state, node)
    return replace(state, loop=None, captured=None, where=None, commands_in_sentence=state.commands_in_sentence + 1)


def _with_rests(state: DialogueState, once: p.WorkAlong, command: WorkCommand, said: Spans) -> DialogueState:
    """Return the state after work in laps with a rest between one and the next."""
    rest = p.Wait(id="", seconds=command.rest_s, said=said)
    rounds: p.Node = p.InOrder(id="", steps=(once, rest))
    if command.rests_last:
        return with_step(state, p.Repeat(id="", times=command.laps, body=rounds, said=said))
    if command.laps > 2:
        rounds = p.Repeat(id="", times=command.laps - 1, body=rounds, said=said)
        return with_step(with_step(state, rounds), once)
    return with_step(with_step(with_step(state, once), rest), once)


def driven_along(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state after a drive along rows at which nothing is said to be done ("drive along rows 3 to 8")."""
    area = state.area
    if area is None or state.lead is not None or state.open or not _is_along(area):
        return state
    node = p.WorkAlong(along=area.place.selector, said=setting.spans_of(area.used))
    return with_step(replace(state, area=None), node)


def _is_along(area: DriveCommand) -> bool:
    selector = area.place.selector
    named = are_rows(selector) and not selector.relative
    return bool(area.along) and not area.begins and not area.returns and named and selector != s.Rows()
