"""Orders of visits against brute force and against simpler ways, and what holds of every one of them."""

from itertools import pairwise, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.orienteering import shortest_order as order_module
from fieldhand.orienteering.prepared_problem import NO_LENGTHS
from fieldhand.orienteering.shortest_order import COMPILED_FROM, EXACT, shortest_order
from support.graphs import euclidean

seeds = st.integers(0, 2**32 - 1)


def length(order, distances):
    return sum(distances[a, b] for a, b in pairwise(order))


def between(xy):
    return np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))


def clusters(n, seed):
    """Distances between points in a few clusters, many times as far from each other as points in one."""
    rng = np.random.default_rng(seed)
    return between(
        rng.random((max(n // 20, 2), 2))[rng.integers(max(n // 20, 2), size=n)] + rng.normal(size=(n, 2)) / 50
    )


def orchard(n, seed):
    """Drives between trees along aisles that only the headlands at both ends join."""
    rng = np.random.default_rng(seed)
    aisles = max(round(n**0.5 / 2), 2)
    aisle, along = rng.integers(aisles, size=n), rng.integers(4 * aisles, size=n) * 5.0
    round_low = along[:, None] + along
    round_high = 2 * 20.0 * aisles - round_low
    across = 6.0 * np.abs(aisle[:, None] - aisle)
    within = np.abs(along[:, None] - along)
    return np.where(across == 0.0, within, np.minimum(round_low, round_high) + across)


kinds = st.sampled_from([euclidean, clusters, orchard])


def nearest_neighbours(distances, end):
    """The order that goes to the nearest, from there to the nearest again."""
    left = [v for v in range(1, len(distances)) if v != end]
    order = [0]
    while left:
        order.append(min(left, key=lambda v: distances[order[-1], v]))
        left.remove(order[-1])
    return order if end is None else [*order, end]


@given(n=st.integers(1, 7), seed=seeds, closed=st.booleans())
@settings(max_examples=40, deadline=None)
def test_few_vertices_are_ordered_as_short_as_brute_force_finds(n, seed, closed):
    d = euclidean(n, seed)
    end = n - 1 if closed and n > 1 else None
    inner = [v for v in range(1, n) if v != end]
    tail = () if end is None else (end,)
    best = min(length((0, *p, *tail), d) for p in permutations(inner))
    assert length(shortest_order(d, 0, end), d) == pytest.approx(best)


@given(n=st.integers(2, 60), seed=seeds, closed=st.booleans(), kind=kinds)
@settings(max_examples=25, deadline=None)
def test_every_vertex_comes_once_between_the_ends_and_the_order_is_the_same_again(n, seed, closed, kind):
    d = kind(n, seed)
    end = n - 1 if closed else None
    order = shortest_order(d, 0, end)
    assert sorted(order) == list(range(n))
    assert order[0] == 0
    assert not closed or order[-1] == end
    assert shortest_order(d, 0, end) == order


@given(n=st.integers(12, 60), seed=seeds, closed=st.booleans(), kind=kinds)
@settings(max_examples=30, deadline=None)
def test_no_order_is_longer_than_going_to_the_nearest_each_time(n, seed, closed, kind):
    d = kind(n, seed)
    end = n - 1 if closed else None
    assert length(shortest_order(d, 0, end), d) <= length(nearest_neighbours(d, end), d) * (1 + 1e-9)


@given(n=st.integers(12, 40), seed=seeds, kind=kinds)
@settings(max_examples=20, deadline=None)
def test_no_single_reversal_or_move_of_a_vertex_shortens_an_order(n, seed, kind):
    d = kind(n, seed)
    order = list(shortest_order(d, 0, n - 1))
    least = length(order, d) * (1 - 1e-9)
    for i in range(1, n - 1):
        for j in range(1, n - 1):
            low, high = min(i, j), max(i, j)
            assert length([*order[:low], *order[low : high + 1][::-1], *order[high + 1 :]], d) >= least
            rest = [v for k, v in enumerate(order) if k != i]
            assert length([*rest[:j], order[i], *rest[j:]], d) >= least


@pytest.mark.parametrize("kind", [euclidean, clusters, orchard])
@pytest.mark.parametrize("closed", [True, False])
def test_local_search_finds_the_exact_order_of_a_dozen_vertices(kind, closed, monkeypatch):
    ratios = []
    for seed in range(5):
        d = kind(EXACT + 2, seed)
        end = EXACT + 1 if closed else None
        exact = length(shortest_order(d, 0, end), d)
        with monkeypatch.context() as patched:
            patched.setattr(order_module, "EXACT", 0)
            ratios.append(length(shortest_order(d, 0, end), d) / exact)
    assert min(ratios) >= 1 - 1e-9
    assert np.mean(ratios) < 1.01


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("kind", [euclidean, clusters, orchard])
def test_compiled_code_searches_on_from_where_plain_python_stops(kind, closed):
    d = kind(COMPILED_FROM, 3)
    end = len(d) - 1 if closed else None
    order = shortest_order(d, 0, end)
    assert sorted(order) == list(range(len(d)))
    assert order[0] == 0
    assert not closed or order[-1] == end
    assert length(order, d) < length(nearest_neighbours(d, end), d)


def test_plain_and_compiled_code_give_the_same_order(monkeypatch):
    d = clusters(60, 5)
    monkeypatch.setattr(order_module, "_EFFORT_COMPILED", order_module._EFFORT)
    plain = shortest_order(d, 0)
    monkeypatch.setattr(order_module, "COMPILED_FROM", 0)
    assert shortest_order(d, 0) == plain


def test_coordinates_give_the_order_that_their_distances_give():
    xy = np.random.default_rng(8).random((COMPILED_FROM + 20, 2))
    ways = NO_LENGTHS._replace(xy=xy)
    assert shortest_order(ways, 0) == shortest_order(np.sqrt(((xy[:, None] - xy) ** 2).sum(axis=2)), 0)
    few = NO_LENGTHS._replace(xy=xy[:9])
    assert shortest_order(few, 0, 8) == shortest_order(between(xy[:9]), 0, 8)


@pytest.mark.parametrize("n", [40, COMPILED_FROM])
def test_a_row_of_trees_is_driven_from_end_to_end(n):
    x = np.arange(float(n))
    assert shortest_order(np.abs(x[:, None] - x), 0) == tuple(range(n))


@pytest.mark.parametrize("n", [40, COMPILED_FROM])
def test_vertices_that_share_one_place_are_all_visited(n):
    order = shortest_order(np.zeros((n, n)), 1, 2)
    assert sorted(order) == list(range(n))
    assert (order[0], order[-1]) == (1, 2)


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
