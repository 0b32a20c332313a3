"""Constructions of places relative to others: steps along a row, neighbours, nearest and farthest."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_along_row, as_apart, as_nearest, as_zone, chooses_from_trees, is_spot, over
from fieldhand.site.model import Site
from fieldhand.terms import CountedFrom, Side, Towards

GRAMMAR = Grammar()
construction = GRAMMAR.construction


#: Least and greatest distance in metres from a place; None for no greatest one.
Distance = tuple[float, float | None, PlaceMeaning]
#: Any tree, where no noun says so.
_ANY_TREE = Nominal(s.Trees())


@construction(
    "place: [DET] n=count OTHER inner=nominal NEARBY", "place: [DET] n=count OTHER NEARBY inner=nominal", cost=0.2
)
def others_nearby(n: int, inner: Nominal) -> PlaceMeaning | None:
    """Compose "three different trees nearby"."""
    return nearby(replace(inner, selector=s.NotVisited(of=inner.selector)), n)


@construction(
    "place: DET NEARBY inner=nominal",
    "place: DET inner=nominal NEARBY",
    "place: [n=count] NEARBY inner=nominal",
    "place: [n=count] inner=nominal NEARBY",
    cost=0.2,
)
def nearby(inner: Nominal, n: int | None = None) -> PlaceMeaning | None:
    """Compose "a nearby tree" and "three nearby trees"."""
    if inner.single or inner.complete:
        return None
    number = n or (None if inner.plural else 1)
    if number is None:
        return PlaceMeaning(s.Nearest(to=s.Here(), count=2, fresh=True, of=inner.selector), "nearby")
    selector = s.Nearest(to=s.Here(), count=number, fresh=True, of=inner.selector)
    return PlaceMeaning(selector, "one" if number == 1 else "several", count=number)


@construction(
    "nominal: FAR inner=nominal",
    "nominal: inner=nominal FAR",
    "nominal: FARTHEST inner=nominal",
    "nominal: inner=nominal FARTHEST",
    "nominal: FARTHEST inner=nominal FROM there=THERE",
    cost=0.3,
)
def far_away(inner: Nominal, there: Lex | None = None) -> Nominal | None:
    """Compose "tree far away" and "one farthest from there"."""
    if inner.single or inner.plural or inner.complete or (there is not None and not inner.pronoun):
        return None
    return replace(inner, selector=s.Farthest(origin=s.Here(), of=inner.selector), single=True)


@construction("nominal: ANOTHER inner=nominal FARTHEST", "nominal: ANOTHER inner=nominal FARTHEST FROM THERE", cost=0.1)
def another_far_away(inner: Nominal) -> Nominal | None:
    """Compose "another tree as far away as possible"."""
    if inner.single or inner.plural or inner.complete:
        return None
    return replace(inner, selector=s.Farthest(origin=s.Here(), of=s.NotVisited(of=inner.selector)), single=True)


@construction(
    "place: n=count inner=nominal ADJACENT",
    "place: n=count ADJACENT inner=nominal",
    "place: n=count inner=nominal ADJACENT in_ to=place",
    "place: n=count inner=nominal ADJACENT NEAR to=place",
    "place: n=count ADJACENT inner=nominal in_ to=place",
    "place: n=count ADJACENT inner=nominal NEAR to=place",
    cost=0.2,
)
def adjacent(n: int, inner: Nominal, to: PlaceMeaning | None = None) -> PlaceMeaning | None:
    """Compose "three trees next to each other" and "three adjacent trees in the middle of the orchard"."""
    if inner.single or inner.complete or n < 2 or (to is not None and to.shape != "one"):
        return None
    near = s.Here() if to is None else to.selector
    return PlaceMeaning(s.Adjacent(near=near, count=n, of=inner.selector), "several", count=n)


@construction("place: n=count inner=nominal NEAREACH", "place: n=count NEAREACH inner=nominal", cost=0.2)
def adjoining(n: int, inner: Nominal) -> PlaceMeaning | None:
    """Compose "three adjoining trees"."""
    return (
        None
        if inner.single or n < 2
        else PlaceMeaning(s.Adjacent(near=s.Here(), count=n, of=inner.selector), "several", count=n)
    )


@construction(
    "place: [DET] inner=nominal near=NEXTTO to=place",
    "place: [DET] inner=nominal near=BESIDE to=place",
    "place: [DET] inner=nominal near=NEAR to=place",
    cost=0.2,
)
def those_beside(inner: Nominal, near: Lex, to: PlaceMeaning) -> list[PlaceMeaning] | None:
    """Compose "the trees next to tree 12": how many?"""
    around = "surrounds" in near.features
    if not inner.plural or to.shape not in ("one", "here") or ("beside" not in near.features and not around):
        return None
    found = (next_to(inner, to, number) for number in ((4, 8) if around else (2, 4)))
    return [one for one in found if one is not None]


@construction(
    "place: [DET] inner=nominal near=NEAR to=place",
    "place: [DET] inner=nominal near=NEXTTO to=place",
    "place: [DET] inner=nominal near=ALONG to=place",
    cost=0.4,
)
def somewhere_near(inner: Nominal, near: Lex, to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the trees near the pond": how near?"""
    zone = as_zone(to.selector) is not None
    if not inner.plural or inner.single or inner.complete or not (zone or to.shape == "one"):
        return None
    if not zone and not near.features.isdisjoint({"surrounds", "beside", "upwards", "downwards"}):
        return None
    return PlaceMeaning(s.Nearest(to=to.selector, of=inner.selector), "unknown")


@construction(
    "place: [DET] [n=count] inner=nominal NEXTTO to=place",
    "place: [DET] [n=count] inner=nominal BESIDE to=place",
    cost=0.2,
)
def next_to(
    inner: Nominal, to: PlaceMeaning, n: int | None = None, side: Side | Literal["any"] = "any"
) -> PlaceMeaning | None:
    """Compose "the two trees next to tree 12"."""
    number = n or (None if inner.plural else 1)
    beside_zone = to.shape == "area" and side == "any" and as_zone(to.selector) is not None
    if number is None or inner.single or inner.kind != "tree" or not (to.shape in ("one", "here") or beside_zone):
        return None
    selector = s.Nearest(to=to.selector, count=number, adjacent=not beside_zone, side=side, of=inner.selector)
    return _beside(to, PlaceMeaning(selector, "one" if number == 1 else "several", count=number))


@construction("on_side: AT DET side=DIR [part=SIDE]", "on_side: side=DIR", cost=0.1)
def on_side(side: Lex, part: Lex | None = None) -> Side | None:
    """Compose "on the east", "to its north" and "north"."""
    if "adjective" in side.features:
        return None
    return side.value if side.value in SIDES and (part is None or "borders" in part.features) else None


@construction(
    "place: [DET] inner=nominal NEXTTO to=place side=on_side",
    "place: [DET] inner=nominal BESIDE to=place side=on_side",
    "place: [DET] inner=nominal NEXTTO to=place TREE side=on_side",
    "place: DET inner=nominal side=on_side OF to=place",
    cost=0.2,
)
def next_to_on_side(inner: Nominal, to: PlaceMeaning, side: Side) -> PlaceMeaning | None:
    """Compose "the tree next to it on the east" and "the tree to the north of it"."""
    return next_to(inner, to, 1, side) if not inner.plural and inner.selector == s.Trees() else None


@construction(
    "place: [DET] [n=count] noun=NEIGHBOUR OF to=place",
    "place: [DET] [n=count] noun=NEIGHBOUR OF to=place in_ rows=rows",
    "place: to=owned_by [n=count] noun=NEIGHBOUR",
    "place: to=owned_by [n=count] noun=NEIGHBOUR in_ rows=rows",
    "place: DET [n=count] noun=NEIGHBOUR",
    "place: DET [n=count] noun=NEIGHBOUR in_ rows=rows",
    cost=0.2,
)
def neighbours(
    noun: Lex, n: int | None = None, to: PlaceMeaning | None = None, rows: s.Selector | None = None
) -> PlaceMeaning | list[PlaceMeaning] | None:
    """Compose "the two neighbours of tree 12" and "its neighbours in the same row"."""
    plural = "plural" in noun.features
    if (plural and n == 1) or (n or 1) > (1 if not plural else n or 1):
        return None
    of = to or PlaceMeaning(s.Here(), "here")
    row = s.Trees() if rows is None else s.RowOf(origin=of.selector) if rows == s.RowOf() else rows
    found = [
        next_to(Nominal(row, plural=plural), of, number)
        for number in ((n,) if n is not None or not plural else (2,) if rows is not None else (2, 4))
    ]
    return [one for one in found if one is not None]


@construction(
    "place: [DET] side=DIR noun=NEIGHBOUR [OF] to=place",
    "place: DET side=DIR noun=NEIGHBOUR",
    "place: to=owned_by side=DIR noun=NEIGHBOUR",
    "place: [DET] noun=NEIGHBOUR OF to=place beside=on_side",
    "place: [DET] noun=NEIGHBOUR beside=on_side OF to=place",
    "place: DET noun=NEIGHBOUR beside=on_side",
    cost=0.2,
)
def neighbour_on_side(
    noun: Lex, side: Lex | None = None, beside: Side | None = None, to: PlaceMeaning | None = None
) -> PlaceMeaning | None:
    """Compose "the southern neighbour of tree 12" and "its neighbour to the east"."""
    where = beside if side is None else side.value
    if where is None or where not in SIDES or "plural" in noun.features:
        return None
    return next_to(Nominal(s.Trees()), to or PlaceMeaning(s.Here(), "here"), 1, where)


@construction(
    "place: [DET] [inner=nominal] OPPOSITE to=place [side=on_side]",
    "place: [DET] [inner=nominal] OPPOSITE to=place COMMA side=on_side",
    "place: [DET] [inner=nominal] OPPOSITE side=on_side OF to=place",
    "place: [DET] inner=nominal OPPOSITE [side=on_side]",
    cost=0.2,
)
def opposite(
    to: PlaceMeaning | None = None, inner: Nominal | None = None, side: CountedFrom = "usual"
) -> PlaceMeaning | None:
    """Compose "the tree opposite tree 12" and "the tree across the aisle to the south of tree 12"."""
    if inner is not None and (inner.plural or inner.single or inner.selector != s.Trees()):
        return None
    if to is None:
        return PlaceMeaning(s.Across(origin=s.Here(), side=side), "one")
    return PlaceMeaning(s.Across(origin=to.selector, side=side), "one") if to.shape in ("one", "here") else None


@construction("place: word=OPPOSITE [side=on_side]", cost=0.6)
def across_the_aisle(word: Lex, side: CountedFrom = "usual") -> PlaceMeaning | None:
    """Compose "across the aisle"."""
    return PlaceMeaning(s.Across(origin=s.Here(), side=side), "one") if "over_aisle" in word.features else None


@construction("way: word=ALONG", "way: word=ALONG DET ROW", "way: word=ALONG THATROW", cost=0.1)
def way_along(word: Lex) -> Towards | None:
    """Compose "down the row"."""
    return "down" if "downwards" in word.features else "up" if "upwards" in word.features else None


@construction("way: WAY", "way: WAY ALONG DET ROW", "way: MORE ALONG DET ROW", cost=0.1)
def further() -> Towards:
    """Compose "further along"."""
    return "down"


@construction(
    "way: AT DET side=DIR",
    "way: side=DIR",
    "way: MORE side=DIR",
    "way: MORE AT DET side=DIR",
    "way: WAY AT DET side=DIR",
    "way: WAY side=DIR",
    cost=0.1,
)
def way_to_side(side: Lex) -> Towards | None:
    """Compose "to the north"."""
    return side.value if side.value in SIDES else None


@construction("stride: n=count TREE way=way", "stride: n=count way=way", cost=0.1)
def stride(n: int, way: Towards) -> tuple[int, Towards]:
    """Compose "three trees to the north"."""
    return (n, way)


@construction("place: step=stride", cost=0.3)
def along_row(step: tuple[int, Towards]) -> PlaceMeaning:
    """Compose "three trees down the row" as a place."""
    return PlaceMeaning(s.AlongRow(trees=step[0], towards=step[1]), "step")


@construction(
    "place: DET TREE step=stride",
    "place: DET TREE WHICH IS step=stride",
    "place: DET ONE step=stride",
    "place: ANOTHER [RANDOM] TREE step=stride",
    "place: ANOTHER [RANDOM] POINT step=stride",
    cost=0.3,
)
def tree_along_row(step: tuple[int, Towards]) -> PlaceMeaning:
    """Compose "the tree two further along"."""
    return PlaceMeaning(s.AlongRow(trees=step[0], towards=step[1]), "one")


@construction(
    "place: [DET] TREE step=stride FROM to=place",
    "place: [DET] TREE step=stride OF to=place",
    "place: step=stride FROM to=place",
    cost=0.2,
)
def along_row_from(step: tuple[int, Towards], to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "two trees down the row from tree 12"."""
    if to.shape not in ("one", "here"):
        return None
    return PlaceMeaning(s.AlongRow(trees=step[0], towards=step[1], origin=to.selector), "one")


@construction(
    "place: DET NEXTONE TREE",
    "place: DET NEXTONE TREE way=way",
    "place: DET NEXTONE TREE in_ rows=rows",
    "place: DET NEXTONE TREE ALONG rows=rows",
    cost=0.2,
)
def next_tree(way: Towards = "down", rows: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "the next tree"."""
    if rows is not None and rows != s.RowOf():
        return None
    return PlaceMeaning(s.AlongRow(trees=1, towards=way), "one")


@construction(
    "place: [DET] [n=count] inner=nominal NEAREST [AT] to=place",
    "place: [DET] n=count NEAREST inner=nominal AT to=place",
    "place: [DET] NEAREST inner=nominal AT to=place",
    "place: [DET] NEAREST inner=nominal OF to=place",
    "place: [DET] [n=count] inner=nominal [which_is] NEAREST AT to=place",
    "place: [DET] [n=count] inner=nominal near=NEAR to=place",
    "place: to=owned_by [n=count] NEAREST [inner=nominal]",
    "place: DET NEAREST OF to=place",
    cost=0.3,
)
def nearest(
    to: PlaceMeaning, inner: Nominal = _ANY_TREE, n: int | None = None, near: Lex | None = None
) -> PlaceMeaning | None:
    """Compose "the two trees nearest to the charger"."""
    if near is not None and "surrounds" in near.features:
        return None if n is None else next_to(inner, to, n)
    if near is not None and "nearest" not in near.features and n is None and inner.plural:
        return None
    number = n or (None if inner.plural else 1)
    if number is None or inner.single or number >= (inner.complete or number + 1):
        return None
    if to.shape not in ("one", "here", "area"):
        return None
    origin = to.selector
    if to.shape == "area" and as_zone(origin) is None:
        return None
    if origin == s.Middle() and number == 1 and inner.selector == s.Trees():
        return None  # that is the middle itself
    selector: s.Selector = s.Nearest(to=origin, count=number, of=inner.selector)
    if is_spot(origin):
        selector = s.Adjacent(near=origin, count=number, of=inner.selector)
    return _beside(to, PlaceMeaning(selector, "one" if number == 1 else "several", count=number))


@construction(
    "place: [DET] [n=count] FARTHEST inner=nominal FROM to=place",
    "place: [DET] [n=count] inner=nominal [which_is] FARTHEST FROM to=place",
    cost=0.3,
)
def farthest(inner: Nominal, to: PlaceMeaning, n: int | None = None) -> PlaceMeaning | None:
    """Compose "the tree farthest from the charger"."""
    number = n or (None if inner.plural else 1)
    zone = to.shape == "area" and as_zone(to.selector) is not None
    if number is None or inner.single or inner.complete or not (to.shape in ("one", "here") or zone):
        return None
    selector = s.Farthest(origin=to.selector, count=number, of=inner.selector)
    return _beside(to, PlaceMeaning(selector, "one" if number == 1 else "several", count=number))


def _beside(to: PlaceMeaning, found: PlaceMeaning) -> PlaceMeaning:
    """Return a place near another one, which may be one spoken of before."""
    return replace(found, beside=to.shape == "here")


@construction("place: DET n=count inner=nominal way=way OF to=place", cost=0.1, given=("site",))
def trees_to_side(n: int, inner: Nominal, way: Towards, to: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Compose "the three trees north of tree 40", along its row."""
    runs = {block.runs_east_west for block in site.planting.blocks}
    if inner.selector != s.Trees() or n < 2 or to.shape not in ("one", "here") or way not in SIDES:
        return None
    if runs != {way in ("east", "west")}:
        return None
    steps = tuple(s.AlongRow(trees=k, towards=way, origin=to.selector) for k in range(1, n + 1))
    return PlaceMeaning(s.UnionOf(parts=steps), "several", count=n)


@construction(
    "in_radius: INSIDE [DET] RADIUS OF far=amount",
    "in_radius: INSIDE [DET] far=amount RADIUS",
    "in_radius: in_ [DET] far=amount RADIUS",
    "in_radius: in_ DET RADIUS OF far=amount",
    cost=0.1,
)
def in_radius(far: Amount) -> Amount:
    """Compose "within a radius of 20 m"."""
    return far


@construction(
    "distance: INSIDE far=amount OF to=place",
    "distance: far=in_radius OF to=place",
    "distance: far=in_radius NEAR to=place",
    "distance: UPTO far=amount FROM to=place",
    "distance: check=CMP far=amount FROM to=place",
    "distance: check=CLOSER far=amount AT to=place",
    "distance: check=CLOSER far=amount FROM to=place",
    "distance: span=value_range FROM to=place",
    cost=0.1,
)
def distance(
    to: PlaceMeaning,
    far: Amount | None = None,
    check: Lex | None = None,
    span: tuple[float, float, str] | None = None,
) -> Distance | None:
    """Compose "within 20 m of the charger" and "more than 20 m from the charger"."""
    unit = far.unit if far is not None else span[2] if span is not None else ""
    zone = to.shape == "area" and as_zone(to.selector) is not None
    if unit != "metres" or not (to.shape in ("one", "here") or zone):
        return None
    if far is None:
        return None if span is None or zone else (span[0], span[1], to)
    if check is None or check.value is None or check.value[0] in ("lt", "le"):
        return (0.0, far.number, to)
    return (far.number, None, to) if check.value[0] in ("gt", "ge") else None


def _at_distance(of: s.Selector, at: Distance) -> s.Selector | None:
    """Return the trees of a selection within or beyond a distance of a place."""
    low, high, to = at
    if (zone := as_zone(to.selector)) is not None:
        if not chooses_from_trees(of):
            return None
        return over(of, s.InZone(zone=zone.zone, margin_m=high if high is not None else low, outside=high is None))
    near = of if high is None else s.Within(distance_m=high, to=to.selector, of=of)
    if high is None:
        return s.Excluding(places=beyond(low, to.selector), of=of)
    return s.Excluding(places=s.Within(distance_m=low, to=to.selector), of=near) if low else near


@construction(
    "place: [EACH] [DET] inner=nominal [which_is] at=distance",
    "place: [ANY] n=count inner=nominal at=distance",
    cost=0.2,
)
def within(inner: Nominal, at: Distance, n: int | None = None) -> PlaceMeaning | None:
    """Compose "all trees within 20 m of the charger" and "three trees within 20 m of the charger"."""
    there = _at_distance(inner.selector, at)
    if there is None or inner.single or (n is not None and inner.complete):
        return None
    if n is None and at[2].shape == "here" and not inner.plural:
        return None
    if n is None:
        return _beside(at[2], PlaceMeaning(there, "several"))
    return _beside(at[2], PlaceMeaning(s.Take(count=n, of=there), "one" if n == 1 else "several", count=n))


@construction("place: word=DET inner=nominal at=distance", cost=0.2)
def one_beyond_place(word: Lex, inner: Nominal, at: Distance) -> PlaceMeaning | None:
    """Compose "a tree at least 20 m away from it"."""
    there = _at_distance(inner.selector, at)
    if there is None or inner.single or inner.plural or "indefinite" not in word.features or at[1] is not None:
        return None
    return _beside(at[2], PlaceMeaning(s.Take(count=1, of=there), "one"))


@construction(
    "place: DET n=count NEAREST inner=nominal",
    "place: DET NEAREST inner=nominal",
    "place: DET n=count inner=nominal NEAREST",
    cost=0.4,
)
def nearest_here(inner: Nominal, n: int | None = None) -> PlaceMeaning | None:
    """Compose "the three nearest trees"."""
    number = n or (None if inner.plural else 1)
    if number is None or inner.single or inner.complete or inner.kind != "tree":
        return None
    selector = s.Nearest(to=s.Here(), count=number, of=inner.selector)
    return PlaceMeaning(selector, "one" if number == 1 else "several", count=number)


@construction(
    "place: [DET] rank=ORD inner=nominal [which_is] NEAREST AT to=place",
    "place: [DET] rank=ORD NEAREST inner=nominal AT to=place",
    cost=0.1,
)
def nth_nearest(rank: Lex, inner: Nominal, to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the 5th tree in row 3 nearest to the charger"."""
    if rank.value < 2 or inner.single or inner.plural or inner.complete or to.shape != "one":
        return None
    nearer = s.Nearest(to=to.selector, count=rank.value - 1, of=inner.selector)
    return PlaceMeaning(s.Nearest(to=to.selector, of=s.Excluding(places=nearer, of=inner.selector)), "one")


@construction("place: near=place in_ where=region", cost=0.4)
def nearest_in(near: PlaceMeaning, where: s.Selector) -> PlaceMeaning | None:
    """Compose "the 3 trees nearest to the charger in the northern half"."""
    apart = as_apart(near.selector)
    if apart is not None and apart.of == s.Trees():
        return replace(near, selector=replace(apart, of=where))  # "five trees 25 m apart in row 2"
    nearest = as_nearest(near.selector)
    if nearest is None or nearest.of != s.Trees() or not nearest.to.named_marker or nearest.adjacent:
        return None
    return replace(near, selector=replace(nearest, of=where))


@construction("place: near=place in_ rows=rows", cost=0.2)
def near_in_row(near: PlaceMeaning, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the tree next to it in the same row" and "the two trees north of it in the row"."""
    if rows != s.RowOf():
        return None
    steps = near.selector.members
    if all(as_along_row(step) is not None for step in steps):
        return near
    nearest = as_nearest(near.selector)
    if nearest is None or nearest.of != s.Trees() or near.shape not in ("one", "several"):
        return None
    return replace(near, selector=replace(nearest, of=s.RowOf(origin=nearest.to)))


@construction(
    "place: [DET] n=count inner=nominal NEAREST [AT] to=place [COMMA] AND [AT] DET m=count [TREE] FARTHEST FROM IT",
    "place: [DET] n=count inner=nominal NEAREST [AT] to=place [COMMA] AND [AT] DET m=count FARTHEST",
    cost=0.2,
)
def nearest_and_farthest(n: int, m: int, inner: Nominal, to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the three trees nearest to the pond and the three farthest from it"."""
    ends = nearest(to, inner, n), farthest(inner, to, m)
    if ends[0] is None or ends[1] is None:
        return None
    return PlaceMeaning(s.UnionOf(parts=(ends[0].selector, ends[1].selector)), "several", count=n + m)


@construction(
    "place: n=count inner=nominal [COMMA] [EACH] dist=apart",
    "place: n=count inner=nominal [COMMA] WHICH dist=apart",
    "place: n=count inner=nominal [COMMA] ABOUT dist=apart",
    "place: n=count inner=nominal [COMMA] [EACH] least=apart_least",
    "place: n=count inner=nominal [COMMA] WHICH least=apart_least",
    "place: n=count other=OTHER inner=nominal [COMMA] [EACH] dist=apart",
    "place: n=count other=OTHER inner=nominal [COMMA] [EACH] least=apart_least",
    cost=0.2,
)
def trees_apart(
    n: int, inner: Nominal, dist: float | None = None, least: float | None = None, other: Lex | None = None
) -> PlaceMeaning | None:
    """Compose "four trees of row 3, each 12 m from the next"."""
    if inner.single or inner.complete or n < 2:
        return None
    of = inner.selector if other is None else s.NotVisited(of=inner.selector)
    apart = s.Apart(apart_m=dist or least or 0.0, count=n, least=least is not None, of=of)
    return PlaceMeaning(apart, "several", count=n)


@construction("place: whole=place [COMMA] [which_is] at=distance", cost=0.3)
def those_within(whole: PlaceMeaning, at: Distance) -> PlaceMeaning | None:
    """Compose "every yellow tree that is within 50 m of the charger"."""
    low, _, to = at
    if low or to.shape != "one" or to.selector.relative or whole.shape != "several":
        return None
    if whole.count is not None or whole.per is not None or not chooses_from_trees(whole.selector):
        return None
    there = _at_distance(whole.selector, at)
    return None if there is None else replace(whole, selector=there)


@construction(
    "place: DET rank=ORD TREE way=way OF [to=place]", "place: DET rank=ORD TREE way=way [FROM] [THERE]", cost=0.2
)
def nth_along_row(rank: Lex, way: Towards, to: PlaceMeaning | None = None) -> PlaceMeaning | None:
    """Compose "the 4th tree to the north of it"."""
    if to is not None and to.shape not in ("one", "here"):
        return None
    origin = s.Here() if to is None or to.shape == "here" else to.selector
    return PlaceMeaning(s.AlongRow(trees=rank.value, towards=way, origin=origin), "one")


@construction(
    "place: DET NEXTONE n=count inner=nominal",
    "place: DET NEXTONE n=count inner=nominal way=way",
    "place: DET NEXTONE n=count inner=nominal in_ rows=rows",
    cost=0.2,
)
def next_trees(n: int, inner: Nominal, way: Towards = "down", rows: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "the next three trees"."""
    if inner.single or inner.selector != s.Trees() or n < 2 or rows not in (None, s.RowOf()):
        return None
    return PlaceMeaning(
        s.UnionOf(parts=tuple(s.AlongRow(trees=k, towards=way) for k in range(1, n + 1))), "several", count=n
    )


def beyond(metres: float, of: s.Selector) -> s.Selector:
    """Return what is left out where trees are at least so far from a place: those nearer to it, and itself."""
    return s.UnionOf(parts=(of, s.Within(distance_m=metres, to=of)))
