"""Constructions of the sides of zones: "from the north side of the pond", "at both ends of the slope", "near the mast".

Something that the robot cannot enter is seen from outside; of other ground an edge or an end is inside of it, and its
"north side" is its northern half.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

from shapely import Polygon, unary_union
from shapely.geometry.base import BaseGeometry

from fieldhand.places import selectors as s
from fieldhand.places.points.transect import OFF_EDGE_M
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.sampling import SamplingPath, bare_zone, is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_zone
from fieldhand.site.model import Site
from fieldhand.terms import Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: How much longer than wide something is that has two sides, across its length, and something that has two ends.
_LONG, _HAS_ENDS = 4.0, 1.3
_ROUND: tuple[Side, ...] = ("north", "east", "south", "west")


@dataclass(frozen=True, slots=True)
class EdgeSide:
    """A side of an edge: of the compass, or that on which an area lies.

    Attributes:
        compass: Side of the compass; None for the side of an area.
        zone: Name of the area.
        edge: True for "the south edge" of any area; the south side of ground that can be driven on is a part of it.
    """

    compass: Side | None = None
    zone: str = ""
    edge: bool = False

    def of(self, fence: s.Selector, site: Site) -> Side | None:
        """Return the side of the compass of something; None if the area lies on no one side of it."""
        return self.compass or _side_towards(_ground(fence, site), _ground(s.InZone(zone=self.zone), site))


@dataclass(frozen=True, slots=True)
class Sides:
    """Several sides: those that are named, all of them, both of something long, or its two ends."""

    named: tuple[EdgeSide, ...] = ()
    all: bool = False
    number: int = 0
    ends: bool = False

    def of(self, area: s.Selector, site: Site) -> tuple[Side, ...]:
        """Return the sides of the compass; empty if an area has no such sides."""
        if self.named:
            found = [one.of(area, site) for one in self.named]
            return tuple(one for one in found if one is not None) if None not in found else ()
        ground = _ground(area, site)
        two = two_sides(ground) if not self.ends else _ends(ground)
        if self.ends or (two and self.number in (0, 2)):
            return two
        return _ROUND if self.all and not two and self.number in (0, 4) else ()


def _ground(area: s.Selector, site: Site) -> BaseGeometry:
    zone = as_zone(area)
    return unary_union([one.polygon for one in site.zones if zone is not None and one.name == zone.zone])


def _side_towards(own: BaseGeometry, other: BaseGeometry) -> Side | None:
    """Return the side of a shape on which another lies; of a long shape, one of the two across its length."""
    if own.is_empty or other.is_empty:
        return None
    east, north = other.centroid.x - own.centroid.x, other.centroid.y - own.centroid.y
    if (along := _along(own, _LONG)) is not None:
        across = (-along[1], along[0])
        ahead = east * across[0] + north * across[1]
        east, north = ahead * across[0], ahead * across[1]
    return None if math.hypot(east, north) < 1e-6 else _nearest_side(east, north)


def _along(shape: BaseGeometry, longer: float) -> tuple[float, float] | None:
    """Return the direction along a shape that is so much longer than wide, a unit vector; None for any other shape."""
    rectangle = shape.minimum_rotated_rectangle
    if not isinstance(rectangle, Polygon) or rectangle.is_empty:
        return None
    corners = list(rectangle.exterior.coords)[:3]
    (short, _), (length, (east, north)) = sorted(
        (math.dist(one, two), (two[0] - one[0], two[1] - one[1])) for one, two in pairwise(corners)
    )
    return (east / length, north / length) if length >= longer * short and length > 0.0 else None


def _nearest_side(east: float, north: float) -> Side:
    if abs(east) >= abs(north):
        return "east" if east > 0 else "west"
    return "north" if north > 0 else "south"


def two_sides(shape: BaseGeometry) -> tuple[Side, ...]:
    """Return the two sides of something long, across its length; empty for any other shape."""
    along = _along(shape, _LONG)
    return () if along is None else (_nearest_side(-along[1], along[0]), _nearest_side(along[1], -along[0]))


def sides_of_fence(fence: s.Selector, site: Site) -> tuple[Side, ...]:
    """Return the two sides of a fence or a wall, across its length; empty if it has none."""
    return two_sides(_ground(fence, site))


def _ends(shape: BaseGeometry) -> tuple[Side, ...]:
    along = _along(shape, _HAS_ENDS)
    return () if along is None else (_nearest_side(*along), _nearest_side(-along[0], -along[1]))


def on_side(area: s.Selector | None, side: Side, *, count: int = 1) -> s.Transect:
    """Return points along one side of a zone, or of the site without one."""
    zone = None if area is None else as_zone(area)
    return s.Transect(count=count, shape="edge", zone="" if zone is None else zone.zone, part=side)


def is_whole_zone(area: s.Selector) -> bool:
    """Return True for a zone by its name, and nothing else."""
    zone = as_zone(area)
    return zone is not None and zone == s.InZone(zone=zone.zone)


# --- sides ------------------------------------------------------------------------------------------------------------


@construction("fence_side: [DET] side=DIR SIDE", "fence_side: ITS side=DIR SIDE", cost=0.1)
def compass_side(side: Lex) -> EdgeSide | None:
    """Compose "the west side"."""
    return EdgeSide(compass=side.value) if side.value in SIDES else None


@construction("fence_side: [DET] side=DIR EDGE", "fence_side: ITS side=DIR EDGE", cost=0.1)
def compass_edge(side: Lex) -> EdgeSide | None:
    """Compose "the west edge"."""
    return EdgeSide(compass=side.value, edge=True) if side.value in SIDES else None


@construction("fence_side: [DET] zone=ZONE SIDE", "fence_side: [DET] zone=ZONEPOSS SIDE", cost=0.1)
def side_of_area(zone: Lex) -> EdgeSide:
    """Compose "the paddock side" of a fence."""
    return EdgeSide(zone=zone.value)


@construction("zone_side: side=fence_side", cost=0.0)
def one_side(side: EdgeSide) -> EdgeSide:
    """Compose "the west side"."""
    return side


@construction("zone_side: [DET] side=DIR noun=FINISH", "zone_side: [DET] side=MOST noun=FINISH", cost=0.1)
def compass_end(side: Lex, noun: Lex) -> EdgeSide | None:
    """Compose "the west end"."""
    return EdgeSide(compass=side.value, edge=True) if side.value in SIDES and not noun.plural else None


@construction("border_noun: noun=EDGE", "border_noun: noun=FINISH", "border_noun: noun=SIDE", cost=0.0)
def border_noun(noun: Lex) -> Lex | None:
    """Compose "side" and "end"; a "part" is none."""
    return noun if noun.text.rstrip("s") not in ("part", "section", "portion", "region") else None


@construction("zone_sides: one=zone_side", cost=0.0)
def single_side(one: EdgeSide) -> Sides:
    """Compose "the west end"."""
    return Sides((one,))


@construction(
    "zone_sides: first=zone_sides [COMMA] AND last=zone_side", "zone_sides: first=zone_sides COMMA last=zone_side",
    "zone_sides: first=zone_sides [COMMA] AND AT last=zone_side",
    "zone_sides: first=zone_sides COMMA AT last=zone_side", cost=0.1,
)  # fmt: skip
def more_sides(first: Sides, last: EdgeSide) -> Sides | None:
    """Compose "the west end and the east end"."""
    return None if last in first.named or not first.named else replace(first, named=(*first.named, last))


@construction("compass_list: [DET] side=DIR", cost=0.0)
def compass_list(side: Lex) -> tuple[Side, ...] | None:
    """Compose "the north", the beginning of "the north and the south side"."""
    return (side.value,) if side.value in SIDES else None


@construction(
    "compass_list: first=compass_list COMMA [DET] side=DIR",
    "compass_list: first=compass_list [COMMA] AND [DET] side=DIR", cost=0.1,
)  # fmt: skip
def longer_compass_list(first: tuple[Side, ...], side: Lex) -> tuple[Side, ...] | None:
    """Compose "the north, east and south" before "sides"."""
    return (*first, side.value) if side.value in SIDES and side.value not in first else None


@construction("zone_sides: sides=compass_list noun=border_noun", cost=0.0)
def listed_sides(sides: tuple[Side, ...], noun: Lex) -> Sides | None:
    """Compose "the north and the south sides"."""
    edge = "borders" not in noun.features
    return Sides(tuple(EdgeSide(compass=side, edge=edge) for side in sides)) if len(sides) > 1 else None


@construction(
    "zone_sides: word=EACH [OF] [DET] [n=count] noun=border_noun", "zone_sides: DET n=count noun=border_noun",
    "zone_sides: word=EACH [OF] ITS [n=count] noun=border_noun", "zone_sides: word=EACHSIDE",
    cost=0.1,
)  # fmt: skip
def every_side(noun: Lex | None = None, n: int = 0, word: Lex | None = None) -> Sides | None:
    """Compose "each of the four sides" and "both ends"; "all edges" are the whole edge."""
    edge = noun is not None and "borders" not in noun.features
    ends = noun is not None and "end" in noun.text
    if edge and not ends:
        return None
    two = word is not None and ("two" in word.features or "both" in word.text or "either" in word.text)
    number = n or (2 if two else 0)
    if ends and number not in (0, 2):
        return None
    return Sides(all=True, number=number, ends=ends)


# --- places on a side -------------------------------------------------------------------------------------------------


@construction(
    "zone_spot: sides=zone_sides OF area=region", "zone_spot: owner=ZONEPOSS sides=zone_sides",
    "zone_spot: DET owner=ZONEPOSS sides=zone_sides", cost=0.0, given=("site",),
)  # fmt: skip
def on_sides(sides: Sides, site: Site, area: s.Selector | None = None, owner: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the north side of the pond" and "both ends of the slope"."""
    where = area or s.InZone(zone=owner.value if owner is not None else "")
    if not is_whole_zone(where):
        return None
    if not is_keep_out(where, site) and any(one.zone or not one.edge for one in sides.named):
        return None
    named = sides.of(where, site)
    points = tuple(on_side(where, side) for side in named)
    if len(points) < 2:
        return PlaceMeaning(points[0], "one") if points else None
    return PlaceMeaning(s.UnionOf(parts=points), "several", count=len(points), each=True)


@construction("seen_from: FROM sides=compass_list", "seen_from: FROM sides=zone_sides", cost=0.0)
def seen_from(sides: Sides | tuple[Side, ...]) -> Sides:
    """Compose "from the south" and "from all four sides"."""
    return sides if isinstance(sides, Sides) else Sides(tuple(EdgeSide(compass=side) for side in sides))


@construction("zone_spot: [DET] zone=ZONE sides=seen_from", cost=0.0, given=("site",))
def seen_from_side(zone: Lex, sides: Sides, site: Site) -> PlaceMeaning | None:
    """Compose "the oak from the south", of what the robot cannot enter."""
    where = s.InZone(zone=zone.value)
    return on_sides(sides, site, where) if is_keep_out(where, site) else None


@construction("zone_spot: [DET] MIDDLE OF at=edge_part", cost=0.0)
def middle_of_side(at: tuple[Side, s.Selector | None]) -> PlaceMeaning:
    """Compose "the middle of the south edge of the meadow"."""
    return PlaceMeaning(on_side(at[1], at[0]), "one")


@construction("place: at=zone_spot", cost=0.0)
def zone_spot(at: PlaceMeaning) -> PlaceMeaning:
    """Compose "each of the four sides of the pond" as a place."""
    return at


@construction(
    "edge_part: side=zone_side OF area=region", "edge_part: [DET] area=ZONEPOSS side=zone_side",
    "edge_part: side=zone_side OF site", cost=0.0, given=("site",),
)  # fmt: skip
def part_of_edge(
    side: EdgeSide, site: Site, area: s.Selector | Lex | None = None
) -> tuple[Side, s.Selector | None] | None:
    """Compose "the south edge of the meadow", along which captures are made."""
    where = s.InZone(zone=area.value) if isinstance(area, Lex) else area
    if where is None:
        return (side.compass, None) if side.compass is not None and not site.trees else None
    if not is_whole_zone(where) or not (is_keep_out(where, site) or bare_zone(where, site)):
        return None
    known = side.of(where, site)
    return None if known is None else (known, where)


@construction(
    "path_over: ALONG at=edge_part", "path_over: EVENLYALONG at=edge_part", "path_over: GO [ONCE] ALONG at=edge_part",
    "path_over: GO [ONCE] at=edge_part", "path_over: GO ALONG at=edge_part ONCE", "path_over: AT at=edge_part",
    cost=0.1,
)  # fmt: skip
def along_part_of_edge(at: tuple[Side, s.Selector | None]) -> tuple[SamplingPath, s.Selector | None]:
    """Compose "along the south edge of the meadow"."""
    return SamplingPath("edge", 1, part=at[0]), at[1]


# --- beside zones and markers -----------------------------------------------------------------------------------------


@construction("next_to: word=NEXTTO", "next_to: word=NEAR", "next_to: word=BESIDE", cost=0.0)
def next_to(word: Lex) -> Lex | None:
    """Compose "next to" and "near"; "around" and "nearest to" are neither, and "by" is at it."""
    return None if {"surrounds", "nearest", "at_it"} & word.features else word


@construction("zone_beside: [DIRECTLY] next_to [DET] zone=ZONE", cost=0.1, given=("site",))
def beside_zone(zone: Lex, site: Site) -> PlaceMeaning | None:
    """Compose "next to the compost heap": outside of it; ground with plants has rows beside it."""
    where = s.InZone(zone=zone.value)
    edge = s.Transect(count=1, shape="edge", zone=zone.value)
    if is_keep_out(where, site):
        return PlaceMeaning(edge, "one")
    return PlaceMeaning(replace(edge, off_m=-OFF_EDGE_M), "one") if bare_zone(where, site) else None


@construction(
    "zone_beside: [DIRECTLY] next_to at=marker", "zone_beside: [DIRECTLY] next_to [DET] gate=GATENAME",
    "zone_beside: [DIRECTLY] INSIDE [DET] gate=GATENAME", cost=0.1,
)  # fmt: skip
def beside_marker(at: s.Selector | None = None, gate: Lex | None = None) -> PlaceMeaning:
    """Compose "next to the charger", "near the road gate" and "just inside the door"."""
    return PlaceMeaning(at or s.GateIs(gate=gate.value if gate is not None else ""), "one")


@construction(
    "zone_beside: first=zone_beside AND [DET] zone=ZONE", "zone_beside: first=zone_beside COMMA [DET] zone=ZONE",
    "zone_beside: first=zone_beside AND at=marker", "zone_beside: first=zone_beside COMMA at=marker",
    "zone_beside: first=zone_beside AND [DET] gate=GATENAME",
    "zone_beside: first=zone_beside COMMA [DET] gate=GATENAME",
    "zone_beside: first=zone_beside COMMA AND [DET] zone=ZONE",
    cost=0.0, given=("site",),
)  # fmt: skip
def beside_several(
    first: PlaceMeaning, site: Site, zone: Lex | None = None, at: s.Selector | None = None, gate: Lex | None = None
) -> PlaceMeaning | None:
    """Compose "next to the compost heap and the herb patch": outside of each of them."""
    further = beside_marker(at, gate) if zone is None else beside_zone(zone, site)
    if further is None or (first.shape != "one" and first.count is None):
        return None
    parts = (*first.selector.members, *further.selector.members)
    if len({*parts}) < len(parts):
        return None
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=len(parts), each=True)


@construction("zone_beside: NEXTTO at=place", cost=0.3)
def beside_plants(at: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "next to three random leeks": work on soil or air beside a plant is done at it."""
    zones = [one for one in at.selector.walk() if getattr(one, "shape", "") == "edge" or one.whole_zone]
    return at if at.shape == "several" and not zones else None
