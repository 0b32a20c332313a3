"""Constructions of where samples are brought: "take a leaf of each tree and bring them all to the shed door"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import takes_pictures
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    CaptureCommand,
    Connective,
    DriveCommand,
    Home,
    LinkedCommand,
    PlaceMeaning,
    Said,
)
from fieldhand.robot.model import RobotProfile

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "cargo: BRINGS CARGO [BRINGOFF]", "cargo: BRINGS BRINGOFF CARGO", "cargo: BRINGS [DET] NOUN [BRINGOFF]",
    "cargo: RETURN WITH CARGO", "cargo: GO WITH CARGO", "cargo: DROPSOFF",
    cost=0.1,
)  # fmt: skip
def cargo() -> str:
    """Compose "bring them all" and "drop it off" before the place."""
    return "brings"


@construction("brought: cargo BACKHERE", cost=0.1)
def brought_back(used: int) -> Home:
    """Compose "bring the samples back here"."""
    return Home(None, used)


@construction("brought: cargo [AT] marker=marker", "brought: cargo [AT] place=place", cost=0.2)
def brought_to(
    used: int, marker: s.Selector | None = None, place: PlaceMeaning | None = None
) -> Home | DriveCommand | None:
    """Compose "bring them all to the shed door"."""
    there = marker if place is None else place.selector if place.shape == "one" else None
    if there is None or there.relative:
        return None
    if there.named_marker in ("start", "end"):
        return Home("return_to_start" if there.named_marker == "start" else "return_to_end", used)
    return DriveCommand(PlaceMeaning(there, "one"), used, returns=True, ends=True)


@construction("said: before=said joint=joint way=brought", cost=0.2, given=("robot",))
def brought_in_the_end(before: Said, joint: Connective, way: Home | DriveCommand, robot: RobotProfile) -> Said | None:
    """Compose "... and bring them all to the shed door", behind samples that are taken."""
    things = [
        thing for one in before.clauses if isinstance(one.command, CaptureCommand) for thing in one.command.things
    ]
    actions = [robot.action[thing.action] for thing in things if thing.action in robot.action]
    samples = [one for one in actions if not one.measures and not takes_pictures(one) and one.implement is None]
    return Said((*before.clauses, LinkedCommand(joint, way))) if samples else None
