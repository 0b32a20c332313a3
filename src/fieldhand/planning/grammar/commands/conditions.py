"""Constructions of tests, conditions and questions, and of work that depends on the budget or on a failure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    NTH_READING,
    SAME_THRESHOLD,
    Allowed,
    AllTests,
    Amount,
    CaptureCommand,
    CaptureWhere,
    Check,
    Failing,
    Nominal,
    OfLast,
    Otherwise,
    PassOn,
    PlaceMeaning,
    ReadingQuestion,
    Test,
    Thing,
    UntilCondition,
    When,
)
from fieldhand.planning.grammar.places.numbers import named_trees
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_in_row, as_some, is_one_row
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Comparisons that are true where another one is not.
_OPPOSITE: Mapping[Check, Check] = {"lt": "ge", "ge": "lt", "gt": "le", "le": "gt"}
#: Units of the readings of which some levels are said, by the feature of the words.
_SAID_OF = {"of_heat": "degC", "of_water": "percent"}


@construction("subject: IT", "subject: ITS", "subject: [DET] READING", cost=0.0)
def anything() -> str:
    """Compose "it"."""
    return ""


@construction("subject: word=DET", cost=0.3)
def that(word: Lex) -> str | None:
    """Compose "that" alone."""
    return "" if "demonstrative" in word.features else None


@construction("subject: DET rank=ORD READING", "subject: DET rank=ORD ONE", "subject: DET rank=ORD", cost=0.0)
def nth_reading(rank: Lex) -> str:
    """Compose "the first reading"."""
    return f"{NTH_READING}{rank.value}"


@construction("subject: DET LAST READING", "subject: DET LAST ONE", cost=0.0)
def last_reading() -> str:
    """Compose "the last reading"."""
    return f"{NTH_READING}-1"


@construction("subject: [DET] noun=NOUN relation word=DET tree=TREE", cost=0.1)
def quantity_of_tree(noun: Lex, word: Lex, tree: Lex) -> list[str] | None:
    """Compose "the canopy temperature at a tree", of each of those at which it is measured."""
    return None if tree.plural or "definite" in word.features else named_quantity(noun)


@construction(
    "asked: [DET] noun=NOUN [READING] relation place=place", "asked: [DET] noun=MEDIUM relation place=place", cost=0.0
)
def quantity_at(noun: Lex, place: PlaceMeaning) -> tuple[str, PlaceMeaning] | None:
    """Compose "the temperature at tree 4" and "the air at tree 4"."""
    naming: Naming = noun.value
    if len(set(naming.quantities)) != 1 or not _is_known(place):
        return None  # "the temperature at any tree": at which?
    return (naming.quantities[0], place)


def _is_known(place: PlaceMeaning) -> bool:
    """Return True for one place that the phrase names by itself: not "the second one", not any tree of several."""
    counted = as_in_row(place.selector)
    if place.shape != "one" or place.like is not None or as_some(place.selector) is not None:
        return False
    return counted is None or is_one_row(counted.of)


@construction(
    "measured: asked=asked [IS] test=predicate",
    "measured: asked=asked denied=ISNOT test=predicate",
    cost=0.2,
)
def measured(asked: tuple[str, PlaceMeaning], test: Test, denied: Lex | None = None) -> tuple[PlaceMeaning, Test]:
    """Compose "the temperature at tree 4 is above 30 degC"."""
    return (asked[1], replace(test, quantity=asked[0], negated=test.negated != (denied is not None)))


@construction(
    "measured: [DET] noun=NOUN [READING] [IS] test=predicate relation place=place",
    "measured: [DET] noun=MEDIUM [IS] test=predicate relation place=place",
    cost=0.3,
)
def measured_at(noun: Lex, test: Test, place: PlaceMeaning) -> tuple[PlaceMeaning, Test] | None:
    """Compose "the temperature is above 30 degC at tree 4"."""
    asked = quantity_at(noun, place)
    return None if asked is None else measured(asked, test)


@construction("when: IF one=measured", "when: WHERE one=measured", "when: word=UNLESS one=measured", cost=0.3)
def when_measured(one: tuple[PlaceMeaning, Test], used: int, word: Lex | None = None) -> When:
    """Compose "if the temperature at tree 4 is above 30 degC"."""
    test = one[1] if word is None else replace(one[1], negated=not one[1].negated)
    return When(AllTests((test,)), used, measured_at=one[0])


@construction("terse: test=predicate", "terse: test=test", cost=0.6)
def terse(test: Test, used: int) -> When:
    """Compose "above 30 degC", behind which stands what is done then."""
    return When(AllTests((test,)), used, terse=True)


@construction(
    "measured: place=place [IS] test=predicate",
    "measured: IT [IS] test=predicate AT place=place",
    cost=0.6,
    given=("robot",),
)
def tree_measured(place: PlaceMeaning, test: Test, robot: RobotProfile) -> list[tuple[PlaceMeaning, Test]] | None:
    """Compose "tree 14 is hotter than 36 degC": which readings are in that unit?"""
    if not _is_known(place) or test.value == SAME_THRESHOLD:
        return None
    measured_by_it = [name for action in robot.actions for name in action.measures]
    found = [name for name in measured_by_it if test.unit in ("", robot.quantity[name].unit)]
    return [(place, replace(test, quantity=name)) for name in found]


@construction(
    "measured: place=place [IS] test=predicate",
    "measured: IT [IS] test=predicate AT place=place",
    "measured: number=NUM IS test=predicate",
    cost=0.0,
    given=("site",),
)
def measured_before(
    test: Test, site: Site, place: PlaceMeaning | None = None, number: Lex | None = None
) -> tuple[PlaceMeaning, Test] | None:
    """Compose "tree 31 came out high" and "31 came out high", of a reading that was taken there."""
    if number is not None:
        place = named_trees((number.text,)) if number.text.isdecimal() and number.text in site.by_id else None
    known = place is not None and _is_known(place) and test.value != SAME_THRESHOLD
    return (place, test) if known and place is not None else None


@construction("question: IS one=measured [FULLSTOP]", cost=0.2)
def is_it_there(one: tuple[PlaceMeaning, Test], used: int) -> ReadingQuestion:
    """Compose "is tree 4 hotter than 36 degC?"."""
    return ReadingQuestion(AllTests((one[1],)), one[0], used)


@construction("question: one=question MEASURE IT", "question: one=question FULLSTOP MEASURE IT", cost=0.1)
def question_measured(one: ReadingQuestion, used: int) -> ReadingQuestion:
    """Compose "is the air above 35 degC at tree 4? Measure it."."""
    return replace(one, used=used)


@construction(
    "subject: [DET] noun=NOUN",
    "subject: [DET] noun=NOUN READING",
    "subject: [DET] noun=NOUN THERE",
    "subject: ITS AVERAGEWORD noun=NOUN",
    "subject: [DET] noun=MEDIUM",
    cost=0.0,
)
def named_quantity(noun: Lex) -> list[str] | None:
    """Compose "the temperature", "its average temperature" and "the air"."""
    naming: Naming = noun.value
    return list(naming.quantities or naming.actions[:1]) or None


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


@construction("predicate: [AT] value=threshold bound=BOUND", cost=0.1)
def bounded(value: tuple[float, str], bound: Lex) -> Test | None:
    """Compose "30 degC or more"."""
    return None if bound.value[1] else Test("", bound.value[0], value[0], value[1])


@construction("predicate: STILL test=predicate", "predicate: AGAIN test=predicate", cost=0.1)
def still(test: Test) -> Test:
    """Compose "still above 30 degC" and "again above 30 degC"."""
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
    "test: [subject=subject] IS test=predicate",
    "test: subject=subject test=predicate",
    "test: IS subject=subject test=predicate",
    "test: [subject=subject] denied=ISNOT test=predicate",
    cost=0.2,
)
def reading_is(test: Test, subject: str = "", denied: Lex | None = None) -> Test:
    """Compose "it is above 30 degC", "it is not above 30 degC" and "is it above 30 degC"."""
    return replace(test, quantity=subject, negated=test.negated != (denied is not None))


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
    "tests: subject=subject IS first=predicate AND second=predicate",
    "tests: subject=subject IS first=predicate any_of=OR second=predicate",
    cost=0.2,
)
def two_tests_of_one(subject: str, first: Test, second: Test, any_of: Lex | None = None) -> AllTests:
    """Compose "it is below 20 degC or above 30 degC"."""
    both = (replace(first, quantity=subject), replace(second, quantity=subject))
    return AllTests(both, any_of=any_of is not None)


@construction("when: UNLESS tests=tests", cost=0.3)
def unless(tests: AllTests, used: int) -> When | None:
    """Compose "unless it is high"."""
    if len(tests.tests) > 1:
        return None
    return When(AllTests((replace(tests.tests[0], negated=not tests.tests[0].negated),)), used)


@construction(
    "test: IT [IS] [DET] value=ATTRVAL [ONE]",
    "test: DET TREE IS [DET] value=ATTRVAL [ONE]",
    "test: IT denied=ISNOT [DET] value=ATTRVAL [ONE]",
    "test: IT IS denied=NOT [DET] value=ATTRVAL [ONE]",
    "test: DET TREE denied=ISNOT [DET] value=ATTRVAL [ONE]",
    "test: DET TREE IS denied=NOT [DET] value=ATTRVAL [ONE]",
    cost=0.3,
)
def tree_is(value: Lex, denied: Lex | None = None) -> list[Test]:
    """Compose "it is yellow" and "it is not a Carmel"."""
    return [Test("", "eq", text, attribute=name, negated=denied is not None) for name, text in value.value]


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


@construction("when: one=bare_level FULLSTOP", cost=0.3)
def level_question(one: AllTests, used: int) -> When:
    """Compose "low?"."""
    return When(one, used)


@construction("when: test=test mark=FULLSTOP", "when: test=predicate mark=FULLSTOP", cost=0.6)
def test_as_question(test: Test, mark: Lex, used: int) -> When | None:
    """Compose "below 33 degC?" and "is it below 33 degC?"."""
    return When(AllTests((test,)), used) if "question" in mark.features else None


@construction(
    "when: IF tests=tests",
    "when: IF tests=tests INVERTED",
    "when: INVERTS tests=tests",
    "when: where=WHERE tests=tests",
    cost=0.3,
)
def when(tests: AllTests, used: int, where: Lex | None = None) -> When:
    """Compose "if it is high" and "wherever a tree is yellow"."""
    return When(tests, used, among="" if where is None else "area")


@construction(
    "question: MEASURE QUESTION tests=tests",
    "question: MEASURE WHETHER tests=tests",
    "question: MEASURE IF tests=tests",
    cost=0.2,
)
def question(tests: AllTests, used: int) -> ReadingQuestion | None:
    """Compose "check whether the temperature is high"."""
    return ReadingQuestion(tests, None, used) if len(tests.tests) == 1 and tests.tests[0].quantity else None


@construction(
    "question: MEASURE QUESTION one=measured",
    "question: MEASURE WHETHER one=measured",
    "question: MEASURE IF one=measured",
    cost=0.2,
)
def question_at(one: tuple[PlaceMeaning, Test], used: int) -> ReadingQuestion:
    """Compose "check whether the temperature at tree 4 is high"."""
    return ReadingQuestion(AllTests((one[1],)), one[0], used)


@construction(
    "failing: TRY",
    "failing: IF [WHODOES] CANNOT",
    "failing: IF IT CANNOT",
    "failing: IF DOES CANNOT",
    "failing: IF [DET] reading=READING CANNOT",
    "failing: IF things=things CANNOT [verb]",
    cost=0.2,
)
def failing(used: int, things: tuple[Thing, ...] = (), reading: Lex | None = None) -> Failing | None:
    """Compose "if that fails", "if you can't get to it" and "if the leaf sample does not succeed"."""
    if len(things) > 1 or (reading is not None and reading.plural):
        return None
    return Failing(used, action=things[0].action if things else "" if reading is None else LAST_THING)


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


@construction("when: IF test=predicate", "when: WHERE test=predicate", cost=0.8)
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


@construction("means: first=means AND second=means", cost=0.1)
def both_means(first: str, second: str) -> str:
    """Compose "time and charge"."""
    return first or second


@construction(
    "tests: SOMEONE [IS] test=predicate",
    "tests: SOMEONE READING [IS] test=predicate",
    "tests: SOMEONE WITH [DET] noun=NOUN test=predicate",
    cost=0.3,
)
def someone(test: Test, noun: Lex | None = None) -> list[AllTests]:
    """Compose "one is above 38 degC" and "you find a tree with a canopy temperature above 38 degC"."""
    return [AllTests((replace(test, quantity=name),)) for name in ([""] if noun is None else measured_by(noun))]


@construction("when: IF place=place [IS] value=ATTRVAL", "when: IF place=place IS DET value=ATTRVAL", cost=0.3)
def when_tree_is(place: PlaceMeaning, value: Lex, used: int) -> list[When] | None:
    """Compose "if tree 6 is yellow"."""
    if place.shape != "one" or as_some(place.selector) is not None:
        return None  # "if a tree is yellow": of those visited
    return [When(AllTests((test,)), used, measured_at=place) for test in tree_is(value)]


@construction("predicate: LEVEL [COMMA] MEANING test=predicate", cost=0.1)
def level_explained(test: Test) -> Test:
    """Compose "too hot, meaning over 40 degC"."""
    return test


@construction(
    "tested: word=DET WHICH [IS] test=predicate",
    "tested: word=DET WHERE [IT] [IS] test=predicate",
    "tested: ANY [WHICH] IS test=predicate",
    "tested: ANY WHICH test=predicate",
    "tested: WHATEVER IS test=predicate",
    "tested: EACH ONE [WHICH] [IS] test=predicate",
    "tested: ANY [OF] IT WHICH [IS] test=predicate",
    "tested: EACH WHICH [IS] test=predicate",
    "tested: DET inner=nominal WHICH [IS] test=predicate",
    "tested: [DET] inner=nominal WHERE [IT] [IS] test=predicate",
    "tested: ANY inner=nominal WHICH [IS] test=predicate",
    "tested: ANY inner=nominal WHERE [IT] [IS] test=predicate",
    "tested: EACH inner=nominal WHICH [IS] test=predicate",
    "tested: EACH inner=nominal WHERE [IT] [IS] test=predicate",
    "tested: DET test=predicate ONE",
    "tested: test=predicate noun=ONE",
    "tested: word=DET [IS] test=predicate",
    "tested: [DET] noun=ONE [WHICH] [IS] test=predicate",
    "tested: ANY test=predicate",
    "tested: EACH word=DET test=predicate",
    "tested: EACH word=DET WHICH [IS] test=predicate",
    "tested: EVERYTHING [WHICH] [IS] test=predicate",
    cost=0.2,
)
def those_tested(
    test: Test, inner: Nominal | None = None, word: Lex | None = None, noun: Lex | None = None
) -> tuple[AllTests, PlaceMeaning | None] | None:
    """Compose "those that are hot" and "any tree of row 4 that is hot"."""
    if noun is not None and not noun.plural and "plural" not in noun.features:
        return None
    if word is not None and "those" not in word.features:
        return None
    if inner is not None and (inner.single or inner.complete):
        return None
    area = None if inner is None or inner.selector == s.Trees() else inner.selector
    return AllTests((test,)), None if area is None else PlaceMeaning(area, "several", each=True)


@construction(
    "tested: DET value=ATTRVAL noun=ONE",
    "tested: [DET] noun=ONE WHICH [IS] value=ATTRVAL",
    "tested: word=DET WHICH [IS] value=ATTRVAL",
    "tested: ANY WHICH [IS] value=ATTRVAL",
    cost=0.0,
)
def those_of_kind(
    value: Lex, noun: Lex | None = None, word: Lex | None = None
) -> list[tuple[AllTests, PlaceMeaning | None]] | None:
    """Compose "the yellow ones" and "those that are yellow"."""
    if noun is not None and not noun.plural and "plural" not in noun.features:
        return None
    if word is not None and "those" not in word.features:
        return None
    return [(AllTests((test,)), None) for test in tree_is(value)]


@construction(
    "tested: ANY WHICH noun=NOUN [IS] test=predicate", "tested: word=DET WHICH noun=NOUN [IS] test=predicate", cost=0.2
)
def whose_reading_is(test: Test, noun: Lex, word: Lex | None = None) -> list[tuple[AllTests, None]] | None:
    """Compose "any whose canopy turns out high"."""
    if word is not None and "those" not in word.features:
        return None
    return [(AllTests((replace(test, quantity=name),)), None) for name in measured_by(noun)]


@construction("tested: [DET] test=predicate noun=ONE in_ place=place", cost=0.3)
def tested_among(test: Test, noun: Lex, place: PlaceMeaning) -> tuple[AllTests, PlaceMeaning] | None:
    """Compose "hot ones among trees 57 to 74"."""
    if "plural" not in noun.features or place.shape not in ("several", "area") or place.optional:
        return None
    return (AllTests((test,)), replace(place, shape="several", each=True))


@construction("tested: [DET] test=predicate noun=ONE in_ trees=numbers", cost=0.4, given=("site",))
def tested_among_numbers(
    test: Test, noun: Lex, trees: tuple[str, ...], site: Site
) -> tuple[AllTests, PlaceMeaning] | None:
    """Compose "hot ones among 57 to 74", on a site whose trees have numbers."""
    known = len(trees) > 1 and all(name in site.by_id for name in trees)
    return tested_among(test, noun, named_trees(trees)) if known else None


@construction("tested: those=tested by=measured_by", cost=0.2)
def tested_by(those: tuple[AllTests, PlaceMeaning | None], by: str) -> tuple[AllTests, PlaceMeaning | None]:
    """Compose "any tree that is above 38 degC in the thermal picture"."""
    (test,) = those[0].tests
    return (AllTests((replace(test, quantity=by),)), those[1])


@construction(
    "capture_where: WHERE DET inner=nominal [IS] test=predicate [by=measured_by] COMMA act=capture",
    "capture_where: IF DET inner=nominal [IS] test=predicate [by=measured_by] COMMA act=capture",
    "capture_where: IF ANY inner=nominal [IS] test=predicate [by=measured_by] COMMA act=capture",
    cost=0.3,
)
def whenever_one_is(inner: Nominal, test: Test, act: CaptureCommand, used: int, by: str = "") -> CaptureWhere | None:
    """Compose "whenever a tree of row 4 is above 38 degC in the thermal picture, measure its CO2"."""
    if inner.single or inner.complete or inner.plural or inner.selector == s.Trees():
        return None
    if act.place is not None and act.place.shape != "here" and not act.place.beside:
        return None
    area = PlaceMeaning(inner.selector, "several", each=True)
    there = act if act.place is not None and act.place.beside else replace(act, place=None)
    return CaptureWhere(AllTests((replace(test, quantity=by or test.quantity),)), there, used, area)


@construction(
    "measured_by: AT [DET] noun=NOUN", "measured_by: INSIDE [DET] noun=NOUN", "measured_by: OF noun=NOUN", cost=0.1
)
def measured_by(noun: Lex) -> list[str]:
    """Compose "in the thermal picture": the quantity, or the action that measures it."""
    naming: Naming = noun.value
    return list(dict.fromkeys(naming.quantities)) or list(naming.actions[:1])


@construction("measured: place=place [IS] test=predicate by=measured_by", cost=0.2)
def measured_there(place: PlaceMeaning, test: Test, by: str) -> tuple[PlaceMeaning, Test] | None:
    """Compose "tree 14 has more than 450 ppm of CO2"."""
    if place.shape != "one" or as_some(place.selector) is not None:
        return None
    return (place, replace(test, quantity=by))


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
    """Compose "measure CO2 at those that are hot"."""
    return CaptureWhere(tests[0], CaptureCommand(things, None, used), used, tests[1])


@construction("capture_where: verb=ACTV tests=tested", cost=0.3)
def act_where(verb: Lex, tests: tuple[AllTests, PlaceMeaning | None], used: int) -> CaptureWhere:
    """Compose "photograph those that are hot"."""
    naming: Naming = verb.value
    return CaptureWhere(tests[0], CaptureCommand((Thing(naming.actions[0]),), None, used), used, tests[1])


@construction(
    "capture_where: tests=tested SHOULD things=things",
    "capture_where: tests=tested TAKE things=things",
    "capture_where: tests=tested COMMA things=things",
    "capture_where: tests=tested SHOULD things=things INSTEAD",
    "capture_where: tests=tested COMMA things=things INSTEAD",
    cost=0.4,
)
def those_get(things: tuple[Thing, ...], tests: tuple[AllTests, PlaceMeaning | None], used: int) -> CaptureWhere:
    """Compose "any that are hot get a CO2 reading"."""
    return capture_where(things, tests, used)


@construction(
    "until: UNTIL tests=tests",
    "until: ASSOONAS tests=tests [COMMA] [WHODOES] STOP",
    "until: WHERE tests=tests [COMMA] [WHODOES] STOP",
    "until: HALTWHEN tests=tests",
    "until: [MISSION] [SHOULD] STOP ASSOONAS tests=tests",
    "until: [MISSION] [SHOULD] STOP WHERE tests=tests",
    "until: [MISSION] [IS] STOP AT [DET] FIRSTONE ONE [WHICH] [IS] test=predicate",
    "until: [MISSION] [IS] STOP AT [DET] FIRSTONE READING [WHICH] [IS] test=predicate",
    "until: STOP AT [DET] ORD [ONE] [WHICH] [IS] test=predicate",
    "until: STOP AT [DET] FIRSTONE [WHICH] [IS] test=predicate",
    "until: DET FIRSTONE READING [WHICH] [IS] test=predicate STOP [MISSION]",
    "until: DET FIRSTONE ONE [WHICH] [IS] test=predicate STOP [MISSION]",
    "until: DET ORD READING [WHICH] [IS] test=predicate STOP [MISSION]",
    cost=0.3,
)
def until(used: int, tests: AllTests | None = None, test: Test | None = None) -> UntilCondition | None:
    """Compose "until it is high" and "stop at the first one over 39"."""
    if test is not None:
        tests = AllTests((test,))
    return None if tests is None else UntilCondition(tests, used)


@construction("until: [KEEPON] STAYING tests=tests", cost=0.3)
def while_it_holds(tests: AllTests, used: int) -> UntilCondition | None:
    """Compose "keep going while it stays below 420 ppm"."""
    if len(tests.tests) > 1 or tests.of_last:
        return None
    return UntilCondition(AllTests((replace(tests.tests[0], negated=not tests.tests[0].negated),)), used)


@construction(
    "when: word=DET [WHICH] [IS] test=predicate [SHOULD]",
    "when: [DET] noun=TREE [WHICH] [IS] test=predicate [SHOULD]",
    "when: [DET] noun=ONE [WHICH] [IS] test=predicate [SHOULD]",
    cost=0.6,
)
def those_that_are(test: Test, used: int, word: Lex | None = None, noun: Lex | None = None) -> When | None:
    """Compose "those hotter than 35 degC should get"."""
    if word is not None and noun is None and "those" not in word.features:
        return None
    if noun is not None and not (noun.plural or "plural" in noun.features):
        return None
    return When(AllTests((test,)), used, among="visited")


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


@construction("pass_on: PASSON", cost=0.3)
def pass_on(used: int) -> PassOn:
    """Compose "leave it"."""
    return PassOn(used)


@construction(
    "pass_on: PASSTO [DET] NEXTONE",
    "pass_on: PASSTO [DET] NEXTONE ONE",
    "pass_on: PASSTO [DET] NEXTONE TREE",
    cost=0.3,
)
def pass_to_next(used: int) -> PassOn:
    """Compose "carry on with the next one"."""
    return PassOn(used, to_next=True)


@construction(
    "tests: every=GROUPALL [IS] test=predicate",
    "tests: every=GROUPALL noun=NOUN [READING] [IS] test=predicate",
    "tests: GROUPANY [IS] test=predicate",
    "tests: GROUPANY noun=NOUN [READING] [IS] test=predicate",
    "tests: AT GROUPANY [COMMA] test=test",
    "tests: test=test AT GROUPANY",
    "tests: none=GROUPNONE [IS] test=predicate",
    "tests: [ATLEAST] n=count OFTHEM [IS] test=predicate",
    cost=0.2,
)
def of_several(
    test: Test, every: Lex | None = None, none: Lex | None = None, noun: Lex | None = None, n: int = 0
) -> AllTests | None:
    """Compose "both are low", "at one of them it is low", "neither is low" and "at least two of them are low"."""
    of_last: OfLast = n or ("all" if every is not None else "none" if none is not None else "any")
    quantities = {test.quantity} if noun is None else set(noun.value.quantities)
    if len(quantities) != 1:
        return None
    return AllTests((replace(test, quantity=quantities.pop()),), of_last=of_last)


@construction("otherwise: IF GROUPNONE IS", "otherwise: IF GROUPNONE", cost=0.3)
def if_none_is(used: int) -> Otherwise:
    """Compose "if neither is"."""
    return Otherwise(used)


@construction("bare_level: level=LEVEL", cost=1.0)
def bare_level(level: Lex) -> AllTests:
    """Compose "low" of "low?"."""
    return AllTests((at_level(level),))


@construction(
    "such_reading: [DET] level=LEVEL READING",
    "such_reading: [DET] level=LEVEL noun=NOUN",
    "such_reading: [DET] level=LEVEL noun=NOUN READING",
    cost=0.1,
)
def such_reading(level: Lex, noun: Lex | None = None) -> list[Test]:
    """Compose "a low reading" and "a low CO2 level"."""
    return [replace(at_level(level), quantity=name) for name in ([""] if noun is None else measured_by(noun))]


@construction(
    "when: AT test=such_reading",
    "when: INCASE test=such_reading",
    "when: WITH test=such_reading",
    "when: test=such_reading MEANING",
    "when: test=such_reading THERE MEANING",
    "when: test=test MEANING",
    "when: test=test THERE MEANING",
    cost=0.3,
)
def such_a_reading_means(test: Test, used: int) -> When:
    """Compose "on a low reading" and "a reading under 400 ppm means"."""
    return When(AllTests((test,)), used)
