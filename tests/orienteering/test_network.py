"""Sparse drivable graphs: distances along the edges, problems over what is worth a visit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import Deterministic
from fieldhand.orienteering.network import Network
from fieldhand.orienteering.problem import Limit
from fieldhand.orienteering.route import StoppingCriterion, solve
from support.arrays import assert_near


def row_of(nodes, spacing=10.0):
    edges = np.array([[i, i + 1] for i in range(nodes - 1)])
    return Network(nodes=nodes, edges=edges, lengths=np.full(nodes - 1, spacing))


@given(n=st.integers(2, 12), seed=st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_distances_are_those_of_floyd_and_warshall(n, seed):
    rng = np.random.default_rng(seed)
    m = int(rng.integers(1, 3 * n))
    edges, lengths = rng.integers(0, n, (m, 2)), rng.random(m)
    d = np.full((n, n), np.inf)
    np.fill_diagonal(d, 0.0)
    for (a, b), x in zip(edges, lengths, strict=True):
        if a != b:
            d[a, b] = d[b, a] = min(d[a, b], x)
    for k in range(n):
        d = np.minimum(d, d[:, [k]] + d[[k]])
    found = Network(nodes=n, edges=edges, lengths=lengths).distances(range(n))
    assert np.isfinite(found).tolist() == np.isfinite(d).tolist()
    assert_near(found[np.isfinite(d)], d[np.isfinite(d)], within=1e-9)


def test_junctions_are_no_vertices_but_are_driven_over():
    rewards = np.zeros(7)
    rewards[[2, 5]] = 1.0
    limits = (Limit(budget=60.0),)
    made, nodes = row_of(7).problem(rewards, 0, 6, limits, Deterministic())
    assert nodes == (0, 2, 5, 6)
    assert [nodes[v] for v in solve(made, 0, StoppingCriterion(rounds=50)).vertices] == [0, 2, 5, 6]


def test_what_cannot_be_reached_is_left_out_of_the_route():
    network = Network(nodes=4, edges=np.array([[0, 1], [1, 3]]), lengths=np.ones(2))
    made, nodes = network.problem(np.array([0.0, 1.0, 9.0, 0.0]), 0, 3, (Limit(budget=9.0),))
    assert [nodes[v] for v in solve(made, 0, StoppingCriterion(rounds=50)).vertices] == [0, 1, 3]


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"nodes": 1, "edges": np.zeros((0, 2), int), "lengths": np.zeros(0)}, "1 nodes"),
        ({"edges": np.array([[0, 3]]), "lengths": np.ones(1)}, "way 0"),
        ({"lengths": np.array([1.0, -1.0])}, "-1"),
        ({"lengths": np.array([np.nan, 1.0])}, "way 0"),
        ({"lengths": np.ones(3)}, "do not fit"),
    ],
)
def test_what_is_no_network_is_refused_with_a_reason(changes, says):
    with pytest.raises(ProblemError, match=says):
        Network(**({"nodes": 3, "edges": np.array([[0, 1], [1, 2]]), "lengths": np.ones(2)} | changes))


def test_an_end_without_a_way_to_it_is_refused():
    network = Network(nodes=4, edges=np.array([[0, 1], [2, 3]]), lengths=np.ones(2))
    with pytest.raises(ProblemError, match="no way"):
        network.problem(np.ones(4), 0, 3, (Limit(budget=9.0),))
