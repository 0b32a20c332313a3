"""Constructions of trees by their numbers in rows: "tree 5 of row 3", "trees 2 to 4 of every row"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning, Shape
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import is_one_row, over
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "place: [DET] trees=tree_ids in_ rows=rows",
    "place: [DET] trees=tree_ids in_ rows=rows_of_block",
    "place: rows=rows [COMMA] trees=tree_ids",
    cost=0.1,
    given=("site",),
)
def trees_of_rows(trees: tuple[str, ...], rows: s.Selector, site: Site) -> list[PlaceMeaning]:
    """Compose "tree 5 of row 3"."""
    count = len(trees) if is_one_row(rows) else None
    shape: Shape = "one" if count == 1 else "several"
    return [PlaceMeaning(one, shape, count=count) for one in numbered(trees, rows, site)] or [_elsewhere(trees)]


@construction("place: whole=place except [DET] trees=tree_ids", cost=0.2, given=("site",))
def except_trees_of_rows(whole: PlaceMeaning, trees: tuple[str, ...], site: Site) -> list[PlaceMeaning] | None:
    """Compose "the trees of row 3 except tree 5"."""
    if whole.shape not in ("several", "area") or whole.count is not None or whole.per is not None:
        return None
    if whole.selector == s.Trees():
        return None
    ways = numbered(trees, whole.selector, site)
    if whole.selector.relative and all(name.isdigit() for name in trees):
        ways.append(_all_of([s.TreeIs(tree=name) for name in trees]))
    return [replace(whole, selector=s.Excluding(places=one, of=whole.selector)) for one in ways] or [_elsewhere(trees)]


def _elsewhere(trees: Sequence[str]) -> PlaceMeaning:
    """Return the meaning of trees that do not stand in the rows in which a phrase says they do."""
    fault = message("not all of these trees stand in those rows", context="fault")
    return PlaceMeaning(_all_of([s.TreeIs(tree=name) for name in trees]), "nowhere", fault=fault)


def numbered(trees: Sequence[str], rows: s.Selector, site: Site) -> list[s.Selector]:
    """Return what trees with numbers in rows can be: counted in the row, or known by these ids and standing there.

    Several meanings that are the same trees are one. If the site has none of them, the trees are counted, and the site
    says what it lacks.
    """
    by_id = _all_of([s.TreeIs(tree=name) for name in trees])
    in_rows = ids_of(rows, site)
    fits = in_rows is not None and set(trees) <= in_rows
    if not all(name.isdigit() for name in trees):
        return [by_id] if fits or in_rows is None else []
    counted = over(_all_of([s.InRow(first=first, last=last) for first, last in _runs(trees)]), rows)
    at_places = ids_of(counted, site)
    if fits and (at_places is None or at_places == set(trees)):
        return [by_id]
    return [counted, by_id] if fits else [counted]


def _runs(trees: Sequence[str]) -> Iterator[tuple[int, int]]:
    """Yield the ranges of numbers of which a list is made; two numbers that follow each other are no range."""
    numbers = [int(name) for name in trees]
    if len(numbers) > 2 and numbers == list(range(numbers[0], numbers[-1] + 1)):
        yield numbers[0], numbers[-1]
        return
    yield from ((number, number) for number in numbers)


def _all_of(parts: Sequence[s.Selector]) -> s.Selector:
    """Return the one selector, or all of them."""
    return parts[0] if len(parts) == 1 else s.UnionOf(parts=tuple(parts))


def ids_of(selector: s.Selector, site: Site) -> set[str] | None:
    """Return the ids of the trees of a selector; None if the site has no such trees, or it depends on the robot."""
    from fieldhand.places.resolution import resolve

    if selector.relative:
        return None
    try:
        return {place.id for place in resolve(selector, site, Context(here=site.start))}
    except (PlaceError, TaskError):
        return None


@construction(
    "place: [DET] trees=tree_ids FROM [DET] side=DIR in_ rows=rows",
    "place: [DET] trees=tree_ids FROM [DET] side=DIR in_ rows=each_row",
    cost=0.1,
)
def trees_from_side(trees: tuple[str, ...], side: Lex, rows: s.Selector) -> PlaceMeaning | None:
    """Compose "tree 3 from the south in row 4"."""
    if side.value not in SIDES or not all(name.isdigit() for name in trees):
        return None
    parts = [s.InRow(first=first, last=last, counted_from=side.value) for first, last in _runs(trees)]
    count = len(trees) if is_one_row(rows) else None
    return PlaceMeaning(over(_all_of(parts), rows), "one" if count == 1 else "several", count=count)


@construction("place: [DET] trees=tree_ids in_ rows=each_row", cost=0.1)
def trees_of_each_row(trees: tuple[str, ...], rows: s.Selector) -> PlaceMeaning | None:
    """Compose "trees 2 to 4 of every row"."""
    if not all(name.isdigit() for name in trees):
        return None
    return PlaceMeaning(
        over(_all_of([s.InRow(first=first, last=last) for first, last in _runs(trees)]), rows), "several"
    )
