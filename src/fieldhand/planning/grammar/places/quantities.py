"""Constructions of how many of a description are meant: "a", "the three", "any", "every", "as many as you can"."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.numbered import are_two, ids_of
from fieldhand.planning.grammar.places.numbers import VAGUE_NUMBERS
from fieldhand.planning.grammar.places.vague import as_many_of_best
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import is_by_attribute, is_description
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class Determiner:
    """Words before a noun that say how many are meant.

    Attributes:
        kind: Article ("the", "a", "some" or another one, ``that``), "any" or the free choice of "whichever", "each" or
            "all"; empty if there is none.
        n: Number, if it is given.
        two: True for "both".
    """

    kind: Literal["", "the", "a", "some", "that", "any", "any such", "whichever", "each", "all"] = ""
    n: int | None = None
    two: bool = False


@construction("quantity: word=DET [n=count]", cost=0.0)
def article(word: Lex, n: int | None = None) -> Determiner:
    """Compose "the", "a" and "the three"."""
    if "indefinite" in word.features:
        return Determiner("some" if "vague" in word.features else "a", n)
    return Determiner("the" if "definite" in word.features else "that", n)


@construction("quantity: n=count", cost=0.0)
def number(n: int) -> Determiner:
    """Compose "three"."""
    return Determiner("", n)


@construction("quantity: word=ANY [of=DET]", "quantity: word=ANY n=count", "quantity: ATLEAST n=count", cost=0.1)
def any_of(word: Lex | None = None, n: int | None = None, of: Lex | None = None) -> Determiner:
    """Compose "any" and "at least three"."""
    features = frozenset() if word is None else word.features
    n = 1 if "just_one" in features and n is None else n
    such = "any_such" in features and n is None and of is None
    return Determiner("whichever" if "free_choice" in features else "any such" if such else "any", n)


@construction("quantity: word=EACH [DET] [n=count]", cost=0.0)
def each(word: Lex, n: int | None = None) -> Determiner:
    """Compose "every" and "all 12"."""
    return Determiner("all" if "all_of" in word.features else "each", n, two="two" in word.features)


@construction("place: quantity=quantity inner=nominal", cost=0.2, given=("site",))
def quantified(quantity: Determiner, inner: Nominal, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the three yellow trees", "any tree of row 4" and "every corner"."""
    kind, n = quantity.kind, quantity.n
    if inner.pronoun and inner.tested and n is None and kind in ("", "the", "each", "all", "any", "any such"):
        return [_of_those(place) for place in quantified(quantity, replace(inner, pronoun=False), site) or ()] or None
    if quantity.two and not inner.complete and not are_two(inner.selector, site):
        return None  # "both trees", of two that were named
    if inner.single:
        return (
            [PlaceMeaning(inner.selector, "one")]
            if n in (None, 1) and kind not in ("any", "any such", "each", "all")
            else None
        )
    if kind in ("each", "all"):
        return _all_of(quantity, inner, site)
    if kind == "any such" and inner.tested and not inner.complete:
        return [PlaceMeaning(inner.selector, "several", each=True)]  # "any leeks that are shorter than 20 cm"
    if kind in ("any", "any such", "whichever"):
        return _any_of(n, inner, site)
    if n is not None:
        return _so_many(quantity, n, inner, site)
    if inner.complete:
        return [PlaceMeaning(inner.selector, "several", count=inner.complete)]
    if (kind in ("a", "some") and not inner.plural) or (kind == "a" and inner.unmarked):
        return [PlaceMeaning(s.Take(count=1, of=inner.selector), "one")]
    if kind == "some":
        return [PlaceMeaning(s.Take(count=n, of=inner.selector), "several", count=n) for n in VAGUE_NUMBERS]
    if inner.plural:
        return [PlaceMeaning(inner.selector, "several", vague=inner.vague)] if kind != "a" else None
    return _those_there(1, inner, site) if kind == "the" else None


def _of_those(place: PlaceMeaning) -> PlaceMeaning:
    """Return "the ones with mildew" as those of the places that were named before."""
    known = place.shape == "several" and place.count is None
    known = known and not any(part.uses_records for part in place.selector.walk())
    return replace(place, like=Likewise("those", holds=True)) if known else place


@construction("place: inner=nominal", cost=0.3)
def unquantified(inner: Nominal) -> PlaceMeaning | None:
    """Compose "yellow trees"."""
    if inner.pronoun and inner.tested:
        place = unquantified(replace(inner, pronoun=False))
        return None if place is None else _of_those(place)
    if inner.single:
        return PlaceMeaning(inner.selector, "one")
    if inner.complete:
        return PlaceMeaning(inner.selector, "several", count=inner.complete)
    return PlaceMeaning(inner.selector, "several", vague=inner.vague) if inner.plural else None


def _all_of(quantity: Determiner, inner: Nominal, site: Site) -> list[PlaceMeaning] | None:
    """Return "every yellow tree", and "all 12 yellow trees": if there are more, all or only so many?"""
    n = quantity.n
    if n in (None, inner.complete):
        return [PlaceMeaning(inner.selector, "several", each=True, count=inner.complete or None)]
    return some_or_all(n, inner.selector, site) if quantity.kind == "all" and inner.plural and n else None


def _any_of(n: int | None, inner: Nominal, site: Site) -> list[PlaceMeaning] | None:
    """Return "any three trees", "any tree" and "any yellow tree": one of them, or each that there is?"""
    if n is not None:
        return None if inner.complete else _so_many(Determiner(), n, inner, site)
    if inner.tested and not inner.plural:
        return [PlaceMeaning(inner.selector, "several", each=True)]  # "any tree that is older than 8 years"
    if is_by_attribute(inner.selector):
        return None if inner.complete or inner.tested else some_or_all(1, inner.selector, site)
    return [PlaceMeaning(s.Take(count=1, of=inner.selector), "one")]


def _so_many(quantity: Determiner, n: int, inner: Nominal, site: Site) -> list[PlaceMeaning] | None:
    """Return "three trees" and "the three yellow trees"."""
    if inner.complete:
        if n == inner.complete:
            return [PlaceMeaning(inner.selector, "several", count=n)]
        if quantity.kind:
            return None
    elif quantity.kind not in ("", "a", "some"):
        return _those_there(n, inner, site) if quantity.kind == "the" else None
    return [
        PlaceMeaning(s.Take(count=n, of=inner.selector), "one" if n == 1 else "several", count=n if n > 1 else None)
    ]


def _those_there(n: int, inner: Nominal, site: Site) -> list[PlaceMeaning] | None:
    """Return "the three yellow trees": all of them, or any so many if there are more."""
    if inner.pronoun or inner.of_side or inner.kind != "tree" or not is_description(inner.selector):
        return None
    return some_or_all(n, inner.selector, site)


def some_or_all(n: int, selector: s.Selector, site: Site) -> list[PlaceMeaning] | None:
    """Return the meanings of so many trees of a selection: all of them if there are as many."""
    there = ids_of(selector, site)
    if there is None or len(there) < n:
        return None
    every = PlaceMeaning(selector, "several")
    if len(there) == n:
        return [PlaceMeaning(s.Take(count=1, of=selector), "one") if n == 1 else every]
    some = PlaceMeaning(s.Take(count=n, of=selector), "one" if n == 1 else "several", count=n)
    return [every, some]


@construction("place: ASMANY [DET] [other=OTHER] inner=nominal as_can", cost=0.2)
@construction("place: [DET] MOSTNUMBER OF inner=nominal", cost=0.2)
@construction("place: ASMANY [DET] [other=OTHER] inner=nominal", cost=2.0)
def as_many(inner: Nominal, other: Lex | None = None) -> PlaceMeaning | None:
    """Compose "as many trees as you can" and "as many other trees as you can"."""
    if inner.single or not inner.plural:
        return None
    if other is not None and "others" in other.features:
        inner = replace(inner, selector=s.NotVisited(of=inner.selector))
    return as_many_of_best(PlaceMeaning(inner.selector, "several", optional=True, vague=inner.vague))


@construction("place: UPTO n=count inner=nominal", "place: check=CMP n=count inner=nominal", cost=0.2)
def up_to(n: int, inner: Nominal, check: Lex | None = None) -> PlaceMeaning | None:
    """Compose "up to six trees" and "at most six trees"."""
    if inner.single or inner.complete or (check is not None and check.value != ("le", "")):
        return None
    return PlaceMeaning(inner.selector, "several", at_most=n)


@construction("place: OTHER inner=nominal", cost=0.3)
def different_ones(inner: Nominal) -> PlaceMeaning | None:
    """Compose "different trees", of which something else says how many."""
    if inner.single or not inner.plural or inner.complete:
        return None
    return PlaceMeaning(s.NotVisited(of=inner.selector), "several")


@construction("nominal: ANOTHER inner=nominal", "nominal: DET OTHER inner=nominal", cost=0.2)
def another(inner: Nominal) -> Nominal | None:
    """Compose "another tree"."""
    if inner.single or inner.plural or inner.complete:
        return None
    return replace(inner, selector=s.Take(count=1, of=s.NotVisited(of=inner.selector)), single=True)
