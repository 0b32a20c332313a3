"""Constructions of trees that are described without a value: "weak vines", "the worst trees".

Numbers that a person would ask for become readings of their own, so that the plans differ in them and the person is
asked: from which value on a vine is weak, and by which attribute a tree is bad.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.english.naming import split
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.chosen import Choice
from fieldhand.planning.grammar.places.compass import CORNERS
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.words import Lex, hinted_attributes
from fieldhand.planning.selections import as_top, as_where, chooses_from_trees, swapped
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Words in the names of attributes by which a plant is good or bad.
_QUALITIES = (
    "vigor",
    "vigour",
    "yield",
    "health",
    "ndvi",
    "quality",
    "growth",
    "condition",
    "score",
    "rating",
    "grade",
)
#: Words in the names of attributes that say where a plant stands, or which one it is.
_OF_THE_GROUND = frozenset(
    {"row", "position", "number", "id", "column", "slot", "index", "no", "nr", "lat", "lon", "year"}
)
#: Shares of the trees, of which each is offered as those that a word means.
_SHARES = (0.05, 0.10, 0.25)
#: Words in the names of attributes that say how high a place lies.
_HEIGHTS = ("elevation", "altitude", "elev")
_ANYWHERE = s.Trees()
#: Minimum number of different values of an attribute by which trees are ranked.
_FEWEST_VALUES = 3


def qualities(site: Site) -> list[str]:
    """Return the attributes of a site that say how good a tree is."""
    hinted = dict.fromkeys(name for hint in _QUALITIES for name in hinted_attributes(hint, site))
    return [name for name in hinted if len(_numbers(name, site)) >= _FEWEST_VALUES]


def _measures(site: Site) -> list[str]:
    """Return the attributes of a site that are numbers, but for those that say where a plant stands."""
    names = [name for name in site.attributes if not _OF_THE_GROUND & {*split(name)}]
    return [name for name in names if len({*_numbers(name, site)}) >= _FEWEST_VALUES]


@construction("chosen_by: rank=SUPER", cost=0.3, given=("site",))
def by_quality(rank: Lex, site: Site) -> list[Choice] | None:
    """Compose "worst" without an attribute; where none says how good a plant is, by the most or the least of any."""
    if rank.value[0] or "judges" not in rank.features:
        return None
    known = [Choice("best", (name, rank.value[1])) for name in qualities(site)]
    return known or [Choice("best", (name, least)) for name in _measures(site) for least in (False, True)] or None


@construction("VAGUEADJ: TOO word=VAGUEADJ", "VAGUEADJ: word=VAGUEADJ ENOUGH", cost=0.0)
def vague_in_some_degree(word: Lex) -> Lex:
    """Compose "too dry" and "tall enough"."""
    return word


@construction("vague: word=VAGUEADJ inner=nominal", "vague: inner=nominal WHICH IS word=VAGUEADJ", cost=0.0)
def vaguely(word: Lex, inner: Nominal) -> tuple[Nominal, tuple[str, bool], str] | None:
    """Compose "weak vines"."""
    return (inner, word.value, "") if word.value[0] != "=" and _can_be_ranked(inner) else None


@construction("vague: [DET] word=VAGUEADJ noun=ONE in_ where=region", cost=0.0)
def vague_ones_there(word: Lex, noun: Lex, where: s.Selector) -> tuple[Nominal, tuple[str, bool], str] | None:
    """Compose "the tall ones in bed 3"."""
    return vaguely(word, Nominal(where, plural="plural" in noun.features)) if chooses_from_trees(where) else None


@construction(
    "vague: word=VAGUEADJ [DASH] attribute=ATTR inner=nominal",
    "vague: inner=nominal WITH [DET] word=VAGUEADJ attribute=ATTR",
    "vague: inner=nominal OF [DET] word=VAGUEADJ attribute=ATTR",
    cost=0.0,
)
def vaguely_by(word: Lex, attribute: Lex, inner: Nominal) -> list[tuple[Nominal, tuple[str, bool], str]] | None:
    """Compose "vines of low vigor"."""
    if not _can_be_ranked(inner):
        return None
    return [(inner, word.value, name) for name in attribute.value]


def _can_be_ranked(inner: Nominal) -> bool:
    return inner.plural and not (inner.single or inner.complete or inner.pronoun) and chooses_from_trees(inner.selector)


@construction("nominal: said=vague", cost=1.0, given=("site",))
def from_some_value_on(said: tuple[Nominal, tuple[str, bool], str], site: Site) -> list[Nominal] | None:
    """Compose "weak vines" as those with a vigor below one of some values."""
    inner, (_, lowest), _ = said
    found = [
        replace(
            inner,
            selector=s.Where(attribute=name, test="lt" if lowest else "gt", value=value, of=inner.selector),
            tested=True,
            vague=name,
        )
        for name in _attributes(said, site)
        for value in _thresholds(name, site, inner.selector, lowest=lowest)
    ]
    return found or None


def as_many_of_best(place: PlaceMeaning) -> PlaceMeaning:
    """Return places of which as many as possible are visited, the best ones first, if no number and no value was given.

    "As many of the weakest vines as you can" does not say among how many of them, and "as many weak vines" not from
    which value on: the budget decides, and the weakest are worth most.
    """
    if not place.vague:
        return place
    found = [found for part in place.selector.walk() if (found := _ranking(part, place.vague)) is not None]
    if len(found) != 1:
        return place
    ((part, of, which),) = found
    return replace(place, selector=swapped(place.selector, part, of), count=None, vague="", ranked=(place.vague, which))


def _ranking(part: s.Selector, attribute: str) -> tuple[s.Selector, s.Selector, Literal["highest", "lowest"]] | None:
    """Return a selector that takes the best by an attribute, what it chooses from, and which are the best."""
    if (top := as_top(part)) is not None and top.attribute == attribute:
        return top, top.of, "lowest" if top.lowest else "highest"
    where = as_where(part)
    if where is None or where.attribute != attribute or where.test not in ("lt", "gt"):
        return None
    return where, where.of, "lowest" if where.test == "lt" else "highest"


def _attributes(said: tuple[Nominal, tuple[str, bool], str], site: Site) -> Sequence[str]:
    """Return the attributes that a description can be about."""
    _, (hint, _), named = said
    names = [named] if named else hinted_attributes(hint, site) if hint else qualities(site)
    return [name for name in names if len(_numbers(name, site)) >= _FEWEST_VALUES]


def _numbers(attribute: str, site: Site) -> list[float]:
    """Return the values of an attribute that are numbers, one for each tree, in order."""
    found = (tree.properties.get(attribute) for tree in site.trees)
    return sorted(value for value in found if isinstance(value, float))


def _thresholds(attribute: str, site: Site, among: s.Selector, *, lowest: bool) -> Sequence[float]:
    """Return rounded values below which (or above which) some of the trees are, the fewest first.

    They are those of all trees, unless no tree of a group is beyond them: then they are the group's.
    """
    found = _shares(_numbers(attribute, site), lowest=lowest)
    own = ids_of(among, site) or set()
    there = [tree.properties.get(attribute) for tree in site.trees if tree.place.id in own]
    values = sorted(value for value in there if isinstance(value, float))
    if not values or (values[0] < found[0] if lowest else values[-1] > found[0]):
        return found
    return _shares(values, lowest=lowest)


def _shares(values: list[float], *, lowest: bool) -> list[float]:
    """Return rounded values beyond which some of others are, the fewest first."""
    if not lowest:
        values.reverse()
    rounded = (float(f"{values[round(share * (len(values) - 1))]:.2g}") for share in _SHARES)
    found = [value for value in dict.fromkeys(rounded) if (values[0] < value if lowest else values[0] > value)]
    return found if len(found) > 1 else list(dict.fromkeys(values))[1 : len(_SHARES) + 1]


@construction("place: [DET] rank=SUPER noun=CORNER", cost=0.3, given=("site",))
@construction("place: [DET] rank=SUPER noun=CORNER in_ where=region", cost=0.3, given=("site",))
def corner_by_height(rank: Lex, noun: Lex, site: Site, where: s.Selector = _ANYWHERE) -> list[PlaceMeaning] | None:
    """Compose "the lowest corner": the site's file says which, or it may be each of the four."""
    if rank.value[0] or "steep" not in rank.features or noun.plural or not chooses_from_trees(where):
        return None
    known = [name for hint in _HEIGHTS for name in hinted_attributes(hint, site)]
    if known:
        corners = s.Corners(of=where)
        return [PlaceMeaning(s.Top(attribute=name, count=1, lowest=rank.value[1], of=corners), "one") for name in known]
    return [PlaceMeaning(s.Corners(which=(corner,), of=where), "one") for corner in CORNERS]
