"""Constructions of questions which of two areas has more, and of the readings that answer them.

"Which is wetter, the slope or the bank? Take four readings in each." and "Is the slope wetter than the bank?".
"""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import CaptureCommand, Nominal, PlaceMeaning, Thing
from fieldhand.planning.grammar.places.counted import row_of_all
from fieldhand.planning.grammar.places.likewise import of_other_value
from fieldhand.planning.grammar.places.per_group import SoManyEach
from fieldhand.planning.grammar.places.sampling import bare_points
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, over
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("which_of_two: WHICHONE [of_the_two] IS more=BARECMP", cost=0.1, given=("robot",))
@construction("which_of_two: WHICHONE [of_the_two] IS BARECMP things=things [BELOWIT]", cost=0.1, given=("robot",))
def which_of_two(
    robot: RobotProfile, more: Lex | None = None, things: tuple[Thing, ...] = ()
) -> list[tuple[Thing, ...]] | None:
    """Compose "which is wetter" and "which has more nitrate under it", as what is measured."""
    if more is None:
        return [things]
    word = "moisture" if "more_water" in more.features else "temperature" if "more_heat" in more.features else ""
    return [(Thing(name),) for name in _measuring(word, robot)] or None


@construction("two_areas: first=place OR second=place", cost=0.0)
def two_areas(first: PlaceMeaning, second: PlaceMeaning) -> tuple[PlaceMeaning, PlaceMeaning] | None:
    """Compose "the courgettes or the pumpkins"."""
    if second.like is not None and second.like.kind == "value":  # "the grafted Sungolds ..., the ungrafted ones"
        other = of_other_value(first.selector, second.selector)
        second = second if other is None else replace(second, selector=other, like=None)
    known = all(
        one.shape in ("area", "several") and one.count is None and not one.refers_back for one in (first, second)
    )
    return (first, second) if known else None


_Compared = tuple[tuple[Thing, ...], tuple[PlaceMeaning, PlaceMeaning]]


@construction("asks_whether: ASKMEAN WHETHER", "asks_whether: ASKMEAN IF", "asks_whether: MEASURE WHETHER", cost=0.0)
@construction("asks_whether: MEASURE IF", "asks_whether: TELLME WHETHER", "asks_whether: TELLME IF", cost=0.0)
@construction("asks_whether: [DET] claimant CLAIMS [QUESTION]", cost=0.1)
def asks_whether() -> str:
    """Compose "find out whether" and "my neighbour says that", which readings in each place tell."""
    return "whether"


@construction("below_it: in_", "below_it: UNDERIT", cost=0.0)
def below_it() -> str:
    """Compose "in" and "under" before ground or plants."""
    return "in"


@construction("more_of: more=BARECMP", "more_of: DET what=MEDIUM more=BARECMP", cost=0.0, given=("robot",))
@construction("more_of: more=BARECMP things=things", "more_of: more=BARECMP what=MEDIUM", cost=0.0, given=("robot",))
def compared_quantity(
    robot: RobotProfile, more: Lex, things: tuple[Thing, ...] = (), what: Lex | None = None
) -> list[tuple[Thing, ...]] | None:
    """Compose "wetter", "more nitrate" and "cooler leaves", as what is measured."""
    if what is not None:
        naming: Naming = what.value
        return [(Thing(naming.actions[0]),)] if naming.actions else None
    return which_of_two(robot, None if things else more, things)


@construction(
    "comparing: [asks_whether] THEREIS what=more_of in_ first=place THAN [in_] second=place",
    "comparing: IS IT what=more_of below_it first=place THAN [below_it] second=place",
    "comparing: asks_whether IT IS what=more_of below_it first=place THAN [below_it] second=place",
    "comparing: asks_whether CONTRACTED what=more_of below_it first=place THAN [below_it] second=place",
    "comparing: IS what=more_of below_it first=place THAN [below_it] second=place",
    "comparing: IS first=place [HOLDS] what=more_of THAN [in_] second=place",
    "comparing: ASKSDO first=place HOLDS what=more_of THAN [in_] second=place",
    "comparing: asks_whether first=place IS what=more_of THAN [in_] second=place",
    cost=0.2,
)
def more_than(what: tuple[Thing, ...], first: PlaceMeaning, second: PlaceMeaning) -> _Compared | None:
    """Compose "is there more nitrate on the bank than on the slope" and "does row 3 have warmer leaves than row 4"."""
    areas = two_areas(first, second)
    return None if areas is None else (what, areas)


@construction("comparing: IS first=place cmp=CMP second=place", cost=0.2, given=("robot",))
@construction("comparing: asks_whether first=place IS cmp=CMP second=place", cost=0.2, given=("robot",))
def is_more_than(first: PlaceMeaning, cmp: Lex, second: PlaceMeaning, robot: RobotProfile) -> list[_Compared] | None:
    """Compose "is the wet corner wetter than the slope"."""
    word = "moisture" if "of_water" in cmp.features else "temperature" if "of_heat" in cmp.features else ""
    areas = two_areas(first, second)
    return None if areas is None else [((Thing(name),), areas) for name in _measuring(word, robot)] or None


def _measuring(word: str, robot: RobotProfile) -> list[str]:
    """Return the actions that measure a quantity with a word in its name."""
    return [one.name for one in robot.actions if word and any(word in name.split("_") for name in one.measures)]


@construction(
    "share_of_each: n=in_each",
    "share_of_each: n=count [TREE] OF EACH",
    "share_of_each: n=count [TREE] OF EACH [COMMA] how=how_spread",
    cost=0.1,
)
@construction("share_of_each: n=in_each [COMMA] how=how_spread", cost=0.1)
def of_each(n: int | SoManyEach, how: str = "") -> tuple[int, str]:
    """Compose "three plants of each, evenly spread along the bed"."""
    if isinstance(n, SoManyEach):
        return n.count, "random" if n.random else how
    return n, how


@construction("how_spread: EVENLYSPACED [ALONGBED]", "how_spread: SPREADOUT", cost=0.0)
def evenly_spread() -> str:
    """Compose "evenly spread along the bed"."""
    return "even"


@construction("how_spread: RANDOM", cost=0.0)
def at_random() -> str:
    """Compose "at random"."""
    return "random"


@construction("share_of_each: n=count RANDOM [TREE] OF EACH", cost=0.1)
def random_of_each(n: int) -> tuple[int, str]:
    """Compose "six random plants of each"."""
    return n, "random"


@construction("comparing: things=which_of_two [COMMA] areas=two_areas", cost=0.0)
def which_of_these(things: tuple[Thing, ...], areas: tuple[PlaceMeaning, PlaceMeaning]) -> _Compared:
    """Compose "which is wetter, the slope or the bank"."""
    return things, areas


@construction("answer: [TAKE] each=share_of_each", "answer: MEASURE [AT] each=share_of_each", cost=0.0)
@construction("answer: USE each=share_of_each", "answer: BASEDON each=share_of_each", cost=0.0)
def answer(each: tuple[int, str]) -> tuple[int, str, str]:
    """Compose "take four readings in each" and "using eight random plants of each kind"."""
    return (*each, "")


@construction("answer: verb things=things OF each=share_of_each", "answer: verb things=things INEACH", cost=0.0)
def answer_by_things(things: tuple[Thing, ...], each: tuple[int, str] | None = None) -> tuple[int, str, str] | None:
    """Compose "take a picture of eight random plants of each" and "take five CO2 readings in each"."""
    count = things[0].count or 1
    if len(things) > 1 or things[0].parameters or (each is not None and count != 1):
        return None
    return (count, "", things[0].action) if each is None else (*each, things[0].action)


@construction(
    "capture: asked=comparing FULLSTOP by=answer",
    "capture: asked=comparing [COMMA] by=answer",
    cost=0.2,
    given=("site",),
)
def answered_by(asked: _Compared, by: tuple[int, str, str], used: int, site: Site) -> CaptureCommand | None:
    """Compose "which is wetter, the slope or the bank? Take four readings in each."."""
    (things, areas), (count, how, action) = asked, by
    parts = [_some_of(one.selector, count, how, site) for one in areas]
    if count < 1 or any(one.count not in (None, 1) for one in things) or action not in ("", things[0].action):
        return None
    return CaptureCommand(things, PlaceMeaning(s.UnionOf(parts=tuple(parts)), "several", count=2 * count), used)


def _some_of(area: s.Selector, count: int, how: str, site: Site) -> s.Selector:
    """Return so many places of an area: spread over it, evenly along its row, or drawn."""
    free = bare_points(area, site, count, random=how == "random")
    if free is not None:
        return free
    if how == "random":
        return s.RandomSample(count=count, of=area)
    row = row_of_all(Nominal(area), site)
    return (
        s.Evenly(count=count, of=area if are_rows(area) else over(area, row))
        if row is not None and count > 1
        else s.Spread(count=count, of=area)
    )
