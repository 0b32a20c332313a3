"""Slow ground in the dialogue: each place gets its speed, and a distance where only "near" is said is asked for."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.grammar.dialogue.paces import require_possible, said_speed, slow_assumption
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, Setting
from fieldhand.planning.grammar.meaning import PaceClause, SlowPlace, WayRule
from fieldhand.task import plan as p


def ruled(setting: Setting, state: DialogueState, command: WayRule) -> DialogueState:
    """Return the state after a rule of where the robot drives.

    Raises:
        NotComposed: It is not said how near to a place it drives slowly, or only some places are so far from another.
        OpenQuestion: It is not said how slowly.
    """
    if command.described and sum(node.selector is not None for node in p.walk(state.plan)) > 1:
        what = message("a distance is kept in the whole mission, not at some of its places only", context="fault")
        raise NotComposed(what, command.used, message("ask for those places in a mission of their own"))
    slow: list[SlowPlace] = []
    for one in command.slow:
        if one.metres is None:
            what = message("it is not said how near that is", context="fault")
            raise NotComposed(what, command.used, message("give a distance: 'within 5 m of it'"))
        pace = with_speed(setting, one.pace or PaceClause(0.0, slowly=True), command.used)
        state = slow_assumption(setting, state, pace)
        slow.append(replace(one, pace=pace))
    rule = replace(command, slow=tuple(slow))
    return replace(state, ways=(*state.ways, (rule, setting.spans_of(command.used))))


def with_speed(setting: Setting, pace: PaceClause, used: int) -> PaceClause:
    """Return a speed with its number, at which the robot can drive.

    Raises:
        NotComposed: The robot cannot drive at it.
        OpenQuestion: It has no number.
    """
    found = said_speed(setting, pace if pace.used else replace(pace, used=used))
    require_possible(setting, found)
    return found
