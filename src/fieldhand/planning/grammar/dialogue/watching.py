"""Conditions that hold all the time, in the dialogue: they apply to the whole mission and change no step."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.grammar.dialogue.paces import slow_assumption
from fieldhand.planning.grammar.dialogue.slow import with_speed
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, Setting, with_assumption
from fieldhand.planning.grammar.meaning import WatchCommand
from fieldhand.task import plan as p
from fieldhand.task.watches import Fallback, Watch


def watched(setting: Setting, state: DialogueState, command: WatchCommand) -> DialogueState:
    """Return the state after a sentence about what the robot watches.

    Raises:
        NotComposed: Another sentence says something else about the same condition.
    """
    reaction, speed = command.reaction, None
    if reaction.pace is not None:
        pace = with_speed(setting, reaction.pace, command.used)
        state, speed = slow_assumption(setting, state, pace), pace.speed
    if len(command.during) > 1:
        raise NotComposed(message("it is not clear during what this is to be watched", context="fault"))
    for condition in command.conditions:
        if any(known.condition == condition for known in state.watches):
            raise NotComposed(message("it is said twice what is done then", context="fault"))
        home: Fallback = "return_to_start" if "start" in setting.site.markers else "return_to_end"
        fallback = reaction.fallback or ("end" if reaction.stands else home)
        one = Watch(
            condition=condition,
            response=reaction.response,
            at_most_s=reaction.at_most_s,
            fallback=fallback if reaction.response == "wait" else Watch.fallback,
            said=setting.spans_of(command.used),
            speed_m_s=speed,
            during=command.during[0] if command.during else "",
        )
        state = replace(
            state, watches=(*state.watches, one), after_watch=one.at_most_s is not None or one.response == "end"
        )
    if reaction.response == "wait" and reaction.stands and not reaction.over and reaction.at_most_s is None:
        return with_assumption(
            state,
            message(
                "“Stop” means that the robot stands still until it is over and then goes on.", context="assumption"
            ),
        )
    return state


def with_visits(plan: p.Node) -> p.Node:
    """Return a plan in which each capture at a place is a visit, which can be left out."""
    if plan.visits_each:
        return plan
    act = plan.act
    if act is not None and act.at is not None:
        there = replace(act, at=None, at_said=(), label="")
        return p.ForEach(select=act.at, body=there, label=act.label, said=act.at_said)
    return plan.with_children([with_visits(child) for child in plan.children])
