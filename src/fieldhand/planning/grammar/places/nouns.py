"""Constructions of nouns and what describes them: attributes, extremes and rankings."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.words import Lex, hinted_attributes
from fieldhand.planning.selections import (
    as_every_nth,
    as_top,
    chooses_from_trees,
)
from fieldhand.site.model import Site
from fieldhand.terms import Test

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("nominal: noun=TREE", "owner: noun=TREEPOSS", cost=0.0)
def tree(noun: Lex) -> Nominal:
    """Compose "trees"."""
    return Nominal(s.Trees(), plural=noun.plural)


@construction(
    "nominal: inner=nominal WHICH [IS] NOT value=ATTRVAL",
    "nominal: inner=nominal WHICH ISNOT value=ATTRVAL",
    "nominal: inner=nominal WHICH NOT value=ATTRVAL",
    "nominal: inner=nominal WHICHPOSS NOT value=ATTRVAL",
    cost=0.3,
)
def without_attribute(inner: Nominal, value: Lex) -> list[Nominal] | None:
    """Compose "trees that are not yellow"."""
    if inner.single or inner.complete or not chooses_from_trees(inner.selector):
        return None
    return [
        replace(inner, selector=s.Where(attribute=name, test="ne", value=text, of=inner.selector), tested=True)
        for name, text in value.value
    ]


@construction("nominal: side=MOST", cost=1.0)
def extreme_one(side: Lex) -> Nominal | None:
    """Compose "northernmost" without a noun."""
    return Nominal(s.Extreme(side=side.value), single=True) if side.value in SIDES else None


@construction("place: DET rank=ranking", cost=1.0)
def best_one(rank: tuple[str, bool]) -> PlaceMeaning | None:
    """Compose "the oldest"."""
    return PlaceMeaning(s.Top(attribute=rank[0], count=1, lowest=rank[1]), "one") if rank[0] else None


@construction("nominal: noun=ONE", cost=0.4)
def pronoun(noun: Lex) -> Nominal:
    """Compose "ones"."""
    return Nominal(s.Trees(), plural="plural" in noun.features, pronoun=True)


@construction(
    "nominal: value=ATTRVAL inner=nominal",
    "owner: value=ATTRVAL inner=owner",
    "nominal: inner=nominal OF value=ATTRVAL",
    "nominal: inner=nominal OF [DET] ATTR value=ATTRVAL",
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


@construction("region: DET value=ATTRVAL", cost=0.8, given=("site",))
def where_a_variety_grows(value: Lex, site: Site) -> list[s.Selector]:
    """Compose "the Merlot" as an area."""
    varieties = hinted_attributes("variety", site)
    return [s.Where(attribute=name, test="eq", value=text) for name, text in value.value if name in varieties]


@construction("nominal: value=ATTRVAL", cost=0.8)
def those_of_a_kind(value: Lex) -> list[Nominal]:
    """Compose "Nonpareil" without a noun."""
    return [Nominal(s.Where(attribute=name, test="eq", value=text), plural=True) for name, text in value.value]


@construction(
    "nominal: inner=nominal [WHICH] [IS] test=attribute_test",
    "nominal: inner=nominal [WITH] test=attribute_test",
)
def with_attribute(inner: Nominal, test: tuple[str, Test, Any]) -> Nominal | None:
    """Compose "trees that are older than 8 years"."""
    if inner.single or inner.complete or not chooses_from_trees(inner.selector):
        return None
    name, check, value = test
    return replace(inner, selector=s.Where(attribute=name, test=check, value=value, of=inner.selector), tested=True)


@construction(
    "nominal: inner=nominal [WHICH] [IS] test=attribute_test AND [WHICH] [IS] second=attribute_test",
    "nominal: inner=nominal WITH test=attribute_test AND [WITH] second=attribute_test",
    cost=0.2,
)
def with_two_attributes(inner: Nominal, test: tuple[str, Test, Any], second: tuple[str, Test, Any]) -> Nominal | None:
    """Compose "trees older than 8 years and younger than 12"."""
    first = with_attribute(inner, test)
    return None if first is None else with_attribute(first, second)


@construction("place: whole=place [WHICH] [IS] test=attribute_test", cost=0.3)
def those_with_attribute(whole: PlaceMeaning, test: tuple[str, Test, Any]) -> PlaceMeaning | None:
    """Compose "every third tree in row 4 that is yellow"."""
    if as_every_nth(whole.selector) is None or whole.per is not None:
        return None
    name, check, value = test
    return replace(whole, selector=s.Where(attribute=name, test=check, value=value, of=whole.selector))


@construction(
    "attribute_test: attribute=ATTR [IS] check=CMP value=NUM",
    "attribute_test: attribute=ATTR [IS] check=CMP value=amount",
    "attribute_test: [DET] attribute=ATTR [IS] check=CMP value=NUM",
    "attribute_test: check=CMP value=NUM [OF] attribute=ATTR",
    "attribute_test: check=CMP value=amount [OF] attribute=ATTR",
    cost=0.2,
)
def attribute_compared(attribute: Lex, check: Lex, value: Any) -> list[tuple[str, Test, Any]] | None:
    """Compose "yield above 10 kg" and "more than 0.9 vigor"."""
    return None if check.value[1] else [(name, check.value[0], _number(value)) for name in attribute.value]


@construction("attribute_test: check=CMP value=NUM", "attribute_test: check=CMP value=amount", cost=0.2)
def hinted_compared(check: Lex, value: Any) -> tuple[str, Test, Any] | None:
    """Compose "older than 8 years"."""
    name = check.value[1]
    if isinstance(value, Amount) and value.unit not in ("years", "kg", "metres"):
        return None
    return (name, check.value[0], _number(value)) if name else None


@construction("attribute_test: value=NUM bound=BOUND", "attribute_test: value=amount bound=BOUND", cost=0.2)
def bounded(value: Any, bound: Lex) -> tuple[str, Test, Any] | None:
    """Compose "8 years or older"."""
    if isinstance(value, Amount) and value.unit not in ("years", "kg", "metres"):
        return None
    return (bound.value[1], bound.value[0], _number(value)) if bound.value[1] else None


@construction(
    "attribute_test: [DET] attribute=ATTR [OF] [IS] value=NUM bound=BOUND",
    "attribute_test: [DET] attribute=ATTR [OF] [IS] value=amount bound=BOUND",
    cost=0.2,
)
def attribute_bounded(attribute: Lex, value: Any, bound: Lex) -> list[tuple[str, Test, Any]] | None:
    """Compose "vigor of 0.9 or more"."""
    return None if bound.value[1] else [(name, bound.value[0], _number(value)) for name in attribute.value]


@construction(
    "attribute_test: ATTRVERB check=CMP value=NUM",
    "attribute_test: ATTRVERB check=CMP value=amount",
    cost=0.2,
    given=("site",),
)
def yielded(check: Lex, value: Any, site: Site) -> list[tuple[str, Test, Any]] | None:
    """Compose "yielded less than 5 kg"."""
    if check.value[1] or (isinstance(value, Amount) and value.unit != "kg"):
        return None
    return [(name, check.value[0], _number(value)) for name in hinted_attributes("yield", site)]


@construction("attribute_test: attribute=ATTR IS value=ATTRVAL", cost=0.2)
def attribute_is_value(attribute: Lex, value: Lex) -> list[tuple[str, Test, Any]]:
    """Compose "leaves are yellow"."""
    return [(name, "eq", text) for name, text in value.value if name in attribute.value]


@construction(
    "attribute_test: attribute=ATTR ISNOT value=ATTRVAL",
    "attribute_test: attribute=ATTR IS NOT value=ATTRVAL",
    cost=0.2,
)
def attribute_is_not(attribute: Lex, value: Lex) -> list[tuple[str, Test, Any]]:
    """Compose "leaves are not green"."""
    return [(name, "ne", text) for name, text in value.value if name in attribute.value]


@construction(
    "nominal: inner=nominal [WHICH] [DET] attribute=ATTR [IS] BETWEEN low=NUM AND high=NUM",
    "nominal: inner=nominal WITH [DET] attribute=ATTR [OF] BETWEEN low=NUM AND high=NUM",
    "nominal: inner=nominal WHICH [DET] attribute=ATTR OF BETWEEN low=NUM AND high=NUM",
    cost=0.3,
)
def with_attribute_between(inner: Nominal, attribute: Lex, low: Lex, high: Lex) -> list[Nominal] | None:
    """Compose "trees with a yield between 4 and 6"."""
    if inner.single or inner.complete or low.value >= high.value or not chooses_from_trees(inner.selector):
        return None
    return [
        replace(
            inner,
            selector=s.Where(
                attribute=name,
                test="le",
                value=high.value,
                of=s.Where(attribute=name, test="ge", value=low.value, of=inner.selector),
            ),
            tested=True,
        )
        for name in attribute.value
    ]


@construction(
    "place_where: WHERE [DET] [TREE] [IS] test=attribute_test",
    "place_where: WHERE [DET] [TREE] [IS] test=attribute_test in_ where=region",
    "place_where: WHERE IT [IS] [DET] test=attribute_test",
    "place_where: WHERE IT [IS] [DET] test=attribute_test in_ where=region",
    cost=0.3,
)
def where_so(test: tuple[str, Test, Any], where: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "where vigor is under 0.35 in the south block"."""
    name, check, value = test
    of = s.Trees() if where is None else where
    return PlaceMeaning(s.Where(attribute=name, test=check, value=value, of=of), "several")


@construction("place: where=place_where", cost=0.3)
def at_places_where(where: PlaceMeaning) -> PlaceMeaning:
    """Compose "where vigor is under 0.35" as places."""
    return where


@construction("attribute_test: value=ATTRVAL", "attribute_test: value=ATTRVAL ATTR", cost=0.4)
def attribute_is(value: Lex) -> list[tuple[str, Test, Any]]:
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
            if inner.plural
            else s.Extreme(side=side.value, of=inner.selector)
        )
    return replace(inner, selector=made, single=not inner.plural)


@construction("place: [DET] n=count side=MOST inner=nominal", cost=0.2)
def so_many_extreme(n: int, side: Lex, inner: Nominal) -> PlaceMeaning | None:
    """Compose "the 3 northernmost trees"."""
    if inner.single or inner.complete or side.value in CORNERS or n < 2:
        return None
    return PlaceMeaning(s.Extreme(side=side.value, count=n, of=inner.selector), "several", count=n)


@construction(
    "place: [DET] first=MOST AND second=MOST inner=nominal",
    "place: [DET] first=MOST AND DET second=MOST inner=nominal",
    cost=0.2,
)
def two_extremes(first: Lex, second: Lex, inner: Nominal) -> PlaceMeaning | None:
    """Compose "the northernmost and southernmost trees"."""
    if inner.single or inner.complete or first.value in CORNERS or second.value in CORNERS:
        return None
    parts = tuple(s.Extreme(side=side.value, of=inner.selector) for side in (first, second))
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=2)


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


@construction("ranking: attribute=SUPER", cost=0.0)
def ranking_word(attribute: Lex) -> tuple[str, bool]:
    """Compose "oldest"."""
    return cast("tuple[str, bool]", attribute.value)


@construction("ranking: rank=ranking attribute=ATTR", cost=0.0)
def ranking_of(rank: tuple[str, bool], attribute: Lex) -> list[tuple[str, bool]] | None:
    """Compose "highest yield"."""
    return [(name, rank[1]) for name in attribute.value] if not rank[0] else None


@construction(
    "place: [DET] n=count rank=ranking inner=nominal",
    "place: DET rank=ranking n=count inner=nominal",
    "place: [DET] n=count inner=nominal [WHICH] WITH DET rank=ranking",
    "place: [DET] rank=ranking inner=nominal",
    "owned_by: [DET] rank=ranking inner=owner",
    "place: [DET] inner=nominal [WHICH] WITH DET rank=ranking",
)
def ranked(rank: tuple[str, bool], inner: Nominal, n: int | None = None) -> PlaceMeaning | None:
    """Compose "the five oldest trees" and "5 trees with the highest yield"."""
    name, lowest = rank
    number = n or (None if inner.plural else 1)
    if not name or number is None or inner.single or inner.complete:
        return None
    selector = s.Top(attribute=name, count=number, lowest=lowest, of=inner.selector)
    return PlaceMeaning(selector, "one") if number == 1 else PlaceMeaning(selector, "several", count=number)


@construction("place: [DET] n=count inner=nominal WHICH ATTRVERB DET best=ranking", cost=0.2, given=("site",))
def that_yielded(n: int, inner: Nominal, best: tuple[str, bool], site: Site) -> list[PlaceMeaning] | None:
    """Compose "the ten trees that yielded the least"."""
    if best[0] or inner.single or inner.complete:
        return None
    return [
        PlaceMeaning(
            s.Top(attribute=name, count=n, lowest=best[1], of=inner.selector), "one" if n == 1 else "several", count=n
        )
        for name in hinted_attributes("yield", site)
    ]


@construction("place: best=place in_ where=region", cost=0.4)
def best_in(best: PlaceMeaning, where: s.Selector) -> PlaceMeaning | None:
    """Compose "the 20 vines with the lowest vigor in the south block"."""
    top = as_top(best.selector)
    if top is None or top.of != s.Trees() or best.per is not None or best.each:
        return None
    return replace(best, selector=replace(top, of=where))


@construction("nominal: EVERYTHING", cost=0.2)
def everything() -> Nominal:
    """Compose "everything"."""
    return Nominal(s.Trees(), plural=True)


@construction("nominal: rank=ORD side=MOST inner=nominal", cost=0.1)
def nth_extreme(rank: Lex, side: Lex, inner: Nominal) -> Nominal | None:
    """Compose "second northernmost tree"."""
    if inner.single or inner.complete or inner.plural or side.value in CORNERS or rank.value < 2:
        return None
    further = s.Extreme(side=side.value, count=rank.value - 1, of=inner.selector)
    of = s.Excluding(places=further, of=inner.selector)
    return replace(inner, selector=s.Extreme(side=side.value, of=of), single=True)


@construction("nominal: rank=ORD best=ranking inner=nominal", cost=0.1)
def nth_ranked(rank: Lex, best: tuple[str, bool], inner: Nominal) -> Nominal | None:
    """Compose "second oldest tree"."""
    if inner.single or inner.complete or inner.plural or not best[0] or rank.value < 2:
        return None
    better = s.Top(attribute=best[0], count=rank.value - 1, lowest=best[1], of=inner.selector)
    of = s.Excluding(places=better, of=inner.selector)
    return replace(inner, selector=s.Top(attribute=best[0], count=1, lowest=best[1], of=of), single=True)


@construction("nominal: side=DIR inner=nominal", cost=0.3)
def of_a_side(side: Lex, inner: Nominal) -> Nominal | None:
    """Compose "northern trees"."""
    if inner.single or inner.complete or inner.kind != "tree" or "adjective" not in side.features:
        return None
    if inner.pronoun:
        return None  # "the southern ones", of corners that were named before
    part = s.Quarter(quarter=side.value) if side.value in CORNERS else s.Half(side=side.value)
    return replace(inner, selector=replace(part, of=inner.selector), of_side=True)


@construction("nominal: inner=nominal [WHICH] [IS] FARTHEST [AT] [DET] side=DIR", cost=0.2)
def farthest_to_side(inner: Nominal, side: Lex) -> Nominal | None:
    """Compose "tree that lies farthest to the south"."""
    return None if inner.plural else extreme(side, inner)


@construction(
    "nominal: inner=nominal WHICH [IS] NOT in_ where=region",
    "nominal: inner=nominal WHICH ISNOT in_ where=region",
    cost=0.3,
)
def not_in_area(inner: Nominal, where: s.Selector) -> Nominal | None:
    """Compose "trees that are not on the edge of the orchard"."""
    if inner.single or inner.complete:
        return None
    return replace(inner, selector=s.Excluding(places=where, of=inner.selector), tested=True)


@construction(
    "nominal: inner=nominal [WHICH] WITH [DET] attribute=ATTR OF check=CMP value=NUM",
    "nominal: inner=nominal [WHICH] WITH [DET] attribute=ATTR OF check=CMP value=amount",
    "nominal: inner=nominal WHICH [DET] attribute=ATTR OF check=CMP value=amount",
    "nominal: inner=nominal WHICH [DET] attribute=ATTR OF check=CMP value=NUM",
    cost=0.2,
)
def with_attribute_of(inner: Nominal, attribute: Lex, check: Lex, value: Any) -> list[Nominal] | None:
    """Compose "trees with a yield of more than 3 kg"."""
    if inner.single or inner.complete or not chooses_from_trees(inner.selector):
        return None
    tests = attribute_compared(attribute, check, value) or []
    return [
        replace(inner, selector=s.Where(attribute=name, test=test, value=number, of=inner.selector), tested=True)
        for name, test, number in tests
    ]


@construction("nominal: old=amount [DASH] OLD inner=nominal", cost=0.2, given=("site",))
def of_age(old: Amount, inner: Nominal, site: Site) -> list[Nominal] | None:
    """Compose "four year old trees"."""
    if old.unit != "years" or inner.single or inner.complete:
        return None
    ages = hinted_attributes("age", site)
    return [
        replace(inner, selector=s.Where(attribute=name, test="eq", value=old.number, of=inner.selector))
        for name in ages
    ]


@construction("nominal: inner=nominal [WHICH] [IS] BETWEEN low=NUM AND high=amount [OLD]", cost=0.2, given=("site",))
def of_ages_between(inner: Nominal, low: Lex, high: Amount, site: Site) -> list[Nominal] | None:
    """Compose "trees between 5 and 10 years old"."""
    if high.unit != "years" or inner.single or inner.complete or low.value >= high.number:
        return None
    if not chooses_from_trees(inner.selector):
        return None
    found: list[Nominal] = []
    for name in hinted_attributes("age", site):
        older = s.Where(attribute=name, test="ge", value=low.value, of=inner.selector)
        found.append(
            replace(inner, selector=s.Where(attribute=name, test="le", value=high.number, of=older), tested=True)
        )
    return found


@construction(
    "place: [DET] best=ranking n=count inner=nominal BY attribute=ATTR",
    "place: [DET] n=count inner=nominal WITH DET best=ranking attribute=ATTR",
    cost=0.1,
)
def ranked_by(best: tuple[str, bool], n: int, inner: Nominal, attribute: Lex) -> list[PlaceMeaning] | None:
    """Compose "the bottom 4 trees by yield"."""
    if best[0] or inner.single or inner.complete:
        return None
    return [
        PlaceMeaning(
            s.Top(attribute=name, count=n, lowest=best[1], of=inner.selector), "one" if n == 1 else "several", count=n
        )
        for name in attribute.value
    ]
