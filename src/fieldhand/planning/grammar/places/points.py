"""Constructions of free points: "twelve spots in the paddock, spread out evenly", "random points on the slope".

The words around the noun each add one thing, in any order; where no plants grow, the site is an area as well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import THAT_GROUND, PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import OPEN_NUMBER, as_zone
from fieldhand.site.model import Site
from fieldhand.terms import AreaPart

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class Ground:
    """A zone, or the whole site, and the half or quarter of it that is meant."""

    zone: str = ""
    part: AreaPart = "all"


@dataclass(frozen=True, slots=True)
class Points:
    """Free points.

    Attributes:
        count: Number, if it is given.
        random: True if they are drawn at random.
        even: True if they are spread evenly.
        where: Where they are, if it is said.
        plural: True for a noun in the plural.
    """

    count: int | None = None
    random: bool = False
    even: bool = False
    where: Ground | None = None
    plural: bool = True


# Where they are.


@construction("ground: [DET] zone=ZONE", cost=0.0)
def ground_of_zone(zone: Lex) -> Ground:
    """Compose "the slope"."""
    return Ground(zone.value)


@construction("ground: WHOLEOF whole=ground", cost=0.1)
def whole_ground(whole: Ground) -> Ground | None:
    """Compose "the whole of the slope"."""
    return whole if whole.part == "all" else None


@construction("ground: site", cost=0.4, given=("site",))
def ground_of_site(site: Site) -> Ground | None:
    """Compose "the meadow", where no plants grow."""
    return None if site.trees else Ground()


@construction(
    "ground: [DET] side=DIR HALF OF whole=ground", "ground: [DET] side=DIR HALF in_ whole=ground",
    "ground: [DET] side=DIR SIDE OF whole=ground", "ground: [DET] side=DIR QUARTER OF whole=ground",
    "ground: [DET] side=DIR QUARTER in_ whole=ground", "ground: [DET] side=DIR OF whole=ground",
    cost=0.1,
)  # fmt: skip
def part_of_ground(side: Lex, whole: Ground) -> Ground | None:
    """Compose "the northern half of the slope"."""
    return replace(whole, part=side.value) if whole.part == "all" and side.value in (*SIDES, *CORNERS) else None


@construction("ground: [DET] side=DIR HALF", "ground: [DET] side=DIR QUARTER", cost=0.3, given=("site",))
def part_of_site(side: Lex, site: Site) -> Ground | None:
    """Compose "the northern half" of a site without plants."""
    return None if site.trees else Ground("", side.value)


# The words around the noun.


@construction("points: noun=POINT", "points: noun=SAMPLINGPOINT", cost=0.0)
def points(noun: Lex) -> Points:
    """Compose "spots"."""
    return Points(plural=noun.text.endswith("s"))


@construction("points: n=count points=points", cost=0.0)
def so_many(n: int, points: Points) -> Points | None:
    """Compose "twelve spots"."""
    return replace(points, count=n) if points.count is None else None


@construction("points: word=DET points=points", cost=0.1)
def definite(word: Lex, points: Points) -> Points | None:
    """Compose "some random spots" and "those twelve spots"."""
    return points if points.count is not None or "vague" in word.features else None


@construction("points: RANDOM points=points", "points: points=points [COMMA] RANDOM", cost=0.0)
def at_random(points: Points) -> Points | None:
    """Compose "random spots" and "spots drawn at random"."""
    return None if points.random or points.even else replace(points, random=True)


@construction(
    "points: EVENLYSPACED points=points", "points: FARAPART points=points",
    "points: points=points [COMMA] EVENLYSPACED", "points: points=points [COMMA] FARAPART",
    "points: points=points [COMMA] SPREADOUT",
    cost=0.0,
)  # fmt: skip
def spread_out(points: Points) -> Points | None:
    """Compose "evenly spread spots" and "spots, spread out evenly"."""
    return None if points.random or points.even else replace(points, even=True)


@construction(
    "points: points=points [COMMA] in_ where=ground", "points: points=points [COMMA] OVER where=ground",
    "points: points=points [COMMA] SPREAD where=ground", "points: points=points EVENLYALONG where=ground",
    "points: points=points OPPOSITE where=ground", "points: points=points ALONG where=ground",
    "points: points=points there=THERE", "points: points=points in_ there=IT", "points: points=points OVER there=IT",
    cost=0.0,
)  # fmt: skip
def somewhere(points: Points, where: Ground | None = None, there: Lex | None = None) -> Points | None:
    """Compose "spots all over the slope" and "six spots there"."""
    if points.where is not None or (there is not None and "of_several" in there.features):
        return None
    return replace(points, where=where or Ground(THAT_GROUND))


@construction("place: ITS MIDDLE", "place: [DET] MIDDLE OF IT", cost=0.2)
def its_middle() -> PlaceMeaning:
    """Compose "its middle", of the zone or the row that was spoken of."""
    return PlaceMeaning(s.Middle(of=s.InZone(zone=THAT_GROUND)), "one")


@construction("points: where=ground [COMMA] word=AT points=points", cost=0.2)
def at_points_there(where: Ground, points: Points, word: Lex) -> Points | None:
    """Compose "(on) the slope at four evenly spread points"."""
    known = points.where is None and points.count is not None and "motion" not in word.features
    return replace(points, where=where) if known else None


# Places.


@construction("place: points=points", cost=0.3)
def as_places(points: Points) -> PlaceMeaning | None:
    """Compose "twelve random spots in the paddock"."""
    if points.where is None:
        return None
    if points.count is None:  # "at random places on the slope until ...": something else says how many
        made = s.PointsIn(zone=points.where.zone, count=OPEN_NUMBER, random=points.random, part=points.where.part)
        return PlaceMeaning(made, "several") if points.plural else None
    return points_on(points.where, points.count, random=points.random)


@construction(
    "place: points=points in_ EACH QUARTER OF where=ground", "place: points=points in_ EACH QUARTER in_ where=ground",
    "place: points=points in_ EACH QUARTER",
    cost=0.2, given=("site",),
)  # fmt: skip
def points_in_each_quarter(points: Points, site: Site, where: Ground | None = None) -> PlaceMeaning | None:
    """Compose "one random point in each quarter of the meadow"."""
    whole = where or (None if site.trees else Ground())
    if whole is None or whole.part != "all" or points.where is not None or not points.count:
        return None
    parts = [points_on(replace(whole, part=part), points.count, random=points.random).selector for part in CORNERS]
    return PlaceMeaning(s.UnionOf(parts=tuple(parts)), "several", count=points.count * len(parts), each=True)


@construction(
    "place: first=points [COMMA] AND n=count in_ where=ground", "place: first=points [COMMA] AND then=points", cost=0.2
)
def and_as_many_elsewhere(
    first: Points, n: int = 0, where: Ground | None = None, then: Points | None = None
) -> PlaceMeaning | None:
    """Compose "four random spots in the warm section and four in the cool section"."""
    second = Points(n, random=first.random, where=where) if then is None else then
    if first.count is None or second.count is None or first.where is None or second.where is None:
        return None
    parts = [points_on(one.where, one.count, random=one.random) for one in (first, second) if one.where and one.count]
    both = s.UnionOf(parts=tuple(one.selector for one in parts))
    return PlaceMeaning(both, "several", count=first.count + second.count)


def points_on(where: Ground, count: int, *, random: bool = False) -> PlaceMeaning:
    """Return so many points of a zone, of the site, or of a half or quarter of it."""
    made = s.PointsIn(zone=where.zone, count=count, random=random, part=where.part)
    return PlaceMeaning(made, "one" if count == 1 else "several", count=count)


def outside_zones(whole: PlaceMeaning, part: s.Selector) -> PlaceMeaning | None:
    """Return the points of a grid outside of zones; None for other places, whose number would not be kept."""
    zones = [as_zone(one) for one in part.members]
    inner = whole.selector
    while (zone := as_zone(inner)) is not None and zone.outside:
        inner = zone.of
    if not isinstance(inner, s.Grid) or whole.count is not None:
        return None
    made = whole.selector
    for zone in zones:
        if zone is None or zone.of != s.Trees():
            return None
        made = s.InZone(zone=zone.zone, outside=not zone.outside, margin_m=zone.margin_m, of=made)
    return replace(whole, selector=made, shape="several")
