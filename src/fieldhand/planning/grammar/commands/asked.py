"""Constructions of questions about an area that readings answer: "how wet is the meadow? Twelve spots should do."."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.parameters import with_parameter
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    UNSAID_THING,
    CaptureCommand,
    ParameterValue,
    PlaceMeaning,
    Thing,
)
from fieldhand.planning.grammar.places.sampling import bare_ground
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, is_one_row
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class AskedArea:
    """A question about an area, and the captures that answer it."""

    things: tuple[Thing, ...]
    where: s.Selector
    more: s.Selector | None = None


@dataclass(frozen=True, slots=True)
class Spots:
    """So many places spread over an area.

    Attributes:
        count: Number of places.
        how: Parameter of the captures.
        each: True if there are as many in each of several areas.
        random: True if they are drawn at random.
    """

    count: int
    how: ParameterValue | None = None
    each: bool = False
    random: bool = False


@construction(
    "asked: noun=ASKHOW IS where=region [ONAVERAGE]",
    "asked: noun=ASKHOW IS [DET] GROUND in_ where=region [ONAVERAGE]",
    "asked: noun=ASKHOW IS IT in_ where=region [ONAVERAGE]",
    cost=0.2,
)
def how_wet_is(noun: Lex, where: s.Selector) -> AskedArea | None:
    """Compose "how wet is the meadow on average"."""
    naming: Naming = noun.value
    return AskedArea((Thing(naming.actions[0]),), where) if naming.actions else None


@construction(
    "asked: [MEASURE] [DET] AVERAGEWORD things=things in_ where=region",
    "asked: [MEASURE] [DET] AVERAGEWORD things=things OF where=region",
    "asked: TELLRESULTS [DET] AVERAGEWORD things=things in_ where=region",
    "asked: TELLRESULTS [DET] AVERAGEWORD things=things OF where=region",
    "asked: MEASURE things=things in_ where=region ONAVERAGE",
    "asked: HOWMUCH things=things THEREIS in_ where=region",
    "asked: HOWMUCH things=things IS in_ where=region",
    "asked: WHATIS [DET] [AVERAGEWORD] things=things IS in_ where=region",
    "asked: COMPAREV [DET] [AVERAGEWORD] things=things in_ where=region",
    "asked: COMPAREV [DET] [AVERAGEWORD] things=things OF where=region",
    cost=0.2,
)
def what_is_the_mean(things: tuple[Thing, ...], where: s.Selector) -> AskedArea | None:
    """Compose "what is the average soil moisture in the slope"."""
    return AskedArea(things, where) if all(one.count in (None, 1) for one in things) else None


@construction(
    "asked: one=asked [COMMA] AND in_ more=region", "asked: one=asked [COMMA] AND OF more=region",
    "asked: one=asked [COMMA] AND more=region",
    cost=0.1,
)  # fmt: skip
def and_of_another(one: AskedArea, more: s.Selector) -> AskedArea | None:
    """Compose "what is the average soil moisture in the slope and in the wet corner"."""
    return replace(one, more=more) if one.more is None and one.where != more else None


@construction("spots: one=spots INEACH", cost=0.1)
def spots_in_each(one: Spots) -> Spots | None:
    """Compose "twelve spots in each"."""
    return None if one.each else replace(one, each=True)


@construction(
    "spots: [TAKE] n=count POINT", "spots: [TAKE] n=count TREE", "spots: [TAKE] n=count READING",
    "spots: [MEASURE] [AT] n=count POINT", "spots: [MEASURE] [AT] n=count TREE",
    "spots: [TAKE] n=count READING AT n2=count POINT",
    cost=0.1,
)  # fmt: skip
def so_many_spots(n: int, n2: int | None = None) -> Spots | None:
    """Compose "twelve spots"."""
    return Spots(n) if n2 in (None, n) and n > 1 else None


@construction("spots: [TAKE] [AT] n=count RANDOM POINT", "spots: [AT] n=count POINT RANDOM", cost=0.1)
def so_many_random_spots(n: int) -> Spots | None:
    """Compose "eight random points"."""
    return Spots(n, random=True) if n > 1 else None


@construction("spots: [TAKE] things=things", cost=0.3)
def so_many_readings(things: tuple[Thing, ...]) -> Spots | None:
    """Compose "twelve readings"."""
    known = len(things) == 1 and things[0].action in (LAST_THING, UNSAID_THING) and not things[0].parameters
    return Spots(things[0].count) if known and things[0].count is not None and things[0].count > 1 else None


@construction(
    "spots: one=spots [COMMA] EVENLYSPACED", "spots: one=spots [COMMA] SPREADOUT",
    "spots: one=spots [COMMA] SPREADHERE",
    "spots: one=spots [COMMA] how=parameter", "spots: one=spots [COMMA] [AND] REMAINS",
    "spots: one=spots [COMMA] TELLSUS",
    cost=0.1,
)  # fmt: skip
def spots_that(one: Spots, how: ParameterValue | None = None) -> Spots | None:
    """Compose "twelve spots spread out evenly, 10 cm deep, should tell us"."""
    if how is None:
        return one
    return replace(one, how=how) if one.how is None else None


@construction(
    "capture: asked=asked FULLSTOP spots=spots", "capture: asked=asked COMMA spots=spots",
    "capture: asked=asked [COMMA] OUTOFSPOTS spots=spots", cost=0.3,
    given=("site", "robot"),
)  # fmt: skip
def spots_tell(asked: AskedArea, spots: Spots, used: int, site: Site, robot: RobotProfile) -> CaptureCommand | None:
    """Compose "how wet is the meadow on average? Twelve spots spread out evenly should tell us."."""
    things = asked.things
    if spots.how is not None:
        made = tuple(with_parameter(one, spots.how, robot) for one in things)
        things = tuple(one for one in made if one is not None)
        if len(things) < len(made):
            return None
    areas = [asked.where] if asked.more is None else [asked.where, asked.more]
    if spots.each != (len(areas) > 1):
        return None
    parts = [_spread_over(where, spots.count, site, random=spots.random) for where in areas]
    if any(part is None for part in parts):
        return None
    kept = tuple(part for part in parts if part is not None)
    selector = kept[0] if len(kept) == 1 else s.UnionOf(parts=kept)
    return CaptureCommand(things, PlaceMeaning(selector, "several", count=spots.count * len(kept)), used)


def _spread_over(where: s.Selector, count: int, site: Site, *, random: bool) -> s.Selector | None:
    """Return so many places of an area; None if something is left out of ground that has no plants."""
    ground = bare_ground(where, site)
    if ground is not None:
        return None if ground.left_out else s.PointsIn(zone=ground.zone, count=count, random=random)
    if random:
        return s.RandomSample(count=count, of=where)
    if are_rows(where) and is_one_row(where):
        return s.Evenly(count=count, of=where)
    return s.Spread(count=count, of=where)
