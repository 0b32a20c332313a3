"""Constructions of places by earlier missions: "not visited since Monday", "the 5 hottest of last week"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.places.earlier.period import EVER
from fieldhand.places.earlier.recorded_work import EarlierStatistic
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.earlier.periods import PastTime
from fieldhand.planning.grammar.earlier.unsaid import unsaid
from fieldhand.planning.grammar.earlier.work import EarlierWork, of_some_time
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning, Subject, Test
from fieldhand.planning.grammar.places.clauses import Clause, Trait
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import chooses_from_trees, over
from fieldhand.robot.model import Quantity, RobotProfile

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Cost of a clause about earlier missions that names no period, above that of one about this mission.
_WITHOUT_PERIOD = 2.0
#: Statistics of the readings of earlier missions, by those of the grammar.
_STATISTICS: dict[str, EarlierStatistic] = {
    "mean": "mean", "median": "median", "minimum": "minimum", "maximum": "maximum", "": "latest",
}  # fmt: skip
_IT = Subject()
_OPPOSITE = {"lt": "ge", "ge": "lt", "gt": "le", "le": "gt", "eq": "ne"}


# What was done.


@construction("trait: work=WORKSAID when=PERIOD", "trait: WHICH when=PERIOD work=WORKSAID", cost=0.2)
def done_in_period(work: Lex, when: Lex) -> list[Trait]:
    """Compose "not visited since Monday"."""
    said: EarlierWork = work.value
    return [Trait(earlier=one) for one in said.selectors(when.value)]


@construction("trait: work=WORKSAID", cost=0.2 + _WITHOUT_PERIOD)
def done_before(work: Lex) -> list[Trait]:
    """Compose "already visited" and "that failed"."""
    said: EarlierWork = work.value
    return [Trait(earlier=one) for one in said.selectors(None)]


@construction("nominal: adjective=WORKADJ inner=nominal when=PERIOD", cost=0.2)
@construction("nominal: adjective=WORKADJ inner=nominal", cost=0.2 + _WITHOUT_PERIOD)
def of_earlier_result(adjective: Lex, inner: Nominal, when: Lex | None = None) -> list[Nominal] | None:
    """Compose "failed trees of yesterday"."""
    if inner.single or inner.complete or not chooses_from_trees(inner.selector):
        return None
    work = EarlierWork((("", ""),), outcomes=(adjective.value,))
    found = work.selectors(None if when is None else when.value)
    return [replace(inner, selector=over(one, inner.selector), tested=True) for one in found]


@construction("place: whole=place [COMMA] clause=relative", cost=0.4)
def named_trees_with(whole: PlaceMeaning, clause: Clause) -> PlaceMeaning | None:
    """Compose "trees 4, 5 and 6 that were not done yesterday"."""
    named = whole.shape == "several" and all(one.named_tree for one in whole.selector.members)
    if not named or any(trait.earlier is None for trait in clause):
        return None
    selector = whole.selector
    for trait in clause:
        selector = selector if trait.earlier is None else over(trait.earlier, selector)
    return replace(whole, selector=selector, count=None)


# What was read.


@construction(
    "earlier_test: subject=measured WAS test=predicate when=PERIOD",
    "earlier_test: subject=measured when=PERIOD WAS test=predicate",
    "earlier_test: when=PERIOD subject=measured WAS test=predicate",
    cost=0.1,
    given=("robot",),
)
@construction("earlier_test: subject=measured WAS test=predicate", cost=0.1 + _WITHOUT_PERIOD, given=("robot",))
def was_read(
    test: Test, robot: RobotProfile, when: Lex | None = None, subject: Subject = _IT
) -> list[s.Selector] | None:
    """Compose "CO2 was above 450 ppm last time" behind "where"."""
    if subject.place is not None or subject.setting:
        return None
    return tested_earlier(
        replace(test, quantity=subject.quantity or test.quantity, of=subject.of or test.of), when, robot
    )


@construction(
    "earlier_value: test=predicate when=PERIOD", "earlier_value: when=PERIOD test=predicate",
    cost=0.1, given=("robot",),
)  # fmt: skip
def value_in_period(test: Test, when: Lex, robot: RobotProfile) -> list[s.Selector] | None:
    """Compose "above 450 ppm last time" behind "that were"."""
    return None if when.value.unsaid else tested_earlier(test, when, robot)


@construction(
    "trait: WAS test=earlier_value", "trait: which_is test=earlier_value", "trait: WHICH WAS test=earlier_value",
    "trait: test=earlier_value",
    cost=0.2,
)  # fmt: skip
def of_earlier_value(test: s.Selector) -> Trait:
    """Compose "that were above 450 ppm last time"."""
    return Trait(earlier=test)


@construction(
    "trait: WITH subject=measured test=predicate when=PERIOD",
    "trait: WITH subject=measured OF test=predicate when=PERIOD",
    "trait: WHICH subject=measured test=predicate when=PERIOD",
    "trait: WAS subject=measured test=predicate when=PERIOD",
    "trait: WAS subject=measured OF test=predicate when=PERIOD",
    "trait: WHICH WAS subject=measured test=predicate when=PERIOD",
    "trait: WHICH WAS subject=measured OF test=predicate when=PERIOD",
    cost=0.3,
    given=("robot",),
)
def with_value(subject: Subject, test: Test, when: Lex, robot: RobotProfile) -> list[Trait] | None:
    """Compose "with CO2 above 450 ppm last time" and "that had a CO2 of 450 ppm or more last week"."""
    if subject.place is not None or subject.setting or when.value.unsaid:
        return None
    named = replace(test, quantity=subject.quantity or test.quantity, of=subject.of or test.of)
    return [Trait(earlier=one) for one in tested_earlier(named, when, robot) or ()] or None


@construction(
    "trait: WITH [DET] level=LEVEL noun=NOUN [READING] when=PERIOD",
    "trait: WHICH WAS [DET] level=LEVEL noun=NOUN [READING] when=PERIOD",
    "trait: WAS [DET] level=LEVEL noun=NOUN [READING] when=PERIOD",
    cost=0.3,
    given=("robot",),
)
def with_level(level: Lex, noun: Lex, when: Lex, robot: RobotProfile) -> list[Trait] | None:
    """Compose "with high CO2 last week"."""
    found = [
        one
        for name in quantities_of(noun)
        for one in tested_earlier(Test(name, "level", level.value), when, robot) or ()
    ]
    return [Trait(earlier=one) for one in found] or None


@construction("trait: WHICH test=earlier_test", "trait: test=earlier_test", cost=0.2)
def whose_reading_was(test: s.Selector) -> Trait:
    """Compose "whose CO2 was high last week"."""
    return Trait(earlier=test)


@construction("relative: WHERE test=earlier_test", cost=0.2)
def where_it_was(test: s.Selector) -> Clause:
    """Compose "where CO2 was high last week" behind "trees"."""
    return (Trait(earlier=test),)


@construction("relative: WHERE first=earlier_test AND second=earlier_test", cost=0.3)
def where_both_were(first: s.Selector, second: s.Selector) -> Clause | None:
    """Compose "where CO2 was high and it was hot last week"."""
    return (Trait(earlier=first), Trait(earlier=second))


@construction(
    "place_where: WHERE test=earlier_test",
    "place_where: DET POINT WHERE test=earlier_test",
    "place_where: WHERE test=earlier_test in_ where=region",
    "place_where: in_ where=region WHERE test=earlier_test",
    cost=0.3,
)
def places_where_it_was(test: s.Selector, where: s.Selector | None = None) -> PlaceMeaning:
    """Compose "where CO2 was high last week" as places."""
    return PlaceMeaning(test if where is None else over(test, where), "several")


@construction("place_where: WHERE work=WORKSAID when=PERIOD", "place: work=WORKWHERE when=PERIOD", cost=0.3)
@construction("place: work=WORKWHERE", cost=0.3 + _WITHOUT_PERIOD)
def places_where_done(work: Lex, when: Lex | None = None) -> list[PlaceMeaning]:
    """Compose "where we took pictures yesterday"."""
    said: EarlierWork = work.value
    return [PlaceMeaning(one, "several") for one in said.selectors(None if when is None else when.value)]


@construction("place: WHATEVER work=WORKSAID when=PERIOD", cost=0.3)
@construction("place: WHATEVER work=WORKSAID", cost=0.3 + _WITHOUT_PERIOD)
def whatever_was_done(work: Lex, when: Lex | None = None) -> list[PlaceMeaning]:
    """Compose "what was done yesterday"."""
    return places_where_done(work, when)


def tested_earlier(test: Test, when: Lex | None, robot: RobotProfile) -> list[s.Selector] | None:
    """Return the places whose earlier readings pass a test, one selector for each quantity that may be meant."""
    said: PastTime = PastTime(EVER, unsaid=True) if when is None else when.value
    if said.longer or said.lasting or test.than is not None or test.attribute or test.of not in _STATISTICS:
        return None
    found = [_passing(test, one, said) for one in robot.quantities if test.quantity in ("", one.name)]
    return [one for one in found if one is not None] or None


def _passing(test: Test, quantity: Quantity, when: PastTime) -> s.Selector | None:
    """Return the places of a test of a quantity; None if the quantity has no such level or unit."""
    if test.unit not in ("", quantity.unit):
        return None
    bounds: list[tuple[str, float]]
    match test.check:
        case "level":
            level = quantity.levels.get(test.value)
            if level is None:
                return None
            bounds = [("gt" if level.direction == "above" else "lt", level.value)]
        case "between":
            bounds = [("ge", test.value[0]), ("le", test.value[1])]
        case "lt" | "le" | "gt" | "ge" | "eq" if isinstance(test.value, float):
            bounds = [(test.check, test.value)]
        case _:
            return None
    if test.negated:
        if len(bounds) > 1:
            return None
        bounds = [(_OPPOSITE[check], value) for check, value in bounds]
    name = quantity.name if test.quantity else unsaid(quantity.name, unit_said=bool(test.unit))
    name = of_some_time(name) if when.unsaid else name
    made: s.Selector = s.Trees()
    for check, value in bounds:
        made = s.WhereEarlier(
            quantity=name, test=check, value=value, unit=quantity.unit,  # type: ignore[arg-type]
            statistic=_STATISTICS[test.of], period=when.period, of=made,
        )  # fmt: skip
    return made


def quantities_of(noun: Lex) -> tuple[str, ...]:
    """Return the quantities that a noun names."""
    naming: Naming = noun.value
    return tuple(dict.fromkeys(naming.quantities))


# What was read most.


@construction("hottest: most=MOSTREAD", cost=0.0, given=("robot",))
def hottest(most: Lex, robot: RobotProfile) -> list[s.TopEarlier]:
    """Compose "hottest" as readings of earlier missions."""
    lowest, unit = most.value
    return [s.TopEarlier(quantity=unsaid(one.name), lowest=lowest) for one in robot.quantities if one.unit == unit]


@construction(
    "with_most: WITH [DET] most=STATISTIC noun=NOUN [READING]",
    "with_most: WITH [DET] most=STATISTIC average=AVERAGEWORD noun=NOUN [READING]",
    "with_most: WHICH WAS [DET] most=STATISTIC noun=NOUN [READING]",
    "with_most: WHICH [DET] most=STATISTIC noun=NOUN [READING]",
    "with_most: WHERE [DET] noun=NOUN [READING] WAS [DET] most=STATISTIC",
    "with_most: WHICH noun=NOUN [READING] WAS [DET] most=STATISTIC",
    cost=0.0,
)
def with_most(most: Lex, noun: Lex, average: Lex | None = None) -> list[s.TopEarlier] | None:
    """Compose "with the lowest soil moisture" and "where CO2 was highest"."""
    if most.value not in ("minimum", "maximum"):
        return None
    statistic: EarlierStatistic = "latest" if average is None else "mean"
    return [
        s.TopEarlier(quantity=name, lowest=most.value == "minimum", statistic=statistic) for name in quantities_of(noun)
    ]


@construction(
    "with_most: WHERE [IT] WAS [DET] most=hottest",
    "with_most: WHICH WAS [DET] most=hottest",
    "with_most: WHICH [DET] most=hottest",
    "with_most: which_is [DET] most=hottest",
    cost=0.0,
)
def where_hottest(most: s.TopEarlier) -> s.TopEarlier:
    """Compose "that were hottest"."""
    return most


@construction("with_most: WHERE IT WAS [DET] most=STATISTIC", cost=0.0, given=("robot",))
def where_highest(most: Lex, robot: RobotProfile) -> list[s.TopEarlier] | None:
    """Compose "where it was highest", of what the step measures."""
    if most.value not in ("minimum", "maximum"):
        return None
    lowest = most.value == "minimum"
    return [s.TopEarlier(quantity=unsaid(one.name, unit_said=False), lowest=lowest) for one in robot.quantities]


@construction("of_most: [DET] most=STATISTIC noun=NOUN", cost=0.0)
def highest_reading(most: Lex, noun: Lex) -> list[s.TopEarlier] | None:
    """Compose "highest CO2" before "trees"."""
    return with_most(most, noun)


@construction(
    "place: [DET] most=hottest [several=read_noun] when=PERIOD",
    "place: [DET] n=count most=hottest [several=read_noun] when=PERIOD",
    "place: [DET] most=hottest n=count [several=read_noun] when=PERIOD",
    "place: [DET] n=count [several=read_noun] most=with_most when=PERIOD",
    "place: [DET] several=read_noun most=with_most when=PERIOD",
    "place: [DET] n=count most=of_most several=read_noun when=PERIOD",
    "place: [DET] when=PERIODPOSS most=hottest [several=read_noun]",
    "place: [DET] when=PERIODPOSS n=count most=hottest [several=read_noun]",
    "place: [DET] when=PERIODPOSS most=hottest n=count [several=read_noun]",
    "place: [DET] n=count when=PERIODPOSS most=hottest [several=read_noun]",
    "place_where: most=with_most when=PERIOD",
    cost=0.3,
)
def most_read_earlier(most: s.TopEarlier, when: Lex, n: int = 1, several: bool | None = None) -> PlaceMeaning | None:
    """Compose "the 10 hottest trees of last week" and "yesterday's hottest tree"."""
    return _top(most, when.value, n, several, s.Trees())


@construction(
    "place: [DET] most=hottest [several=read_noun] in_ where=region when=PERIOD",
    "place: [DET] n=count most=hottest [several=read_noun] in_ where=region when=PERIOD",
    "place: [DET] most=hottest n=count [several=read_noun] in_ where=region when=PERIOD",
    "place: [DET] most=hottest [several=read_noun] when=PERIOD in_ where=region",
    "place: [DET] n=count most=hottest [several=read_noun] when=PERIOD in_ where=region",
    "place: [DET] most=hottest n=count [several=read_noun] when=PERIOD in_ where=region",
    "place: [DET] n=count [several=read_noun] in_ where=region most=with_most when=PERIOD",
    "place: [DET] several=read_noun in_ where=region most=with_most when=PERIOD",
    "place: [DET] n=count [several=read_noun] most=with_most when=PERIOD in_ where=region",
    "place: [DET] n=count [several=read_noun] most=with_most in_ where=region when=PERIOD",
    "place: [DET] several=read_noun most=with_most when=PERIOD in_ where=region",
    "place: [DET] when=PERIODPOSS n=count most=hottest [several=read_noun] in_ where=region",
    "place: [DET] when=PERIODPOSS most=hottest [several=read_noun] in_ where=region",
    cost=0.3,
)
def most_read_earlier_in(
    most: s.TopEarlier, when: Lex, where: s.Selector, n: int = 1, several: bool | None = None
) -> PlaceMeaning | None:
    """Compose "the 10 hottest trees in row 3 last week"."""
    return _top(most, when.value, n, several, where)


def _top(most: s.TopEarlier, when: PastTime, n: int, several: bool | None, of: s.Selector) -> PlaceMeaning | None:
    if when.longer or when.lasting or when.unsaid or (several is not None and several != (n > 1)):
        return None  # "the hottest ones of last week": how many?
    selector = replace(most, count=n, period=when.period, of=of)
    return PlaceMeaning(selector, "several" if n > 1 else "one", count=n if n > 1 else None)
