"""Constructions of rows, and of what is said of each row."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import OTHER_ROWS, THOSE_ROWS, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.counted import Positions, size_of
from fieldhand.planning.grammar.places.numbered import all_of
from fieldhand.planning.grammar.places.numbers import name_of, whole
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    are_rows,
    as_quota,
    as_rows,
    as_zone,
    chooses_from_trees,
    counts_in_row,
    is_extreme,
    is_in_block,
    is_one_row,
    of_each,
    over,
    swapped,
)
from fieldhand.site.counting import find_row, rows_from
from fieldhand.site.model import Site
from fieldhand.site.planting import Block
from fieldhand.terms import Towards

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Opposite sides.
OPPOSITE_SIDE = {"north": "south", "south": "north", "east": "west", "west": "east"}


@construction("row_name: name=NUM", "row_name: name=ROWNAME", cost=0.0)
def row_name(name: Lex) -> Lex:
    """Compose "3" and "A12" behind "row"."""
    return name


@construction(
    "rows: [DET] [n=count] side=MOST noun=ROW",
    "rows: DET side=MOST n=count noun=ROW",
    "rows: [DET] [n=count] noun=ROW [which_is] side=farthest_side",
    cost=0.1,
)
def outermost_rows(side: Lex, noun: Lex, n: int | None = None) -> s.Selector | None:
    """Compose "the two northernmost rows"."""
    if side.value not in SIDES or noun.plural != (n is not None):
        return None
    return s.Rows(first="1", last=str(n or 1), counted_from=side.value)


@construction("rows: [DET] [n=count] OUTER noun=ROW", "rows: [DET] [n=count] EDGE noun=ROW", cost=0.2)
def outer_rows(noun: Lex, n: int = 2) -> s.Selector | None:
    """Compose "the outer rows"."""
    if not noun.plural or n != 2:
        return None
    return s.UnionOf(parts=(s.Rows(first="1", last="1"), s.Rows(first="-1", last="-1")))


@construction(
    "rows: DET noun=ROW NEXTTO row=rows",
    "rows: DET noun=ROW BESIDE row=rows",
    "rows: DET noun=ROW EACHSIDE OF row=rows",
    "rows: DET noun=ROW side=on_side OF row=rows",
    cost=0.2,
    given=("site",),
)
def rows_next_to(noun: Lex, row: s.Selector, site: Site, side: str = "") -> s.Selector | list[s.Selector] | None:
    """Compose "the rows on either side of row 3"; "the row next to row 3" may be either of the two."""
    named = as_rows(row)
    blocks = [one for one in site.planting.blocks if row_of_block(named, one)]
    if named is None or not is_one_row(named) or named.counted_from != "usual" or len(blocks) != 1:
        return None
    counted, first_side = rows_from(site, blocks[0], "usual")
    names = [one.name for one in counted]
    if named.first not in names or (
        side and (OPPOSITE_SIDE.get(first_side) is None or side not in (first_side, OPPOSITE_SIDE[first_side]))
    ):
        return None
    steps = (-1, 1) if not side else (-1,) if side == first_side else (1,)
    at = names.index(named.first)
    found = [replace(named, first=names[at + k], last=names[at + k]) for k in steps if 0 <= at + k < len(names)]
    if not noun.plural:
        return list(found)
    return s.UnionOf(parts=tuple(found)) if len(found) == 2 else None


def row_of_block(rows: s.Rows | None, block: Block) -> bool:
    """Return True if rows may be those of a block."""
    return rows is not None and rows.of in (s.Trees(), s.InBlock(block=block.name))


@construction("rows: [DET] rank=ORD ROW FROM [DET] side=DIR", cost=0.1)
def row_from_side(rank: Lex, side: Lex) -> s.Selector | None:
    """Compose "the third row from the north"."""
    if side.value not in SIDES:
        return None
    return s.Rows(first=str(rank.value), last=str(rank.value), counted_from=side.value)


@construction("rows: word=DET noun=ROW", cost=0.1)
def those_rows(word: Lex, noun: Lex) -> s.Selector | None:
    """Compose "these rows"."""
    return THOSE_ROWS if noun.plural and "spoken_of" in word.features else None


@construction("each_row: each=EACH OF word=DET noun=ROW", "each_row: each=EACH word=DET noun=ROW", cost=0.1)
def each_of_the_rows(each: Lex, word: Lex, noun: Lex) -> s.Selector | None:
    """Compose "each of the rows" and "each of these rows"."""
    if "of_each" not in each.features or not noun.plural:
        return None
    return THOSE_ROWS if "spoken_of" in word.features else s.Rows()


@construction("each_row: each=EACH OF OTHERS", "each_row: each=EACH OF DET OTHER noun=ROW", cost=0.1)
@construction("each_row: each=EACH OF DET REMAINING noun=ROW", "each_row: each=EACH DET REMAINING noun=ROW", cost=0.1)
@construction("each_row: each=EACH DET OTHER noun=ROW", cost=0.1)
def each_of_the_other_rows(each: Lex, noun: Lex | None = None) -> s.Selector | None:
    """Compose "each of the others" and "each of the other rows", of those that were named or left out before."""
    known = "of_each" in each.features or "all_of" in each.features
    return OTHER_ROWS if known and (noun is None or noun.plural) else None


@construction("rows: word=DET noun=ROW", cost=0.6)
def this_row(word: Lex, noun: Lex) -> s.Selector | None:
    """Compose "this row"."""
    return s.RowOf() if not noun.plural and "definite" in word.features else None


@construction("rows: [DET] ROW [NUMBERED] [HASH] number=row_name", cost=0.1)
def row_by_number(number: Lex) -> s.Selector:
    """Compose "row 4"."""
    name = name_of(number)
    return s.Rows(first=name, last=name)


@construction(
    "rows: [DET] ROW first=row_name range_to [ROW] last=row_name",
    "rows: [DET] ROW BETWEEN first=row_name AND last=row_name",
    "rows: BETWEEN ROW first=row_name AND [ROW] last=row_name",
    cost=0.2,
)
def rows_from_to(first: Lex, last: Lex) -> s.Selector:
    """Compose "rows 3 to 5" and "rows between 3 and 5"."""
    return s.Rows(first=name_of(first), last=name_of(last))


@construction("nominal: inner=nominal BETWEEN [DET] noun=ROW first=row_name AND [ROW] last=row_name", cost=0.2)
def between_rows(inner: Nominal, noun: Lex, first: Lex, last: Lex) -> list[Nominal] | None:
    """Compose "trees between rows 3 and 6": with those of the two rows, or without them?"""
    low, high = (whole(one.value) if isinstance(one.value, float) else None for one in (first, last))
    if not noun.plural or low is None or high is None or high < low + 2 or not chooses_from_trees(inner.selector):
        return None
    return [
        replace(inner, selector=over(inner.selector, s.Rows(first=str(begin), last=str(end))))
        for begin, end in ((low, high), (low + 1, high - 1))
    ]


@construction("row_item: first=row_name", "row_item: first=row_name range_to [ROW] last=row_name", cost=0.1)
def row_item(first: Lex, last: Lex | None = None) -> s.Rows:
    """Compose "5" and "5 to 7" in a list of rows."""
    return s.Rows(first=name_of(first), last=name_of(last or first))


@construction("row_list: [DET] noun=ROW [NUMBERED] first=row_item", cost=0.0)
def row_list(noun: Lex, first: s.Rows) -> tuple[s.Rows, ...] | None:
    """Compose "rows 3", the beginning of "rows 3, 5 and 7"."""
    return (first,) if noun.plural else None


@construction("row_list: rows=row_list [COMMA] [AND] [ROW] item=row_item", cost=0.1)
def longer_row_list(rows: tuple[s.Rows, ...], item: s.Rows) -> tuple[s.Rows, ...]:
    """Compose "rows 3, 5 and 7 to 9"."""
    return (*rows, item)


@construction("rows: rows=row_list", cost=0.1)
def listed_rows(rows: tuple[s.Rows, ...]) -> s.Selector | None:
    """Compose "rows 3 and 5" as rows."""
    return s.UnionOf(parts=rows) if len(rows) > 1 else None


@construction("rows: DET SAME noun=ROW", "rows: THATWORD noun=ROW", cost=0.1)
def same_row(noun: Lex) -> s.Selector:
    """Compose "the same row" and "the same rows"."""
    return THOSE_ROWS if noun.plural else s.RowOf()


@construction(
    "rows: DET ROW OF tree=place",
    "rows: DET ROW WITH tree=place",
    "rows: DET ROW HOLDING tree=place",
    "rows: DET ROW [WHICH] tree=place IS in_",
    "rows: DET ROW in_ WHICH tree=place IS",
    "rows: DET ROW WHERE tree=place IS",
    "rows: tree=owned_by ROW",
    cost=0.2,
)
def row_of_tree(tree: PlaceMeaning) -> s.Selector | None:
    """Compose "the row of tree 12"."""
    return s.RowOf(origin=tree.selector) if tree.selector == s.Here() or isinstance(tree.selector, s.TreeIs) else None


@construction("rows: [DET] NEXTROW", cost=0.1)
def next_row() -> s.Selector:
    """Compose "the next row"."""
    return s.RowOf(over=1)


@construction("rows: DET NEXTONE n=count noun=ROW", "rows: DET n=count NEXTONE noun=ROW", cost=0.1)
def next_rows(n: int, noun: Lex) -> s.Selector | None:
    """Compose "the next two rows"."""
    if not noun.plural or n < 2:
        return None
    return s.UnionOf(parts=tuple(s.RowOf(over=number) for number in range(1, n + 1)))


@construction("rows: [DET] PREVROW", cost=0.1)
def previous_row() -> s.Selector:
    """Compose "the previous row"."""
    return s.RowOf(over=-1)


@construction("rows: n=count noun=ROW way=way", cost=0.1, given=("site",))
def rows_to_side(n: int, noun: Lex, way: Towards, site: Site) -> s.Selector | None:
    """Compose "three rows further east"."""
    return rows_towards(n, way, site) if noun.plural == (n > 1) else None


@construction("place: n=count noun=ROW way=way", cost=0.3, given=("site",))
def no_rows_to_side(n: int, noun: Lex, way: Towards, site: Site) -> PlaceMeaning | None:
    """Compose "three rows further north", where the rows are not counted that way."""
    if noun.plural != (n > 1) or way not in SIDES or rows_towards(n, way, site) is not None:
        return None
    if len({block.runs_east_west for block in site.planting.blocks}) > 1:
        fault = message("the rows of this site run different ways", context="fault")
    else:
        fault = message("the rows are not counted to that side", context="fault")
    return PlaceMeaning(s.RowOf(), "nowhere", fault=fault)


@construction("rows: DET [n=count] noun=ROW to=AT DET side=DIR", cost=0.1, given=("site",))
def rows_beside(noun: Lex, to: Lex, side: Lex, site: Site, n: int | None = None) -> s.Selector | None:
    """Compose "the row to the east" and "the two rows to the east"."""
    if noun.plural != (n is not None) or "motion" not in to.features or n == 1:
        return None
    found = [row for k in range(1, (n or 1) + 1) if (row := rows_towards(k, side.value, site)) is not None]
    return s.UnionOf(parts=tuple(found)) if len(found) > 1 else found[0] if found else None


def rows_towards(number: int, side: str, site: Site) -> s.RowOf | None:
    """Return the row so many rows to a side of the current one; None if the rows run to that side."""
    runs = {block.runs_east_west for block in site.planting.blocks}
    if runs != {side in ("north", "south")} or side not in SIDES:
        return None
    return s.RowOf(over=number if side in ("east", "south") else -number)


@construction("rows: n=count ROWSOVER", cost=0.1)
def rows_over(n: int) -> s.Selector:
    """Compose "two rows over"."""
    return s.RowOf(over=n)


@construction("row_parity: ODD", cost=0.0)
def odd() -> int:
    """Compose "odd-numbered"."""
    return 1


@construction("row_parity: EVEN", cost=0.0)
def even() -> int:
    """Compose "even-numbered"."""
    return 2


@construction("rows: [DET] number=row_parity noun=ROW", "rows: each=EACH number=row_parity noun=ROW", cost=0.1)
def rows_of_parity(number: int, noun: Lex, each: Lex | None = None) -> s.Selector | None:
    """Compose "the odd rows"."""
    return s.Rows(first=str(number), every=2) if noun.plural or each is not None else None


@construction(
    "rows: [DET] number=row_parity noun=ROW [FROM] first=row_name range_to last=row_name",
    "rows: [DET] number=row_parity noun=ROW BETWEEN first=row_name AND last=row_name",
    cost=0.1,
)
def rows_of_parity_between(number: int, noun: Lex, first: Lex, last: Lex) -> s.Selector | None:
    """Compose "the odd rows from 3 to 9"."""
    low, high = whole(first.value), whole(last.value)
    if low is None or high is None or low >= high or not noun.plural:
        return None
    return s.Rows(first=str(low + (low - number) % 2), last=str(high), every=2)


@construction("rows: [DET] at=marks noun=ROW", cost=0.1, given=("site",))
def rows_at_positions(at: Positions, noun: Lex, site: Site) -> s.Selector | None:
    """Compose "the third row", "the last two rows" and "the third, fifth and last rows"."""
    if at.either or any(first == 0 for first, _ in at.spans):
        return None
    if len(at.spans) == 1 and noun.plural != (size_of(at.spans[0]) != 1):
        return None
    return all_of([rows_at(first, last, site) for first, last in at.spans])


@construction("row_step: EACH n=ORD", "row_step: EACH OTHER", cost=0.0)
def row_step(n: Lex | None = None) -> int | None:
    """Compose "every third" before "row"."""
    return 2 if n is None else n.value if n.value > 1 else None


@construction("rows: every=row_step ROW", "rows: every=row_step ROW OF TREE", cost=0.8)
def every_nth_row(every: int) -> s.Selector:
    """Compose "every third row"."""
    return s.Rows(every=every)


@construction("each_row: every=row_step noun=ROW", cost=0.2)
def each_nth_row(every: int, noun: Lex) -> s.Selector | None:
    """Compose "every third row", one by one."""
    return None if noun.plural else s.Rows(every=every)


@construction(
    "rows: every=row_step ROW [OF] [TREE] [COMMA] STARTING ROW number=row_name",
    "rows: every=row_step ROW [OF] [TREE] [COMMA] STARTING DET rank=ORD ROW",
    cost=0.1,
)
def rows_starting_with(every: int, number: Lex | None = None, rank: Lex | None = None) -> s.Selector:
    """Compose "every third row starting with row 2"."""
    first = name_of(number) if number is not None else "" if rank is None else str(rank.value)
    return s.Rows(first=first, every=every)


def rows_at(first: int, last: int, site: Site) -> s.Rows:
    """Return rows by their positions: counted from a side where the rows have names, and none is that number."""
    blocks = site.planting.blocks
    if len(blocks) != 1 or first < 0:
        return s.Rows(first=str(first), last=str(last))
    rows, side = rows_from(site, blocks[0], "usual")
    known = [find_row(rows, str(number), by_number=False) for number in (first, last)]
    if None not in known or side not in SIDES:
        return s.Rows(first=str(first), last=str(last))
    return s.Rows(first=str(first), last=str(last), counted_from=side)


@construction("region: rows=rows", cost=0.0)
def rows_as_region(rows: s.Selector) -> s.Selector:
    """Compose "row 4" as an area."""
    return rows


@construction("each_row: EACH noun=ROW", cost=0.2)
def each_row(noun: Lex) -> s.Selector | None:
    """Compose "each row"."""
    return None if noun.plural else s.Rows()


@construction(
    "each_row: EACH ROW FROM first=row_name range_to [ROW] last=row_name",
    "each_row: EACH ROW first=row_name range_to [ROW] last=row_name",
    cost=0.1,
)
def each_row_from_to(first: Lex, last: Lex) -> s.Selector:
    """Compose "each row from 3 to 5"."""
    return rows_from_to(first, last)


@construction("per_row: PER noun=ROW", cost=0.1)
def per_row(noun: Lex) -> s.Selector | None:
    """Compose "per row"."""
    return each_row(noun)


@construction("each_row: EACH AT rows=rows", "each_row: EACH OF rows=rows", "each_row: word=EACH rows=rows", cost=0.2)
def each_of_rows(rows: s.Selector, word: Lex | None = None) -> s.Selector | None:
    """Compose "each of rows 3 to 5"."""
    third = word is not None and "every" in word.features  # "every third row of both blocks"
    return None if is_one_row(rows) or third else rows


@construction("each_row: rows=each_row in_ where=region", cost=0.1)
def each_row_of_area(rows: s.Selector, where: s.Selector) -> s.Selector | None:
    """Compose "each row of block 2" and "each row of the northern half"."""
    if are_rows(where) or not chooses_from_trees(where):
        return None
    inside = over(rows, where)
    if are_rows(inside):
        return inside
    zone = as_zone(where)
    whole = zone is not None and not zone.outside and not zone.margin_m and zone.of == s.Trees()
    return swapped(rows, s.Trees(), where) if whole else None


@construction(
    "all_rows: word=DET noun=ROW",
    "all_rows: each=EACH [word=DET] noun=ROW",
    "all_rows: each=EACH [word=DET] n=count noun=ROW",
    cost=0.0,
    given=("site",),
)
def every_row(
    noun: Lex, site: Site, n: int | None = None, word: Lex | None = None, each: Lex | None = None
) -> s.Selector | None:
    """Compose "all rows", and "all ten rows" of a site that has ten."""
    if not noun.plural or n not in (None, len(site.planting.rows)):
        return None
    if word is not None and ("spoken_of" in word.features or (each is not None and "of_each" in each.features)):
        return None
    return s.Rows()


@construction("region: rows=all_rows", cost=0.5)
def every_row_as_region(rows: s.Selector) -> s.Selector:
    """Compose "all rows" as an area."""
    return rows


@construction("any_rows: rows=rows", "any_rows: rows=each_row", "any_rows: rows=all_rows", cost=0.0)
def any_rows(rows: s.Selector) -> s.Selector:
    """Compose "row 4", "each row" and "all rows", of which something is said by itself."""
    return rows


@construction("rows: block=owned_block rows=rows", cost=0.1)
def rows_owned_by_block(block: s.Selector, rows: s.Selector) -> s.Selector | None:
    """Compose "the north block's third row"."""
    return rows_of_block(rows, block)


@construction(
    "place: [DET] inner=nominal in_ rows=each_row",
    "place: each=EACH inner=nominal in_ rows=each_row",
    cost=0.3,
)
def trees_of_each_row(inner: Nominal, rows: s.Selector, each: Lex | None = None) -> PlaceMeaning | None:
    """Compose "the northernmost tree of each row"."""
    if not chooses_from_trees(inner.selector):
        return None
    if inner.single:
        if each is not None or counts_in_row(over(inner.selector, rows)):
            return None  # "the last tree of each row" is counted along it
        return PlaceMeaning(inner.selector, "several", each=True, per=rows)
    return PlaceMeaning(over(inner.selector, rows), "several") if inner.plural or each is not None else None


@construction("place: DET inner=nominal in_ rows=row_list", cost=0.4)
def extreme_of_each_row(inner: Nominal, rows: tuple[s.Rows, ...]) -> PlaceMeaning | None:
    """Compose "the northernmost tree of rows 1, 3 and 5": of each of them, or of all of them?"""
    if not inner.single or not is_extreme(inner.selector) or len(rows) < 2:
        return None
    return PlaceMeaning(inner.selector, "several", each=True, per=s.UnionOf(parts=rows))


@construction(
    "place: one=place in_ rows=each_row",
    "place: one=place FOR rows=each_row",
    "place: rows=each_rows one=place",
    "place: one=place EACH in_ rows=rows",
    "place: one=place rows=per_row",
    cost=0.2,
)
def in_each_row(one: PlaceMeaning, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "two trees in each row"."""
    if one.per is not None or one.shape not in ("one", "several") or one.optional or one.at_most:
        return None
    if not chooses_from_trees(one.selector) or counts_in_row(one.selector):
        return None
    if is_one_row(rows):
        return None
    in_rows = over(one.selector, rows)
    if (quota := as_quota(one.selector)) is not None and (each := of_each(quota, "row", rows)) is not None:
        return replace(one, selector=each)
    if all(counts_in_row(part) for part in in_rows.members):
        return replace(one, selector=in_rows, shape="several", count=None)  # "the first and last tree of each row"
    if one.shape == "several" and one.count is None:
        return replace(one, selector=in_rows)
    return PlaceMeaning(one.selector, "several", each=True, per=rows)


@construction(
    "place: rows=each_row [COMMA] in_ one=place",
    "place: rows=each_row COMMA one=place",
    "place: rows=rows [COMMA] in_ one=place INEACH",
    "place: rows=rows COMMA one=place INEACH",
    "place: one=place APIECE in_ rows=rows",
    "place: one=place in_ rows=rows APIECE",
    "place: one=place OF rows=rows AND OF more=rows",
    "place: one=place AT rows=rows AND AT more=rows",
    cost=0.2,
)
def in_each_of_those_rows(rows: s.Selector, one: PlaceMeaning, more: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "three trees apiece in rows 2 and 4" and "the two northernmost trees of row 2 and of row 8"."""
    return in_each_row(one, rows if more is None else s.UnionOf(parts=(*rows.members, *more.members)))


@construction("place: rows=each_row", cost=0.5)
def at_each_row(rows: s.Selector) -> PlaceMeaning:
    """Compose "each row" as a place."""
    return PlaceMeaning(s.Trees(), "area", each=True, per=rows)


@construction(
    "rows_of_block: rows=rows in_ block=block",
    "rows_of_block: rows=rows in_ [DET] block=bare_block",
    "rows_of_block: block=bare_block rows=rows",
    "rows_of_block: rows=rows COMMA block=block",
    "rows_of_block: rows=rows [COMMA] block=bare_block",
    cost=0.1,
)
def rows_of_block(rows: s.Selector, block: s.Selector) -> s.Selector | None:
    """Compose "rows 3 to 5 of block 2"."""
    if is_in_block(rows):
        return None
    return over(rows, block)


@construction("rows_of_block: rows=rows in_ blocks=blocks", "rows_of_block: rows=rows in_ blocks=each_block", cost=0.1)
def rows_of_each_block(rows: s.Selector, blocks: tuple[s.Selector, ...]) -> s.Selector | None:
    """Compose "row 12 of both blocks"."""
    if is_in_block(rows):
        return None
    return s.UnionOf(parts=tuple(over(rows, block) for block in blocks))


@construction("rows: rows=rows_of_block", cost=0.0)
def rows_with_block(rows: s.Selector) -> s.Selector:
    """Compose "row 10 of the north block" as rows."""
    return rows


@construction("rows: DET SAME ROW AS tree=place", cost=0.1)
def row_like(tree: PlaceMeaning) -> s.Selector | None:
    """Compose "the same row as tree 40"."""
    return row_of_tree(tree)


@construction("rows: rows=rows OF TREE", cost=0.2)
def rows_of_trees(rows: s.Selector) -> s.Selector:
    """Compose "every third row of trees"."""
    return rows
