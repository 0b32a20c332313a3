"""The clauses of a request as they are meant: corrected, and in the order in which they are done."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.grammar.dialogue.faults import NotComposed
from fieldhand.planning.grammar.meaning import (
    CaptureCommand,
    Connective,
    Correction,
    DriveCommand,
    InTurn,
    LinkedCommand,
    PlaceMeaning,
)
from fieldhand.planning.selections import replaceable_area, swapped


def as_meant(clauses: Sequence[LinkedCommand]) -> tuple[LinkedCommand, ...]:
    """Return clauses with corrections made ("no wait, tree 9"), and in order ("finish with ..., start with ...").

    Raises:
        NotComposed: What is corrected, or the order, is unclear.
    """
    found: list[LinkedCommand] = []
    for clause in clauses:
        if isinstance(clause.command, Correction):
            if not found:
                raise NotComposed(message("it is not clear what is corrected", context="fault"), clause.command.used)
            found.append(_corrected(found.pop(), clause, clause.command))
        else:
            found.append(clause)
    return _in_turn(found)


def _corrected(last: LinkedCommand, clause: LinkedCommand, correction: Correction) -> LinkedCommand:
    """Return the last clause with what a correction puts in the place of a part of it."""
    command = last.command
    used = correction.used | (clause.before.used if clause.before is not None else 0)
    unclear = NotComposed(message("it is not clear what is corrected", context="fault"), correction.used)
    if correction.things and isinstance(command, CaptureCommand):
        if [one.action for one in correction.things] != [one.action for one in command.things]:
            raise unclear
        return replace(last, command=replace(command, things=correction.things, used=command.used | used))
    if correction.place is None or not isinstance(command, CaptureCommand | DriveCommand) or command.place is None:
        raise unclear
    place = _other_place(command.place, correction.place)
    if place is None:
        raise unclear
    return replace(last, command=replace(command, place=place, used=command.used | used))


def _other_place(old: PlaceMeaning, new: PlaceMeaning) -> PlaceMeaning | None:
    """Return a place with another one in its stead, or with another area of the same kind; None if they are unlike."""
    if old.shape == new.shape == "one" or old.selector == new.selector:
        return replace(new, tokens=old.tokens | new.tokens)
    if new.shape != "area":
        return None
    area = replaceable_area(old.selector, new.selector)
    return None if area is None else replace(old, selector=swapped(old.selector, area, new.selector))


def _in_turn(clauses: Sequence[LinkedCommand]) -> tuple[LinkedCommand, ...]:
    """Return clauses in the order in which they are done."""
    first: list[LinkedCommand] = []
    last: list[LinkedCommand] = []
    rest: list[LinkedCommand] = []
    end = len(clauses) - 1
    for number, clause in enumerate(clauses):
        turn = clause.command
        if not isinstance(turn, InTurn):
            rest.append(clause)
            continue
        plain = replace(clause, command=turn.command)
        if number == (0 if turn.first else end):
            rest.append(plain)
            continue
        after = clauses[number + 1] if number < end else None
        if turn.command.place is None or turn.command.place.shape not in ("one", "several", "area"):
            raise NotComposed(message("it is not clear where", context="fault"), turn.used)
        if after is not None and (after.before is None or not isinstance(after.command, _Independent)):
            raise NotComposed(message("it is not clear what belongs to it", context="fault"), turn.used)
        (first if turn.first else last).append(plain)
    if len(first) > 1 or len(last) > 1:
        raise NotComposed(message("two steps cannot both be the first or the last one", context="fault"))
    moved = first + rest + last
    if not (first or last):
        return tuple(moved)
    return tuple(replace(one, before=_new_step(one, number)) for number, one in enumerate(moved))


#: Commands that do not depend on the clause before them.
_Independent = CaptureCommand | DriveCommand | InTurn


def _new_step(clause: LinkedCommand, number: int) -> Connective | None:
    """Return the connective of a clause among those that were put in order."""
    used = clause.before.used if clause.before is not None else 0
    if number == 0:
        return Connective(False, True, used)
    return replace(clause.before, full=True, then=True) if clause.before is not None else Connective(True, False, 0)
