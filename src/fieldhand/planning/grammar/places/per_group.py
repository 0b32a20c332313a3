"""Constructions of so many places in each of several beds or zones: "both beds, four spots in each, spread out"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.sampling import bare_points
from fieldhand.planning.selections import are_rows, as_where, as_zone, is_one_row
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("evenly_there: EVENLYSPACED", "evenly_there: SPREADOUT", "evenly_there: FARAPART", cost=0.0)
def evenly_there() -> str:
    """Compose "nicely spread out"."""
    return "evenly"


@construction("spots_there: TREE", "spots_there: POINT", "spots_there: SAMPLINGPOINT", cost=0.0)
def spots_there() -> str:
    """Compose "spots" of "four spots in each"."""
    return "spots"


@construction("in_each_bed: n=count spots_there in_ EACH [OF] ROW [COMMA] [evenly_there]", cost=0.0)
def so_many_in_each_bed(n: int) -> int:
    """Compose "three places in each bed"."""
    return n


@construction(
    "in_each_one: n=count spots_there INEACH [COMMA] [evenly_there]",
    "in_each_one: n=count evenly_there spots_there INEACH",
    "in_each_one: n=count INEACH [COMMA] evenly_there",
    "in_each_one: n=count READING INEACH [COMMA] evenly_there",
    "in_each_one: n=count evenly_there READING INEACH",
    "in_each_one: AT n=in_each_one",
    "in_each: n=in_each_one", "in_each: [AT] n=in_each_bed",
    cost=0.0,
)  # fmt: skip
def so_many_in_each(n: int) -> int:
    """Compose "four spots in each, nicely spread out"."""
    return n


@construction(
    "place: rows=rows [COMMA] n=in_each", "place: rows=each_row [COMMA] n=in_each",
    "place: rows=rows AND [in_] more=rows [COMMA] n=in_each",
    cost=0.1,
)  # fmt: skip
def of_rows_so_many_each(rows: s.Selector, n: int, more: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "both cabbage beds, four spots in each"."""
    if more is not None:
        rows = s.UnionOf(parts=(*rows.members, *more.members))
    return _of_each_row(n, rows)


@construction(
    "place: of=crop_area [COMMA] n=in_each_bed", "place: of=crop_area AND [in_] more=crop_area [COMMA] n=in_each_bed",
    "place: of=crop_area [COMMA] AT n=in_each_bed",
    "place: of=crop_area AND [in_] more=crop_area [COMMA] AT n=in_each_bed", cost=0.0,
)  # fmt: skip
def of_crops_so_many_each_bed(of: s.Selector, n: int, more: s.Selector | None = None) -> PlaceMeaning:
    """Compose "in the leeks and in the onions, at three places in each bed"."""
    plants = of if more is None else s.UnionOf(parts=(*of.members, *more.members))
    return PlaceMeaning(s.Quota(per="row", count=n, of=plants), "several")


@construction(
    "place: of=crop_area [COMMA] n=in_each_one", "place: of=crop_area AND [in_] more=crop_area [COMMA] n=in_each_one",
    cost=0.1,
)  # fmt: skip
def of_crops_so_many_each(of: s.Selector, n: int, more: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "the leeks and the onions, three plants of each", which are of each crop; of one, of each of its beds."""
    kinds = [as_where(one) for one in (*of.members, *(() if more is None else more.members))]
    if len(kinds) < 2:
        return of_crops_so_many_each_bed(of, n)
    plain = [one.attribute for one in kinds if one is not None and one.of == s.Trees()]
    if len(plain) < len(kinds) or len(set(plain)) != 1:
        return None
    plants = s.UnionOf(parts=tuple(one for one in kinds if one is not None))
    return PlaceMeaning(s.Quota(per=plain[0], count=n, of=plants), "several")


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


def _of_each_row(n: int, rows: s.Selector) -> PlaceMeaning | None:
    """Return so many plants of each of some rows, spread along it."""
    if not are_rows(rows) or is_one_row(rows):
        return None
    return PlaceMeaning(s.Quota(per="row", count=n, of=rows), "several")


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
    "place: areas=grounds [COMMA] n=in_each", "place: areas=grounds [COMMA] [AT] n=count READING INEACH",
    cost=0.1, given=("site",),
)  # fmt: skip
def of_grounds_so_many_each(areas: tuple[s.Selector, ...], n: int, site: Site) -> PlaceMeaning:
    """Compose "the wet corner and on the slope, four spots in each"."""
    parts = tuple(bare_points(one, site, n) or s.Spread(count=n, of=one) for one in areas)
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=n * len(parts))
