"""What a selector may know of the mission: the trees that were visited."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from fieldhand.places.context import VisitedIds

names = st.sampled_from("abcdefg")


@given(st.lists(names, unique=True), st.lists(st.tuples(st.integers(0, 30), names), max_size=30))
def test_visited_trees_keep_their_order_and_no_walk_sees_those_of_another(first, steps):
    """Each step goes on from any of the earlier ones, as branches of a mission do."""
    walks, expected = [VisitedIds(first)], [tuple(first)]
    for origin, name in steps:
        k = origin % len(walks)
        walks.append(walks[k].plus(name))
        expected.append(expected[k] if name in expected[k] else (*expected[k], name))
    assert [tuple(walk) for walk in walks] == expected
    for walk, ids in zip(walks, expected, strict=True):
        assert len(walk) == len(ids)
        assert {n for n in "abcdefg" if n in walk} == set(ids)
        assert walk == ids == VisitedIds(ids)
        assert hash(walk) == hash(VisitedIds(ids))
