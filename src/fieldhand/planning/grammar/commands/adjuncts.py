"""Constructions of adjuncts, which change the capture of their clause: "twice", "every 10 m", "one per row"."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import split
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Adjunct, Clause, once
from fieldhand.planning.grammar.commands.things import named_capture
from fieldhand.planning.grammar.meaning import LAST_THING, UNSAID_THING, CaptureCommand, Nominal, PlaceMeaning, Thing
from fieldhand.planning.grammar.places.counted import row_of_all
from fieldhand.planning.grammar.places.groups import EachKind, of_each_kind
from fieldhand.planning.grammar.places.nouns import Comparison, tests_of, that_pass
from fieldhand.planning.grammar.places.numbers import VAGUE_NUMBERS
from fieldhand.planning.grammar.places.sampling import bare_points
from fieldhand.planning.grammar.places.vague import as_many_of_best
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    are_rows,
    as_quota,
    as_some,
    as_spread_points,
    as_zone,
    chooses_from_trees,
    is_one_row,
    is_random,
    over,
)
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


def _is_uncounted(command: CaptureCommand) -> bool:
    return all(one.count is None for one in command.things)


def _counted(command: CaptureCommand, count: int) -> CaptureCommand:
    return replace(command, things=tuple(replace(one, count=count, plural=count > 1) for one in command.things))


def _only_count(command: CaptureCommand) -> int | None:
    """Return the number of captures if the command gives one number of two or more."""
    counts = {one.count for one in command.things}
    count = counts.pop()
    return None if counts or count is None or count < 2 else count


# How often, and how many at each place.


def _so_often(command: CaptureCommand, times: int) -> CaptureCommand | None:
    return replace(command, times=times) if command.times == 1 else None


def _again(command: CaptureCommand, _: None) -> CaptureCommand | None:
    return command if command.relation in ("at", "of", "along") else None


def _each(command: CaptureCommand, things: tuple[Thing, ...] | int | None) -> CaptureCommand | None:
    """Return a command with so many captures, or those of ``things``, at each of several places."""
    if isinstance(things, tuple) and len(things) == 1 and things[0].action in (UNSAID_THING, LAST_THING):
        things = things[0].count or 1  # "measure CO2 at trees 5 and 6, one reading at each"
    if things == 1 and command.place is None:
        return command  # "of the yellow trees let the temperature be taken, each once"
    if isinstance(things, int):
        same_number = _is_uncounted(command) or {one.count for one in command.things} == {things}
        command = _counted(command, things) if same_number else replace(command, things=())
    elif things is not None:
        same = {one.action for one in command.things} == {one.action for one in things}
        command = replace(command, things=things if same and _is_uncounted(command) else ())
    place = command.place
    if place is None and command.relation == "bare" and things is None:
        return replace(command, place=PlaceMeaning(s.Here(), "those", each=True))  # "(five vines.) A picture each."
    if place is not None and place.per is not None and place.shape == "area" and isinstance(things, int):
        return command if command.things else None  # "in both sections, three readings each"
    if place is None or place.shape != "several" or not command.things or not all(one.count for one in command.things):
        return None
    return replace(command, place=replace(place, each=True))


@construction("often: times=COUNT", "often: n=count TIMES", cost=0.0)
def often(times: Lex | None = None, n: int = 1) -> int:
    """Compose "twice" and "five times"."""
    return n if times is None else int(times.value)


@construction("adjunct: times=often", cost=0.2)
def so_often(times: int) -> Adjunct:
    """Compose "twice"."""
    return Adjunct(_so_often, times)


@construction("adjunct: AGAIN", cost=0.2)
def once_more() -> Adjunct:
    """Compose "again", where the robot is, or of one place."""
    return Adjunct(_again)


@construction(
    "adjunct: EACH [OFTHEM]",
    "adjunct: times=often EACH",
    "adjunct: EACH times=often",
    "adjunct: times=count EACH",
    "adjunct: number=things EACH",
    "adjunct: number=things INEACH",
    cost=0.2,
)
def of_each(times: int | None = None, number: tuple[Thing, ...] | None = None) -> Adjunct:
    """Compose "each" behind "two pictures", "twice each", "one each" and "two pictures each"."""
    specifies = number is not None and [one.action for one in number] in ([UNSAID_THING], [LAST_THING])
    return Adjunct(_each, times or number, is_sentence=specifies)


@construction("adjunct: times=count PER TREE", "adjunct: number=things PER TREE", cost=0.2)
def so_many_at_each(times: int | None = None, number: tuple[Thing, ...] | None = None) -> Adjunct | None:
    """Compose "two at each plant" behind what is captured there."""
    if number is not None and any(one.count is None for one in number):
        return None
    return of_each(times, number)


# At which trees of the place.


def _at_every_tree(command: CaptureCommand, _: None) -> CaptureCommand | None:
    place = command.place
    if place is None or place.shape != "area" or place.per is not None or not _is_uncounted(command):
        return None
    return replace(command, place=replace(place, shape="several", each=True))


def _at_so_many(command: CaptureCommand, count: int) -> CaptureCommand | None:
    place = command.place
    if place is None or place.shape != "area" or place.per is not None or command.spacing is not None:
        return None
    made = _counted(command, count) if _is_uncounted(command) else None
    return None if made is None else replace(made, things=tuple(replace(one, plural=True) for one in made.things))


@dataclass(frozen=True, slots=True)
class _Drawing:
    """The site on which places are drawn."""

    site: Site = field(compare=False)


def _evenly(command: CaptureCommand, drawing: _Drawing) -> CaptureCommand | None:
    place, count = command.place, _only_count(command)
    if place is not None and as_spread_points(place.selector) is not None:
        return command  # as free points are spread anyway
    if place is not None and place.shape == "several" and (some := as_some(place.selector)) is not None:
        in_rows = any(are_rows(part) for part in some.of.walk())
        own = None if in_rows else row_of_all(Nominal(some.of), drawing.site)
        along = None if own is None else replace(place, selector=s.Evenly(count=some.count, of=over(some.of, own)))
        return None if along is None or place.per is not None else replace(command, place=along)
    if place is None or place.shape != "area" or place.per is not None or count is None:
        return None
    if (free := bare_points(place.selector, drawing.site, count)) is not None:
        return replace(command, things=once(command.things), place=PlaceMeaning(free, "several", count=count))
    if as_zone(place.selector) is not None:
        spread = PlaceMeaning(s.Spread(count=count, of=place.selector), "several", count=count)
        return replace(command, things=once(command.things), place=spread)
    if not (are_rows(place.selector) and is_one_row(place.selector)):
        return None
    even = PlaceMeaning(s.Evenly(count=count, of=place.selector), "several", count=count)
    return replace(command, things=once(command.things), place=even)


def _free_choice(command: CaptureCommand, count: int | None) -> CaptureCommand | None:
    """Return a command at some trees, which its words leave open; ``count`` is their number if it was said again."""
    place = command.place
    if place is None or place.shape == "those":
        return None
    quota = as_quota(place.selector)
    if quota is not None and quota.how != "random":  # "three plants of each crop, any three will do"
        return command if count in (None, quota.count) else None
    if count not in (None, place.count):
        return None
    some = any(as_some(part) is not None for part in place.selector.members)
    return command if some or (place.shape == "area" and not _is_uncounted(command)) else None


def _at_random(command: CaptureCommand, drawing: _Drawing) -> CaptureCommand | None:
    place, count = command.place, _only_count(command)
    if place is not None and place.shape == "area" and place.per is None and count is not None:
        free = bare_points(place.selector, drawing.site, count, random=True)
        drawn_there = PlaceMeaning(free or s.RandomSample(count=count, of=place.selector), "several", count=count)
        return replace(command, things=once(command.things), place=drawn_there)
    if place is None or place.shape not in ("one", "several") or place.per is not None:
        return None
    spread = as_spread_points(place.selector)
    if spread is not None and place.count:
        return replace(command, place=replace(place, selector=replace(spread, random=True)))
    quota = as_quota(place.selector)
    if quota is not None and quota.how == "spread":
        return replace(command, place=replace(place, selector=replace(quota, how="random")))
    some = [as_some(part) for part in place.selector.members]
    drawn = tuple(s.RandomSample(count=one.count, of=one.of) for one in some if one is not None)
    if not drawn or len(drawn) < len(some):
        return None
    selector = drawn[0] if len(drawn) == 1 else s.UnionOf(parts=drawn)
    return replace(command, place=replace(place, selector=selector))


def _placed(command: CaptureCommand, _: None) -> CaptureCommand | None:
    """Return a command that names its place."""
    return None if command.place is None or command.place.refers_back else command


@construction("part: n=count MORE", cost=1.5)
def more_of_them_part(n: int) -> Clause:
    """Compose "eight more" before where they are taken; "otherwise take two more" may be of either kind."""
    thing = Thing(LAST_THING, count=n, plural=n > 1, more=True)
    return Clause("t", things=(thing,), adjuncts=(Adjunct(_placed, late=True),))


def drawn_likewise(command: CaptureCommand, other: CaptureCommand, site: Site) -> CaptureCommand:
    """Return captures at places drawn at random if those of another command are."""
    parts = () if other.place is None else other.place.selector.members
    drawn = all(is_random(one) for one in parts)
    return (_at_random(command, _Drawing(site)) or command) if parts and drawn else command


def _as_many(command: CaptureCommand, _: None) -> CaptureCommand | None:
    place = command.place
    if place is None or place.shape != "several" or place.per is not None:
        return None
    if place.count is not None and not place.vague:
        return None
    return replace(command, place=as_many_of_best(replace(place, optional=True)))


@construction(
    "adjunct: [relation] EACH noun=TREE",
    "adjunct: ONEBYONE",
    "adjunct: ENTIRE",
    cost=0.3,
)
def at_every_tree(noun: Lex | None = None) -> Adjunct | None:
    """Compose "every tree" and "tree by tree", of an area."""
    return None if noun is not None and noun.plural else Adjunct(_at_every_tree, is_sentence=True)


@construction(
    "adjunct: n=count POINT REMAINS",
    "adjunct: n=count TREE REMAINS",
    "adjunct: n=count [OFTHEM] REMAINS",
    "adjunct: AT n=count POINT",
    cost=0.2,
)
def at_so_many(n: int) -> Adjunct:
    """Compose "three spots will do"."""
    return Adjunct(_at_so_many, n, of_place=True, is_sentence=True)


@construction("adjunct: EVENLYSPACED", cost=0.2, given=("site",))
def evenly_spaced(site: Site) -> Adjunct:
    """Compose "evenly spread", along a row or over ground without plants."""
    return Adjunct(_evenly, _Drawing(site), is_sentence=True)


@construction("adjunct: ANY [TREE] REMAINS", "adjunct: ANY n=count [TREE] REMAINS", "adjunct: FREECHOICE", cost=0.2)
def whichever_it_is(n: int | None = None) -> Adjunct:
    """Compose "any tree is good" and "any five will do"."""
    return Adjunct(_free_choice, n, is_sentence=True)


@construction("adjunct: RANDOM", "adjunct: AT RANDOM POINT", cost=0.2, given=("site",))
def chosen_at_random(site: Site) -> Adjunct:
    """Compose "chosen at random"."""
    return Adjunct(_at_random, _Drawing(site), is_sentence=True)


def _not_at_all(command: CaptureCommand, _: None) -> CaptureCommand | list[CaptureCommand] | None:
    """Return a command at some of its places, whose number is open if it was not said."""
    place = command.place
    if place is None or place.per is not None or place.each or place.optional or place.shape not in ("several", "area"):
        return None
    counts = {one.count for one in command.things}
    if place.count is not None or (place.shape == "area" and counts != {None}):
        return command
    if place.refers_back or not chooses_from_trees(place.selector) or len(counts) > 1:
        return None
    numbers = VAGUE_NUMBERS if counts <= {None, 1} else [n for n in counts if n is not None]
    some = (PlaceMeaning(s.Take(count=n, of=place.selector), "several", count=n) for n in numbers)
    return [replace(command, things=once(command.things), place=one, relation="at") for one in some]


@construction("adjunct: NOTALL", cost=0.2)
def not_at_all() -> Adjunct:
    """Compose "not all of them" behind what is captured there."""
    return Adjunct(_not_at_all, is_sentence=True)


@construction(
    "part: n=count RANDOM noun=NOUN", "part: n=count RANDOM noun=NOUN READING",
    "part: n=count RANDOM READING OF [DET] noun=NOUN", "part: n=count RANDOM ONE",
    "part: n=count even=EVENLYSPACED noun=NOUN", "part: n=count even=EVENLYSPACED noun=NOUN READING",
    cost=0.3, given=("site",),
)  # fmt: skip
def drawn_things_part(n: int, site: Site, noun: Lex | None = None, even: Lex | None = None) -> Clause | None:
    """Compose "six random moisture readings" and "ten evenly spread readings", at as many places."""
    thing = Thing(LAST_THING, count=n, plural=n > 1) if noun is None else named_capture(noun, count=n, plural=n > 1)
    drawing = Adjunct(_at_random if even is None else _evenly, _Drawing(site))
    return None if thing is None or n < 2 else Clause("t", things=(thing,), adjuncts=(drawing,))


@construction("adjunct: ASMANY as_can", cost=0.2)
def as_many_of_those() -> Adjunct:
    """Compose "as many as you can"."""
    return Adjunct(_as_many)


@construction("adjunct: as_can", cost=0.1)
def as_can_of_many() -> Adjunct:
    """Compose "as you can" behind "as many pictures"."""
    return Adjunct(_unchanged, of_many=True)


@construction("adjunct: ONTHEWAY", cost=0.3)
def on_the_way() -> Adjunct:
    """Compose "on the way back" behind a capture at a place, which comes last anyway."""
    return Adjunct(_unchanged, of_place=True)


@construction("adjunct: [AGAIN] WHERE MAPSAYS by=comparison", cost=0.1, given=("site", "robot"))
def where_map_says(by: Comparison, site: Site, robot: RobotProfile) -> Adjunct:
    """Compose "wherever the map says less than 22", of the property of plants that is named like what is read."""
    return Adjunct(_where_recorded, _Recorded(by, site, robot), may_lead=True)


@dataclass(frozen=True, slots=True)
class _Recorded:
    """A comparison with what a site records of what a robot reads."""

    by: Comparison
    site: Site = field(compare=False)
    robot: RobotProfile = field(compare=False)


def _where_recorded(command: CaptureCommand, told: _Recorded) -> list[CaptureCommand] | None:
    """Return captures where the property of plants that is named like their quantity passes a comparison."""
    if told.by[3] or len(command.things) != 1 or command.things[0].action not in told.robot.action:
        return None
    place = command.place
    if place is not None and (
        place.count is not None or place.per is not None or place.shape not in ("several", "area")
    ):
        return None
    words = {word for name in told.robot.action[command.things[0].action].measures for word in split(name)}
    recorded = [one for one, values in told.site.attributes.items() if not any(isinstance(x, str) for x in values)]
    names = [one for one in recorded if words & {*split(one.replace("_", " "))}]
    of = s.Trees() if place is None else place.selector
    found = [PlaceMeaning(that_pass(test, of), "several") for test in tests_of(names, told.by)]
    return [replace(command, place=one) for one in found] or None


def _each_another(command: CaptureCommand, _: None) -> CaptureCommand | None:
    """Return captures each of which is taken at another plant than the others."""
    place, n = command.place, _only_count(command)
    if command.spacing is not None or place is None:
        return command
    if place.per is not None or place.optional or place.refers_back:
        return None
    if n is None:
        once_each = all(one.count in (None, 1) for one in command.things) and command.times == 1
        return command if place.shape == "several" and once_each else None
    if place.count == n:
        return _counted(command, 1)
    if (
        place.count is not None
        or place.each
        or place.shape not in ("several", "area")
        or not chooses_from_trees(place.selector)
    ):
        return None
    some = PlaceMeaning(s.Take(count=n, of=place.selector), "several", count=n)
    return replace(_counted(command, 1), place=some)


@construction(
    "adjunct: EACH [ONE] FROM DET OTHER TREE", "adjunct: EACH [ONE] AT DET OTHER TREE",
    "adjunct: EACH [ONE] FROM ANOTHER TREE", "adjunct: EACH [ONE] AT ANOTHER TREE",
    "adjunct: EACH [ONE] OF DET OTHER TREE", "adjunct: EACH FROM OTHER TREE", "adjunct: EACH AT OTHER TREE",
    "adjunct: OTHEREACH",
    cost=0.1,
)  # fmt: skip
def each_another() -> Adjunct:
    """Compose "each from a different plant"."""
    return Adjunct(_each_another, late=True)


@construction("adjunct: FROM OTHER trees=TREE", "adjunct: AT OTHER trees=TREE", cost=0.1)
def all_different(trees: Lex) -> Adjunct | None:
    """Compose "from different plants"; "some other plant" is a place."""
    return each_another() if trees.plural else None


def _unchanged(command: CaptureCommand, _: None) -> CaptureCommand:
    return command


# So many per row, block, corner or kind.


def _per(command: CaptureCommand, rows: s.Selector) -> CaptureCommand | None:
    """Return a command for each row, or each block, of its area or of the site."""
    place = command.place
    if place is not None:
        if place.shape != "area" or place.per is not None or not chooses_from_trees(place.selector):
            return None
        if are_rows(place.selector) and rows != s.Rows():
            return None
        rows = place.selector if are_rows(place.selector) else over(rows, place.selector)
    return replace(command, place=PlaceMeaning(s.Trees(), "area", each=True, per=rows), relation="at")


def _at_each_corner(command: CaptureCommand, _: None) -> CaptureCommand | None:
    if command.place is not None:
        return None
    return replace(command, place=PlaceMeaning(s.Corners(), "several", each=True, count=4))


def _at_each_tree(command: CaptureCommand, _: None) -> CaptureCommand | None:
    if command.place is not None or any(one.count not in (None, 1) for one in command.things):
        return None
    many = tuple(replace(one, count=None, plural=True) for one in command.things)
    return replace(command, things=many, place=PlaceMeaning(s.Trees(), "those", each=True), relation="each")


@dataclass(frozen=True, slots=True)
class _Kinds:
    """An attribute whose values tell kinds of trees apart, and how many kinds the phrase names (0 if it names none)."""

    named: EachKind
    site: Site = field(compare=False)


def _of_each_kind(command: CaptureCommand, kinds: _Kinds) -> list[CaptureCommand] | None:
    """Return a command at so many trees of each kind."""
    place = command.place
    if place is None or (place.shape == "area" and place.per is None and chooses_from_trees(place.selector)):
        counts = {one.count or 1 for one in command.things}
        if len(counts) > 1 or any(one.plural and one.count is None for one in command.things):
            return None
        some: s.Selector = s.Take(count=counts.pop(), of=s.Trees() if place is None else place.selector)
        command = replace(command, things=once(command.things))
    elif place.shape in ("one", "several") and _is_uncounted(command):
        some = place.selector
    else:
        return None
    places = of_each_kind(some, kinds.named, kinds.site)
    return None if places is None else [replace(command, place=one) for one in places]


@construction("adjunct: rows=per_row", cost=0.2)
def per_row(rows: s.Selector) -> Adjunct:
    """Compose "per row"."""
    return Adjunct(_per, rows, may_lead=True)


@construction("adjunct: blocks=per_block", cost=0.2)
def per_block(blocks: tuple[s.Selector, ...]) -> Adjunct:
    """Compose "per block"."""
    return Adjunct(_per, s.UnionOf(parts=blocks), may_lead=True)


@construction("adjunct: PER noun=NUMBEREDZONE", cost=0.2)
def per_zone(noun: Lex) -> Adjunct | None:
    """Compose "per bed"."""
    zones = s.UnionOf(parts=tuple(s.InZone(zone=name) for _, name in noun.value))
    return None if noun.plural else Adjunct(_per, zones, may_lead=True)


@construction("adjunct: PER noun=CORNER [OF] [site]", cost=0.2)
def per_corner(noun: Lex) -> Adjunct | None:
    """Compose "per corner"."""
    return None if noun.plural else Adjunct(_at_each_corner, may_lead=True)


@construction("adjunct: PER TREE", cost=0.6)
def per_tree() -> Adjunct:
    """Compose "per tree"."""
    return Adjunct(_at_each_tree)


@construction("adjunct: things=things PER TREE", cost=0.6)
def one_per_tree(things: tuple[Thing, ...]) -> Adjunct:
    """Compose "one reading per tree" behind the trees that are read."""
    return Adjunct(_one_per_tree, things)


def _one_per_tree(command: CaptureCommand, things: tuple[Thing, ...]) -> CaptureCommand | None:
    several = command.place is not None and command.place.shape in ("several", "area") and command.place.per is None
    if command.place is None or not several or not _says_again(command, things):
        return None
    return replace(command, place=replace(command.place, shape="several", each=command.place.each))


@construction("adjunct: kinds=per_kind", cost=0.2, given=("site",))
def per_kind(kinds: EachKind, site: Site) -> Adjunct:
    """Compose "per variety" and "for each variety"."""
    return Adjunct(_of_each_kind, _Kinds(kinds, site), may_lead=True)


# Spread over a line or an area.


def _spaced(command: CaptureCommand, dist: tuple[float, bool]) -> CaptureCommand | list[CaptureCommand] | None:
    """Return a command at stops so far apart; with True a number of captures is that of the stops."""
    metres, many = dist
    place, single = command.place, all(one.count in (None, 1) for one in command.things)
    if command.spacing is not None or (place is not None and place.shape not in ("area", "those", "here")):
        return None
    if many and command.times > 1 and _is_uncounted(command):  # "three times, 15 m apart"
        return replace(_counted(command, command.times), times=1, spacing=metres)
    if many and not single:
        return replace(command, spacing=metres)
    once_each = replace(command, things=once(command.things), spacing=metres)
    if single:
        return once_each
    counted = replace(command, spacing=metres)
    if len(command.things) > 1 or command.things[0].count is None or place is None:
        return None
    return [counted, replace(once_each, times=command.things[0].count)]  # three stops, or three at every stop?


def _at_points(command: CaptureCommand, points: tuple[int, float]) -> CaptureCommand | None:
    if command.place is not None and command.place.shape != "area":
        return None
    return replace(_counted(command, points[0]), spacing=points[1])


@dataclass(frozen=True, slots=True)
class _Spreading:
    """The area over which captures are spread."""

    where: s.Selector
    site: Site = field(compare=False)


def _spread(command: CaptureCommand, over_what: _Spreading) -> CaptureCommand | None:
    """Return a command at places spread over an area, as many as there are captures."""
    where = over_what.where
    count, zone = _only_count(command), as_zone(where)
    if count is None or command.place is not None or (zone is not None and zone.outside):
        return None
    over_it: s.Selector | None = bare_points(where, over_what.site, count)
    if over_it is None:
        over_it = s.Spread(count=count, of=where) if zone is None else s.PointsIn(zone=zone.zone, count=count)
    return replace(
        command, things=once(command.things), place=PlaceMeaning(over_it, "several", count=count), relation="at"
    )


@construction("adjunct: dist=spaced", "adjunct: AT dist=spaced", cost=0.1)
def at_spacing(dist: tuple[float, bool]) -> Adjunct:
    """Compose "every 10 m" and "10 m apart"."""
    return Adjunct(_spaced, dist, may_lead=True)


@construction("adjunct: dist=own_stops", "adjunct: AT dist=own_stops", cost=0.1)
def at_own_stops(dist: tuple[float, bool]) -> Adjunct:
    """Compose "stops 20 m apart" and "stop every 20 m"."""
    return Adjunct(_spaced, dist, may_lead=True, is_sentence=True)


@construction("adjunct: things=things dist=spaced", cost=0.4)
def one_at_each_stop(things: tuple[Thing, ...], dist: tuple[float, bool]) -> Adjunct:
    """Compose "one reading every 10 m" behind what is read."""
    return Adjunct(_one_spaced, (things, dist))


def _one_spaced(
    command: CaptureCommand, said: tuple[tuple[Thing, ...], tuple[float, bool]]
) -> CaptureCommand | list[CaptureCommand] | None:
    things, dist = said
    return _spaced(command, dist) if _says_again(command, things) else None


def _says_again(command: CaptureCommand, things: tuple[Thing, ...]) -> bool:
    """Return True if captures are those of the command, one of each ("one reading")."""
    known = {UNSAID_THING, LAST_THING, *(one.action for one in command.things)}
    return all(one.action in known and one.count in (None, 1) for one in things) and _is_uncounted(command)


@construction("adjunct: relation n=count POINT dist=spaced", cost=0.1)
def at_points(n: int, dist: tuple[float, bool]) -> Adjunct:
    """Compose "at 5 points every 10 m"."""
    return Adjunct(_at_points, (n, dist[0]), may_lead=True)


@construction(
    "adjunct: SPREAD where=region",
    "adjunct: SPREAD site",
    "adjunct: EVENLYALONG site",
    "adjunct: along=EVENLYALONG where=region",
    cost=0.2,
    given=("site",),
)
def spread_over(site: Site, where: s.Selector | None = None, along: Lex | None = None) -> Adjunct | None:
    """Compose "spread over the pond zone"; along rows trees are evenly spaced instead."""
    if along is not None and where is not None and are_rows(where):
        return None
    return Adjunct(_spread, _Spreading(where or s.Trees(), site))


@construction(
    "adjunct: [SCATTERED] RANDOM OVER where=region",
    "adjunct: SCATTERED RANDOM in_ where=region",
    cost=0.2,
    given=("site",),
)
def scattered_over(where: s.Selector, site: Site) -> Adjunct:
    """Compose "scattered at random over the slope"."""
    return Adjunct(_scattered, _Spreading(where, site))


@construction("adjunct: SCATTERED OVER where=region", cost=0.2, given=("site",))
def dotted_over(where: s.Selector, site: Site) -> Adjunct:
    """Compose "dotted about the slope"."""
    return Adjunct(_spread, _Spreading(where, site))


def _scattered(command: CaptureCommand, over_what: _Spreading) -> CaptureCommand | None:
    """Return a command at places of an area drawn at random, as many as there are captures."""
    where = over_what.where
    count, zone = _only_count(command), as_zone(where)
    if count is None or command.place is not None or (zone is not None and zone.outside):
        return None
    drawn = bare_points(where, over_what.site, count, random=True) or s.RandomSample(count=count, of=where)
    there = PlaceMeaning(drawn, "several", count=count)
    return replace(command, things=once(command.things), place=there, relation="at")


@construction(
    "clause: SCATTER things=things OVER where=region",
    "clause: SCATTER things=things OVER site",
    cost=0.2,
    given=("site",),
)
def scattered(things: tuple[Thing, ...], site: Site, where: s.Selector | None = None) -> Clause:
    """Compose "scatter 4 readings over the wet corner"."""
    return Clause("vt", things=things, adjuncts=(Adjunct(_spread, _Spreading(where or s.Trees(), site)),))


# In another case.


def _instead(command: CaptureCommand, _: None) -> CaptureCommand:
    return replace(command, instead=True)


def _as_it_is(command: CaptureCommand, _: Any) -> CaptureCommand | None:
    return command if command.place is not None else None


@construction("adjunct: INSTEAD", cost=0.2)
def instead() -> Adjunct:
    """Compose "instead", in another case."""
    return Adjunct(_instead)


@construction("adjunct: INSTEAD OF things", cost=0.2)
def instead_of_things() -> Adjunct:
    """Compose "instead of CO2", in another case."""
    return Adjunct(_instead)


@construction("adjunct: [COMMA] place=here", cost=0.5)
def at_each_of_those(place: PlaceMeaning) -> Adjunct | None:
    """Compose "at each" behind places that were named with what is done there."""
    return Adjunct(_at_each_place, of_place=True) if place.shape == "those" and place.each else None


def _at_each_place(command: CaptureCommand, _: None) -> CaptureCommand | None:
    place = command.place
    if place is None or place.shape not in ("several", "area") or place.per is not None:
        return None
    return replace(command, place=replace(place, shape="several", each=True))


@construction("adjunct: BYGOING", cost=0.1)
def by_going_there() -> Adjunct:
    """Compose "by going to them"."""
    return Adjunct(_as_it_is)
