"""Constructions of commands to capture something: at a place, at each of several, or at a spacing."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Adjunct
from fieldhand.planning.grammar.commands.parameters import with_parameter
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    UNSAID_THING,
    Amount,
    CaptureCommand,
    Nominal,
    ParameterValue,
    PlaceMeaning,
    Thing,
)
from fieldhand.planning.grammar.places.numbers import named_trees
from fieldhand.planning.grammar.places.points import Ground, Points, points_on
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_zone, specifies_part
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

_ALL = s.Trees()


@construction("here: word=THERE", cost=0.1)
def here(word: Lex) -> PlaceMeaning:
    """Compose "there"."""
    several = "of_several" in word.features
    return PlaceMeaning(
        s.Trees() if several and "of_trees" in word.features else s.Here(),
        "those" if several else "here",
        each="of_each" in word.features,
        one_tree=not several and "of_trees" in word.features,
    )


@construction(
    "here: AT word=EACH [DET] noun=TREE", "here: OF word=EACH [DET] noun=TREE", "here: AT word=EACH [DET] noun=POINT",
    cost=0.1,
)  # fmt: skip
def at_both(word: Lex, noun: Lex) -> PlaceMeaning | None:
    """Compose "at both plants", of two that were named."""
    two = "two" in word.features and noun.text.endswith("s")
    return PlaceMeaning(s.Here(), "those", each=True, count=2) if two else None


@construction(
    "capture: READING relation place=place COMMA things=things",
    "capture: things=things COMMA trees=numbers",
    "capture: [verb] things=things AT trees=numbers",
    cost=0.9,
    given=("site",),
)
def by_numbers(
    things: tuple[Thing, ...],
    used: int,
    site: Site,
    place: PlaceMeaning | None = None,
    trees: tuple[str, ...] = (),
) -> CaptureCommand | None:
    """Compose "readings at trees 5 to 8: CO2" and "CO2 at 5, 6 and 7" on a site whose trees have numbers."""
    if place is None:
        if not all(name in site.by_id for name in trees):
            return None
        place = named_trees(trees)
    return CaptureCommand(things, place, used)


@construction("capture: act=capture FULLSTOP adjunct=adjunct", cost=0.3)
def adjunct_by_itself(act: CaptureCommand, adjunct: Adjunct, used: int) -> list[CaptureCommand] | None:
    """Compose "measure CO2 along row 4. Every tree." and "... at five yellow trees. Any five will do."."""
    changed = adjunct.change(act, adjunct.value) if adjunct.is_sentence else None
    ways = changed if isinstance(changed, list) else [changed]
    return [replace(one, used=used) for one in ways if isinstance(one, CaptureCommand)] or None


@construction(
    "capture: adjunct=adjunct FULLSTOP [each=here] [COMMA] act=capture",
    "capture: adjunct=adjunct COMMA each=here [COMMA] act=capture",
    "capture: adjunct=adjunct AND each=here [COMMA] act=capture",
    cost=0.3,
)
def adjunct_before(
    adjunct: Adjunct, act: CaptureCommand, used: int, each: PlaceMeaning | None = None
) -> CaptureCommand | None:
    """Compose "make stops 20 m apart; at each stop read CO2"."""
    if not (adjunct.is_sentence and adjunct.may_lead) or act.spacing is not None or act.within is not None:
        return None
    if each is not None and (each.shape != "those" or act.place is not None):
        return None
    if act.place is not None and act.place.shape in ("those", "here"):
        act = replace(act, place=None)
    changed = adjunct.change(act, adjunct.value)
    return replace(changed, used=used) if isinstance(changed, CaptureCommand) else None


@construction(
    "capture: adjunct=adjunct [COMMA] AND act=capture", "capture: adjunct=adjunct COMMA act=capture",
    cost=0.5,
)  # fmt: skip
def at_each_point_of(adjunct: Adjunct, act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "lay a 20 m grid over the slope and take soil moisture at every point"."""
    if not adjunct.lays_out or act.spacing is not None or act.within is not None or act.times != 1:
        return None
    if act.place is None or act.place.shape != "those":
        return None
    changed = adjunct.change(replace(act, place=None), adjunct.value)
    return replace(changed, used=used) if isinstance(changed, CaptureCommand) else None


@construction(
    "capture: adjunct=adjunct [COMMA] [AND] [verb] things=things relation points=points",
    "capture: adjunct=adjunct [COMMA] [AND] [verb] things=things relation points=points ONTHEWAY",
    "capture: adjunct=adjunct WITH things=things", "capture: adjunct=adjunct WITH things=things ONTHEWAY",
    cost=0.4,
)  # fmt: skip
def at_points_of(
    adjunct: Adjunct, things: tuple[Thing, ...], used: int, points: Points | None = None
) -> CaptureCommand | None:
    """Compose "walk the slope in a W and take nitrate at fifteen stops" and "a W with fifteen nitrate readings"."""
    if not adjunct.lays_out or (points is not None and (points.where is not None or points.count is None)):
        return None
    if points is not None:
        if any(one.count not in (None, 1) for one in things):
            return None
        things = tuple(replace(one, count=points.count) for one in things)
    changed = adjunct.change(CaptureCommand(things, None, used), adjunct.value)
    return replace(changed, used=used) if isinstance(changed, CaptureCommand) else None


@construction(
    "capture: GO FARTHEST FOR things=things",
    "capture: GO FARTHEST FOR things=things OF inner=nominal",
    "capture: GO FARTHEST FOR things=things OF other=ANOTHER inner=nominal",
    cost=0.3,
)
def far_away_for(
    things: tuple[Thing, ...], used: int, inner: Nominal | None = None, other: Lex | None = None
) -> CaptureCommand | None:
    """Compose "move as far away as possible for a CO2 reading of another tree"."""
    if inner is not None and (inner.single or inner.plural or inner.complete):
        return None
    trees = s.Trees() if inner is None else inner.selector
    far = s.Farthest(origin=s.Here(), of=trees if other is None else s.NotVisited(of=trees))
    return CaptureCommand(things, PlaceMeaning(far, "one"), used)


@construction("capture: act=capture place=here", cost=0.4)
def done_there(act: CaptureCommand, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "photograph it there"."""
    if act.place is not None and act.place.shape != "here":
        return None
    return replace(act, place=act.place or place, used=used) if act.relation in ("at", "of") else None


@construction("capture: act=capture IS WANTED", cost=0.2)
def is_wanted(act: CaptureCommand, used: int) -> CaptureCommand:
    """Compose "pictures of the yellow trees are what I want"."""
    return replace(act, used=used)


@construction("capture: act=capture IS", cost=0.6)
def is_as_well(act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "a picture of each is", behind what is not required."""
    return replace(act, used=used) if act.relation == "plain" else None


@construction("capture: place=place IS WANTED things=things word=relation", cost=0.3)
def are_wanted(place: PlaceMeaning, things: tuple[Thing, ...], word: str, used: int) -> CaptureCommand | None:
    """Compose "the yellow trees are what I want pictures of"."""
    if place.shape == "area" and not all(one.plural for one in things):
        return None
    return CaptureCommand(things, place, used, relation=word)


@construction(
    "capture: SEPARATE things=things BY far=amount [COMMA] [AND] [verb] n=count [LIMIT]",
    "capture: SEPARATE things=things dist=apart [COMMA] [AND] [verb] n=count [LIMIT]",
    "capture: SEPARATE things=things BY far=amount",
    "capture: SEPARATE things=things dist=apart",
    cost=0.2,
)
def separate(
    things: tuple[Thing, ...], used: int, far: Amount | None = None, dist: float | None = None, n: int | None = None
) -> CaptureCommand | None:
    """Compose "separate your measurements by 12 m, and carry out four in all"."""
    metres = dist if far is None else far.number if far.unit == "metres" else None
    if metres is None or (n is not None and any(one.count is not None for one in things)):
        return None
    counted = things if n is None else tuple(replace(one, count=n, plural=True) for one in things)
    return CaptureCommand(counted, None, used, spacing=metres)


@construction("capture: act=capture COMMA relation place=place", cost=0.2)
def specified(act: CaptureCommand, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "take pictures in row 4, at the yellow trees"."""
    area = act.place
    if area is None or area.shape != "area" or act.within is not None or act.spacing is not None:
        return None
    if not specifies_part(place.selector):
        return None
    return replace(act, place=place, within=area, used=used, relation="at")


@construction("capture: MEASURE place=place [COMMA] BY act=capture", cost=0.3)
def measure_by(place: PlaceMeaning, act: CaptureCommand, used: int) -> CaptureCommand | None:
    """Compose "measure another tree by taking a picture"."""
    return replace(act, place=place, used=used, relation="at") if act.place is None and act.spacing is None else None


@construction("capture: AGAIN word=relation place=place", cost=0.6)
def once_more_at(word: str, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "once more at tree 9" behind what is taken."""
    return CaptureCommand((Thing(LAST_THING),), place, used, relation=word) if place.shape == "one" else None


@construction("capture: MEASURE IT AGAIN", "capture: TAKE IT AGAIN", "capture: MEASURE IT AGAIN place=here", cost=0.4)
def measure_it_again(used: int, place: PlaceMeaning | None = None) -> CaptureCommand:
    """Compose "(wait 10 minutes and) read it again"."""
    return CaptureCommand((Thing(LAST_THING, count=1),), place, used)


@construction("capture: MEASURE IT place=here", "capture: MEASURE IT relation place=place", cost=0.4)
def measure_it(place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "measure it there" and "measure it at tree 4"."""
    return CaptureCommand((Thing(LAST_THING),), place, used) if place.shape != "area" else None


@construction("capture: verb=ACTV word=DET", "capture: verb=ACTV several=GROUPALL", cost=0.8)
def act_on_those(verb: Lex, used: int, word: Lex | None = None, several: Lex | None = None) -> CaptureCommand | None:
    """Compose "photograph that" and "photograph both"."""
    if word is not None and not {"demonstrative", "those"} & word.features:
        return None
    of_several = several is not None or (word is not None and "those" in word.features)
    return _act_on(verb, PlaceMeaning(s.Here(), "those" if of_several else "here"), used)


@construction(
    "capture: verb=MEASURE place=place", "capture: verb=MEASURE AT place=place",
    "capture: verb=MEASURE place=place again=AGAIN", "capture: verb=MEASURE AT place=place again=AGAIN", cost=4.0,
)  # fmt: skip
def check_place(verb: Lex, place: PlaceMeaning, used: int, again: Lex | None = None) -> CaptureCommand | None:
    """Compose "check tree 4", which does not say what is measured there; "again" may not mean a picture."""
    if place.shape not in ("one", "several", "area"):
        return None
    thing = Thing(UNSAID_THING, plural=place.shape == "area", verb=_kind_of(verb) if again is None else "")
    return CaptureCommand((thing,), place, used)


def _kind_of(verb: Lex | None) -> Literal["", "look", "sample"]:
    """Return what a verb says of a capture that is not named."""
    features = frozenset[str]() if verb is None else verb.features
    return "look" if "looks" in features else "sample" if "samples" in features else ""


@construction(
    "capture: TAKE n=count MORE in_ where=region", "capture: n=count MORE in_ where=region",
    "capture: TAKE n=count MORE in_ where=rows", "capture: n=count MORE in_ where=rows",
    cost=1.0,
)  # fmt: skip
def so_many_more_there(n: int, where: s.Selector, used: int) -> CaptureCommand | None:
    """Compose "do six more on the slope"."""
    if n < 2:
        return None
    return CaptureCommand(
        (Thing(LAST_THING, count=n, plural=True, more=True),), PlaceMeaning(where, "area"), used, relation="in"
    )


@construction(
    "capture: MEASURE where=ground FOR things=things [COMMA] AT points=points",
    "capture: MEASURE where=ground FOR things=things [COMMA] how=parameter [COMMA] AT points=points",
    "capture: MEASURE where=ground FOR things=things [COMMA] AT points=points [COMMA] how=parameter",
    cost=0.3,
    given=("robot",),
)  # fmt: skip
def searched_for(
    where: Ground,
    things: tuple[Thing, ...],
    points: Points,
    used: int,
    robot: RobotProfile,
    how: ParameterValue | None = None,
) -> CaptureCommand | None:
    """Compose "test the slope for moisture at four evenly spread points"."""
    if points.where is not None or points.count is None or any(one.count not in (None, 1) for one in things):
        return None
    made = things if how is None else tuple(one for thing in things if (one := with_parameter(thing, how, robot)))
    place = points_on(where, points.count, random=points.random)
    return CaptureCommand(made, place, used) if len(made) == len(things) else None


@construction("capture: verb=TAKE place=place", cost=1.2)
def do_the_rest(verb: Lex, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "do the rest", where the same is captured."""
    rest = place.like is not None and place.like.kind == "rest"
    known = rest and "performs" in verb.features
    return CaptureCommand((Thing(LAST_THING),), place, used) if known else None


@construction(
    "capture: verb things=things OF site",
    "capture: verb things=things OVER site",
    "capture: verb=ACTV site",
    "capture: unsaid=MEASURE site",
    cost=1.5,
)
def of_site(
    used: int, things: tuple[Thing, ...] = (), verb: Lex | None = None, unsaid: Lex | None = None
) -> CaptureCommand:
    """Compose "take a picture of the orchard"."""
    if verb is not None:
        naming: Naming = verb.value
        things = (Thing(naming.actions[0]),)
    any_thing = (Thing(UNSAID_THING, plural=True, verb=_kind_of(unsaid)),)
    return CaptureCommand(things or any_thing, PlaceMeaning(s.Trees(), "area"), used, relation="of")


@construction("capture: VISIT place=place AND verb things=things", cost=0.6)
def visit_and(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "visit three trees and take a picture"."""
    if place.shape != "several" or any(one.count not in (None, 1) for one in things):
        return None
    return CaptureCommand(things, place, used)


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


@construction("capture: relation place=place times=COUNT", "capture: place=place times=COUNT", cost=1.0)
def elsewhere_so_often(place: PlaceMeaning, times: Lex, used: int) -> CaptureCommand | None:
    """Compose "at tree 6 twice" behind "at tree 5 three times"."""
    if place.shape not in ("one", "several"):
        return None
    return CaptureCommand((Thing(LAST_THING),), place, used, times=times.value)


@construction("capture: ASMANY [DET] inner=nominal as_can verb=ACTV", cost=0.3)
def as_many_as_it_can(inner: Nominal, verb: Lex, used: int) -> CaptureCommand | None:
    """Compose "as many of the yellow trees as it can photograph"."""
    if inner.single or not inner.plural:
        return None
    return _act_on(verb, PlaceMeaning(inner.selector, "several", optional=True), used)


@construction("capture: MAXIMISE NUMBEROF inner=nominal verb=ACTV", cost=0.2)
def maximise(inner: Nominal, verb: Lex, used: int) -> CaptureCommand | None:
    """Compose "maximise the number of trees photographed"."""
    if inner.single or not inner.plural:
        return None
    return _act_on(verb, PlaceMeaning(inner.selector, "several", optional=True), used)


@construction("capture: things=things REMAINS", cost=0.6)
def enough(things: tuple[Thing, ...], used: int) -> CaptureCommand:
    """Compose "one picture is enough", where a condition says when."""
    return CaptureCommand(things, None, used, relation="bare")


def _act_on(verb: Lex, place: PlaceMeaning, used: int) -> CaptureCommand:
    """Return the capture of an action's verb at a place."""
    naming: Naming = verb.value
    return CaptureCommand((Thing(naming.actions[0]),), place, used, relation="of")


@construction(
    "capture: MEASURE DET ground=GROUND relation place=place",
    "capture: MEASURE DET ground=GROUND how=parameter relation place=place",
    "capture: MEASURE DET ground=GROUND relation place=place [COMMA] how=parameter",
    "capture: verb=MEASURE [relation] place=place",
    "capture: verb=MEASURE [relation] place=place [COMMA] how=parameter",
    "capture: verb=MEASURE how=parameter relation place=place",
    cost=1.5,
    given=("robot",),
)
def ground_measured(
    place: PlaceMeaning,
    used: int,
    robot: RobotProfile,
    ground: Lex | None = None,
    verb: Lex | None = None,
    how: ParameterValue | None = None,
) -> list[CaptureCommand] | None:
    """Compose "test the soil at tree 4" and "probe the slope", which do not say what for."""
    if not any(word is not None and word.features & {"of_soil", "probes"} for word in (ground, verb)):
        return None
    names = {quantity.name for quantity in robot.quantities if "soil" in quantity.name}
    things = [Thing(action.name, plural=True) for action in robot.actions if names & {*action.measures}]
    if how is not None:
        things = [made for one in things if (made := with_parameter(one, how, robot)) is not None]
    return [CaptureCommand((one,), place, used) for one in things] or None


@construction("capture: MEASURE it=IT word=relation place=place", cost=0.5)
def measured_elsewhere(it: Lex, word: str, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "read it at the herb patch", of what was read last."""
    del it
    known = place.shape == "area" and as_zone(place.selector) is not None
    return CaptureCommand((Thing(LAST_THING, count=1),), place, used, relation=word) if known else None
