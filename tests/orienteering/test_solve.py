"""What holds of every fixed route, brute force on small problems, and what is refused."""

from dataclasses import replace
from itertools import pairwise, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.orienteering.overrun import overrun_probability
from fieldhand.orienteering.policy import StoppingCriterion, solve
from fieldhand.orienteering.problem import Limit, Problem
from support.graphs import euclidean, problem

seeds = st.integers(0, 10_000)
BRIEF = StoppingCriterion(rounds=4000)


@given(n=st.integers(4, 40), seed=seeds, budget=st.floats(2.0, 4.0), pf=st.sampled_from([0.05, 0.1, 0.3]))
@settings(max_examples=12, deadline=None)
def test_a_route_joins_start_and_end_visits_nothing_twice_and_keeps_the_chance(n, seed, budget, pf):
    given_ = problem(n, seed, budget=budget, pf=pf)
    try:
        route = solve(given_, seed, BRIEF)
    except ProblemError:
        # Only where even the direct way is too risky.
        direct = given_.distances[0, n - 1]
        assert float(overrun_probability(direct, direct**2 / 4, direct**3 / 4, budget)) > pf
        return
    assert (route.vertices[0], route.vertices[-1]) == (0, n - 1)
    assert len(set(route.vertices)) == len(route.vertices)
    assert route.chances[0] <= pf + 1e-9
    assert route.reward == pytest.approx(given_.rewards[list(route.vertices[1:-1])].sum())
    legs = np.array([given_.distances[a, b] for a, b in pairwise(route.vertices)])
    assert route.length == pytest.approx(legs.sum())
    assert solve(given_, seed, BRIEF).vertices == route.vertices


@given(n=st.integers(3, 7), seed=seeds, factor=st.floats(1.0, 3.0))
@settings(max_examples=40, deadline=None)
def test_small_certain_problems_are_solved_as_well_as_by_brute_force(n, seed, factor):
    d = euclidean(n, seed)
    rewards = np.random.default_rng([seed, 1]).random(n)
    budget = d[0, n - 1] * factor
    best = 0.0
    for size in range(n - 1):
        for inner in permutations(range(1, n - 1), size):
            if sum(d[a, b] for a, b in pairwise((0, *inner, n - 1))) <= budget:
                best = max(best, rewards[list(inner)].sum())
    route = solve(
        Problem(distances=d, rewards=rewards, start=0, end=n - 1, limits=(Limit(budget=budget),), alpha=1.0), 0
    )
    assert route.reward == pytest.approx(best)


def test_more_budget_gives_more_reward_on_the_whole():
    for seed in range(4):
        rewards = [solve(problem(30, seed, budget=b), 0, BRIEF).reward for b in (2.5, 3.0, 4.0, 6.0)]
        assert all(more >= less * 0.98 for less, more in pairwise(rewards))
        assert rewards[-1] > rewards[0]


def test_a_second_limit_with_service_binds_where_it_is_the_tighter_one():
    loose = problem(20, 3, budget=6.0)
    visits = Limit(budget=8.0, service=np.full(20, 1.0))
    tight = replace(loose, limits=(*loose.limits, visits))
    route = solve(tight, 0)
    # Service 1 at each stop and at the end, and legs besides, out of 8.
    assert len(route.vertices) - 1 < 8
    assert len(solve(loose, 0).vertices) > len(route.vertices)
    assert max(route.chances) <= 0.1 + 1e-9


def test_legs_after_the_end_count():
    alone = problem(30, 5, budget=3.0)
    followed = replace(alone, legs_after=(0.4, 0.4))
    assert solve(followed, 0).reward < solve(alone, 0).reward


def test_stops_on_the_way_make_a_long_way_safe_enough():
    # 100 m in one leg cost more than 130 m once in five; over nine stops on the line hardly ever.
    x = np.arange(0.0, 101.0, 10.0)
    given_ = Problem(
        distances=np.abs(x[:, None] - x), rewards=np.ones(11), start=0, end=10, limits=(Limit(budget=130.0),)
    )
    assert float(overrun_probability(100.0, 2_500.0, 250_000.0, 130.0)) > 0.1
    assert solve(given_, 0).vertices == tuple(range(11))


def test_a_round_trip_comes_back_to_its_start():
    d = euclidean(15, 2)
    given_ = Problem(distances=d, rewards=np.ones(15), start=4, end=4, limits=(Limit(budget=1.5),))
    route = solve(given_, 0)
    assert (route.vertices[0], route.vertices[-1]) == (4, 4)
    assert len(route.vertices) > 2


def _with(**changes):
    values = {
        "distances": np.array([[0.0, 1.0, 2.0], [1.0, 0.0, 1.0], [2.0, 1.0, 0.0]]),
        "rewards": np.ones(3),
        "start": 0,
        "end": 2,
        "limits": (Limit(budget=3.0),),
        "alpha": 0.5,
    }
    return Problem(**{**values, **changes})


def _distances(value, both=True):
    d = np.array([[0.0, 1.0, 2.0], [1.0, 0.0, 1.0], [2.0, 1.0, 0.0]])
    d[0, 1] = value
    if both:
        d[1, 0] = value
    return d


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"distances": _distances(np.nan)}, "vertices 0 and 1"),
        ({"distances": _distances(-1.0)}, "-1"),
        ({"distances": _distances(5.0, both=False)}, "symmetric"),
        ({"distances": np.zeros((2, 2))}, "shape"),
        ({"rewards": np.array([0.0, np.nan, 0.0])}, "vertex 1"),
        ({"rewards": np.array([0.0, -2.0, 0.0])}, "-2"),
        ({"distances": np.zeros((1, 1)), "rewards": np.ones(1)}, "1 vertices"),
        ({"distances": np.zeros((0, 0)), "rewards": np.ones(0)}, "0 vertices"),
        ({"start": 3}, "start"),
        ({"end": -1}, "end"),
        ({"alpha": 1.5}, "alpha"),
        ({"limits": ()}, "no limit"),
        ({"limits": (Limit(budget=3.0, failure_probability=0.0),)}, "probability"),
        ({"limits": (Limit(budget=3.0, failure_probability=1.0),)}, "probability"),
        ({"limits": (Limit(budget=3.0, failure_probability=-0.1),)}, "probability"),
        ({"limits": (Limit(budget=3.0, failure_probability=1.5),)}, "probability"),
        ({"limits": (Limit(budget=3.0, failure_probability=np.nan),)}, "probability"),
        ({"limits": (Limit(budget=np.nan),)}, "budget"),
        ({"limits": (Limit(budget=-1.0),)}, "budget"),
        ({"limits": (Limit(budget=np.inf),)}, "budget"),
        ({"rewards": np.array([0.0, np.inf, 0.0])}, "vertex 1"),
        ({"distances": np.zeros((3, 2))}, "shape"),
        ({"limits": (Limit(budget=3.0, service=np.array([0.0, -1.0, 0.0])),)}, "service"),
        ({"limits": (Limit(budget=1.9),)}, "direct way"),
        ({"legs_after": (-1.0,)}, "after the end"),
        ({"distances": np.zeros((0, 0)), "coordinates": np.array([[0.0, 0.0], [1.0, np.nan], [2.0, 0.0]])}, "vertex 1"),
        ({"distances": np.zeros((0, 0)), "coordinates": np.zeros((2, 2))}, "coordinates of shape"),
        ({"coordinates": np.zeros((3, 2))}, "more than one way"),
        ({"distances": np.array([[0, 1, np.inf], [1, 0, np.inf], [np.inf, np.inf, 0]])}, "no way"),
    ],
)
def test_what_is_no_problem_is_refused_with_a_reason(changes, says):
    with pytest.raises(ProblemError, match=says):
        _with(**changes)


def test_a_budget_that_no_route_keeps_often_enough_is_refused():
    with pytest.raises(ProblemError, match="safest way"):
        solve(_with(limits=(Limit(budget=2.05),)), 0)


def test_a_search_that_is_given_no_time_is_refused():
    for wrong in ({"rounds": 0}, {"seconds": 0.0}, {"seconds": float("nan")}):
        with pytest.raises(ProblemError, match="round"):
            StoppingCriterion(**wrong)


def test_a_search_by_time_gives_a_route_as_good_as_a_counted_one():
    given_ = problem(25, 6, budget=2.5)
    timed = solve(given_, 0, StoppingCriterion(rounds=10**9, seconds=0.2))
    assert timed.chances[0] <= 0.1 + 1e-9
    assert timed.reward >= 0.95 * solve(given_, 0, StoppingCriterion(rounds=2000)).reward
