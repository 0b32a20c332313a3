"""Constructions of zones that share a name and differ in their number: beds of a garden, benches of a greenhouse."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import numbered_zones_of
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS
from fieldhand.planning.grammar.places.points import Points
from fieldhand.planning.grammar.places.sampling import bare_points
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_every_nth, as_some, as_zone, chooses_from_trees, over
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Zones of one name, in the order of their numbers.
Zones = tuple[s.Selector, ...]

#: Maximum number of zones of a range.
_MOST = 500


def _head(names: dict[str, str]) -> str:
    """Return what the names of numbered zones have in common."""
    return next(iter(names.values())).rpartition(" ")[0]


@construction("zone_run: [DET] noun=NUMBEREDZONE numbers=numbers", cost=0.1)
def numbered_zones(noun: Lex, numbers: tuple[str, ...]) -> Zones | None:
    """Compose "beds 2 to 6"; the site says if it lacks one."""
    names = dict(noun.value)
    if not noun.plural or len(numbers) < 2:
        return None
    return tuple(s.InZone(zone=names.get(number, f"{_head(names)} {number}")) for number in numbers)


@construction("zone_run: [DET] noun=NUMBEREDZONE first=NUM range_to last=NUM", cost=0.1)
def range_of_zones(noun: Lex, first: Lex, last: Lex) -> Zones | None:
    """Compose "beds 2 to 6"; the site says if it lacks one."""
    low, high = int(first.value), int(last.value)
    if not noun.plural or not low < high <= low + _MOST:
        return None
    return numbered_zones(noun, tuple(str(number) for number in range(low, high + 1)))


@construction("region: [DET] noun=NUMBEREDZONE [NUMBERED] [HASH] number=NUM", cost=0.6)
def zone_that_is_not_there(noun: Lex, number: Lex) -> s.Selector | None:
    """Compose "bed 12" of eight; the site says which it has."""
    names = dict(noun.value)
    text = f"{number.value:g}"
    return None if noun.plural or text in names else s.InZone(zone=f"{_head(names)} {text}")


@construction(
    "zone_list: every=row_step NUMBEREDZONE [COMMA] STARTING noun=NUMBEREDZONE first=NUM",
    "zone_list: every=row_step NUMBEREDZONE [COMMA] STARTING zone=ZONE",
    "zone_list: every=row_step noun=NUMBEREDZONE [COMMA] STARTING DET rank=ORD [ONE]",
    cost=0.05,
    given=("site",),
)
def zones_starting_with(
    every: int,
    site: Site,
    noun: Lex | None = None,
    first: Lex | None = None,
    zone: Lex | None = None,
    rank: Lex | None = None,
) -> Zones | None:
    """Compose "every third bed starting with bed 2"."""
    head = zone.value.rpartition(" ")[0] if zone is not None else ""
    named = noun.value if noun is not None else numbered_zones_of(site).get(head, ())
    names = [name for _, name in named]
    wanted = zone.value if zone is not None else f"{_head(dict(named))} {first.value:g}" if first is not None else ""
    if rank is not None and 0 < rank.value <= len(names):
        wanted = names[int(rank.value) - 1]
    if wanted not in names:
        return None
    return tuple(s.InZone(zone=name) for name in names[names.index(wanted) :: every])


@construction(
    "zone_list: EACH noun=NUMBEREDZONE",
    "zone_list: EACH [OF] DET noun=NUMBEREDZONE",
    "zone_list: several=NUMBEREDZONE",
    "zone_list: word=DET several=NUMBEREDZONE",
    cost=0.2,
)
def every_zone(noun: Lex | None = None, several: Lex | None = None, word: Lex | None = None) -> Zones | None:
    """Compose "every bed", "the beds" and "a bed" of "two a bed"; "the bed" is one of them."""
    if several is not None and not several.plural and (word is None or "indefinite" not in word.features):
        return None
    noun = noun or several
    return None if noun is None else tuple(s.InZone(zone=name) for _, name in noun.value)


@construction(
    "zone_list: EACH noun=ZONEKIND", "zone_list: EACH [OF] DET noun=ZONEKIND", "zone_list: noun=ZONEKIND",
    "zone_list: EACH [OF] [DET] n=count noun=ZONEKIND", "zone_list: [DET] n=count noun=ZONEKIND", cost=0.1,
)  # fmt: skip
def zones_of_a_kind(noun: Lex, n: int | None = None) -> Zones | None:
    """Compose "each section" and "the two sections", of the warm and the cool section."""
    return tuple(s.InZone(zone=name) for name in noun.value) if n in (None, len(noun.value)) else None


@construction("zone_list: DET noun=ZONEKIND", cost=0.1)
def the_zones(noun: Lex) -> list[Zones]:
    """Compose "the sections", which are all of them, and "the section": which one?"""
    each = [s.InZone(zone=name) for name in noun.value]
    return [tuple(each)] if noun.text.endswith("s") else [(one,) for one in each]


@construction("zone_list: EACH QUARTER", "zone_list: EACH [OF] DET n=count QUARTER", cost=0.3)
def quarters_of_site(n: int = 4) -> Zones | None:
    """Compose "each quarter" of the site."""
    return quarters_of_ground(None, n)


@construction(
    "zone_list: EACH QUARTER OF whole=region", "zone_list: EACH [OF] [DET] [n=count] QUARTER OF whole=region",
    "zone_list: [DET] n=count QUARTER OF whole=region", "zone_list: [DET] noun=QUARTER OF whole=region",
    "zone_list: EACH QUARTER OF site", "zone_list: EACH [OF] [DET] [n=count] QUARTER OF site",
    "zone_list: [DET] n=count QUARTER OF site", "zone_list: [DET] noun=QUARTER OF site",
    cost=0.1,
)  # fmt: skip
def quarters_of_ground(whole: s.Selector | None = None, n: int = 4, noun: Lex | None = None) -> Zones | None:
    """Compose "each quarter of the paddock"."""
    ground = s.Trees() if whole is None else whole
    if n != 4 or (noun is not None and not noun.plural):
        return None
    return tuple(s.Quarter(quarter=corner, of=ground) for corner in CORNERS)


@construction("zone_list: EACH OF zones=zone_list", "zone_list: EACH zones=zone_list", cost=0.0)
def each_of_zones(zones: Zones) -> Zones:
    """Compose "each of beds 2 to 6"."""
    return zones


@construction("place: one=place in_ zones=zone_list", cost=0.2)
def in_each_zone(one: PlaceMeaning, zones: Zones) -> PlaceMeaning | None:
    """Compose "three points in every bed" and "two plants in each of beds 2 to 6"."""
    some = as_some(one.selector)
    if one.per is not None or one.shape not in ("one", "several") or one.selector == s.Middle():
        return None
    if some is None and chooses_from_trees(one.selector) and one.like is None:
        if as_every_nth(one.selector) is not None or (one.shape == "several" and one.count is None):
            return replace(one, selector=over(one.selector, s.UnionOf(parts=zones)))  # "every plant in both sections"
        return PlaceMeaning(one.selector, "several", each=True, per=s.UnionOf(parts=zones))
    if some is None or some.of != s.Trees():
        return None
    return PlaceMeaning(some, "several", each=True, per=s.UnionOf(parts=zones))


@construction("place: points=points in_ zones=zone_list", cost=0.1, given=("site",))
def points_in_each_zone(points: Points, zones: Zones, site: Site) -> PlaceMeaning | None:
    """Compose "three points in every bed" and "four random spots in each section"."""
    if points.count is None or points.where is not None:
        return None
    made = points_of(zones, points.count, site, random=points.random)
    return None if made is None else PlaceMeaning(made, "several", each=True, count=points.count * len(zones))


@construction(
    "place: [DET] MIDDLE OF zones=zone_list", "place: [DET] MIDDLE in_ zones=zone_list",
    "place: [DET] MIDDLE OF zones=grounds", "place: [DET] MIDDLE in_ zones=grounds", cost=0.1, given=("site",),
)  # fmt: skip
def middle_of_each(zones: Zones, site: Site) -> PlaceMeaning:
    """Compose "the middle of each section" and "the middle of the slope and of the paddock"."""
    made = points_of(zones, 1, site) or s.UnionOf(parts=tuple(s.Middle(of=one) for one in zones))
    return PlaceMeaning(made, "several", each=True, count=len(zones))


@construction("place: [DET] noun=TREE in_ DET MIDDLE OF zones=zone_list", cost=0.1)
def tree_in_middle_of_each(noun: Lex, zones: Zones) -> PlaceMeaning | None:
    """Compose "the tree in the middle of each quarter"."""
    made = s.UnionOf(parts=tuple(s.Middle(of=one) for one in zones))
    return None if noun.plural else PlaceMeaning(made, "several", each=True, count=len(zones))


@construction(
    "place: points=points in_ zones=grounds [COMMA] APIECE", "place: points=points in_ zones=grounds [COMMA] INEACH",
    "place: points=points APIECE in_ zones=grounds", cost=0.0, given=("site",),
)  # fmt: skip
def points_in_each_ground(points: Points, zones: Zones, site: Site) -> PlaceMeaning | None:
    """Compose "five random points in the wet corner and the slope each"."""
    return points_in_each_zone(points, zones, site)


def points_of(zones: Zones, count: int, site: Site, *, random: bool = False) -> s.Selector | None:
    """Return so many free points of each of some zones, or of parts of ground without plants."""
    points: list[s.Selector] = []
    for one in zones:
        zone = as_zone(one)
        named = zone is not None and zone == s.InZone(zone=zone.zone)
        free = s.PointsIn(zone=zone.zone, count=count, random=random) if zone is not None and named else None
        points += [found] if (found := free or bare_points(one, site, count, random=random)) is not None else []
    return s.UnionOf(parts=tuple(points)) if len(points) == len(zones) else None


@construction("zone_list: every=row_step noun=NUMBEREDZONE", cost=0.1)
def every_nth_zone(every: int, noun: Lex) -> Zones:
    """Compose "every second bed"."""
    return tuple(s.InZone(zone=name) for _, name in noun.value[::every])


@construction("zone_run: [DET] odd=ODD noun=NUMBEREDZONE", "zone_run: [DET] EVEN noun=NUMBEREDZONE", cost=0.1)
def odd_or_even_zones(noun: Lex, odd: Lex | None = None) -> Zones | None:
    """Compose "the odd beds"."""
    left = 1 if odd is not None else 0
    return tuple(s.InZone(zone=name) for number, name in noun.value if int(number) % 2 == left) or None


@construction("place: zones=zone_list", cost=0.3)
def at_zones(zones: Zones) -> PlaceMeaning:
    """Compose "beds 2 to 6" as places."""
    return PlaceMeaning(s.Trees(), "area", each=True, per=s.UnionOf(parts=zones))


@construction("zone_list: zones=zone_run", cost=0.0)
def zones_one_by_one(zones: Zones) -> Zones:
    """Compose "beds 2 to 6", of each of which something is said."""
    return zones


@construction("region: zones=zone_run", cost=0.3)
def zones_as_region(zones: Zones) -> s.Selector:
    """Compose "beds 2 to 6" as an area."""
    return s.UnionOf(parts=zones)
