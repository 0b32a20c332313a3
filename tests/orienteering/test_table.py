"""Tables in single precision: their distances are right, and problems with them are solved just as well."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.orienteering.kernels.legs import length
from fieldhand.orienteering.network import Network
from fieldhand.orienteering.policy import Policy, State, solve
from fieldhand.orienteering.prepared_problem import prepare_problem
from fieldhand.orienteering.problem import Limit, Problem, remaining_problem
from fieldhand.orienteering.route import StoppingCriterion
from fieldhand.orienteering.simulated_mission import simulate_mission
from fieldhand.orienteering.table import MOST
from support.arrays import assert_near

seeds = st.integers(0, 10_000)


def sparse(nodes, seed, ways=1.3):
    """Ways at random: some of length 0, some twice, some from a node to itself; often in several parts."""
    rng = np.random.default_rng(seed)
    pairs = rng.integers(0, nodes, (int(ways * nodes) + 1, 2))
    lengths = rng.random(len(pairs)) * (rng.random(len(pairs)) > 0.15)
    twice = rng.integers(0, len(pairs), 3)
    return Network(
        nodes=nodes, edges=np.concatenate([pairs, pairs[twice, ::-1]]), lengths=np.append(lengths, rng.random(3))
    )


def grid(side, seed=0):
    """A square grid of roads, each a little longer than 1."""
    at = np.arange(side * side).reshape(side, side)
    ways = np.concatenate(
        [np.stack([at[:, :-1], at[:, 1:]], -1).reshape(-1, 2), np.stack([at[:-1], at[1:]], -1).reshape(-1, 2)]
    )
    return Network(nodes=side * side, edges=ways, lengths=1.0 + 0.2 * np.random.default_rng(seed).random(len(ways)))


def both(network, rewards, start, end, *limits):
    """The same problem in double and in single precision."""
    return [network.problem(rewards, start, end, limits, precision=form)[0] for form in ("double", "single")]


@given(seed=seeds, ways=st.floats(0.5, 2.5))
@settings(max_examples=25, deadline=None)
def test_distances_are_symmetric_and_those_in_double_precision(seed, ways):
    network = sparse(200, seed, ways)
    chosen = np.random.default_rng(seed).permutation(200)[:150]
    single, double = network.table(chosen).distances, network.distances(chosen)
    assert (single == single.T).all()
    assert (np.isinf(single) == np.isinf(double)).all()
    assert_near(single[np.isfinite(single)], double[np.isfinite(double)], rel=1e-7, within=1e-30)


@given(seed=seeds, start=st.integers(0, 29))
@settings(max_examples=15, deadline=None)
def test_loops_and_problem_see_the_same_lengths_in_both_precisions(seed, start):
    double, single = both(sparse(30, seed), np.ones(30), start, start, Limit(budget=1.0))
    first, second = prepare_problem(double), prepare_problem(single)
    for u in range(31):
        assert_near(second.row(u), first.row(u), rel=1e-6, within=1e-12)
        for v in range(31):
            assert length(second.lengths, u, v) == pytest.approx(length(first.lengths, u, v), rel=1e-6)
    assert single.length(3, 17) == pytest.approx(double.length(3, 17), rel=1e-6)


@given(seed=seeds)
@settings(max_examples=15, deadline=None)
def test_neighbours_are_the_nearest_along_the_ways(seed):
    network = sparse(60, seed, 2.0)
    away, near_ = network.distances(range(60)), network.table(range(60)).near
    np.fill_diagonal(away, np.inf)
    for v in range(60):
        near = [u for u in near_[v] if u != v]
        nearest = np.sort(away[v][np.isfinite(away[v])])[: near_.shape[1]]
        assert_near(away[v][near], nearest, within=1e-9)
        assert len(set(near)) == len(near)


@given(seed=st.integers(0, 500))
@settings(max_examples=5, deadline=None)
def test_routes_and_missions_are_as_valid_and_as_good_as_in_double_precision(seed):
    rewards = np.random.default_rng(seed).random(49)
    rewards[::3] = 0.0
    double, single = both(grid(7, seed), rewards, 0, 48, Limit(budget=26.0))
    routes = [solve(problem, seed, StoppingCriterion(rounds=3000)) for problem in (double, single)]
    assert routes[1].reward >= 0.97 * routes[0].reward
    assert routes[1].chances[0] <= 0.1 + 1e-9
    legs = sum(double.distances[a, b] for a, b in pairwise(routes[1].vertices))
    assert routes[1].length == pytest.approx(legs)
    made = simulate_mission(single, Policy(single, seed).next, np.random.default_rng(seed))
    assert (made.path[0], made.path[-1]) == (single.start, single.end)
    assert len(set(made.path)) == len(made.path)
    assert simulate_mission(single, Policy(single, seed).next, np.random.default_rng(seed)) == made


def test_what_is_left_of_a_problem_keeps_its_table():
    given_ = both(grid(5), np.ones(25), 0, 24, Limit(budget=14.0))[1]
    policy = Policy(given_, 0)
    first = policy.next(State(vertex=0, left=(14.0,)))
    rest = remaining_problem(given_, first, (12.0,), (first, 0))
    assert rest.table is given_.table
    assert Policy(rest, 0, price=policy.price).next(State(vertex=first, left=(12.0,))) not in (0, first)


def test_many_vertices_are_kept_in_single_precision_and_too_many_are_refused():
    limits = (Limit(budget=100.0),)
    few, many = (grid(side).problem(np.ones(side**2), 0, 0, limits)[0] for side in (10, 40))
    assert (few.table, many.distances.size) == (None, 0)
    assert many.table.distances.nbytes == 4 * many.size**2
    with pytest.raises(ProblemError, match="20,025 places are more than the 20,000"):
        grid(5).table(np.zeros(MOST + 25, dtype=np.int64))


def test_an_end_without_a_way_to_it_is_refused():
    network = Network(nodes=4, edges=np.array([[0, 1], [2, 3]]), lengths=np.ones(2))
    for form in ("double", "single"):
        with pytest.raises(ProblemError, match="no way"):
            network.problem(np.ones(4), 0, 3, (Limit(budget=9.0),), precision=form)


@pytest.mark.parametrize("form", ["double", "single"])
def test_what_cannot_be_reached_is_never_visited(form):
    near, far = grid(4), grid(5, 1)
    apart = Network(
        nodes=41, edges=np.concatenate([near.edges, far.edges + 16]), lengths=np.append(near.lengths, far.lengths)
    )
    given_, nodes = apart.problem(np.r_[np.ones(16), np.full(25, 9.0)], 0, 15, (Limit(budget=30.0),), precision=form)
    made = simulate_mission(given_, Policy(given_, 0).next, np.random.default_rng(0))
    for way in (solve(given_, 0, StoppingCriterion(rounds=500)).vertices, made.path):
        assert max(nodes[v] for v in way) < 16
        assert len(way) > 8


def test_a_table_that_does_not_belong_to_a_problem_is_refused():
    table = grid(3).table(range(9))
    values = {"start": 0, "end": 1, "limits": (Limit(budget=9.0),)}
    with pytest.raises(ProblemError, match="table of 9"):
        Problem(table=table, rewards=np.ones(8), **values)
    with pytest.raises(ProblemError, match="more than one way"):
        Problem(table=table, coordinates=np.zeros((9, 2)), rewards=np.ones(9), **values)
