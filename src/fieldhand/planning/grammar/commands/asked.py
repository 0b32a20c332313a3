"""Constructions of questions about an area that readings answer: "how wet is the meadow? Twelve spots should do."."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

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
from fieldhand.planning.grammar.places.sampling import bare_ground, some_points
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_several_rows
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class AskedArea:
    """A question about some areas, and the captures that answer it."""

    things: tuple[Thing, ...]
    areas: tuple[s.Selector, ...]


@dataclass(frozen=True, slots=True)
class Spots:
    """So many places of an area.

    Attributes:
        count: Number of places.
        how: Parameter of the captures.
        each: True if there are as many in each of several areas.
        random: True if they are drawn at random.
        action: What is read there, if the phrase names it.
    """

    count: int
    how: ParameterValue | None = None
    each: bool = False
    random: bool = False
    action: str = ""


# Questions.


@construction("asked_of: where=region", "asked_of: where=rows", "asked_of: where=crop_area", cost=0.0)
def asked_of(where: s.Selector) -> tuple[s.Selector, ...]:
    """Compose "the slope" and "the tomatoes" of "the mean nitrate of"."""
    return where.members


@construction("asked_of: EACH OF where=rows", "asked_of: EACH where=rows", "asked_of: where=each_row", cost=0.0)
def asked_of_each(where: s.Selector) -> tuple[s.Selector, ...] | None:
    """Compose "each tomato row", each of which is asked about by itself."""
    return (where,) if are_several_rows(where) else None


@construction(
    "asked_of: first=asked_of [COMMA] AND [in_] more=asked_of", "asked_of: first=asked_of [COMMA] AND OF more=asked_of",
    "asked_of: first=asked_of COMMA [in_] more=asked_of",
    cost=0.1,
)  # fmt: skip
def and_of_another(first: tuple[s.Selector, ...], more: tuple[s.Selector, ...]) -> tuple[s.Selector, ...] | None:
    """Compose "the slope and in the wet corner"."""
    return None if {*first} & {*more} else (*first, *more)


@construction(
    "asked: noun=ASKHOW IS where=asked_of [ONAVERAGE]",
    "asked: noun=ASKHOW IS [DET] GROUND in_ where=asked_of [ONAVERAGE]",
    "asked: noun=ASKHOW IS IT in_ where=asked_of [ONAVERAGE]",
    cost=0.2,
)
def how_wet_is(noun: Lex, where: tuple[s.Selector, ...]) -> AskedArea | None:
    """Compose "how wet is the meadow on average"."""
    naming: Naming = noun.value
    return AskedArea((Thing(naming.actions[0]),), where) if naming.actions else None


@construction("capture: noun=ASKHOW IS IT way=relation place=place", "capture: noun=ASKHOW IS place=place", cost=0.6)
def how_wet_is_it(noun: Lex, place: PlaceMeaning, used: int, way: str = "at") -> CaptureCommand | None:
    """Compose "how dry is it on the slope?", of a reading there."""
    naming: Naming = noun.value
    known = place.shape in ("one", "several", "area") and not place.refers_back
    return CaptureCommand((Thing(naming.actions[0]),), place, used, relation=way) if known and naming.actions else None


@construction(
    "capture: noun=ASKHOW IS IT way=relation place=place ends=FULLSTOP how=parameter",
    "capture: noun=ASKHOW IS place=place ends=FULLSTOP how=parameter",
    cost=0.6,
    given=("robot",),
)
def how_wet_down_there(
    noun: Lex,
    place: PlaceMeaning,
    ends: Lex,
    how: ParameterValue,
    used: int,
    robot: RobotProfile,
    way: str = "at",
) -> CaptureCommand | None:
    """Compose "how wet is it at the trough? 15 cm deep."."""
    known = how_wet_is_it(noun, place, used, way) if "question" in ends.features else None
    thing = None if known is None else with_parameter(known.things[0], how, robot)
    return None if known is None or thing is None else replace(known, things=(thing,))


@construction("in_or_over: in_", "in_or_over: OVER", cost=0.0)
def in_or_over() -> str:
    """Compose "in" and "across" before what a question is about."""
    return "in"


@construction(
    "asked: [asking] [DET] AVERAGEWORD things=things in_or_over where=asked_of",
    "asked: [asking] things=things in_or_over where=asked_of ONAVERAGE",
    "asked: HOWMUCH things=things [ONAVERAGE] THEREIS in_ where=asked_of [ONAVERAGE]",
    "asked: HOWMUCH things=things IS in_ where=asked_of [ONAVERAGE]",
    "asked: HOWMUCH things=things in_ where=asked_of [ONAVERAGE]",
    "asked: HOWMUCH things=things ONAVERAGE in_ where=asked_of",
    "asked: WHATIS [DET] [AVERAGEWORD] things=things [IS] in_ where=asked_of [ONAVERAGE]",
    "asked: ASKMEAN [DET] [AVERAGEWORD] things=things in_ where=asked_of [ONAVERAGE]",
    cost=0.2,
)
def what_is_the_mean(things: tuple[Thing, ...], where: tuple[s.Selector, ...]) -> AskedArea | None:
    """Compose "what is the average soil moisture in the slope"."""
    return AskedArea(things, where) if all(one.count in (None, 1) for one in things) else None


@construction("asking: MEASURE", "asking: WHATIS", "asking: ASKMEAN", "asking: TELLME", "asking: HOWMUCH", cost=0.0)
def asking() -> str:
    """Compose "find out" before a mean."""
    return "what"


# Places that answer them.


@construction(
    "spots_by: TAKE", "spots_by: MEASURE [AT]", "spots_by: USE", "spots_by: FROM", "spots_by: BASEDON",
    "spots_by: WITH", "spots_by: TAKE [DET] AVERAGEWORD OF", "spots_by: OVER", "spots_by: AT",
    "spots_by: MEASURE IT [AT]",
    cost=0.0,
)  # fmt: skip
def spots_by() -> str:
    """Compose "use" and "based on" before so many readings."""
    return "by"


@construction("spots_noun: READING", "spots_noun: POINT", "spots_noun: TREE", "spots_noun: SAMPLINGPOINT", cost=0.0)
@construction("spots_noun: READING AT POINT", cost=0.0)
def spots_noun() -> str:
    """Compose "readings" and "spots"."""
    return "spots"


@construction(
    "spots: [spots_by] n=count [random=RANDOM] spots_noun",
    "spots: [spots_by] n=count spots_noun [COMMA] random=RANDOM",
    "spots: [spots_by] n=count READING AT [n2=count] random=RANDOM POINT",
    "spots: [spots_by] n=count READING AT n2=count POINT",
    cost=0.1,
)
def so_many_spots(n: int, n2: int | None = None, random: Lex | None = None) -> Spots | None:
    """Compose "twelve spots" and "based on eight random points"."""
    return Spots(n, random=random is not None) if n2 in (None, n) and n > 1 else None


@construction("spots: [TAKE] [AT] n=count RANDOM POINT", "spots: [AT] n=count POINT RANDOM", cost=0.1)
def so_many_random_spots(n: int) -> Spots | None:
    """Compose "eight random points"."""
    return Spots(n, random=True) if n > 1 else None


@construction("spots: [TAKE] things=things", cost=0.3)
def so_many_readings(things: tuple[Thing, ...]) -> Spots | None:
    """Compose "twelve readings" and "three moisture readings"."""
    known = len(things) == 1 and not things[0].parameters and not things[0].more
    action = things[0].action if known and things[0].action not in (LAST_THING, UNSAID_THING) else ""
    count = things[0].count or (0 if things[0].plural else 1)
    return Spots(count, action=action) if known and (count > 1 or (count == 1 and action)) else None


@construction("spots: one=spots INEACH", "spots: one=spots [AT] PER ROW", "spots: INEACH [COMMA] one=spots", cost=0.1)
def spots_in_each(one: Spots) -> Spots | None:
    """Compose "twelve spots in each" and "four readings per row"."""
    return None if one.each else replace(one, each=True)


@construction(
    "spots: one=spots [COMMA] EVENLYSPACED", "spots: one=spots [COMMA] SPREADOUT",
    "spots: one=spots [COMMA] SPREADHERE",
    "spots: one=spots THERE", "spots: one=spots [COMMA] how=parameter", "spots: one=spots [COMMA] [AND] REMAINS",
    "spots: one=spots [COMMA] SHOULDDO", "spots: one=spots [COMMA] ONAVERAGE",
    cost=0.1,
)  # fmt: skip
def spots_that(one: Spots, how: ParameterValue | None = None) -> Spots | None:
    """Compose "twelve spots spread out evenly, 10 cm deep, should tell us"."""
    if how is None:
        return one
    return replace(one, how=how) if one.how is None else None


@construction(
    "capture: asked=asked FULLSTOP spots=spots", "capture: asked=asked [COMMA] spots=spots", cost=0.3,
    given=("site", "robot"),
)  # fmt: skip
def spots_tell(
    asked: AskedArea, spots: Spots, used: int, site: Site, robot: RobotProfile
) -> list[CaptureCommand] | None:
    """Compose "how wet is the meadow on average? Twelve spots spread out evenly should tell us."."""
    things = asked.things
    if spots.action and [one.action for one in things] != [spots.action]:
        return None
    if spots.how is not None:
        made = tuple(with_parameter(one, spots.how, robot) for one in things)
        things = tuple(one for one in made if one is not None)
        if len(things) < len(made):
            return None
    several = len(asked.areas)
    if spots.each and several == 1 and not are_several_rows(asked.areas[0]):
        return None
    ways = [spots]
    if several > 1 and not spots.each:  # "four spots" of two areas: in each, or in all?
        ways += [] if spots.count % several else [replace(spots, count=spots.count // several)]
    places = [_readings(asked.areas, replace(way, each=spots.each or several > 1), site) for way in ways]
    return [CaptureCommand(things, place, used) for place in places if place is not None] or None


def _readings(areas: tuple[s.Selector, ...], spots: Spots, site: Site) -> PlaceMeaning | None:
    """Return so many places of each of some areas."""
    parts = [_places_of(where, spots, site) for where in areas]
    kept = tuple(part for part in parts if part is not None)
    if len(kept) < len(parts):
        return None
    number = None if any(are_several_rows(one) for one in areas) else spots.count * len(kept)
    selector = kept[0] if len(kept) == 1 else s.UnionOf(parts=kept)
    return PlaceMeaning(selector, "one" if number == 1 else "several", count=number, each=number is None)


@construction(
    "capture: things=things in_ where=asked_of ends=FULLSTOP spots=spots", cost=0.3, given=("site", "robot"),
)  # fmt: skip
def spots_tell_of_noun(
    things: tuple[Thing, ...],
    where: tuple[s.Selector, ...],
    ends: Lex,
    spots: Spots,
    used: int,
    site: Site,
    robot: RobotProfile,
) -> list[CaptureCommand] | None:
    """Compose "how warm is the air in the cool section? Four readings will do."."""
    if "question" not in ends.features or any(one.count not in (None, 1) for one in things):
        return None
    return spots_tell(AskedArea(things, where), spots, used, site, robot)


def _places_of(where: s.Selector, spots: Spots, site: Site) -> s.Selector | None:
    """Return so many places spread over an area; None if something is left out of ground that has no plants."""
    ground = bare_ground(where, site)
    if ground is not None and ground.left_out:
        return None
    if are_several_rows(where):
        how: Literal["random", "spread"] = "random" if spots.random else "spread"
        return s.Quota(per="row", count=spots.count, how=how, of=where) if spots.each else None
    return some_points(where, site, spots.count, random=spots.random)
