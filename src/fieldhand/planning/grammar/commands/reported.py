"""Constructions of what the report of a mission says anyway: "and tell me the average", "how far apart are they?".

The report lists each reading, and of all readings of a quantity their lowest, mean, median and highest. To ask for it
behind the captures asks for nothing more, if it is about these captures.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, cast

from fieldhand.places import selectors as s
from fieldhand.places.series_statistics import Statistic as StatisticName
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.adjuncts import drawn_likewise
from fieldhand.planning.grammar.meaning import (
    CaptureCommand,
    Connective,
    InTurn,
    LinkedCommand,
    PlaceMeaning,
    Reported,
    Said,
    Thing,
)
from fieldhand.planning.grammar.meaning import Subject as Statistic
from fieldhand.planning.grammar.words import Lex
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class Finding:
    """Figures that are asked for of the readings.

    Attributes:
        quantities: Quantities that the phrase names.
        places: Places that it names.
        asks: True for a clause that asks ("which is higher").
        extreme: True for the place with the highest or lowest reading ("the driest one").
        of: The only statistic that the phrase names, which "it" may mean behind it.
    """

    quantities: tuple[str, ...] = ()
    places: tuple[PlaceMeaning, ...] = ()
    asks: bool = False
    extreme: bool = False
    of: StatisticName | Literal[""] = ""


@construction("finding: one=statistic", cost=0.1)
def statistic(one: Statistic) -> Finding:
    """Compose "the average" and "the mean CO2 of the slope"."""
    quantities = (one.quantity,) if one.quantity else ()
    extreme = one.of in ("minimum", "maximum") and not quantities
    return Finding(quantities, () if one.place is None else (one.place,), extreme=extreme, of=one.of)


@construction("finding: [DET] STATISTIC READING", cost=0.2)
def value() -> Finding:
    """Compose "the highest value"."""
    return Finding()


@construction(
    "finding: [DET] [n=count] FIGURES",
    "finding: EACH [OF] [DET] [n=count] FIGURES",
    "finding: [DET] [n=count] noun=NOUN FIGURES",
    "finding: [DET] [n=count] FIGURES OF [DET] noun=NOUN",
    cost=0.2,
)
def figures(noun: Lex | None = None, n: int = 0) -> list[Finding]:
    """Compose "the averages" and "the difference"."""
    del n
    quantities = () if noun is None else tuple(dict.fromkeys(noun.value.quantities))
    return [Finding((one,)) for one in quantities] or [Finding()]


@construction(
    "readings_said: word=DET [n=count] READFIGURES",
    "readings_said: EACH [DET] [n=count] READFIGURES",
    "readings_said: EACH [DET] READING",
    "readings_said: readings_said WITHEACHOTHER",
    "readings_said: word=DET [n=count] noun=NOUN READFIGURES",
    cost=0.2,
)
def readings_said(word: Lex | None = None, noun: Lex | None = None, n: int = 0) -> list[Finding] | None:
    """Compose "the two values" and "all the readings"."""
    if word is not None and "indefinite" in word.features:
        return None
    return figures(noun, n)


@construction(
    "finding: WHICHONE [of_the_two] IS [BYFAR] BARECMP",
    "finding: WHICHONE [of_the_two] IS [BYFAR] [DET] STATISTIC [ONE]",
    "finding: WHICHONE [of_the_two] IS [BYFAR] [DET] MOSTREAD [ONE]",
    "finding: WHICHONE [of_the_two] IS one=statistic",
    "finding: DIFFERS",
    "finding: HOWAPART who_differs [IS]",
    "finding: HOWAPART IS who_differs",
    "finding: HOWDIFFER who_differs DIFFERV",
    "finding: HOWBIG [DET] DIFFERENCE [BETWEENTHEM] [IS]",
    "finding: HOWBIG IS [DET] DIFFERENCE [BETWEENTHEM]",
    "finding: [DET] DIFFERENCE BETWEENTHEM",
    "finding: WHERE IT IS STATISTIC",
    "finding: WHERE IT IS MOSTREAD",
    "finding: WHERE [DET] noun=NOUN IS STATISTIC",
    "finding: WHERE [DET] noun=NOUN IS MOSTREAD",
    cost=0.2,
)
def which_is_more(one: Statistic | None = None, noun: Lex | None = None) -> Finding | None:
    """Compose "which is higher", "which of the two is driest", "where it is highest" and "how far apart they are"."""
    found = Finding() if one is None else statistic(one)
    if noun is not None:
        if len(noun.value.quantities) != 1:
            return None
        found = Finding((noun.value.quantities[0],))
    return Finding(found.quantities, found.places, asks=True)


@construction(
    "who_differs: IT", "who_differs: them_all", "who_differs: readings_said", "who_differs: DET [n=count] FIGURES",
    "who_differs: DET [n=count] PARTWORD", "who_differs: DET [n=count] GROUPNOUN",
    cost=0.1,
)  # fmt: skip
def who_differs(n: int = 0) -> str:
    """Compose "they", "the two values" and "the crops" of "how they differ"."""
    del n
    return "they"


@construction(
    "finding: whether [DET] claimant [IS] RIGHTWORD", "finding: whether THEREIS [DET] DIFFERENCE [BETWEENTHEM]",
    "finding: whether who_differs DIFFERV", "finding: whether who_differs IS DET SAME",
    cost=0.2,
)  # fmt: skip
def whether_so() -> Finding:
    """Compose "whether she is right" and "if they differ" behind "tell me"; by itself "if" is a condition."""
    return Finding()


@construction("whether: WHETHER", "whether: IF", cost=0.0)
@construction(
    "claimant: PEOPLE", "claimant: PAPERWORK", "claimant: IT", "claimant: CLAIMANT", "claimant: IMPERSONAL", cost=0.0
)
def whether() -> str:
    """Compose "whether", and who is right."""
    return "whether"


@construction(
    "finding: whether one=place IS BARECMP",
    "finding: whether one=place IS BARECMP THAN other=place",
    "finding: whether one=place IS CMP other=place",
    "finding: whether IT IS BARECMP relation one=place",
    "finding: whether IT IS BARECMP relation one=place THAN [relation] other=place",
    cost=0.2,
)
def whether_more(one: PlaceMeaning, other: PlaceMeaning | None = None) -> Finding:
    """Compose "whether the slope is warmer" and "if it is cooler at the pond" behind "tell me"."""
    return Finding(places=(one,) if other is None else (one, other))


@construction(
    "finding: WHICHONE [of_the_two] IS [BYFAR] BARECMP [COMMA] one=place OR other=place",
    "finding: WHICHONE [of_the_two] IS [BYFAR] BARECMP [COMMA] [relation] one=place OR relation other=place",
    cost=0.2,
)
def which_of_those(one: PlaceMeaning, other: PlaceMeaning) -> Finding:
    """Compose "which is wetter, the slope or the paddock"."""
    return Finding(places=(one, other), asks=True)


@construction(
    "of_the_two: ONE",
    "of_the_two: OFTHEALL",
    "of_the_two: ONE OFTHEALL",
    "of_the_two: OF DET n=count",
    "of_the_two: ONE OF DET n=count",
    "of_the_two: noun=TREE",
    "of_the_two: noun=ROW",
    "of_the_two: noun=PLOT",
    "of_the_two: noun=POINT",
    "of_the_two: noun=READING",
    "of_the_two: OFTHEM",
    "of_the_two: ONE OFTHEM",
    "of_the_two: OF DET n=count POINT",
    "of_the_two: PARTWORD",
    "of_the_two: OF DET n=count PARTWORD",
    "of_the_two: OF DET n=count TREE",
    "of_the_two: OF DET n=count ROW",
    cost=0.1,
)
def of_them(n: int = 0, noun: Lex | None = None) -> str:
    """Compose "one", "of the two" and "bed" of "which bed is wetter"."""
    del n, noun
    return "of them"


@construction(
    "finding: one=finding OFTHEALL",
    "finding: one=finding of_the_two",
    "finding: one=finding BETWEEN DET [n=count] [FIGURES]",
    "finding: one=finding OF DET n=count FIGURES",
    "finding: one=finding OF DET FIGURES",
    "finding: one=finding OF DET READING",
    "finding: one=finding ONAVERAGE",
    "finding: one=finding PER PARTWORD",
    "finding: one=finding BETWEEN [DET] [n=count] PARTWORD",
    "finding: one=finding PER TREE",
    "finding: one=finding PER ROW",
    "finding: one=finding INEACHCASE",
    "finding: one=finding WITHEACHOTHER",
    "finding: one=finding PERROUND",
    cost=0.1,
)
def of_all(one: Finding, n: int = 0) -> Finding:
    """Compose "the average of the five" and "which is higher each time"."""
    del n
    return one


@construction(
    "finding: one=finding relation place=place",
    "finding: one=finding BETWEEN place=place",
    "finding: one=finding FOR place=place",
    "finding: one=finding PER place=place",
    cost=0.2,
)
def figure_at(one: Finding, place: PlaceMeaning) -> Finding | None:
    """Compose "the difference between the slope and the paddock"."""
    return None if place.refers_back else Finding(one.quantities, (*one.places, place), one.asks)


@construction(
    "finding: first=finding AND second=finding",
    "finding: first=finding COMMA second=finding",
    "finding: first=finding COMMA AND second=finding",
    "finding: first=finding TOGETHERWITH second=finding",
    cost=0.1,
)
def both(first: Finding, second: Finding) -> Finding:
    """Compose "the mean and the highest one"."""
    return Finding((*first.quantities, *second.quantities), (*first.places, *second.places), first.asks and second.asks)


@construction(
    "report_wish: TELLME figure=finding",
    "report_wish: TELLME INEACHCASE [COMMA] figure=finding",
    "report_wish: TELLME figure=readings_said",
    "report_wish: figure=finding TELLSUS",
    "report_wish: ASKFOR [COMMA] figure=finding",
    "report_wish: COMPARES figure=finding",
    "report_wish: COMPARES figure=readings_said",
    "report_wish: COMPARES figure=them_all",
    "report_wish: WHATIS figure=finding",
    "report_wish: IS figure=finding",
    cost=0.1,
)
def report_wish(figure: Finding) -> Finding:
    """Compose "tell me the average" and "compare the averages"."""
    return figure


@construction("one_side: one=finding", "one_side: one=readings_said", "one_side: one=them_all", cost=0.0)
@construction("one_side: DET ONE relation place=place", "one_side: DET READING relation place=place", cost=0.1)
@construction("one_side: DET ORD [ONE]", "one_side: DET ORD READING", "one_side: DET OTHERS", "one_side: IT", cost=0.2)
@construction("one_side: place=place", "one_side: OTHERS", "one_side: DET [n=count] PARTWORD", cost=0.3)
def one_side(one: Finding | None = None, place: PlaceMeaning | None = None, n: int = 0) -> Finding | None:
    """Compose "their average", "the one from the mast" and "the slope" as one side of a comparison."""
    del n
    if place is not None and place.refers_back:
        return None
    return one or Finding(places=() if place is None else (place,))


@construction(
    "report_wish: COMPARES first=one_side WITH second=one_side",
    "report_wish: COMPARES first=one_side AND second=one_side",
    "report_wish: COMPARES first=one_side AT second=one_side",
    cost=0.3,
)
def compared_with(first: Finding, second: Finding) -> Finding:
    """Compose "compare their average with the one from the mast"."""
    return both(first, second)


@construction("report_wish: TELLME figure=readings_said TOGETHERWITH more=finding", cost=0.1)
@construction("report_wish: TELLME figure=readings_said [COMMA] AND more=finding", cost=0.1)
def readings_and_more(figure: Finding, more: Finding) -> Finding:
    """Compose "list all the readings and the mean"."""
    return both(figure, more)


@construction(
    "wants_figure: TELLME", "wants_figure: WHATIS", "wants_figure: GETFIGURE", "wants_figure: ASKMEAN",
    "wants_figure: MEASURE", "wants_figure: TAKE",
    cost=0.0,
)  # fmt: skip
def wants_figure() -> str:
    """Compose "get" and "work out" before a statistic of readings."""
    return "get"


@construction(
    "capture: wants_figure DET of=STATISTIC [OF] [DET] things=things way=relation place=place",
    "capture: COMPARES [DET] [of=STATISTIC] [OF] [DET] things=things way=relation place=place",
    "capture: COMPARES [DET] [of=STATISTIC] [OF] [DET] things=things BETWEEN place=place",
    "capture: COMPARES place=place FOR [DET] things=things",
    cost=0.4,
)
def measured_for(
    things: tuple[Thing, ...], place: PlaceMeaning, used: int, way: str = "at", of: Lex | None = None
) -> CaptureCommand | None:
    """Compose "get the mean CO2 of four spots on the slope" and "compare CO2 on the slope and on the bank"."""
    if place.shape not in ("one", "several", "area") or (of is not None and things[0].count is not None):
        return None
    if of is None or place.shape == "one":
        return CaptureCommand(things, place, used, relation=way)
    several = tuple(replace(one, plural=place.shape == "area") for one in things)
    return CaptureCommand(several, place, used, relation=way, of=cast(StatisticName, of.value))


@construction("against: WITH", "against: AGAINST", cost=0.0)
def against() -> str:
    """Compose "with" and "to" between what is compared."""
    return "with"


@construction("said: COMPARES first=capture against second=capture", cost=0.3, given=("site",))
@construction("said: before=said joint=joint COMPARES first=capture against second=capture", cost=0.6, given=("site",))
def compared_captures(
    first: CaptureCommand,
    second: CaptureCommand,
    used: int,
    site: Site,
    before: Said | None = None,
    joint: Connective | None = None,
) -> Said | None:
    """Compose "compare six random readings in the strip with six in the meadow", taken one after the other."""
    if first.place is None or second.place is None or second.place.refers_back:
        return None
    own = used & ~first.used & ~second.used & ~(0 if joint is None else joint.used)
    earlier = () if before is None else before.clauses
    for clause in earlier:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    with_it = Connective(False, False, own, both=True)
    return Said((*earlier, LinkedCommand(joint, first), LinkedCommand(with_it, drawn_likewise(second, first, site))))


@construction("compared_at: [word=DET] [relation] place=place", "compared_at: DET ONE relation place=place", cost=0.1)
@construction("compared_at: DET READING relation place=place", cost=0.1)
def compared_at(place: PlaceMeaning, word: Lex | None = None) -> PlaceMeaning | None:
    """Compose "that at the mast" and "the mast" as the place of the second readings that are compared."""
    known = place.shape in ("one", "area") and not place.refers_back and place.count in (None, 1)
    return place if known and (word is None or "demonstrative" in word.features) else None


@construction("said: COMPARES first=capture against at=compared_at", cost=0.4, given=("site",))
@construction("said: before=said joint=joint COMPARES first=capture against at=compared_at", cost=0.7, given=("site",))
def compared_with_place(
    first: CaptureCommand,
    at: PlaceMeaning,
    used: int,
    site: Site,
    before: Said | None = None,
    joint: Connective | None = None,
) -> Said | None:
    """Compose "compare the CO2 at the trough with that at the mast", taken one after the other."""
    single = first.place is not None and first.place.shape in ("one", "area") and first.place.count in (None, 1)
    if not single or any((one.count or 1) > 1 or one.plural for one in first.things):
        return None
    second = replace(first, place=at, relation="at", used=at.tokens)
    return compared_captures(first, second, used, site, before, joint)


@construction("them_all: THEMALL [WITHEACHOTHER]", cost=0.1)
def them_all() -> Finding:
    """Compose "the two" of "compare the two"."""
    return Finding()


@construction("report_wish: GETFIGURE figure=finding", cost=0.3)
def wanted_figure(figure: Finding) -> Finding | None:
    """Compose "give me the average"; "get the driest one" may be about the place."""
    return None if figure.extreme else figure


@construction("report_wish: figure=finding", cost=0.2)
def asked(figure: Finding) -> Finding | None:
    """Compose "which is higher?"."""
    return figure if figure.asks else None


@construction(
    "report_wish: first=report_wish [COMMA] AND second=report_wish",
    "report_wish: first=report_wish COMMA second=report_wish",
    cost=0.2,
)
def told_both(first: Finding, second: Finding) -> Finding:
    """Compose "work out the average and tell me which is higher"."""
    return both(first, second)


@construction("said: before=said joint=joint figure=report_wish", cost=0.3, given=("robot",))
@construction("said: before=said figure=report_wish", cost=0.6, given=("robot",))
def reported(
    before: Said, figure: Finding, used: int, robot: RobotProfile, joint: Connective | None = None
) -> Said | None:
    """Compose "read CO2 at trees 4 and 9 and tell me the average", of what is read there."""
    said = [one.command.command if isinstance(one.command, InTurn) else one.command for one in before.clauses]
    done = [one for one in said if isinstance(one, CaptureCommand)]
    if not done or not (joint is None or joint.full or joint.both or joint.bare or joint.then):
        return None
    read = {name for one in done for thing in one.things for name in _measured(thing.action, robot)}
    known = {zone for one in said for zone in _places(getattr(one, "place", None))}
    if not read or not {*figure.quantities} <= read or not all(_places(one) <= known for one in figure.places):
        return None
    own = used
    for clause in before.clauses:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    if joint is not None:
        own &= ~joint.used
    return Said((*before.clauses, LinkedCommand(joint, Reported(own, figure.of))))


def _measured(action: str, robot: RobotProfile) -> frozenset[str]:
    """Return what an action measures; of one that is not known yet, all that the robot measures."""
    known = robot.action.get(action)
    return frozenset(robot.quantity) if known is None else frozenset(known.measures)


def _places(place: PlaceMeaning | None) -> set[str]:
    """Return the names of the zones, rows and plants that a place names."""
    found: set[str] = set()
    for part in () if place is None else place.selector.walk():
        zone = str(getattr(part, "zone", ""))
        if zone or not any(True for _ in part.inner):
            found.add(zone or repr(part))
        elif getattr(part, "of", None) == s.Trees():
            found.add(repr(part))
    return found - {repr(s.Trees()), repr(s.Here())}
