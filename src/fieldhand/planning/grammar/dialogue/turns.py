"""The clauses of a request as they are meant: corrected, and in the order in which they are done."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.reordering import reordered
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
    Total,
)
from fieldhand.planning.selections import (
    are_rows,
    blocks_of,
    is_in_block,
    named_places,
    over,
    replaceable_area,
    swapped,
)
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
            found = reordered(found, clause.command)
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
    if clauses and isinstance(clauses[0].command, Total):
        return (*clauses[1:], replace(clauses[0], before=Connective(True, False, 0)))
    if not clauses or not isinstance(clauses[0].command, Again) or clauses[0].command.drives:
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
        used = correction.used | (clause.before.used if clause.before is not None else 0)
        other, edits = _other_part(setting, command.place, correction.old, correction, used)
        return replace(last, command=replace(command, place=other, used=command.used | used)), edits
    old, place = command.place, _other_place(command.place, new)
    if place is None or not old.tokens or s.Here() in new.selector.walk():  # "tree 4, I mean its neighbour"
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


def _other_part(
    setting: Setting, place: PlaceMeaning, old: PlaceMeaning, correction: Correction, used: int
) -> tuple[PlaceMeaning, Edits]:
    """Return places with another one in the stead of one of them, and what that changes in the request.

    Raises:
        NotComposed: It is not one of them.
    """
    before, meant = old.selector.named_tree, correction.place.selector.named_tree
    named = named_places(place.selector) or (place.selector,)
    if not before or not meant or not place.tokens or named.count(old.selector) != 1:
        raise _unclear(correction)
    start, end = _range(setting, place.tokens)
    said = list(re.finditer(rf"\b{re.escape(before)}\b", setting.request[start:end], re.IGNORECASE))
    if len(said) != 1:
        raise _unclear(correction)
    other = replace(place, selector=swapped(place.selector, old.selector, correction.place.selector))
    part = (start + said[0].start(), start + said[0].end())
    return other, ((part, meant), (_range(setting, used), ""))


def _range(setting: Setting, used: int) -> Span:
    """Return the range of the request from the first to the last of some tokens."""
    said = setting.spans_of(used)
    return (said[0][0], said[-1][1])


def _other_place(old: PlaceMeaning, new: PlaceMeaning) -> PlaceMeaning | None:
    """Return a place with another one in its stead, or with another area of the same kind; None if they are unlike."""
    if old.shape == new.shape and new.shape in ("one", "area") and old.per is None and new.per is None:
        blocks = set(blocks_of(old.selector))
        if len(blocks) == 1 and are_rows(new.selector) and not is_in_block(new.selector):
            return replace(old, selector=over(new.selector, blocks.pop()), tokens=old.tokens | new.tokens)
        return replace(new, tokens=old.tokens | new.tokens)
    named = (*named_places(old.selector), *named_places(new.selector))
    if old.shape == new.shape == "several" and all(one.named_tree for one in named):
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
