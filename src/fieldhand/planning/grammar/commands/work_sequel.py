"""Constructions that go on with work: "then one of bed 8" behind "a video of bed 3", "starting from the gate"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.working import Tract, along_tract, work
from fieldhand.planning.grammar.meaning import (
    CaptureCommand,
    Connective,
    DriveCommand,
    LinkedCommand,
    PlaceMeaning,
    Said,
    WorkCommand,
)
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import is_gate
from fieldhand.robot.model import RobotProfile

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "one_more: ONE [MORE] [OF] where=tract",
    "one_more: ANOTHER [ONE] [OF] where=tract",
    "one_more: DET rank=ORD [ONE] [OF] where=tract",
    cost=0.2,
)
def one_more(where: Tract, rank: Lex | None = None) -> Tract | None:
    """Compose "one of the beetroot bed" and "another along bed 8"."""
    return where if rank is None or rank.value == 2 else None


@construction("said: before=said joint=joint where=one_more", cost=0.2, given=("robot",))
def same_work_there(before: Said, joint: Connective, where: Tract, used: int, robot: RobotProfile) -> list[Said] | None:
    """Compose "a video of the carrot bed, then one of the beetroot bed"."""
    last = before.clauses[-1].command
    if not isinstance(last, WorkCommand) or not last.action or last.along is None or last.laps > 1:
        return None
    own = used & ~joint.used
    for clause in before.clauses:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    once = WorkCommand(action=last.action, along=None, mode="rows", used=own, parameters=last.parameters)
    return [Said((*before.clauses, LinkedCommand(joint, one))) for one in along_tract(once, where, robot)]


@construction("drive_and_work: BEGINS verb=work_name [OF] where=tract AT place=place", cost=0.2, given=("robot",))
def begun_at(
    verb: Lex, where: Tract, place: PlaceMeaning, used: int, robot: RobotProfile
) -> list[tuple[DriveCommand, WorkCommand]] | None:
    """Compose "start mowing the meadow at the gate"."""
    way = work_start(place, place.tokens)
    made = work(verb, used & ~place.tokens, robot, where)
    return None if way is None or made is None else [(way, one) for one in made]


@construction("said: one=work FIRSTONE", cost=0.2)
def worked_first(one: WorkCommand, used: int) -> Said | None:
    """Compose "mow the slope first"."""
    return None if one.along is None else Said((LinkedCommand(None, replace(one, used=used)),))


@construction("said: both=drive_and_work", cost=0.1)
def begun_first(both: tuple[DriveCommand, WorkCommand]) -> Said:
    """Compose "start mowing the meadow at the gate" at the beginning of a request."""
    return Said((LinkedCommand(None, both[0]), LinkedCommand(Connective(False, True, 0), both[1])))


@construction(
    "work_start: STARTING [AT] place=place", "work_start: GOING STARTING place=place", cost=0.2,
)  # fmt: skip
def work_start(place: PlaceMeaning, used: int) -> DriveCommand | None:
    """Compose "starting from the gate"; a gate or a marker is a single spot."""
    spot = is_gate(place.selector) or bool(place.selector.named_marker)
    return DriveCommand(place, used) if place.shape == "one" and spot else None


@construction("said: before=said [COMMA] [AND] way=work_start", cost=0.3)
def started_there(before: Said, way: DriveCommand) -> Said | None:
    """Compose "patrol the edge of the paddock, starting from the gate": it goes there first."""
    *others, last = before.clauses
    if not isinstance(last.command, WorkCommand) or last.command.along is None:
        return None
    if any(isinstance(one.command, CaptureCommand) for one in others):
        return None  # all of it may begin there
    follows = replace(last, before=Connective(False, True, 0))
    return Said((*others, LinkedCommand(last.before, way), follows))
