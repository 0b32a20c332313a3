"""Fragments of a request ("Row 6. Thermal. Every tree.") as the commands that they make up together.

A fragment names only places, only captures, or only how the visits are made. Places narrow each other from general to
special in whatever order they are named; captures are made at the places before them, or at the next ones if the
request begins with captures.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import pairwise

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.fitting import in_area, is_spoken_of
from fieldhand.planning.grammar.dialogue.state import NotComposed, Setting
from fieldhand.planning.grammar.meaning import (
    CaptureCommand,
    Connective,
    DriveCommand,
    InAnOrder,
    Lead,
    LimitClause,
    LinkedCommand,
    PlaceMeaning,
    VisitLimit,
    WayRule,
)
from fieldhand.planning.grammar.places.numbered import ids_of, numbered
from fieldhand.planning.selections import (
    AREAS,
    are_rows,
    chooses_from_trees,
    is_block,
    is_by_attribute,
    is_description,
    is_in_block,
    named_places,
    over,
    specifies_part,
)

#: Clauses that only say how visits are made.
_Manner = VisitLimit | InAnOrder | LimitClause | WayRule


@dataclass(frozen=True)
class _Step:
    """Captures, the places at which they are made, and how.

    Attributes:
        places: Places, each narrowed as far as the request says.
        captures: Captures.
        manners: How the visits are made.
        joint: Connective before the first clause.
        used: Tokens of the places and of the connectives.
        in_turn: True if the places are visited in the order in which they are named.
    """

    places: tuple[PlaceMeaning, ...] = ()
    captures: tuple[CaptureCommand, ...] = ()
    manners: tuple[LinkedCommand, ...] = ()
    joint: Connective | None = None
    used: int = 0
    in_turn: bool = False


def assembled(setting: Setting, clauses: Sequence[LinkedCommand]) -> tuple[LinkedCommand, ...]:
    """Return clauses with each series of fragments made one command, or several.

    Raises:
        NotComposed: What belongs together is unclear.
    """
    made: list[LinkedCommand] = []
    heading: PlaceMeaning | None = None
    rest = [part for clause in clauses for part in _parts(clause)]
    while rest:
        end = _end_of_fragments(rest) if not made or _is_complete(made[-1]) else 0
        series, rest = rest[: max(end, 1)], rest[max(end, 1) :]
        made += (
            _commands(setting, series, last=not rest) if end > 1 else [_below(setting, heading, one) for one in series]
        )
        announced = made[-1].command
        if isinstance(announced, Lead):
            heading = announced.place if end > 1 else None
    return tuple(made)


def _below(setting: Setting, heading: PlaceMeaning | None, clause: LinkedCommand) -> LinkedCommand:
    """Return a capture in the area of a heading before it ("Row 12, North. First vine, CO2; last vine, CO2.").

    Raises:
        NotComposed: It is not clear whether it is made there.
    """
    command, joint = clause.command, clause.before
    if heading is None or joint is None or not joint.full or not isinstance(command, CaptureCommand):
        return clause
    if command.place is None or is_spoken_of(command.place) or not chooses_from_trees(command.place.selector):
        return clause
    place = narrowed(setting, heading, command.place)
    if place is None or heading.shape != "area":
        raise _unclear(command.used)
    return replace(clause, command=replace(command, place=place))


def _parts(clause: LinkedCommand) -> tuple[LinkedCommand, ...]:
    """Return a capture somewhere in an area ("CO2, row 20") as the area and the capture."""
    command = clause.command
    if not isinstance(command, CaptureCommand) or command.place is None or not _is_open(command, command.place):
        return (clause,)
    capture = replace(command, place=None, used=command.used & ~command.place.tokens)
    area = Lead(command.place, command.place.tokens)
    return (replace(clause, command=area), LinkedCommand(None, capture))


def _is_open(command: CaptureCommand, place: PlaceMeaning) -> bool:
    """Return True for captures somewhere in an area, of which nothing says how many they are."""
    plain = command.spacing is None and command.within is None and not command.instead and command.times == 1
    return plain and place.shape == "area" and place.per is None and all(one.count is None for one in command.things)


def _is_complete(clause: LinkedCommand) -> bool:
    """Return True for a clause on which nothing depends that follows it."""
    return isinstance(clause.command, _Manner) or (
        isinstance(clause.command, CaptureCommand) and clause.command.place is not None
    )


def _end_of_fragments(clauses: Sequence[LinkedCommand]) -> int:
    """Return the number of fragments with which clauses begin."""
    for number, clause in enumerate(clauses):
        joint = clause.before
        if not _is_fragment(clause, first=number == 0):
            return number
        if joint is not None and (joint.first or joint.purpose or joint.from_here):
            return number
    return len(clauses)


def _is_fragment(clause: LinkedCommand, *, first: bool) -> bool:
    match clause.command:
        case Lead(relation=relation, things=things):
            leaves_out = clause.before is not None and clause.before.contrasts  # "all but the first two trees"
            return relation != "topic" and not things and not leaves_out
        case DriveCommand() as drive:
            return first and drive.place.shape == "area" and not (drive.begins or drive.returns or drive.ends)
        case CaptureCommand() as command:
            plain = command.spacing is None and command.within is None and not command.instead
            return plain and _follows_places(command.place)
        case command:
            return isinstance(command, _Manner)


def _follows_places(place: PlaceMeaning | None) -> bool:
    """Return True if captures are made at places that are named elsewhere ("a picture of each")."""
    if place is None or _is_each_tree(place):
        return True
    return is_spoken_of(place) and not (place.count or place.at_most or place.itself or place.one_tree or place.like)


def _is_each_tree(place: PlaceMeaning) -> bool:
    """Return True for "every tree", of areas that are named before."""
    plain = place.shape == "several" and place.count is None and place.at_most is None and not place.optional
    return plain and place.selector == s.Trees()


def _commands(setting: Setting, clauses: Sequence[LinkedCommand], *, last: bool) -> Sequence[LinkedCommand]:
    """Return the commands of a series of fragments.

    Args:
        setting: Robot and site.
        clauses: Fragments.
        last: True if no other clause follows.

    Raises:
        NotComposed: It is unclear what belongs together.
    """
    steps = _steps(setting, clauses)
    for one, other in pairwise(steps):
        areas = any(place.shape == "area" or not named_places(place.selector) for place in one.places)
        parts = any(specifies_part(place.selector) for place in other.places)
        shared = any(
            _shares_trees(setting, place, after) and place.selector != after.selector
            for place in one.places
            for after in other.places
        )
        if (areas and parts) or shared:
            raise _unclear(other.used)
    steps = _with_captures_of_last(steps)
    *whole, end = steps
    if end.captures or last:
        return [made for step in steps for made in _commands_of(step)]
    if len(end.places) > 1 or end.in_turn:
        raise _unclear(end.used)
    made = [made for step in whole for made in _commands_of(step)]
    announced = [LinkedCommand(end.joint, Lead(place, end.used)) for place in end.places]
    return [*made, *announced, *end.manners]


def _with_captures_of_last(steps: Sequence[_Step]) -> Sequence[_Step]:
    """Return steps with trees at the end that have no captures of their own visited for those before them."""
    if len(steps) < 2 or steps[-1].captures:
        return steps
    before, end = steps[-2:]
    if any(place.shape != "one" for place in (*before.places, *end.places)):
        return steps
    return [*steps[:-1], replace(end, captures=before.captures)]


def _unclear(used: int) -> NotComposed:
    return NotComposed(message("it is not clear at which of two places this is done", context="fault"), used)


def _steps(setting: Setting, clauses: Sequence[LinkedCommand]) -> Sequence[_Step]:
    """Return fragments by the captures to which they belong."""
    captures_first = isinstance(clauses[0].command, CaptureCommand)
    last_capture = max((k for k, one in enumerate(clauses) if isinstance(one.command, CaptureCommand)), default=-1)
    steps = [_Step(joint=clauses[0].before)]
    for number, clause in enumerate(clauses):
        step, joint, command = steps[-1], clause.before if number else None, clause.command
        words = joint.used if joint is not None else 0
        if isinstance(command, Lead | DriveCommand):
            apart = joint is not None and (joint.both or _says_then(joint))
            known = step.places
            if step.captures and not captures_first:
                ends = number > last_capture and len(known) == 1 and not apart
                narrower = narrowed(setting, known[0], command.place) if ends else None
                if narrower is None:
                    steps.append(_Step((command.place,), joint=joint, used=command.used))
                    continue
                steps[-1] = replace(step, places=(narrower,), used=step.used | command.used | words)
                continue
            places = (*known, command.place) if apart or not known else _with_place(setting, known, command.place)
            in_turn = step.in_turn or (joint is not None and bool(known) and _says_then(joint))
            steps[-1] = replace(step, places=places, used=step.used | command.used | words, in_turn=in_turn)
        elif isinstance(command, CaptureCommand):
            if captures_first and step.places:
                steps.append(_Step(captures=(command,), joint=joint))
                continue
            if not captures_first and not step.places:
                raise _unclear(command.used)
            steps[-1] = replace(step, captures=(*step.captures, command), used=step.used | words)
        else:
            steps[-1] = replace(step, manners=(*step.manners, clause))
    return steps


def _says_then(joint: Connective) -> bool:
    """Return True for "then", which follows another step or adds a place."""
    return joint.then or not (joint.full or joint.both or joint.bare)


def _with_place(setting: Setting, known: tuple[PlaceMeaning, ...], place: PlaceMeaning) -> tuple[PlaceMeaning, ...]:
    """Return places with a further one, which narrows the last one or is another place.

    Raises:
        NotComposed: It may narrow several of them.
    """
    narrower = narrowed(setting, known[-1], place)
    made = (*known, place) if narrower is None else (*known[:-1], narrower)
    of_each = any(one.shape == "area" for one in made) and any(one.shape != "area" for one in made)
    no_place = narrower is None and (place.there or specifies_part(place.selector))
    overlap = narrower is None and any(_shares_trees(setting, one, place) for one in known)
    if (len(made) > 1 and of_each) or no_place or overlap:
        raise _unclear(place.tokens)
    return made


def _shares_trees(setting: Setting, one: PlaceMeaning, other: PlaceMeaning) -> bool:
    """Return True for areas that overlap, of which their common part may be meant as well as both."""
    if "area" not in (one.shape, other.shape):
        return False
    known = (ids_of(one.selector, setting.site), ids_of(other.selector, setting.site))
    return bool(known[0] and known[1] and known[0] & known[1])


def narrowed(setting: Setting, one: PlaceMeaning, other: PlaceMeaning) -> PlaceMeaning | None:
    """Return what two places mean together if the special one is part of the general one; None for separate places."""
    within = _within(setting, one, other)
    if within is None and other.shape == "area":
        within = _within(setting, other, one)
    return None if within is None else within.with_tokens(one.tokens | other.tokens)


def _within(setting: Setting, area: PlaceMeaning, part: PlaceMeaning) -> PlaceMeaning | None:
    """Return a place in an area; None if it is none of the area."""
    base, selector = area.selector, part.selector
    described = is_description(base) and area.count is None and not area.optional and area.at_most is None
    if area.per is not None or base.relative or not (area.shape == "area" or (area.shape == "several" and described)):
        return None
    named = [one.named_tree for one in selector.members]
    if all(named):
        return _named_in(setting, base, part, named)
    if selector == s.Trees():
        return replace(part, selector=base, there=False) if part.shape == "several" else None
    if specifies_part(selector) and part.shape in ("one", "several"):
        if is_by_attribute(base) and any(isinstance(one, s.EveryNth) for one in selector.walk()):
            return None  # counted among the yellow trees, or among all?
        try:
            return in_area(setting, Lead(area, 0), part)
        except NotComposed:
            return None
    areas = [one for one in selector.walk() if isinstance(one, AREAS)]
    if is_block(base) and not is_in_block(selector) and all(are_rows(one) for one in areas) and part.per is None:
        return replace(part, selector=over(selector, base))
    inside, outside = ids_of(selector, setting.site), ids_of(base, setting.site)
    return part if inside and outside and inside < outside else None


def _named_in(setting: Setting, base: s.Selector, part: PlaceMeaning, named: Sequence[str]) -> PlaceMeaning | None:
    """Return trees that stand in an area, or are counted in rows as no tree of the site has the number; else None."""
    inside = ids_of(base, setting.site)
    if inside is not None and set(named) <= inside:
        ways = numbered(named, base, setting.site) if are_rows(base) else [part.selector]
        return replace(part, selector=setting.either("by number, or by id?", part.tokens, ways))
    if not are_rows(base) or any(name in setting.site.by_id for name in named):
        return None
    ways = numbered(named, base, setting.site)
    return replace(part, selector=ways[0]) if ways else None


def _commands_of(step: _Step) -> Sequence[LinkedCommand]:
    """Return the commands of captures at their places.

    Raises:
        NotComposed: They have no place, or the places are no captures.
    """
    if not step.captures or not step.places:
        raise _unclear(step.used)
    first = step.captures[0]
    if any(one.times != first.times for one in step.captures):
        raise _unclear(step.used)
    things = tuple(thing for one in step.captures for thing in one.things)
    used = reduce(lambda all_used, one: all_used | one.used, step.captures, step.used)
    trees = [one.place for one in step.captures if one.place is not None and _is_each_tree(one.place)]
    if trees and (len(trees) < len(step.captures) or any(place.shape != "area" for place in step.places)):
        raise _unclear(step.used)
    each = bool(trees) or any(one.place is not None and one.place.each for one in step.captures)
    made: list[LinkedCommand] = []
    for place in _visited(step):
        whole = replace(place, shape="several", each=True) if each and place.shape in ("several", "area") else place
        relation = "of" if whole.shape == "area" else "at"
        joint = step.joint if not made else Connective(True, True, 0)
        made.append(LinkedCommand(joint, replace(first, things=things, place=whole, used=used, relation=relation)))
    manners = [replace(one, before=_bare(one.before)) for one in step.manners]
    return [*made, *manners]


def _bare(joint: Connective | None) -> Connective:
    """Return the connective before what belongs to the command before it."""
    return Connective(False, False, 0 if joint is None else joint.used, bare=True)


def _visited(step: _Step) -> Sequence[PlaceMeaning]:
    """Return places that are visited one after the other; in any order they are one list."""
    places, shapes = step.places, {place.shape for place in step.places}
    again = len({place.selector for place in places}) < len(places)
    if len(places) < 2 or step.in_turn or again or shapes not in ({"one"}, {"area"}) or any(one.per for one in places):
        return places
    selector = s.UnionOf(parts=tuple(place.selector for place in places))
    tokens = reduce(lambda all_tokens, one: all_tokens | one.tokens, places, 0)
    count = len(places) if shapes == {"one"} else None
    return [PlaceMeaning(selector, "several" if count else "area", count=count, tokens=tokens)]
