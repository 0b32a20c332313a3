"""Units do not matter: lengths in metres or millimetres, rewards of 1 to 100 or of thousandths."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.orienteering.policy import Policy, solve
from fieldhand.orienteering.problem import Limit, Problem
from fieldhand.orienteering.route import StoppingCriterion
from fieldhand.orienteering.simulated_mission import simulate_mission

FEW = StoppingCriterion(rounds=1500)
seeds = st.integers(0, 10_000)


def scattered(n, seed, length=1.0, reward=1.0, coordinates=False):
    """Vertices at random in a square with sides of ``length``."""
    rng = np.random.default_rng(seed)
    xy, rewards = rng.random((n, 2)) * length, rng.random(n) * reward
    where = (
        {"coordinates": xy} if coordinates else {"distances": np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))}
    )
    service = np.full(n, 0.02 * length)
    limits = (Limit(budget=2.5 * length), Limit(budget=3.0 * length, service=service))
    return Problem(rewards=rewards, start=0, end=n - 1, limits=limits, **where)


@given(n=st.integers(5, 30), seed=seeds, length=st.sampled_from([1e3, 1e-3]), reward=st.sampled_from([100.0, 1e-3]))
@settings(max_examples=8, deadline=None)
def test_other_units_give_the_same_routes_and_the_same_missions(n, seed, length, reward):
    plane = bool(seed % 2)
    first, second = scattered(n, seed, coordinates=plane), scattered(n, seed, length, reward, plane)
    routes = [solve(problem, seed, FEW) for problem in (first, second)]
    assert routes[0].vertices == routes[1].vertices
    assert routes[1].reward == pytest.approx(routes[0].reward * reward)
    assert routes[1].length == pytest.approx(routes[0].length * length)
    missions = [
        simulate_mission(problem, Policy(problem, seed).next, np.random.default_rng(seed))
        for problem in (first, second)
    ]
    assert missions[0].path == missions[1].path
    assert missions[1].left == pytest.approx(np.array(missions[0].left) * length, rel=1e-6, abs=1e-9 * length)


@given(seed=seeds)
@settings(max_examples=8, deadline=None)
def test_whole_numbers_as_in_a_benchmark_file_are_driven_like_any_others(seed):
    # Coordinates up to thousands, distances rounded to whole numbers (some places twice), rewards 1 to 100.
    rng = np.random.default_rng(seed)
    xy, rewards = rng.integers(0, 4000, (40, 2)), rng.integers(1, 101, 40).astype(float)
    xy[7] = xy[8]
    d = np.rint(np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1)))
    given_ = Problem(distances=d, rewards=rewards, start=0, end=0, limits=(Limit(budget=9000.0),))
    route = solve(given_, seed, FEW)
    assert (route.vertices[0], route.vertices[-1]) == (0, 0)
    assert len(set(route.vertices)) == len(route.vertices) - 1
    assert route.chances[0] <= 0.1 + 1e-9
    assert route.length == sum(d[a, b] for a, b in pairwise(route.vertices))
    # Twenty stops of fifty on average, a third of the way between neighbours to spare.
    assert route.reward > 500.0
    made = simulate_mission(given_, Policy(given_, seed).next, np.random.default_rng(seed))
    assert made.path[0] == made.path[-1] == 0
    assert len(set(made.path)) == len(made.path) - 1
