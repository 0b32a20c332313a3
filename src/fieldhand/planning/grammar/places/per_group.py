"""Constructions of so many places in each of several beds or zones: "both beds, four spots in each, spread out"."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.points import Points
from fieldhand.planning.grammar.places.sampling import bare_points
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, as_where, as_zone, is_one_row
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class SoManyEach:
    """A number of places in each of several areas.

    Attributes:
        count: The number.
        random: True if they are drawn at random, else they are spread.
        of_rows: True if the phrase says that it is of each row.
    """

    count: int
    random: bool = False
    of_rows: bool = False

    @property
    def how(self) -> Literal["spread", "random"]:
        """The way in which they are chosen."""
        return "random" if self.random else "spread"


@construction("evenly_there: EVENLYSPACED", "evenly_there: SPREADOUT", "evenly_there: FARAPART", cost=0.0)
def evenly_there() -> str:
    """Compose "nicely spread out"."""
    return "evenly"


@construction("spots_there: TREE", "spots_there: POINT", "spots_there: SAMPLINGPOINT", cost=0.0)
def spots_there() -> str:
    """Compose "spots" of "four spots in each"."""
    return "spots"


@construction(
    "in_each: n=count spots_there INEACH [COMMA] [evenly_there]",
    "in_each: n=count evenly_there spots_there INEACH",
    "in_each: n=count INEACH [COMMA] evenly_there",
    "in_each: n=count READING INEACH [COMMA] [evenly_there]",
    "in_each: n=count evenly_there READING INEACH",
    cost=0.0,
)
def so_many_in_each(n: int) -> SoManyEach:
    """Compose "four spots in each, nicely spread out"."""
    return SoManyEach(n)


@construction("in_each: n=count spots_there in_ EACH [OF] ROW [COMMA] [evenly_there]", cost=0.0)
def so_many_in_each_bed(n: int) -> SoManyEach:
    """Compose "three places in each bed"."""
    return SoManyEach(n, of_rows=True)


@construction(
    "in_each: points=points INEACH", "in_each: n=count random=RANDOM [noun=TREE] INEACH",
    "in_each: n=count [noun=TREE] INEACH [COMMA] random=RANDOM",
    "in_each: n=count READING INEACH [COMMA] AT random=RANDOM POINT",
    "in_each: INEACH AT points=points", cost=0.0,
)  # fmt: skip
def points_in_each(
    points: Points | None = None, n: int = 0, random: Lex | None = None, noun: Lex | None = None
) -> SoManyEach | None:
    """Compose "four random places each"."""
    del random, noun
    if points is None:
        return SoManyEach(n, random=True) if n else None
    return None if points.count is None or points.where is not None else SoManyEach(points.count, points.random)


@construction("in_each: AT share=in_each", "in_each: [TAKE] share=in_each", cost=0.0)
def at_so_many_in_each(share: SoManyEach) -> SoManyEach:
    """Compose "at four spots in each"."""
    return share


@construction(
    "place: rows=rows [COMMA] n=in_each", "place: rows=each_row [COMMA] n=in_each",
    "place: rows=rows AND [in_] more=rows [COMMA] n=in_each",
    cost=0.1,
)  # fmt: skip
def of_rows_so_many_each(rows: s.Selector, n: SoManyEach, more: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "both cabbage beds, four spots in each"."""
    if more is not None:
        rows = s.UnionOf(parts=(*rows.members, *more.members))
    return _of_each_row(n.count, rows, n.how)


@construction(
    "place: of=crop_area [COMMA] n=in_each", "place: of=crop_area AND [in_] more=crop_area [COMMA] n=in_each", cost=0.1
)
def of_crops_so_many_each(of: s.Selector, n: SoManyEach, more: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "the leeks and the onions, three plants of each", which are of each crop; of one, of each of its beds."""
    plants = of if more is None else s.UnionOf(parts=(*of.members, *more.members))
    kinds = [as_where(one) for one in plants.members]
    if n.of_rows or len(kinds) < 2:
        return PlaceMeaning(s.Quota(per="row", count=n.count, how=n.how, of=plants), "several")
    named = {one.attribute for one in kinds if one is not None and one.of == s.Trees()}
    if None in kinds or len(named) != 1:
        return None
    return PlaceMeaning(s.Quota(per=named.pop(), count=n.count, how=n.how, of=plants), "several")


@construction(
    "place: n=count evenly_there spots_there in_ rows=each_row",
    "place: n=count spots_there in_ rows=each_row [COMMA] evenly_there",
    "place: n=count spots_there [COMMA] evenly_there [COMMA] in_ rows=each_row",
    cost=0.1,
)
def evenly_in_each_row(n: int, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "four evenly spread plants in each cabbage bed"."""
    return _of_each_row(n, rows)


@construction("place: n=count POINT in_ rows=each_row", cost=0.2)
def points_in_each_row(n: int, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "four spots in each cabbage bed"."""
    return _of_each_row(n, rows)


def _of_each_row(n: int, rows: s.Selector, how: Literal["spread", "random"] = "spread") -> PlaceMeaning | None:
    """Return so many plants of each of some rows, spread along it."""
    if not are_rows(rows) or is_one_row(rows):
        return None
    return PlaceMeaning(s.Quota(per="row", count=n, how=how, of=rows), "several")


@construction(
    "grounds: first=region AND [in_] then=region", "grounds: first=region COMMA AND [in_] then=region", cost=0.0
)
def grounds(first: s.Selector, then: s.Selector) -> tuple[s.Selector, ...] | None:
    """Compose "the wet corner and on the slope"."""
    both = (*first.members, *then.members)
    return both if all(as_zone(one) is not None for one in both) and first != then else None


@construction("grounds: first=region COMMA rest=grounds", cost=0.0)
def more_grounds(first: s.Selector, rest: tuple[s.Selector, ...]) -> tuple[s.Selector, ...] | None:
    """Compose "the wet corner, the bank and on the slope"."""
    return (first, *rest) if as_zone(first) is not None and first not in rest else None


@construction(
    "place: areas=grounds [COMMA] n=in_each", "place: areas=grounds [COMMA] [AT] count=count READING INEACH",
    "place: n=in_each in_ areas=grounds", "place: points=points in_ EACH areas=grounds",
    "place: points=points BETWEEN areas=grounds INEACH",
    cost=0.1, given=("site",),
)  # fmt: skip
def of_grounds_so_many_each(
    areas: tuple[s.Selector, ...], site: Site, n: SoManyEach | None = None, count: int = 0, points: Points | None = None
) -> PlaceMeaning | None:
    """Compose "the wet corner and on the slope, four spots in each"."""
    if points is not None:
        n = None if points.count is None or points.where is not None else SoManyEach(points.count, points.random)
        if n is None:
            return None
    each = SoManyEach(count) if n is None else n
    parts = tuple(_some_of(one, each, site) for one in areas)
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=each.count * len(parts))


def _some_of(area: s.Selector, each: SoManyEach, site: Site) -> s.Selector:
    """Return so many places of an area."""
    points = bare_points(area, site, each.count, random=each.random)
    if points is not None:
        return points
    if each.random:
        return s.RandomSample(count=each.count, of=area)
    return s.Spread(count=each.count, of=area)


@construction(
    "place: first=points_of AND [AT] n=count [noun=POINT] in_ zone=region",
    "place: first=points_of AND [AT] n=count OTHER [noun=POINT] in_ zone=region",
    "place: first=points_of COMMA [AND] n=count [noun=POINT] in_ zone=region",
    cost=0.0,
    given=("site",),
)
def as_many_there_as_well(
    first: Points, n: int, zone: s.Selector, site: Site, noun: Lex | None = None
) -> PlaceMeaning | None:
    """Compose "four random spots on the bank and four in the paddock", which are drawn as well."""
    del noun
    if first.where is None or first.count is None or first.where.part != "all":
        return None
    there = bare_points(zone, site, n, random=first.random)
    here = s.PointsIn(zone=first.where.zone, count=first.count, random=first.random)
    return None if there is None else PlaceMeaning(s.UnionOf(parts=(here, there)), "several", count=n + first.count)


@construction("points_of: points=points", cost=0.0)
def points_of(points: Points) -> Points | None:
    """Compose "four random spots on the bank"."""
    return points if points.where is not None and points.random else None
