"""The policy over whole missions: the chance that was accepted is kept, and what is left is put to use."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import Deterministic, Empirical, Gamma, Lognormal
from fieldhand.orienteering.policy import Policy, State, solve
from fieldhand.orienteering.problem import Limit, Problem, remaining_problem
from fieldhand.orienteering.simulated_mission import simulate_mission
from support.graphs import begun, mission, problem

MISSIONS = 25
GRAPHS = (0, 1, 4)


@cache
def missions():
    """For each graph the missions on it: reward collected, and what was left."""
    found = {}
    for graph in GRAPHS:
        on = problem(15, graph, budget=2.5)
        driven = [mission(on, seed) for seed in range(MISSIONS)]
        found[graph] = [(float(on.rewards[list(path[1:-1])].sum()), left) for path, left in driven]
    return found


def test_missions_exceed_their_budget_no_more_often_than_accepted():
    lefts = [left for of_graph in missions().values() for _, left in of_graph]
    assert sum(left < 0 for left in lefts) <= 0.1 * len(lefts) + 3 * np.sqrt(0.1 * 0.9 * len(lefts))


def test_deciding_anew_collects_more_than_the_best_fixed_route():
    collected = sum(reward for of_graph in missions().values() for reward, _ in of_graph)
    assert collected > sum(MISSIONS * solve(problem(15, graph, budget=2.5), 0).reward for graph in GRAPHS)


@given(graph=st.integers(0, 500), seed=st.integers(0, 500))
@settings(max_examples=5, deadline=None)
def test_a_mission_ends_at_the_end_visits_nothing_twice_and_is_the_same_again(graph, seed):
    given_ = problem(12, graph, budget=2.5)
    path, left = mission(given_, seed)
    assert (path[0], path[-1]) == (0, 11)
    assert len(set(path)) == len(path)
    assert mission(given_, seed) == (path, left)


def test_what_is_accepted_more_often_collects_more():
    bold, careful = (problem(15, 0, budget=1.6, pf=pf) for pf in (0.3, 0.01))
    rewards, failures = [], []
    for given_ in (bold, careful):
        policy = begun(given_)
        driven = [
            simulate_mission(given_, policy.again(s, policy.price).next, np.random.default_rng(s)) for s in range(40)
        ]
        rewards.append(np.mean([m.reward for m in driven]))
        failures.append(np.mean([m.chance for m in driven]))
    assert rewards[0] > rewards[1]
    assert failures[0] > failures[1]


def test_more_budget_never_collects_less_beyond_noise():
    means = []
    for budget in (1.5, 2.0, 3.0, 5.0):
        given_ = problem(20, 7, budget=budget)
        policy = begun(given_)
        driven = [
            simulate_mission(given_, policy.again(s, policy.price).next, np.random.default_rng(s)) for s in range(30)
        ]
        means.append(np.mean([m.reward if m.kept else 0.0 for m in driven]))
    assert all(more > less - 0.05 * less for less, more in pairwise(means))


def test_coordinates_and_their_distances_are_the_same_problem():
    xy = np.random.default_rng(3).random((30, 2))
    values = {"rewards": np.random.default_rng(4).random(30), "start": 0, "end": 29, "limits": (Limit(budget=2.0),)}
    by_plane = Problem(coordinates=xy, **values)
    by_table = Problem(distances=np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1)), **values)
    paths = [simulate_mission(p, Policy(p, 5).next, np.random.default_rng(6)).path for p in (by_plane, by_table)]
    assert paths[0] == paths[1]


@given(seed=st.integers(0, 500), scale=st.sampled_from([1e-3, 50.0, 4000.0]))
@settings(max_examples=6, deadline=None)
def test_units_of_length_and_of_reward_do_not_matter(seed, scale):
    given_ = problem(15, seed, budget=2.0)
    scaled = Problem(
        distances=given_.distances * scale, rewards=given_.rewards * 64.0, start=0, end=14,
        limits=(Limit(budget=2.0 * scale),),
    )  # fmt: skip
    first = [Policy(p, 1).next(State(vertex=0, left=(p.limits[0].budget,))) for p in (given_, scaled)]
    assert first[0] == first[1]


@pytest.mark.parametrize(
    "costs", [Gamma(0.4), Lognormal(0.6), Empirical([0.7, 0.9, 1.0, 1.1, 2.0]), Deterministic()], ids=repr
)
def test_any_cost_model_can_be_driven_within_the_accepted_chance(costs):
    drawn = problem(15, 1, budget=2.5)
    given_ = replace(drawn, costs=costs)
    policy = begun(given_)
    driven = [simulate_mission(given_, policy.again(s, policy.price).next, np.random.default_rng(s)) for s in range(60)]
    assert np.mean([m.chance for m in driven]) <= 0.1 + 3 * np.sqrt(0.1 * 0.9 / 60)
    assert np.mean([m.reward for m in driven]) > 0.0


def test_hundreds_of_vertices_are_driven_over_from_end_to_end():
    xy = np.random.default_rng(3).random((300, 2))
    given_ = Problem(coordinates=xy, rewards=np.ones(300), start=0, end=0, limits=(Limit(budget=6.0),))
    made = simulate_mission(given_, Policy(given_, 5).next, np.random.default_rng(6))
    assert made.path[0] == made.path[-1] == 0
    assert len(set(made.path)) == len(made.path) - 1
    assert len(made.path) > 80


def test_more_time_gives_an_order_no_worse():
    given_ = problem(30, 2, budget=2.0)
    state = State(vertex=0, left=(2.0,))
    quick, slow = Policy(given_, 1, price=1.0), Policy(given_, 1, price=1.0)
    quick.next(state)
    slow.next(state, seconds=0.3)
    values = [p.expectation.reward + 1.0 * p.expectation.success for p in (quick, slow)]
    assert values[1] >= values[0] - 1e-9


def test_the_chances_of_visits_add_up_to_what_the_outlook_expects():
    given_ = replace(problem(20, 3, budget=1.8), rewards=np.r_[0.0, np.ones(18), 0.0])
    policy = Policy(given_, 1)
    first = policy.next(State(vertex=0, left=(1.8,)))
    chances = policy.chances()
    assert tuple(chances) == policy.expectation.vertices[1:-1]
    assert chances[first] == pytest.approx(1.0)
    assert all(0.0 <= chance <= 1.0 for chance in chances.values())
    # Reward of missions that fail does not count in the outlook; of those that succeed every visit does.
    assert policy.expectation.reward <= sum(chances.values()) + 1e-6
    assert sum(chances.values()) - (1.0 - policy.expectation.success) * len(chances) <= policy.expectation.reward + 1e-6


def test_a_mission_can_be_taken_up_by_a_policy_for_what_is_left():
    given_ = problem(20, 3, budget=2.0)
    policy = Policy(given_, 1)
    first = policy.next(State(vertex=0, left=(2.0,)))
    rest = remaining_problem(given_, first, (1.6,), (first, 0))
    taken = Policy(
        rest, 1, price=policy.price, collected=float(given_.rewards[first]), warm=policy.expectation.vertices[2:-1]
    )
    vertex = taken.next(State(vertex=first, left=(1.6,)))
    assert vertex not in (0, first)
    assert taken.price == policy.price


def test_nothing_is_worth_a_visit_so_the_end_comes_next():
    given_ = replace(problem(10, 1), rewards=np.zeros(10))
    assert Policy(given_, 0).next(State(vertex=0, left=(2.0,))) == 9


def test_with_nothing_left_the_end_comes_next():
    given_ = problem(10, 1)
    assert Policy(given_, 0).next(State(vertex=3, left=(-0.5,), visited=frozenset({3}))) == 9


@pytest.mark.parametrize(
    ("state", "says"),
    [
        (State(vertex=10, left=(1.0,)), "vertex 10"),
        (State(vertex=-1, left=(1.0,)), "vertex -1"),
        (State(vertex=1, left=(1.0,), visited=frozenset({99})), "vertex 99"),
        (State(vertex=1, left=(float("nan"),)), "nan"),
        (State(vertex=1, left=()), "give 1"),
    ],
)
def test_a_state_of_another_problem_is_refused(state, says):
    with pytest.raises(ProblemError, match=says):
        Policy(problem(10, 1), 0).next(state)


@pytest.mark.parametrize("risk_tolerance", [-0.1, 1.1, float("nan")])
def test_daring_is_a_number_from_zero_to_one(risk_tolerance):
    with pytest.raises(ProblemError, match="risk tolerance"):
        Policy(problem(10, 1), 0, risk_tolerance=risk_tolerance)


def test_certain_missions_never_exceed_their_budget():
    for graph in range(8):
        assert mission(problem(15, graph, budget=2.0, alpha=1.0), 0)[1] >= -1e-9
