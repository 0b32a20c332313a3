"""What selectors choose from: areas in their order of nesting, and rows."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

from fieldhand.places import selectors as s

#: Areas by the order in which they are nested, the innermost first: a row of a half of a block.
_NESTING: dict[type[s.Selector], int] = {
    s.InBlock: 0,
    s.Half: 1,
    s.Quarter: 1,
    s.Edge: 2,
    s.Rows: 2,
    s.InZone: 3,
}
#: Selectors of areas.
AREAS = tuple(_NESTING)


def over(selector: s.Selector, base: s.Selector) -> s.Selector:
    """Return a selector that chooses from ``base`` instead of from every tree of the site.

    Areas are nested in a fixed order, whatever the order of the words: "the northern half in row 4" is row 4 of the
    northern half. "The first tree" of rows is the first tree of each.
    """
    if selector == s.Trees():
        return base
    if isinstance(selector, s.UnionOf):
        return s.UnionOf(parts=tuple(over(part, base) for part in selector.parts))
    if isinstance(selector, s.First | s.Last) and selector.of == s.Trees() and are_rows(base):
        number = 1 if isinstance(selector, s.First) else -1
        return s.InRow(first=number, last=number, of=base)
    rank, other = _NESTING.get(type(selector)), _rank(base)
    if rank is not None and other is not None and rank < other:
        return over(base, selector)
    of = getattr(selector, "of", None)
    if of is None:
        return selector
    changed: s.Selector = replace(cast(Any, selector), of=over(of, base))
    return changed


def _rank(selector: s.Selector) -> int | None:
    """Return how far outside an area is nested; None for a selector that is no area."""
    if isinstance(selector, s.UnionOf):
        return max((rank for part in selector.parts if (rank := _rank(part)) is not None), default=None)
    return _NESTING.get(type(selector))


def are_rows(selector: s.Selector) -> bool:
    """Return True for rows, and for lists of rows."""
    return all(isinstance(part, s.Rows | s.RowOf) for part in selector.members)


def is_one_row(rows: s.Selector) -> bool:
    """Return True for a single row."""
    return isinstance(rows, s.RowOf) or (isinstance(rows, s.Rows) and rows.first == rows.last != "")


def are_several_rows(selector: s.Selector) -> bool:
    """Return True for several rows, whose trees are selected."""
    return are_rows(selector) and not is_one_row(selector)


def counts_in_row(selector: s.Selector) -> bool:
    """Return True for trees that are counted along their rows."""
    return isinstance(selector, s.InRow)


def rows_of(selector: s.Selector) -> tuple[s.Rows, ...]:
    """Return the rows in a selector that are named by their labels, or are all rows."""
    return tuple(part for part in selector.walk() if isinstance(part, s.Rows))


def chooses_from_trees(selector: s.Selector) -> bool:
    """Return True if a selector can be restricted: it chooses from every tree of the site at last."""
    if selector == s.Trees():
        return True
    if isinstance(selector, s.UnionOf):
        return all(chooses_from_trees(part) for part in selector.parts)
    if isinstance(selector, s.RowOf):
        return False
    of = getattr(selector, "of", None)
    return of is not None and chooses_from_trees(of)
