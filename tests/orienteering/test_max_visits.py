"""At most so many visits: no route and no mission makes more, and nothing changes where that many do not fit."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.orienteering.policy import Policy, State, solve
from fieldhand.orienteering.problem import Limit, Problem, remaining_problem
from fieldhand.orienteering.route import StoppingCriterion
from fieldhand.orienteering.simulated_mission import simulate_mission
from support.graphs import problem

FEW = StoppingCriterion(rounds=2000)


def driven(given_, seed):
    return simulate_mission(given_, Policy(given_, seed).next, np.random.default_rng(seed))


@given(n=st.integers(4, 40), seed=st.integers(0, 10_000), most=st.integers(0, 12))
@settings(max_examples=20, deadline=None)
def test_no_route_and_no_mission_visits_more(n, seed, most):
    given_ = replace(problem(n, seed, budget=3.0, pf=0.3), max_visits=most)
    assert len(solve(given_, seed, FEW).vertices) - 2 <= most
    path = driven(given_, seed).path
    assert (path[0], path[-1]) == (0, n - 1)
    assert len(path) - 2 <= most


@given(seed=st.integers(0, 10_000))
@settings(max_examples=6, deadline=None)
def test_where_more_are_allowed_than_fit_nothing_changes(seed):
    free = problem(15, seed, budget=2.0, pf=0.3)
    for most in (13, 1000):
        bounded = replace(free, max_visits=most)
        assert solve(bounded, seed, FEW) == solve(free, seed, FEW)
        assert driven(bounded, seed) == driven(free, seed)


def test_fewer_visits_never_give_more_reward_beyond_noise():
    for seed in range(3):
        free = problem(30, seed, budget=4.0)
        rewards = [solve(replace(free, max_visits=most), 0, FEW).reward for most in (0, 1, 2, 5, 10, 20)]
        assert rewards[0] == 0.0
        assert all(more >= 0.98 * less for less, more in pairwise(rewards))
        assert rewards[-1] > rewards[1]


def test_where_the_number_of_visits_binds_the_best_vertices_are_taken():
    # Every vertex is near enough: of equal ways the rewards alone decide.
    given_ = replace(problem(20, 3, budget=100.0), max_visits=4)
    inner = np.sort(given_.rewards[1:-1])[-4:].sum()
    assert solve(given_, 0, FEW).reward == pytest.approx(inner)
    assert driven(given_, 0).reward == pytest.approx(inner + given_.rewards[-1])


def test_a_long_mission_stops_at_its_number_of_visits():
    xy = np.random.default_rng(3).random((150, 2))
    given_ = Problem(coordinates=xy, rewards=np.ones(150), start=0, end=0, limits=(Limit(budget=12.0),), max_visits=80)
    assert len(driven(given_, 5).path) == 82


def test_what_was_visited_counts_and_start_and_end_do_not():
    given_ = replace(problem(15, 2, budget=4.0), max_visits=3)
    done = State(vertex=5, left=(3.0,), visited=frozenset({0, 5, 6, 14}))
    left = Policy(given_, 0)
    assert left.next(done) not in (0, 5, 6)
    assert len(left.expectation.vertices) == 3
    full = State(vertex=7, left=(3.0,), visited=frozenset({5, 6, 7}))
    assert Policy(given_, 0).next(full) == 14
    assert remaining_problem(given_, 5, (3.0,), (5, 6, 0)).max_visits == 1
    assert remaining_problem(given_, 5, (3.0,), (5, 6, 7, 8)).max_visits == 0


def test_with_no_visit_allowed_the_outlook_still_tells_the_chance_of_arriving():
    policy = Policy(replace(problem(15, 2, budget=2.5), max_visits=0), 0)
    assert policy.next(State(vertex=0, left=(2.5,))) == 14
    assert 0.5 < policy.expectation.success <= 1.0
    assert policy.expectation.reward == 0.0


@pytest.mark.parametrize("most", [-1, 1.5, float("nan")])
def test_a_number_of_visits_is_a_whole_number(most):
    with pytest.raises(ProblemError, match="visits"):
        replace(problem(10, 1), max_visits=most)
