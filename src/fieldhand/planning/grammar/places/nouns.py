"""Constructions of nouns and what describes them: attributes, extremes and rankings."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.places import selectors as s
from fieldhand.planning.english.limits import Amount
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_every_nth, chooses_from_trees
from fieldhand.terms import Test

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("nominal: noun=TREE", cost=0.0)
def tree(noun: Lex) -> Nominal:
    """Compose "trees"."""
    return Nominal(s.Trees(), plural=noun.plural)


@construction(
    "nominal: inner=nominal WHICH [IS] NOT value=ATTRVAL",
    "nominal: inner=nominal WHICH ISNOT value=ATTRVAL",
    "nominal: inner=nominal WHICH NOT value=ATTRVAL",
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


@construction("nominal: value=ATTRVAL inner=nominal", cost=0.2)
def described(value: Lex, inner: Nominal) -> list[Nominal] | None:
    """Compose "yellow trees"."""
    if inner.single or inner.complete or inner.pronoun or inner.tested:
        return None  # "the Carmel ones": of which trees?
    return [
        replace(inner, selector=s.Where(attribute=name, test="eq", value=text, of=inner.selector))
        for name, text in value.value
    ]


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
    cost=0.2,
)
def attribute_compared(attribute: Lex, check: Lex, value: Any) -> list[tuple[str, Test, Any]]:
    """Compose "yield above 10 kg"."""
    return [(name, check.value[0], _number(value)) for name in attribute.value]


@construction("attribute_test: check=CMP value=NUM", "attribute_test: check=CMP value=amount", cost=0.2)
def hinted_compared(check: Lex, value: Any) -> tuple[str, Test, Any] | None:
    """Compose "older than 8 years"."""
    name = check.value[1]
    if isinstance(value, Amount) and value.unit not in ("years", "kg", "metres"):
        return None
    return (name, check.value[0], _number(value)) if name else None


@construction("attribute_test: value=ATTRVAL", "attribute_test: value=ATTRVAL ATTR", cost=0.4)
def attribute_is(value: Lex) -> list[tuple[str, Test, Any]]:
    """Compose "yellow" behind a noun."""
    return [(name, "eq", text) for name, text in value.value]


def _number(value: Lex | Amount) -> float:
    """Return the number of a word or of an amount."""
    return value.number if isinstance(value, Amount) else value.value


@construction("nominal: side=MOST inner=nominal", cost=0.2)
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


@construction("nominal: rank=ORD inner=nominal", cost=0.2)
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


@construction("nominal: LAST inner=nominal", cost=0.2)
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


@construction("nominal: EVERYTHING", cost=0.2)
def everything() -> Nominal:
    """Compose "everything"."""
    return Nominal(s.Trees(), plural=True)
