"""Constructions of captures at a distance from each other: along a row, along any line, and of trees far apart."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import LAST_THING, Amount, CaptureCommand, Nominal, PlaceMeaning, Thing
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("every: EACH far=amount", cost=0.1)
def every_so_far(far: Amount) -> float | None:
    """Compose "every 10 m"."""
    return far.number if far.unit == "metres" else None


@construction(
    "apart: [WITH] far=amount APART",
    "apart: ABOUT far=amount APART",
    "apart: SPACEDBY every=every",
    "apart: SPACEDBY far=amount [APART]",
    "apart: [AT] far=amount INTERVAL",
    "apart: AT [DET] INTERVAL OF far=amount",
    "apart: [WITH] [DET] INTERVAL [OF] [COMMA] far=amount",
    "apart: EACH [ONE] far=amount APART",
    "apart: [WITH] far=amount BETWEEN [DET] POINT",
    "apart: [WITH] far=amount BETWEEN [ONE] READING [AND] [DET] [NEXTONE]",
    cost=0.1,
)
def apart(far: Amount | None = None, every: float | None = None) -> float | None:
    """Compose "10 m apart"."""
    if every is not None:
        return every
    return far.number if far is not None and far.unit == "metres" else None


@construction(
    "apart_least: ATLEAST far=amount APART",
    "apart_least: [EACH] check=CMP far=amount APART",
    "apart_least: SPACEDBY ATLEAST far=amount [APART]",
    cost=0.1,
)
def apart_at_least(far: Amount, check: Lex | None = None) -> float | None:
    """Compose "at least 10 m apart"."""
    if far.unit != "metres" or (check is not None and (check.value is None or check.value[0] not in ("ge", "gt"))):
        return None
    return far.number


@construction("spaced: dist=every", cost=0.0)
def spacing_of_one(dist: float) -> tuple[float, bool]:
    """Compose "every 10 m"."""
    return (dist, False)


@construction("spaced: dist=apart", "spaced: dist=apart_least", cost=0.0)
def spacing_of_many(dist: float) -> tuple[float, bool]:
    """Compose "10 m apart"."""
    return (dist, True)


@construction(
    "own_stops: [STOPBY] POINT [COMMA] dist=spaced",
    "own_stops: STOPEACH dist=every",
    "own_stops: [DET] READING dist=every",
    "own_stops: ONE READING dist=every",
    "own_stops: dist=spaced REMAINS",
    "own_stops: INTERVAL COMMA far=amount",
    cost=0.1,
)
def own_stops(dist: tuple[float, bool] | float | None = None, far: Amount | None = None) -> tuple[float, bool] | None:
    """Compose "stops 20 m apart", "stop every 20 m" and "one reading every 20 m"."""
    if far is not None:
        return (far.number, False) if far.unit == "metres" else None
    return dist if isinstance(dist, tuple) else (dist or 0.0, False)


@construction(
    "capture: [verb] things=things relation n=count POINT dist=spaced",
    "capture: [verb] things=things relation n=count POINT dist=spaced relation place=place",
    cost=0.3,
)
def at_so_many_stops(
    things: tuple[Thing, ...], n: int, dist: tuple[float, bool], used: int, place: PlaceMeaning | None = None
) -> CaptureCommand | None:
    """Compose "take pictures at 5 points every 10 m"."""
    if place is not None and place.shape != "area":
        return None
    return CaptureCommand(tuple(replace(one, count=n) for one in things), place, used, spacing=dist[0])


@construction("at_stops: dist=spaced", "at_stops: dist=own_stops", "at_stops: AT dist=spaced", cost=0.0)
def at_stops(dist: tuple[float, bool]) -> tuple[float, bool]:
    """Compose "every 20 m" and "at stops 20 m apart"."""
    return dist


@construction(
    "capture: [verb] things=things [COMMA] dist=at_stops",
    "capture: [verb] things=things [COMMA] dist=at_stops [COMMA] relation place=place",
    "capture: verb=ACTV dist=at_stops relation place=place",
    cost=0.3,
)
def at_spacing(
    dist: tuple[float, bool],
    used: int,
    things: tuple[Thing, ...] = (),
    place: PlaceMeaning | None = None,
    verb: Lex | None = None,
) -> CaptureCommand | list[CaptureCommand] | None:
    """Compose "take a picture every 10 m along row 3"."""
    if verb is not None:
        naming: Naming = verb.value
        things = (Thing(naming.actions[0]),)
    if place is not None and place.shape not in ("area", "those", "here"):
        return None
    if dist[1] and all(one.count in (None, 1) for one in things):
        dist = (dist[0], False)
    if dist[1]:
        return CaptureCommand(things, place, used, spacing=dist[0])
    once = CaptureCommand(tuple(replace(one, count=None) for one in things), place, used, spacing=dist[0])
    if all(one.count in (None, 1) for one in things):
        return once
    counted = replace(once, things=things)
    if len(things) > 1 or things[0].count is None or place is None:
        return None
    return [counted, replace(once, times=things[0].count)]  # three stops, or three at every stop?


@construction(
    "capture: act=capture [COMMA] dist=at_stops",
    "capture: act=capture FULLSTOP dist=own_stops",
    "capture: dist=at_stops [COMMA] [AND] [each=here] [COMMA] act=capture",
    "capture: dist=at_stops INORDERTO act=capture",
    "capture: dist=at_stops FOR things=things",
    "capture: dist=own_stops FULLSTOP [each=here] [COMMA] act=capture",
    "capture: dist=at_stops relation place=place [COMMA] act=capture",
    "capture: relation place=place [COMMA] dist=at_stops [COMMA] act=capture",
    "capture: place=place COMMA dist=at_stops [COMMA] act=capture",
    cost=0.3,
)
def capture_at_stops(
    dist: tuple[float, bool],
    used: int,
    act: CaptureCommand | None = None,
    things: tuple[Thing, ...] = (),
    place: PlaceMeaning | None = None,
    each: PlaceMeaning | None = None,
) -> CaptureCommand | list[CaptureCommand] | None:
    """Compose "measure CO2 along row 3, with stops 20 m apart" and "make stops 20 m apart; at each measure CO2"."""
    if act is None:
        return at_spacing(dist, used, things)
    if each is not None and (each.shape != "those" or act.place is not None):
        return None
    if act.spacing is not None or act.within is not None or act.times != 1 or act.relation in ("each", "lead"):
        return None
    if any(one.action == LAST_THING for one in act.things):
        return None
    own = None if act.place is not None and act.place.shape in ("those", "here") else act.place  # "at each stop"
    if own is not None and (place is not None or own.per is not None):
        return None
    return at_spacing(dist, used, act.things, place or own)


@construction("capture: SEPARATE things=things BY far=amount [COMMA] [AND] [verb] [n=count] [LIMIT]", cost=0.2)
def separate(things: tuple[Thing, ...], used: int, far: Amount, n: int | None = None) -> CaptureCommand | None:
    """Compose "separate your measurements by 12 m, and carry out four in all"."""
    if far.unit != "metres" or (n is not None and any(one.count is not None for one in things)):
        return None
    counted = things if n is None else tuple(replace(one, count=n, plural=True) for one in things)
    return CaptureCommand(counted, None, used, spacing=far.number)


@construction(
    "capture: verb things=things relation inner=nominal [COMMA] [WHICH] dist=apart",
    "capture: verb things=things relation inner=nominal [COMMA] [WHICH] least=apart_least",
    cost=0.2,
)
def of_trees_apart(
    things: tuple[Thing, ...], inner: Nominal, used: int, dist: float | None = None, least: float | None = None
) -> CaptureCommand | None:
    """Compose "take three pictures of trees 15 m apart"."""
    counts = {one.count for one in things}
    count = counts.pop()
    if counts or count is None or count < 2 or not inner.plural or inner.single or inner.complete:
        return None
    apart = s.Apart(apart_m=dist or least or 0.0, count=count, least=least is not None, of=inner.selector)
    return CaptureCommand(things, PlaceMeaning(apart, "several", count=count), used)
