"""Trees that are counted along their rows: which they are, once the description with their rows is known."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning, Shape
from fieldhand.planning.grammar.places.numbered import all_of, elsewhere, ids_of, numbered, runs
from fieldhand.planning.grammar.row_by_row import MOST_ONE_BY_ONE, one_by_one
from fieldhand.planning.selections import are_rows, is_description, is_one_row, over, swapped
from fieldhand.site.model import Site
from fieldhand.site.planting import Row
from fieldhand.terms import CountedFrom

#: Numbers of the first and the last of several trees of a row, negative from its end; (0, n) for the n in the middle.
Span = tuple[int, int]

#: Maximum number of rows of a crop of which it is asked in which a plant is counted.
_MOST_ROWS = 6
BOTH_ENDS: tuple[Span, ...] = ((1, 1), (-1, -1))


@dataclass(frozen=True, slots=True)
class Positions:
    """Positions of trees in their rows.

    Attributes:
        spans: Ranges of numbers.
        counted_from: Side from which they are counted.
        near: Marker at whose end of the row counting begins, if the phrase names one.
        noun: Noun that names the positions by itself ("end"), or "stretch" for those "from the third on"; empty if the
            positions stand before a noun.
        each: True if the phrase says "each" of them.
        either: True if one of them is meant, and the phrase does not say which.
        in_order: True if the phrase names them one after the other ("at the first and at the last").
    """

    spans: tuple[Span, ...]
    counted_from: CountedFrom = "usual"
    near: s.Selector | None = None
    noun: str = ""
    each: bool = False
    either: bool = False
    in_order: bool = False


@dataclass(frozen=True, slots=True)
class TreeNumbers:
    """Numbers of trees, which are counted in rows or are their ids.

    Attributes:
        trees: Numbers or ids.
        counted_from: Side from which they are counted.
        in_each_row: True if they are counted in each of several rows.
    """

    trees: tuple[str, ...]
    counted_from: CountedFrom = "usual"
    in_each_row: bool = False


def size_of(at: Span) -> int:
    """Return the number of trees of a range of positions, 0 if it depends on the row."""
    first, last = at
    if first == 0:
        return last
    return last - first + 1 if first * last > 0 else 0


def backwards(at: Span) -> Span:
    """Return a range of positions counted from the other end of the row."""
    return at if at[0] == 0 else (-at[1], -at[0])


def rows_within(selector: s.Selector) -> s.Selector | None:
    """Return the rows from which a selector chooses its trees; None if it names none."""
    if are_rows(selector):
        return selector
    of = getattr(selector, "of", None)
    return None if of is None else rows_within(of)


def row_of_all(inner: Nominal, site: Site) -> s.Selector | None:
    """Return the one row in which all trees of a description stand; None for trees of several rows, or of any."""
    there = _rows_of_all(inner, site)
    return row_itself(there[0], site) if len(there) == 1 else None


def _rows_of_all(inner: Nominal, site: Site) -> list[Row]:
    """Return the rows in which the trees of a description stand; none for those of no row, or of any."""
    if not is_description(inner.selector):
        return []
    there = {int(site.planting.row_of[site.by_id[tree].index]) for tree in ids_of(inner.selector, site) or ()}
    return [] if -1 in there else [site.planting.rows[row] for row in sorted(there)]


def fills_rows(inner: Nominal, site: Site) -> bool:
    """Return True for plants of a description that share their rows with no others."""
    plants = (ids_of(inner.selector, site) or set()) if is_description(inner.selector) else set()
    rows = [{site.trees[tree].place.id for tree in row.trees} for row in site.planting.rows]
    return bool(plants) and all(row <= plants for row in rows if row & plants)


def row_itself(row: Row, site: Site) -> s.Rows:
    """Return a row by its name, and by its block if another block has a row of that name."""
    named = s.Rows(first=row.name, last=row.name)
    alike = [other for other in site.planting.rows if other.name == row.name]
    return named if len(alike) == 1 else replace(named, of=s.InBlock(block=site.planting.blocks[row.block].name))


def trees_counted(inner: Nominal, at: Positions, site: Site) -> list[PlaceMeaning] | None:
    """Return the trees at some positions of the rows of a description."""
    of, rows = inner.selector, rows_within(inner.selector)
    if rows is None:  # "the third Sungold", of the row in which they stand, or of each in which they may be counted
        known = [row_itself(row, site) for row in _rows_of_all(inner, site)]
        if len(known) == 1:
            return trees_counted(replace(inner, selector=over(of, known[0])), at, site)
        if len(known) > _MOST_ROWS or not fills_rows(inner, site):
            return None
        in_rows = [place for row in known for place in trees_counted(replace(inner, selector=row), at, site) or ()]
        return [one for one in in_rows if one.selector.relative or ids_of(one.selector, site)] or None
    if at.either:
        ways = [trees_counted(inner, replace(at, spans=(one,), either=False), site) or [] for one in at.spans]
        return [place for way in ways for place in way]
    if at.near is not None:
        return _at_end_near(of, at.spans[0], at.near, site) if is_one_row(rows) else None
    middles = [number for first, number in at.spans if first == 0]
    if middles and (len(at.spans) == 1 or middles != [1]):
        return _middle_run(of, rows, at, site)
    one = is_one_row(rows)
    if not middles or one:
        parts = [_at(first, last, at, of) for first, last in at.spans]
    else:
        single = [row for row in one_by_one(rows, site) if ids_of(swapped(of, rows, row), site)]
        if not 0 < len(single) <= MOST_ONE_BY_ONE:
            return None
        parts = [_at(first, last, at, swapped(of, rows, row)) for row in single for first, last in at.spans]
    sizes = [size_of(each) for each in at.spans]
    count = sum(sizes) if one and all(sizes) else None
    alone = len(at.spans) == 1 and sizes == [1]
    selector = all_of(parts)
    if alone:
        return [PlaceMeaning(selector, "one" if one else "several", each=not one)]
    return [PlaceMeaning(selector, "several", count=count, each=at.each)]


def _at(first: int, last: int, at: Positions, of: s.Selector) -> s.Selector:
    """Return the trees at a range of positions of rows."""
    if first == 0:
        return s.Middle(of=of)
    return s.InRow(first=first, last=last, counted_from=at.counted_from, of=of)


def _middle_run(of: s.Selector, rows: s.Selector, at: Positions, site: Site) -> list[PlaceMeaning] | None:
    """Return the trees in the middle of a row: of an even number of trees there are two such runs of an odd number."""
    n = at.spans[0][1]
    left = len(ids_of(of, site) or ()) - n
    if len(at.spans) > 1 or n < 2 or left < 0 or not is_one_row(rows):
        return None
    starts = {left // 2 + 1, (left + 1) // 2 + 1}
    return [PlaceMeaning(s.InRow(first=k, last=k + n - 1, of=of), "several", count=n) for k in sorted(starts)]


def _at_end_near(of: s.Selector, run: Span, near: s.Selector, site: Site) -> list[PlaceMeaning] | None:
    """Return the trees at the end of a row that is nearer to a marker, which are those nearest to it."""
    nearest = s.Nearest(to=near, count=run[1], of=of)
    ends = [s.InRow(first=first, last=last, of=of) for first, last in (run, backwards(run))]
    if ids_of(nearest, site) not in [ids_of(end, site) for end in ends]:
        return None
    return [PlaceMeaning(nearest, "one" if run[1] == 1 else "several", count=run[1])]


def _numbered_in_area(inner: Nominal, numbers: TreeNumbers, site: Site) -> list[PlaceMeaning] | None:
    """Return "plant number 8 in the cool section", of each row in which it may be."""
    plain = is_description(inner.selector) and not inner.complete and rows_within(inner.selector) is None
    if not plain or not all(name.isdigit() for name in numbers.trees) or any(n in site.by_id for n in numbers.trees):
        return None
    return trees_counted(inner, Positions(tuple(runs(numbers.trees)), counted_from=numbers.counted_from), site)


def of_row_named_before(inner: Nominal, at: Positions | TreeNumbers) -> PlaceMeaning | None:
    """Return trees at some positions of a row that was named before them; None if the site itself may be meant."""
    if inner.selector != s.Trees() or inner.kind != "tree" or inner.single:
        return None
    if isinstance(at, TreeNumbers):
        if at.counted_from == "usual" or not all(name.isdigit() for name in at.trees):
            return None
        at = Positions(tuple(runs(at.trees)), counted_from=at.counted_from)
    if at.noun or at.near is not None or at.either or any(first < 1 or last < 1 for first, last in at.spans):
        return None
    if at.spans == ((1, 1),) and at.counted_from == "usual":
        return None
    parts = [s.InRow(first=first, last=last, counted_from=at.counted_from) for first, last in at.spans]
    count = sum(size_of(one) for one in at.spans)
    return PlaceMeaning(all_of(parts), "one" if count == 1 else "several", count=None if count == 1 else count)


def trees_numbered(inner: Nominal, numbers: TreeNumbers, site: Site) -> list[PlaceMeaning] | None:
    """Return trees with numbers in the rows of a description."""
    rows = inner.selector
    if not are_rows(rows):
        return _numbered_in_area(inner, numbers, site)
    count = len(numbers.trees) if is_one_row(rows) else None
    shape: Shape = "one" if count == 1 else "several"
    if numbers.counted_from == "usual" and not numbers.in_each_row:
        ways = numbered(numbers.trees, rows, site)
        return [PlaceMeaning(one, shape, count=count) for one in ways] or [elsewhere(numbers.trees)]
    if not all(name.isdigit() for name in numbers.trees):
        return None
    parts = [s.InRow(first=first, last=last, counted_from=numbers.counted_from) for first, last in runs(numbers.trees)]
    return [PlaceMeaning(over(all_of(parts), rows), shape, count=count)]
