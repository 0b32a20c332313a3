"""Constructions of places named by others before them: "the other half", "the southern one", "the best five"."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, Nominal, PlaceMeaning
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import chooses_from_trees

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "likewise: DET OTHER half=HALF",
    "likewise: DET OPPOSITE half=HALF",
    "likewise: DET OTHER half=SIDE",
    "likewise: DET OPPOSITE half=SIDE",
    "likewise: DET OPPOSITE quarter=QUARTER",
    "likewise: DET OPPOSITE corner=CORNER",
    "likewise: DET corner=CORNER OPPOSITE",
    cost=0.2,
)
def opposite_side(half: Lex | None = None, quarter: Lex | None = None, corner: Lex | None = None) -> Likewise | None:
    """Compose "the other half" and "the opposite corner"."""
    kinds: dict[Literal["", "half", "quarter", "corner"], Lex | None]
    kinds = {"half": half, "quarter": quarter, "corner": corner}
    return next((Likewise(kind) for kind, noun in kinds.items() if noun is not None and not noun.plural), None)


@construction("likewise: DET side=DIR noun=ONE", cost=0.3)
def other_of_its_kind(side: Lex, noun: Lex) -> Likewise | None:
    """Compose "the southern one"."""
    return None if "plural" in noun.features else Likewise("", side.value)


@construction("place: like=likewise", cost=0.3)
def likewise(like: Likewise) -> list[PlaceMeaning]:
    """Compose "the southern one" as a place: a single place, or an area."""
    one, area = (PlaceMeaning(s.Trees(), "one", like=like), PlaceMeaning(s.Trees(), "area", like=like))
    return [one, area] if not like.kind else [one] if like.kind == "corner" else [area]


@construction("place: OTHERS", cost=4.0)
@construction("place: DET OTHER noun=TREE", cost=0.5)
def the_rest(noun: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the others", of trees that were named before."""
    if noun is not None and not noun.plural:
        return None
    return PlaceMeaning(s.Trees(), "several", like=Likewise("rest"))


@construction("place: OTHERS OF where=region", "place: DET OTHER noun=TREE in_ where=region", cost=0.3)
def rest_of_area(where: s.Selector, noun: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the rest of row 4"."""
    if noun is not None and not noun.plural:
        return None
    return PlaceMeaning(where, "several", like=Likewise("rest"))


@construction(
    "place: DET rank=ORD noun=ONE",
    "place: DET last=LAST noun=ONE",
    "place: DET last=LATTER",
    "place: DET FORMER",
    cost=0.5,
)
def one_of_those_named(
    rank: Lex | None = None, last: Lex | None = None, noun: Lex | None = None
) -> PlaceMeaning | None:
    """Compose "the first one" and "the latter", of places that were named before."""
    if noun is not None and "plural" in noun.features:
        return None
    number = -1 if last is not None else 1 if rank is None else rank.value
    return PlaceMeaning(s.Trees(), "one", like=Likewise("nth", number=number))


@construction("place: whole=place in_ like=likewise", cost=0.3)
def in_likewise(whole: PlaceMeaning, like: Likewise) -> PlaceMeaning | None:
    """Compose "two trees in the other half"."""
    if whole.shape not in ("one", "several") or whole.per is not None or whole.like is not None:
        return None
    if like.kind == "corner" or not chooses_from_trees(whole.selector):
        return None
    return replace(whole, like=replace(like, holds=True))


@construction(
    "place: DET rank=ranking n=count",
    "place: DET rank=ranking n=count inner=nominal",
    "place: DET n=count rank=ranking",
    "place: DET n=count rank=ranking inner=nominal",
    "place: DET ONE WITH DET rank=ranking",
    "place: DET n=count [ONE] WITH DET rank=ranking",
    cost=0.5,
)
def best_of_ranked(rank: tuple[str, bool], n: int = 1, inner: Nominal | None = None) -> PlaceMeaning | None:
    """Compose "the best five" and "the one with the lowest", of trees that were ranked before."""
    if inner is not None and (rank[0] or inner.selector != s.Trees()):
        return None
    best = s.Top(attribute=rank[0], count=n, lowest=rank[1])
    return PlaceMeaning(best, "one" if n == 1 else "several", count=n, like=Likewise("ranked"))
