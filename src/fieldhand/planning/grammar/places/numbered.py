"""Trees by their numbers in rows: counted there, or known by these ids."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fieldhand.errors import PlaceError, TaskError
from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.selections import are_rows, over
from fieldhand.site.model import Site


def elsewhere(trees: Sequence[str]) -> PlaceMeaning:
    """Return the meaning of trees that do not stand in the rows in which a phrase says they do."""
    fault = message("not all of these trees stand in those rows", context="fault")
    return PlaceMeaning(all_of([s.TreeIs(tree=name) for name in trees]), "nowhere", fault=fault)


def numbered(trees: Sequence[str], rows: s.Selector, site: Site) -> list[s.Selector]:
    """Return what trees with numbers in rows can be: counted in the row, or known by these ids and standing there.

    Several meanings that are the same trees are one. If the site has none of them, the trees are counted, and the site
    says what it lacks.
    """
    by_id = all_of([s.TreeIs(tree=name) for name in trees])
    in_rows = ids_of(rows, site)
    fits = in_rows is not None and set(trees) <= in_rows
    if not all(name.isdigit() for name in trees):
        return [by_id] if fits or in_rows is None else []
    counted = over(all_of([s.InRow(first=first, last=last) for first, last in runs(trees)]), rows)
    at_places = ids_of(counted, site)
    if fits and (at_places is None or at_places == set(trees)):
        return [by_id]
    return [counted, by_id] if fits else [counted]


def runs(trees: Sequence[str]) -> Iterator[tuple[int, int]]:
    """Yield the ranges of numbers of which a list is made; two numbers that follow each other are no range."""
    numbers = [int(name) for name in trees]
    if len(numbers) > 2 and numbers == list(range(numbers[0], numbers[-1] + 1)):
        yield numbers[0], numbers[-1]
        return
    yield from ((number, number) for number in numbers)


def all_of(parts: Sequence[s.Selector]) -> s.Selector:
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


def are_two(selector: s.Selector, site: Site) -> bool:
    """Return True for two trees, rows, or places that are not known before the mission."""
    there = ids_of(selector, site)
    return are_rows(selector) or there is None or len(there) == 2
