"""Constructions of the neighbours of several plants: "and of the plants on either side of them"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.numbered import ids_of
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
    "place: whole=place [COMMA] AND near=nearest_to_each", "place: whole=place TOGETHERWITH near=nearest_to_each",
    cost=0.1, given=("site",),
)  # fmt: skip
def with_nearest_to_each(whole: PlaceMeaning, near: s.Selector, site: Site) -> PlaceMeaning | None:
    """Compose "each cucumber with mildew and the nearest healthy plant beside it", each of them once."""
    if whole.shape != "several" or not whole.each or whole.per is not None or whole.optional:
        return None
    plants = ids_of(whole.selector, site)
    if not plants or len(plants) > _MOST or not plants <= set(site.by_id):
        return None
    found: list[str] = []
    for plant in sorted(plants, key=lambda name: site.by_id[name].index):
        there = ids_of(s.Nearest(to=s.TreeIs(tree=plant), adjacent=True, of=near), site)
        if not there:
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
