"""Constructions of commands that repeat work of earlier missions: "measure again the 5 driest of last week"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.places.earlier.period import Period
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.earlier.periods import PastTime
from fieldhand.planning.grammar.earlier.work import OPEN_TIME
from fieldhand.planning.grammar.meaning import CaptureCommand, DriveCommand, PlaceMeaning, Said, Thing
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import swapped
from fieldhand.robot.model import RobotProfile

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "capture: MEASURE AGAIN place=place",
    "capture: REMEASURE place=place",
    "capture: MEASURE place=place AGAIN",
    cost=0.6,
    given=("robot",),
)
def measure_again(place: PlaceMeaning, used: int, robot: RobotProfile) -> list[CaptureCommand] | None:
    """Compose "measure again the 5 with the lowest soil moisture of last mission": what was read is read again."""
    parts = [part for part in place.selector.walk() if part.uses_records]
    read = {getattr(part, "quantity", "") or getattr(part, "measured", "") for part in parts} - {""}
    actions = [action.name for action in robot.actions if read & set(action.measures)]
    if len(read) != 1 or len(actions) != 1:
        return None
    return [CaptureCommand((Thing(actions[0]),), place, used)]


@construction(
    "capture: REMEASURE things=things relation=relation place=place",
    "capture: REMEASURE things=things place=place_where",
    cost=0.3,
)
def measure_again_there(
    things: tuple[Thing, ...], place: PlaceMeaning, used: int, relation: str = "at"
) -> CaptureCommand | None:
    """Compose "remeasure CO2 where it was high last week"."""
    return CaptureCommand(things, place, used, relation=relation) if selects_by_records(place) else None


@construction("capture: AGAIN [COMMA] act=capture", cost=0.4)
def again_there(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "again measure CO2 where it was high last week"."""
    return replace(act, used=used) if act.place is not None and selects_by_records(act.place) else None


@construction("drive: REVISIT place=place", cost=0.3)
def revisit(place: PlaceMeaning, used: int) -> DriveCommand | None:
    """Compose "revisit the trees that we missed yesterday"."""
    return DriveCommand(place, used) if selects_by_records(place) else None


@construction(
    "cut_short: when=PERIOD [COMMA] WHOSTOPPED HADTOSTOP", "cut_short: WHOSTOPPED HADTOSTOP when=PERIOD",
    "cut_short: when=PERIODPOSS WHOSTOPPED HADTOSTOP",
    cost=0.0,
)  # fmt: skip
def cut_short(when: Lex) -> PastTime:
    """Compose "yesterday you had to stop early", which tells of which mission something is still missing."""
    said: PastTime = when.value
    return said


@construction("said: when=cut_short FULLSTOP rest=said", "said: when=cut_short [COMMA] THEREFORE rest=said", cost=0.3)
def missing_from_that(when: PastTime, rest: Said, used: int) -> Said | None:
    """Compose "yesterday you had to stop early. Photograph the leeks that are still missing."."""
    last = Period(last_missions=1)
    for at, clause in enumerate(rest.clauses):
        command = clause.command
        if not isinstance(command, CaptureCommand) or command.place is None:
            continue
        selector = command.place.selector
        for part in selector.walk():
            if isinstance(part, s.DoneEarlier) and part.outcome == "left_out" and part.period == last:
                then = replace(part, action=part.action.removeprefix(OPEN_TIME), period=when.period)
                before = used & ~_used(rest)
                there = replace(command.place, selector=swapped(selector, part, then))
                found = replace(clause, command=replace(command, place=there, used=command.used | before))
                return Said((*rest.clauses[:at], found, *rest.clauses[at + 1 :]))
    return None


def _used(said: Said) -> int:
    """Return the tokens of commands and of what joins them."""
    used = 0
    for clause in said.clauses:
        used |= clause.command.used | (0 if clause.before is None else clause.before.used)
    return used


def selects_by_records(place: PlaceMeaning) -> bool:
    """Return True if a place depends on what earlier missions did."""
    return any(part.uses_records for part in place.selector.walk())
