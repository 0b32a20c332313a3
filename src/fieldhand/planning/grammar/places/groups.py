"""Constructions of groups: how many of the places that a noun describes, exceptions, lists, and pronouns."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning, Shape
from fieldhand.planning.grammar.places.numbered import are_two, ids_of
from fieldhand.planning.grammar.places.quantities import article, quantified, unquantified
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    AREAS,
    as_in_row,
    as_quota,
    as_random,
    as_some,
    as_top,
    as_where,
    chooses_from_trees,
    is_by_attribute,
    is_description,
    is_drawn,
    is_end_of_site,
    landmark_of,
    leaves_out,
    measures_distance,
    named_places,
    of_each,
    over,
    picked_from,
    replaceable_area,
    specifies_part,
    swapped,
)
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Maximum number of kinds that are visited one after the other ("of each variety").
_MOST_KINDS = 12
_ANY_TREES = s.Trees()


@construction("owned_by: [word=DET] inner=owner", cost=0.3, given=("site",))
def owned_by(inner: Nominal, site: Site, word: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the first tree's"."""
    if word is not None and word.features.isdisjoint({"definite", "indefinite"}):
        return None
    if word is None:
        return unquantified(inner)
    places = quantified(article(word), inner, site) if inner.single or "indefinite" in word.features else None
    return places[0] if places else that_tree(word)


@construction("place: some=place COMMA DET exact=nominal", cost=0.2)
def namely(some: PlaceMeaning, exact: Nominal) -> PlaceMeaning | None:
    """Compose "another tree, the farthest one from there"."""
    vague = some.shape == "one" and as_some(some.selector) is not None
    return PlaceMeaning(exact.selector, "one") if vague and exact.single and exact.pronoun else None


@construction("place: some=place COMMA INEACHCASE exact=place", "place: some=place INEACHCASE exact=place", cost=0.2)
def in_each_case(some: PlaceMeaning, exact: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "one Merlot and one Syrah vine, in each case the one closest to the barn"."""
    ones = [as_some(part) for part in some.selector.members]
    if exact.shape != "one" or not specifies_part(exact.selector) or exact.refers_back:
        return None
    if (len(ones) < 2 and some.per is None) or some.shape not in ("one", "several"):
        return None
    if any(one is None or one.count != 1 for one in ones):
        return None
    parts = tuple(over(exact.selector, one.of) for one in ones if one is not None)
    return replace(some, selector=parts[0] if len(parts) == 1 else s.UnionOf(parts=parts))


@construction("place: [DET] rank=ORD n=count inner=nominal", cost=1.2)
def first_trees(rank: Lex, n: int, inner: Nominal) -> PlaceMeaning | None:
    """Compose "the first three trees"."""
    if rank.value != 1 or n < 2 or inner.single or inner.selector != s.Trees():
        return None
    return PlaceMeaning(s.Nearest(to=s.Marker(name="start"), count=n), "several", count=n)


@construction("place: n=count POINT SPREAD [DET] zone=ZONE", cost=0.2)
def points_over(n: int, zone: Lex) -> PlaceMeaning:
    """Compose "five points spread across the wet corner"."""
    return PlaceMeaning(s.PointsIn(zone=zone.value, count=n), "several", count=n)


@construction("place: EACH [OF] DET n=count TREE", cost=0.8)
def each_of_those_trees(n: int) -> PlaceMeaning | None:
    """Compose "each of the five trees", of places that were named before; the check of the plan compares the number."""
    if n < 2:
        return None
    return PlaceMeaning(s.Trees(), "those", each=True)


@construction("place: SOMEWHERE [in_] where=region", cost=0.2)
def somewhere(where: s.Selector) -> PlaceMeaning:
    """Compose "somewhere in row 3"."""
    return PlaceMeaning(s.Take(count=1, of=where), "one")


@construction("place: one=place ITSELF", cost=0.1)
def tree_itself(one: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "tree 40 itself"."""
    return one if one.shape == "one" and one.selector.named_tree else None


@construction(
    "as_can: ASCAN",
    "as_can: ASFIT",
    "as_can: ASCAN ACTV",
    "as_can: ASCAN TAKE",
    "as_can: ASCAN MEASURE",
    "as_can: ASCAN VISIT",
    "as_can: ASCAN GO [AT]",
    "as_can: AS means ALLOW [IT]",
    "as_can: AS FITS AT means",
    cost=0.0,
)
def as_can() -> str:
    """Compose "as you can get to" and "as the battery allows"."""
    return "as possible"


@construction("place_list: first=place COMMA second=place", "place_list: first=place_list COMMA second=place", cost=0.4)
def listed_places(first: PlaceMeaning, second: PlaceMeaning) -> PlaceMeaning | list[PlaceMeaning] | None:
    """Compose "tree 12, tree 15"."""
    return both(first, second)


@construction(
    "place: first=place_list [COMMA] AND second=place",
    "place: first=place AND second=place",
    cost=0.4,
)
def both(first: PlaceMeaning, second: PlaceMeaning) -> PlaceMeaning | list[PlaceMeaning] | None:
    """Compose "tree 12 and the charger"."""
    named = first.like is None or _is_named_best(first)
    if first.per is not None or second.per is not None or not named:
        return None
    if second.like is not None and second.like.kind == "those":
        second = replace(second, selector=_of_the_kind(first.selector, second.selector), like=None)
    if first.like is not None and _is_named_best(first):
        first = replace(first, like=None)
    if second.like is not None and second.like.kind == "extreme":
        second = replace(second, like=None)
    if _is_named_best(second):
        best = cast(s.Top, second.selector)
        known = as_top(first.selector)  # "the oldest Carmel and the youngest": of these
        of = known.of if known is not None and best.attribute == known.attribute else best.of
        second = replace(second, selector=replace(best, of=of), like=None)
    if second.like is not None:
        if (opposite := _other_end(first.selector, second.selector)) is None:
            return None
        second = replace(second, selector=opposite, like=None)
    if second.selector.named_marker and measures_distance(first.selector):
        return None  # "within 20 m of the start and the charger"
    beside = first.beside and second.beside  # "the tree north of it and the tree south of it": of the same tree
    if not beside and first.shape == "one" and second.shape in ("one", "step", "several"):
        here = landmark_of(first.selector, second.selector) or first.selector
        shape: Shape = "several" if second.shape == "several" else "one"
        second = replace(second, selector=swapped(second.selector, s.Here(), here), shape=shape, beside=False)
    elif not beside and first.shape == "several" and s.Here() in second.selector.walk():
        return None  # "trees 4 and 5 and the tree next to it": next to which?
    if not {first.shape, second.shape} <= {"one", "several"} or first.optional or second.optional:
        return None
    if first.at_most or second.at_most or leaves_out(first.selector):
        return None  # "all trees except tree 4 and tree 7": both are left out
    parts = tuple(part for one in (first, second) for part in one.selector.members)
    counts = [1 if one.shape == "one" else one.count for one in (first, second)]
    count = None if None in counts else sum(c for c in counts if c is not None)
    whole = PlaceMeaning(s.UnionOf(parts=parts), "several", count=count, beside=first.beside)
    counted = next((one for part in parts if (one := as_in_row(part)) is not None), None)
    drawn = tuple(_drawn(part) for part in parts) if is_drawn(parts[-1]) else parts
    if drawn != parts:  # "ten old and ten young trees at random": the ten old ones, too?
        return [replace(whole, selector=s.UnionOf(parts=drawn)), whole]
    if counted is None or not any(is_end_of_site(part) for part in parts):
        return whole
    # "The first tree and the last tree of row 4": is the first that of the row, too?
    in_row = tuple(over(part, counted.of) if is_end_of_site(part) else part for part in parts)
    return [whole, replace(whole, selector=s.UnionOf(parts=in_row))]


@construction("of_such: [DET] [n=count] [random=RANDOM] flag=FLAG", cost=0.0)
def of_such(flag: Lex, n: int | None = None, random: Lex | None = None) -> list[PlaceMeaning]:
    """Compose "six grafted" before "and six ungrafted Sungold plants"."""
    kinds = [s.Where(attribute=name, test="eq", value=value) for name, value in flag.value]
    if n is None:
        return [PlaceMeaning(kind, "several") for kind in kinds]
    chosen = [s.Take(count=n, of=kind) if random is None else s.RandomSample(count=n, of=kind) for kind in kinds]
    return [PlaceMeaning(one, "one" if n == 1 else "several", count=n if n > 1 else None) for one in chosen]


@construction("place: first=of_such AND second=place", "place: first=of_such AND [AT] second=place", cost=0.1)
def such_and_such(first: PlaceMeaning, second: PlaceMeaning) -> PlaceMeaning | list[PlaceMeaning] | None:
    """Compose "six grafted and six ungrafted Sungold plants": both are Sungold."""
    such = next(part for part in map(as_where, first.selector.walk()) if part is not None)
    other = [part for part in map(as_where, second.selector.walk()) if part and part.attribute == such.attribute]
    if len(other) != 1 or len(second.selector.members) > 1 or other[0].value == such.value:
        return None
    some = as_some(second.selector) or as_random(second.selector)
    described = second.selector if some is None else some.of
    kind = swapped(described, other[0], other[0].of)
    if kind == s.Trees() or not is_description(described):
        return None
    return both(replace(first, selector=over(first.selector, kind)), second)


@construction("place: first=place AND [AT] n=count word=WITHOUT", cost=0.1)
@construction("place: first=place AND [AT] n=count word=WITHOUT IT", cost=0.1)
def and_some_without(first: PlaceMeaning, n: int, word: Lex) -> PlaceMeaning | None:
    """Compose "four plants with mildew and four without"."""
    some = as_some(first.selector) or as_random(first.selector)
    flags = [one for one in map(as_where, first.selector.walk()) if one is not None and isinstance(one.value, bool)]
    if "leaves_out" not in word.features or some is None or len(flags) != 1:
        return None
    others = swapped(some.of, flags[0], replace(flags[0], value=not flags[0].value))
    parts = (first.selector, replace(some, count=n, of=others))
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=some.count + n)


@construction("place: NOTONLY first=place [COMMA] BUTALSO second=place", cost=0.1)
def not_only_but_also(first: PlaceMeaning, second: PlaceMeaning) -> PlaceMeaning | list[PlaceMeaning] | None:
    """Compose "not only the leeks but also the onions"."""
    return both(first, second)


@construction("place: first=place AND [OF] ASMANY inner=nominal", cost=0.0)
def and_as_many(first: PlaceMeaning, inner: Nominal) -> PlaceMeaning | list[PlaceMeaning] | None:
    """Compose "five leeks and as many onions"."""
    chosen = as_some(first.selector) or as_random(first.selector)
    if chosen is None or first.per is not None or inner.single or inner.complete or not inner.counts(chosen.count):
        return None
    others = replace(chosen, of=inner.selector)
    return both(first, PlaceMeaning(others, "several", count=chosen.count))


@construction("place: word=EACH whole=place", cost=0.1)
def both_of_two(word: Lex, whole: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "both the trough and the mast"."""
    two = "two" in word.features and word.text == "both" and len(named_places(whole.selector)) == 2
    return replace(whole, each=True) if two and whole.per is None and whole.shape in ("several", "area") else None


def _is_named_best(place: PlaceMeaning) -> bool:
    """Return True for "the oldest", which may be one of those named before it."""
    best = as_top(place.selector)
    return place.like is not None and place.like.kind == "ranked" and best is not None and bool(best.attribute)


def _of_the_kind(first: s.Selector, second: s.Selector) -> s.Selector:
    """Return "those in row 5" and "the one farthest from it" as trees of the kind before them."""
    if isinstance(second, AREAS):
        return kind_in_area(first, second)
    group = None if is_by_attribute(second) else picked_from(first)  # "the Carmels, and those with mildew"
    return second if group is None else over(second, group)


def _drawn(selector: s.Selector) -> s.Selector:
    """Return so many trees, whichever these are, as trees that are drawn at random."""
    some = as_some(selector)
    return selector if some is None else s.RandomSample(count=some.count, of=some.of)


def kind_in_area(first: s.Selector, area: s.Selector) -> s.Selector:
    """Return the trees of an area that fit the description of others: "those in row 5" behind "the yellow trees"."""
    if not is_description(first):
        return area
    before = replaceable_area(first, area)
    return over(first, area) if before is None else swapped(first, before, area)


def _other_end(first: s.Selector, second: s.Selector) -> s.Selector | None:
    """Return the trees at the other end of a ranking: "the five youngest" behind "the five oldest trees of row 3"."""
    best, worst = as_top(first), as_top(second)
    if best is None or worst is None or best.lowest == worst.lowest or worst.attribute not in ("", best.attribute):
        return None
    return replace(worst, attribute=best.attribute, of=best.of)


@construction("place: first=place COMMA word=DET OTHER ONE", cost=0.2)
def said_again(first: PlaceMeaning, word: Lex) -> PlaceMeaning | None:
    """Compose "another tree, a different one"."""
    some = as_some(first.selector)
    if "indefinite" not in word.features or first.shape != "one" or some is None or some.of != s.NotVisited():
        return None
    return first


@construction("place: INEACH", cost=0.9)
def each_of_those() -> PlaceMeaning:
    """Compose "in each of them"."""
    return PlaceMeaning(s.Here(), "those", each=True)


@construction("place: word=THERE", cost=0.2)
def there(word: Lex) -> PlaceMeaning:
    """Compose "at that tree"."""
    several = "of_several" in word.features
    return PlaceMeaning(
        s.Trees() if several and "of_trees" in word.features else s.Here(),
        "those" if several else "here",
        each="of_each" in word.features,
    )


@construction("place: word=DET", cost=1.0)
def those(word: Lex) -> PlaceMeaning | None:
    """Compose "those"."""
    return PlaceMeaning(s.Here(), "those") if "those" in word.features else None


@construction(
    "place: word=DET [n=count] noun=those_noun", "place: word=DET n=count",
    "place: EACH [OF] word=DET [n=count] noun=those_noun", "place: EACH [OF] word=DET n=count",
    "place: DET SAME n=count [noun=those_noun]", "place: EACH [OF] DET SAME [n=count] noun=those_noun",
    "place: DET SAME noun=those_noun",
    cost=0.3,
)  # fmt: skip
def those_named(word: Lex | None = None, n: int | None = None, noun: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "those five plants" and "the same spots", of so many that were named before."""
    if n == 1 or (word is not None and "those" not in word.features):
        return None
    return PlaceMeaning(noun or s.Trees(), "those", count=n, each=True)


@construction("those_noun: noun=POINT", "those_noun: noun=SAMPLINGPOINT", cost=0.0)
def those_spots(noun: Lex) -> s.Selector | None:
    """Compose "spots" of "the same spots"."""
    return s.Here() if noun.text.endswith("s") else None


@construction("those_noun: noun=ONE", cost=0.0)
def those_ones(noun: Lex) -> s.Selector | None:
    """Compose "ones" of "the same ones"."""
    return s.Here() if "plural" in noun.features else None


@construction("those_noun: inner=nominal", cost=0.0)
def those_plants(inner: Nominal) -> s.Selector | None:
    """Compose "leeks" of "those four leeks", which have to be those that were named before."""
    if not inner.plural or inner.single or inner.complete or inner.pronoun or inner.kind != "tree":
        return None
    return inner.selector if inner.selector == s.Trees() or is_by_attribute(inner.selector) else None


@construction("place: DET SAME noun=TREE", "place: DET SAME noun=ONE", "place: DET SAME noun=POINT", cost=0.3)
def the_same(noun: Lex) -> PlaceMeaning:
    """Compose "the same trees"."""
    several = noun.plural or "plural" in noun.features
    return PlaceMeaning(s.Here(), "those") if several else PlaceMeaning(s.Here(), "here", one_tree=True)


@construction("place: word=IT", cost=0.3)
def it(word: Lex) -> PlaceMeaning:
    """Compose "it"."""
    return PlaceMeaning(s.Here(), "those" if "of_several" in word.features else "here")


@construction("place: word=EACH OF place=place", "place: word=EACH place=place", cost=0.4, given=("site",))
def each_of_group(word: Lex, place: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Compose "each of the 5 oldest trees"."""
    if "all_of" in word.features or place.shape != "several" or place.each or as_some(place.selector) is not None:
        return None
    if "every" in word.features or ("two" in word.features and place.count not in (None, 2)):
        return None
    if "two" in word.features and not are_two(place.selector, site):
        return None  # "both trees", of two that were named
    if place.optional or place.at_most is not None or place.per is not None:
        return None
    return replace(place, each=True)


@construction("place: ANY n=count", cost=0.9)
def any_of_those(n: int) -> PlaceMeaning:
    """Compose "any two", of places that were named before."""
    return PlaceMeaning(s.Here(), "those", count=n)


@construction("place: word=DET TREE [same=ITSELF]", cost=0.7)
def that_tree(word: Lex, same: Lex | None = None) -> PlaceMeaning | None:
    """Compose "that tree" and "the tree itself"."""
    if "definite" not in word.features:
        return None
    return PlaceMeaning(s.Here(), "here", itself=same is not None, one_tree=True)


@construction("place: n=count OFTHEM", "place: n=count OF word=DET", "place: n=count THERE", cost=0.5)
def so_many_of_those(n: int, word: Lex | None = None) -> PlaceMeaning | None:
    """Compose "3 of them"."""
    if word is not None and "those" not in word.features:
        return None
    return PlaceMeaning(s.Here(), "those", count=n)


@construction("place: UPTO n=count OFTHEM", "place: UPTO n=count THERE", "place: UPTO n=count OF word=DET", cost=0.5)
def up_to_so_many_of_those(n: int, word: Lex | None = None) -> PlaceMeaning | None:
    """Compose "up to 3 of them"."""
    those = so_many_of_those(n, word)
    return None if those is None else replace(those, count=None, at_most=n)


@construction("place: whole=place word=THERE", "place: whole=place OF it=IT", cost=0.4)
def of_them_there(whole: PlaceMeaning, word: Lex | None = None, it: Lex | None = None) -> PlaceMeaning | None:
    """Compose "every tree there" and "the trees of it"."""
    if (word is not None and "in_area" not in word.features) or (it is not None and "of_several" in it.features):
        return None
    if whole.shape != "several" or whole.per is not None:
        return None
    inside = word is not None and "inside" in word.features
    return replace(whole, there=True, inside=inside) if chooses_from_trees(whole.selector) else None


@dataclass(frozen=True, slots=True)
class EachKind:
    """Each of the kinds of trees that an attribute tells apart.

    Attributes:
        kind: The attribute.
        several: Number of kinds, if the phrase gives it (otherwise 0).
        of: Trees of which they are kinds.
    """

    kind: Lex
    several: int = 0
    of: s.Selector = _ANY_TREES


@construction("each_kind: EACH kind=ATTR", "each_kind: EACH crop=ATTRVAL kind=ATTR", cost=0.0)
@construction("per_kind: PER kind=ATTR", "per_kind: PER crop=ATTRVAL kind=ATTR", cost=0.0)
def each_kind(kind: Lex, crop: Lex | None = None) -> list[EachKind]:
    """Compose "each variety" and "each tomato cultivar"."""
    if crop is None:
        return [EachKind(kind)]
    crops = [(name, value) for name, value in crop.value if name not in kind.value]
    return [EachKind(kind, of=s.Where(attribute=name, test="eq", value=value)) for name, value in crops]


@construction(
    "each_kind: EACH [OF] [DET] n=count kind=ATTR",
    "each_kind: INEACH [OF] [DET] n=count kind=ATTR",
    cost=0.0,
)
def each_of_kinds(n: int, kind: Lex) -> EachKind:
    """Compose "each of the two varieties"."""
    return EachKind(kind, n)


@construction(
    "per_kind: OF kinds=each_kind", "per_kind: FOR kinds=each_kind", "per_kind: FROM kinds=each_kind",
    "per_kind: AT kinds=each_kind",
    cost=0.0,
)  # fmt: skip
def of_every_kind(kinds: EachKind) -> EachKind:
    """Compose "from each variety"."""
    return kinds


@construction("place: some=place OF kinds=each_kind", cost=0.3, given=("site",))
def best_of_each_kind(some: PlaceMeaning, kinds: EachKind, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the three oldest trees of each variety"."""
    best = as_top(some.selector)
    return None if best is None or best.of != s.Trees() else of_each_kind(best, kinds, site)


@construction(
    "place: n=count [random=RANDOM] inner=nominal kinds=per_kind",
    "place: n=count inner=nominal kinds=per_kind in_ where=region",
    cost=0.2,
    given=("site",),
)
def so_many_of_each_kind(
    n: int,
    inner: Nominal,
    site: Site,
    kinds: EachKind,
    where: s.Selector | None = None,
    random: Lex | None = None,
) -> list[PlaceMeaning] | None:
    """Compose "5 vines per variety": so many of each of the kinds that the site records."""
    if inner.single or inner.complete or inner.pronoun:
        return None
    of = inner.selector if where is None else over(inner.selector, where)
    chosen = s.Take(count=n, of=of) if random is None else s.RandomSample(count=n, of=of)
    return of_each_kind(chosen, kinds, site)


@construction("place: n=count kinds=per_kind", cost=0.3, given=("site",))
def so_many_of_every_kind(n: int, kinds: EachKind, site: Site) -> list[PlaceMeaning] | None:
    """Compose "two of each crop"."""
    return of_each_kind(s.Take(count=n, of=s.Trees()), kinds, site)


@construction("kind_list: kinds=place", cost=0.0)
def named_kinds(kinds: PlaceMeaning) -> tuple[s.Selector, ...] | None:
    """Compose "the tomatoes", the beginning of "the tomatoes, the cucumbers"."""
    parts = kinds.selector.members
    plain = kinds.shape == "several" and kinds.count is None and kinds.per is None and not kinds.optional
    described = all(is_description(part) and as_where(part) is not None for part in parts)
    return parts if plain and described else None


@construction(
    "kind_list: first=kind_list COMMA last=kind_list", "kind_list: first=kind_list [COMMA] AND last=kind_list", cost=0.0
)
def longer_kind_list(first: tuple[s.Selector, ...], last: tuple[s.Selector, ...]) -> tuple[s.Selector, ...] | None:
    """Compose "the tomatoes, the cucumbers"."""
    return None if {*first} & {*last} else (*first, *last)


@construction(
    "place: n=count APIECE OF kinds=kind_list",
    "place: n=count INEACH COMMA kinds=kind_list",
    "place: n=count OF EACH COMMA kinds=kind_list",
    cost=0.0,
)
def so_many_of_named_kinds(n: int, kinds: tuple[s.Selector, ...]) -> PlaceMeaning | None:
    """Compose "two each of the tomatoes and the cucumbers" and "two of each: tomatoes, cucumbers"."""
    some = tuple(s.Take(count=n, of=part) for part in kinds)
    return PlaceMeaning(s.UnionOf(parts=some), "several", count=n * len(some)) if len(some) > 1 else None


def of_each_kind(chosen: s.Selector, kinds: EachKind, site: Site) -> list[PlaceMeaning] | None:
    """Return what a selector chooses, of each of the kinds that the site records.

    Args:
        chosen: Some trees of a description.
        kinds: The kinds.
        site: The site.
    """
    some = as_some(chosen) or as_random(chosen) or as_top(chosen) or as_quota(chosen)
    if some is None:
        return None
    if kinds.of != _ANY_TREES:
        some = replace(some, of=over(some.of, kinds.of))
    kind, several = kinds.kind, kinds.several
    if kind.plural != (several > 0):
        return None
    made: list[PlaceMeaning] = []
    for attribute in kind.value:
        values = [value for value in site.attributes.get(attribute, ()) if isinstance(value, str)]
        if 1 < len(values) <= _MOST_KINDS and several in (0, len(values)):
            described = [s.Where(attribute=attribute, test="eq", value=value, of=some.of) for value in values]
            parts = tuple(replace(some, of=part) for part in described if ids_of(part, site))
            quota = of_each(some, attribute, s.Trees())
            if parts:
                made.append(PlaceMeaning(quota or s.UnionOf(parts=parts), "several", each=True))
    return made or None
