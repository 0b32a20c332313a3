"""Constructions of captures along a sampling path or on a grid: "20 samples in a W through the north block"."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Adjunct, once
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    Amount,
    CaptureCommand,
    LinkedCommand,
    PaceClause,
    PlaceMeaning,
    Said,
    Thing,
)
from fieldhand.planning.grammar.places.lines import SamplingLine
from fieldhand.planning.grammar.places.points import Points, points_on
from fieldhand.planning.grammar.places.sampling import (
    SamplingPath,
    bare_ground,
    every_so_far_over,
    grid_selector,
    is_on_bare_ground,
    laid_over,
    some_points,
)
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_some, as_zone, chooses_from_trees, over
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: A path, or a straight line, and the area that it crosses; None for the place of the command, or the site.
SamplingWay = tuple[SamplingPath | SamplingLine, s.Selector | None]


@dataclass(frozen=True, slots=True)
class _Route:
    """A path and the area that it crosses; None for the place of the command, or the site."""

    path: SamplingPath | SamplingLine
    where: s.Selector | None
    site: Site = field(compare=False)


@dataclass(frozen=True, slots=True)
class _Cells:
    """The side of the cells of a grid in metres, and the area that it covers; None for the place of the command."""

    every_m: float
    where: s.Selector | None
    site: Site = field(compare=False)


def _area(command: CaptureCommand, where: s.Selector | None) -> s.Selector | None:
    """Return the area of an adjunct within the area of its command; None for the site."""
    place = command.place
    if place is None:
        return where
    return place.selector if where is None else over(place.selector, where)


def _along(command: CaptureCommand, route: _Route) -> CaptureCommand | None:
    """Return a command at as many places along the path as there are captures or trees, or at its spacing."""
    place = command.place
    if place is not None and (place.per is not None or not chooses_from_trees(place.selector)):
        return None
    some = None if place is None else as_some(place.selector)
    if some is not None and some.count > 1 and all(one.count in (None, 1) for one in command.things):
        area = some.of if route.where is None else over(some.of, route.where)
        return _on_way(command, route, route.path.over(area, route.site, count=some.count), some.count)
    if place is not None and place.shape != "area":
        return None
    area_there = _area(command, route.where)
    counts = {one.count for one in command.things}
    count = next(iter(counts)) if len(counts) == 1 else None
    if command.spacing is not None:
        if count not in (None, 1):
            return None
        made = route.path.over(area_there, route.site, apart_m=command.spacing)
        return _on_way(replace(command, spacing=None), route, made, None)
    if count is None or count < 2:
        return None
    return _on_way(command, route, route.path.over(area_there, route.site, count=count), count)


def _on_way(
    command: CaptureCommand, route: _Route, points: s.Selector | None, count: int | None
) -> CaptureCommand | None:
    """Return a command at points of a path, in their order if the path says so."""
    made = _at(command, points, count)
    in_order = isinstance(route.path, SamplingPath) and route.path.in_order
    if made is None or made.place is None or not in_order:
        return made
    return replace(made, place=replace(made.place, in_order=True))


def _on_grid(command: CaptureCommand, cells: _Cells) -> CaptureCommand | None:
    """Return a command at the places of a grid over the area."""
    place = command.place
    if command.spacing is not None or any(one.count not in (None, 1) for one in command.things):
        return None
    if place is not None:
        whole = place.shape == "area" or (place.shape == "several" and place.count is None)
        if not whole or place.per is not None or not chooses_from_trees(place.selector):
            return None
    return _at(command, grid_selector(cells.every_m, _area(command, cells.where), cells.site), None)


def _at(command: CaptureCommand, selector: s.Selector | None, count: int | None) -> CaptureCommand | None:
    if selector is None:
        return None
    there = PlaceMeaning(selector, "several", count=count, each=count is None)
    return replace(command, things=once(command.things), place=there, relation="at")


@construction("adjunct: along=path_over", cost=0.2, given=("site",))
def along_path(along: SamplingWay, site: Site) -> Adjunct:
    """Compose "in a W through the north block", of so many samples."""
    return Adjunct(_along, _Route(*along, site), may_lead=True, late=True, lays_out=True)


@construction("said: along=path_over [COMMA] how=pace [COMMA] AND act=capture", cost=0.3, given=("site",))
def round_at_pace(
    along: SamplingWay,
    how: PaceClause,
    act: CaptureCommand,
    used: int,
    site: Site,
) -> Said | None:
    """Compose "circle the pond at 0.5 m/s and take a picture every 10 m"."""
    made = _along(act, _Route(*along, site))
    if made is None:
        return None
    return Said((LinkedCommand(None, replace(made, used=used & ~how.used)), LinkedCommand(None, how)))


@construction("said: along=path_over [COMMA] [AND] act=capture", cost=0.1, given=("site",))
def on_the_way_round(along: SamplingWay, act: CaptureCommand, used: int, site: Site) -> Said | None:
    """Compose "drive round the paddock and take a picture every 5 m", on the way."""
    if act.spacing is None or act.place is not None:
        return None
    made = _along(act, _Route(*along, site))
    return None if made is None else Said((LinkedCommand(None, replace(made, used=used)),))


@construction("adjunct: ONPATH", "adjunct: ONTHEWAY", cost=0.2)
def on_path() -> Adjunct:
    """Compose "on it" behind the samples of a path."""
    return Adjunct(_on_path, late=True)


def _on_path(command: CaptureCommand, _: None) -> CaptureCommand | None:
    shape = "" if command.place is None else getattr(command.place.selector, "shape", "")
    return command if shape else None


@construction("capture: dist=every ALONG rows=rows", "capture: ALONG rows=rows dist=every", cost=0.6)
def spaced_again(dist: float, rows: s.Selector, used: int) -> CaptureCommand:
    """Compose "every 5 m along bed 8" behind what is captured at another place."""
    along = PlaceMeaning(rows, "area")
    return CaptureCommand((Thing(LAST_THING),), along, used, relation="along", spacing=dist)


@construction("adjunct: on=grid_over", cost=0.2, given=("site",))
def on_grid(on: tuple[float, s.Selector | None], site: Site) -> Adjunct:
    """Compose "on a 20 m grid over the meadow"."""
    return Adjunct(_on_grid, _Cells(*on, site), may_lead=True, lays_out=True)


@construction("adjunct: word=OVER where=region COMMA once=things EACH far=amount", cost=0.2, given=("site",))
def one_every_so_far(word: Lex, where: s.Selector, once: tuple[Thing, ...], far: Amount, site: Site) -> Adjunct | None:
    """Compose "all over the patch, one picture every 4 m", of pictures."""
    on = every_so_far_over(word, where, far)
    return None if on is None else Adjunct(_on_grid_once, (_Cells(*on, site), once), lays_out=True)


def _on_grid_once(command: CaptureCommand, laid: tuple[_Cells, tuple[Thing, ...]]) -> CaptureCommand | None:
    """Return a command at the places of a grid, if its captures are what is named again, once at each."""
    cells, once = laid
    same = [one.action for one in command.things] == [one.action for one in once] and len(once) == 1
    return _on_grid(command, cells) if same and once[0].count == 1 else None


@construction("adjunct: every=each_way", cost=0.2, given=("site",))
def each_way(every: float, site: Site) -> Adjunct:
    """Compose "one probe every 25 m each way"."""
    return on_grid((every, None), site)


# Paths and grids that are laid first, and what is done there.


@construction(
    "walked: along=path_over",
    "walked: PATHGO where=region path=in_path",
    "walked: PATHGO OVER where=region path=in_path",
    "walked: path=path OVER where=region",
    "walked: path=path in_ where=region",
    "walked: [TAKE] times=laps where=lapped",
    "walked: [GO] times=often [COMMA] AROUND where=region",
    cost=0.1,
)
def walked(
    along: SamplingWay | None = None,
    path: SamplingPath | None = None,
    where: s.Selector | None = None,
    times: int = 1,
) -> SamplingWay | None:
    """Compose "cross the meadow in an X" before what is done on the way, and "one lap of the pond"."""
    if times != 1:
        return None
    return along or (path or SamplingPath("edge", 1), where)


@construction(
    "capture: on=walked [COMMA] [AND] verb things=things AT n=count POINT [ONTHEWAY]",
    "capture: on=walked [COMMA] [AND] verb things=things n=count TIMES [ONTHEWAY]",
    "capture: on=walked [COMMA] [AND] STOP [n=count] TIMES [ONTHEWAY] INORDERTO verb things=things",
    "capture: on=walked [COMMA] [AND] STOP AT n=count POINT [ONTHEWAY] INORDERTO verb things=things",
    "capture: on=walked [COMMA] [AND] STOPEACH AT n=count POINT [ONTHEWAY] INORDERTO verb things=things",
    "capture: on=walked [COMMA] WITH n=count POINT FOR things=things",
    cost=0.2,
    given=("site",),
)
def captured_on_the_way(
    on: SamplingWay,
    things: tuple[Thing, ...],
    used: int,
    site: Site,
    n: int = 0,
) -> CaptureCommand | None:
    """Compose "walk the slope in a W and read nitrate at fifteen stops on the way"."""
    path, where = on
    if n < 2 or any(one.count not in (None, 1) for one in things):
        return None
    return _at(CaptureCommand(things, None, used), path.over(where, site, count=n), n)


@construction(
    "at_corners: [AT] [DET] [n=count] noun=CORNER", "at_corners: [AT] DET [n=count] noun=CORNER OF IT", cost=0.0
)
@construction(
    "at_corners: [AT] word=EACH [DET] [n=count] noun=CORNER ", "at_corners: [AT] word=EACH noun=CORNER OF IT", cost=0.0
)
@construction("at_corners: [AT] word=EACH OF DET [n=count] noun=CORNER", cost=0.0)
def at_corners(noun: Lex, n: int | None = None, word: Lex | None = None) -> str | None:
    """Compose "in each corner" and "at each of its four corners"."""
    return "corners" if n in (None, 4) and (word is not None or noun.plural) else None


@construction(
    "capture: on=walked [COMMA] [AND] WITH things=things at_corners",
    "capture: on=walked [COMMA] [AND] STOPEACH at_corners FOR things=things",
    "capture: on=walked [COMMA] [AND] STOPEACH at_corners [COMMA] INORDERTO verb things=things",
    "capture: on=walked [COMMA] [AND] joint=verb things=things at_corners",
    "capture: on=walked [COMMA] [AND] joint=ACTV at_corners",
    cost=0.0, given=("site",),
)  # fmt: skip
def captured_at_corners(
    on: SamplingWay,
    used: int,
    site: Site,
    things: tuple[Thing, ...] = (),
    joint: Lex | str | None = None,
) -> CaptureCommand | None:
    """Compose "go once round the paddock with a picture in each corner"."""
    path, where = on
    ground = bare_ground(s.Trees() if where is None else where, site)
    if (
        isinstance(path, SamplingLine)
        or path.shape != "edge"
        or (ground is not None and (ground.left_out or ground.part != "all"))
    ):
        return None
    if isinstance(joint, Lex):
        things = (Thing(joint.value.actions[0]),)
    if not things or any(one.count not in (None, 1) for one in things):
        return None
    if ground is None:  # "drive round the orchard and take a picture at each corner" are two steps
        at = s.Corners(of=where or s.Trees()) if joint is None else None
    else:
        zone = ground.zone or next((one.name for one in site.zones if one.kind == "boundary"), "")
        at = s.Corners(zone=zone) if zone else None
    return None if at is None else CaptureCommand(once(things), PlaceMeaning(at, "several", count=4, each=True), used)


@construction(
    "laid: LAYS every=cells OVER where=region",
    "laid: LAYS every=cells AT where=region",
    "laid: LAYS every=cells OPPOSITE where=region",
    "laid: LAYS where=region AT every=cells",
    "laid: COVERS where=region WITH every=cells",
    "laid: LAYS every=cells OVER site",
    cost=0.1,
)
def laid(every: float, where: s.Selector | None = None) -> tuple[float, s.Selector | None]:
    """Compose "lay a 25 m grid over the meadow"."""
    return every, where


@construction(
    "capture: on=laid [COMMA] AND verb things=things AT EACH GRIDPOINT",
    "capture: on=laid [COMMA] AND verb things=things AT EACH [OFTHEM]",
    "capture: on=laid [COMMA] AND verb things=things AT EACH OF ITS GRIDPOINT",
    "capture: on=laid [COMMA] AND verb things=things place=here",
    cost=0.2,
    given=("site",),
)
def captured_on_grid(
    on: tuple[float, s.Selector | None],
    things: tuple[Thing, ...],
    used: int,
    site: Site,
    place: PlaceMeaning | None = None,
) -> CaptureCommand | None:
    """Compose "lay a 25 m grid over the meadow and test the soil moisture at every point"."""
    every, where = on
    each = place is None or (place.shape == "those" and place.each)
    if not each or any(one.count not in (None, 1) for one in things):
        return None
    return _at(CaptureCommand(things, None, used), grid_selector(every, where, site), None)


@construction("open_points: points=points", "open_points: POINT gap=apart", cost=0.0)
def open_points(points: Points | None = None, gap: float = 0.0) -> Points | float | None:
    """Compose "ten random spots" and "points 30 m apart" of ground that is named elsewhere."""
    return gap if points is None else points if points.where is None else None


@dataclass(frozen=True, slots=True)
class _Laid:
    """Points without their ground, or the side of the cells of a grid."""

    points: Points | float
    site: Site = field(compare=False)


@construction("adjunct: AT points=points", cost=0.2)
def as_many_points_as_captures(points: Points) -> Adjunct | None:
    """Compose "(eight readings) at spots distributed evenly over the slope"."""
    return Adjunct(_as_many_points, points) if points.where is not None and points.count is None else None


def _as_many_points(command: CaptureCommand, points: Points) -> CaptureCommand | None:
    counts = {one.count for one in command.things}
    count = counts.pop() if len(counts) == 1 else None
    if command.place is not None or points.where is None or count is None or count < 2:
        return None
    there = points_on(points.where, count, random=points.random)
    return replace(command, things=once(command.things), place=there, relation="at")


@construction("adjunct: AT points=open_points", cost=0.2, given=("site",))
def at_points(points: Points | float, site: Site) -> Adjunct:
    """Compose "at ten random spots" behind the ground on which they are."""
    return Adjunct(_at_points, _Laid(points, site), of_place=True, is_sentence=True)


def _at_points(command: CaptureCommand, laid: _Laid) -> CaptureCommand | None:
    place, points = command.place, laid.points
    if place is None or place.shape != "area" or place.per is not None or command.spacing is not None:
        return None
    counts = {one.count for one in command.things}
    if not isinstance(points, Points):
        free = bare_ground(place.selector, laid.site) is not None and counts <= {None, 1}
        return _at(command, grid_selector(points, place.selector, laid.site), None) if free else None
    own = counts.pop() if len(counts) == 1 else None
    if not (points.random or points.even or bare_ground(place.selector, laid.site) is not None):
        return None
    if None not in (own, points.count) and own not in (1, points.count):
        return None
    number = points.count or own or 0
    if number < 2:
        return None
    return _at(command, some_points(place.selector, laid.site, number, random=points.random), number)


@construction(
    "fronted: word=AT where=region [COMMA]",
    "fronted: OVER where=region [COMMA]",
    "fronted: INSIDE where=region [COMMA]",
    "fronted: word=AT WHOLEOF where=region [COMMA]",
    "fronted: OVER WHOLEOF where=region [COMMA]",
    cost=0.1,
)
def fronted(where: s.Selector, word: Lex | None = None) -> s.Selector | None:
    """Compose "over the paddock," before what is done there."""
    return where if word is None or "within" in word.features else None


@construction("capture: where=fronted act=capture", cost=0.2, given=("site",))
def captured_over(where: s.Selector, act: CaptureCommand, used: int, site: Site) -> CaptureCommand | None:
    """Compose "over the paddock, test the soil moisture on a 30 m grid"."""
    place = act.place
    if place is None or place.shape != "several" or act.spacing is not None:
        return None
    made = laid_over(place.selector, where, site)
    return None if made is None else replace(act, place=replace(place, selector=made), used=used)


@construction("capture: where=fronted act=capture AT points=open_points", cost=0.2, given=("site",))
def captured_at_points(
    where: s.Selector, act: CaptureCommand, points: Points | float, used: int, site: Site
) -> CaptureCommand | None:
    """Compose "in the paddock, measure nitrate at ten random spots"."""
    if act.place is not None or act.times > 1:
        return None
    made = _at_points(replace(act, place=PlaceMeaning(where, "area")), _Laid(points, site))
    return None if made is None else replace(made, used=used)


@construction(
    "place: [DET] POINT gap=apart OVER where=region", "place: [DET] POINT gap=apart in_ where=region",
    "place: [DET] POINT gap=apart OPPOSITE where=region",
    cost=0.2, given=("site",),
)  # fmt: skip
def points_apart_on_ground(gap: float, where: s.Selector, site: Site) -> PlaceMeaning | None:
    """Compose "points 30 m apart over the slope", of ground without plants."""
    if bare_ground(where, site) is None:
        return None
    points = grid_selector(gap, where, site)
    return None if points is None else PlaceMeaning(points, "several", each=True)


@construction(
    "capture: act=capture [COMMA] except [AT] out=region",
    "capture: act=capture [COMMA] except [AT] DET GRIDPOINT in_ out=region",
    cost=0.3,
    given=("site",),
)
def points_but_those(act: CaptureCommand, out: s.Selector, used: int, site: Site) -> CaptureCommand | None:
    """Compose "... at every point, except in the wet corner", of points of bare ground."""
    zone, place = as_zone(out), act.place
    if place is None or zone is None or zone.outside or zone.margin_m or zone.of != s.Trees():
        return None
    if not is_on_bare_ground(place.selector, site) or place.count is not None:
        return None
    outside = s.InZone(zone=zone.zone, outside=True, of=place.selector)
    return replace(act, place=replace(place, selector=outside), used=used)


@construction(
    "laid_places: LAYS path=path WITH n=count POINT OVER where=region",
    "laid_places: LAYS path=path OF n=count POINT OVER where=region",
    "laid_places: LAYS path=path OVER where=region WITH n=count POINT",
    "laid_places: LAYS path=path in_ where=region WITH n=count POINT",
    "laid_places: LAYS path=path WITH n=count POINT in_ where=region",
    "laid_places: LAYS path=path WITH n=count POINT THROUGH where=region",
    "laid_places: LAYS path=path WITH n=count TREE OVER where=region",
    "laid_places: LAYS path=path WITH n=count TREE OVER site",
    "laid_places: LAYS path=path WITH n=count TREE THROUGH site",
    "laid_places: LAYS path=path WITH n=count POINT OVER site",
    "laid_places: LAYS path=path OVER site WITH n=count POINT",
    "laid_places: on=walked WITH n=count POINT",
    "laid_places: on=walked OF n=count POINT",
    cost=0.1, given=("site",),
)  # fmt: skip
def laid_along_path(
    n: int,
    site: Site,
    path: SamplingPath | None = None,
    where: s.Selector | None = None,
    on: SamplingWay | None = None,
) -> PlaceMeaning | None:
    """Compose "lay a W with twelve points over the slope"."""
    route, over_what = on if on is not None else (path, where)
    made = None if route is None or n < 2 else route.over(over_what, site, count=n)
    return None if made is None else PlaceMeaning(made, "several", count=n)


@construction("laid_places: LAYS place=place", "laid_places: SCATTER place=place", cost=0.2)
def laid_points(place: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "set out twelve points over the slope"."""
    laid = all(hasattr(one, "zone") and as_zone(one) is None for one in place.selector.members)
    return place if laid and place.shape == "several" else None


@construction("at_each: AT EACH GRIDPOINT", "at_each: AT EACH [OFTHEM]", cost=0.0)
def at_each_point() -> str:
    """Compose "at every point"."""
    return "each"


@construction("at_each: place=here", cost=0.1)
def at_each_of_them(place: PlaceMeaning) -> str | None:
    """Compose "at each of them"."""
    return "each" if place.shape == "those" and place.each else None


@construction(
    "capture: place=laid_places [COMMA] AND verb things=things at_each",
    "capture: place=laid_places FULLSTOP [at_each] [COMMA] verb things=things",
    "capture: place=laid_places FULLSTOP verb things=things at_each",
    "capture: place=laid_places [COMMA] AND at_each [COMMA] verb things=things",
    cost=0.2,
)
def captured_at_laid(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "lay a W with twelve points over the slope and read the soil moisture at each of them"."""
    if any(one.count not in (None, 1) for one in things):
        return None
    return CaptureCommand(once(things), replace(place, each=True), used, relation="at")
