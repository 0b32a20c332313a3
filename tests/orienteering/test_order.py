"""Orders of visits against brute force, and what holds of every one of them."""

from itertools import pairwise, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.orienteering.order import EXACT, improve, shortest_order
from graphs import euclidean

seeds = st.integers(0, 2**32 - 1)


def length(order, distances):
    return sum(distances[a, b] for a, b in pairwise(order))


@given(n=st.integers(1, 7), seed=seeds, closed=st.booleans())
@settings(max_examples=40, deadline=None)
def test_few_vertices_are_ordered_as_short_as_brute_force_finds(n, seed, closed):
    d = euclidean(n, seed)
    end = n - 1 if closed and n > 1 else None
    inner = [v for v in range(1, n) if v != end]
    tail = () if end is None else (end,)
    best = min(length((0, *p, *tail), d) for p in permutations(inner))
    assert length(shortest_order(d, 0, end), d) == pytest.approx(best)


@given(n=st.integers(2, 60), seed=seeds, closed=st.booleans())
@settings(max_examples=25, deadline=None)
def test_every_vertex_comes_once_between_the_ends_and_the_order_is_the_same_again(n, seed, closed):
    d = euclidean(n, seed)
    end = n - 1 if closed else None
    order = shortest_order(d, 0, end)
    assert sorted(order) == list(range(n))
    assert order[0] == 0
    assert not closed or order[-1] == end
    assert shortest_order(d, 0, end) == order


@given(n=st.integers(4, 40), seed=seeds)
@settings(max_examples=25, deadline=None)
def test_improving_a_path_keeps_its_ends_and_never_lengthens_it(n, seed):
    d = euclidean(n, seed)
    path = np.array([0, *np.random.default_rng(seed).permutation(np.arange(1, n - 1)), n - 1])
    better = improve(path, d)
    assert sorted(better) == list(range(n))
    assert (better[0], better[-1]) == (0, n - 1)
    assert length(better, d) <= length(path, d) + 1e-9


def test_local_search_comes_within_five_percent_of_the_exact_order():
    worse = []
    for seed in range(15):
        d = euclidean(EXACT + 2, seed)
        exact = length(shortest_order(d, 0, EXACT + 1), d)
        worse.append(length(improve(np.arange(EXACT + 2), d), d) / exact)
    assert np.mean(worse) < 1.05


def test_a_row_of_trees_is_driven_from_end_to_end():
    x = np.arange(40.0)
    assert shortest_order(np.abs(x[:, None] - x), 0) == tuple(range(40))


@pytest.mark.parametrize(
    ("distances", "start", "end"),
    [
        (np.zeros((2, 3)), 0, None),
        (np.array([[0.0, -1.0], [-1.0, 0.0]]), 0, None),
        (np.array([[0.0, np.nan], [np.nan, 0.0]]), 0, None),
        (np.array([[0.0, np.inf], [np.inf, 0.0]]), 0, None),
        (np.zeros((2, 2)), 2, None),
        (np.zeros((2, 2)), 0, -1),
    ],
)
def test_what_is_no_graph_is_refused(distances, start, end):
    with pytest.raises(ProblemError):
        shortest_order(distances, start, end)
