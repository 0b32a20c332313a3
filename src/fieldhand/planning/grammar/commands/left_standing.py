"""Constructions of ground and rows that work leaves out: "mow the meadow. Leave the orchids standing."."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar, tokens_of
from fieldhand.planning.grammar.meaning import CaptureCommand, Command, Connective, LinkedCommand, Said, WorkCommand
from fieldhand.planning.grammar.places.planted_rows import rows_out_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, as_excluding
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class LeftStanding:
    """Ground or rows that work leaves out.

    Attributes:
        where: The ground or rows.
        used: Tokens of the phrase.
        cut: True if the phrase is about something that is cut.
        action: Action that the phrase forbids there; empty for any.
    """

    where: s.Selector
    used: int
    cut: bool = False
    action: str = ""


@construction("spared: where=crop_area", cost=0.1, given=("site",))
def rows_spared(where: s.Selector, site: Site) -> s.Selector | None:
    """Compose "the beans" of "spray all beds but the beans", where their rows have no other plants."""
    return rows_out_of(where, site)


@construction("spared: where=region", "spared: where=rows", "spared: where=crop_area", cost=0.0)
def spared(where: s.Selector) -> s.Selector:
    """Compose "the wet corner" of "leave out the wet corner"."""
    return where


@construction(
    "spared: [DET] flag=FLAG ONE", "spared: ANY which_is flag=FLAG", "spared: word=DET [ONE] which_is flag=FLAG",
    "spared: ANY flag=FLAG ONE",
    cost=0.1, given=("site",),
)  # fmt: skip
def such_rows_spared(flag: Lex, site: Site, word: Lex | None = None) -> list[s.Selector] | None:
    """Compose "those that are covered" of "spray all beds except those that are covered"."""
    if word is not None and word.features.isdisjoint({"those", "definite"}):
        return None
    kinds = [s.Where(attribute=name, test="eq", value=value) for name, value in flag.value]
    rows = [rows_out_of(kind, site) for kind in kinds]
    return [row for row in rows if row is not None] or None


@construction(
    "spared: first=spared [COMMA] AND second=spared", "spared: first=spared COMMA second=spared",
    "spared: first=spared [COMMA] OR second=spared", "spared: first=spared [COMMA] NOR second=spared",
    cost=0.1,
)  # fmt: skip
def both_spared(first: s.Selector, second: s.Selector) -> s.Selector | None:
    """Compose "the wet corner or the slope" behind "do not mow"."""
    return s.UnionOf(parts=(*first.members, *second.members)) if are_rows(first) == are_rows(second) else None


@construction(
    "left_standing: LEAVE where=spared ALONE",
    "left_standing: LEAVE where=spared UNTOUCHED",
    "left_standing: LEAVE word=UNCUT where=spared",
    "left_standing: LEAVE where=spared word=UNCUT",
    "left_standing: LEAVEOUT where=spared",
    "left_standing: EXCEPT where=spared",
    "left_standing: but=BUT [NOT] where=spared",
    "left_standing: [BUT] NEITHER where=spared",
    "left_standing: WITHOUT where=spared",
    "left_standing: but=NOT where=spared",
    "left_standing: where=spared LEFTOUT",
    "left_standing: WITHOUT verb=WORKV where=spared",
    "left_standing: WITHOUT TOUCHING where=spared",
    cost=0.2,
)
def left_standing(
    where: s.Selector, used: int, word: Lex | None = None, verb: Lex | None = None, but: Lex | None = None
) -> LeftStanding | None:
    """Compose "leave the wet corner uncut", "skip row 5" and "don't mow the orchids"; not "but only row 5"."""
    tokens = tokens_of(used)
    if but is not None and len(tokens) < tokens[-1] - tokens[0] + 1:
        return None
    return LeftStanding(
        where,
        used,
        cut=word is not None and "of_any_work" not in word.features,
        action="" if verb is None else str(verb.value),
    )


@construction("said: before=said [joint] out=left_standing", cost=0.4, given=("robot",))
def spared_behind(before: Said, out: LeftStanding, robot: RobotProfile) -> list[Said] | None:
    """Compose "mow the meadow. Leave the wet corner standing.": of all that is mowed, or of the last one?"""
    done = [clause.command for clause in before.clauses if isinstance(clause.command, CaptureCommand | WorkCommand)]
    if not done or not isinstance(done[-1], WorkCommand):
        return None
    without = [_without(clause.command, out, robot) for clause in before.clauses]
    having = [number for number, one in enumerate(without) if one is not None]
    ways = {tuple(having), tuple(having[-1:])} if having else set()
    return [_with(before, without, numbers) for numbers in sorted(ways)]


@construction("said: out=left_standing joint=joint rest=said", cost=0.4, given=("robot",))
def spared_before(out: LeftStanding, joint: Connective, rest: Said, robot: RobotProfile) -> Said | None:
    """Compose "leave the wet corner standing and mow the rest of the meadow"."""
    if joint.then or joint.first:
        return None
    without = [_without(clause.command, out, robot) for clause in rest.clauses]
    having = [number for number, one in enumerate(without) if one is not None]
    return _with(rest, without, having) if having else None


def _with(said: Said, other: Sequence[WorkCommand | None], numbers: Sequence[int]) -> Said:
    """Return commands with others for those of some numbers."""
    clauses: list[LinkedCommand] = []
    for number, (clause, made) in enumerate(zip(said.clauses, other, strict=True)):
        clauses.append(replace(clause, command=made) if number in numbers and made is not None else clause)
    return Said(tuple(clauses))


def _without(command: Command, out: LeftStanding, robot: RobotProfile) -> WorkCommand | None:
    """Return work along what is left; None for another command, and for work that cannot leave it out."""
    if not isinstance(command, WorkCommand) or command.along is None or out.action not in ("", command.action):
        return None
    implement = robot.action[command.action].implement if command.action else None
    if out.cut and (implement is None or not implement.covers):
        return None
    if command.mode not in ("area", "rows") or are_rows(out.where) != (command.mode == "rows"):
        return None
    before = as_excluding(command.along)
    places = out.where if before is None else s.UnionOf(parts=(*before.places.members, *out.where.members))
    rest = s.Excluding(places=places, of=command.along if before is None else before.of)
    return replace(command, along=rest, used=command.used | out.used)
