"""The solvers of the benchmark: each drives a mission that is one, and the exact ones find the exact answer."""

from dataclasses import replace
from itertools import pairwise, permutations

import numpy as np
import pytest

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import Deterministic
from fieldhand.orienteering.problem import Limit, Problem
from fieldhand.orienteering.simulated_mission import simulate_mission
from fieldhand_bench.orienteering.bound import with_perfect_information
from fieldhand_bench.orienteering.certain import compare
from fieldhand_bench.orienteering.milp import solve_milp
from fieldhand_bench.orienteering.solvers import Options, prepare, solver_names
from support.graphs import problem

SOLVERS = solver_names()
QUICK = Options(milp_s=5.0, missions=12, simulations=300)


def brute_force(given):
    best = 0.0
    for size in range(given.size - 1):
        for inner in permutations(range(1, given.size - 1), size):
            path = (0, *inner, given.size - 1)
            if sum(given.distances[a, b] for a, b in pairwise(path)) <= given.limits[0].budget:
                best = max(best, float(given.rewards[list(inner)].sum()))
    return best


@pytest.mark.parametrize("name", SOLVERS)
def test_a_mission_goes_from_start_to_end_visits_nothing_twice_and_is_the_same_again(name):
    given = problem(9, 3, budget=2.0)
    prepared = prepare(name, given, QUICK)
    for seed in range(4):
        made, again = (simulate_mission(given, prepared.mission(seed), np.random.default_rng(seed)) for _ in range(2))
        assert (made.path[0], made.path[-1]) == (0, 8)
        assert len(set(made.path)) == len(made.path)
        assert made == again


@pytest.mark.parametrize("seed", range(3))
def test_the_programme_finds_the_best_route_where_costs_are_certain(seed):
    given = replace(problem(7, seed, budget=1.5), costs=Deterministic())
    found = solve_milp(given, 0, 30.0, samples=1)
    assert found.optimal
    assert found.reward == pytest.approx(brute_force(given))
    assert found.bound == pytest.approx(found.reward, rel=1e-3, abs=1e-6)


def test_the_programme_keeps_its_samples_and_pays_for_safety():
    bold, careful = (problem(8, 1, budget=1.6, pf=pf) for pf in (0.5, 0.02))
    assert solve_milp(careful, 0, 20.0, samples=30).reward <= solve_milp(bold, 0, 20.0, samples=30).reward


def test_who_knows_every_cost_collects_at_least_as_much_as_who_does_not():
    given = problem(10, 2, budget=1.8)
    known = np.mean([with_perfect_information(given, seed)[0] for seed in range(60)])
    prepared = prepare("online", given, QUICK)
    driven = [simulate_mission(given, prepared.mission(s), np.random.default_rng(s)) for s in range(60)]
    assert known > np.mean([m.reward if m.kept else 0.0 for m in driven])


def test_a_world_in_which_the_end_is_too_far_is_said_to_be_so():
    given = problem(5, 2, budget=10.0)
    near = replace(given, limits=(Limit(budget=float(given.distances[0, 4]) * 1.0001),))
    reached = [with_perfect_information(near, seed)[1] for seed in range(40)]
    assert any(reached)
    assert not all(reached)


def test_greedy_goes_where_the_reward_for_the_way_is_greatest():
    x = np.array([0.0, 1.0, 2.0, 10.0])
    given = Problem(
        distances=np.abs(x[:, None] - x),
        rewards=np.array([0.0, 1.0, 5.0, 0.0]),
        start=0,
        end=3,
        limits=(Limit(budget=90.0),),
    )
    assert simulate_mission(given, prepare("greedy", given, QUICK).mission(0), np.random.default_rng(0)).path == (
        0,
        2,
        1,
        3,
    )


def test_without_chance_the_search_finds_what_pyvrp_finds():
    pytest.importorskip("pyvrp")
    for seconds in (0.4, 4.0, 40.0):  # releases for Python 3.10 need more iterations to find any route
        ours, other = compare(problem(15, 4, budget=2.0), 0, seconds)
        if other.reward:
            break
    assert ours.reward >= 0.99 * other.reward > 0.0
    assert max(ours.length, other.length) <= 2.0 + 1e-6


def test_an_unknown_solver_and_a_problem_of_another_kind_are_refused():
    given = problem(6, 1)
    with pytest.raises(ProblemError, match="no solver"):
        prepare("oracle", given, QUICK)
    for name in ("milp", "mcts"):
        with pytest.raises(ProblemError, match="one limit"):
            prepare(name, replace(given, limits=(*given.limits, *given.limits)), QUICK).mission(0)
