"""Constructions of questions which of two areas has more, and of the readings that answer them.

"Which is wetter, the slope or the bank? Take four readings in each."
"""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import CaptureCommand, Nominal, PlaceMeaning, Thing
from fieldhand.planning.grammar.places.counted import row_of_all
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
    names = [one.name for one in robot.actions if word and any(word in name.split("_") for name in one.measures)]
    return [(Thing(name),) for name in names] or None


@construction("two_areas: first=place OR second=place", cost=0.0)
def two_areas(first: PlaceMeaning, second: PlaceMeaning) -> tuple[PlaceMeaning, PlaceMeaning] | None:
    """Compose "the courgettes or the pumpkins"."""
    known = all(
        one.shape in ("area", "several") and one.count is None and not one.refers_back for one in (first, second)
    )
    return (first, second) if known else None


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


@construction(
    "capture: things=which_of_two [COMMA] areas=two_areas FULLSTOP [TAKE] each=share_of_each",
    "capture: things=which_of_two [COMMA] areas=two_areas FULLSTOP MEASURE each=share_of_each",
    "capture: things=which_of_two [COMMA] areas=two_areas FULLSTOP USE each=share_of_each",
    cost=0.2,
    given=("site",),
)
def answered_by(
    things: tuple[Thing, ...],
    areas: tuple[PlaceMeaning, PlaceMeaning],
    each: tuple[int, str],
    used: int,
    site: Site,
) -> CaptureCommand | None:
    """Compose "which is wetter, the slope or the bank? Take four readings in each."."""
    count, how = each
    parts = [_some_of(one.selector, count, how, site) for one in areas]
    if count < 1 or any(one.count not in (None, 1) for one in things):
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
