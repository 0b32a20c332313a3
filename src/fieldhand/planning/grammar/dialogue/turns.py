"""The clauses of a request as they are meant: corrected, and in the order in which they are done."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.state import Edits, NotComposed, Setting
from fieldhand.planning.grammar.meaning import (
    Again,
    CaptureCommand,
    Connective,
    Correction,
    DriveCommand,
    InTurn,
    Lead,
    LinkedCommand,
    PlaceMeaning,
    Reordered,
)
from fieldhand.planning.selections import named_places, replaceable_area, swapped
from fieldhand.task.plan import Span


def as_meant(setting: Setting, clauses: Sequence[LinkedCommand]) -> tuple[tuple[LinkedCommand, ...], Edits]:
    """Return clauses with corrections made ("no wait, tree 9"), in order ("finish with ...").

    With them come the ranges of the request that the corrections change, and what stands there then.

    Raises:
        NotComposed: What is corrected, or the order, is unclear.
    """
    found: list[LinkedCommand] = []
    edits: Edits = ()
    for clause in clauses:
        if isinstance(clause.command, Reordered):
            found = _reordered(setting, found, clause.command)
            continue
        if not isinstance(clause.command, Correction):
            found.append(clause)
            continue
        if not found:
            raise _unclear(clause.command)
        corrected, changed = _corrected(setting, found.pop(), clause, clause.command)
        found.append(corrected)
        edits = (*edits, *changed)
    return _in_turn(_repeated_first(found)), edits


def _repeated_first(clauses: Sequence[LinkedCommand]) -> Sequence[LinkedCommand]:
    """Return clauses with a repetition at their beginning ("three times: ...") behind the sentence that it is of."""
    if not clauses or not isinstance(clauses[0].command, Again):
        return clauses
    again, rest = replace(clauses[0], before=Connective(True, True, 0)), clauses[1:]
    ends = (k for k, clause in enumerate(rest) if k > 0 and clause.before is not None and clause.before.full)
    end = next(ends, len(rest))
    return (*rest[:end], again, *rest[end:])


def _unclear(correction: Correction) -> NotComposed:
    return NotComposed(message("it is not clear what is corrected", context="fault"), correction.used)


def _corrected(
    setting: Setting, last: LinkedCommand, clause: LinkedCommand, correction: Correction
) -> tuple[LinkedCommand, Edits]:
    """Return the last clause with the place of a correction, and what the correction changes in the request."""
    command, new = last.command, correction.place
    if not isinstance(command, CaptureCommand | DriveCommand | Lead) or command.place is None:
        raise _unclear(correction)
    if correction.old is not None:
        return _corrected_part(setting, last, clause, correction, correction.old)
    old, place = command.place, _other_place(command.place, new)
    if place is None or not old.tokens:
        raise _unclear(correction)
    used = correction.used | (clause.before.used if clause.before is not None else 0)
    words, start, end = setting.quoted(new.tokens), *_range(setting, old.tokens)
    if old.shape != new.shape:
        part = setting.request[start:end].lower().rfind(words.lower().split()[0])
        start = start + part if part >= 0 else end
        if len(setting.request[start:end].split()) != len(words.split()):
            raise _unclear(correction)
    changed = replace(command, place=place, used=command.used | used)
    return replace(last, command=changed), (((start, end), words), (_range(setting, used), ""))


def _corrected_part(
    setting: Setting, last: LinkedCommand, clause: LinkedCommand, correction: Correction, old: PlaceMeaning
) -> tuple[LinkedCommand, Edits]:
    """Return the last clause with one of its places replaced, and what that changes in the request.

    Raises:
        NotComposed: It does not name that place once.
    """
    command = last.command
    assert isinstance(command, CaptureCommand | DriveCommand | Lead)
    assert command.place is not None
    before, meant = old.selector.named_tree, correction.place.selector.named_tree
    named = named_places(command.place.selector) or (command.place.selector,)
    if not before or not meant or not command.place.tokens or named.count(old.selector) != 1:
        raise _unclear(correction)
    used = correction.used | (clause.before.used if clause.before is not None else 0)
    start, end = _range(setting, command.place.tokens)
    said = list(re.finditer(rf"\b{re.escape(before)}\b", setting.request[start:end], re.IGNORECASE))
    if len(said) != 1:
        raise _unclear(correction)
    place = replace(command.place, selector=swapped(command.place.selector, old.selector, correction.place.selector))
    changed = replace(command, place=place, used=command.used | used)
    part = (start + said[0].start(), start + said[0].end())
    return replace(last, command=changed), ((part, meant), (_range(setting, used), ""))


def _reordered(setting: Setting, clauses: Sequence[LinkedCommand], order: Reordered) -> list[LinkedCommand]:
    """Return clauses in the order that is said behind them ("the other way round", "tree 9 first").

    Raises:
        NotComposed: They are not two steps of their own, or do not name the place that comes first.
    """
    unclear = NotComposed(message("it is not clear in which order", context="fault"), order.used)
    clauses = [_as_capture(clauses, number) for number in range(len(clauses))]
    steps = [clause.command for clause in clauses]
    if len(steps) == 1 and isinstance(steps[0], CaptureCommand) and steps[0].place is not None:
        return [replace(clauses[0], command=_visits_reordered(steps[0], steps[0].place, order, unclear))]
    if len(steps) != 2 or not all(isinstance(one, CaptureCommand) and _is_at_its_own(one.place) for one in steps):
        raise unclear
    one, other = clauses
    if order.first is not None and order.first.like is not None and order.first.like.number:
        if order.first.like.number not in (-1, 2):
            return [_with_words(one, order.used), other]
    elif order.first is not None:
        named = [_names(one.command, order.first), _names(other.command, order.first)]
        if sorted(named) != [False, True] or (order.swapped and named[0]):
            raise unclear
        if named[0]:
            return [_with_words(one, order.used), other]
    return [
        _with_words(replace(other, before=None), order.used),
        replace(one, before=Connective(True, True, _joins(other))),
    ]


def _as_capture(clauses: Sequence[LinkedCommand], number: int) -> LinkedCommand:
    """Return a clause; one that only names another place as the capture before it, there ("..., then tree 9")."""
    clause, before = clauses[number], clauses[number - 1].command if number else None
    lead = clause.command
    if not isinstance(lead, Lead) or lead.things or not isinstance(before, CaptureCommand):
        return clause
    return replace(clause, command=replace(before, place=lead.place, used=lead.used))


def _joins(clause: LinkedCommand) -> int:
    """Return the tokens of the connective before a clause."""
    return 0 if clause.before is None else clause.before.used


def _with_words(clause: LinkedCommand, used: int) -> LinkedCommand:
    """Return a clause that is said by further words."""
    command = clause.command
    assert isinstance(command, CaptureCommand)
    return replace(clause, command=replace(command, used=command.used | used))


def _is_at_its_own(place: PlaceMeaning | None) -> bool:
    """Return True for places that a phrase names by themselves."""
    if place is None or place.shape not in ("one", "several", "area") or place.like is not None or place.beside:
        return False
    return not place.selector.relative


def _names(command: object, first: PlaceMeaning) -> bool:
    """Return True if a command is at a place, or at one that is described by it ("the pond one")."""
    assert isinstance(command, CaptureCommand)
    place = None if command.place is None else command.place.selector
    return place is not None and (place == first.selector or first.selector in place.walk())


def _visits_reordered(
    command: CaptureCommand, place: PlaceMeaning, order: Reordered, unclear: NotComposed
) -> CaptureCommand:
    """Return a capture at several named places, of which another comes first."""
    named = list(named_places(place.selector))
    if order.first is None:
        if len(named) != 2:
            raise unclear
        named.reverse()
    elif order.first.like is not None and order.first.like.number:
        named.insert(0, named.pop(order.first.like.number - 1 if order.first.like.number > 0 else -1))
    elif named.count(order.first.selector) == 1:
        named.sort(key=lambda one: one != order.first.selector)
    else:
        raise unclear
    if not all(one.single and not one.relative for one in named):
        raise unclear
    select = s.UnionOf(parts=tuple(named))
    return replace(command, place=replace(place, selector=select, in_order=True), used=command.used | order.used)


def _range(setting: Setting, used: int) -> Span:
    """Return the range of the request from the first to the last of some tokens."""
    said = setting.spans_of(used)
    return (said[0][0], said[-1][1])


def _other_place(old: PlaceMeaning, new: PlaceMeaning) -> PlaceMeaning | None:
    """Return a place with another one in its stead, or with another area of the same kind; None if they are unlike."""
    if old.shape == new.shape and new.shape in ("one", "area") and old.per is None and new.per is None:
        return replace(new, tokens=old.tokens | new.tokens)
    named = (*named_places(old.selector), *named_places(new.selector))
    if old.shape == new.shape == "several" and all(isinstance(one, s.TreeIs) for one in named):
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
