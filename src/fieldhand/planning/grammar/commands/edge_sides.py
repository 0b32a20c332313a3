"""Constructions of one side of an edge: "film the west side of the fence", "along the pond on the paddock side"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.laps import goes_around, is_thin, strip_around
from fieldhand.planning.grammar.commands.working import Tract
from fieldhand.planning.grammar.meaning import WorkCommand
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.sampling import is_keep_out
from fieldhand.planning.grammar.places.zone_sides import EdgeSide, sides_of_fence
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_zone
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.terms import Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction


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
    "tract: ONEPASS ALONG fence=region",
    "tract: ONESIDE OF fence=region",
    "tract: ALONG ONESIDE OF fence=region",
    "tract: n=count STRIP ALONG fence=region",
    cost=0.1,
    given=("site",),
)
def once_along_fence(fence: s.Selector, site: Site, n: int = 1) -> list[Tract] | None:
    """Compose "one pass along the fence", on either of its two sides."""
    if n != 1 or not is_keep_out(fence, site) or not is_thin(fence, site) or goes_around(fence, site):
        return None
    return [Tract(fence, "perimeter", sides=side) for side in sides_of_fence(fence, site)] or None


@construction("tract: EACHSIDE OF fence=region", cost=0.1, given=("site",))
def both_sides_of_fence(fence: s.Selector, site: Site) -> Tract | None:
    """Compose "both sides of the stock fence", along which the robot drives all the way round."""
    return Tract(fence, "perimeter") if sides_of_fence(fence, site) and is_keep_out(fence, site) else None


@construction(
    "work: verb=WORKV wide=strip where=tract", "work: verb=WORKV [DET] STRIP where=tract", cost=0.1, given=("robot",)
)
def strip_on_one_side(
    verb: Lex, where: Tract, used: int, robot: RobotProfile, wide: float | None = None
) -> list[WorkCommand] | None:
    """Compose "mow a strip 3 m wide on the west side of the fence"."""
    if where.mode != "perimeter":
        return None
    made = strip_around(verb, where.selector, wide, used, robot)
    return [replace(one, sides=where.sides, heading=where.heading) for one in made] or None


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
