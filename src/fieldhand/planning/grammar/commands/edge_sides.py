"""Constructions of one side of an edge: "film the west side of the fence", "along the pond on the paddock side"."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

from shapely import Polygon, unary_union
from shapely.geometry.base import BaseGeometry

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.working import Tract
from fieldhand.planning.grammar.meaning import WorkCommand
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.sampling import is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_zone
from fieldhand.site.model import Site
from fieldhand.terms import Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: How much longer than wide something is that has two sides, across its length.
_LONG = 4.0


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


def _ground(area: s.Selector, site: Site) -> BaseGeometry:
    zone = as_zone(area)
    return unary_union([one.polygon for one in site.zones if zone is not None and one.name == zone.zone])


def _side_towards(own: BaseGeometry, other: BaseGeometry) -> Side | None:
    """Return the side of a shape on which another lies; of a long shape, one of the two across its length."""
    if own.is_empty or other.is_empty:
        return None
    east, north = other.centroid.x - own.centroid.x, other.centroid.y - own.centroid.y
    rectangle = own.minimum_rotated_rectangle
    if isinstance(rectangle, Polygon):
        corners = list(rectangle.exterior.coords)[:3]
        (short, across), (length, _) = sorted(
            (math.dist(one, two), (two[0] - one[0], two[1] - one[1])) for one, two in pairwise(corners)
        )
        if length >= _LONG * short and short > 0.0:
            ahead = (east * across[0] + north * across[1]) / short**2
            east, north = ahead * across[0], ahead * across[1]
    if math.hypot(east, north) < 1e-6:
        return None
    if abs(east) >= abs(north):
        return "east" if east > 0 else "west"
    return "north" if north > 0 else "south"


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


@construction(
    "tract: [AT] side=fence_side OF fence=region",
    "tract: ALONG side=fence_side OF fence=region",
    "tract: [AT] side=fence_side OF fence=region ALONGIT",
    "tract: ONCE ALONG side=fence_side OF fence=region",
    "tract: ONEPASS ALONG side=fence_side OF fence=region",
    cost=0.1,
    given=("site",),
)
def one_side_of_edge(side: EdgeSide, fence: s.Selector, site: Site) -> Tract | None:
    """Compose "along the west side of the fence" and "the southern edge of the paddock"."""
    zone = as_zone(fence)
    if zone is None or zone.outside or zone.margin_m or zone.of != s.Trees():
        return None
    if not side.edge and not is_keep_out(fence, site):
        return None
    known = side.of(fence, site)
    return None if known is None else Tract(fence, "perimeter", sides=known)


@construction(
    "work: one=work [COMMA] AT side=fence_side",
    "work: one=work [COMMA] FROM side=fence_side",
    "work: one=work [COMMA] ALONG side=fence_side",
    "work: one=work [COMMA] side=fence_side",
    cost=0.1,
    given=("site",),
)
def worked_on_one_side(one: WorkCommand, side: EdgeSide, used: int, site: Site) -> WorkCommand | None:
    """Compose "film the fence from the paddock side"."""
    if one.mode != "perimeter" or one.sides != "one" or one.along is None or not is_keep_out(one.along, site):
        return None
    known = side.of(one.along, site)
    return None if known is None else replace(one, sides=known, used=used)


@construction(
    "work: one=work [COMMA] [and_or_but] order=ordered",
    "work: one=work [COMMA] GO order=ordered",
    "work: one=work [COMMA] axis=from_end_to_end",
    cost=0.1,
)
def worked_towards(
    one: WorkCommand, used: int, order: tuple[str, str, bool] | None = None, axis: Side | None = None
) -> WorkCommand | None:
    """Compose "film the west side of the fence from south to north"."""
    first, _, last = ("", "", axis) if order is None else order[0].partition("_to_")
    if one.mode != "perimeter" or one.heading != "any" or last not in SIDES or (order and first not in SIDES):
        return None
    along = {"north": "north_south", "south": "north_south"}.get(last, "east_west")
    across = {"north": "north_south", "south": "north_south"}.get(one.sides, "east_west")
    if one.sides not in SIDES or along == across:
        return None
    return replace(one, heading=last, used=used)


@construction(
    "from_end_to_end: [GO] FROM [DET] first=DIR FINISH range_to [DET] last=DIR FINISH",
    "from_end_to_end: [GO] FROM ITS first=DIR FINISH range_to ITS last=DIR FINISH",
    "from_end_to_end: RUNS [DET] first=DIR [FINISH] range_to [DET] last=DIR [FINISH]",
    "from_end_to_end: RUNS ITS first=DIR FINISH range_to ITS last=DIR FINISH",
    cost=0.1,
)
def from_end_to_end(first: Lex, last: Lex) -> Side | None:
    """Compose "from its south end to its north end"."""
    opposite = {first.value, last.value} in ({"north", "south"}, {"east", "west"})
    return last.value if opposite else None
