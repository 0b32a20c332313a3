"""Constructions of places named by others before them: "the other half", "its neighbour", "the last of them"."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, Nominal, PlaceMeaning
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_where, chooses_from_trees, is_by_attribute, swapped

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


@construction("place: DET zone=ZONE ONE", cost=0.5)
def one_by_zone(zone: Lex) -> PlaceMeaning:
    """Compose "the pond one", of the places that were named before."""
    return PlaceMeaning(s.InZone(zone=zone.value), "one", like=Likewise("nth"))


@construction("place: like=likewise", cost=0.3)
def likewise(like: Likewise) -> list[PlaceMeaning]:
    """Compose "the southern one" as a place: a single place, or an area."""
    one, area = (PlaceMeaning(s.Trees(), "one", like=like), PlaceMeaning(s.Trees(), "area", like=like))
    return [one, area] if not like.kind else [one] if like.kind == "corner" else [area]


@construction("place: [DET] value=ATTRVAL noun=ONE", "place: each=EACH value=ATTRVAL noun=ONE", cost=0.4)
def those_of_another_value(value: Lex, noun: Lex, each: Lex | None = None) -> list[PlaceMeaning] | None:
    """Compose "the green ones" and "every green one" behind "the yellow trees"."""
    if each is None and not noun.plural and "plural" not in noun.features:
        return None
    like = Likewise("value")
    return [
        PlaceMeaning(s.Where(attribute=name, test="eq", value=text), "several", like=like) for name, text in value.value
    ]


def of_other_value(before: s.Selector, described: s.Selector) -> s.Selector | None:
    """Return trees with another value of the attribute by which those before are described; None if they are not."""
    new = as_where(described)
    parts = [part for part in map(as_where, before.walk()) if part is not None and part.test == "eq"]
    old = [one for one in parts if new is not None and one.attribute == new.attribute and one.value != new.value]
    return swapped(before, old[0], replace(new, of=old[0].of)) if new is not None and len(old) == 1 else None


@construction("place: DET OTHER inner=nominal", cost=0.6)
def other_ones_of_a_kind(inner: Nominal) -> PlaceMeaning | None:
    """Compose "the other basil plants", of which some were named before."""
    if not inner.plural or inner.single or inner.complete or not is_by_attribute(inner.selector):
        return None
    return PlaceMeaning(inner.selector, "several", like=Likewise("rest"))


@construction("place: DET REMAINING inner=nominal", "place: EACH DET REMAINING inner=nominal", cost=0.4)
def remaining_ones(inner: Nominal) -> PlaceMeaning | None:
    """Compose "the remaining tomatoes", of which some were named or done before."""
    if not inner.plural or inner.single or inner.complete:
        return None
    return PlaceMeaning(inner.selector, "several", like=Likewise("rest"))


@construction("place: OTHERS", cost=4.0)
@construction("place: DET OTHER noun=TREE", cost=0.5)
def the_rest(noun: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the others", of trees that were named before."""
    if noun is not None and not noun.plural:
        return None
    return PlaceMeaning(s.Trees(), "several", like=Likewise("rest"))


@construction(
    "place: OTHERS in_ where=region",
    "place: OTHERS OF where=crop_area",
    "place: DET OTHER noun=TREE in_ where=region",
    "place: EACH [DET] OTHER noun=TREE in_ where=region",
    cost=0.3,
)
def rest_of_area(where: s.Selector, noun: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the rest of row 4"."""
    if noun is not None and not noun.plural:
        return None
    return PlaceMeaning(where, "several", like=Likewise("rest"))


@construction("place: OTHERS OF DET ROW", "place: OTHERS OF DET PLOT", "place: OTHERS OFTHEM", cost=0.3)
def rest_of_those() -> PlaceMeaning:
    """Compose "the rest of the row", of the one some of whose trees were named before."""
    return PlaceMeaning(s.Trees(), "several", like=Likewise("rest"))


@construction("place: OTHERS OF [DET] inner=nominal", cost=0.5)
def rest_of_kind(inner: Nominal) -> PlaceMeaning | None:
    """Compose "the rest of the yellow trees"."""
    if inner.single or inner.complete or inner.pronoun:
        return None
    return PlaceMeaning(inner.selector, "several", like=Likewise("rest"))


@construction(
    "place: word=DET rank=ORD noun=ONE",
    "place: word=DET last=LAST noun=ONE",
    "place: DET last=LATTER",
    "place: DET FORMER",
    "place: DET rank=ORD group=of_those",
    "place: DET last=LAST group=of_those",
    cost=0.5,
)
def one_of_those_named(
    rank: Lex | None = None,
    last: Lex | None = None,
    noun: Lex | None = None,
    word: Lex | None = None,
    group: int = 0,
) -> PlaceMeaning | None:
    """Compose "the first one", "the latter" and "the last of these", of places that were named before."""
    if noun is not None and "plural" in noun.features:
        return None
    if word is not None and "indefinite" in word.features:
        return None
    number = -1 if last is not None else 1 if rank is None else rank.value
    return PlaceMeaning(s.Trees(), "one", like=Likewise("nth", number=number, of_number=group))


@construction("of_those: word=THERE", "of_those: OF word=DET", "of_those: OF DET n=count", cost=0.1)
def of_those(word: Lex | None = None, n: int = 0) -> int | None:
    """Compose "of them", "of these" and "of the four": their number, 0 if it is not said."""
    return n if word is None or not word.features.isdisjoint({"of_several", "those"}) else None


@construction("owned_by: ITS", cost=0.2)
def its() -> PlaceMeaning:
    """Compose "its", of the place spoken of last."""
    return PlaceMeaning(s.Here(), "here")


@construction(
    "place: [DET] [n=count] noun=TREE EACHSIDE [OF] [to=place]",
    "place: [DET] [n=count] noun=NEIGHBOUR EACHSIDE [OF] [to=place]",
    "place: DET noun=ONE EACHSIDE OF to=place",
    "place: DET noun=ONE EACHSIDE to=here",
    "place: DET [n=count] noun=TREE DIRECTLY BOTHWAYS to=place",
    "place: DET noun=ONE DIRECTLY BOTHWAYS to=place",
    "place: DET [n=count] noun=TREE DIRECTLY BOTHWAYS it=IT",
    "place: DET noun=ONE DIRECTLY BOTHWAYS it=IT",
    cost=0.2,
)
def on_each_side(
    n: int = 2, to: PlaceMeaning | None = None, noun: Lex | None = None, it: Lex | None = None
) -> PlaceMeaning | None:
    """Compose "the trees on either side of it" and "the one before and after it": the next of its row to each side."""
    del it
    if n != 2 or (to is not None and to.shape not in ("one", "here")):
        return None
    origin = s.Here() if to is None else to.selector
    sides = tuple(s.AlongRow(trees=1, towards=towards, origin=origin) for towards in ("down", "up"))
    each = noun is not None and not noun.plural and "plural" not in noun.features
    return PlaceMeaning(s.UnionOf(parts=sides), "several", count=2, each=each)


@construction("place: [DET] inner=nominal [which_is] ASFAR FROM to=place as_can", cost=0.2)
def as_far_from_it(inner: Nominal, to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the tree that is as far away from it as possible"."""
    if inner.single or inner.plural or inner.complete or to.shape not in ("one", "here"):
        return None
    return PlaceMeaning(s.Farthest(origin=to.selector, of=inner.selector), "one", beside=to.shape == "here")


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
