"""Constructions of tests of several readings together: statistics, counts and shares, precision, comparisons."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal, cast

from fieldhand.places.series_statistics import Statistic
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    DIFFERENCE,
    NTH_READING,
    SAME_THRESHOLD,
    AllTests,
    Amount,
    HowMany,
    PlaceMeaning,
    Subject,
    Test,
)
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Checks of a number of readings.
_COUNTS = ("lt", "le", "gt", "ge")
#: The last reading, and the one before it.
_LAST, _BEFORE = f"{NTH_READING}-1", f"{NTH_READING}-2"
#: Shapes of the places of several readings.
_PLACES = ("several", "area")


@construction(
    "statistic: [DET] of=STATISTIC",
    "statistic: [DET] of=STATISTIC READING",
    "statistic: [DET] of=STATISTIC noun=NOUN",
    "statistic: [DET] of=STATISTIC noun=NOUN READING",
    "statistic: [DET] of=STATISTIC OF [DET] noun=NOUN",
    "statistic: [DET] of=STATISTIC OF [DET] noun=NOUN READING",
    "statistic: [DET] noun=NOUN of=STATISTIC",
    "statistic: THEIR of=STATISTIC",
    "statistic: THEIR of=STATISTIC READING",
    "statistic: THEIR of=STATISTIC noun=NOUN",
    cost=0.1,
)
def statistic(of: Lex, noun: Lex | None = None) -> list[Subject] | None:
    """Compose "the average", "the median CO2", "the mean of the CO2 readings" and "the temperature range"."""
    name = cast(Statistic, of.value)
    if noun is None:
        return [Subject(of=name)]
    naming: Naming = noun.value
    return [Subject(one, of=name) for one in dict.fromkeys(naming.quantities) or naming.actions[:1]] or None


@construction(
    "statistic: DET of=MOSTREAD ONE", "statistic: DET of=MOSTREAD", "statistic: DET of=MOSTREAD TREE", cost=0.2
)
def extreme_of(of: Lex) -> Subject:
    """Compose "the hottest one", whose reading is the highest."""
    return Subject(of="minimum" if of.value[0] else "maximum")


@construction("statistic: one=statistic OFTHEALL", "statistic: one=statistic OFTHEM", cost=0.0)
def of_all(one: Subject) -> Subject:
    """Compose "the average of all of them"."""
    return one


@construction("statistic: one=statistic relation place=place", "statistic: place=owned_by one=statistic", cost=0.1)
def statistic_at(one: Subject, place: PlaceMeaning) -> Subject | None:
    """Compose "the average in row 3" and "row 3's average"."""
    known = place.shape in (*_PLACES, "one") and not place.refers_back and not place.optional and place.at_most is None
    return replace(one, place=place) if known and one.place is None else None


@construction("measured: one=statistic", cost=0.1)
def of_several(one: Subject) -> Subject:
    """Compose "the average" as what is tested."""
    return one


@construction(
    "test: ONAVERAGE [COMMA] test=test", "test: test=test ONAVERAGE", "predicate: ONAVERAGE test=predicate", cost=0.1
)
@construction("predicate: test=predicate ONAVERAGE", cost=0.1)
def on_average(test: Test) -> Test | None:
    """Compose "on average they are above 450 ppm"."""
    plain = not test.of and not test.attribute and test.value != SAME_THRESHOLD
    return replace(test, of="mean") if plain else None


# --- how many ---------------------------------------------------------------------------------------------------------


@construction("how_many: MOSTOF", "how_many: half=HALFOF", cost=0.0)
def most(half: Lex | None = None) -> HowMany:
    """Compose "most of them" and "half of them"."""
    return HowMany("gt" if half is None else "ge", 50.0, percent=True)


@construction("how_many: [bound=CMP] share=amount OFPERCENT", "how_many: bound=UPTO share=amount OFPERCENT", cost=0.0)
def share_of_them(share: Amount, bound: Lex | None = None) -> HowMany | None:
    """Compose "30 % of them" and "more than 30 % of the readings"."""
    check = _check(bound)
    if share.unit != "percent" or check is None or not 0 <= share.number <= 100:
        return None
    return HowMany(check, share.number, percent=True)


@construction(
    "how_many: bound=CMP n=count [OFTHEM]",
    "how_many: bound=CMP n=count OFTHEALL",
    "how_many: bound=CMP n=count TREE",
    "how_many: bound=CMP n=count READING",
    "how_many: bound=UPTO n=count [OFTHEM]",
    "how_many: bound=UPTO n=count OFTHEALL",
    "how_many: ATLEAST n=count OFTHEALL",
    "how_many: ATLEAST n=count TREE",
    "how_many: ATLEAST n=count READING",
    "how_many: n=count bound=BOUND OFTHEALL",
    cost=0.0,
)
def so_many(n: int, bound: Lex | None = None) -> HowMany | None:
    """Compose "more than 3 of them", "fewer than 4 readings" and "at least 2 of the vines"."""
    check = _check(bound)
    return None if check is None else HowMany(check, float(n))


@construction("how_many: n=count OFTHEALL", cost=0.0)
def several_of_all(n: int) -> HowMany | None:
    """Compose "3 of them"; "one of them" is each of them in its turn."""
    return HowMany("ge", float(n)) if n > 1 else None


def _check(bound: Lex | None) -> Literal["lt", "le", "gt", "ge"] | None:
    """Return the comparison of a number of readings; at least so many where none is said."""
    if bound is None:
        return "ge"
    value: Any = bound.value
    if value in (None, "UPTO"):
        return "le"
    if value[1] or value[0] not in _COUNTS or "denies" in bound.features:
        return None
    return cast(Literal["lt", "le", "gt", "ge"], value[0])


@construction(
    "tests: of=how_many [IS] test=predicate",
    "tests: of=how_many noun=NOUN [READING] [IS] test=predicate",
    "tests: AT of=how_many [COMMA] test=test",
    "tests: IT IS of=how_many test=predicate",
    cost=0.2,
)
def so_many_pass(test: Test, of: HowMany, noun: Lex | None = None) -> AllTests | None:
    """Compose "more than 3 of them are below 400 ppm"."""
    quantities = {test.quantity} if noun is None else set(noun.value.quantities)
    if len(quantities) != 1 or test.place is not None or test.of or test.attribute:
        return None
    return AllTests((replace(test, quantity=quantities.pop()),), of_last=of)


@construction(
    "tests: FOUND n=count [ONE] [WHICH] [IS] test=predicate",
    "tests: FOUND n=count TREE [WHICH] [IS] test=predicate",
    "tests: FOUND n=count READING [WHICH] [IS] test=predicate",
    "tests: FOUND n=count OFTHEM [WHICH] [IS] test=predicate",
    "tests: n=count IS test=predicate",
    "tests: n=count TREE [WHICH] IS test=predicate",
    "tests: n=count READING [WHICH] IS test=predicate",
    cost=0.3,
)
def so_many_found(n: int, test: Test) -> AllTests | None:
    """Compose "you have found three above 36 degC"."""
    if n < 2 or test.of or test.attribute or test.place is not None or test.value == SAME_THRESHOLD:
        return None
    return AllTests((test,), of_last=HowMany("ge", float(n)))


@construction("readings_found: n=count READING [WHICH] [IS] test=predicate", cost=0.0)
@construction("readings_found: n=count OFTHEM [WHICH] [IS] test=predicate", cost=0.0)
@construction("readings_found: n=count TREE [WHICH] IS test=predicate", cost=0.0)
def readings_found(n: int, test: Test) -> AllTests | None:
    """Compose "three readings below 25 percent" behind "stop after"."""
    return so_many_found(n, test)


# --- precision --------------------------------------------------------------------------------------------------------


@construction("width: WITHINWORD value=amount", cost=0.0)
def width(value: Amount) -> Amount | None:
    """Compose "to within 10 ppm"."""
    return value if value.number > 0 else None


@construction(
    "tests: subject=measured IS KNOWN value=width",
    "tests: subject=measured IS value=width",
    "tests: KNOWING subject=measured value=width",
    cost=0.1,
)
def mean_is_known(subject: Subject, value: Amount) -> AllTests | None:
    """Compose "the mean is known to within 5 %"."""
    if subject.of not in ("", "mean") or (subject.of == "" and not subject.quantity) or subject.place is not None:
        return None
    return AllTests((Test(subject.quantity, "known", value.number, value.unit, setting=subject.setting, of="mean"),))


@construction("tests: [DET] ERROROF [IS] test=predicate", cost=0.1)
def error_is(test: Test) -> AllTests | None:
    """Compose "the error of the mean is below 5 %"."""
    below = test.check in ("lt", "le") and not test.negated and test.value != SAME_THRESHOLD and test.unit
    if not below or test.quantity or test.attribute or test.of or test.value <= 0:
        return None
    return AllTests((Test("", "known", test.value, test.unit, of="mean"),))


# --- comparisons ------------------------------------------------------------------------------------------------------


@construction("test: word=IT AVERAGED test=predicate", "test: DET READING AVERAGED test=predicate", cost=0.1)
def they_average(test: Test, word: Lex | None = None) -> Test | None:
    """Compose "they average below 15 ppm"."""
    if word is not None and "of_several" not in word.features:
        return None
    return None if test.of or test.attribute or test.value == SAME_THRESHOLD else replace(test, of="mean")


@construction("side: one=statistic", cost=0.0)
def side_of_statistic(one: Subject) -> Subject:
    """Compose "the mean of row 3" as one side of a comparison."""
    return one


@construction(
    "side: place=place",
    "side: place=owned_by",
    "side: word=DET relation place=place",
    "side: DET ONE relation place=place",
    "side: [DET] noun=NOUN [READING] relation place=place",
    "side: place=owned_by noun=NOUN",
    cost=0.1,
)
def side_of_place(place: PlaceMeaning, noun: Lex | None = None, word: Lex | None = None) -> list[Subject] | None:
    """Compose "row 4", "that of row 4" and "the temperature of row 4" as one side of a comparison."""
    if word is not None and word.features.isdisjoint({"demonstrative", "those"}):
        return None
    if place.shape not in (*_PLACES, "one") or place.refers_back or place.optional or place.per is not None:
        return None
    quantities = [""] if noun is None else list(dict.fromkeys(noun.value.quantities))
    return [Subject(name, place) for name in quantities]


@construction(
    "test: [DET] DIFFERENCE [OFTHEM] [IS] test=predicate", "test: DET DIFFERENCE BETWEENTHEM [IS] test=predicate",
    "test: [IT] DIFFER BY more=CMP by=amount", "test: [IT] DIFFER BY [ATLEAST] by=amount",
    "test: DET count [GROUPNOUN] DIFFER BY more=CMP by=amount",
    "test: GROUPALL DIFFER BY more=CMP by=amount", "test: GROUPALL DIFFER BY [ATLEAST] by=amount",
    "test: [IT] IS more=CMP by=amount APART", cost=0.1,
)  # fmt: skip
def they_differ(test: Test | None = None, more: Lex | None = None, by: Amount | None = None) -> Test | None:
    """Compose "the difference is more than 5 degrees" and "they differ by more than 5 degrees", of two readings."""
    than = Subject(DIFFERENCE)
    if test is not None:
        plain = test.check in _COUNTS and not test.negated and test.value != SAME_THRESHOLD and not test.quantity
        return replace(test, of="mean", than=than) if plain and not test.attribute and not test.of else None
    bound = "ge" if more is None else _check(more)
    return None if by is None or bound is None else Test("", bound, by.number, by.unit, of="mean", than=than)


@construction(
    "side: DET rank=ORD READING", "side: DET rank=ORD ONE", "side: DET rank=ORD", "side: DET LAST READING",
    "side: DET LAST ONE", cost=0.1,
)  # fmt: skip
def side_of_nth_reading(rank: Lex | None = None) -> Subject:
    """Compose "the second reading" as one side of a comparison."""
    return Subject(f"{NTH_READING}{-1 if rank is None else rank.value}")


@construction(
    "test: [subject=measured] way=CHANGED more=CMP by=amount",
    "test: [subject=measured] way=CHANGED [AT] by=amount",
    "test: [subject=measured] way=CHANGED BY more=CMP by=amount",
    "test: [subject=measured] way=CHANGED BY by=amount",
    "test: [subject=measured] way=CHANGED BY ATLEAST by=amount",
    "test: [subject=measured] way=CHANGED ATLEAST by=amount",
    "test: [subject=measured] IS way=CHANGED BY more=CMP by=amount",
    "test: [subject=measured] IS way=CHANGED more=CMP by=amount",
    "test: [subject=measured] IS way=CHANGED BY [ATLEAST] by=amount",
    "test: [subject=measured] [IS] way=CHANGED",
    "test: one=test CHANGEDSINCE",
    cost=0.1,
)  # fmt: skip
def has_changed(
    way: Lex | None = None,
    subject: Subject | None = None,
    more: Lex | None = None,
    by: Amount | None = None,
    one: Test | None = None,
) -> Test | None:
    """Compose "it has gone up by more than 50 ppm", of the last reading and the one before it."""
    if one is not None:
        return one if one.than is not None and one.than.quantity == _BEFORE else None
    if way is None or (subject is not None and (subject.place is not None or subject.of or subject.setting)):
        return None
    bound = "ge" if more is None else _check(more)
    if bound not in ("gt", "ge"):
        return None
    risen = "rises" in way.features
    number = 0.0 if by is None else by.number
    check: Any = ("gt" if by is None else bound) if risen else {"gt": "lt", "ge": "le"}["gt" if by is None else bound]
    than = Subject(_BEFORE)
    return Test(_LAST, check, number if risen else -number, "" if by is None else by.unit, of="mean", than=than)


@construction(
    "test: first=side [IS] word=CMP second=side",
    "test: first=side [IS] by=amount word=CMP second=side",
    "test: first=side [IS] more=CMP by=amount word=CMP second=side",
    "test: first=side [IS] ONAVERAGE word=CMP second=side",
    "test: first=side [IS] word=CMP second=side ONAVERAGE",
    "test: first=side [IS] by=amount word=CMP second=side ONAVERAGE",
    "test: first=side [IS] more=CMP by=amount word=CMP second=side ONAVERAGE",
    "test: first=side [IS] ONAVERAGE more=CMP by=amount word=CMP second=side",
    "test: first=side [IS] ONAVERAGE by=amount word=CMP second=side",
    "test: IS first=side word=CMP second=side",
    "test: first=side AVERAGES word=CMP second=side",
    cost=0.2,
)
def is_more_than_other(
    first: Subject, second: Subject, word: Lex, by: Amount | None = None, more: Lex | None = None
) -> Test | None:
    """Compose "the mean of row 3 is at least 2 degC higher than that of row 4"."""
    value: Any = word.value
    if value in (None, "UPTO") or value[1] or value[0] not in ("lt", "gt") or "denies" in word.features:
        return None
    by_number = all(one.place is None and one.quantity.startswith(NTH_READING) for one in (first, second))
    if not by_number and (first.place is None or second.place is None or first.place.selector == second.place.selector):
        return None
    if second.of not in ("", first.of) or (second.quantity not in ("", first.quantity) and not by_number):
        return None
    check: Any = value[0]
    if by is not None and more is not None:
        bound = _check(more)
        if bound not in ("gt", "ge"):
            return None
        check = {"gt": {"gt": "gt", "ge": "ge"}, "lt": {"gt": "lt", "ge": "le"}}[check][bound]
    elif by is not None:
        check = {"gt": "ge", "lt": "le"}[check]
    difference = 0.0 if by is None else by.number if value[0] == "gt" else -by.number
    return Test(
        first.quantity,
        check,
        difference,
        "" if by is None else by.unit,
        place=first.place,
        of=first.of or "mean",
        than=second,
    )


@construction(
    "test: first=side IS word=BARECMP [ONAVERAGE]",
    "test: first=side IS ONAVERAGE word=BARECMP",
    "test: first=side AVERAGES word=BARECMP",
    "test: first=side IS DET word=BARECMP of=STATISTIC",
    "test: first=side IS DET word=BARECMP of=STATISTIC OFTHEALL",
    "test: first=side IS DET word=BARECMP noun=NOUN",
    cost=0.3,
)
def is_more_than_the_rest(
    first: Subject, word: Lex, of: Lex | None = None, noun: Lex | None = None
) -> list[Test] | None:
    """Compose "the wet corner averages higher", than the other area that was read."""
    if first.place is None or first.place.shape == "one" or word.value not in ("lt", "gt"):
        return None
    named = cast(Statistic, of.value) if of is not None else "mean"
    quantities = [first.quantity]
    if noun is not None:
        quantities = [one for one in noun.value.quantities if first.quantity in ("", one)]
    return [
        Test(one, word.value, 0.0, place=first.place, of=first.of or named, than=Subject(of=first.of or named))
        for one in dict.fromkeys(quantities)
    ]
