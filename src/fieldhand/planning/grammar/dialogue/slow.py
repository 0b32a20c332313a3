"""Slow ground in the dialogue: each place gets its speed, and a distance where only "near" is said is asked for."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.grammar.dialogue.paces import require_possible, said_speed, slow_assumption
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, Setting
from fieldhand.planning.grammar.meaning import PaceClause, SlowPlace, WayRule


def ruled(setting: Setting, state: DialogueState, command: WayRule) -> DialogueState:
    """Return the state after a rule of where the robot drives.

    Raises:
        NotComposed: It is not said how near to a place it drives slowly.
        OpenQuestion: It is not said how slowly.
    """
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
