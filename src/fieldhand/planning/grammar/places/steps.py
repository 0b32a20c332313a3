"""Constructions of places relative to others: steps along a row, neighbours, nearest and farthest."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.rows import rows_towards
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, as_zone, chooses_from_trees, is_block, over
from fieldhand.site.model import Site
from fieldhand.terms import CountedFrom, Side, Towards

GRAMMAR = Grammar()
construction = GRAMMAR.construction


#: Least and greatest distance in metres from a place; None for no greatest one.
Distance = tuple[float, float | None, PlaceMeaning]
#: Any tree, where no noun says so.
_ANY_TREE = Nominal(s.Trees())


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


@construction("on_side: AT DET side=DIR [part=SIDE]", "on_side: side=DIR", cost=0.1)
def on_side(side: Lex, part: Lex | None = None) -> Side | None:
    """Compose "on the east", "to its north" and "north"."""
    if "adjective" in side.features:
        return None
    return side.value if side.value in SIDES and (part is None or "borders" in part.features) else None


@construction(
    "place: [DET] [inner=nominal] OPPOSITE to=place [side=on_side]",
    "place: [DET] [inner=nominal] OPPOSITE to=place COMMA side=on_side",
    "place: [DET] [inner=nominal] OPPOSITE side=on_side OF to=place",
    "place: [DET] inner=nominal OPPOSITE [side=on_side]",
    "place: [DET] inner=nominal OPPOSITE [IT] in_ rows=rows", "place: [DET] inner=nominal OPPOSITE IT",
    cost=0.2,
)  # fmt: skip
def opposite(
    to: PlaceMeaning | None = None,
    inner: Nominal | None = None,
    side: CountedFrom = "usual",
    rows: s.Selector | None = None,
) -> PlaceMeaning | None:
    """Compose "the tree opposite tree 12", "the tree across the aisle to the south of tree 12" and "... in row 2"."""
    if inner is not None and (inner.single or (inner.plural and not inner.unmarked)):
        return None
    known = s.Trees() if inner is None else inner.selector
    known = known if rows is None else over(known, rows)
    if known != s.Trees():  # the dialogue checks that it is one of these
        of_those = PlaceMeaning(s.Across(origin=s.Here(), side=side), "one", per=known)
        return of_those if to is None and chooses_from_trees(known) else None
    if to is None:
        return PlaceMeaning(s.Across(origin=s.Here(), side=side), "one")
    return PlaceMeaning(s.Across(origin=to.selector, side=side), "one") if to.shape in ("one", "here") else None


@construction(
    "rows_beside_it: in_ EACH [OF] [DET] ROW NEXTTO IT", "rows_beside_it: in_ EACH [OF] [DET] ROW BESIDE IT",
    "rows_beside_it: in_ DET noun=ROW NEXTTO IT", "rows_beside_it: in_ DET noun=ROW BESIDE IT",
    "rows_beside_it: in_ DET noun=ROW EACHSIDE [OF] [IT]", "rows_beside_it: in_ EACH ROW EACHSIDE [OF] [IT]",
    "rows_beside_it: in_ EACH [OF] [DET] ADJOINING ROW", "rows_beside_it: in_ DET ADJOINING noun=ROW",
    "rows_beside_it: EACHSIDE [OF] [IT]", cost=0.1,
)  # fmt: skip
def rows_beside_it(noun: Lex | None = None) -> str | None:
    """Compose "in each bed beside it", "in the beds on either side" and "on both sides"."""
    return "both" if noun is None or noun.plural else None


@construction(
    "place: [DET] TREE OPPOSITE [IT] rows_beside_it", "place: [DET] ONE OPPOSITE [IT] rows_beside_it",
    "place: [DET] TREE OPPOSITE to=place rows_beside_it", cost=0.1, given=("site",),
)  # fmt: skip
def opposite_on_both_sides(site: Site, to: PlaceMeaning | None = None) -> PlaceMeaning | None:
    """Compose "the plant across from it in each bed beside it"."""
    if to is not None and to.shape not in ("one", "here"):
        return None
    runs = {block.runs_east_west for block in site.planting.blocks}
    if len(runs) != 1:
        return None
    sides: tuple[Side, Side] = ("north", "south") if runs == {True} else ("west", "east")
    origin = s.Here() if to is None else to.selector
    parts = tuple(s.Across(origin=origin, side=side) for side in sides)
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=2)


@construction("place: word=OPPOSITE [side=on_side]", cost=0.6)
def across_the_aisle(word: Lex, side: CountedFrom = "usual") -> PlaceMeaning | None:
    """Compose "across the aisle"."""
    return PlaceMeaning(s.Across(origin=s.Here(), side=side), "one") if "over_aisle" in word.features else None


@construction("that_row: DET ROW", "that_row: ITS ROW", "that_row: DET SAME ROW", "that_row: THATROW", cost=0.0)
def that_row() -> str:
    """Compose "the row" and "its row", of the place spoken of."""
    return "row"


@construction("way: word=ALONG", "way: word=ALONG that_row", cost=0.1)
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
    "way: side=DIR ALONG that_row",
    "way: ALONG that_row side=DIR",
    "way: MORE side=DIR",
    "way: MORE AT DET side=DIR",
    "way: WAY AT DET side=DIR",
    "way: WAY side=DIR",
    cost=0.1,
)
def way_to_side(side: Lex) -> Towards | None:
    """Compose "to the north"."""
    return side.value if side.value in SIDES else None


@construction("stride: [ANOTHER] n=count TREE way=way", "stride: n=count way=way", cost=0.1)
def stride(n: int, way: Towards) -> tuple[int, Towards]:
    """Compose "three trees to the north"."""
    return (n, way)


@construction("row_side: BEFORE", "row_side: word=THEN", cost=0.0)
def row_side(word: Lex | None = None) -> Towards | None:
    """Compose "before" and "after" another tree of a row."""
    return "up" if word is None else "down" if "after_doing" in word.features else None


@construction(
    "place: word=DET noun=TREE way=row_side to=place", "place: word=DET noun=ONE way=row_side to=place", cost=0.3
)
def tree_before(word: Lex, noun: Lex, way: Towards, to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the tree before tree 20"."""
    if noun.plural or "plural" in noun.features or "definite" not in word.features:
        return None
    if to.shape not in ("one", "here"):
        return None
    return _beside(to, PlaceMeaning(s.AlongRow(trees=1, towards=way, origin=to.selector), "one"))


@construction(
    "place: DET TREE way=row_side AND other=row_side to=place",
    "place: DET TREE way=row_side to=place AND [DET] [ONE] other=row_side [IT]",
    cost=0.2,
)
def trees_before_and_after(way: Towards, other: Towards, to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the trees before and after tree 20"."""
    if way == other or to.shape not in ("one", "here"):
        return None
    steps = tuple(s.AlongRow(trees=1, towards=one, origin=to.selector) for one in (way, other))
    return _beside(to, PlaceMeaning(s.UnionOf(parts=steps), "several", count=2))


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
    rows = to.shape == "area" and (are_rows(to.selector) or is_block(to.selector))
    if unit != "metres" or not (to.shape in ("one", "here") or zone or rows):
        return None
    if far is None:
        return None if span is None else (span[0], span[1], to)
    if check is None or check.value is None or check.value[0] in ("lt", "le"):
        return (0.0, far.number, to)
    return (far.number, None, to) if check.value[0] in ("gt", "ge") else None


def at_distance(of: s.Selector, at: Distance) -> s.Selector | None:
    """Return the trees of a selection within or beyond a distance of a place."""
    low, high, to = at
    if (zone := as_zone(to.selector)) is not None:
        if not chooses_from_trees(of):
            return None
        inside = s.Trees() if high is None else s.InZone(zone=zone.zone, margin_m=high)
        beyond = s.InZone(zone=zone.zone, margin_m=low, outside=True, of=inside)
        return over(of, beyond if low or high is None else inside)
    near = of if high is None else s.Within(distance_m=high, to=to.selector, of=of)
    return s.Within(distance_m=low, to=to.selector, beyond=True, of=near) if low else near


@construction(
    "place: [each=EACH] [DET] [OTHER] inner=nominal [which_is] at=distance",
    "place: [ANY] n=count inner=nominal at=distance",
    cost=0.2,
)
def within(inner: Nominal, at: Distance, n: int | None = None, each: Lex | None = None) -> PlaceMeaning | None:
    """Compose "all trees within 20 m of the charger" and "three trees within 20 m of the charger"."""
    there = at_distance(inner.selector, at)
    if there is None or inner.single or (n is not None and inner.complete):
        return None
    if n is None and at[2].shape == "here" and not inner.plural and each is None:
        return None
    if n is None:
        return _beside(at[2], PlaceMeaning(there, "several"))
    return _beside(at[2], PlaceMeaning(s.Take(count=n, of=there), "one" if n == 1 else "several", count=n))


@construction("place: word=DET inner=nominal at=distance", cost=0.2)
def one_beyond_place(word: Lex, inner: Nominal, at: Distance) -> PlaceMeaning | None:
    """Compose "a tree at least 20 m away from it"."""
    there = at_distance(inner.selector, at)
    if there is None or inner.single or inner.plural or "indefinite" not in word.features or at[1] is not None:
        return None
    return _beside(at[2], PlaceMeaning(s.Take(count=1, of=there), "one"))


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
    "place: DET NEXTONE n=count [inner=nominal] way=way",
    "place: DET NEXTONE n=count inner=nominal in_ rows=rows",
    "place: DET n=count inner=nominal FOLLOWING [way=way]",
    "place: DET n=count FOLLOWING inner=nominal [way=way]",
    cost=0.2,
)
def next_trees(
    n: int, inner: Nominal | None = None, way: Towards = "down", rows: s.Selector | None = None
) -> PlaceMeaning | None:
    """Compose "the next three trees" and "the three trees that follow it down the row"."""
    if inner is not None and (inner.single or inner.selector != s.Trees()):
        return None
    if n < 2 or rows not in (None, s.RowOf()):
        return None
    return PlaceMeaning(
        s.UnionOf(parts=tuple(s.AlongRow(trees=k, towards=way) for k in range(1, n + 1))), "several", count=n
    )


@construction("place: DET TREE n=count noun=ROW way=way OF to=place", cost=0.1, given=("site",))
def tree_rows_away(n: int, noun: Lex, way: Towards, to: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Compose "the tree two rows east of tree 50"."""
    rows = rows_towards(n, way, site) if noun.plural == (n > 1) and to.shape in ("one", "here") else None
    if rows is None:
        return None
    return PlaceMeaning(s.Nearest(to=to.selector, of=replace(rows, origin=to.selector)), "one")
