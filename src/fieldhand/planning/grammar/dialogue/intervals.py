"""Captures at regular intervals: "every ten minutes for an hour", "stay for an hour and ... every ten minutes"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.language.words import say_duration
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    with_assumption,
)
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    Again,
    CaptureCommand,
    Command,
    Lead,
    LinkedCommand,
    PlaceMeaning,
    Total,
    rested_things,
    wait_seconds,
)
from fieldhand.planning.grammar.places.sampling import bare_zone
from fieldhand.site.model import Site

#: Maximum number of captures at intervals.
_MOST = 50


def with_intervals(clauses: Sequence[LinkedCommand], site: Site) -> tuple[LinkedCommand, ...]:
    """Return clauses with what one of them says of the intervals of the next, or of the one before it.

    "Stay for an hour and read CO2 every ten minutes" reads it for an hour, "every ten minutes, six times in all" six
    times, and "wait ten minutes and do it again" repeats it after a wait. "Three readings at the trough and three at
    the mast, a minute apart" has pauses at both places.
    """
    found: list[LinkedCommand] = []
    for clause in _rested_alike(clauses, site):
        merged = _together(found[-1].command, clause.command) if found else None
        if merged is None:
            found.append(clause)
            continue
        joined = 0 if clause.before is None else clause.before.used
        found[-1] = replace(found[-1], command=replace(merged, used=merged.used | joined))
        if isinstance(clause.command, Total):
            found.append(clause)
    return tuple(found)


def _rested_alike(clauses: Sequence[LinkedCommand], site: Site) -> Sequence[LinkedCommand]:
    """Return clauses with the pauses of captures that are not named, as those of the named captures before them."""
    made = list(clauses)
    for at, clause in enumerate(clauses):
        seconds = _pause(clause.command)
        if seconds is None:
            continue
        first = at - 1
        while first > 0 and _unrested(made[first].command, site) == LAST_THING:
            first -= 1
        action = _unrested(made[first].command, site) if first >= 0 else ""
        if action in ("", LAST_THING):
            continue
        named = made[first].command
        for k in range(first, at + 1):
            command = made[k].command
            if isinstance(named, CaptureCommand) and isinstance(command, CaptureCommand):
                times = (command.things[0].count or 1) * command.times if k < at else len(command.things) // 2 + 1
                once = replace(named.things[0], count=1, plural=False)
                things = rested_things((once,), times, seconds)
                made[k] = replace(made[k], command=replace(command, things=things, times=1, relation="at"))
    return made


def _pause(command: Command) -> float | None:
    """Return the seconds between captures that are not named; None for another command."""
    if not isinstance(command, CaptureCommand) or command.things[0].action != LAST_THING or len(command.things) < 3:
        return None
    seconds = wait_seconds(command.things[1].action)
    known = seconds and rested_things(command.things[:1], len(command.things) // 2 + 1, seconds) == command.things
    return seconds if known else None


def _unrested(command: Command, site: Site) -> str:
    """Return the action of several captures at one place; empty for another command."""
    if not isinstance(command, CaptureCommand) or len(command.things) != 1 or command.spacing is not None:
        return ""
    (thing,), place = command.things, command.place
    alone = place is not None and (place.shape == "one" or bool(bare_zone(place.selector, site)))
    return thing.action if alone and (thing.count or 1) * command.times > 1 else ""


def _together(first: Command, then: Command) -> CaptureCommand | Again | None:
    """Return two commands as one; None if they are two."""
    recurs = isinstance(first, CaptureCommand) and first.every_s > 0 and not first.for_s
    if recurs and isinstance(first, CaptureCommand):
        if isinstance(then, Total):
            return _so_often(first, then.count, 0)
        if isinstance(then, Again):
            return _so_often(first, then.times, then.used) if then.in_all and then.place is None else None
    if not isinstance(first, CaptureCommand) or len(first.things) != 1:
        return None
    seconds = wait_seconds(first.things[0].action)
    if not seconds:
        return None
    if isinstance(then, Again):
        here = first.place is None or first.place.shape == "here"
        known = here and then.place is None and not then.rest_s
        merged = replace(then, times=then.times or 1, rest_s=seconds, used=first.used | then.used)
        return merged if known else None
    if not isinstance(then, CaptureCommand) or not then.every_s or then.for_s:
        return None
    if then.place is not None and then.place.shape != "here":
        return None
    place = first.place or then.place
    return replace(then, place=place, relation=first.relation, for_s=seconds, used=first.used | then.used)


def _so_often(command: CaptureCommand, times: int, used: int) -> CaptureCommand | None:
    """Return captures at intervals as so many."""
    if not 2 <= times <= _MOST:
        return None
    things = rested_things(tuple(replace(one, count=1) for one in command.things), times, command.every_s)
    return replace(command, things=things, every_s=0.0, used=command.used | used)


def at_intervals(
    setting: Setting, state: DialogueState, command: CaptureCommand
) -> tuple[DialogueState, CaptureCommand]:
    """Return captures at intervals as captures with waits between them, and the state that says how many they are.

    Raises:
        NotComposed: The phrase does not say how often, or the captures are not at one place.
    """
    if not command.every_s and not command.for_s:
        return state, command
    said = setting.quoted(command.used)
    if not command.for_s:
        raise OpenQuestion(message("'{said}': how often, or for how long?", said=said), command.used)
    if not 0.0 < command.every_s <= command.for_s:
        raise NotComposed(message("it does not say how often in that time", context="fault"))
    times = int(command.for_s / command.every_s + 1e-9) + 1
    if not _at_one_place(setting, state, command) or times > _MOST or command.spacing is not None:
        raise NotComposed(
            message("captures at intervals of time are made at one place, and at most {most} times", most=_MOST),
            advice=message("say how many rounds: 'three rounds, with a ten-minute wait between them'"),
        )
    once = tuple(replace(one, count=1) for one in command.things)
    taken = message(
        "Every {gap} for {time} is taken as {count} times: at the beginning, at the end, and between.",
        context="assumption",
        gap=say_duration(command.every_s),
        time=say_duration(command.for_s),
        count=times,
    )
    things = rested_things(once, times, command.every_s)
    return with_assumption(state, taken), replace(command, things=things, every_s=0.0, for_s=0.0)


def _at_one_place(setting: Setting, state: DialogueState, command: CaptureCommand) -> bool:
    lead = state.lead if isinstance(state.lead, Lead) else None
    place: PlaceMeaning | None = command.place or (None if lead is None else lead.place)
    if place is None:
        return state.area is None
    if place.shape == "here":
        return state.where is None or state.where.shape == "one" or state.loop is not None
    return place.shape == "one" or bool(bare_zone(place.selector, setting.site))
