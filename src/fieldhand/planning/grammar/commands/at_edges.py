"""Constructions of ground that the robot cannot enter, beside which it stops: "at the pond", "go to the oak"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Clause
from fieldhand.planning.grammar.meaning import DriveCommand, PlaceMeaning
from fieldhand.planning.grammar.places.listed_spots import SpotList
from fieldhand.planning.grammar.places.sampling import is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "at_edge: word=AT [DET] zone=ZONE", "at_edge: word=OF [DET] zone=ZONE", "at_edge: word=BESIDE [DET] zone=ZONE",
    cost=0.2, given=("site",),
)  # fmt: skip
def at_edge(word: Lex, zone: Lex, site: Site) -> s.Selector | None:
    """Compose "at the pond", at its edge; into it the robot cannot drive."""
    beside = "beside_it" in word.features and is_keep_out(s.InZone(zone=zone.value), site)
    return s.Transect(count=1, shape="edge", zone=zone.value) if beside else None


@construction("part: where=at_edge", cost=0.1)
def edge_part(where: s.Selector) -> Clause:
    """Compose "at the pond" of "read CO2 at the pond"."""
    return Clause("p", place=PlaceMeaning(where, "one"))


@construction("spot_item: where=at_edge", cost=0.1)
def edge_item(where: s.Selector) -> SpotList:
    """Compose "at the pond" of a list."""
    return SpotList((where,), (where,))


@construction("drive: verb=GO where=at_edge", cost=1.2)
def drive_to_edge(verb: Lex, where: s.Selector, used: int) -> DriveCommand | None:
    """Compose "go to the pond"; "begin at the pond" names what is near."""
    return None if "begins" in verb.features else DriveCommand(PlaceMeaning(where, "one"), used)
