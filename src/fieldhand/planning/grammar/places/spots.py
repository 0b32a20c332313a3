"""Constructions of single spots on the site: corners, middles, markers and gates."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.places.sampling import bare_points
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, as_edge, as_zone, compass_part, is_one_row, over
from fieldhand.site.model import Site
from fieldhand.terms import CornerName, Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Corners in the order in which they are visited.
_CORNERS_IN_TURN: tuple[CornerName, ...] = ("nw", "ne", "se", "sw")


@construction("nominal: noun=TREE in_ DET at=corner_at", "nominal: noun=ONE in_ DET at=corner_at", cost=0.1)
def tree_in_corner(noun: Lex, at: Nominal) -> Nominal | None:
    """Compose "tree in the north-east corner"; of several trees it does not say how many."""
    return None if noun.plural or "plural" in noun.features else at


@construction("corner_at: side=DIR noun=CORNER", "corner_at: side=MOST noun=CORNER", cost=0.0)
def corner_at(side: Lex, noun: Lex) -> Nominal | None:
    """Compose "north-east corner" behind "tree in the"."""
    return corner(side, noun)


@construction("nominal: noun=TREE in_ DET MIDDLE [in_] [site]", cost=0.1)
def tree_in_middle(noun: Lex) -> Nominal | None:
    """Compose "tree in the middle of the orchard"."""
    return None if noun.plural else Nominal(s.Middle(), single=True)


@construction("spot: DET MIDDLE [in_] [site]", cost=0.0)
def middle_spot() -> s.Selector:
    """Compose "the middle of the orchard" behind "three trees in"."""
    return s.Middle()


@construction("spot: DET at=corner_at [OF] [site]", "spot: DET at=corner_at OF where=region", cost=0.1)
def corner_spot(at: Nominal, where: s.Selector | None = None) -> s.Selector:
    """Compose "the north-west corner of the south block" behind "ten trees in"."""
    return at.selector if where is None else over(at.selector, where)


@construction("place: [DET] n=count inner=nominal in_ at=spot", cost=0.2)
def trees_at_spot(n: int, inner: Nominal, at: s.Selector) -> PlaceMeaning | None:
    """Compose "three trees in the middle of the orchard"."""
    if n < 2 or inner.single or inner.complete or inner.kind != "tree":
        return None
    return PlaceMeaning(s.Adjacent(near=at, count=n, of=inner.selector), "several", count=n)


@construction("place: [DET] noun=TREE in_ at=spot", cost=0.4)
def somewhere_at_spot(noun: Lex, at: s.Selector) -> PlaceMeaning | None:
    """Compose "the trees in the middle of the orchard": how many?"""
    return PlaceMeaning(s.Nearest(to=at), "unknown") if noun.plural else None


@construction("nominal: side=DIR noun=CORNER [TREE]", "nominal: side=MOST noun=CORNER [TREE]", cost=0.1)
def corner(side: Lex, noun: Lex) -> Nominal | None:
    """Compose "north-east corner"."""
    if side.value not in CORNERS or noun.plural:
        return None
    return Nominal(s.Corners(which=(side.value,)), single=True)


@construction("nominal: [n=count] CORNER noun=TREE", cost=0.1)
def corner_trees(noun: Lex, n: int | None = None) -> Nominal | None:
    """Compose "four corner trees"."""
    return corners(noun, n)


@construction("nominal: [n=count] noun=CORNER", "nominal: TREE AT DET [n=count] noun=CORNER", cost=0.2)
def corners(noun: Lex, n: int | None = None) -> Nominal | None:
    """Compose "four corners"."""
    if n not in (None, 4):
        return None
    if not noun.plural:
        return Nominal(s.Corners(), plural=False, kind="corner")
    return Nominal(s.Corners(), plural=True, complete=4)


@construction(
    "place: [word=DET] MIDDLE",
    "place: [word=DET] MIDDLE TREE",
    "place: [DET] MIDDLE ONE",
    "place: [DET] TREE NEAREST [AT] DET MIDDLE [in_] [site]",
    "place: DET TREE NEAR DET MIDDLE [in_] [site]",
    cost=0.2,
)
def middle(word: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the middle of the orchard"; "its middle" is that of something else."""
    return None if word is not None and "of_it" in word.features else PlaceMeaning(s.Middle(), "one")


@construction("place: [DET] MIDDLE in_ site", cost=0.2)
def middle_of_site() -> PlaceMeaning:
    """Compose "the middle of the orchard", whatever was named before it."""
    return PlaceMeaning(s.Middle(), "one", itself=True)


@construction(
    "place: [DET] MIDDLE in_ where=region",
    "place: [DET] MIDDLE noun=TREE in_ where=region",
    cost=0.7,
    given=("site",),
)
def middle_of(where: s.Selector, site: Site, noun: Lex | None = None) -> PlaceMeaning | list[PlaceMeaning] | None:
    """Compose "the middle of row 4" and "the middle tree of rows 3 and 4", of each of which there is one."""
    several = are_rows(where) and not is_one_row(where)
    of_each = PlaceMeaning(s.Middle(), "several", each=True, per=where)
    if noun is not None and (several or noun.plural):
        return of_each if several else None
    if several:  # of each row, or of the area that they are?
        return [of_each, PlaceMeaning(s.Middle(of=where), "one")]
    if noun is None and compass_part(where) is not None and (free := bare_points(where, site, 1)) is not None:
        return PlaceMeaning(free, "one")
    if (zone := as_zone(where)) is not None:
        whole = not zone.outside and as_edge(zone.of) is None
        return PlaceMeaning(s.PointsIn(zone=zone.zone), "one") if whole else None
    if (edge := as_edge(where)) is not None:
        return PlaceMeaning(s.EdgeMiddle(side=edge.side, of=edge.of), "one")
    return PlaceMeaning(s.Middle(of=where), "one")


@construction("adverbial_place: MIDWORD where=region", cost=0.2, given=("site",))
def mid_area(where: s.Selector, site: Site) -> PlaceMeaning | list[PlaceMeaning] | None:
    """Compose "mid warm section"."""
    return middle_of(where, site)


@construction(
    "halfway: HALFWAY where=rows", "halfway: HALFWAY where=each_row", "halfway: HALFWAY where=all_rows", cost=0.0
)
def halfway(where: s.Selector) -> PlaceMeaning:
    """Compose "halfway along row 4", which needs no word before it."""
    if is_one_row(where):
        return PlaceMeaning(s.Middle(of=where), "one")
    return PlaceMeaning(s.Middle(), "several", each=True, per=where)


@construction("place: place=halfway", "place: [DET] TREE [which_is] place=halfway", cost=0.2)
def place_halfway(place: PlaceMeaning) -> PlaceMeaning:
    """Compose "halfway along row 4" as a place."""
    return place


@construction("marker: START", "marker: DET START", cost=0.1)
def start_marker() -> s.Selector:
    """Compose "the start"."""
    return s.Marker(name="start")


@construction("marker: [word=DET] noun=FINISH", cost=0.1)
def end_marker(noun: Lex, word: Lex | None = None) -> s.Selector | None:
    """Compose "the end"; "the ends" are those of a row."""
    verb = word is None and "ends" in noun.features
    return None if verb or noun.plural else s.Marker(name="end")


@construction("marker: noun=FINISH", cost=1.6)
def bare_end_marker(noun: Lex) -> s.Selector | None:
    """Compose "end", which rather is a command: "take a picture at tree 4 and finish"."""
    return s.Marker(name="end") if "ends" in noun.features else None


@construction("marker: [DET] CHARGER", cost=0.1)
def charger() -> s.Selector:
    """Compose "the charger"."""
    return s.Marker(name="charger")


@construction("place: marker=marker", cost=0.1)
def marker(marker: s.Selector) -> PlaceMeaning:
    """Compose "the charger" as a place."""
    return PlaceMeaning(marker, "one")


@construction("edge_side: side=DIR EDGE", "edge_side: side=DIR part=SIDE", "edge_side: side=DIR FINISH", cost=0.1)
def edge_side(side: Lex, part: Lex | None = None) -> Side | None:
    """Compose "northern edge" behind "the middle of the"."""
    if part is not None and "borders" not in part.features:
        return None  # "the northern part"
    return side.value if side.value in SIDES else None


@construction(
    "place: [DET] MIDDLE OF [DET] side=edge_side [in_] [site]",
    "place: [DET] TREE AT DET MIDDLE OF [DET] side=edge_side [in_] [site]",
    cost=0.1,
)
def middle_of_edge(side: Side) -> PlaceMeaning:
    """Compose "the middle of the northern edge"."""
    return PlaceMeaning(s.EdgeMiddle(side=side), "one")


@construction("turns: [FIRSTONE] [DET] side=DIR [CORNER]", cost=0.2)
def first_turn(side: Lex) -> tuple[CornerName, ...] | None:
    """Compose "first the north-west corner"."""
    return (side.value,) if side.value in CORNERS else None


@construction(
    "turns: first=turns [COMMA] AND [DET] side=DIR [CORNER] [LAST]",
    "turns: first=turns COMMA [then] [DET] side=DIR [CORNER]",
    "turns: first=turns [COMMA] AND then [DET] side=DIR [CORNER]",
    cost=0.2,
)
def next_turn(first: tuple[CornerName, ...], side: Lex) -> tuple[CornerName, ...] | None:
    """Compose "first the north-west corner, then the north-east"."""
    return (*first, side.value) if side.value in CORNERS and side.value not in first else None


@construction("place: [DET] [n=count] noun=CORNER [COMMA] [GOING] at=turns", cost=0.2)
def corners_in_turn(noun: Lex, at: tuple[CornerName, ...], n: int | None = None) -> PlaceMeaning | None:
    """Compose "the corners going north-west, north-east, south-east and south-west"."""
    if not noun.plural or len(at) < 2 or n not in (None, len(at)):
        return None
    each = tuple(s.Corners(which=(corner,)) for corner in at)
    return PlaceMeaning(s.UnionOf(parts=each), "several", count=len(at), in_order=True)


@construction("place: [DET] gate=GATENAME", cost=0.1)
def gate(gate: Lex) -> PlaceMeaning:
    """Compose "north gate", the name of a gate."""
    return PlaceMeaning(s.GateIs(gate=gate.value), "one")


@construction(
    "place: word=EACH noun=GATES", "place: word=EACH DET noun=GATES", "place: word=EACH OF DET noun=GATES",
    "place: [DET] gates=GATES", "place: [DET] n=count noun=GATES", "place: word=EACH n=count noun=GATES",
    "place: word=EACH [OF] DET n=count noun=GATES",
    cost=0.2,
)  # fmt: skip
def every_gate(
    noun: Lex | None = None, gates: Lex | None = None, word: Lex | None = None, n: int | None = None
) -> PlaceMeaning | None:
    """Compose "every gate", "the gates" and "the two gates"; "both gates" of three are not."""
    named = gates or noun
    n = 2 if word is not None and "two" in word.features else n
    if named is None or (gates is not None and not gates.plural) or n not in (None, len(named.value)):
        return None
    parts = tuple(s.GateIs(gate=name) for name in named.value)
    if len(parts) < 2:
        return None
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=len(parts), each=gates is None)


@construction("corner_list: [DET] side=DIR", cost=0.0)
def corner_list(side: Lex) -> tuple[tuple[CornerName, ...], bool] | None:
    """Compose "the north-west", the beginning of "the north-west and the south-east corner"."""
    return ((side.value,), False) if side.value in CORNERS else None


@construction(
    "corner_list: first=corner_list COMMA [DET] side=DIR",
    "corner_list: first=corner_list [COMMA] AND [DET] side=DIR",
    "corner_list: first=corner_list [COMMA] [AND] then=then [DET] side=DIR",
    cost=0.1,
)
def longer_corner_list(
    first: tuple[tuple[CornerName, ...], bool], side: Lex, then: str = ""
) -> tuple[tuple[CornerName, ...], bool] | None:
    """Compose "the north-west, then the north-east", of corners that are visited in this order."""
    if side.value not in CORNERS or side.value in first[0]:
        return None
    return ((*first[0], side.value), first[1] or bool(then))


@construction(
    "place: corners=corner_list CORNER [TREE] [in_] [site]", "place: corners=corner_list CORNER OF site", cost=0.2
)
def corners_listed(corners: tuple[tuple[CornerName, ...], bool]) -> PlaceMeaning | None:
    """Compose "the north-west and the south-east corner"."""
    names, in_order = corners
    if len(names) < 2:
        return None
    parts = tuple(s.Corners(which=(name,)) for name in names)
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=len(parts), in_order=in_order)


@construction("nominal: [n=count] side=DIR noun=CORNER", cost=0.1)
def corners_of_side(side: Lex, noun: Lex, n: int | None = None) -> Nominal | None:
    """Compose "two northern corners"."""
    if side.value not in SIDES or not noun.plural or n not in (None, 2):
        return None
    which = tuple(corner for corner in _CORNERS_IN_TURN if side.value[0] in corner)
    return Nominal(s.Corners(which=which), plural=True, complete=2)


@construction("place: n=count TREE AT EACH noun=CORNER", "place: DET tree=TREE in_ EACH noun=CORNER", cost=0.2)
def tree_at_each_corner(noun: Lex, n: int = 1, tree: Lex | None = None) -> PlaceMeaning | None:
    """Compose "one tree at each corner" and "the tree in each corner"."""
    return (
        None
        if n != 1 or noun.plural or (tree is not None and tree.plural)
        else PlaceMeaning(s.Corners(), "several", each=True, count=4)
    )


@construction("place: EACH noun=QUARTER", "place: EACH noun=QUARTER OF site", cost=0.2)
def each_quarter(noun: Lex) -> PlaceMeaning | None:
    """Compose "each quarter" as a place."""
    if noun.plural:
        return None
    quarters = s.UnionOf(parts=tuple(s.Quarter(quarter=corner) for corner in _CORNERS_IN_TURN))
    return PlaceMeaning(s.Trees(), "area", each=True, per=quarters)


@construction("place: n=count POINT in_ [DET] zone=ZONE", cost=0.2)
def points_in_zone(n: int, zone: Lex) -> PlaceMeaning:
    """Compose "3 points in the wet corner"."""
    return PlaceMeaning(s.PointsIn(zone=zone.value, count=n), "one" if n == 1 else "several", count=n)
