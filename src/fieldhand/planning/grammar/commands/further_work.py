"""Constructions of ground that is worked like that before it: "mow the bank, then the meadow"."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.headings import work_on_the_way_back, work_towards
from fieldhand.planning.grammar.commands.parameters import with_parameter
from fieldhand.planning.grammar.commands.sides import worked_on_one_side
from fieldhand.planning.grammar.commands.working import Tract, along_tract, on_both_sides
from fieldhand.planning.grammar.meaning import (
    Allowed,
    Amount,
    Connective,
    LinkedCommand,
    ParameterValue,
    Said,
    Thing,
    WorkCommand,
)
from fieldhand.planning.grammar.words import Lex
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.nodes.work_along import RowSides
from fieldhand.terms import TreeSide

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class FurtherGround:
    """Ground that is worked like that before it.

    Attributes:
        where: The ground.
        order: Order that tells the direction, if it is said.
        side: Side of the rows, if it is said.
        both: True for both sides.
        how: Parameter, if one is said.
        back: True if it is worked on the way back.
    """

    where: Tract
    order: tuple[str, str, bool] | None = None
    side: TreeSide | None = None
    both: bool = False
    how: ParameterValue | None = None
    back: bool = False

    @property
    def is_plain(self) -> bool:
        """True for ground of which nothing else is said."""
        return self == FurtherGround(self.where)


@construction("further: where=tract", cost=0.2)
def further_ground(where: Tract) -> FurtherGround | None:
    """Compose "the meadow" and "as much of it as the battery allows" behind "mow the bank, then"."""
    return FurtherGround(where)


@construction(
    "further: one=further [COMMA] order=ordered", "further: one=further [COMMA] GO order=ordered",
    "further: one=further [COMMA] [AT] side=own_side", "further: one=further [COMMA] FROM side=own_side",
    "further: one=further [COMMA] [FROM] both=EACHSIDE",
    "further: one=further [COMMA] how=parameter", "further: one=further [COMMA] rate=work_rate",
    "further: one=further [COMMA] back=ONTHEWAY", "further: back=ONTHEWAY [COMMA] one=further",
    "further: back=TURNROUND [COMMA] [AND] one=further",
    cost=0.1,
)  # fmt: skip
def further_so(
    one: FurtherGround,
    order: tuple[str, str, bool] | None = None,
    side: TreeSide | None = None,
    both: Lex | None = None,
    how: ParameterValue | None = None,
    rate: Amount | None = None,
    back: Lex | None = None,
) -> FurtherGround | None:
    """Compose "row 5 from north to south" and "the onions on the way back"."""
    if rate is not None:
        how = ParameterValue(rate.number, rate.unit, ())
    if order is not None:
        return replace(one, order=order) if one.order is None else None
    if how is not None:
        return replace(one, how=how) if one.how is None else None
    if back is not None:
        return None if one.back else replace(one, back=True)
    return None if one.side is not None or one.both else replace(one, side=side, both=both is not None)


@construction("said: before=said joint=joint one=further", cost=0.3, given=("robot", "site"))
def worked_likewise(
    before: Said, joint: Connective, one: FurtherGround, used: int, robot: RobotProfile, site: Site
) -> list[Said] | None:
    """Compose "mow the bank, then the meadow"; "mow the bank and the meadow" is one ground."""
    last = before.clauses[-1].command
    if not isinstance(last, WorkCommand) or not last.action or last.along is None:
        return None
    if joint.first or joint.precedes or joint.purpose or (joint.full and not joint.then):
        return None
    in_turn = joint.then or joint.in_turn
    differs = (
        one.where.optional
        or not replace(one, how=None).is_plain
        or last.heading != "any"
        or last.sides != "one"
        or last.parameters
    )
    if not in_turn and not differs:
        return _worked_together(before, last, one, used, robot)
    own = used & ~joint.used
    for clause in before.clauses:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    plain = WorkCommand(last.action, None, "rows", own, parameters=last.parameters)
    found: list[Said] = []
    for parameters, sides in product(_parameters(last, one, robot), _sides(last, one)):
        for work in along_tract(replace(plain, parameters=parameters[1]), one.where, robot):
            if sides != "one" and work.sides != "one":
                continue  # "film the east side of bed 8 and the west side of bed 9"
            made = _as_said(replace(work, sides=sides) if sides != "one" else work, one, site)
            if made is None or (made.mode != last.mode and {made.mode, last.mode} <= {"rows", "aisles"}):
                continue
            earlier = replace(before.clauses[-1], command=replace(last, parameters=parameters[0]))
            found.append(Said((*before.clauses[:-1], earlier, LinkedCommand(replace(joint, then=True), made))))
    return found or None


@construction("said: before=said joint=joint case=allow [COMMA] one=further", cost=0.2, given=("robot", "site"))
def worked_if_it_fits(
    before: Said, joint: Connective, case: Allowed, one: FurtherGround, used: int, robot: RobotProfile, site: Site
) -> list[Said] | None:
    """Compose "mow the bank and, if there is time left, also the meadow"."""
    if one.where.optional:
        return None
    fits = LinkedCommand(replace(joint, both=True), case)
    found = worked_likewise(
        before, replace(joint, then=True, used=0), one, used & ~case.used & ~joint.used, robot, site
    )
    return [Said((*way.clauses[:-1], fits, replace(way.clauses[-1], before=None))) for way in found or []]


def _worked_together(
    before: Said, last: WorkCommand, one: FurtherGround, used: int, robot: RobotProfile
) -> list[Said] | None:
    """Return "spray row 3 and row 5 at 200 l/ha"; without the rate the rows are one ground anyway."""
    made = None if one.how is None else with_parameter(Thing(last.action), one.how, robot)
    if made is None or last.along is None or last.mode not in ("rows", "area") or one.where.along:
        return None
    both = s.UnionOf(parts=(*last.along.members, *one.where.selector.members))
    own = used
    for clause in before.clauses[:-1]:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    work = replace(last, along=both, parameters=made.parameters, used=own)
    return [Said((*before.clauses[:-1], replace(before.clauses[-1], command=work)))]


_Parameters = tuple[tuple[str, str | float], ...]


def _parameters(last: WorkCommand, one: FurtherGround, robot: RobotProfile) -> list[tuple[_Parameters, _Parameters]]:
    """Return the parameters that both works may have: those that are said of the second may be those of the first."""
    if one.how is None:
        return [(last.parameters, last.parameters)]
    made = with_parameter(Thing(last.action), one.how, robot)
    if made is None:
        return []
    own = made.parameters
    return [(last.parameters, own)] if last.parameters else [(own, own), ((), own)]


def _sides(last: WorkCommand, one: FurtherGround) -> list[RowSides]:
    """Return the sides of rows that the second work may have: those of the first, or none."""
    if one.side is not None or one.both or last.sides == "one" or last.mode != "rows":
        return ["one"]
    return [last.sides, "one"]


def _as_said(work: WorkCommand, one: FurtherGround, site: Site) -> WorkCommand | None:
    """Return work with the direction and the sides that are said."""
    made: WorkCommand | None = work
    if one.order is not None:
        made = work_towards(work, one.order, work.used, site)
    if made is not None and one.back:
        made = work_on_the_way_back(made, made.used)
    if made is not None and one.side is not None:
        made = worked_on_one_side(made, one.side, made.used, site)
    if made is not None and one.both:
        made = on_both_sides(made, made.used)
    return made
