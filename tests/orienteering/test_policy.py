"""The policy over whole missions: the chance that was accepted is kept, and what is left is put to use."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.orienteering.policy import solve
from fieldhand.orienteering.split import Option, split
from fieldhand.orienteering.tail import chance_over
from graphs import mission, problem

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


def test_certain_missions_never_exceed_their_budget():
    for graph in range(8):
        assert mission(problem(15, graph, budget=2.0, alpha=1.0), 0)[1] >= -1e-9


options = st.lists(
    st.builds(
        lambda legs, reward: Option(length=sum(legs), squares=sum(x**2 for x in legs), service=(0.0,), reward=reward),
        st.lists(st.floats(1.0, 15.0), min_size=1, max_size=8),
        st.floats(0.0, 5.0),
    ),
    max_size=8,
)


@given(home=st.floats(1.0, 20.0), more=options, leg=st.floats(1.0, 20.0), level=st.floats(0.01, 0.5))
@settings(max_examples=20, deadline=None)
def test_what_is_allowed_after_a_leg_is_on_average_what_was_allowed_before_it(home, more, leg, level):
    direct = Option(length=home, squares=home**2, service=(0.0,), reward=0.0)
    left = 2.5 * (home + leg)
    given_ = split(np.array([level]), leg, 0.5, [left], [direct, *more])
    costs = leg * (0.5 + np.random.default_rng(3).exponential(0.5, 600))
    after = [given_.levels([left - cost])[0] for cost in costs]
    alone = np.mean(chance_over(home, home**2, left - costs, 0.5))
    spread = 3 * np.std(after) / np.sqrt(len(costs))
    # Where even the way home by itself is riskier than that, that is what it is.
    assert np.mean(after) <= max(level, alone) + spread + 0.01
    if alone < level - 0.01:
        assert np.mean(after) >= level - spread - 0.01


def test_where_nothing_is_at_stake_the_level_stays():
    direct = Option(length=1.0, squares=1.0, service=(0.0,), reward=0.0)
    given_ = split(np.array([0.1]), 1.0, 0.5, [1000.0], [direct])
    assert given_.levels([999.0])[0] == pytest.approx(0.1)
