"""Constructions of trees that are counted along their rows: "third", "first and last", "the two at the north end".

The words add positions to a description (:class:`~fieldhand.planning.grammar.places.chosen.Chosen`) in any order;
:func:`~fieldhand.planning.grammar.places.counted.counted` finds the trees.
"""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.english.plant_words import is_kind_attribute
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.areas import inside
from fieldhand.planning.grammar.places.chosen import Choice, Chosen, counted_from
from fieldhand.planning.grammar.places.compass import AWAY_FROM, SIDES
from fieldhand.planning.grammar.places.counted import (
    BOTH_ENDS,
    Positions,
    Span,
    TreeNumbers,
    backwards,
    of_row_named_before,
    size_of,
    trees_counted,
    trees_numbered,
)
from fieldhand.planning.grammar.places.numbered import ids_of, runs
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import chooses_from_trees, is_one_row
from fieldhand.site.model import Site
from fieldhand.terms import CountedFrom, Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

_TREE = Nominal(s.Trees())
_TREES = Nominal(s.Trees(), plural=True)


# Numbers of trees, and of rows.


@construction("position: rank=ORD", cost=0.0)
def ordinal_position(rank: Lex) -> Span:
    """Compose "third"."""
    return (rank.value, rank.value)


@construction("position: rank=ORD AT LAST", "position: rank=ORD LAST", cost=0.0)
def position_from_end(rank: Lex) -> Span:
    """Compose "third to last"."""
    return (-rank.value, -rank.value)


@construction("position: PENULT", cost=0.0)
def penultimate() -> Span:
    """Compose "penultimate"."""
    return (-2, -2)


@construction("position: LAST", cost=0.0)
def last_position() -> Span:
    """Compose "last"."""
    return (-1, -1)


@construction("positions: rank=ORD n=count", "positions: n=count rank=ORD", cost=0.0)
def first_so_many(rank: Lex, n: int) -> Span | None:
    """Compose "first three"."""
    return (1, n) if rank.value == 1 and n > 1 else None


@construction("positions: LAST n=count", "positions: n=count LAST", cost=0.0)
def last_so_many(n: int) -> Span | None:
    """Compose "last three"."""
    return (-n, -1) if n > 1 else None


@construction("positions: first=ORD range_to [DET] LAST", "positions: first=ORD range_to [DET] last=ORD", cost=0.0)
def from_rank(first: Lex, last: Lex | None = None) -> Span | None:
    """Compose "tenth to the twentieth" and "third to the last"."""
    return (first.value, -1) if last is None else (first.value, last.value) if first.value < last.value else None


@construction("span: at=position", "span: at=positions", cost=0.0)
def span(at: Span) -> Span:
    """Compose "third" or "first three"."""
    return at


@construction("middle_span: MIDDLE [n=count]", "middle_span: n=count MIDDLE", cost=0.0)
def middle_span(n: int = 1) -> Span:
    """Compose "middle" and "middle five"."""
    return (0, n)


@construction("mark: at=span [noun=TREE]", "mark: at=middle_span [noun=TREE]", "mark: at=middle_span ONE", cost=0.0)
def tree_mark(at: Span, noun: Lex | None = None) -> tuple[Span, ...] | None:
    """Compose "third tree" and "middle one", one of several spots of a row."""
    return (at,) if noun is None or noun.plural == (size_of(at) != 1) else None


@construction("mark: START", "mark: DET end=FINISH", "mark: [BOTH] [DET] ends=ends", cost=0.0)
def end_mark(end: Lex | None = None, ends: Lex | None = None) -> tuple[Span, ...] | None:
    """Compose "beginning", "the end" and "both ends", among several spots of a row."""
    if end is not None:
        return None if end.plural else BOTH_ENDS[1:]
    return BOTH_ENDS[:1] if ends is None else BOTH_ENDS if ends.plural else None


@construction("marks: at=mark", cost=0.0)
def marks(at: tuple[Span, ...]) -> Positions:
    """Compose "first", the beginning of "first, third and fifth"."""
    return Positions(at)


@construction(
    "marks: first=marks COMMA [AND] [DET] then=mark",
    "marks: first=marks AND [DET] then=mark",
    "marks: first=marks [COMMA] AND word=AT [DET] then=mark",
    "marks: first=marks [COMMA] AND word=OF DET then=mark",
    "marks: first=marks [COMMA] other=OR [DET] then=mark",
    "marks: first=marks COMMA word=AT DET then=mark",
    cost=0.0,
)
def more_marks(
    first: Positions, then: tuple[Span, ...], word: Lex | None = None, other: Lex | None = None
) -> Positions | None:
    """Compose "first, third and fifth", "first tree and the last" and "beginning, the middle and the end"."""
    if not set(first.spans).isdisjoint(then):
        return None
    if len(first.spans) > 1 and first.either != (other is not None):
        return None
    return replace(
        first,
        spans=(*first.spans, *then),
        either=other is not None,
        in_order=first.in_order or word is not None,
    )


# Words before the noun, and nouns of their own.


@construction("chosen: at=marks chosen=chosen", cost=0.0)
def at_positions(at: Positions, chosen: Chosen) -> Chosen | None:
    """Compose "first three yellow trees"."""
    inner = chosen.inner
    if chosen.choice is not None or chosen.count is not None or chosen.unvisited or inner.complete:
        return None
    if inner.kind != "tree" or inner.pronoun or not chooses_from_trees(inner.selector):
        return None
    if len(at.spans) == 1 and (not inner.counts(size_of(at.spans[0])) or at.spans == ((0, 1),)):
        return None
    sizes = [size_of(span) for span in at.spans]
    if inner.plural and sizes[-1] == 1 and max(sizes) > 1:
        return None  # "the three first and last trees": how many last ones?
    return replace(chosen, choice=Choice("at", at), preceded=True)


@construction("chosen: at=marks", cost=0.1)
def spots_of_row(at: Positions) -> Chosen | None:
    """Compose "beginning, the middle and the end" before "of row 4"."""
    return ranks_in_row(at) if (0, 1) in at.spans else None


@construction("chosen: at=marks", cost=0.7)
def ranks_in_row(at: Positions) -> Chosen | None:
    """Compose "first, fifth and last" before "of row 4"."""
    return Chosen(_TREES, choice=Choice("at", replace(at, noun="spots"))) if len(at.spans) > 1 else None


@construction("ends: noun=FINISH", "ends: FINISH noun=TREE", "ends: OUTER noun=TREE", cost=0.0)
def ends(noun: Lex) -> Lex:
    """Compose "ends", "end trees" and "outermost trees", of rows."""
    return noun


@construction("chosen: [n=count] noun=ends", cost=0.0)
def ends_of_row(noun: Lex, n: int | None = None) -> Chosen | None:
    """Compose "two ends" before "of row 4", and "end", which is the last tree."""
    if n not in (None, 2) or (n is not None and not noun.plural):
        return None
    at = Positions(BOTH_ENDS if noun.plural else BOTH_ENDS[1:], noun="end")
    return Chosen(replace(_TREE, plural=noun.plural), choice=Choice("at", at))


@construction("chosen: one=DIR AND [DET] other=DIR FINISH", cost=0.0)
def ends_on_sides(one: Lex, other: Lex) -> Chosen | None:
    """Compose "north and the south end" before "of row 4"."""
    if {one.value, other.value} not in ({"north", "south"}, {"east", "west"}):
        return None
    return Chosen(_TREES, choice=Choice("at", Positions(BOTH_ENDS, noun="end")))


@construction("chosen: START", cost=0.1)
def beginning_of_row() -> Chosen:
    """Compose "beginning" before "of row 4"."""
    return Chosen(_TREE, choice=Choice("at", Positions(BOTH_ENDS[:1], noun="start")))


@construction(
    "row_end: side=DIR FINISH", "row_end: side=DIR part=SIDE", "row_end: marker=marker FINISH",
    cost=0.0, given=("site",),
)  # fmt: skip
def row_end(
    site: Site, side: Lex | None = None, marker: s.Selector | None = None, part: Lex | None = None
) -> Positions | None:
    """Compose "northern end" and "charger end" of a row: its first tree, counted from there."""
    if (side is not None and side.value not in SIDES) or (part is not None and "borders" not in part.features):
        return None
    ways = {block.runs_east_west for block in site.planting.blocks}
    if part is not None and side is not None and ways and (side.value in ("east", "west")) not in ways:
        return None  # "the west side of row 4", which runs north to south
    at = Positions(BOTH_ENDS[:1], near=marker, noun="side")
    return at if side is None else replace(at, counted_from=side.value)


@construction("chosen: at=row_end [TREE]", cost=0.0)
def end_on_side(at: Positions) -> Chosen:
    """Compose "northern end" before "of row 4"."""
    return Chosen(_TREE, choice=Choice("at", at))


@construction("chosen: trees=tree_ids", cost=0.0)
def by_numbers(trees: tuple[str, ...]) -> Chosen:
    """Compose "tree 5" before "of row 3"."""
    return Chosen(replace(_TREE, plural=len(trees) > 1), choice=Choice("numbered", TreeNumbers(trees)))


# Words behind the noun.


@construction(
    "stretch: FROM [DET] at=positions [ONE]",
    "stretch: FROM [DET] at=positions TREE",
    "stretch: FROM [DET] first=position [TREE] ONWARDS",
    "stretch: FROM [DET] first=position [TREE] range_to [DET] FINISH",
    cost=0.0,
)
def stretch(at: Span | None = None, first: Span | None = None) -> Span | None:
    """Compose "from the third to the tenth" and "from the fifth on" behind a row."""
    return at if first is None else (first[0], -1)


@construction("chosen: chosen=chosen at=stretch", cost=0.1)
def trees_from_to(chosen: Chosen, at: Span) -> Chosen | None:
    """Compose "trees from the third to the tenth"."""
    inner = replace(chosen.inner, plural=True)
    made = at_positions(Positions((at,)), replace(chosen, inner=inner))
    if made is None or chosen.inner.plural:
        return made
    return replace(made, choice=Choice("at", Positions((at,), noun="stretch")))  # "every tree from the third on"


@construction("place: rows=rows [COMMA] at=stretch", cost=0.2, given=("site",))
def stretch_of_row(rows: s.Selector, at: Span, site: Site) -> list[PlaceMeaning] | None:
    """Compose "row 4 from the fifth tree on"."""
    return trees_counted(replace(_TREES, selector=rows), Positions((at,)), site)


@construction(
    "place: rows=rows [COMMA] FROM trees=tree_ids ONWARDS",
    "place: rows=rows [COMMA] FROM trees=tree_ids range_to [DET] FINISH",
    "place: [DET] trees=tree_ids ONWARDS in_ rows=rows",
    cost=0.1,
    given=("site",),
)
def from_number_on(rows: s.Selector, trees: tuple[str, ...], site: Site) -> list[PlaceMeaning] | None:
    """Compose "row 2 from tree 3 to the end", where the tree with that id does not stand in the row."""
    if len(trees) > 1 or not trees[0].isdigit() or not is_one_row(rows) or trees[0] in (ids_of(rows, site) or ()):
        return None
    return stretch_of_row(rows, (int(trees[0]), -1), site)


@construction(
    "chosen: chosen=chosen [EACH] [COMMA] COUNTED [DET] side=DIR [FINISH]",
    "chosen: chosen=chosen [EACH] [COMMA] COUNTED [DET] side=DIR SIDE",
    cost=0.1,
)
def counting_from(chosen: Chosen, side: Lex) -> Chosen | None:
    """Compose "trees 4 to 9, counted from the south"."""
    counted = counted_from(replace(chosen, inner=replace(chosen.inner, selector=s.Trees())), side)
    return None if counted is None else replace(counted, inner=chosen.inner)


@construction("chosen: chosen=chosen FROM DET noun=FINISH", "chosen: chosen=chosen FROM each=EACH FINISH", cost=0.0)
def from_the_end(chosen: Chosen, noun: Lex | None = None, each: Lex | None = None) -> Chosen | None:
    """Compose "third tree from the end" and "second tree from each end"."""
    at = _as_positions(chosen)
    if at is None or at.noun or (noun is not None and noun.plural) or at.counted_from != "usual":
        return None
    behind = tuple(map(backwards, at.spans))
    spans = behind if each is None else (*at.spans, *behind)
    return replace(chosen, choice=Choice("at", replace(at, spans=spans)))


@construction(
    "chosen: chosen=chosen in_ DET noun=FINISH",
    "chosen: chosen=chosen in_ DET at=row_end",
    "chosen: chosen=chosen in_ each=EACH noun=FINISH",
    "chosen: chosen=chosen in_ DET two=count noun=FINISH",
    cost=0.0,
)
def at_the_end(
    chosen: Chosen, noun: Lex | None = None, at: Positions | None = None, each: Lex | None = None, two: int = 2
) -> Chosen | None:
    """Compose "two trees at the southern end", "tree at each end" and "trees at the two ends"."""
    inner, n = chosen.inner, chosen.count
    if two != 2:
        return None
    if (first := _as_positions(chosen)) is not None and at is not None and first == Positions(BOTH_ENDS[:1]):
        return replace(chosen, choice=Choice("at", replace(at, noun="")))
    if chosen.choice is not None or inner.kind != "tree" or not chooses_from_trees(inner.selector):
        return None
    if n is None and inner.plural and each is None and (noun is None or not noun.plural):
        return None
    ends = noun is not None and (noun.plural or each is not None)
    n = (n or 1) // (2 if ends and each is None and n == 2 else 1)
    made = Positions(((-n, -1),)) if at is None else replace(at, spans=((1, n),), noun="")
    if ends:
        made = Positions(((1, n), (-n, -1)), each=n == 1 and each is not None and "two" not in each.features)
    return replace(chosen, count=None, choice=Choice("at", made))


@construction("chosen: chosen=chosen in_ DET MIDDLE", cost=0.1)
def in_the_middle(chosen: Chosen) -> Chosen | None:
    """Compose "five trees in the middle" before "of row 4"."""
    if chosen.count is None or chosen.count < 2:
        return None
    return at_positions(Positions(((0, chosen.count),)), replace(chosen, count=None))


@construction("chosen: chosen=chosen COMMA in_ rows=each_row", cost=0.0)
def in_rows_behind(chosen: Chosen, rows: s.Selector) -> Chosen | None:
    """Compose "fifth tree, counted from the south, in each row"."""
    at = None if chosen.choice is None else chosen.choice.value
    return in_rows(chosen, rows) if getattr(at, "counted_from", "usual") != "usual" else None


@construction("chosen: chosen=chosen way=in_ rows=any_rows", cost=0.0)
def in_rows(chosen: Chosen, rows: s.Selector, way: str = "in") -> Chosen | None:
    """Compose "first three trees in every row"."""
    choice = chosen.choice
    if choice is None or not isinstance(choice.value, Positions | TreeNumbers):
        return None
    if not chooses_from_trees(chosen.inner.selector) or (there := inside(chosen.inner, rows, way)) is None:
        return None
    if isinstance(choice.value, TreeNumbers) and rows == s.Rows():
        choice = replace(choice, value=replace(choice.value, in_each_row=True))
    return replace(chosen, choice=choice, inner=there)


def _as_positions(chosen: Chosen) -> Positions | None:
    """Return the positions of a description; None if it has none."""
    value = None if chosen.choice is None else chosen.choice.value
    return value if isinstance(value, Positions) else None


# Places.


@construction("place: [word=DET] chosen=chosen", cost=0.0, given=("site",))
def by_number(chosen: Chosen, site: Site, word: Lex | None = None) -> list[PlaceMeaning] | None:
    """Compose "the first three trees in row 4", trees that are counted along their rows."""
    choice = chosen.choice
    if choice is None or chosen.count is not None or chosen.unvisited:
        return None
    if isinstance(choice.value, TreeNumbers):
        return trees_numbered(chosen.inner, choice.value, site)
    at = _as_positions(chosen)
    if at is None or at.noun == "stretch" or (at.noun == "end" and word is None and not chosen.inner.plural):
        return None  # "end" is a command rather than a place
    return trees_counted(chosen.inner, at, site)


@construction("place: [DET] kind=ATTRVAL trees=numbers", cost=0.1, given=("site",))
def numbered_of_a_crop(kind: Lex, trees: tuple[str, ...], site: Site) -> list[PlaceMeaning] | None:
    """Compose "cabbage 12" where the ids of plants are no numbers: the twelfth of a row of cabbages."""
    if any(tree.place.id.isdigit() for tree in site.trees) or not all(name.isdigit() for name in trees):
        return None
    at = Positions(tuple(runs(trees)))
    kinds = [s.Where(attribute=name, test="eq", value=text) for name, text in kind.value if is_kind_attribute(name)]
    plants = [Nominal(one, plural=len(trees) > 1) for one in kinds]
    return [place for one in plants for place in trees_counted(one, at, site) or ()] or None


@construction("place: each=EACH chosen=chosen", cost=0.1, given=("site",))
def each_by_number(each: Lex, chosen: Chosen, site: Site) -> list[PlaceMeaning] | None:
    """Compose "each end of row 4" and "every tree of row 4 from the fifth on"."""
    at = _as_positions(chosen)
    if at is None or at.noun not in ("end", "stretch"):
        return None
    if at.noun == "end":
        at = replace(at, spans=BOTH_ENDS, each="two" not in each.features)
    return trees_counted(chosen.inner, at, site)


@construction(
    "place: rows=rows comma=COMMA [DET] chosen=chosen",
    "place: rows=each_rows chosen=chosen",
    "place: in_ rows=each_row [COMMA] [DET] chosen=chosen",
    cost=0.1,
    given=("site",),
)
def behind_their_rows(
    rows: s.Selector, chosen: Chosen, site: Site, comma: Lex | None = None
) -> list[PlaceMeaning] | None:
    """Compose "row 3, trees 4 to 9", "row 3's northern end" and "every row's first tree"."""
    there, at = in_rows(chosen, rows), _as_positions(chosen)
    aside = comma is not None and at is not None and at.noun != ""
    places = None if there is None or aside else by_number(there, site)
    if places is None or comma is None or not chosen.inner.pronoun:
        return places
    # "two pictures of row 3, one at each end": one of the two
    return [replace(one, each=False, count=len(one.selector.members)) for one in places]


@construction("place: rows=rows trees=tree_ids", cost=0.1, given=("site",))
def numbers_behind_rows(rows: s.Selector, trees: tuple[str, ...], site: Site) -> list[PlaceMeaning] | None:
    """Compose "row 3 trees 4 to 9"."""
    return behind_their_rows(rows, by_numbers(trees), site)


@construction("place: [word=DET] chosen=chosen [EACH]", cost=0.4)
def of_the_row_named_before(chosen: Chosen, word: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the third tree" and "trees 4 to 8 counted from the south", of a row that was named before it."""
    at = None if chosen.choice is None else chosen.choice.value
    if not isinstance(at, Positions | TreeNumbers) or (word is not None and "definite" not in word.features):
        return None
    return of_row_named_before(chosen.inner, at) if chosen.count is None else None


@construction("place: DET rank=ORD", "place: [DET] rank=ORD FROM [DET] side=DIR", cost=0.6)
def ranked_of_the_row(rank: Lex, side: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the third from the north", of a row that was named before it."""
    if side is not None and side.value not in SIDES:
        return None
    at = Positions(((rank.value, rank.value),), counted_from="usual" if side is None else side.value)
    return of_row_named_before(_TREE, at)


@construction(
    "start: STARTING [DET] side=DIR",
    "start: STARTING [DET] side=DIR FINISH",
    "start: STARTING [DET] side=DIR SIDE",
    "start: STARTING [DET] side=MOST [TREE]",
    "start: STARTING [DET] side=MOST ONE",
    "start: STARTING ITS side=MOST [TREE]",
    "start: STARTING [DET] [rank=ORD] TREE AT [DET] side=DIR FINISH [in_] [any_rows]",
    "start: STARTING DET ONE AT [DET] side=DIR FINISH",
    "start: STARTING [DET] side=DIR FINISH in_ any_rows",
    cost=0.1,
)
def from_side(side: Lex, rank: Lex | None = None) -> Side | None:
    """Compose "starting from the north" and "starting with the first tree at the north end"."""
    return side.value if side.value in SIDES and (rank is None or rank.value == 1) else None


@construction(
    "start: side=start [COMMA] [AND] GOING [AT] [DET] to=DIR",
    "start: FROM [DET] begin=DIR range_to [DET] to=DIR",
    cost=0.1,
)
def from_side_and_on(to: Lex, side: Side | None = None, begin: Lex | None = None) -> Side | None:
    """Compose "starting from the south and working north" and "from south to north"."""
    side = side if begin is None else begin.value
    return side if side is not None and AWAY_FROM.get(side, "").endswith(f"_to_{to.value}") else None


@construction(
    "place: DET side=DIR noun=FINISH",
    "place: DET TREE AT DET side=DIR noun=FINISH",
    "place: DET ONE AT DET side=DIR noun=FINISH",
    "place: ITS side=DIR noun=FINISH",
    cost=1.2,
)
def end_of_that_row(side: Lex, noun: Lex) -> PlaceMeaning | None:
    """Compose "the south end", of the row that was spoken of."""
    if side.value not in SIDES or noun.plural:
        return None
    return PlaceMeaning(s.InRow(first=1, last=1, counted_from=side.value, of=s.RowOf()), "one")


@construction("place: DET noun=FINISH OF rows=rows NEAREST [AT] to=place", cost=0.1)
def nearer_end(noun: Lex, rows: s.Selector, to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the end of row 3 nearest to the charger"."""
    if noun.plural or not is_one_row(rows) or to.shape != "one":
        return None
    ends = s.UnionOf(parts=(s.InRow(first=1, last=1, of=rows), s.InRow(first=-1, last=-1, of=rows)))
    return PlaceMeaning(s.Nearest(to=to.selector, of=ends), "one")


@construction("place: [BOTH] [DET] at=marks inner=nominal", cost=0.2)
def first_and_last(at: Positions, inner: Nominal) -> PlaceMeaning | None:
    """Compose "both the first and the last tree", those of the site or of a row that was named before."""
    if at.spans != BOTH_ENDS or at.either or inner.plural or inner.single or inner.selector != s.Trees():
        return None
    return PlaceMeaning(s.UnionOf(parts=(s.First(), s.Last())), "several", count=2, in_order=at.in_order)


@construction("each_rows: EACH ROWPOSS", "each_rows: rows=rows POSS", cost=0.0)
def each_rows(rows: s.Selector | None = None) -> s.Selector:
    """Compose "every row's" and "row 3's"."""
    return rows or s.Rows()


@construction("fraction: HALF", cost=0.0)
def half_share() -> int:
    """Compose "half" of a row."""
    return 2


@construction("fraction: QUARTER", cost=0.0)
def quarter_share() -> int:
    """Compose "quarter" of a row."""
    return 4


@construction("fraction: rank=ORD", cost=0.0)
def third_share(rank: Lex) -> int | None:
    """Compose "third" of a row."""
    return 3 if rank.value == 3 else None


@construction(
    "row_part: [DET] rank=ORD of=fraction",
    "row_part: [DET] last=LAST of=fraction",
    "row_part: [DET] MIDDLE of=fraction",
    "row_part: [DET] side=DIR of=fraction",
    cost=0.1,
)
def row_part(
    of: int, rank: Lex | None = None, last: Lex | None = None, side: Lex | None = None
) -> tuple[int, int, CountedFrom] | None:
    """Compose "first third" and "northern half" of a row: which part, of how many, and from where they are counted."""
    if side is not None:
        return (1, of, side.value) if side.value in SIDES else None
    number = of if last is not None else rank.value if rank is not None else 2
    if number > of or (last is None and rank is None and of != 3):
        return None
    return (number, of, "usual")


@construction("region: part=row_part in_ rows=rows", cost=0.1, given=("site",))
def part_of_row(part: tuple[int, int, CountedFrom], rows: s.Selector, site: Site) -> s.Selector | None:
    """Compose "the northern half of row 2"; a tree in its middle belongs to both halves."""
    number, of, side = part
    there = ids_of(s.InRow(first=1, last=1, counted_from=side, of=rows), site) if is_one_row(rows) else None
    length = len(ids_of(rows, site) or ())
    if not there or length < of:
        return None
    first, last = length * (number - 1) // of + 1, -(-length * number // of)
    if number == of and number > 1:
        return s.InRow(first=first - length - 1, last=-1, of=rows)
    return s.InRow(first=first, last=last, counted_from=side, of=rows)


@construction(
    "place: OUTOF m=count inner=nominal AT DET ROW [PASSED] [COMMA] n=count [OFTHEM]",
    "place: OUTOF DET ROW OF m=count inner=nominal [PASSED] [COMMA] n=count [OFTHEM]",
    "place: n=count OUTOF m=count inner=nominal AT DET ROW",
    "place: n=count OUTOF DET ROW OF m=count inner=nominal",
    cost=0.2,
)
def some_of_a_row(n: int, m: int, inner: Nominal) -> PlaceMeaning | None:
    """Compose "out of a row of six trees, two"."""
    if n >= m or inner.single or inner.complete or not inner.plural or inner.kind != "tree":
        return None
    return PlaceMeaning(s.Evenly(count=n, of=s.Successive(count=m, of=inner.selector)), "several", count=n)


@construction("place: [DET] number=row_parity noun=TREE in_ rows=any_rows", cost=0.1)
def trees_of_parity(number: int, noun: Lex, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the even-numbered trees of row 3"."""
    return PlaceMeaning(s.EveryNth(nth=2, start=number, of=rows), "several", each=True) if noun.plural else None
