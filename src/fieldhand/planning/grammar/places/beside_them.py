"""Constructions of the neighbours of several plants: "and of the plants on either side of them"."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.flags import is_so, such
from fieldhand.planning.grammar.places.nouns import attribute_is, that_pass
from fieldhand.planning.grammar.places.numbered import all_of, ids_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Maximum number of plants whose neighbours are named one by one.
_MOST = 40


@construction(
    "beside_them: [DET] noun=TREE [DIRECTLY] EACHSIDE THERE",
    "beside_them: [DET] noun=TREE [DIRECTLY] EACHSIDE OF IT",
    "beside_them: [DET] noun=TREE [DIRECTLY] NEXTTO IT",
    "beside_them: [DET] noun=TREE [DIRECTLY] BESIDE IT",
    "beside_them: ITS [n=count] noun=NEIGHBOUR",
    "beside_them: [DET] [n=count] noun=NEIGHBOUR OF EACH [ONE]",
    "beside_them: EACH ITS noun=NEIGHBOUR",
    "beside_them: THEIR n=count noun=NEIGHBOUR",
    "beside_them: [DET] noun=TREE EACHSIDE OF EACH [ONE]",
    "beside_them: [DET] noun=TREE EACHSIDE OF DET",
    "beside_them: [DET] noun=NEIGHBOUR EACHSIDE",
    "beside_them: [DET] noun=NEIGHBOUR EACHSIDE THERE",
    "beside_them: [DET] noun=ONE EACHSIDE THERE",
    "beside_them: [DET] noun=ONE EACHSIDE OF EACH",
    "beside_them: THEIR noun=NEIGHBOUR",
    "beside_them: EACH ITS noun=NEIGHBOUR",
    "beside_them: EACH THEIR noun=NEIGHBOUR",
    "beside_them: ITS noun=NEIGHBOUR",
    "beside_them: ITS count noun=NEIGHBOUR",
    "beside_them: [DET] noun=NEIGHBOUR OF EACH [ONE]",
    "beside_them: [DET] noun=NEIGHBOUR OF IT",
    "beside_them: [DET] noun=TREE NEXTTO IT",
    "beside_them: [DET] noun=TREE NEXTTO word=DET",
    "beside_them: [DET] noun=TREE NEXTTO EACH [ONE]",
    "beside_them: [DET] noun=ONE NEXTTO word=DET",
    "beside_them: [DET] noun=ONE NEXTTO IT",
    cost=0.1,
)
def beside_them(noun: Lex, n: int = 2, word: Lex | None = None) -> str | None:
    """Compose "the plants on either side of them" and "its neighbours"."""
    if n != 2 or (word is not None and "those" not in word.features and word.text != "them"):
        return None
    return "beside" if noun.plural or "plural" in noun.features or noun.text == "one" else None


@construction(
    "beside_them: [DET] TREE [DIRECTLY] EACHSIDE THERE", "beside_them: [DET] TREE [DIRECTLY] EACHSIDE OF IT",
    "beside_them: [DET] TREE [DIRECTLY] EACHSIDE OF EACH [ONE]", "beside_them: [DET] NEIGHBOUR EACHSIDE [THERE]",
    "beside_them: [DET] ONE EACHSIDE OF IT", cost=0.2,
)  # fmt: skip
def one_on_each_side() -> str:
    """Compose "the plant on each side of it"."""
    return "beside"


@construction("beside_them: beside_them in_ DET ROW", "beside_them: beside_them in_ DET SAME ROW", cost=0.0)
def beside_them_in_the_row() -> str:
    """Compose "its direct neighbours in the row"."""
    return "beside"


@construction(
    "place: whole=place [COMMA] AND beside_them", "place: whole=place AND OF beside_them",
    "place: whole=place AND AT beside_them", "place: whole=place TOGETHERWITH beside_them",
    "place: whole=place AND ALSO OF beside_them", "place: whole=place AND ALSO beside_them",
    cost=0.1, given=("site",),
)  # fmt: skip
def with_those_beside(whole: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Compose "the cucumbers with mildew and the plants on either side of them", each of them once."""
    if whole.shape != "several" or whole.per is not None or whole.optional or whole.at_most is not None:
        return None
    plants = ids_of(whole.selector, site)
    if not plants or len(plants) > _MOST or not plants <= set(site.by_id):
        return None
    beside = [name for name in _next_in_row(plants, site) if name not in plants]
    parts = tuple(s.TreeIs(tree=name) for name in beside)
    return PlaceMeaning(s.UnionOf(parts=(*whole.selector.members, *parts)), "several") if parts else None


@construction("such_group: [DET] flag=FLAG ONE", "such_group: [DET] value=ATTRVAL ONE", cost=0.1)
def such_group(flag: Lex | None = None, value: Lex | None = None) -> list[s.Selector]:
    """Compose "the sick ones" behind "beside"."""
    tests = is_so(flag) if flag is not None else [] if value is None else attribute_is(value)
    return [that_pass(test, s.Trees()) for test in tests]


@construction("beside_group: NEXTTO", "beside_group: BESIDE", "beside_group: EACHSIDE OF", cost=0.0)
def beside_group() -> str:
    """Compose "next to" and "on either side of"."""
    return "beside"


@construction(
    "place: [DET] inner=nominal [which_is] [DIRECTLY] beside_group of=place",
    "place: [DET] inner=nominal [which_is] [DIRECTLY] beside_group group=such_group",
    "place: [DET] [flag=FLAG] noun=NEIGHBOUR OF of=place",
    cost=0.4, given=("site",),
)  # fmt: skip
def beside_each_of_them(
    site: Site,
    of: PlaceMeaning | None = None,
    group: s.Selector | None = None,
    inner: Nominal | None = None,
    noun: Lex | None = None,
    flag: Lex | None = None,
) -> list[PlaceMeaning] | None:
    """Compose "the plants next to the ones with mildew": with those of them that stand side by side, or without?"""
    if group is not None:
        of = PlaceMeaning(group, "several")
    if (
        of is None
        or of.shape != "several"
        or of.per is not None
        or of.optional
        or of.at_most is not None
        or of.refers_back
    ):
        return None
    if inner is None:
        all_plants = Nominal(s.Trees(), plural=noun is not None and "plural" in noun.features)
        such_plants = [all_plants] if flag is None else such(flag, all_plants) or []
        return [way for one in such_plants for way in beside_each_of_them(site, of, inner=one) or ()] or None
    if not inner.plural or inner.single or inner.complete or inner.kind != "tree":
        return None
    plants, fitting = ids_of(of.selector, site), ids_of(inner.selector, site)
    if not plants or not fitting or not 1 < len(plants) <= _MOST or not plants <= set(site.by_id):
        return None
    beside = [name for name in _next_in_row(plants, site) if name in fitting]
    if all(one.named_tree for one in of.selector.members):
        return [_each_side(of.selector)] if len(beside) == 2 * len(plants) and not plants & set(beside) else None
    others = [name for name in beside if name not in plants]
    return [_these(names) for names in dict.fromkeys((tuple(others), tuple(beside)))] if others else None


def _each_side(trees: s.Selector) -> PlaceMeaning:
    """Return the next plant of its row to each side of each of some plants."""
    ways: tuple[Literal["down", "up"], ...] = ("down", "up")
    sides = tuple(s.AlongRow(trees=1, towards=to, origin=tree) for tree in trees.members for to in ways)
    return PlaceMeaning(s.UnionOf(parts=sides), "several", count=len(sides))


def _these(names: Sequence[str]) -> PlaceMeaning:
    """Return plants by their ids."""
    parts = [s.TreeIs(tree=name) for name in names]
    return PlaceMeaning(all_of(parts), "several" if len(parts) > 1 else "one")


@construction(
    "nearest_to_each: [ALSO] [OF] DET NEAREST inner=nominal", "nearest_to_each: [ALSO] AT DET NEAREST inner=nominal",
    "nearest_to_each: [ALSO] [OF] DET NEAREST inner=nominal BESIDE IT",
    "nearest_to_each: [ALSO] [OF] DET NEAREST inner=nominal NEXTTO IT",
    "nearest_to_each: [ALSO] [OF] DET NEAREST inner=nominal AT IT", cost=0.1,
)  # fmt: skip
def nearest_to_each(inner: Nominal) -> s.Selector | None:
    """Compose "the nearest healthy plant beside it"."""
    return None if inner.plural or inner.single or inner.complete or inner.vague else inner.selector


@construction(
    "next_to_each: [ALSO] [OF] DET inner=nominal [DIRECTLY] NEXTTO IT",
    "next_to_each: [ALSO] [OF] DET inner=nominal [DIRECTLY] BESIDE IT",
    "next_to_each: [ALSO] AT DET inner=nominal [DIRECTLY] NEXTTO IT",
    "next_to_each: [ALSO] [OF] n=count inner=nominal [DIRECTLY] NEXTTO IT",
    "next_to_each: [ALSO] [OF] n=count inner=nominal [DIRECTLY] BESIDE IT", cost=0.1,
)  # fmt: skip
def next_to_each(inner: Nominal, n: int = 1) -> s.Selector | None:
    """Compose "a healthy cucumber next to it"."""
    return nearest_to_each(inner) if n == 1 else None


@construction(
    "next_to_each: [ALSO] [OF] DET flag=FLAG noun=NEIGHBOUR [OF] [IT]",
    "next_to_each: [ALSO] [OF] n=count flag=FLAG noun=NEIGHBOUR",
    "next_to_each: [ALSO] [OF] ITS flag=FLAG noun=NEIGHBOUR", cost=0.1,
)  # fmt: skip
def such_neighbour_of_each(flag: Lex, noun: Lex, n: int = 1) -> list[s.Selector] | None:
    """Compose "a healthy neighbour"."""
    if n != 1 or noun.plural or "plural" in noun.features:
        return None
    return [inner.selector for inner in such(flag, Nominal(s.Trees())) or ()] or None


@construction(
    "place: whole=place [COMMA] AND beside=next_to_each", "place: whole=place TOGETHERWITH beside=next_to_each",
    "place: whole=place [COMMA] AND near=nearest_to_each", "place: whole=place TOGETHERWITH near=nearest_to_each",
    cost=0.1, given=("site",),
)  # fmt: skip
def with_nearest_to_each(
    whole: PlaceMeaning, site: Site, near: s.Selector | None = None, beside: s.Selector | None = None
) -> PlaceMeaning | None:
    """Compose "each cucumber with mildew and the nearest healthy plant beside it", each of them once.

    Where none of the kind stands next to one of them, "next to it" is none.
    """
    if whole.shape != "several" or not whole.each or whole.per is not None or whole.optional:
        return None
    plants = ids_of(whole.selector, site)
    if not plants or len(plants) > _MOST or not plants <= set(site.by_id):
        return None
    found: list[str] = []
    for plant in sorted(plants, key=lambda name: site.by_id[name].index):
        there = ids_of(s.Nearest(to=s.TreeIs(tree=plant), adjacent=True, of=near or beside or s.Trees()), site)
        if not there or (beside is not None and not there & {*_next_in_row({plant}, site)}):
            return None
        found += [name for name in there if name not in plants and name not in found]
    parts = tuple(s.TreeIs(tree=name) for name in found)
    return PlaceMeaning(s.UnionOf(parts=(*whole.selector.members, *parts)), "several") if parts else None


def _next_in_row(plants: set[str], site: Site) -> list[str]:
    """Return the ids of the plants next to others in their rows, in the order of the rows."""
    found: list[str] = []
    for row in site.planting.rows:
        names = [site.trees[tree].place.id for tree in row.trees]
        near = {k + step for k, name in enumerate(names) if name in plants for step in (-1, 1)}
        found += [names[k] for k in sorted(near) if 0 <= k < len(names)]
    return found
