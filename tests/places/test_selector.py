"""What selectors tell of themselves without their classes, held against the places that they resolve to."""

from __future__ import annotations

import pytest

from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import SELECTORS
from fieldhand.site.loader import open_site

SITE = open_site("demo")
EXAMPLES = [kind.example(SITE) for kind in SELECTORS]
JOINED = s.UnionOf(parts=(s.TreeIs(tree="4"), s.Rows(first="2", last="3"), s.Corners()))


def ids(selector: s.Selector, here: str = "4") -> list[str]:
    tree = SITE.by_id[here].place
    return [p.id for p in resolve(selector, SITE, Context(here=tree, visited=(), bound={"seen": (tree,)}))]


@pytest.mark.parametrize("selector", [*EXAMPLES, JOINED], ids=lambda x: type(x).__name__)
def test_members_together_are_the_places_of_a_selector(selector: s.Selector) -> None:
    if selector.members != (selector,):
        joined = [name for part in selector.members for name in ids(part)]
        assert ids(selector) == list(dict.fromkeys(joined))


def test_only_a_union_has_other_members_than_itself() -> None:
    assert [type(x) for x in EXAMPLES if x.members != (x,)] == [s.UnionOf]
    assert JOINED.members == JOINED.parts


@pytest.mark.parametrize("selector", EXAMPLES, ids=lambda x: type(x).__name__)
def test_a_selector_names_a_marker_only_where_it_is_that_place(selector: s.Selector) -> None:
    assert bool(selector.named_marker) == isinstance(selector, s.Marker)
    if selector.named_marker:
        assert ids(selector) == [SITE.markers[selector.named_marker].id]


@pytest.mark.parametrize("selector", EXAMPLES, ids=lambda x: type(x).__name__)
def test_any_few_of_a_group_are_of_it_and_depend_on_where_the_robot_is(selector: s.Selector) -> None:
    group = selector.any_of
    assert (group is not None) == isinstance(selector, s.Take)
    if group is not None:
        assert set(ids(selector)) < set(ids(group))
        assert len(ids(selector)) == selector.size.exact
        assert selector.relative


@pytest.mark.parametrize("over", [0, 1])
def test_the_row_of_a_place_moves_with_that_place(over: int) -> None:
    row = s.RowOf(over=over)
    assert row.row_of == s.Here()
    assert [x for x in EXAMPLES if x.row_of is not None] == [s.RowOf.example(SITE)]
    rows = SITE.planting.rows
    first, second = (str(SITE.trees[int(rows[k].trees[0])].place.id) for k in (0, 1))
    assert set(ids(row, first)).isdisjoint(ids(row, second))


def test_what_is_central_is_nearest_to_a_middle() -> None:
    assert {type(x) for x in EXAMPLES if x.central} == {s.Middle, s.EdgeMiddle}
