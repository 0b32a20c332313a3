"""Constructions of driving speeds: "at 0.3 m/s", "no faster than 2 km/h between trees", "slowly", "at half speed"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount, DriveCommand, PaceClause, PlaceMeaning
from fieldhand.planning.grammar.words import Lex
from fieldhand.robot.model import RobotProfile

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Unit of speeds, as of :class:`Amount`.
_UNIT = "m_s"


@construction(
    "manner: word=AT speed=amount",
    "manner: speed=amount",
    "manner: word=AT DET speed=amount",
    "manner: word=AT [DET] SPEED OF speed=amount",
    "manner: WITH [DET] SPEED OF speed=amount",
    "manner: WITH speed=amount",
    "manner: [DET] SPEED [COMMA] [IS] speed=amount",
    "manner: [DET] SPEED IS AT speed=amount",
    cost=0.2,
)
def at_speed(speed: Amount, word: Lex | None = None) -> PaceClause | None:  # noqa: ARG001
    """Compose "at 0.3 m/s" and "at a speed of 2 km/h"."""
    return PaceClause(speed.number) if speed.unit == _UNIT and speed.number > 0.0 else None


@construction(
    "manner: [AT] less speed=amount",
    "manner: AT UPTO speed=amount",
    "manner: NOFASTER speed=amount",
    "manner: NOFASTER less speed=amount",
    "manner: [AT] speed=amount TOPS",
    "manner: speed=amount [COMMA] [AND] NOTMORE",
    "manner: WITHOUT GO check=CMP speed=amount",
    "manner: AT [DET] SPEED less speed=amount",
    "manner: [AT] [DET] SPEED [IS] less speed=amount",
    "manner: [AT] [DET] SPEEDLIMIT [IS] [OF] [COMMA] speed=amount",
    "manner: WITH [DET] SPEEDLIMIT OF speed=amount",
    "manner: [AT] [DET] SPEEDLIMIT [IS] AT speed=amount",
    "manner: [WITH] [DET] SPEED [MUST] LIMITEDTO speed=amount",
    "manner: LIMITEDTO speed=amount",
    cost=0.2,
)
def at_most_speed(speed: Amount, check: Lex | None = None) -> PaceClause | None:
    """Compose "no faster than 0.5 m/s" and "speed limit: 2 km/h"."""
    if check is not None and check.value[0] not in ("gt", "ge"):
        return None
    return PaceClause(speed.number, at_most=True) if speed.unit == _UNIT and speed.number > 0.0 else None


@construction(
    "manner: AT part=PART [OF] [DET] SPEED",
    "manner: AT [DET] part=PART SPEED",
    "manner: AT share=amount [OF] [DET] SPEED",
    cost=0.2,
    given=("robot",),
)
def at_part_of_speed(robot: RobotProfile, part: Lex | None = None, share: Amount | None = None) -> PaceClause | None:
    """Compose "at half speed" and "at 50 % of its speed"."""
    if share is not None and share.unit != "percent":
        return None
    of = part.value if part is not None else 0.0 if share is None else share.number / 100.0
    return PaceClause(round(of * robot.speed_m_s, 4), share=of) if 0.0 < of <= 1.0 else None


@construction("manner: FULLSPEED", cost=0.2, given=("robot",))
def at_full_speed(robot: RobotProfile) -> PaceClause:
    """Compose "at full speed"."""
    return PaceClause(robot.speed_m_s)


@construction("manner: SLOW", cost=0.2, given=("robot",))
def slowly(robot: RobotProfile) -> PaceClause:
    """Compose "slowly": as slow as the profile says, else the person is asked."""
    return PaceClause(robot.slow_m_s or 0.0, slowly=True)


@construction("pace: SLOWDOWN", cost=0.3, given=("robot",))
def slow_down(robot: RobotProfile, used: int) -> PaceClause:
    """Compose "slow down"."""
    return replace(slowly(robot), used=used)


@construction("pace: SLOWDOWN [COMMA] how=manner", "pace: SLOWDOWNTO speed=amount", cost=0.3)
def slow_down_to(used: int, how: PaceClause | None = None, speed: Amount | None = None) -> PaceClause | None:
    """Compose "slow down to 0.3 m/s"."""
    found = at_speed(speed) if speed is not None else how
    return None if found is None else replace(found, used=used)


@construction(
    "manner: EASY [COMMA] how=manner",
    "manner: SLOW [COMMA] how=manner",
    "manner: how=manner [COMMA] [AND] SLOW",
    cost=0.1,
)
def slowly_at(how: PaceClause) -> PaceClause | None:
    """Compose "slowly, at 0.3 m/s"."""
    return None if how.slowly else how


@construction("manner: how=manner BETWEEN TREE", "manner: how=manner BETWEEN [DET] STOPPLACE", cost=0.1)
def between_trees(how: PaceClause) -> PaceClause:
    """Compose "no faster than 0.5 m/s between trees", which is wherever the robot drives."""
    return how


@construction(
    "pace: how=manner",
    "pace: GO how=manner",
    "pace: DRIVEN how=manner",
    "pace: TAKE IT how=manner",
    "pace: TAKE [DET] ROW how=manner",
    "pace: KEEP how=manner",
    "pace: subject [MUST] GO how=manner",
    "pace: [MUST] GO how=manner",
    "pace: WITHOUT GO how=manner",
    "pace: how=manner [COMMA] WHOLETIME",
    "pace: GO how=manner [COMMA] WHOLETIME",
    cost=0.3,
)
def pace(how: PaceClause, used: int) -> PaceClause:
    """Compose "drive at 0.3 m/s"."""
    return replace(how, used=used)


@construction(
    "drive: GO how=manner [COMMA] [word=AT] place=place", "drive: GO how=manner [COMMA] ALONG place=place", cost=0.4
)
def drive_at_pace(how: PaceClause, place: PlaceMeaning, used: int, word: Lex | None = None) -> DriveCommand | None:
    """Compose "drive slowly to tree 4"."""
    if word is not None and "within" in word.features and place.shape in ("area", "several"):
        return None  # "drive slowly in row 3" says how it drives there
    drives = place.shape in ("one", "several", "area", "step")
    return DriveCommand(place, used, pace=replace(how, used=used)) if drives else None


@construction("drive: way=drive [COMMA] how=manner", cost=0.2)
def driven_at_pace(way: DriveCommand, how: PaceClause, used: int) -> DriveCommand | None:
    """Compose "drive to tree 4 at 0.3 m/s"."""
    return None if way.pace is not None else replace(way, used=used, pace=replace(how, used=used))
