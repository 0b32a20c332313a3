"""Constructions of exclusions that are clauses of their own: "leave out the yellow ones", "don't do row 3"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar, tokens_of
from fieldhand.planning.grammar.meaning import (
    THOSE_ROWS,
    CaptureCommand,
    Command,
    Connective,
    DriveCommand,
    Lead,
    Likewise,
    LinkedCommand,
    PlaceMeaning,
    Said,
)
from fieldhand.planning.grammar.places.exceptions import (
    both_out,
    drawn_from,
    each_of_kind,
    except_for,
    except_positions,
)
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.planted_rows import rows_out_of
from fieldhand.planning.grammar.places.points import outside_zones
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    are_rows,
    as_excluding,
    as_half,
    as_rows,
    as_zone,
    chooses_from_trees,
    named_places,
    over,
    swapped,
)
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class Excluded:
    """Places that other commands leave out.

    Attributes:
        place: The places; None if they are counted in the row of the command.
        positions: Ranges of trees of that row.
        actions: Actions that the phrase forbids there; empty if it forbids any.
        used: Tokens of the phrase.
        done: True if the phrase only tells that they were done, and others say which are left ("the remaining ones").
    """

    place: PlaceMeaning | None = None
    positions: tuple[tuple[int, int], ...] = ()
    actions: tuple[str, ...] = ()
    used: int = 0
    done: bool = False


@construction("kept_out: place=place", cost=0.0)
def place_kept_out(place: PlaceMeaning) -> Excluded | None:
    """Compose "the yellow trees" of "skip the yellow trees"."""
    known = place.shape in ("one", "several", "area") and place.per is None and not place.optional
    those = place.like is not None and place.like.kind == "those"
    return Excluded(place) if known and (those or not place.refers_back) else None


@construction(
    "kept_outs: first=kept_out COMMA second=kept_out", "kept_outs: first=kept_outs COMMA second=kept_out",
    "kept_out: first=kept_out [COMMA] OR second=kept_out", "kept_out: first=kept_out [COMMA] NOR second=kept_out",
    "kept_out: first=kept_outs [COMMA] OR second=kept_out", "kept_out: first=kept_outs [COMMA] NOR second=kept_out",
    cost=0.1,
)  # fmt: skip
def both_kept_out(first: Excluded, second: Excluded) -> Excluded | None:
    """Compose "the yellow trees or the old ones" of "don't do": both are left out."""
    both = None if first.place is None or second.place is None else both_out(first.place, second.place)
    return None if both is None else Excluded(both)


@construction("kept_out: first=kept_outs [COMMA] AND second=kept_out", cost=-0.3)
@construction("kept_out: first=kept_out AND second=kept_out", cost=0.1)
def all_kept_out(first: Excluded, second: Excluded) -> Excluded | None:
    """Compose "the carrots and bed 4" of "skip": each of them is left out."""
    return both_kept_out(first, second)


@construction("kept_out: out=kept_out ITSELF", cost=0.1)
def themselves_kept_out(out: Excluded) -> Excluded:
    """Compose "the sick ones themselves" of "not the sick ones themselves"."""
    return out


@construction("kept_out: in_ where=region", cost=0.2)
def area_kept_out(where: s.Selector) -> Excluded:
    """Compose "in the wet corner" of "..., except in the wet corner"."""
    return Excluded(PlaceMeaning(where, "area"))


@construction(
    "kept_out: at=row_ends", "kept_out: [DET] TREE AT at=row_ends", "kept_out: DET [ONE] AT at=row_ends", cost=0.2
)
def row_ends_kept_out(at: s.Selector) -> Excluded:
    """Compose "the plants at the row ends" of "not from the plants at the row ends"."""
    return Excluded(PlaceMeaning(at, "several"))


@construction("kept_out: [DET] value=ATTRVAL ONE", cost=0.2)
def kind_kept_out(value: Lex) -> list[Excluded]:
    """Compose "the yellow ones" of "skip the yellow ones"."""
    return [
        Excluded(PlaceMeaning(s.Where(attribute=name, test="eq", value=text), "several")) for name, text in value.value
    ]


@construction(
    "kept_out: [DET] flag=FLAG ONE", "kept_out: ANY flag=FLAG ONE", "kept_out: ANY which_is flag=FLAG",
    "kept_out: word=DET [ONE] which_is flag=FLAG",
    cost=0.2,
)  # fmt: skip
def such_kept_out(flag: Lex, word: Lex | None = None) -> list[Excluded] | None:
    """Compose "the covered ones" of "skip the covered ones", and "those that are covered"."""
    if word is not None and word.features.isdisjoint({"those", "definite"}):
        return None
    return [
        Excluded(PlaceMeaning(s.Where(attribute=name, test="eq", value=value), "several")) for name, value in flag.value
    ]


@construction("kept_out: out=left_out", cost=0.2)
def positions_kept_out(out: tuple[tuple[int, int], ...]) -> Excluded:
    """Compose "the first one" of "not the first one"."""
    return Excluded(positions=out)


@construction(
    "kept_out: ANY which_is [in_] where=region",
    "kept_out: ANY in_ where=region",
    "kept_out: word=DET which_is in_ where=region",
    cost=0.2,
)
def any_there_kept_out(where: s.Selector, word: Lex | None = None) -> Excluded | None:
    """Compose "any that lie in the wet corner" and "those lying in the wet corner"."""
    return Excluded(PlaceMeaning(where, "area")) if word is None or "those" in word.features else None


@construction(
    "excluded: LEAVEOUT out=kept_out [ATALL]",
    "excluded: but=EXCEPT out=kept_out",
    "excluded: LEAVE out=kept_out ALONE",
    "excluded: out=kept_out LEFTOUT",
    "excluded: word=NOT out=kept_out",
    "excluded: word=NOT OF out=kept_out",
    "excluded: word=NOT AT out=kept_out",
    "excluded: THOUGH word=NOT out=kept_out",
    "excluded: word=NOT out=kept_out [COMMA] THOUGH",
    "excluded: WITHOUT verb=ACTV out=kept_out",
    cost=0.2,
)
def excluded(
    out: Excluded, used: int, verb: Lex | None = None, word: Lex | None = None, but: Lex | None = None
) -> Excluded | None:
    """Compose "skip the yellow trees", "leave the Carmels be" and "tree 4 can be left out"."""
    tokens = tokens_of(used)
    if word is not None and len(tokens) < tokens[-1] - tokens[0] + 1:
        return None  # "not just tree 4"
    if (word or but) and out.place is not None and as_excluding(out.place.selector) is not None:
        return None  # "not bed 7 and not the Roma" leaves out both
    if out.place is not None and (word is not None or (but is not None and "not" in but.text.split())):
        out = replace(out, place=each_of_kind(out.place))
    if verb is None:
        return replace(out, used=used)
    naming: Naming = verb.value
    return replace(out, used=used, actions=naming.actions)


@construction("excluded: out=kept_out TOLDDONE", "excluded: TELLSDONE out=kept_out [TOLDWHEN]", cost=0.2)
def told_done(out: Excluded, used: int) -> Excluded:
    """Compose "rows 1 and 2 were done this morning" beside "photograph the remaining tomatoes"."""
    return replace(out, used=used, done=True)


@construction("excluded: WITHOUT one=capture", cost=0.3)
def not_captured(one: CaptureCommand, used: int) -> Excluded | None:
    """Compose "do not take pictures in row 3"."""
    out = None if one.place is None or one.times > 1 or one.spacing is not None else place_kept_out(one.place)
    return None if out is None else replace(out, used=used, actions=tuple(thing.action for thing in one.things))


@construction(
    "excluded: WITHOUT TAKE ANY noun=NOUN in_ out=kept_out",
    "excluded: WITHOUT TAKE ANY noun=NOUN out=kept_out",
    "excluded: WITHOUT ANY noun=NOUN in_ out=kept_out",
    cost=0.2,
)
def none_captured(noun: Lex, out: Excluded, used: int) -> Excluded | None:
    """Compose "don't take any pictures of the south block"."""
    naming: Naming = noun.value
    return replace(out, used=used, actions=naming.actions) if naming.actions else None


@construction("said: before=said [joint] out=excluded", cost=0.4, given=("site",))
def left_out_behind(before: Said, out: Excluded, site: Site) -> list[Said]:
    """Compose "photograph row 3. Skip the yellow ones.": of each command that has some, or of the last one?"""
    without = _each_without(before, out, site)
    having = [number for number, one in enumerate(without) if one is not None]
    if any(isinstance(clause.command, CaptureCommand) and clause.command.place is None for clause in before.clauses):
        having = having[-1:] if having == [0] else having
    ways = {tuple(having), tuple(having[-1:])} if having else set()
    return [_with(before, without, numbers) for numbers in sorted(ways)]


@construction("said: out=excluded joint=joint rest=said", cost=0.4, given=("site",))
def left_out_before(out: Excluded, joint: Connective, rest: Said, site: Site) -> Said | None:
    """Compose "skip the yellow trees. Photograph row 3.", of all commands that have some."""
    if joint.then or joint.first or any(_is_every_second(clause.command) for clause in rest.clauses):
        return None  # "skip row 3. Photograph every other row.": each of those that are left, or every second one?
    without = _each_without(rest, out, site, first=True)
    having = [number for number, one in enumerate(without) if one is not None]
    return _in_other_area(_with(rest, without, having), rest) if having else None


def _in_other_area(said: Said, before: Said) -> Said:
    """Return commands with the places that follow "in the other one" chosen there."""
    area, following = said.clauses[0].command, said.clauses[1:2]
    if not isinstance(area, Lead) or area == before.clauses[0].command or not following:
        return said
    inner = following[0].command
    if not isinstance(inner, CaptureCommand | Lead) or inner.place is None or area.place.shape != "area":
        return said
    if inner.place.shape not in ("one", "several") or not chooses_from_trees(inner.place.selector):
        return said
    place = replace(inner.place, selector=over(inner.place.selector, area.place.selector))
    merged = replace(inner, place=place, used=inner.used | area.used)
    return Said((LinkedCommand(said.clauses[0].before, merged), *said.clauses[2:]))


def _is_every_second(command: Command) -> bool:
    """Return True for a command at "every other" row or tree."""
    if not isinstance(command, CaptureCommand | Lead) or command.place is None:
        return False
    parts = (*command.place.selector.walk(), *(() if command.place.per is None else command.place.per.walk()))
    zones = [as_zone(one) for one in (() if command.place.per is None else command.place.per.members)]
    numbers = [int(number) for one in zones if one is not None and (number := one.zone.split()[-1]).isdigit()]
    if len(numbers) > 1 and {then - one for one, then in pairwise(numbers)} == {2}:
        return True  # beds that are areas with a number
    return any(getattr(one, "every", getattr(one, "nth", 1)) == 2 for one in parts)


def _each_without(
    said: Said, out: Excluded, site: Site, *, first: bool = False
) -> list[CaptureCommand | DriveCommand | Lead | None]:
    """Return commands without the places that are left out; None for those that have none of them.

    Where no command has such places, those of a description are left out of all of them.
    """
    found = [_without(clause.command, out, site, first=first) for clause in said.clauses]
    named = out.place is None or out.done or any(one.named_tree or as_rows(one) for one in out.place.selector.walk())
    if (
        named
        or (out.place is not None and len(out.place.selector.members) > 1)
        or any(one is not None for one in found)
    ):
        return found
    return [_without(clause.command, out, site, first=first, some=False) for clause in said.clauses]


def _with(said: Said, other: Sequence[CaptureCommand | DriveCommand | Lead | None], numbers: Sequence[int]) -> Said:
    """Return commands with others for those of some numbers."""
    clauses = tuple(
        replace(clause, command=made) if number in numbers and made is not None else clause
        for number, (clause, made) in enumerate(zip(said.clauses, other, strict=True))
    )
    return Said(clauses)


def _without(
    command: object, out: Excluded, site: Site, *, first: bool = False, some: bool = True
) -> CaptureCommand | DriveCommand | Lead | None:
    """Return a command at its places but those that are left out; None if it has none of them, or no others.

    Args:
        command: Command.
        out: What is left out.
        site: Site.
        first: True if this was said before the command, which then may choose among the others.
        some: False to leave them out even if there are none.
    """
    if not isinstance(command, CaptureCommand | DriveCommand | Lead) or command.place is None:
        return None
    if isinstance(command, DriveCommand) and command.place.per is None:
        return None  # of drives, only "choose two plants in each bed" leaves some out
    things = () if isinstance(command, DriveCommand) else command.things
    if out.actions and not (things and all(one.action in out.actions for one in things)):
        return None
    whole, used = command.place, command.used | out.used
    if (first or out.done) and (rest := _others(whole, out, site)) is not None:
        return replace(command, place=rest, used=used)
    if out.done:
        return None
    if out.place is None:
        left = except_positions(whole, out.positions)
        return None if left is None else replace(command, place=left[0], used=used)
    if whole.per is not None and (rows := rows_out_of(out.place.selector, site)) is not None:
        per = s.Excluding(places=rows, of=whole.per)  # "a reading in each bed. Leave out the covered ones."
        return replace(command, place=replace(whole, per=per), used=used)
    if (points := outside_zones(whole, out.place.selector)) is not None:
        return replace(command, place=points, used=used)
    drawn = drawn_from(whole.selector) if whole.per is None else None
    among, left_out = ids_of(drawn or whole.selector, site), ids_of(out.place.selector, site)
    if any(part.uses_records for part in out.place.selector.walk()):
        left_out, among, some = set(), among or set(), False  # what was done before may be known later only
    if among is None or left_out is None or (some and not among & left_out):
        return None
    if some and not all((ids_of(part, site) or among) & among for part in out.place.selector.members):
        return None
    if first and whole.count is not None and (chosen := getattr(whole.selector, "of", None)) is not None:
        others = s.Excluding(places=out.place.selector, of=chosen)  # "the three oldest trees" of those that are left
        return replace(command, place=replace(whole, selector=swapped(whole.selector, chosen, others)), used=used)
    if named_places(whole.selector):
        whole = replace(whole, count=None)
    rest = except_for(whole, out.place, site) if not among <= left_out or not left_out else None
    if rest is None:
        return None
    shape = (
        "several" if rest.shape == "area" and rest.per is None else rest.shape
    )  # all but those, not one of the others
    return replace(command, place=replace(rest, shape=shape), used=used)


def left_out_of(command: CaptureCommand | Lead, out: Excluded, site: Site) -> CaptureCommand | Lead | None:
    """Return a command at its places but those that are left out; None if it has none of them, or no others."""
    left = _without(command, out, site)
    return None if isinstance(left, DriveCommand) else left


def _others(whole: PlaceMeaning, out: Excluded, site: Site) -> PlaceMeaning | None:
    """Return "the other trees" and "the other block" as those that are not left out; None for other places."""
    rows_out = None if out.place is None else rows_out_of(out.place.selector, site) or out.place.selector
    if rows_out is not None and are_rows(rows_out):  # "two plants in each of the others"
        per = None if whole.per is None else swapped(whole.per, THOSE_ROWS, rows_out)
        left = replace(whole, selector=swapped(whole.selector, THOSE_ROWS, rows_out), per=per)
        if left != whole:
            return left
    if out.place is not None and isinstance(whole.selector, s.NotVisited):
        return replace(whole, selector=s.Excluding(places=out.place.selector, of=whole.selector.of))
    if whole.like is None or out.place is None or whole.like.side or whole.like.kind not in ("", "rest", "half"):
        return None
    part = out.place.selector
    unsaid = whole.like.kind == "rest" and whole.each and whole.selector == s.Trees()
    if unsaid and rows_out is not None and are_rows(rows_out):
        return None  # "leave out the covered beds, and two pictures of each of the others": of each plant, or bed?
    if whole.like.kind == "rest":
        return replace(whole, like=None, selector=s.Excluding(places=part, of=whole.selector))
    if whole.shape != "area":
        return None
    if isinstance(part, s.InBlock) and part.of == s.Trees():
        others = [block.name for block in site.planting.blocks if block.name != part.block]
        return replace(whole, like=None, selector=replace(part, block=others[0])) if len(others) == 1 else None
    return replace(whole, like=None, selector=s.Excluding(places=part)) if as_half(part) is not None else None


@construction("place: DET OTHER noun=ONE", cost=0.6)
def the_other_one(noun: Lex) -> PlaceMeaning | None:
    """Compose "the other one", of an area."""
    return None if "plural" in noun.features else PlaceMeaning(s.Trees(), "area", like=Likewise(""))
