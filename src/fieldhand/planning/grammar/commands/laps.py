"""Constructions of laps, of rests between them, and of captures with a time between them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from shapely import unary_union
from shapely.geometry.base import BaseGeometry

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Adjunct
from fieldhand.planning.grammar.commands.waits import LONGEST_WAIT_S
from fieldhand.planning.grammar.commands.working import Tract
from fieldhand.planning.grammar.meaning import (
    MOST_LAPS,
    NOW_AND_THEN_S,
    THAT_GROUND,
    Amount,
    CaptureCommand,
    WorkCommand,
    rested_things,
)
from fieldhand.planning.grammar.places.areas import edges
from fieldhand.planning.grammar.places.numbers import amount
from fieldhand.planning.grammar.places.sampling import SamplingPath, bare_zone, is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, as_zone, is_one_row
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Greatest part of the ground inside of a fence that the fence takes up, and least part of the site that is inside.
_THIN, _NEARLY = 0.1, 0.8
#: Half of the greatest width of a fence or wall in metres.
_HALF_A_FENCE_M = 0.4
#: Maximum number of captures with a rest between them.
_MOST_RESTED = 50

#: Difference of a width from that of so many laps, in laps, that is none.
_SAME_WIDTH = 0.05


# --- laps -------------------------------------------------------------------------------------------------------------


@construction("laps: n=count ROUND", "laps: [DET] noun=ROUND", cost=0.1)
def laps(n: int = 1, noun: Lex | None = None) -> int | None:
    """Compose "two laps" and "a lap"."""
    return None if noun is not None and noun.plural else n


@construction(
    "lapped: OF line=edge_line", "lapped: OF where=region", "lapped: OF site", "lapped: edge=edge",
    "lapped: [AROUND] inside=INSIDE where=region", cost=0.1, given=("site",),
)  # fmt: skip
def lapped(
    site: Site,
    line: s.Selector | None = None,
    where: s.Selector | None = None,
    edge: Tract | None = None,
    inside: Lex | None = None,
) -> s.Selector | None:
    """Compose "of the boundary", "around the pond" and "just inside the paddock" behind "two laps"."""
    if where is not None and (are_rows(where) or where == edges()):
        return None
    if inside is not None and where is not None and (is_keep_out(where, site) or as_zone(where) is None):
        return None
    if edge is not None and edge.heading != "any":
        return None
    return edge.selector if edge is not None else line or where or s.Trees()


@construction("edge: AROUND ALONG line=edge_line", cost=0.1)
def round_along(line: s.Selector) -> Tract:
    """Compose "round along the boundary"."""
    return Tract(line, "perimeter")


@construction(
    "edge: ALONG fence=region",
    "edge: AROUND ALONG fence=region",
    cost=0.2,
    given=("site",),
)
def along_fence(fence: s.Selector, site: Site) -> Tract | None:
    """Compose "along the deer fence"."""
    return Tract(fence, "perimeter") if is_keep_out(fence, site) else None


@construction("edge: fence=region", cost=0.2, given=("site",))
def fence_itself(fence: s.Selector, site: Site) -> Tract | None:
    """Compose "the deer fence" of "film the deer fence", along which the robot drives, and "the pond"."""
    return Tract(fence, "perimeter", solid=not is_thin(fence, site)) if is_keep_out(fence, site) else None


@construction("work: one=work [COMMA] AROUND", cost=0.2)
def all_the_way_round(one: WorkCommand, used: int) -> WorkCommand | None:
    """Compose "film the deer fence all the way round"."""
    if one.mode == "rows" and one.along is not None and one.along.whole_zone and one.sides == "one":
        return replace(one, mode="perimeter", used=used)  # "film the paddock all the way round"
    return replace(one, used=used) if one.along is None or one.mode == "perimeter" else None


@construction("work: one=work [COMMA] EDGEIN", "work: one=work [COMMA] out=EDGEOUT", cost=0.2)
def on_one_side_of_edge(one: WorkCommand, used: int, out: Lex | None = None) -> WorkCommand | None:
    """Compose "film the deer fence from the inside"."""
    known = not one.edge_side and (one.along is None or one.mode == "perimeter")
    return replace(one, edge_side="inside" if out is None else "outside", used=used) if known else None


@construction(
    "edge: [AROUND] INSIDE fence=region", "edge: [AROUND] ALONG [DET] INSIDE fence=region", cost=0.2, given=("site",)
)
def inside_fence(fence: s.Selector, site: Site) -> Tract | None:
    """Compose "just inside the deer fence", which stands around the site; a pond has no such side."""
    return Tract(fence, "perimeter") if is_keep_out(fence, site) and goes_around(fence, site) else None


@construction(
    "edge: [AROUND] INSIDE line=edge_line", "edge: [AROUND] ALONG [DET] INSIDE line=edge_line", cost=0.1,
    given=("site",),
)  # fmt: skip
def inside_edge(line: s.Selector, site: Site) -> Tract | None:
    """Compose "just inside the edge of the paddock", where the robot drives along it anyway; of a pond it cannot."""
    return None if is_keep_out(line, site) and not goes_around(line, site) else Tract(line, "perimeter")


def goes_around(fence: s.Selector, site: Site) -> bool:
    """Return True for what is thin and stands around nearly the whole site."""
    own = _ground_of(fence, site)
    whole = unary_union([one.polygon for one in site.zones if one.kind == "boundary"])
    around = own.convex_hull.area
    return own.area < _THIN * around and around >= _NEARLY * whole.area > 0.0


def is_thin(fence: s.Selector, site: Site) -> bool:
    """Return True for a fence or a wall, which has ground on both of its sides."""
    return bool(_ground_of(fence, site).buffer(-_HALF_A_FENCE_M).is_empty)


def _ground_of(fence: s.Selector, site: Site) -> BaseGeometry:
    zone = as_zone(fence)
    return unary_union([one.polygon for one in site.zones if zone is not None and one.name == zone.zone])


@construction("work: [TAKE] times=laps where=lapped", "work: GO [FOR] times=laps where=lapped", cost=0.2)
@construction(
    "work: [TAKE] times=laps way=CLOCKWISE where=lapped", "work: GO times=laps way=CLOCKWISE where=lapped", cost=0.2
)
def so_many_laps(times: int, where: s.Selector, used: int, way: Lex | None = None) -> WorkCommand | None:
    """Compose "do two laps of the boundary" and "three laps clockwise around the pond"."""
    made = _driven(where, times, used)
    if made is None or way is None:
        return made
    return replace(made, heading="counterclockwise" if "against" in way.features else "clockwise")


@construction("work: verb=GO times=often where=edge", "work: GO times=often [COMMA] where=edge", cost=0.1)
def often_around(times: int, where: Tract, used: int, verb: Lex | None = None) -> WorkCommand | None:
    """Compose "drive twice around the pond"."""
    del verb
    made = _driven(where.selector, times, used)
    return None if made is None else replace(made, heading=where.heading)


@construction("work: times=often AROUND line=edge_line", "work: times=often AROUND where=region", cost=0.3)
@construction("work: times=often AROUND site", "work: times=often AROUND ALONG line=edge_line", cost=0.3)
def once_around(
    times: int, used: int, line: s.Selector | None = None, where: s.Selector | None = None
) -> WorkCommand | None:
    """Compose "once round the orchard", without a verb."""
    if where is not None and are_rows(where):
        return None
    return _driven(line or where or s.Trees(), times, used)


@construction(
    "work: verb=WORKV times=laps where=lapped", "work: verb=WORKV times=often [COMMA] where=edge",
    "work: verb=WORKV [DET] STRIP where=lapped", cost=0.1,
)  # fmt: skip
def worked_in_laps(verb: Lex, used: int, times: int = 1, where: s.Selector | Tract | None = None) -> WorkCommand | None:
    """Compose "mow two laps around the paddock", "mow once along the fence" and "mow a strip around the pond"."""
    along = where.selector if isinstance(where, Tract) else where
    made = None if along is None else _driven(along, times, used)
    heading = where.heading if isinstance(where, Tract) else "any"
    return None if made is None else replace(made, action=verb.value, heading=heading)


@construction(
    "worked_laps: times=laps [COMMA] WITH [DET] verb=WORKN", "worked_laps: WITH [DET] verb=WORKN [COMMA] times=laps",
    "worked_laps: times=often [COMMA] WITH [DET] verb=WORKN", "worked_laps: WITH [DET] verb=WORKN [COMMA] times=often",
    "worked_laps: [DET] verb=WORKN times=laps", "worked_laps: [DET] verb=WORKN times=often", cost=0.1,
)  # fmt: skip
def laps_with(verb: Lex, times: int) -> tuple[Lex, int]:
    """Compose "two rounds with the mower" and "(run) the mower twice"."""
    return verb, times


@construction(
    "work: [TAKE] laps=worked_laps where=lapped", "work: GO [FOR] laps=worked_laps where=lapped",
    "work: USE laps=worked_laps where=lapped",
    "work: [ONLY] where=edge [COMMA] laps=worked_laps", "work: GO where=edge [COMMA] laps=worked_laps", cost=0.1,
)  # fmt: skip
def worked_laps(laps: tuple[Lex, int], where: s.Selector | Tract, used: int) -> WorkCommand | None:
    """Compose "one round with the mower along the fence" and "only the edge, two rounds with the mower"."""
    return worked_in_laps(laps[0], used, laps[1], where)


@construction(
    "strip: [DET] STRIP far=amount DIMENSION",
    "strip: [DET] STRIP OF far=amount",
    "strip: [DET] far=amount [DASH] [DIMENSION] STRIP",
    cost=0.1,
)
def strip(far: Amount) -> float | None:
    """Compose "a strip 3 m wide"."""
    return far.number if far.unit == "metres" and far.number > 0.0 else None


@construction("work: verb=WORKV wide=strip where=lapped", cost=0.1, given=("robot",))
def worked_strip(verb: Lex, wide: float, where: s.Selector, used: int, robot: RobotProfile) -> list[WorkCommand] | None:
    """Compose "mow a strip 3 m wide around the paddock"."""
    return strip_around(verb, where, wide, used, robot) or None


def strip_around(verb: Lex, where: s.Selector, wide: float | None, used: int, robot: RobotProfile) -> list[WorkCommand]:
    """Return work on a strip along an edge, in as many laps side by side as it is wide; between two numbers, either."""
    if wide is None:
        once = _driven(where, 1, used)
        return [] if once is None else [replace(once, action=verb.value)]
    implement = robot.action[verb.value].implement
    width_m = None if implement is None or not implement.covers else implement.width_m
    if width_m is None:
        return []
    laps = wide / width_m
    numbers = {max(1, math.floor(laps + _SAME_WIDTH)), max(1, math.ceil(laps - _SAME_WIDTH))}
    made = [_driven(where, times, used) for times in sorted(numbers)]
    return [replace(one, action=verb.value) for one in made if one is not None]


@construction("circled: CIRCLEV where=region", "circled: CIRCLEV IT", "circled: GO AROUND IT", cost=0.1)
def circled(where: s.Selector | None = None) -> s.Selector | None:
    """Compose "circle the pond" and "drive round it"."""
    known = where is None or not (are_rows(where) or where == edges())
    return (where or s.InZone(zone=THAT_GROUND)) if known else None


@construction("work: where=circled", "work: GO times=often AROUND it=IT", cost=0.1)
def circles(used: int, where: s.Selector | None = None, times: int = 1, it: Lex | None = None) -> WorkCommand | None:
    """Compose "circle the pond" by itself, and "drive twice round it"."""
    del it
    return _driven(where or s.InZone(zone=THAT_GROUND), times, used)


@construction("path_over: where=circled [ONCE]", "path_over: GO ONCE AROUND it=IT", "path_over: AROUND it=IT", cost=0.2)
def on_the_round(where: s.Selector | None = None, it: Lex | None = None) -> tuple[SamplingPath, s.Selector | None]:
    """Compose "circle it once", of captures on the way."""
    del it
    return SamplingPath("edge", 1), where or s.InZone(zone=THAT_GROUND)


def _driven(where: s.Selector, times: int, used: int) -> WorkCommand | None:
    """Return a drive around an area."""
    if not 1 <= times <= MOST_LAPS:
        return None
    return WorkCommand(action="", along=where, mode="perimeter", used=used, laps=times)


@construction("work: one=work [COMMA] times=often", cost=0.1)
def worked_so_often(one: WorkCommand, times: int, used: int) -> WorkCommand | None:
    """Compose "patrol the boundary five times"."""
    if one.laps != 1 or not 1 <= times <= MOST_LAPS or one.along is None:
        return None
    return replace(one, laps=times, used=used)


# --- rests ------------------------------------------------------------------------------------------------------------


@construction(
    "between_them: BETWEEN [DET] [EACH] ROUND",
    "between_them: BETWEEN [DET] READING",
    "between_them: BETWEEN EACH [ONE]",
    "between_them: INBETWEEN [EACH]",
    "between_them: APARTEACH",
    cost=0.1,
)
def between_them() -> str:
    """Compose "between rounds" and "in between"."""
    return "between"


@construction(
    "rest: [WITH] time=wait [COMMA] between_them",
    "rest: [WITH] [DET] time=wait between_them",
    "rest: between_them [COMMA] time=wait",
    "rest: [WITH] time=amount between_them",
    cost=0.1,
)
def rest(time: float | Amount) -> float | None:
    """Compose "with a ten-minute rest between rounds"."""
    if isinstance(time, float):
        return time
    return time.number if time.unit == "seconds" and 0.0 < time.number <= LONGEST_WAIT_S else None


@construction(
    "rest: [AT] far=amount APART", "rest: AT far=amount INTERVAL", "rest: [AT] [DET] INTERVAL OF far=amount", cost=0.1
)
@construction(
    "rest: AT [DET] far=amount [DASH] INTERVAL",
    "rest: WITH far=amount BETWEEN [DET] READING",
    cost=0.1,
)
def time_apart(far: Amount) -> float | None:
    """Compose "ten minutes apart" and "at ten-minute intervals"."""
    return rest(far)


@construction("recurs: [ONCE] EACH gap=amount", "recurs: [ONCE] EACH [half=HALF] unit=UNIT", cost=0.1)
def recurs(gap: Amount | None = None, unit: Lex | None = None, half: Lex | None = None) -> float | None:
    """Compose "every ten minutes", "every minute" and "every half hour"."""
    if unit is not None:
        return rest(amount(Lex(1.0 if half is None else 0.5, False, ""), unit))
    return None if gap is None else rest(gap)


@construction(
    "work: one=work [COMMA] [and_or_but] time=rest",
    "work: one=work FULLSTOP time=rest",
    cost=0.1,
)
def rests_between_laps(one: WorkCommand, time: float, used: int) -> WorkCommand | None:
    """Compose "patrol the boundary three times, with a ten-minute rest between rounds"."""
    return replace(one, rest_s=time, used=used) if one.laps > 1 and not one.rest_s and not one.optional else None


@construction(
    "work: one=work [COMMA] [WITH] time=wait AFTEREACH",
    "work: one=work [COMMA] [and_or_but] time=wait AFTEREACH",
    cost=0.1,
)
def rests_after_each_lap(one: WorkCommand, time: float, used: int) -> WorkCommand | None:
    """Compose "patrol the boundary three times with a ten-minute rest after each"."""
    made = rests_between_laps(one, time, used)
    return None if made is None else replace(made, rests_last=True)


@construction(
    "at_row_ends: AT DET FINISH OF each=EACH [DET] ROW", "at_row_ends: AT DET FINISH OF each=EACH [ONE]",
    "at_row_ends: AT each=EACH ROW FINISH", "at_row_ends: AT each=EACH ROW [DASH] FINISH",
    "at_row_ends: after=THEN each=EACH [DET] ROW", "at_row_ends: AT DET FINISH OF DET ROW",
    "at_row_ends: AT ITS FINISH", "at_row_ends: AT DET FINISH", cost=0.1,
)  # fmt: skip
def at_row_ends(each: Lex | None = None, after: Lex | None = None) -> str | None:
    """Compose "at the end of each row", and "at the end" of a single one."""
    if after is not None and "after_doing" not in after.features:
        return None
    return "one" if each is None else "each"


@construction(
    "work: one=work [COMMA] [and_or_but] [WITH] time=wait ends=at_row_ends",
    "work: one=work [COMMA] [and_or_but] ends=at_row_ends [COMMA] time=wait",
    "work: one=work FULLSTOP time=wait ends=at_row_ends", "work: one=work FULLSTOP ends=at_row_ends [COMMA] time=wait",
    cost=0.1,
)  # fmt: skip
def rests_at_row_ends(one: WorkCommand, time: float, ends: str, used: int) -> WorkCommand | None:
    """Compose "film rows 7 and 8 and wait half a minute at the end of each row"."""
    fits = one.mode == "rows" and one.laps == 1 and one.sides != "both" and not one.optional and not one.rest_s
    single = one.along is not None and is_one_row(one.along)
    if not fits or one.along is None or (ends == "one" and not single):
        return None
    return replace(one, rest_s=time, rests_rows=True, used=used)


@dataclass(frozen=True, slots=True)
class _Rest:
    """A wait between captures, on a site; ``recurs`` if the phrase says that they are made again and again."""

    seconds: float
    site: Site = field(compare=False)
    recurs: bool = False


def _rested(command: CaptureCommand, rest: _Rest) -> CaptureCommand | None:
    """Return captures at one place, or at each of several, with a wait between one and the next."""
    counts = {one.count for one in command.things}
    place = command.place
    if command.spacing is not None or len(counts) != 1:
        return None
    count = next(iter(counts)) or 1
    if count == command.times == 1 and rest.recurs:
        return replace(command, every_s=rest.seconds)  # for how long is said elsewhere
    times = command.times if count == 1 else count if command.times == 1 else 0
    if not 2 <= times <= _MOST_RESTED:
        return None
    single = place is None or place.shape in ("one", "here") or bool(bare_zone(place.selector, rest.site))
    if place is not None and not single and not (place.shape == "several" and place.each):
        return None
    once = tuple(replace(one, count=1) for one in command.things)
    return replace(command, things=rested_things(once, times, rest.seconds), times=1)


@construction("adjunct: [and_or_but] time=rest", cost=0.2, given=("site",))
def rests_between_captures(time: float, site: Site) -> Adjunct:
    """Compose "three times, ten minutes apart"."""
    return Adjunct(_rested, _Rest(time, site), late=True)


@construction("adjunct: [AND] time=recurs", cost=0.2, given=("site",))
def captured_again_and_again(time: float, site: Site) -> Adjunct:
    """Compose "six times, every ten minutes" and "every ten minutes", for how long is said beside it."""
    return Adjunct(_rested, _Rest(time, site, recurs=True), late=True, may_lead=True)


def _now_and_then(command: CaptureCommand, _: None) -> CaptureCommand | None:
    """Return captures of which it is asked how often they are made."""
    counts = {one.count or 1 for one in command.things}
    return (
        replace(command, every_s=NOW_AND_THEN_S) if counts == {1} and command.times == 1 and not command.for_s else None
    )


@construction("adjunct: VAGUEOFTEN", cost=0.2)
def captured_now_and_then() -> Adjunct:
    """Compose "every so often"."""
    return Adjunct(_now_and_then, None, late=True, may_lead=True)


@construction(
    "adjunct: FOR [DET] time=amount [INALL]",
    "adjunct: OVER [DET] time=amount [INALL]",
    "adjunct: FORNEXT time=amount",
    "adjunct: [COMMA] time=amount INALL",
    cost=0.4,
)
@construction("adjunct: FORNEXT unit=UNIT", cost=0.4)
def for_so_long(time: Amount | None = None, unit: Lex | None = None) -> Adjunct | None:
    """Compose "for an hour" and "for the next hour" beside "every ten minutes"."""
    time = amount(Lex(1.0, False, "1"), unit) if unit is not None else time
    if time is None:
        return None
    return None if rest(time) is None else Adjunct(_lasting, time.number, may_lead=True)


def _lasting(command: CaptureCommand, seconds: float) -> CaptureCommand | None:
    return None if command.for_s else replace(command, for_s=seconds)
