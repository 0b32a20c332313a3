"""Constructions of ground that the robot cannot enter, beside which it stops: "at the pond", "go to the oak"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Clause
from fieldhand.planning.grammar.commands.parameters import with_parameter
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    THAT_GROUND,
    CaptureCommand,
    DriveCommand,
    Lead,
    ParameterValue,
    PlaceMeaning,
    Thing,
)
from fieldhand.planning.grammar.places.listed_spots import SpotList
from fieldhand.planning.grammar.places.sampling import is_keep_out
from fieldhand.planning.grammar.places.zone_sides import Sides, on_side
from fieldhand.planning.grammar.words import Lex
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "at_edge: word=AT [DET] zone=ZONE", "at_edge: word=OF [DET] zone=ZONE", cost=0.2, given=("site",),
)  # fmt: skip
def at_edge(word: Lex, zone: Lex, site: Site) -> s.Selector | None:
    """Compose "at the pond", at its edge; into it the robot cannot drive."""
    beside = "beside_it" in word.features and is_keep_out(s.InZone(zone=zone.value), site)
    return s.Transect(count=1, shape="edge", zone=zone.value) if beside else None


@construction(
    "part: where=at_edge",
    "part: place=zone_beside",
    "part: place=bearing_place",
    "part: place=adverbial_place",
    cost=0.1,
)
def edge_part(where: s.Selector | None = None, place: PlaceMeaning | None = None) -> Clause:
    """Compose "at the pond" of "read CO2 at the pond" and "next to the mast"."""
    return Clause("p", place=place or PlaceMeaning(where or s.Here(), "one"))


@construction("lead: where=at_edge", "lead: place=zone_beside", "lead: place=adverbial_place", cost=1.2)
def edge_lead(used: int, where: s.Selector | None = None, place: PlaceMeaning | None = None) -> Lead:
    """Compose "(CO2 at the trough,) then at the pond" and "next to the mast, ..."."""
    return Lead(place or PlaceMeaning(where or s.Here(), "one"), used)


@construction(
    "capture: AGAIN where=at_edge", "capture: AGAIN place=zone_beside", "capture: AGAIN place=bearing_place", cost=0.6
)
def again_at_edge(used: int, where: s.Selector | None = None, place: PlaceMeaning | None = None) -> CaptureCommand:
    """Compose "again at the pond" behind what is taken."""
    return CaptureCommand((Thing(LAST_THING),), place or PlaceMeaning(where or s.Here(), "one"), used)


@construction("spot_item: where=at_edge", "spot_item: place=zone_beside", cost=0.1)
def edge_item(where: s.Selector | None = None, place: PlaceMeaning | None = None) -> SpotList:
    """Compose "at the pond" and "next to the mast" of a list."""
    at = where or (s.Here() if place is None else place.selector)
    return SpotList((at,), (at,))


@construction("drive: verb=GO where=at_edge", "drive: verb=GO place=zone_beside", cost=1.2)
def drive_to_edge(
    verb: Lex, used: int, where: s.Selector | None = None, place: PlaceMeaning | None = None
) -> DriveCommand | None:
    """Compose "go to the pond" and "stop near the mast"; "begin at the pond" names what is near."""
    there = place or PlaceMeaning(where or s.Here(), "one")
    return None if "begins" in verb.features else DriveCommand(there, used)


@construction("capture: sides=seen_from", cost=2.0)
@construction("capture: word=DET how=parameter [sides=seen_from]", cost=1.2, given=("robot",))
def seen_again(
    used: int,
    word: Lex | None = None,
    how: ParameterValue | None = None,
    sides: Sides | None = None,
    robot: RobotProfile | None = None,
) -> list[CaptureCommand] | None:
    """Compose "(photograph the trunk of the oak from the south,) then its canopy from the north"."""
    things = [Thing(LAST_THING, count=1)]
    if robot is not None and how is not None:
        known = isinstance(how.value, str) and how.value and word is not None and "indefinite" not in word.features
        made = [with_parameter(Thing(action.name, count=1), how, robot) for action in robot.actions]
        things = [one for one in made if one is not None] if known else []
    if sides is None:
        return [CaptureCommand((one,), None, used) for one in things] or None
    if len(sides.named) != 1 or (side := sides.named[0].compass) is None:
        return None
    of_ground = PlaceMeaning(on_side(s.InZone(zone=THAT_GROUND), side), "one")
    of_tree = PlaceMeaning(s.Beside(side=side, of=s.InZone(zone=THAT_GROUND)), "one")
    return [CaptureCommand((one,), there, used) for one in things for there in (of_ground, of_tree)] or None
