"""Constructions of nouns and what describes them: attributes, extremes and rankings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Literal, cast

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import split
from fieldhand.planning.english.plant_words import is_kind_attribute, is_unmarked
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount, Likewise, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.attribute_units import attributes_in, in_unit_of_attribute
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.places.numbers import amount
from fieldhand.planning.grammar.words import Lex, hinted_attributes
from fieldhand.planning.selections import chooses_from_trees
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.terms import Test

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Test of an attribute: one with a value, with a pair for "between", or with alternatives.
AttributeCheck = Test | Literal["between", "any", "none"]
#: Attribute, test and value.
AttributeTest = tuple[str, AttributeCheck, Any]

#: Test, value, unit, and the attribute if the words name it ("older than").
Comparison = tuple[Test | Literal["between"], Any, str, str]
#: Words in the names of attributes that are sizes of plants.
_SIZES = ("size", "height", "diameter", "width", "spread", "girth", "weight")
#: Word in the name of the attribute that a verb or an adjective is about, by its unit.
_ATTRIBUTE_BY_UNIT = {"years": "age", "kg": "yield"}


@construction("nominal: noun=TREE", "owner: noun=TREEPOSS", cost=0.0)
def tree(noun: Lex) -> Nominal:
    """Compose "trees"."""
    return Nominal(s.Trees(), plural=noun.plural)


@construction("which_is: WHICH [IS]", "which_is: WHICH [IS] STILL", "which_is: IS", cost=0.0)
def which_is() -> str:
    """Compose "that are" before a description."""
    return "which"


@construction(
    "nominal: inner=nominal WITHOUT value=ATTRVAL ATTR", "nominal: NON [DASH] value=ATTRVAL inner=nominal", cost=0.3
)
def without_attribute(inner: Nominal, value: Lex) -> list[Nominal] | None:
    """Compose "non-yellow trees"."""
    if inner.single or inner.complete or not chooses_from_trees(inner.selector):
        return None
    return [
        replace(inner, selector=that_pass((name, "ne", text), inner.selector), tested=True)
        for name, text in value.value
    ]


@construction("nominal: side=MOST", cost=1.0)
def extreme_one(side: Lex) -> Nominal | None:
    """Compose "northernmost" without a noun."""
    return Nominal(s.Extreme(side=side.value), single=True) if side.value in SIDES else None


@construction("place: DET side=MOST", cost=0.6)
def extreme_of_those(side: Lex) -> PlaceMeaning | None:
    """Compose "the northernmost", which may be a row behind a row."""
    if side.value not in SIDES:
        return None
    return PlaceMeaning(s.Extreme(side=side.value), "one", like=Likewise("extreme", side=side.value))


@construction("place: DET rank=ranking OFTHEM", cost=0.4)
@construction("place: DET n=count rank=ranking OFTHEM", "place: DET rank=ranking n=count OFTHEM", cost=0.4)
def best_of_them(rank: tuple[str, bool], n: int = 1) -> PlaceMeaning | None:
    """Compose "the tallest of them"."""
    best = s.Top(attribute=rank[0], count=n, lowest=rank[1])
    shape: Literal["one", "several"] = "one" if n == 1 else "several"
    return PlaceMeaning(best, shape, count=n, like=Likewise("ranked", holds=True)) if rank[0] else None


@construction("place: DET rank=ranking", cost=1.0, given=("robot",))
def best_one(rank: tuple[str, bool], robot: RobotProfile) -> PlaceMeaning | None:
    """Compose "the oldest"; "the driest" is rather that of the places whose moisture was read."""
    if any(word in split(quantity.name) for word in split(rank[0]) for quantity in robot.quantities):
        return None
    return (
        PlaceMeaning(s.Top(attribute=rank[0], count=1, lowest=rank[1]), "one", like=Likewise("ranked"))
        if rank[0]
        else None
    )


@construction("nominal: noun=ONE", cost=0.4)
def pronoun(noun: Lex) -> Nominal:
    """Compose "ones"."""
    return Nominal(s.Trees(), plural="plural" in noun.features, pronoun=True)


@construction(
    "nominal: value=ATTRVAL inner=nominal",
    "owner: value=ATTRVAL inner=owner",
    "nominal: inner=nominal OF value=ATTRVAL",
    "nominal: inner=nominal OF [DET] ATTR value=ATTRVAL",
    "nominal: value=ATTRVAL [DASH] LEAVED inner=nominal",
    cost=0.2,
)
def described(value: Lex, inner: Nominal) -> list[Nominal] | None:
    """Compose "yellow trees"."""
    if inner.single or inner.complete or inner.pronoun or inner.tested:
        return None  # "the Carmel ones": of which trees?
    return [
        replace(inner, selector=s.Where(attribute=name, test="eq", value=text, of=inner.selector))
        for name, text in value.value
    ]


@construction(
    "nominal: inner=nominal OF [DET] value=ATTRVAL attribute=ATTR",
    "nominal: inner=nominal OF [DET] attribute=ATTR value=ATTRVAL",
    cost=0.2,
)
def of_a_kind(inner: Nominal, value: Lex, attribute: Lex) -> list[Nominal] | None:
    """Compose "trees of the Carmel variety"."""
    if inner.single or inner.complete or not chooses_from_trees(inner.selector):
        return None
    return [
        replace(inner, selector=s.Where(attribute=name, test="eq", value=text, of=inner.selector), tested=True)
        for name, text in value.value
        if name in attribute.value
    ]


@construction("value_list: first=ATTRVAL OR second=ATTRVAL", "value_list: first=ATTRVAL AND second=ATTRVAL", cost=0.1)
def either_value(first: Lex, second: Lex) -> list[tuple[tuple[str, str], ...]]:
    """Compose "yellow or pale green": values of one attribute."""
    return [(one, other) for one in first.value for other in second.value if one[0] == other[0] and one != other]


@construction("value_list: first=ATTRVAL COMMA rest=value_list", cost=0.1)
def longer_value_list(first: Lex, rest: tuple[tuple[str, str], ...]) -> list[tuple[tuple[str, str], ...]]:
    """Compose "yellow, green or pale green"."""
    return [(one, *rest) for one in first.value if one[0] == rest[0][0] and one not in rest]


@construction("nominal: values=value_list inner=nominal", cost=0.2)
def of_several_kinds(values: tuple[tuple[str, str], ...], inner: Nominal) -> Nominal | None:
    """Compose "yellow or pale green trees"."""
    if inner.single or inner.complete or inner.pronoun or inner.tested or not inner.plural:
        return None
    return replace(inner, selector=that_pass((values[0][0], "any", tuple(text for _, text in values)), inner.selector))


@construction("attribute_test: values=value_list [ATTR]", cost=0.4)
def attribute_is_one_of(values: tuple[tuple[str, str], ...]) -> AttributeTest:
    """Compose "yellow or pale green" behind a noun."""
    return (values[0][0], "any", tuple(text for _, text in values))


@construction("region: word=DET value=ATTRVAL", cost=0.8)
def where_a_variety_grows(word: Lex, value: Lex) -> list[s.Selector] | None:
    """Compose "the Merlot" as an area."""
    if value.plural or "indefinite" in word.features:
        return None
    return [
        s.Where(attribute=name, test="eq", value=text)
        for name, text in value.value
        if is_kind_attribute(name) and is_unmarked(name, text)
    ]


@construction("crop_area: [word=DET] value=ATTRVAL", "crop_area: EACH [OF] [word=DET] value=ATTRVAL", cost=0.4)
def where_a_crop_grows(value: Lex, word: Lex | None = None) -> list[s.Selector] | None:
    """Compose "the carrots" and "the beetroot" as ground that is worked or crossed."""
    if word is not None and "indefinite" in word.features:
        return None
    kinds = [(name, text) for name, text in value.value if is_kind_attribute(name)]
    return [
        s.Where(attribute=name, test="eq", value=text)
        for name, text in kinds
        if value.plural or is_unmarked(name, text) or (word is not None and "definite" in word.features)
    ]


@construction(
    "crop_area: first=crop_area AND second=crop_area", "crop_area: first=crop_area COMMA second=crop_area",
    "crop_area: first=crop_area COMMA AND second=crop_area",
    cost=0.1,
)  # fmt: skip
def where_crops_grow(first: s.Selector, second: s.Selector) -> s.Selector | None:
    """Compose "the leeks and the onions" as ground."""
    return None if first == second else s.UnionOf(parts=(*first.members, *second.members))


@construction("nominal: value=ATTRVAL", cost=0.8)
def those_of_a_kind(value: Lex) -> list[Nominal]:
    """Compose "Nonpareil", "courgettes" and "courgette" without another noun; "yellow" needs one."""
    return [
        Nominal(
            s.Where(attribute=name, test="eq", value=text),
            plural=value.plural or is_unmarked(name, text),
            unmarked=not value.plural and is_unmarked(name, text),
        )
        for name, text in value.value
        if value.plural or is_kind_attribute(name)
    ]


@construction("nominal: values=value_list", cost=0.8)
def those_of_several_kinds(values: tuple[tuple[str, str], ...]) -> Nominal | None:
    """Compose "leeks and onions"."""
    if not all(is_kind_attribute(name) for name, _ in values):
        return None
    return Nominal(that_pass((values[0][0], "any", tuple(text for _, text in values)), s.Trees()), plural=True)


def that_pass(test: AttributeTest, of: s.Selector) -> s.Selector:
    """Return the trees of a selection that pass a test of an attribute."""
    name, check, value = test
    if check == "any":
        return s.UnionOf(parts=tuple(s.Where(attribute=name, test="eq", value=text, of=of) for text in value))
    if check == "none":
        for text in value:
            of = s.Where(attribute=name, test="ne", value=text, of=of)
        return of
    if check == "between":
        low, high = value
        return s.Where(attribute=name, test="le", value=high, of=s.Where(attribute=name, test="ge", value=low, of=of))
    return s.Where(attribute=name, test=check, value=value, of=of)


@construction("figure: value=NUM", "figure: value=amount", cost=0.0)
def figure(value: Any) -> tuple[float, str]:
    """Compose "8" and "8 years": the number and its unit."""
    return (value.number, value.unit) if isinstance(value, Amount) else (value.value, "")


@construction("comparison: check=CMP value=figure", "comparison: value=figure check=BOUND", cost=0.0)
def compared(check: Lex, value: tuple[float, str]) -> Comparison:
    """Compose "more than 8 years" and "8 years or older"."""
    test, attribute = check.value
    return (test, value[0], value[1], attribute)


@construction("comparison: span=value_range", cost=0.1)
def between(span: tuple[float, float, str]) -> Comparison:
    """Compose "between 5 and 10 years"."""
    return ("between", span[:2], span[2], "")


@construction("attribute_test: [DET] attribute=ATTR [OF] [IS] by=comparison", cost=0.2)
@construction("attribute_test: by=comparison [OF] attribute=ATTR", cost=0.2)
def attribute_compared(attribute: Lex, by: Comparison) -> list[AttributeTest] | None:
    """Compose "yield above 10 kg", "vigor of 0.9 or more" and "a yield between 4 and 6 kg"."""
    return None if by[3] else tests_of(attribute.value, by)


def tests_of(names: Iterable[str], by: Comparison) -> list[AttributeTest]:
    """Return the tests of attributes by a comparison, in their own units; none of those that have another unit."""
    check, value, unit, _ = by
    found: list[AttributeTest] = []
    for name in names:
        numbers = [in_unit_of_attribute(name, one, unit) for one in (value if check == "between" else (value,))]
        if None not in numbers:
            found.append((name, check, tuple(numbers) if check == "between" else numbers[0]))
    return found


@construction(
    "attribute_test: [DET] attribute=ATTR OF value=figure",
    "attribute_test: [DET] attribute=ATTR IS value=figure",
    "attribute_test: [DET] attribute=ATTR [OF] [IS] exact=amount",
    "attribute_test: exact=amount OF attribute=ATTR",
    cost=0.3,
)
def attribute_exactly(
    attribute: Lex, value: tuple[float, str] = (0.0, ""), exact: Amount | None = None
) -> list[AttributeTest]:
    """Compose "an age of 12 years" and "two years of age"."""
    number, unit = value if exact is None else (exact.number, exact.unit)
    return tests_of(attribute.value, ("eq", number, unit, ""))


@construction("attribute_test: by=comparison", cost=0.2, given=("site",))
def hinted(by: Comparison, site: Site) -> list[AttributeTest] | None:
    """Compose "older than 8 years" and "under 8 years", whose words or unit tell the attribute."""
    _, _, unit, attribute = by
    return tests_of([attribute] if attribute else attributes_in(unit, site), by)


@construction(
    "attribute_test: by=comparison what=DIMENSION", "attribute_test: exact=amount [DASH] what=DIMENSION",
    cost=0.1, given=("site",),
)  # fmt: skip
def of_that_dimension(
    what: Lex, site: Site, by: Comparison | None = None, exact: Amount | None = None
) -> list[AttributeTest] | None:
    """Compose "under 22 cm tall" and "40 cm high"."""
    told: Comparison = by if by is not None else ("eq", *((exact.number, exact.unit) if exact else (0.0, "")), "")
    return None if told[3] else tests_of(hinted_attributes(what.value, site), told)


@construction(
    "attribute_test: GROWN value=figure", "attribute_test: no=NOTGROWN value=figure",
    "attribute_test: GROWN value=figure what=DIMENSION", "attribute_test: no=NOTGROWN value=figure what=DIMENSION",
    cost=0.1, given=("site",),
)  # fmt: skip
def grown_to(
    value: tuple[float, str], site: Site, no: Lex | None = None, what: Lex | None = None
) -> list[AttributeTest]:
    """Compose "have reached 40 cm" and "haven't made 22 centimetres"."""
    names = attributes_in(value[1], site) if what is None else hinted_attributes(what.value, site)
    return tests_of(names, ("ge" if no is None else "lt", *value, ""))


@construction("attribute_test: test=attribute_test YET", cost=0.1)
def tested_so_far(test: AttributeTest) -> AttributeTest:
    """Compose "haven't made 22 centimetres yet"."""
    return test


@construction("of_kind: word=AGED", "of_kind: ATTRVERB", cost=0.0)
def of_kind(word: Lex | None = None) -> str:
    """Compose "aged" and "yielded": the unit of what they tell."""
    return "kg" if word is None else "years"


@construction(
    "attribute_test: kind=of_kind by=comparison", "attribute_test: by=comparison OLD",
    "attribute_test: AGED value=figure", "attribute_test: exact=amount [DASH] OLD",
    cost=0.2, given=("site",),
)  # fmt: skip
def of_that_kind(
    site: Site,
    kind: str = "years",
    by: Comparison | None = None,
    value: tuple[float, str] = (0.0, ""),
    exact: Amount | None = None,
) -> list[AttributeTest] | None:
    """Compose "aged over 5", "between 5 and 10 years old", "yielded less than 5 kg" and "two years old"."""
    number, unit = value if exact is None else (exact.number, exact.unit)
    told: Comparison = ("eq", number, unit, "") if by is None else by
    if told[3] or told[2] not in ("", kind):
        return None
    return tests_of(hinted_attributes(_ATTRIBUTE_BY_UNIT[kind], site), told)


@construction("nominal: old=amount [DASH] OLD inner=nominal", cost=0.2, given=("site",))
def old_trees(old: Amount, inner: Nominal, site: Site) -> list[Nominal] | None:
    """Compose "four-year-old trees"."""
    if inner.single or inner.complete:
        return None
    return [replace(inner, selector=that_pass(test, inner.selector)) for test in of_that_kind(site, exact=old) or ()]


@construction("nominal: old=amount [DASH] OLDS", cost=0.2, given=("site",))
def those_so_old(old: Amount, site: Site) -> list[Nominal] | None:
    """Compose "four-year-olds"."""
    return old_trees(old, Nominal(s.Trees(), plural=True), site)


@construction(
    "value_range: BETWEEN low=NUM AND high=NUM [DASH] unit=UNIT",
    "value_range: [FROM] low=NUM range_to high=NUM [DASH] unit=UNIT",
    cost=0.5,
)
def value_range_of_unit(low: Lex, high: Lex, unit: Lex) -> tuple[float, float, str] | None:
    """Compose "between 50 and 60 cm"."""
    return value_range(amount(low, unit), amount(high, unit))


@construction(
    "value_range: BETWEEN low=NUM AND high=NUM",
    "value_range: BETWEEN low=amount AND high=amount",
    "value_range: [FROM] low=NUM range_to high=NUM",
    "value_range: [FROM] low=amount range_to high=amount",
    cost=0.1,
)
def value_range(low: Any, high: Any) -> tuple[float, float, str] | None:
    """Compose "between 4 and 6 kg"."""
    unit = high.unit if isinstance(high, Amount) else ""
    if _number(low) >= _number(high) or (isinstance(low, Amount) and low.unit != unit):
        return None
    return (_number(low), _number(high), unit)


@construction("attribute_test: [DET] attribute=ATTR IS value=ATTRVAL", cost=0.2)
def attribute_is_value(attribute: Lex, value: Lex) -> list[AttributeTest]:
    """Compose "leaves are yellow"."""
    return [(name, "eq", text) for name, text in value.value if name in attribute.value]


@construction(
    "attribute_test: [DET] attribute=ATTR ISNOT value=ATTRVAL",
    "attribute_test: [DET] attribute=ATTR IS NOT value=ATTRVAL",
    cost=0.2,
)
def attribute_is_not(attribute: Lex, value: Lex) -> list[AttributeTest]:
    """Compose "leaves are not green"."""
    return [(name, "ne", text) for name, text in value.value if name in attribute.value]


@construction(
    "place_where: WHERE [DET] [TREE] [IS] test=attribute_test",
    "place_where: WHERE [DET] [TREE] [IS] test=attribute_test in_ where=region",
    "place_where: WHERE MAPSAYS [DET] [TREE] [IS] test=attribute_test",
    "place_where: WHERE IT [IS] [DET] test=attribute_test",
    "place_where: WHERE IT [IS] [DET] test=attribute_test in_ where=region",
    cost=0.3,
)
def where_so(test: AttributeTest, where: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "where vigor is under 0.35 in the south block"."""
    return PlaceMeaning(that_pass(test, s.Trees() if where is None else where), "several")


@construction("place: where=place_where", cost=0.3)
def at_places_where(where: PlaceMeaning) -> PlaceMeaning:
    """Compose "where vigor is under 0.35" as places."""
    return where


@construction("attribute_test: value=ATTRVAL", "attribute_test: value=ATTRVAL ATTR", cost=0.4)
def attribute_is(value: Lex) -> list[AttributeTest]:
    """Compose "yellow" behind a noun."""
    return [(name, "eq", text) for name, text in value.value]


def _number(value: Lex | Amount) -> float:
    """Return the number of a word or of an amount."""
    return value.number if isinstance(value, Amount) else value.value


@construction(
    "nominal: side=MOST inner=nominal",
    "owner: side=MOST inner=owner",
    "nominal: inner=nominal WHICH [IS] [DET] side=MOST",
    cost=0.2,
)
def extreme(side: Lex, inner: Nominal) -> Nominal | None:
    """Compose "northernmost tree"."""
    if inner.single or inner.complete or inner.kind != "tree":
        return None
    if side.value in CORNERS:
        made: s.Selector = s.Corners(which=(side.value,), of=inner.selector)
    else:
        made = (
            s.AmongExtreme(side=side.value, of=inner.selector)
            if inner.plural and not inner.unmarked
            else s.Extreme(side=side.value, of=inner.selector)
        )
    return replace(inner, selector=made, single=not inner.plural or inner.unmarked)


@construction("nominal: rank=ORD inner=nominal", "owner: rank=ORD inner=owner", cost=0.2)
def first_of_site(rank: Lex, inner: Nominal) -> Nominal | None:
    """Compose "first tree"."""
    if (
        inner.single
        or inner.plural
        or rank.value != 1
        or inner.kind != "tree"
        or inner.pronoun
        or inner.selector != s.Trees()
    ):
        return None
    return replace(inner, selector=s.First(), single=True)


@construction("nominal: LAST inner=nominal", "owner: LAST inner=owner", cost=0.2)
def last_of_site(inner: Nominal) -> Nominal | None:
    """Compose "last tree"."""
    if inner.single or inner.plural or inner.kind != "tree" or inner.pronoun or inner.selector != s.Trees():
        return None
    return replace(inner, selector=s.Last(), single=True)


@construction("ranking: attribute=SUPER", cost=0.0, given=("site",))
def ranking_word(attribute: Lex, site: Site) -> list[tuple[str, bool]]:
    """Compose "oldest"; "biggest" may be about each size that the site records."""
    name, lowest = cast("tuple[str, bool]", attribute.value)
    sizes = [one for hint in _SIZES for one in hinted_attributes(hint, site)] if "of_size" in attribute.features else []
    return [(name, lowest), *((one, lowest) for one in sizes)]


@construction("ranking: rank=ranking [DASH] attribute=ATTR", cost=0.0)
def ranking_of(rank: tuple[str, bool], attribute: Lex) -> list[tuple[str, bool]] | None:
    """Compose "highest yield"."""
    return [(name, rank[1]) for name in attribute.value] if not rank[0] else None


@construction(
    "place: [DET] inner=nominal WITH DET first=ranking AND [DET] [TREE] [WITH] [DET] second=ranking", cost=0.1
)
def two_ranked(inner: Nominal, first: tuple[str, bool], second: tuple[str, bool]) -> PlaceMeaning | None:
    """Compose "the tree with the highest and the lowest yield"."""
    name = first[0] or second[0]
    if not name or second[0] not in ("", name) or first == second or inner.single or inner.complete:
        return None
    parts = tuple(s.Top(attribute=name, count=1, lowest=lowest, of=inner.selector) for _, lowest in (first, second))
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=2)


@construction("nominal: EVERYTHING", cost=0.2)
def everything() -> Nominal:
    """Compose "everything"."""
    return Nominal(s.Trees(), plural=True)


@construction("nominal: side=DIR inner=nominal", cost=0.3)
def of_a_side(side: Lex, inner: Nominal) -> Nominal | None:
    """Compose "northern trees"."""
    if inner.single or inner.complete or inner.kind != "tree" or "adjective" not in side.features:
        return None
    if inner.pronoun:
        return None  # "the southern ones", of corners that were named before
    part = s.Quarter(quarter=side.value) if side.value in CORNERS else s.Half(side=side.value)
    return replace(inner, selector=replace(part, of=inner.selector), of_side=True)


@construction("farthest_side: FARTHEST [AT] [DET] side=DIR", cost=0.0)
def farthest_side(side: Lex) -> Lex:
    """Compose "farthest to the south" behind a noun."""
    return side


@construction("nominal: inner=nominal [which_is] side=farthest_side", cost=0.2)
def farthest_to_side(inner: Nominal, side: Lex) -> Nominal | None:
    """Compose "tree that lies farthest to the south"."""
    return None if inner.plural else extreme(side, inner)
