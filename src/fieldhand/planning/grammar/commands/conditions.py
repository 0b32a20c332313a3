"""Constructions of tests, conditions and questions, and of work that depends on the budget or on a failure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.parameters import with_parameter
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    LATEST_READING,
    NTH_READING,
    SAME_THRESHOLD,
    Allowed,
    AllTests,
    Amount,
    CaptureCommand,
    CaptureWhere,
    Check,
    Failing,
    HowMany,
    Likewise,
    Nominal,
    OfLast,
    Otherwise,
    ParameterValue,
    PassOn,
    PlaceMeaning,
    ReadingQuestion,
    Subject,
    Test,
    Thing,
    UntilCondition,
    When,
)
from fieldhand.planning.grammar.places.compass import AWAY_FROM
from fieldhand.planning.grammar.places.numbers import named_trees
from fieldhand.planning.grammar.places.sampling import bare_points, whole_zone
from fieldhand.planning.grammar.words import Lex, hinted_attributes
from fieldhand.planning.selections import as_in_row, as_some, is_one_row
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Comparisons that are true where another one is not.
_OPPOSITE: Mapping[Check, Check] = {"lt": "ge", "ge": "lt", "gt": "le", "le": "gt"}
#: Units of the readings of which some levels are said, by the feature of the words.
_SAID_OF = {"of_heat": "degC", "of_water": "percent"}
#: Largest number of readings of which a request says how many pass a test.
_MOST_OF_SEVERAL = 9
#: The reading taken last.
_IT = Subject()


@construction("measured: word=IT", "measured: ITS", "measured: [DET] READING", cost=0.0)
def anything(word: Lex | None = None) -> Subject:
    """Compose "it", and "that one", which is the latest reading of several."""
    return Subject(LATEST_READING if word is not None and "latest" in word.features else "")


@construction("measured: word=DET", cost=0.3)
def that(word: Lex) -> Subject | None:
    """Compose "that" alone."""
    return Subject() if "demonstrative" in word.features else None


@construction("measured: DET rank=ORD READING", "measured: DET rank=ORD ONE", "measured: DET rank=ORD", cost=0.0)
@construction("measured: DET LAST READING", "measured: DET LAST ONE", cost=0.0)
def nth_reading(rank: Lex | None = None) -> Subject:
    """Compose "the first reading" and "the last one"."""
    return Subject(f"{NTH_READING}{-1 if rank is None else rank.value}")


@construction(
    "measured: [DET] noun=NOUN",
    "measured: [DET] noun=NOUN READING",
    "measured: [DET] noun=NOUN THERE",
    "measured: [DET] noun=NOUNPOSS",
    "measured: ITS AVERAGEWORD noun=NOUN",
    "measured: [DET] noun=MEDIUM",
    cost=0.0,
)
def named_quantity(noun: Lex) -> list[Subject] | None:
    """Compose "the temperature", "its average temperature" and "the air"."""
    naming: Naming = noun.value
    return [Subject(name) for name in dict.fromkeys(naming.quantities) or naming.actions[:1]] or None


@construction("measured: [DET] noun=NOUN relation word=DET tree=TREE", cost=0.1)
def quantity_of_tree(noun: Lex, word: Lex, tree: Lex) -> list[Subject] | None:
    """Compose "the canopy temperature at a tree", of each of those at which it is measured."""
    return None if tree.plural or "definite" in word.features else named_quantity(noun)


@construction(
    "measured: [DET] value=amount [DOWNTO] READING",
    "measured: [DET] value=amount [DOWNTO] ONE",
    "measured: [DET] READING how=parameter",
    "measured: DET ONE how=parameter",
    "measured: [DET] noun=NOUN [READING] how=parameter",
    cost=0.1,
    given=("robot",),
)
def with_setting(
    robot: RobotProfile, value: Amount | None = None, how: ParameterValue | None = None, noun: Lex | None = None
) -> list[Subject] | None:
    """Compose "the 15 cm value" and "the moisture at 15 cm", of readings that were taken so."""
    setting = how if value is None else ParameterValue(value.number, value.unit, ())
    if setting is None or isinstance(setting.value, str):
        return None
    made = [with_parameter(Thing(action.name), setting, robot) for action in robot.actions]
    ways = dict.fromkeys(one.parameters for one in made if one is not None)
    named = [Subject()] if noun is None else named_quantity(noun) or []
    return [replace(one, setting=way) for one in named for way in ways]


@construction(
    "measured: [DET] READING relation place=place",
    "measured: DET noun=ONE relation place=place",
    "measured: [DET] noun=NOUN [READING] relation place=place",
    "measured: [DET] noun=MEDIUM relation place=place",
    "measured: place=owned_by [READING]",
    "measured: place=owned_by noun=NOUN [READING]",
    cost=0.0,
    given=("site",),
)
def reading_at(place: PlaceMeaning, site: Site, noun: Lex | None = None) -> list[Subject] | None:
    """Compose "the temperature at tree 4" and "tree 4's"; of a zone it is that in its middle, or at a plant in it."""
    place = _in_zone(place, site)
    named = [Subject()] if noun is None or noun.value is None else named_quantity(noun) or []
    return [replace(one, place=place) for one in named] if _is_known(place) and len(named) == 1 else None


@construction("measured: place=place", cost=0.0, given=("site",))
def reading_of_place(place: PlaceMeaning, site: Site) -> Subject | None:
    """Compose "tree 31", "the southern one" and "the warm section", of a reading that was taken there."""
    place = _in_zone(place, site)
    return Subject(place=place) if _is_known(place) else None


def _in_zone(place: PlaceMeaning, site: Site) -> PlaceMeaning:
    """Return a zone as the place in it where one reading is taken; another place as it is."""
    if place.shape != "area":
        return place
    free: s.Selector | None = bare_points(place.selector, site, 1)
    if free is None and whole_zone(place.selector):
        free = s.Take(count=1, of=place.selector)
    return place if free is None else replace(place, selector=free, shape="one")


@construction(
    "measured: [DET] READING relation side=an_end",
    "measured: DET ONE relation side=an_end",
    "measured: [DET] place=DIR READING",
    "measured: [DET] place=MOST READING",
    cost=0.0,
)
def reading_to_side(side: str = "", place: Lex | None = None) -> Subject | None:
    """Compose "the one at the south end" and "the northernmost reading"."""
    to = side if place is None else place.value
    return Subject(place=PlaceMeaning(s.Here(), "one", like=Likewise("", side=to))) if to in AWAY_FROM else None


def _is_known(place: PlaceMeaning) -> bool:
    """Return True for one place that the phrase names by itself: not any tree of several, but one of a zone."""
    counted, some = as_in_row(place.selector), as_some(place.selector)
    if (
        place.shape != "one"
        or (place.like is not None and place.like.kind not in ("", "ranked"))
        or (some is not None and not (some.count == 1 and whole_zone(some.of)))
    ):
        return False
    return counted is None or is_one_row(counted.of)


@construction("terse: test=predicate", "terse: test=test", cost=0.6)
def terse(test: Test, used: int) -> When:
    """Compose "above 30 degC", behind which stands what is done then."""
    return When(AllTests((test,)), used, terse=True)


@construction("threshold: value=amount", cost=0.0)
def with_unit(value: Amount) -> tuple[float, str]:
    """Compose "30 degC"."""
    return (value.number, value.unit)


@construction("threshold: value=NUM", cost=0.2)
def without_unit(value: Lex) -> tuple[float, str]:
    """Compose "30"."""
    return (value.value, "")


@construction("predicate: check=CMP value=threshold", "predicate: check=UPTO value=threshold", cost=0.1)
def compared(check: Lex, value: tuple[float, str]) -> Test | None:
    """Compose "above 30 degC"."""
    if check.value in (None, "UPTO"):
        return Test("", "le", value[0], value[1])
    if check.value[1]:
        return None
    denied, unit = "denies" in check.features, _unit_said(check)
    if unit and value[1] not in ("", unit):
        return None
    check_ = _OPPOSITE[check.value[0]] if denied else check.value[0]
    return Test("", check_, value[0], value[1] or unit, negated=denied)


def _unit_said(word: Lex) -> str:
    """Return the unit of the readings of which a word is said ("hotter than"); empty if it is said of any."""
    return next((unit for name, unit in _SAID_OF.items() if name in word.features), "")


@construction(
    "predicate: word=BARECMP",
    "predicate: [DET] word=BARECMP ONE",
    "predicate: word=BARECMP that=DET",
    "predicate: word=CMP that=DET",
    "predicate: word=CMP IT",
    cost=0.6,
)
def than_that(word: Lex, that: Lex | None = None) -> Test | None:
    """Compose "lower" and "below that", of the threshold that was said last."""
    if that is not None and "demonstrative" not in that.features:
        return None
    check: Any = word.value
    if isinstance(word.value, tuple) and not word.value[1] and "denies" not in word.features:
        check = word.value[0]
    return Test("", check, SAME_THRESHOLD, _unit_said(word)) if check in ("lt", "gt") else None


@construction(
    "predicate: BETWEEN low=threshold AND high=threshold",
    "predicate: BETWEEN low=threshold range_to high=threshold",
    cost=0.1,
)
def between(low: tuple[float, str], high: tuple[float, str]) -> Test | None:
    """Compose "between 20 and 30 degC"."""
    if low[0] >= high[0] or (low[1] and high[1] and low[1] != high[1]):
        return None
    return Test("", "between", (low[0], high[0]), low[1] or high[1])


@construction("predicate: BETWEEN low=NUM AND high=NUM unit=UNIT", cost=0.1)
def between_in_unit(low: Lex, high: Lex, unit: Lex) -> Test | None:
    """Compose "between 20 and 30 degC"."""
    name, factor, offset = unit.value
    first, second = (round(n.value * factor + offset, 6) for n in (low, high))
    return Test("", "between", (first, second), name) if first < second else None


@construction(
    "predicate: word=OUTSIDE low=threshold range_to high=threshold",
    "predicate: word=OUTSIDE BETWEEN low=threshold range_to high=threshold",
    "predicate: word=OUTSIDE BETWEEN low=threshold AND high=threshold",
    "predicate: low=threshold range_to high=threshold",
    cost=0.1,
)
def outside(low: tuple[float, str], high: tuple[float, str], word: Lex | None = None) -> Test | None:
    """Compose "outside 20 to 30 degC" and "20 to 30 degC"."""
    inside = between(low, high)
    return inside if inside is None or word is None else replace(inside, negated=True)


@construction(
    "predicate: [AT] value=threshold bound=BOUND",
    "predicate: FROM value=threshold bound=BOUND",
    "predicate: value=threshold sign=AND",
    cost=0.1,
)
def bounded(value: tuple[float, str], bound: Lex | None = None, sign: Lex | None = None) -> Test | None:
    """Compose "30 degC or more" and "30+"."""
    if bound is None:
        return Test("", "ge", value[0], value[1]) if sign is not None and sign.text == "+" else None
    return None if bound.value[1] else Test("", bound.value[0], value[0], value[1])


@construction("predicate: STILL test=predicate", "predicate: AGAIN test=predicate", cost=0.1)
def still(test: Test) -> Test:
    """Compose "still above 30 degC" and "again above 30 degC", of the latest reading."""
    return replace(test, quantity=test.quantity or LATEST_READING)


@construction("predicate: EVERYTHING test=predicate", "predicate: LEVEL [COMMA] MEANING test=predicate", cost=0.1)
def anything_so(test: Test) -> Test:
    """Compose "anything above 30 degC" and "too hot, meaning over 40 degC"."""
    return test


@construction("predicate: level=LEVEL", "predicate: [DET] level=LEVEL READING", cost=0.1)
def at_level(level: Lex) -> Test:
    """Compose "high"; "hot" is said of a temperature only, and "dry" of moisture."""
    return Test("", "level", level.value, _unit_said(level))


@construction("predicate: DET noun=NOUN [OF] test=predicate", cost=0.4)
def with_a_quantity(noun: Lex, test: Test) -> list[Test] | None:
    """Compose "a canopy temperature above 36 degC" behind "has"."""
    return [replace(test, quantity=name) for name in measured_by(noun)] if not test.quantity else None


@construction("predicate: NOT test=predicate", cost=0.1)
def negated(test: Test) -> Test:
    """Compose "not above 30 degC"."""
    return replace(test, negated=not test.negated)


@construction(
    "test: [subject=measured] IS test=predicate",
    "test: subject=measured test=predicate",
    "test: IS subject=measured test=predicate",
    "test: test=predicate IS subject=measured",
    "test: test=predicate subject=measured IS",
    "test: [subject=measured] denied=ISNOT test=predicate",
    "test: subject=measured [IS] test=predicate relation place=place",
    "test: IS subject=measured test=predicate relation place=place",
    cost=0.2,
    given=("site",),
)
def reading_is(
    test: Test,
    subject: Subject = _IT,
    denied: Lex | None = None,
    place: PlaceMeaning | None = None,
    site: Site | None = None,
) -> Test | None:
    """Compose "it is above 30 degC", "it is not above 30 degC" and "is it above 30 degC"."""
    place = place if place is None or site is None else _in_zone(place, site)
    if place is not None and (subject.place is not None or not _is_known(place)):
        return None
    if (subject.place is not None or place is not None) and test.value == SAME_THRESHOLD:
        return None
    negated = test.negated != (denied is not None)
    return replace(
        test,
        quantity=subject.quantity or test.quantity,
        negated=negated,
        place=subject.place or place,
        setting=subject.setting,
        of=subject.of or test.of,
    )


@construction("test: subject=measured [IS] test=predicate", cost=0.8, given=("robot",))
@construction("test: subject=measured [IS] test=predicate by=measured_by", cost=0.2, given=("robot",))
def tree_measured(subject: Subject, test: Test, robot: RobotProfile, by: str = "") -> list[Test] | None:
    """Compose "tree 14 is hotter than 36 degC": which readings are in that unit?"""
    if subject.place is None or subject.quantity or subject.place.like is not None or test.value == SAME_THRESHOLD:
        return None
    measured = [by] if by else [name for action in robot.actions for name in action.measures]
    found = [name for name in measured if by or test.unit in ("", robot.quantity[name].unit)]
    return [replace(test, quantity=name, place=subject.place) for name in found]


@construction("test: number=NUM IS test=predicate", cost=0.0, given=("site",))
def number_is(number: Lex, test: Test, site: Site) -> Test | None:
    """Compose "31 came out high", of a reading that was taken there."""
    known = number.text.isdecimal() and number.text in site.by_id and test.value != SAME_THRESHOLD
    return replace(test, place=named_trees((number.text,))) if known else None


@construction("tests: test=test", cost=0.0)
def one_test(test: Test) -> AllTests:
    """Compose "it is high"."""
    return AllTests((test,))


@construction("tests: first=tests AND second=test", "tests: first=tests any_of=OR second=test", cost=0.3)
def several_tests(first: AllTests, second: Test, any_of: Lex | None = None) -> AllTests | None:
    """Compose "it is above 20 degC and it is below 30 degC"."""
    if len(first.tests) > 1 and first.any_of != (any_of is not None):
        return None
    return AllTests((*first.tests, second), any_of=any_of is not None)


@construction(
    "tests: subject=measured [IS] first=predicate AND second=predicate",
    "tests: subject=measured [IS] first=predicate any_of=OR second=predicate",
    "tests: subject=measured [IS] none=NEITHER first=predicate NOR second=predicate",
    cost=0.2,
)
def two_tests_of_one(
    subject: Subject, first: Test, second: Test, any_of: Lex | None = None, none: Lex | None = None
) -> AllTests | None:
    """Compose "it is below 20 degC or above 30 degC" and "it is neither low nor high"."""
    if first.quantity or second.quantity:
        return None  # "the CO2 is low or the canopy hot"
    both = tuple(
        replace(
            one,
            quantity=subject.quantity,
            place=subject.place,
            setting=subject.setting,
            negated=one.negated != (none is not None),
        )
        for one in (first, second)
    )
    return AllTests(both, any_of=any_of is not None)


@construction("when: UNLESS tests=tests", cost=0.3)
def unless(tests: AllTests, used: int) -> When | None:
    """Compose "unless it is high"."""
    if len(tests.tests) > 1:
        return None
    return When(AllTests((replace(tests.tests[0], negated=not tests.tests[0].negated),)), used)


@construction("the_tree: IT", "the_tree: DET TREE", "the_tree: place=place", cost=0.0)
def the_tree(place: PlaceMeaning | None = None) -> Subject | None:
    """Compose "it", "the tree" and "tree 6", of which an attribute is tested."""
    return Subject(place=place) if place is None or _is_known(place) else None


@construction(
    "test: tree=the_tree IS [DET] value=ATTRVAL [ONE]",
    "test: IT [DET] value=ATTRVAL [ONE]",
    "test: tree=the_tree denied=ISNOT [DET] value=ATTRVAL [ONE]",
    "test: tree=the_tree IS denied=NOT [DET] value=ATTRVAL [ONE]",
    cost=0.3,
)
def tree_is(value: Lex, denied: Lex | None = None, tree: Subject = _IT) -> list[Test]:
    """Compose "it is yellow", "it is not a Carmel" and "tree 6 is yellow"."""
    negated = denied is not None
    return [Test("", "eq", text, attribute=name, negated=negated, place=tree.place) for name, text in value.value]


@construction("test: IT IS check=CMP value=amount", "test: IT check=CMP value=amount", cost=0.3)
def tree_compared(check: Lex, value: Amount) -> Test | None:
    """Compose "it is older than 8 years"."""
    if not check.value[1] or value.unit not in ("years", "kg"):
        return None
    return Test("", check.value[0], value.number, attribute=check.value[1])


@construction("when: FOREACHOF [COMMA] one=when", cost=0.1)
def for_each_of_them(one: When, used: int) -> When:
    """Compose "for each of them: if it is high"."""
    return replace(one, used=used)


@construction("when: tests=tests mark=FULLSTOP", "when: test=predicate mark=FULLSTOP", cost=0.6)
def asked_of_reading(mark: Lex, used: int, tests: AllTests | None = None, test: Test | None = None) -> When | None:
    """Compose "below 33 degC?" and "is it below 33 degC?"."""
    tests = tests if test is None else AllTests((test,))
    return When(tests, used, asks=True) if tests is not None and "question" in mark.features else None


@construction("if_: IF", "if_: IF COMMA AND IF [COMMA]", cost=0.0)
def if_word() -> str:
    """Compose "if (and only if)"."""
    return "if"


@construction(
    "when: if_ tests=tests",
    "when: if_ tests=tests INVERTED",
    "when: INVERTS tests=tests",
    "when: where=WHERE tests=tests",
    cost=0.3,
)
def when(tests: AllTests, used: int, where: Lex | None = None) -> When:
    """Compose "if it is high" and "wherever a tree is yellow"."""
    return When(tests, used, among="" if where is None else "area")


@construction(
    "question: MEASURE QUESTION test=test",
    "question: MEASURE WHETHER test=test",
    "question: MEASURE IF test=test",
    cost=0.2,
)
@construction("question: IS test=test mark=FULLSTOP", "question: IS test=test [mark=FULLSTOP] MEASURE IT", cost=0.2)
def question(test: Test, used: int, mark: Lex | None = None) -> ReadingQuestion | None:
    """Compose "check whether the temperature at tree 4 is high" and "is tree 4 hotter than 36 degC?"."""
    if mark is not None and "question" not in mark.features:
        return None
    return ReadingQuestion(AllTests((test,)), test.place, used) if test.quantity.isidentifier() else None


@construction(
    "failing: TRY",
    "failing: TRY mark=FULLSTOP",
    "failing: IF [WHODOES] CANNOT",
    "failing: IF IT CANNOT",
    "failing: IF DET CANNOT",
    "failing: IF DOES CANNOT",
    "failing: IF [DET] reading=READING CANNOT",
    "failing: IF things=things CANNOT [verb]",
    cost=0.2,
)
def failing(
    used: int, things: tuple[Thing, ...] = (), reading: Lex | None = None, mark: Lex | None = None
) -> Failing | None:
    """Compose "if that fails", "can't get to it?" and "if the leaf sample does not succeed"."""
    if mark is not None and "question" not in mark.features:
        return None
    if len(things) > 1 or (reading is not None and reading.plural):
        return None
    return Failing(used, action=things[0].action if things else "" if reading is None else LAST_THING)


@construction(
    "failing: IF [IT] CANNOTREACH place=place",
    "failing: IF [DOES] CANNOTREACH place=place",
    "failing: IF place=place CANNOT",
    cost=0.2,
)
def place_failing(place: PlaceMeaning, used: int) -> Failing | None:
    """Compose "if you can't get to tree 45"."""
    return Failing(used, place=place) if place.shape == "one" else None


@construction("failing: IF [DOES] CANNOTREACH trees=numbers", cost=0.4, given=("site",))
def number_failing(trees: tuple[str, ...], used: int, site: Site) -> Failing | None:
    """Compose "if you can't get to 45", on a site whose trees have numbers."""
    return Failing(used, place=named_trees(trees)) if len(trees) == 1 and trees[0] in site.by_id else None


@construction("failing: FAILINGTHAT", "failing: one=failing [COMMA] other=failing", cost=0.9)
def failing_that(used: int, one: Failing | None = None, other: Failing | None = None) -> Failing | None:
    """Compose "failing that", which may be another case of a condition as well."""
    plain = all(way is None or not (way.action or way.at_one) for way in (one, other))
    return Failing(used) if plain else None


@construction(
    "failing: one=failing relation ONE [TREE]",
    "failing: one=failing relation ANY [TREE]",
    "failing: one=failing THERE",
    "failing: one=failing relation GROUPANY",
    cost=0.2,
)
def failing_at_one(one: Failing, used: int) -> Failing:
    """Compose "if the leaf sample does not succeed at one of them"."""
    return replace(one, used=used, at_one=True)


@construction("when: IF test=predicate", "when: WHERE test=predicate", "when: WITH test=predicate", cost=0.8)
def when_so(test: Test, used: int) -> When:
    """Compose "if hot" and "where low"."""
    return When(AllTests((test,)), used)


@construction("when: word=IFSO", cost=0.2)
def if_so(word: Lex, used: int) -> When:
    """Compose "if so" and "if it is"."""
    return When(AllTests(()), used, affirms="affirms" in word.features)


@construction(
    "means: [DET] BATTERY", "means: [DET] MEANS", "means: [DET] TIMEWORD", "means: [DET] noun=TIMES", cost=0.0
)
def means(noun: Lex | None = None) -> str | None:
    """Compose "the battery"."""
    return "means" if noun is None or "time" in noun.features else None


@construction(
    "allow: word=FITS",
    "allow: IF means [STILL] ALLOW [IT]",
    "allow: means PERMITTING",
    "allow: IF THEREIS [STILL] [ENOUGH] means [LEFT]",
    "allow: FITS AT means",
    "allow: IF THEREIS [STILL] [SOME] means LEFT",
    "allow: IF means IS LEFT",
    "allow: IF [ENOUGH] means REMAINS",
    "allow: IF [ENOUGH] means IS [LEFT]",
    "allow: IF means IS ENOUGH [FOR] [IT]",
    "allow: FITS INSIDE means",
    cost=0.2,
)
def if_it_fits(used: int, word: Lex | None = None) -> Allowed:
    """Compose "if the battery allows it"."""
    return Allowed(used, unsaid=word is not None and "unsaid_budget" in word.features)


@construction("allow: ALSO [COMMA] one=allow", cost=-1.0)
def added_if_it_fits(one: Allowed, used: int) -> Allowed:
    """Compose "(and the bank) too, if there is time"; it costs less than a word that is left out."""
    return replace(one, used=used, adds=True)


@construction("means: first=means AND second=means", cost=0.1)
def both_means(first: str, second: str) -> str:
    """Compose "time and charge"."""
    return first or second


@construction(
    "tests: SOMEONE [IS] test=predicate",
    "tests: SOMEONE READING [IS] test=predicate",
    "tests: SOMEONE noun=NOUN [IS] test=predicate",
    "tests: SOMEONE WITH [DET] noun=NOUN test=predicate",
    cost=0.3,
)
def someone(test: Test, noun: Lex | None = None) -> list[AllTests]:
    """Compose "one is above 38 degC" and "you find a tree with a canopy temperature above 38 degC"."""
    return [AllTests((replace(test, quantity=name),)) for name in ([""] if noun is None else measured_by(noun))]


@construction(
    "among: ANY",
    "among: EACH",
    "among: WHATEVER",
    "among: EVERYTHING",
    "among: EACH ONE",
    "among: ANY OF IT",
    "among: word=DET",
    "among: EACH word=DET",
    "among: [DET] noun=ONE",
    cost=0.0,
)
def among(word: Lex | None = None, noun: Lex | None = None) -> str | None:
    """Compose "those", "any" and "the ones", of several places."""
    if noun is not None and not noun.plural and "plural" not in noun.features:
        return None
    return "those" if word is None or "those" in word.features else None


@construction(
    "among_trees: DET inner=nominal", "among_trees: ANY inner=nominal", "among_trees: EACH inner=nominal", cost=0.0
)
def among_trees(inner: Nominal) -> PlaceMeaning | None:
    """Compose "any tree of row 4" before what it is like."""
    return None if inner.single or inner.complete else PlaceMeaning(inner.selector, "several", each=True)


@construction(
    "among_trees: ANY OF whole=place", "among_trees: ANY whole=place", "among_trees: word=DET OF whole=place", cost=0.3
)
def among_those(whole: PlaceMeaning, word: Lex | None = None) -> PlaceMeaning | None:
    """Compose "any of trees 4 to 8" and "those of trees 4 to 8" before what they are like."""
    if whole.shape != "several" or whole.optional or whole.at_most or whole.per is not None:
        return None
    return replace(whole, each=True) if word is None or "those" in word.features else None


@construction(
    "tested: among [WHICH] [IS] test=predicate",
    "tested: among WHERE [IT] [IS] test=predicate",
    "tested: among WHICH noun=NOUN [IS] test=predicate",
    "tested: among WITH test=predicate",
    "tested: DET test=predicate noun=ONE",
    "tested: test=predicate noun=ONE",
    "tested: area=among_trees WHICH [IS] test=predicate",
    "tested: area=among_trees WHERE [IT] [IS] test=predicate",
    "tested: area=among_trees WHICH noun=NOUN [IS] test=predicate",
    "tested: those=tested by=measured_by",
    cost=0.2,
    given=("site",),
)
def those_tested(
    site: Site,
    test: Test | None = None,
    area: PlaceMeaning | None = None,
    noun: Lex | None = None,
    those: tuple[AllTests, PlaceMeaning | None] | None = None,
    by: str = "",
) -> list[tuple[AllTests, PlaceMeaning | None]] | None:
    """Compose "those that are hot" and "any tree of row 4 that is above 38 degC in the thermal picture"."""
    if those is not None:
        (test,), area = those[0].tests, those[1]
    if test is None or (noun is not None and noun.value is None and among(noun=noun) is None):
        return None
    named = measured_by(noun) if noun is not None and noun.value is not None else [by or test.quantity]
    known = None if area is None or area.selector == s.Trees() else area
    if area is not None and any(hinted_attributes(name.rpartition("_")[2], site) for name in named if name):
        return None  # "peppers with a moisture under 25", which the site records
    return [(AllTests((replace(test, quantity=name),)), known) for name in named]


@construction("tested: DET value=ATTRVAL noun=ONE", "tested: among WHICH [IS] value=ATTRVAL", cost=0.0)
def those_of_kind(value: Lex, noun: Lex | None = None) -> list[tuple[AllTests, PlaceMeaning | None]] | None:
    """Compose "the yellow ones" and "those that are yellow"."""
    if noun is not None and among(noun=noun) is None:
        return None
    return [(AllTests((test,)), None) for test in tree_is(value)]


@construction(
    "capture_where: if_ area=among_trees [IS] test=predicate [by=measured_by] COMMA act=capture",
    "capture_where: WHERE area=among_trees [IS] test=predicate [by=measured_by] COMMA act=capture",
    "capture_where: those=tested COMMA act=capture",
    cost=0.3,
)
def whenever_one_is(
    act: CaptureCommand,
    used: int,
    area: PlaceMeaning | None = None,
    test: Test | None = None,
    by: str = "",
    those: tuple[AllTests, PlaceMeaning | None] | None = None,
) -> CaptureWhere | None:
    """Compose "whenever a tree of row 4 is above 38 degC in the thermal picture, measure its CO2"."""
    if act.place is not None and act.place.shape != "here" and not act.place.beside:
        return None
    there = act if act.place is not None and act.place.beside else replace(act, place=None)
    if those is not None:
        return CaptureWhere(those[0], there, used, those[1]) if act.relation != "bare" else None
    if test is None or area is None or area.selector == s.Trees():
        return None
    return CaptureWhere(AllTests((replace(test, quantity=by or test.quantity),)), there, used, area)


@construction(
    "measured_by: AT [DET] noun=NOUN", "measured_by: INSIDE [DET] noun=NOUN", "measured_by: OF noun=NOUN", cost=0.1
)
def measured_by(noun: Lex) -> list[str]:
    """Compose "in the thermal picture": the quantity, or the action that measures it."""
    naming: Naming = noun.value
    return list(dict.fromkeys(naming.quantities)) or list(naming.actions[:1])


@construction(
    "capture_where: tests=tested SHOULD things=things [INSTEAD]",
    "capture_where: tests=tested TAKE things=things",
    "capture_where: tests=tested COMMA things=things [INSTEAD]",
    cost=0.4,
)
@construction(
    "capture_where: verb things=things relation tests=tested",
    "capture_where: verb things=things FOR tests=tested",
    "capture_where: [WITH] things=things relation tests=tested",
    "capture_where: relation tests=tested [COMMA] verb things=things",
    "capture_where: FOR tests=tested [COMMA] verb things=things",
    "capture_where: relation tests=tested [COMMA] things=things",
    cost=0.3,
)
def capture_where(things: tuple[Thing, ...], tests: tuple[AllTests, PlaceMeaning | None], used: int) -> CaptureWhere:
    """Compose "measure CO2 at those that are hot" and "any that are hot get a CO2 reading"."""
    return CaptureWhere(tests[0], CaptureCommand(things, None, used), used, tests[1])


@construction("capture_where: verb=ACTV tests=tested", cost=0.3)
def act_where(verb: Lex, tests: tuple[AllTests, PlaceMeaning | None], used: int) -> CaptureWhere:
    """Compose "photograph those that are hot"."""
    naming: Naming = verb.value
    return CaptureWhere(tests[0], CaptureCommand((Thing(naming.actions[0]),), None, used), used, tests[1])


@construction("halts: [WHODOES] STOP [THERE]", "halts: MISSION [SHOULD] STOP", "halts: MISSION IS STOP", cost=0.0)
def halts() -> str:
    """Compose "the mission should stop"."""
    return "stop"


@construction("first: [DET] FIRSTONE", "first: [DET] ORD", cost=0.0)
def first() -> str:
    """Compose "the first"."""
    return "first"


@construction(
    "first_tested: first [WHICH] [IS] test=predicate",
    "first_tested: first ONE [WHICH] [IS] test=predicate",
    "first_tested: first READING [WHICH] [IS] test=predicate",
    "first_tested: first ONE INORDERTO test=predicate",
    cost=0.0,
)
def first_tested(test: Test) -> AllTests:
    """Compose "the first one over 39 degC"."""
    return AllTests((test,))


@construction("soon: ASSOONAS", "soon: WHERE", cost=0.0)
def soon() -> str:
    """Compose "as soon as" and "when"."""
    return "when"


@construction(
    "until: UNTIL tests=tests",
    "until: HALTWHEN tests=tests",
    "until: soon tests=tests [COMMA] halts",
    "until: halts soon tests=tests",
    "until: halts AT tests=first_tested",
    "until: halts THEN tests=readings_found",
    "until: halts AT tests=readings_found",
    "until: halts WITH tests=readings_found",
    "until: UNTIL tests=readings_found",
    "until: tests=first_tested [COMMA] halts [MISSION]",
    cost=0.3,
)
def until(used: int, tests: AllTests) -> UntilCondition:
    """Compose "until it is high" and "stop at the first one over 39"."""
    return UntilCondition(tests, used)


@construction("until: if_ tests=tests [COMMA] halts", cost=0.3)
def until_any(used: int, tests: AllTests) -> UntilCondition | None:
    """Compose "if any of them is above 500 ppm, stop there"."""
    return UntilCondition(tests, used) if tests.of_last == "any" else None


@construction("until: [KEEPON] STAYING tests=tests", cost=0.3)
def while_it_holds(tests: AllTests, used: int) -> UntilCondition | None:
    """Compose "keep going while it stays below 420 ppm"."""
    if len(tests.tests) > 1 or tests.of_last:
        return None
    return UntilCondition(AllTests((replace(tests.tests[0], negated=not tests.tests[0].negated),)), used)


@construction("when: those=tested [SHOULD]", "when: relation those=tested", "when: FOR those=tested", cost=0.5)
def those_that_are(those: tuple[AllTests, PlaceMeaning | None], used: int) -> When | None:
    """Compose "those hotter than 35 degC should get"."""
    reading = not any(test.attribute for test in those[0].tests)
    return When(those[0], used, among="visited") if those[1] is None and reading else None


@construction(
    "otherwise: word=OTHERWISE [MEANING]",
    "otherwise: OTHERS [SHOULD]",
    "otherwise: FOR OTHERS",
    "otherwise: AT OTHERS",
    cost=0.2,
)
def otherwise(used: int, word: Lex | None = None) -> Otherwise:
    """Compose "otherwise"."""
    return Otherwise(used, in_all=word is None or "in_all_cases" in word.features)


@construction(
    "pass_on: PASSON",
    "pass_on: PASSTO [DET] on=NEXTONE",
    "pass_on: PASSTO [DET] on=NEXTONE ONE",
    "pass_on: PASSTO [DET] on=NEXTONE TREE",
    cost=0.3,
)
def pass_on(used: int, on: Lex | None = None) -> PassOn:
    """Compose "leave it" and "carry on with the next one"."""
    return PassOn(used, to_next=on is not None)


@construction(
    "group: every=GROUPALL",
    "group: GROUPANY",
    "group: none=GROUPNONE",
    "group: [ATLEAST] n=count OFTHEM",
    "group: n=count bound=BOUND [OFTHEM]",
    "group: bound=CMP n=count [OFTHEM]",
    cost=0.0,
)
def group(every: Lex | None = None, none: Lex | None = None, n: int = 0, bound: Lex | None = None) -> OfLast | None:
    """Compose "both", "any of them", "at least two of them" and "more than one"."""
    if bound is not None:
        if bound.value == ("gt", ""):
            return HowMany("gt", float(n))
        return n if bound.value == ("ge", "") and n <= _MOST_OF_SEVERAL else None
    return n or ("all" if every is not None else "none" if none is not None else "any")


@construction(
    "tests: [IT] of=group [IS] test=predicate",
    "tests: IT IS of=group test=predicate",
    "tests: of=group noun=NOUN [READING] [IS] test=predicate",
    "tests: AT of=group [COMMA] test=test",
    "tests: test=test AT of=group",
    "tests: test=predicate IS behind=group",
    cost=0.2,
)
def of_several(test: Test, of: OfLast = "", noun: Lex | None = None, behind: OfLast | None = None) -> AllTests | None:
    """Compose "both are low", "at one of them it is low", "neither is low" and "at least two of them are low"."""
    if isinstance(behind, HowMany):
        return None  # "(at least two) are above 35"
    of = of if behind is None else behind
    quantities = {test.quantity} if noun is None else set(noun.value.quantities)
    if len(quantities) != 1 or test.place is not None:
        return None
    return AllTests((replace(test, quantity=quantities.pop()),), of_last=of)


@construction("otherwise: IF GROUPNONE IS", "otherwise: IF GROUPNONE", cost=0.3)
def if_none_is(used: int) -> Otherwise:
    """Compose "if neither is"."""
    return Otherwise(used)


@construction(
    "such_reading: [DET] level=LEVEL READING",
    "such_reading: [DET] level=LEVEL noun=NOUN",
    "such_reading: [DET] level=LEVEL noun=NOUN READING",
    "such_reading: [DET] READING [IS] test=predicate",
    "such_reading: [DET] noun=NOUN [READING] [IS] test=predicate",
    "such_reading: EVERYTHING test=predicate",
    cost=0.1,
)
def such_reading(level: Lex | None = None, noun: Lex | None = None, test: Test | None = None) -> list[Test]:
    """Compose "a low reading", "a low CO2 level" and "a reading above 38 degC"."""
    tests = [one for one in (test, None if level is None else at_level(level)) if one is not None]
    return [replace(one, quantity=name) for one in tests for name in ([""] if noun is None else measured_by(noun))]


@construction(
    "when: AT test=such_reading",
    "when: INCASE test=such_reading",
    "when: WITH test=such_reading",
    "when: test=such_reading MEANING",
    "when: test=such_reading THERE MEANING",
    "when: test=test MEANING",
    "when: test=test THERE MEANING",
    "when: test=predicate MEANING",
    cost=0.3,
)
def such_a_reading_means(test: Test, used: int) -> When:
    """Compose "on a low reading" and "a reading under 400 ppm means"."""
    return When(AllTests((test,)), used)
