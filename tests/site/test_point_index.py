"""An index of points finds the same by comparing them as with a k-d tree."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from fieldhand.site import point_index
from fieldhand.site.point_index import PointIndex

Floats = NDArray[np.float64]

#: Coordinates on a coarse lattice, so that many points coincide or are equally distant.
COORDINATES = st.one_of(st.integers(-4, 4).map(float), st.floats(-100, 100, width=32))


def clouds(least: int) -> st.SearchStrategy[Floats]:
    points = st.lists(st.tuples(COORDINATES, COORDINATES), min_size=least, max_size=25)
    return points.map(lambda some: np.array(some, dtype=np.float64).reshape(-1, 2))


def both(points: Floats) -> tuple[PointIndex, PointIndex]:
    """Return an index that compares the points directly, and one that has built its tree."""
    direct, tree = PointIndex(points), PointIndex(points)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(point_index, "_FEW_PAIRS", -1)
        tree.nearest(np.zeros((1, 2)))
    return direct, tree


@given(clouds(0), clouds(0))
def test_nearest(points: Floats, to: Floats) -> None:
    (away, which), (expected, _) = (index.nearest(to) for index in both(points))
    assert away.tolist() == expected.tolist()
    if len(points):
        assert away.tolist() == np.sqrt(((points[which] - to) ** 2).sum(axis=1)).tolist()


@given(clouds(1), clouds(0), st.floats(0.0, 10.0))
def test_nearest_within_a_distance(points: Floats, to: Floats, within: float) -> None:
    direct, tree = (index.nearest(to, within=within) for index in both(points))
    assert direct[0].tolist() == tree[0].tolist()
    assert (direct[1] == len(points)).tolist() == (tree[1] == len(points)).tolist() == np.isinf(direct[0]).tolist()


@given(clouds(1), clouds(0), st.integers(1, 30))
def test_nearest_few(points: Floats, to: Floats, count: int) -> None:
    (away, which), (expected, _) = (index.nearest_few(to, count) for index in both(points))
    assert away.shape == which.shape == (len(to), min(count, len(points)))
    assert away.tolist() == expected.tolist()
    assert away.tolist() == np.sqrt(((points[which] - to[:, None]) ** 2).sum(axis=2)).tolist()
    assert all(len(set(some)) == len(some) for some in which.tolist())


@given(clouds(1), st.floats(0.0, 10.0), st.booleans())
def test_pairs(points: Floats, within: float, each_axis: bool) -> None:
    direct, tree = (sorted(index.pairs(within, each_axis=each_axis).tolist()) for index in both(points))
    assert direct == tree
    assert all(i < j for i, j in direct)


@given(clouds(1), clouds(0), st.floats(0.0, 10.0), st.booleans())
def test_points_close_to_others(points: Floats, to: Floats, within: float, each_axis: bool) -> None:
    direct, tree = (index.close_to(to, within, each_axis=each_axis).tolist() for index in both(points))
    assert sorted(direct) == sorted(tree)
    assert [k for k, _ in tree] == sorted(k for k, _ in tree)


def test_many_points_are_searched_with_a_tree() -> None:
    points = np.random.default_rng(1).random((600, 2))
    index = PointIndex(points)
    few = index.nearest_few(points[:300], 3)
    assert index._tree is None
    again = index.nearest_few(points[:300], 3)
    assert index._tree is not None
    assert few[0].tolist() == again[0].tolist()
    assert few[1].tolist() == again[1].tolist()
