"""Constructions of positions in rows: "third", "first and last", every third tree, the ends of a row."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning, Shape
from fieldhand.planning.grammar.places.compass import AWAY_FROM, SIDES
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.row_by_row import MOST_ONE_BY_ONE, one_by_one
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, as_every_nth, as_in_row, chooses_from_trees, is_one_row, over
from fieldhand.site.model import Site
from fieldhand.terms import CountedFrom, Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Trees that "points" along a row stand for.
_TREES = Nominal(s.Trees(), plural=True)


@construction("position: rank=ORD", cost=0.0)
def ordinal_position(rank: Lex) -> tuple[int, int]:
    """Compose "third"."""
    return (rank.value, rank.value)


@construction("position: rank=ORD AT LAST", "position: rank=ORD LAST", cost=0.0)
def position_from_end(rank: Lex) -> tuple[int, int]:
    """Compose "third to last"."""
    return (-rank.value, -rank.value)


@construction("position: PENULT", cost=0.0)
def penultimate() -> tuple[int, int]:
    """Compose "penultimate"."""
    return (-2, -2)


@construction("position: LAST", cost=0.0)
def last_position() -> tuple[int, int]:
    """Compose "last"."""
    return (-1, -1)


@construction(
    "place: [DET] where=position inner=nominal in_ rows=any_rows",
    "place: [DET] where=position inner=nominal in_ rows=rows AND in_ more=rows",
    cost=0.2,
)
def tree_of_row(
    where: tuple[int, int], inner: Nominal, rows: s.Selector, more: s.Selector | None = None
) -> PlaceMeaning | None:
    """Compose "the third tree in row 4"."""
    if more is not None:
        rows = s.UnionOf(parts=(*rows.members, *more.members))
    if inner.plural or inner.single or not chooses_from_trees(inner.selector):
        return None
    selector = s.InRow(first=where[0], last=where[1], of=over(inner.selector, rows))
    return PlaceMeaning(selector, "one" if is_one_row(rows) else "several", each=not is_one_row(rows))


@construction("span: at=position", "span: at=positions", cost=0.0)
def span(at: tuple[int, int]) -> tuple[int, int]:
    """Compose "third" or "first three"."""
    return at


@construction(
    "place: [DET] first=span AND [DET] second=span inner=nominal in_ rows=any_rows",
    "place: DET first=span AND AT DET second=span inner=nominal in_ rows=any_rows",
    "place: DET first=span AND OF DET second=span inner=nominal in_ rows=any_rows",
    cost=0.2,
)
def two_trees_of_row(
    first: tuple[int, int], second: tuple[int, int], inner: Nominal, rows: s.Selector
) -> PlaceMeaning | None:
    """Compose "the first and last trees in row 4"."""
    if inner.single or not chooses_from_trees(inner.selector):
        return None
    of = over(inner.selector, rows)
    parts = tuple(s.InRow(first=at[0], last=at[1], of=of) for at in (first, second))
    count = sum(at[1] - at[0] + 1 for at in (first, second)) if is_one_row(rows) else None
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=count)


@construction("place: [DET] first=span one=nominal AND [DET] second=span [other=nominal] in_ rows=any_rows", cost=0.2)
def two_positions_of_row(
    first: tuple[int, int], one: Nominal, second: tuple[int, int], rows: s.Selector, other: Nominal | None = None
) -> PlaceMeaning | None:
    """Compose "the first tree and the last tree in row 4"."""
    if (other is not None and one.selector != other.selector) or one.plural != (first[0] != first[1]):
        return None
    return two_trees_of_row(first, second, one, rows)


@construction("position_list: rank=ORD COMMA other=ORD", "position_list: rank=ORD AND other=ORD", cost=0.1)
def two_positions(rank: Lex, other: Lex) -> tuple[int, ...]:
    """Compose "first and third"."""
    return (rank.value, other.value)


@construction(
    "position_list: first=position_list COMMA other=ORD",
    "position_list: first=position_list [COMMA] AND other=ORD",
    cost=0.1,
)
def more_positions(first: tuple[int, ...], other: Lex) -> tuple[int, ...]:
    """Compose "first, third and fifth"."""
    return (*first, other.value)


@construction(
    "place: [DET] at=position_list inner=nominal in_ rows=any_rows",
    cost=0.2,
)
def trees_at_positions(at: tuple[int, ...], inner: Nominal, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the first, third and fifth trees in row 4"."""
    if inner.single or not chooses_from_trees(inner.selector):
        return None
    of = over(inner.selector, rows)
    return PlaceMeaning(
        s.UnionOf(parts=tuple(s.InRow(first=n, last=n, of=of) for n in at)),
        "several",
        count=len(at) if is_one_row(rows) else None,
    )


@construction("positions: rank=ORD n=count", cost=0.0)
def first_so_many(rank: Lex, n: int) -> tuple[int, int] | None:
    """Compose "first three"."""
    return (1, n) if rank.value == 1 and n > 1 else None


@construction("positions: first=ORD range_to [DET] LAST", cost=0.0)
def from_rank_to_last(first: Lex) -> tuple[int, int]:
    """Compose "third to the last"."""
    return (first.value, -1)


@construction("positions: first=ORD range_to [DET] last=ORD", cost=0.0)
def from_rank_to_rank(first: Lex, last: Lex) -> tuple[int, int] | None:
    """Compose "tenth to the twentieth"."""
    return (first.value, last.value) if first.value < last.value else None


@construction("positions: LAST n=count", cost=0.0)
def last_so_many(n: int) -> tuple[int, int] | None:
    """Compose "last three"."""
    return (-n, -1) if n > 1 else None


@construction(
    "place: [DET] where=positions inner=nominal in_ rows=any_rows",
    "place: [DET] inner=nominal FROM [DET] where=positions in_ rows=any_rows",
    "place: [DET] inner=nominal FROM [DET] where=positions ONE in_ rows=any_rows",
    "place: [DET] inner=nominal in_ rows=any_rows FROM [DET] where=positions",
    "place: EACH inner=nominal in_ rows=any_rows FROM [DET] where=positions",
    "place: rows=rows FROM [DET] where=positions [TREE]",
    cost=0.2,
)
def trees_of_row(where: tuple[int, int], rows: s.Selector, inner: Nominal = _TREES) -> PlaceMeaning | None:
    """Compose "the first three trees in row 4"."""
    if inner.single or not chooses_from_trees(inner.selector):
        return None
    known = is_one_row(rows) and where[0] * where[1] > 0
    count = where[1] - where[0] + 1 if known else None
    return PlaceMeaning(s.InRow(first=where[0], last=where[1], of=over(inner.selector, rows)), "several", count=count)


@construction(
    "place: [DET] rank=ORD inner=nominal",
    "place: DET rank=ORD",
    "place: [DET] rank=ORD inner=nominal [COMMA] FROM [DET] side=DIR",
    "place: [DET] rank=ORD FROM [DET] side=DIR",
    "place: [DET] rank=ORD inner=nominal EACH",
    cost=0.6,
)
def tree_of_row_named_before(rank: Lex, inner: Nominal | None = None, side: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the third tree" and "the third from the north", of a row that was named before it."""
    if side is not None and side.value not in SIDES:
        return None
    if (rank.value < 2 and side is None) or (
        inner is not None and (inner.plural or inner.selector != s.Trees() or inner.kind != "tree")
    ):
        return None
    tree = s.InRow(first=rank.value, last=rank.value, of=s.Trees())
    return PlaceMeaning(tree if side is None else replace(tree, counted_from=side.value), "one")


@construction(
    "place: [DET] inner=nominal FROM [DET] where=positions",
    "place: [DET] where=positions inner=nominal",
    cost=0.6,
)
def trees_of_row_named_before(where: tuple[int, int], inner: Nominal) -> PlaceMeaning | None:
    """Compose "the trees from the third to the tenth", of a row that was named before them."""
    if not 0 < where[0] < where[1] or inner.selector != s.Trees() or inner.kind != "tree" or inner.single:
        return None
    selector = s.InRow(first=where[0], last=where[1], of=s.Trees())
    return PlaceMeaning(selector, "several", count=where[1] - where[0] + 1)


@construction(
    "place: [DET] at=span inner=nominal FROM [DET] side=DIR [FINISH] in_ rows=any_rows",
    cost=0.1,
)
def trees_from_side(at: tuple[int, int], inner: Nominal, side: Lex, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the third tree from the north in row 4" and "the first three trees from the south of row 2"."""
    number = at[1] - at[0] + 1
    if inner.plural != (number > 1) or inner.single or inner.selector != s.Trees() or side.value not in SIDES:
        return None
    selector = s.InRow(first=at[0], last=at[1], counted_from=side.value, of=rows)
    if not is_one_row(rows):
        return PlaceMeaning(selector, "several")
    return PlaceMeaning(selector, "one") if number == 1 else PlaceMeaning(selector, "several", count=number)


@construction(
    "place: [DET] rank=ORD inner=nominal FROM DET FINISH in_ rows=any_rows",
    "place: [DET] rank=ORD inner=nominal FROM each=EACH FINISH in_ rows=any_rows",
    cost=0.1,
)
def tree_from_end(rank: Lex, inner: Nominal, rows: s.Selector, each: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the third tree from the end of row 4" and "the second tree from each end of row 4"."""
    if inner.plural or inner.single or inner.selector != s.Trees():
        return None
    if each is not None:
        parts = tuple(s.InRow(first=k, last=k, of=rows) for k in (rank.value, -rank.value))
        return PlaceMeaning(s.UnionOf(parts=parts), "several", count=2 if is_one_row(rows) else None)
    one: Shape = "one" if is_one_row(rows) else "several"
    return PlaceMeaning(s.InRow(first=-rank.value, last=-rank.value, of=rows), one)


@construction(
    "place: [DET] side=DIR FINISH [TREE] in_ rows=any_rows",
    "place: rows=each_rows side=DIR FINISH [TREE]",
    cost=0.1,
)
def end_of_row(side: Lex, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the northern end of row 4"."""
    if side.value not in SIDES:
        return None
    one = is_one_row(rows)
    return PlaceMeaning(
        s.InRow(first=1, last=1, counted_from=side.value, of=rows), "one" if one else "several", each=not one
    )


@construction(
    "place: [DET] n=count inner=nominal in_ DET [side=DIR] noun=FINISH in_ rows=any_rows",
    "place: [DET] n=count inner=nominal in_ each=EACH noun=FINISH in_ rows=any_rows",
    cost=0.1,
)
def trees_at_end(
    n: int, inner: Nominal, noun: Lex, rows: s.Selector, side: Lex | None = None, each: Lex | None = None
) -> PlaceMeaning | None:
    """Compose "the two trees at the southern end of row 4" and "two trees at each end of row 4"."""
    if inner.single or inner.plural != (n > 1) or not chooses_from_trees(inner.selector):
        return None
    if (side is not None and side.value not in SIDES) or (noun.plural and each is None):
        return None
    of = over(inner.selector, rows)
    if each is not None:
        ends = (s.InRow(first=1, last=n, of=of), s.InRow(first=-n, last=-1, of=of))
        return PlaceMeaning(s.UnionOf(parts=ends), "several", count=2 * n if is_one_row(rows) else None)
    run = (
        s.InRow(first=-n, last=-1, of=of) if side is None else s.InRow(first=1, last=n, counted_from=side.value, of=of)
    )
    one = n == 1 and is_one_row(rows)
    return PlaceMeaning(run, "one" if one else "several", count=n if is_one_row(rows) else None)


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
    "place: DET MIDDLE n=count inner=nominal in_ rows=rows",
    "place: DET n=count MIDDLE inner=nominal in_ rows=rows",
    "place: DET n=count inner=nominal in_ DET MIDDLE in_ rows=rows",
    cost=0.1,
    given=("site",),
)
def middle_trees_of_row(n: int, inner: Nominal, rows: s.Selector, site: Site) -> list[PlaceMeaning] | None:
    """Compose "the middle five trees of row 4": of an even number of trees there are two such runs."""
    left = len(ids_of(rows, site) or ()) - n
    if inner.selector != s.Trees() or not inner.plural or n < 2 or left < 0 or not is_one_row(rows):
        return None
    starts = {left // 2 + 1, (left + 1) // 2 + 1}
    return [PlaceMeaning(s.InRow(first=k, last=k + n - 1, of=rows), "several", count=n) for k in sorted(starts)]


@construction("place: rows=rows FROM [DET] rank=ORD [TREE] ONWARDS", cost=0.1)
def row_from_position(rows: s.Selector, rank: Lex) -> PlaceMeaning | None:
    """Compose "row 4 from the fifth tree on"."""
    return PlaceMeaning(s.InRow(first=rank.value, last=-1, of=rows), "several") if is_one_row(rows) else None


@construction("ends: noun=FINISH", "ends: FINISH noun=TREE", cost=0.0)
def ends(noun: Lex) -> Lex:
    """Compose "ends" and "end trees", of rows."""
    return noun


@construction(
    "place: noun=ends in_ rows=any_rows",
    "place: rows=each_rows noun=ends",
    "place: each=EACH noun=ends in_ rows=any_rows",
    "place: [DET] n=count noun=ends in_ rows=any_rows",
    "place: DET noun=ends in_ rows=any_rows",
    "place: TREE AT each=EACH noun=FINISH in_ rows=any_rows",
    "place: DET TREE AT each=EACH noun=FINISH in_ rows=any_rows",
    cost=0.1,
)
def both_ends(noun: Lex, rows: s.Selector, n: int = 2, each: Lex | None = None) -> PlaceMeaning | None:
    """Compose "both ends of row 4" and "each end of row 4"."""
    if n != 2 or not (noun.plural or each is not None):
        return None
    parts = (s.InRow(first=1, last=1, of=rows), s.InRow(first=-1, last=-1, of=rows))
    one_by_one = each is not None and "two" not in each.features
    return PlaceMeaning(s.UnionOf(parts=parts), "several", count=2 if is_one_row(rows) else None, each=one_by_one)


@construction("place: [DET] [n=count] OUTER noun=TREE in_ rows=any_rows", cost=0.0)
def outer_trees_of_rows(noun: Lex, rows: s.Selector, n: int = 2) -> PlaceMeaning | None:
    """Compose "the outermost trees of each row", those at its ends."""
    return both_ends(noun, rows, n)


@construction("mark: [DET] at=position [TREE]", cost=0.0)
def mark(at: tuple[int, int]) -> tuple[int, ...] | None:
    """Compose "the third tree", one of several spots of a row: its number, or 0 for the middle."""
    return (at[0],) if at[0] == at[1] else None


@construction("mark: [DET] MIDDLE [ONE]", "mark: [DET] MIDDLE TREE", cost=0.0)
def middle_mark() -> tuple[int, ...]:
    """Compose "the middle", one of several spots of a row."""
    return (0,)


@construction("mark: [DET] START", cost=0.0)
def first_mark() -> tuple[int, ...]:
    """Compose "the beginning", one of several spots of a row."""
    return (1,)


@construction("mark: [BOTH] [DET] noun=ends", cost=0.0)
def end_mark(noun: Lex) -> tuple[int, ...]:
    """Compose "the end" and "both ends", among several spots of a row."""
    return (1, -1) if noun.plural else (-1,)


@construction(
    "marks: first=mark [COMMA] [AND] [AT] then=mark", "marks: first=marks [COMMA] [AND] [AT] then=mark", cost=0.0
)
def marks(first: tuple[int, ...], then: tuple[int, ...]) -> tuple[int, ...] | None:
    """Compose "the beginning, the middle and the end"."""
    return (*first, *then) if set(first).isdisjoint(then) else None


@construction("place: at=marks [inner=nominal] in_ rows=any_rows", cost=0.2, given=("site",))
def spots_of_rows(
    at: tuple[int, ...], rows: s.Selector, site: Site, inner: Nominal | None = None
) -> PlaceMeaning | None:
    """Compose "the first, the middle and the last tree of rows 1 and 5"."""
    if inner is not None and (inner.single or not chooses_from_trees(inner.selector)):
        return None
    parts: list[s.Selector] = []
    single = one_by_one(rows, site)
    if not 0 < len(single) <= MOST_ONE_BY_ONE or 0 not in at:
        return None  # without the middle, rows need not be named one by one
    for row in single:
        of = row if inner is None else over(inner.selector, row)
        parts += (s.Middle(of=of) if number == 0 else s.InRow(first=number, last=number, of=of) for number in at)
    return PlaceMeaning(s.UnionOf(parts=tuple(parts)), "several", count=len(parts) if is_one_row(rows) else None)


@construction("place: [DET] START AND [AT] DET noun=FINISH in_ rows=any_rows", cost=0.1)
def beginning_and_end(noun: Lex, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the beginning and the end of row 4"."""
    return None if noun.plural else both_ends(replace(noun, plural=True), rows)


@construction("place: [DET] START in_ rows=any_rows", cost=0.2)
def beginning_of_row(rows: s.Selector) -> PlaceMeaning:
    """Compose "the beginning of row 4"."""
    single = is_one_row(rows)
    return PlaceMeaning(s.InRow(first=1, last=1, of=rows), "one" if single else "several", each=not single)


@construction(
    "start: STARTING [DET] side=DIR",
    "start: STARTING [DET] side=DIR FINISH",
    "start: STARTING [DET] side=DIR SIDE",
    "start: STARTING [DET] side=MOST [TREE]",
    "start: STARTING [DET] side=MOST ONE",
    "start: STARTING ITS side=MOST [TREE]",
    "start: STARTING [DET] [rank=ORD] TREE AT [DET] side=DIR FINISH [in_] [any_rows]",
    "start: STARTING [DET] side=DIR FINISH in_ any_rows",
    cost=0.1,
)
def from_side(side: Lex, rank: Lex | None = None) -> Side | None:
    """Compose "starting from the north" and "starting with the first tree at the north end"."""
    return side.value if side.value in SIDES and (rank is None or rank.value == 1) else None


@construction("start: side=start [COMMA] [AND] GOING [AT] [DET] to=DIR", cost=0.1)
def from_side_and_on(side: Side, to: Lex) -> Side | None:
    """Compose "starting from the south and working north"."""
    return side if AWAY_FROM.get(side, "").endswith(f"_to_{to.value}") else None


@construction(
    "place: whole=place [COMMA] COUNTED [DET] side=DIR",
    "place: whole=place [COMMA] COUNTED [DET] side=DIR FINISH",
    "place: whole=place [COMMA] COUNTED [DET] side=DIR SIDE",
    cost=0.3,
)
def counted_from(whole: PlaceMeaning, side: Lex) -> PlaceMeaning | None:
    """Compose "every other tree of row 6 counted from the south" and "trees 4 to 8 of row 3 counted from the south"."""
    counted = as_every_nth(whole.selector) or as_in_row(whole.selector) or _as_positions(whole.selector)
    if counted is None or counted.counted_from != "usual" or side.value not in SIDES:
        return None
    return replace(whole, selector=replace(counted, counted_from=side.value))


def _as_positions(selector: s.Selector) -> s.InRow | None:
    """Return trees with successive numbers as positions of a row that was named before; None for others."""
    numbers = [int(one.named_tree) for one in selector.members if one.named_tree.isdigit()]
    if len(numbers) != len(selector.members) or numbers != list(range(numbers[0], numbers[-1] + 1)):
        return None
    return s.InRow(first=numbers[0], last=numbers[-1])


@construction(
    "place: [DET] n=count inner=nominal AT word=DET noun=ROW",
    "place: word=DET noun=ROW OF n=count inner=nominal",
    cost=0.1,
)
def trees_in_a_row(n: int, inner: Nominal, word: Lex, noun: Lex) -> PlaceMeaning | None:
    """Compose "four trees in a row"."""
    if noun.plural or "one" not in word.features or inner.single or inner.complete or n < 2:
        return None
    return PlaceMeaning(s.Successive(count=n, of=inner.selector), "several", count=n)


@construction(
    "place: [DET] TREE AT DET noun=FINISH in_ rows=rows",
    "place: DET noun=FINISH OF rows=rows",
    cost=0.2,
)
def end_tree(noun: Lex, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the tree at the end of row 3"."""
    if noun.plural or not is_one_row(rows):
        return None
    return PlaceMeaning(s.InRow(first=-1, last=-1, of=rows), "one")


@construction(
    "place: [DET] TREE AT DET side=DIR FINISH in_ rows=any_rows",
    cost=0.1,
)
def tree_at_end(side: Lex, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the tree at the south end of row 8"."""
    return end_of_row(side, rows)


@construction("place: [DET] TREE AT [DET] noun=FINISH in_ rows=any_rows", cost=0.2)
def trees_at_ends(noun: Lex, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "the trees at the ends of rows 2 to 4"."""
    return both_ends(noun, rows)


@construction("place: DET noun=FINISH OF rows=rows NEAREST [AT] to=place", cost=0.1)
def nearer_end(noun: Lex, rows: s.Selector, to: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the end of row 3 nearest to the charger"."""
    if noun.plural or not is_one_row(rows) or to.shape != "one":
        return None
    ends = s.UnionOf(parts=(s.InRow(first=1, last=1, of=rows), s.InRow(first=-1, last=-1, of=rows)))
    return PlaceMeaning(s.Nearest(to=to.selector, of=ends), "one")


@construction(
    "place: DET first=position AND AT DET second=position inner=nominal",
    "place: DET first=position AND OF DET second=position inner=nominal",
    cost=0.2,
)
def first_and_then_last(first: tuple[int, int], second: tuple[int, int], inner: Nominal) -> PlaceMeaning | None:
    """Compose "the first and at the last tree", two places one after the other."""
    found = first_and_last(first, second, inner)
    return None if found is None else replace(found, in_order=True)


@construction("place: [BOTH] [DET] first=position [one=nominal] AND [DET] second=position inner=nominal", cost=0.2)
def first_and_last(
    first: tuple[int, int], second: tuple[int, int], inner: Nominal, one: Nominal | None = None
) -> PlaceMeaning | None:
    """Compose "both the first and the last tree"."""
    if (first, second) != ((1, 1), (-1, -1)) or inner.plural or inner.single or inner.selector != s.Trees():
        return None
    if one is not None and one != inner:
        return None
    return PlaceMeaning(s.UnionOf(parts=(s.First(), s.Last())), "several", count=2)


@construction(
    "place: [DET] n=count inner=nominal [COMMA] EVENLYALONG rows=rows",
    "place: n=count POINT EVENLYALONG rows=rows",
    "place: n=count POINT EVENLYSPACED in_ rows=rows",
    "place: n=count POINT EVENLYSPACED along rows=rows",
    "place: n=count EVENLYSPACED POINT in_ rows=rows",
    "place: n=count EVENLYSPACED POINT along rows=rows",
    "place: [DET] n=count EVENLYSPACED inner=nominal",
    "place: [DET] n=count inner=nominal [COMMA] EVENLYSPACED",
    "place: [DET] n=count inner=nominal EVENLYSPACED in_ rows=rows",
    "place: [DET] n=count inner=nominal EVENLYSPACED along rows=rows",
    cost=0.2,
)
def evenly_along(n: int, inner: Nominal = _TREES, rows: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "ten trees spread evenly along row 4" and "four evenly spaced trees in row 5"."""
    if inner.single or inner.complete or n < 2 or (rows is not None and not chooses_from_trees(inner.selector)):
        return None
    of = inner.selector if rows is None else over(inner.selector, rows)
    if len({part for part in of.walk() if are_rows(part)}) != 1 or not any(is_one_row(part) for part in of.walk()):
        return None  # along which line?
    return PlaceMeaning(s.Evenly(count=n, of=of), "several", count=n)


@construction("each_rows: EACH ROWPOSS", "each_rows: rows=rows POSS", cost=0.0)
def each_rows(rows: s.Selector | None = None) -> s.Selector:
    """Compose "every row's" and "row 3's"."""
    return rows or s.Rows()


@construction("place: rows=each_rows where=span inner=nominal", cost=0.2)
def trees_of_each_rows(rows: s.Selector, where: tuple[int, int], inner: Nominal) -> PlaceMeaning | None:
    """Compose "every row's first tree"."""
    if inner.plural != (where[0] != where[1]):
        return None
    return trees_of_row(where, rows, inner) if inner.plural else tree_of_row(where, inner, rows)


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
