"""Constructions of exceptions: places without some others, or without a part of themselves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar, tokens_of
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.chosen import Chosen, chosen_among
from fieldhand.planning.grammar.places.clauses import Clause, with_attribute
from fieldhand.planning.grammar.places.compass import CORNERS
from fieldhand.planning.grammar.places.counted import BOTH_ENDS, Span, row_itself, rows_within
from fieldhand.planning.grammar.places.numbered import all_of, elsewhere, ids_of, numbered
from fieldhand.planning.grammar.places.planted_rows import filled_rows, rows_out_of
from fieldhand.planning.grammar.places.points import outside_zones
from fieldhand.planning.grammar.places.rows import rows_at
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    AREAS,
    are_rows,
    are_several_rows,
    as_excluding,
    as_in_row,
    as_quota,
    as_random,
    as_some,
    as_where,
    blocks_of,
    centre_of,
    is_block,
    is_by_attribute,
    is_end_of_site,
    is_in_block,
    is_one_row,
    is_whole_rows,
    named_places,
    over,
    picked_from,
    picks_from_all,
    rows_of,
    some_of,
    swapped,
)
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class Omission:
    """Places, or parts of other places, that an exception leaves out: one of these.

    Attributes:
        place: Places of their own.
        trees: Numbers or ids of trees, or numbers of rows.
        as_trees: True if the phrase says that these are trees.
        or_so_many: True if a number may be that of the trees which are left out ("all trees but 2").
        value: Attribute and value of those that are left out.
        area: Area in which they are, if the phrase names it.
        positions: Ranges of positions in the row.
        rows: Rows of these positions, if the phrase names them.
        chosen: Choice among the other places ("the oldest one").
        bare_number: True for a number behind "not" alone ("not 6").
    """

    place: PlaceMeaning | None = None
    trees: tuple[str, ...] = ()
    as_trees: bool = False
    or_so_many: bool = False
    value: tuple[str, str | bool] | None = None
    area: s.Selector | None = None
    positions: tuple[Span, ...] = ()
    rows: s.Selector | None = None
    chosen: Chosen | None = None
    bare_number: bool = False


@construction("except: [COMMA] but=EXCEPT [FOR]", "except: [COMMA] word=WITHOUT", cost=0.0)
def except_word(word: Lex | None = None, but: Lex | None = None) -> str | None:
    """Compose "except for" and "without", and "but not", which says it of each of a kind ("but not a Carmel")."""
    if but is not None:
        return "not" if "not" in but.text.split() else "except"
    return "except" if word is not None and "leaves_out" in word.features else None


@construction(
    "out: place=place", "out: in_ place=place", "out: which_is in_ place=place", "out: FROM place=place", cost=0.1
)
def places_out(place: PlaceMeaning) -> Omission:
    """Compose "the yellow trees" and "in the wet corner"."""
    return Omission(place=place)


@construction("out: ANY clause=relative", "out: DET ONE clause=relative", cost=0.1)
def described_out(clause: Clause) -> Omission | None:
    """Compose "any that are yellow"."""
    inner = with_attribute(Nominal(s.Trees(), plural=True), clause)
    return None if inner is None else Omission(place=PlaceMeaning(inner.selector, "several"))


@construction("out: trees=numbers", "out: [DET] word=NUMBERED trees=numbers", "out: [DET] named=tree_ids", cost=0.0)
def numbers_out(trees: tuple[str, ...] = (), named: tuple[str, ...] = (), word: Lex | None = None) -> Omission:
    """Compose "7 and 13" and "tree 40"."""
    return Omission(trees=trees or named, as_trees=bool(named) or word is not None)


@construction(
    "out: [DET] value=ATTRVAL ONE", "out: ANY value=ATTRVAL ONE", "out: [DET] value=ATTRVAL ONE in_ area=region",
    cost=0.0,
)  # fmt: skip
def kind_out(value: Lex, area: s.Selector | None = None) -> list[Omission]:
    """Compose "the yellow ones"."""
    return [Omission(value=(name, text), area=area) for name, text in value.value]


@construction(
    "out: [DET] flag=FLAG ONE", "out: ANY flag=FLAG ONE", "out: [DET] flag=FLAG ONE in_ area=region",
    "out: ANY which_is flag=FLAG", "out: word=DET which_is flag=FLAG", "out: word=DET [ONE] which_is flag=FLAG",
    cost=0.0,
)  # fmt: skip
def such_out(flag: Lex, area: s.Selector | None = None, word: Lex | None = None) -> list[Omission] | None:
    """Compose "the covered ones" and "those that are covered"."""
    if word is not None and word.features.isdisjoint({"those", "definite"}):
        return None
    return [Omission(value=(name, value), area=area) for name, value in flag.value]


@construction("out: [DET] side=DIR ONE", cost=0.0)
def corner_out(side: Lex) -> Omission | None:
    """Compose "the north-west one", of corners."""
    return Omission(place=PlaceMeaning(s.Corners(which=(side.value,)), "one")) if side.value in CORNERS else None


@construction("left_out: at=left_out_at", "left_out: [BOTH] at=left_out_at AND [DET] second=left_out_at", cost=0.0)
def left_out(at: tuple[Span, ...], second: tuple[Span, ...] = ()) -> tuple[Span, ...]:
    """Compose "the first two" and "the first and the last one" behind "except"."""
    return (*at, *second)


@construction("left_out_at: [DET] at=span [TREE]", "left_out_at: [DET] at=span ONE", cost=0.1)
def position_left_out(at: Span) -> tuple[Span, ...]:
    """Compose "the first two trees" behind "except"."""
    return (at,)


@construction("each_end: [DET] noun=FINISH", "each_end: BOTH noun=FINISH", cost=0.0)
@construction("each_end: each=EACH noun=FINISH", "each_end: word=ANY noun=FINISH", cost=0.0)
def each_end(noun: Lex, each: Lex | None = None, word: Lex | None = None) -> int | None:
    """Compose "the ends", "each end" and "either end": the number of ends that the noun is about."""
    if each is None and word is None:
        return 2 if noun.plural else None
    return None if noun.plural or (word is not None and not word.text.startswith("either")) else 1


@construction(
    "left_out_at: ends=each_end",
    "left_out_at: [DET] FINISH noun=ONE", "end_trees: [DET] FINISH noun=TREE",
    "left_out_at: [DET] ONE AT ends=each_end", "end_trees: [DET] TREE AT ends=each_end",
    "left_out_at: [DET] n=count [ONE] AT ends=each_end", "end_trees: [DET] n=count TREE AT ends=each_end",
    cost=0.1,
)  # fmt: skip
def ends_left_out(ends: int = 2, n: int | None = None, noun: Lex | None = None) -> tuple[Span, ...] | None:
    """Compose "its ends", "the end trees", "the two at the ends" and "the one at either end" behind "except"."""
    if noun is not None and not noun.plural and "plural" not in noun.features:
        return None
    if n is None or n == ends:
        return BOTH_ENDS
    return ((1, n), (-n, -1)) if ends == 1 and n > 0 else None


@construction("out: positions=left_out", "out: positions=left_out in_ rows=any_rows", cost=0.0)
@construction("out: trees=end_trees", "out: trees=end_trees in_ rows=any_rows", cost=0.1)
def positions_out(
    positions: tuple[Span, ...] = (), rows: s.Selector | None = None, trees: tuple[Span, ...] = ()
) -> Omission:
    """Compose "the first and last of row 3" and "the plants at the ends"."""
    return Omission(positions=positions or trees, rows=rows, as_trees=bool(trees))


@construction(
    "row_ends: [DET] ROW noun=FINISH", "row_ends: [DET] noun=FINISH OF [word=DET] row=ROW",
    "row_ends: [DET] noun=FINISH OF EACH row=ROW", "row_ends: EACH noun=FINISH OF word=DET row=ROW", cost=0.1,
)  # fmt: skip
def row_ends(noun: Lex, row: Lex | None = None, word: Lex | None = None) -> s.Selector | None:
    """Compose "the row ends" and "the end of a row", of any row of the site; "the row" is one that was named."""
    if row is None and not noun.plural:
        return None
    if row is not None and not row.plural and word is not None and "definite" in word.features:
        return None
    return s.UnionOf(parts=tuple(s.InRow(first=at, last=at, of=s.Rows()) for at in (1, -1)))


@construction("out: at=row_ends", "out: AT at=row_ends", "out: [DET] TREE AT at=row_ends", cost=0.1)
@construction("out: DET [ONE] AT at=row_ends", cost=0.1)
@construction("out: FROM at=row_ends", "out: FROM [DET] TREE AT at=row_ends", cost=0.1)
def ends_of_rows_out(at: s.Selector) -> Omission:
    """Compose "the plants at the row ends" behind "but not"."""
    return Omission(place=PlaceMeaning(at, "several"))


@construction("out: n=count OFTHEM", cost=0.1)
def some_of_them_out(n: int) -> Omission:
    """Compose "two of them" behind "all leeks except"."""
    return Omission(trees=(str(n),), or_so_many=True)


@construction("out: DET chosen=bare", cost=0.0)
def chosen_out(chosen: Chosen) -> Omission:
    """Compose "the three nearest to the charger"."""
    return Omission(chosen=chosen)


@construction(
    "outs: first=out COMMA second=out", "outs: first=outs COMMA second=out",
    "out: first=out [COMMA] OR second=out", "out: first=outs [COMMA] OR second=out",
    "out: first=out [COMMA] NOR second=out", "out: first=outs [COMMA] NOR second=out",
    "out: first=out AND second=out", "out: first=outs [COMMA] AND second=out",
    cost=0.0,
)  # fmt: skip
def neither_of_both(first: Omission, second: Omission) -> Omission | None:
    """Compose "the wet corner or the slope" behind "but not", and "the beans and bed 4": both are left out."""
    one, other = first.place, second.place
    if one is None or other is None:
        return None
    both = both_out(one, other)
    return None if both is None else Omission(place=both)


def both_out(one: PlaceMeaning, other: PlaceMeaning) -> PlaceMeaning | None:
    """Return two places of which both are left out."""
    if not {one.shape, other.shape} <= {"one", "several", "area"}:
        return None
    known = all(place.like is None or place.like.kind == "those" for place in (one, other))
    if not known or any(place.per is not None or place.optional for place in (one, other)):
        return None
    parts = s.UnionOf(parts=(*one.selector.members, *other.selector.members))
    return PlaceMeaning(parts, "area" if one.shape == other.shape == "area" else "several")


@construction("but_out: how=except out=out", "but_out: [COMMA] NEITHER out=out", cost=0.0)
def out_with_except(out: Omission, how: str = "not") -> Omission | None:
    """Compose "except the yellow trees"; "but not bed 7 and not the Roma" leaves out both."""
    if out.place is not None and as_excluding(out.place.selector) is not None:
        return None
    return replace(out, place=each_of_kind(out.place)) if how == "not" and out.place is not None else out


def each_of_kind(place: PlaceMeaning) -> PlaceMeaning:
    """Return "a Carmel" behind "not" as each of them."""
    some = as_some(place.selector)
    if some is None or some.count != 1 or place.shape != "one":
        return place
    return replace(place, selector=some.of, shape="several", count=None)


@construction("but_out: but=BUT [word=NOT] out=out", "but_out: NOT trees=numbers", cost=0.0)
def out_with_but(
    used: int,
    out: Omission | None = None,
    trees: tuple[str, ...] = (),
    word: Lex | None = None,
    but: Lex | None = None,
) -> Omission | None:
    """Compose "but not the yellow trees" and "not 6"; "but only the yellow ones" keeps them."""
    tokens = tokens_of(used)
    if len(tokens) < tokens[-1] - tokens[0] + 1:
        return None
    if out is None:
        return Omission(trees=trees, bare_number=True)
    if out.trees == ("1",) and not out.as_trees:
        return None  # "the last row but one"
    if out_with_except(out) is None:
        return None
    denied = word is not None or (but is not None and "not" in but.text.split())
    if denied and out.place is not None:
        out = replace(out, place=each_of_kind(out.place))
    return replace(out, or_so_many=word is None and len(out.trees) == 1 and not out.as_trees)


@construction("but_out: [COMMA] GROUPNONE out=out", "but_out: [COMMA] WITH GROUPNONE out=out", cost=0.1)
def none_of_them_out(out: Omission) -> Omission | None:
    """Compose "none of them at the end of a row"."""
    return out_with_except(out)


@construction("but_out: first=but_out [COMMA] AND NOT second=out", cost=-0.3)
def neither_of_them_out(first: Omission, second: Omission) -> Omission | None:
    """Compose "but not bed 7 and not the Roma"."""
    return neither_of_both(first, second)


@construction(
    "place: whole=place [COMMA] out=but_out",
    cost=0.2,
    given=("site",),
)
def without(whole: PlaceMeaning, out: Omission, site: Site) -> list[PlaceMeaning] | None:
    """Compose "all trees except the yellow trees" and "row 3, the first two left out"."""
    drawn = drawn_from(whole.selector)
    if drawn is not None and whole.per is None:  # "any three trees except tree 12": three of the others
        others = without(PlaceMeaning(drawn, "several"), out, site) or ()
        return [replace(whole, selector=swapped(whole.selector, drawn, one.selector)) for one in others] or None
    if whole.shape not in ("several", "area") or whole.optional:
        return None
    if out.place is not None and not _each_is_in(out.place, whole, site):
        return None
    if out.place is not None:
        left = except_for(whole, out.place, site)
        return None if left is None else [left]
    if out.positions and (row := _only_row_of(whole, site)) is not None:
        return _ends_of_only_row(whole, out, row)
    of_each = out.as_trees or (whole.shape == "several" and sum(map(sum, out.positions)) == 0)
    if out.positions and out.rows is None and of_each and are_several_rows(whole.selector) and whole.per is None:
        return except_positions(whole, out.positions, whole.selector)  # "the plants in each bed except its ends"
    if out.positions and not are_several_rows(whole.selector):
        return except_positions(whole, out.positions, out.rows)
    if out.positions and out.rows is not None:
        return except_positions(whole, out.positions, out.rows)
    if whole.per is not None and out.value is not None:
        rows = rows_left_out(whole.per, out, site)
        return None if rows is None else [replace(whole, per=s.Excluding(places=rows, of=whole.per))]
    parts = _parts_out(whole, out, site)
    listed = named_places(whole.selector) or as_in_row(whole.selector) is not None
    whole = replace(whole, count=None) if listed else whole
    if whole.count is not None or whole.per is not None:
        return None
    if out.as_trees and not parts and ids_of(whole.selector, site) is not None:
        return [elsewhere(out.trees)]
    if out.bare_number and is_one_row(whole.selector):
        parts = []  # "row 3, not 4": the fourth tree, or row 4, which is left out anyway?
    return [_excluding(whole, part) for part in parts] or None


def _each_is_in(out: PlaceMeaning, whole: PlaceMeaning, site: Site) -> bool:
    """Return True if each of several parts of an exception is one of the whole, or cannot be told now."""
    parts = out.selector.members
    if len(parts) < 2 or whole.selector == s.Trees():
        return True
    among = ids_of(whole.selector, site)
    for part in parts:
        own = None if ids_of(over(part, whole.selector), site) else ids_of(part, site)
        if own is not None and among is not None and not own & among:
            return False  # "photograph all tomatoes except the Roma and bed 3", where onions grow
    return True


def _only_row_of(whole: PlaceMeaning, site: Site) -> s.Selector | None:
    """Return the only row in which all plants of a kind stand, and no others; of those of one row, or of the site."""
    kind = as_where(whole.selector)
    if kind is None or whole.count is not None or whole.per is not None:
        return None
    if kind.of != s.Trees():
        alone = is_one_row(kind.of) and ids_of(kind, site) == ids_of(kind.of, site)
        return kind.of if alone else None
    rows = filled_rows(kind, site)
    return row_itself(rows[0], site) if len(rows) == 1 else None


def _ends_of_only_row(whole: PlaceMeaning, out: Omission, row: s.Selector) -> list[PlaceMeaning] | None:
    """Return "every pumpkin except the first" and "... except the two at the ends of the row"."""
    if out.rows not in (None, s.RowOf(), row):
        return None
    parts = all_of([s.InRow(first=first, last=last, of=row) for first, last in out.positions])
    return [replace(whole, selector=s.Excluding(places=parts, of=whole.selector), shape="several")]


def _excluding(whole: PlaceMeaning, part: s.Selector) -> PlaceMeaning:
    """Return a place without a part; some trees of one row are trees rather than an area."""
    trees = whole.shape == "area" and not are_rows(part)
    return replace(
        whole, selector=s.Excluding(places=part, of=whole.selector), shape="several" if trees else whole.shape
    )


def _parts_out(whole: PlaceMeaning, out: Omission, site: Site) -> list[s.Selector]:
    """Return the parts of a place that an exception can mean."""
    of = whole.selector
    if out.value is not None:
        return [s.Where(attribute=out.value[0], test="eq", value=out.value[1], of=out.area or of)]
    if out.chosen is not None:
        return [one.selector for one in chosen_among(of, out.chosen, site)]
    if are_several_rows(of) and not out.as_trees:
        rows = rows_left_out(of, out, site)
        return [] if rows is None else [rows]
    if not out.trees:
        return []
    named = [s.TreeIs(tree=tree) for tree in out.trees]
    if set(named) <= set(of.members):
        return [all_of(named)] if len(named) < len(of.members) else []
    if of == s.Trees():
        return [] if out.or_so_many else [all_of(named)]
    counted = as_in_row(of)
    if counted is not None and is_one_row(counted.of) and all(name.isdigit() for name in out.trees):
        numbers = [int(name) for name in out.trees]
        if all(counted.first <= number <= counted.last for number in numbers):  # "trees 4 to 9 of row 2 except tree 6"
            return [all_of([replace(counted, first=number, last=number) for number in numbers])]
    ways = numbered(out.trees, of, site) if out.as_trees or is_one_row(of) else []
    if of.relative and all(name.isdigit() for name in out.trees):
        ways.append(all_of(named))
    if not ways and out.or_so_many and is_by_attribute(of) and not set(out.trees) & set(site.by_id):
        return [some_of(of, int(number)) for number in out.trees if number.isdigit()]  # "all the leeks but three"
    if not ways and set(out.trees) < (ids_of(of, site) or set()):
        ways.append(all_of(named))
    return ways


def rows_left_out(rows: s.Selector, out: Omission, site: Site) -> s.Selector | None:
    """Return the rows that numbers and positions behind rows leave out."""
    blocks = set(blocks_of(rows))
    chosen = any(row.every > 1 or row.first or not (row.of == s.Trees() or is_block(row.of)) for row in rows_of(rows))
    if len(blocks) > 1 or (out.positions and chosen):
        return None  # "rows 3 to 7 except the first": the third, or the first of the block?
    if out.value is not None:  # "each bed except the covered ones"
        kind = s.Where(attribute=out.value[0], test="eq", value=out.value[1], of=out.area or s.Trees())
        return rows_out_of(kind, site)
    parts = [s.Rows(first=name, last=name) for name in out.trees] or [rows_at(*at, site) for at in out.positions]
    if not parts:
        return None
    return all_of([over(row, next(iter(blocks))) if blocks else row for row in parts])


@construction(
    "each_row: rows=each_row [COMMA] out=but_out", "all_rows: rows=all_rows [COMMA] out=but_out",
    cost=0.2, given=("site",),
)  # fmt: skip
def each_row_but(rows: s.Selector, out: Omission, site: Site) -> s.Selector | None:
    """Compose "each row but the last"."""
    if not are_several_rows(rows) or out.as_trees or out.rows is not None:
        return None
    left = rows_left_out(rows, out, site)
    return None if left is None else s.Excluding(places=left, of=rows)


@construction("out: positions=left_out ROW", cost=0.0)
def rows_out(positions: tuple[Span, ...]) -> Omission:
    """Compose "the last row" behind "all rows but"."""
    return Omission(positions=positions)


def except_positions(
    whole: PlaceMeaning, out: tuple[Span, ...], row: s.Selector | None = None
) -> list[PlaceMeaning] | None:
    """Return "row 3 except the first two" and "every tree but the first and last of row 3"."""
    whole_rows = are_rows(whole.selector)
    of_each = row is not None and not is_one_row(row)
    known = whole.selector == s.Trees() or row in (None, s.RowOf(), whole.selector) or (of_each and whole_rows)
    rows = whole.selector if whole_rows else row
    if rows is None or not known or whole.count is not None or whole.per is not None or whole.optional:
        return None
    if not whole_rows and whole.selector != s.Trees():
        return None
    if not is_one_row(rows) and row is None:
        return None  # "rows 3 and 4 except the first": of each of them?
    places = all_of([s.InRow(first=first, last=last, of=rows) for first, last in out])
    return [replace(whole, selector=s.Excluding(places=places, of=rows), shape="several")]


def except_for(whole: PlaceMeaning, part: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Return "all trees except the yellow trees".

    Args:
        whole: Places of which some are left out.
        part: Places that are left out.
        site: The site.
    """
    if whole.shape not in ("several", "area") or part.shape not in ("one", "several", "area"):
        return None
    if (drawn := drawn_from(whole.selector)) is not None and whole.per is None:
        others = except_for(PlaceMeaning(drawn, "several"), part, site)  # so many of each, or at random, of the others
        return None if others is None else replace(whole, selector=swapped(whole.selector, drawn, others.selector))
    if whole.count is not None:
        if not set(named_places(part.selector) or (part.selector,)) < set(named_places(whole.selector)):
            return None
        whole = replace(whole, count=None)
    if (points := outside_zones(whole, part.selector)) is not None:
        return points
    part = replace(part, like=None) if part.like is not None and part.like.kind == "those" else part
    if centre_of(whole.selector) == part.selector:
        return whole  # "the trees within 12 m of tree 40, but not tree 40 itself"
    if whole.selector != s.Trees() and any(is_end_of_site(one) or one.named_marker for one in part.selector.members):
        return None  # the first, the last or the ends of these, not of the site
    trees = {one.named_tree for one in part.selector.walk() if one.named_tree}
    if trees and whole.selector != s.Trees() and not trees <= (ids_of(whole.selector, site) or set()):
        return None
    if whole.per is not None:
        if not are_rows(part.selector):
            return None
        return replace(whole, per=s.Excluding(places=part.selector, of=whole.per))
    blocks = set(blocks_of(whole.selector))
    if len(blocks) == 1 and are_rows(part.selector) and is_whole_rows(part.selector) and not is_in_block(part.selector):
        part = replace(part, selector=over(part.selector, blocks.pop()))  # "row 4" behind "rows 1 to 6 of block North"
    ranked_before = (
        part.selector.uses_records and getattr(part.selector, "count", 0) > 0
    )  # "the 5 hottest of last week"
    if ranked_before or _is_counted_in_it(part, whole) or (part.shape == "one" and picks_from_all(part.selector)):
        part = replace(part, selector=over(part.selector, whole.selector))  # "every yellow tree but the oldest"
    all_of_it = whole.shape == "area" and part.shape == "several"  # "row 6 except the yellow trees"
    selector = s.Excluding(places=part.selector, of=whole.selector)
    return replace(whole, selector=selector, shape="several" if all_of_it else whole.shape)


def drawn_from(selector: s.Selector) -> s.Selector | None:
    """Return the trees of which a selector takes some, whichever these are; None for another selector."""
    some = as_some(selector) or as_random(selector) or as_quota(selector)
    return None if some is None else some.of


def _is_counted_in_it(part: PlaceMeaning, whole: PlaceMeaning) -> bool:
    """Return True for "the two trees at its north end", of a row that is named before it."""
    counted = [as_in_row(one) for one in part.selector.members]
    rows = rows_within(whole.selector)
    return rows is not None and is_one_row(rows) and all(one is not None and one.of == s.Trees() for one in counted)


@construction("place: EACH except part=place", "place: EACH BUT part=place", cost=0.3)
def all_but(part: PlaceMeaning) -> list[PlaceMeaning] | None:
    """Compose "all but the yellow trees", and "all but the last tree of row 3", of that row or of the site."""
    if part.shape not in ("one", "several", "area") or part.per is not None or part.optional:
        return None
    if as_some(part.selector) is not None or part.at_most is not None:
        return None
    groups = {picked_from(one) or (rows_within(one) and getattr(one, "of", None)) for one in part.selector.members}
    kind = groups.pop() if len(groups) == 1 else None
    if kind is not None and is_by_attribute(kind):  # "all but the two tallest leeks": of the leeks
        return [PlaceMeaning(s.Excluding(places=part.selector, of=kind), "several")]
    inside = next((one for one in part.selector.walk() if isinstance(one, AREAS)), None)
    wholes: Iterator[s.Selector] = iter([s.Trees()] if inside is None or part.shape == "area" else [inside, s.Trees()])
    return [PlaceMeaning(s.Excluding(places=part.selector, of=whole), "several") for whole in wholes]
