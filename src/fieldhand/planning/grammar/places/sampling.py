"""Constructions of sampling: shares of a group, paths and grids over an area, random points, gaps in rows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

from fieldhand.places import selectors as s
from fieldhand.places.points.transect import PathShape
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.areas import edges
from fieldhand.planning.grammar.places.chosen import Choice
from fieldhand.planning.grammar.places.exceptions import Omission
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.points import outside_zones
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    OPEN_NUMBER,
    are_rows,
    as_excluding,
    as_some,
    as_zone,
    chooses_from_trees,
    compass_part,
    is_one_row,
    over,
    rows_of,
)
from fieldhand.site.model import Site
from fieldhand.terms import AreaPart

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Largest share of a group that is a sample of it, in percent; 100 % are all of them.
_MOST_PERCENT = 100.0
#: Largest area in square metres of an object beside which there is one place to be.
_LARGEST_OBJECT_M2 = 25.0


@dataclass(frozen=True, slots=True)
class SamplingPath:
    """A path across an area along which samples are taken.

    Attributes:
        shape: Its form.
        legs: Number of legs of a zigzag.
        off_m: Distance from an edge in metres; None for the usual one.
        part: Side of an edge.
        in_order: True if the phrase says that its points are visited in their order, which is clockwise.
    """

    shape: PathShape
    legs: int
    off_m: float | None = None
    part: AreaPart = "all"
    in_order: bool = False

    def over(self, area: s.Selector | None, site: Site, *, count: int = 0, apart_m: float = 0.0) -> s.Selector | None:
        """Return so many places, or places so far apart, along the path across an area, or across the site.

        None if the area is ground without trees that has no name.
        """
        if self.shape == "edge":
            known = None if area is None else as_zone(area)
            zone = "" if known is None else known.zone
            edge = s.Transect(count=count, apart_m=apart_m, shape="edge", zone=zone, part=self.part)
            return edge if self.off_m is None else replace(edge, off_m=self.off_m)
        ground = bare_ground(area, site)
        if ground is not None:
            if ground.left_out and not apart_m:
                return None  # so many in all, of which some would be left out
            path = replace(self.among(s.Trees(), count), apart_m=apart_m, zone=ground.zone, part=ground.part)
            return ground.without(path)
        if not site.trees:
            return None
        return replace(self.among(s.Trees() if area is None else area, count), apart_m=apart_m)

    def among(self, of: s.Selector, count: int) -> s.Transect:
        """Return so many trees of a group along the path across it."""
        return s.Transect(count=count, shape=self.shape, legs=self.legs, of=of)


def whole_zone(area: s.Selector) -> str:
    """Return the name of the zone that an area is; empty for other areas."""
    zone = as_zone(area)
    return "" if zone is None or zone.outside or zone.margin_m or zone.of != s.Trees() else zone.zone


def bare_zone(area: s.Selector, site: Site) -> str:
    """Return the name of the zone that an area is, if no trees grow in it; else empty."""
    name = whole_zone(area)
    return "" if name and site.trees and ids_of(area, site) else name


@dataclass(frozen=True, slots=True)
class BareGround:
    """Ground without trees.

    Attributes:
        zone: Name of the zone; empty for the whole site.
        left_out: Names of the zones that are left out of it.
        part: The half or quarter of it that is meant.
    """

    zone: str
    left_out: tuple[str, ...] = ()
    part: AreaPart = "all"

    def without(self, points: s.Selector) -> s.Selector:
        """Return points but those in the zones that are left out."""
        for name in self.left_out:
            points = s.InZone(zone=name, outside=True, of=points)
        return points


def bare_ground(area: s.Selector | None, site: Site) -> BareGround | None:
    """Return the ground that an area is, if no trees grow in it and it has a name; None otherwise."""
    if area is None or area == s.Trees():
        return None if site.trees else BareGround("")
    if (rest := as_excluding(area)) is not None:
        inner = bare_ground(rest.of, site)
        outs = [as_zone(part) for part in rest.places.members]
        plain = [one.zone for one in outs if one is not None and not one.outside and not one.margin_m]
        return replace(inner, left_out=(*inner.left_out, *plain)) if inner and len(plain) == len(outs) else None
    if (named := compass_part(area)) is not None:
        whole = bare_ground(named[1], site)
        return replace(whole, part=named[0]) if whole is not None and whole.part == "all" else None
    zone = bare_zone(area, site)
    return BareGround(zone) if zone else None


def is_on_bare_ground(points: s.Selector, site: Site) -> bool:
    """Return True for a grid or a path over ground without trees, some of whose points may be left out."""
    zone = as_zone(points)
    points = zone.of if zone is not None and zone.outside else points
    named = isinstance(points, s.Grid | s.Transect) and points.on_ground
    return named or (isinstance(points, s.Grid | s.Transect) and not site.trees)


def is_keep_out(area: s.Selector, site: Site) -> bool:
    """Return True for something that the robot can only drive along or around: a fence, a pond, a building."""
    zone = as_zone(area)
    named = [one for one in site.zones if zone is not None and one.name == zone.zone]
    return bool(named) and all(one.kind == "keep_out" for one in named)


def is_object(area: s.Selector, site: Site) -> bool:
    """Return True for ground that an object takes up (a trough, a tap), beside which a robot stops."""
    zone = as_zone(area)
    sizes = [one.polygon.area for one in site.zones if zone is not None and one.name == zone.zone]
    return is_keep_out(area, site) and max(sizes) <= _LARGEST_OBJECT_M2


def beside_objects(areas: s.Selector, site: Site) -> tuple[s.Selector, ...]:
    """Return the places at which a robot stops beside objects ("the trough and the tap"); empty for other areas."""
    spots: list[s.Selector] = []
    for one in areas.members:
        if is_object(one, site):
            spots.append(s.Transect(count=1, shape="edge", zone=one.whole_zone))
        elif one.single and not one.relative:
            spots.append(one)
        else:
            return ()
    return tuple(spots)


def bare_points(area: s.Selector, site: Site, count: int, *, random: bool = False) -> s.PointsIn | s.Transect | None:
    """Return so many free points of ground without plants: a zone, a half or a quarter of one; None for other areas.

    What the robot cannot enter has them along its edge.
    """
    if (named := compass_part(area)) is not None:
        part, of = named
        whole = bare_points(of, site, count, random=random)
        return replace(whole, part=part) if whole is not None and whole.part == "all" else None
    if not random and area.whole_zone and is_keep_out(area, site):
        return s.Transect(count=count, shape="edge", zone=area.whole_zone)
    if area == s.Trees() and not site.trees:
        return s.PointsIn(count=count, random=random)
    zone = bare_zone(area, site)
    return s.PointsIn(zone=zone, count=count, random=random) if zone else None


def some_points(area: s.Selector, site: Site, count: int, *, random: bool = False) -> s.Selector | None:
    """Return so many places of an area: free points of bare ground, else plants of it."""
    free = bare_points(area, site, count, random=random)
    if free is not None or not chooses_from_trees(area):
        return free
    if random:
        return s.RandomSample(count=count, of=area)
    if are_rows(area):
        return s.Evenly(count=count, of=area) if is_one_row(area) else None
    return s.Spread(count=count, of=area)


def laid_over(points: s.Selector, area: s.Selector, site: Site) -> s.Selector | None:
    """Return points that were named without their ground as those over an area; None for other places."""
    if not isinstance(points, s.Grid | s.Transect) or points.on_ground or points.of != s.Trees():
        return None
    if isinstance(points, s.Grid):
        return grid_selector(points.every_m, area, site)
    path = SamplingPath(points.shape, points.legs)
    return None if points.shape == "edge" else path.over(area, site, count=points.count, apart_m=points.apart_m)


# Shares.


@construction("tree_share: part=amount", "tree_share: DET part=amount", cost=0.0)
def percentage(part: Amount) -> float | None:
    """Compose "10 %"."""
    return part.number if part.unit == "percent" and 0 < part.number < _MOST_PERCENT else None


@construction("tree_share: ABOUT share=tree_share", cost=0.1)
def about_a_share(share: float) -> float:
    """Compose "roughly a third of", of which so many are taken."""
    return share


@construction("tree_share: part=PART [OF]", cost=0.1)
def fraction(part: Lex) -> float:
    """Compose "a tenth of"."""
    return round(100.0 * float(part.value), 2)


@construction(
    "place: share=tree_share OF [DET] inner=nominal",
    "place: share=tree_share OF [EACH] [DET] inner=nominal",
    "place: share=tree_share [DET] inner=nominal",
    "place: random=RANDOM share=tree_share OF [DET] inner=nominal",
    "place: DET random=RANDOM share=tree_share OF [DET] inner=nominal",
    "place: share=tree_share OF [DET] inner=nominal [COMMA] random=RANDOM",
    "place: [DET] share=tree_share random=SAMPLE OF [DET] inner=nominal",
    cost=0.3,
)
def share_of(share: float, inner: Nominal, random: Lex | None = None) -> PlaceMeaning | None:
    """Compose "10 % of the Merlot vines"."""
    if inner.single or inner.complete or not inner.plural or not chooses_from_trees(inner.selector):
        return None
    drawn = random is not None and "random" in random.text
    per = "row" if any(rows == replace(s.Rows(), of=rows.of) for rows in rows_of(inner.selector)) else ""  # "each row"
    chosen = s.Quota(per=per, percent=share, how="random" if drawn else "spread", of=inner.selector)
    return PlaceMeaning(chosen, "several", each=True)


@construction("place: share=tree_share OF where=region", cost=0.6)
def share_of_area(share: float, where: s.Selector) -> PlaceMeaning | None:
    """Compose "10 % of the north block"; half of a row may be one end of it."""
    return None if share == 50.0 else PlaceMeaning(s.Quota(percent=share, of=where), "several", each=True)


# Paths.


@construction(
    "path: [DET] route=ROUTE [PATTERN]",
    "path: DET route=ROUTELETTER [PATTERN]",
    "path: [DET] route=ROUTELETTER [DASH] PATTERN",
    "path: [DET] route=ROUTELETTER [DASH] SHAPED PATTERN",
    "path: [DET] PATTERN OF DET route=ROUTELETTER",
    "path: [DET] route=ROUTE SHAPED PATTERN",
    cost=0.1,
)
def path(route: Lex) -> SamplingPath:
    """Compose "a W", "a zigzag" and "a Z-shaped path"."""
    shape, legs = route.value
    return SamplingPath(cast(PathShape, shape), legs)


@construction(
    "path: inner=path OF n=count LEG",
    "path: inner=path WITH n=count LEG",
    "path: inner=path COMMA n=count LEG",
    "path: [DET] n=count [DASH] LEG inner=path",
    cost=0.1,
)
def with_legs(inner: SamplingPath, n: int) -> SamplingPath | None:
    """Compose "a zigzag of five legs"; a letter has its own."""
    if inner.shape != "zigzag":
        return None
    return SamplingPath("zigzag", n)


@construction(
    "in_path: AT path=path",
    "in_path: ALONG path=path",
    "in_path: OVER path=path",
    "in_path: WITH path=path",
    "in_path: USE path=path",
    "in_path: INPATH path=path",
    "in_path: NEXTONE path=path",
    "in_path: GO path=path",
    "in_path: GO AT path=path",
    "in_path: GO ALONG path=path",
    "in_path: BY GO path=path",
    "in_path: BY GO AT path=path",
    cost=0.1,
)
def in_path(path: SamplingPath) -> SamplingPath:
    """Compose "in a W", "along a zigzag" and "walking a W"."""
    return path


@construction(
    "path_over: path=in_path OVER where=region",
    "path_over: path=path OVER where=region",
    "path_over: path=in_path OPPOSITE where=region",
    "path_over: path=in_path OVER where=crop_area",
    "path_over: path=in_path in_ where=crop_area",
    "path_over: GO OVER where=crop_area path=in_path",
    "path_over: GO where=crop_area path=in_path",
    "path_over: path=in_path in_ where=region",
    "path_over: GO OVER where=region path=in_path",
    "path_over: GO in_ where=region path=in_path",
    "path_over: GO where=region path=in_path",
    "path_over: CROSSV where=region path=in_path",
    cost=0.1,
)
def path_over(path: SamplingPath, where: s.Selector) -> tuple[SamplingPath, s.Selector | None]:
    """Compose "in a W through the north block"."""
    return path, where


@construction(
    "path_over: ALONG line=edge_line",
    "path_over: EVENLYALONG line=edge_line",
    "path_over: AROUND line=edge_line",
    "path_over: AROUND ALONG line=edge_line",
    "path_over: AROUND where=region",
    "path_over: AROUND site",
    "path_over: GO [one=ONCE] line=edge_line",
    "path_over: GO [one=ONCE] ALONG line=edge_line",
    "path_over: GO [one=ONCE] AROUND line=edge_line",
    "path_over: GO AROUND line=edge_line one=ONCE",
    "path_over: GO [one=ONCE] AROUND ALONG line=edge_line",
    "path_over: GO [one=ONCE] AROUND where=region",
    "path_over: GO AROUND where=region one=ONCE",
    "path_over: GO [one=ONCE] AROUND site",
    "path_over: GO AROUND site one=ONCE",
    "path_over: ALONG fence=region",
    "path_over: GO [one=ONCE] ALONG fence=region",
    "path_over: GO ALONG fence=region one=ONCE",
    "path_over: GO [one=ONCE] AROUND ALONG fence=region",
    "path_over: GO [one=ONCE] fence=region",
    cost=0.2,
    given=("site",),
)
def along_edge(
    site: Site,
    line: s.Selector | None = None,
    where: s.Selector | None = None,
    fence: s.Selector | None = None,
    one: Lex | None = None,
) -> tuple[SamplingPath, s.Selector | None] | None:
    """Compose "along the fence" and "once round the pond", of captures on the way."""
    del one
    if fence is not None and not is_keep_out(fence, site):
        return None
    area = line if where is None else where
    area = area if fence is None else fence
    if area is None or area == s.Trees() or area == edges():
        return SamplingPath("edge", 1), None
    zone = as_zone(area)
    whole = zone is not None and not zone.outside and not zone.margin_m and zone.of == s.Trees()
    return (SamplingPath("edge", 1), area) if whole else None


@construction(
    "off_edge: far=amount FROM [DET] EDGE",
    "off_edge: far=amount CLEAROF [DET] EDGE",
    "off_edge: far=amount CLEAROF IT",
    "off_edge: KEEPOFF far=amount CLEAROF IT",
    "off_edge: KEEPOFF far=amount CLEAROF [DET] EDGE",
    cost=0.1,
)
def off_edge(far: Amount) -> float | None:
    """Compose "4 metres from the edge" and "keeping 4 m away from it"."""
    return far.number if far.unit == "metres" else None


@construction("path_over: along=path_over [COMMA] [AT] off=off_edge", cost=0.1)
def along_edge_at_distance(
    along: tuple[SamplingPath, s.Selector | None], off: float
) -> tuple[SamplingPath, s.Selector | None] | None:
    """Compose "once round the pond, 4 metres from its edge"."""
    path, where = along
    if not isinstance(path, SamplingPath) or path.shape != "edge" or path.off_m is not None:
        return None
    return replace(path, off_m=off), where


@construction(
    "path_over: along=path_over [COMMA] [KEEPOFF] far=amount CLEAROF [DET] water_edge",
    "path_over: along=path_over [COMMA] [KEEPOFF] far=amount CLEAROF what=region",
    cost=0.1,
    given=("site",),
)
def along_water_at_distance(
    along: tuple[SamplingPath, s.Selector | None], far: Amount, site: Site, what: s.Selector | None = None
) -> tuple[SamplingPath, s.Selector | None] | None:
    """Compose "round the pond, two metres off the bank", and "off the water", which is the pond."""
    off, where = off_edge(far), along[1]
    if off is None or where is None or (not is_keep_out(where, site) if what is None else what != where):
        return None
    return along_edge_at_distance(along, off)


@construction(
    "path_over: path=in_path",
    "path_over: path=in_path OVER site",
    "path_over: path=in_path OPPOSITE site",
    "path_over: path=in_path in_ site",
    "path_over: GO OVER site path=in_path",
    cost=0.2,
)
def path_over_site(path: SamplingPath) -> tuple[SamplingPath, s.Selector | None]:
    """Compose "in a W across the vineyard"."""
    return path, None


@construction("chosen_as: [which_is] along=path_over", cost=0.1)
def chosen_along_path(along: tuple[SamplingPath, s.Selector | None]) -> Choice:
    """Compose "in a W" behind "20 vines"."""
    return Choice("path", along)


@construction(
    "place: n=count POINT along=path_over",
    "place: n=count [EVENLYSPACED] POINT along=path_over",
    cost=0.2,
    given=("site",),
)
def points_on_path(n: int, along: tuple[SamplingPath, s.Selector | None], site: Site) -> PlaceMeaning | None:
    """Compose "20 points in a W through the meadow"."""
    route, where = along
    points = route.over(where, site, count=n)
    return None if points is None else PlaceMeaning(points, "several", count=n)


# Grids.


@construction(
    "cells: [DET] far=amount GRID",
    "cells: [DET] far=amount [DASH] GRID",
    "cells: [DET] GRID OF far=amount",
    "cells: [DET] GRID WITH far=amount [INTERVAL]",
    "cells: [DET] GRID WITH DET INTERVAL OF far=amount",
    "cells: [DET] number=NUM BYSIZE far=amount GRID",
    "cells: [DET] far2=amount BYSIZE far=amount GRID",
    "cells: [DET] GRID OF number=NUM BYSIZE far=amount",
    "cells: [DET] GRID OF far2=amount BYSIZE far=amount",
    "cells: [DET] GRID [COMMA] EACH far=amount",
    cost=0.1,
)
def grid(far: Amount, far2: Amount | None = None, number: Lex | None = None) -> float | None:
    """Compose "a 20 m grid" and "a 20 by 20 m grid"; one whose cells are no squares is not."""
    if far.unit != "metres" or far.number <= 0:
        return None
    across = far2.number if far2 is not None else far.number if number is None else number.value
    return far.number if abs(across - far.number) < 1e-6 else None


@construction(
    "cells: [DET] GRID OF POINT gap=apart", "cells: [DET] GRID WITH POINT gap=apart", "cells: [DET] GRID gap=apart",
    cost=0.1,
)  # fmt: skip
def grid_of_points(gap: float) -> float:
    """Compose "a grid of points 20 m apart"."""
    return gap


@construction("on_grid: EACH far=amount AT [DET] GRID", cost=0.1)
def so_far_on_a_grid(far: Amount) -> float | None:
    """Compose "every 20 m on a grid"."""
    return far.number if far.unit == "metres" and far.number > 0 else None


@construction(
    "on_grid: AT every=cells",
    "on_grid: USE every=cells",
    "on_grid: WITH every=cells",
    "on_grid: INPATH every=cells",
    "on_grid: NEXTONE every=cells",
    "on_grid: LAYOUT every=cells",
    "on_grid: OF every=cells",
    "on_grid: ALONG every=cells",
    cost=0.0,
)
def on_grid(every: float) -> float:
    """Compose "on a 20 m grid"."""
    return every


@construction(
    "each_way: [DET] [READING] EACH far=amount EACHWAY", "each_way: n=count READING EACH far=amount EACHWAY",
    cost=0.0,
)  # fmt: skip
def so_far_each_way(far: Amount, n: int = 1) -> float | None:
    """Compose "one probe every 25 m each way"."""
    return far.number if n == 1 and far.unit == "metres" and far.number > 0 else None


@construction(
    "grid_over: every=on_grid OVER where=region",
    "grid_over: every=on_grid OPPOSITE where=region",
    "grid_over: every=on_grid in_ where=region",
    "grid_over: every=on_grid",
    "grid_over: every=on_grid OVER site",
    "grid_over: every=on_grid in_ site",
    cost=0.1,
)
def grid_over(every: float, where: s.Selector | None = None) -> tuple[float, s.Selector | None]:
    """Compose "on a 20 m grid over the meadow"."""
    return every, where


@construction(
    "grid_over: EACH far=amount word=OVER where=region",
    "grid_over: word=OVER where=region [COMMA] [DET] READING EACH far=amount",
    "grid_over: word=OVER where=region [COMMA] [n=count] READING EACH far=amount",
    "grid_over: word=OVER where=region COMMA n=count EACH far=amount",
    cost=0.1,
)
def every_so_far_over(word: Lex, where: s.Selector, far: Amount, n: int = 1) -> tuple[float, s.Selector] | None:
    """Compose "every 4 m all over the patch"; "around" and "through" it are lines."""
    if n != 1 or far.unit != "metres" or far.number <= 0 or "covers" not in word.features or not is_zone_of(where):
        return None
    return far.number, where


def is_zone_of(area: s.Selector) -> bool:
    """Return True for a zone, or for a half or a quarter of one."""
    part = compass_part(area)
    return as_zone(area if part is None else part[1]) is not None


@construction("grid_over: on=grid_over out=but_out", cost=0.1)
def grid_but(on: tuple[float, s.Selector | None], out: Omission) -> tuple[float, s.Selector | None] | None:
    """Compose "on a 20 m grid over the meadow except in the wet corner"."""
    if on[1] is None or out.place is None or any(as_zone(one) is None for one in out.place.selector.members):
        return None
    return on[0], s.Excluding(places=out.place.selector, of=on[1])


def grid_selector(every: float, area: s.Selector | None, site: Site) -> s.Selector | None:
    """Return the places of a grid over an area, or over the site; None for ground without trees that has no name."""
    rest = None if area is None else as_excluding(area)
    if rest is not None:  # "over the meadow except the wet corner"
        inner = grid_selector(every, rest.of, site)
        kept = None if inner is None else outside_zones(PlaceMeaning(inner, "several"), rest.places)
        if kept is not None:
            return kept.selector
    ground = bare_ground(area, site)
    if ground is not None:
        return ground.without(s.Grid(every_m=every, zone=ground.zone, part=ground.part))
    return s.Grid(every_m=every, of=s.Trees() if area is None else area) if site.trees else None


@construction(
    "place: [DET] inner=nominal on=grid_over", "place: [DET] POINT [PLACED] on=grid_over", cost=0.2, given=("site",)
)
def places_on_grid(
    on: tuple[float, s.Selector | None], site: Site, inner: Nominal | None = None
) -> PlaceMeaning | None:
    """Compose "the vines on a 20 m grid" and "points on a 20 m grid over the meadow"."""
    every, where = on
    if inner is None:
        points = grid_selector(every, where, site)
        return None if points is None else PlaceMeaning(points, "several", each=True)
    if inner.single or inner.complete or not inner.plural or not chooses_from_trees(inner.selector):
        return None
    of = inner.selector if where is None else over(inner.selector, where)
    trees = grid_selector(every, of, site)
    return None if trees is None else PlaceMeaning(trees, "several", each=True)


# Points at random.


@construction(
    "place: n=count RANDOM POINT in_ [DET] zone=ZONE",
    "place: n=count RANDOM POINT OVER [DET] zone=ZONE",
    "place: n=count POINT RANDOM in_ [DET] zone=ZONE",
    "place: n=count POINT in_ [DET] zone=ZONE [COMMA] RANDOM",
    "place: n=count POINT OVER [DET] zone=ZONE [COMMA] RANDOM",
    cost=0.1,
)
def random_points(n: int, zone: Lex) -> PlaceMeaning:
    """Compose "12 random places in the meadow"."""
    return PlaceMeaning(s.PointsIn(zone=zone.value, count=n, random=True), "one" if n == 1 else "several", count=n)


@construction(
    "place: RANDOM inner=nominal",
    "place: RANDOM inner=nominal OF where=region",
    "place: RANDOM inner=nominal in_ where=region",
    cost=0.6,
)
def open_random_trees(inner: Nominal, where: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "random vines of the north block", of which something else says how many at most."""
    if inner.single or inner.complete or not inner.plural or inner.pronoun or as_some(inner.selector) is not None:
        return None
    of = inner.selector if where is None else over(inner.selector, where)
    return PlaceMeaning(s.RandomSample(count=OPEN_NUMBER, of=of), "several") if chooses_from_trees(of) else None


# Gaps.


@construction("nominal: GAP", cost=0.1)
def gaps() -> Nominal:
    """Compose "gaps" and "missing vines"."""
    return Nominal(s.Missing(), plural=True)


@construction("nominal: MISSINGWORD inner=nominal", "nominal: MISSINGWORD POINT", cost=0.1)
def missing_ones(inner: Nominal | None = None) -> Nominal | None:
    """Compose "missing Merlot vines" and "empty positions"."""
    of = s.Trees() if inner is None else inner.selector
    if inner is not None and (inner.single or inner.complete or inner.pronoun or not chooses_from_trees(of)):
        return None
    if as_some(of) is not None:
        return None
    return Nominal(s.Missing(of=of), plural=True if inner is None else inner.plural)


@construction("nominal: inner=nominal ISMISSING", "nominal: inner=nominal WHICH ISMISSING", cost=0.2)
def that_are_missing(inner: Nominal) -> Nominal | None:
    """Compose "vines that are missing"."""
    return missing_ones(inner)


@construction(
    "place_where: WHERE [DET] inner=nominal ISMISSING",
    "place_where: WHERE [DET] inner=nominal ISMISSING in_ where=region",
    "place_where: WHERE in_ where=region [DET] inner=nominal ISMISSING",
    "place_where: POINT WHERE [DET] inner=nominal ISMISSING",
    "place_where: WHERE THEREIS GAP",
    "place_where: WHERE THEREIS GAP in_ where=region",
    cost=0.2,
)
def where_missing(inner: Nominal | None = None, where: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "where vines are missing in the south block"."""
    gap = gaps() if inner is None else missing_ones(replace(inner, plural=True))
    if gap is None:
        return None
    return PlaceMeaning(gap.selector if where is None else over(gap.selector, where), "several")
