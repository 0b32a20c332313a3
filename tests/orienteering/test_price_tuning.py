"""Missions on paper: what they say of the chance of failing is right on average, and sharp."""

from dataclasses import replace

import numpy as np
import pytest

from fieldhand.orienteering.costs import Gamma
from fieldhand.orienteering.policy import Policy, State
from fieldhand.orienteering.price_tuning import tune_price
from fieldhand.orienteering.problem import Limit, Problem
from fieldhand.orienteering.simulated_mission import simulate_mission
from support.graphs import problem


def driven(given_, policy, seeds, *, foreseen):
    """Missions at the policy's price."""
    found = []
    for seed in seeds:
        again = policy.again(seed, policy.price)
        success_after_leg = again.success_after_leg if foreseen else None
        found.append(simulate_mission(given_, again.next, np.random.default_rng([seed, 3]), success_after_leg))
    return found


@pytest.mark.parametrize("costs", [None, Gamma(0.6)], ids=repr)
def test_taking_out_the_luck_of_the_legs_keeps_the_mean_chance_and_sharpens_it(costs):
    given_ = replace(problem(15, 4, budget=2.0), costs=costs)
    policy = Policy(given_, 0)
    policy.next(State(vertex=0, left=(2.0,)))
    plain, sharp = (
        np.array([m.chance for m in driven(given_, policy, range(80), foreseen=foreseen)]) for foreseen in (False, True)
    )
    assert sharp.mean() == pytest.approx(plain.mean(), abs=3.0 * plain.std() / np.sqrt(80))
    assert sharp.std() < 0.5 * plain.std()


def test_what_is_foreseen_does_not_change_the_missions():
    given_ = problem(15, 4, budget=2.0)
    policy = Policy(given_, 0)
    policy.next(State(vertex=0, left=(2.0,)))
    paths = [[m.path for m in driven(given_, policy, range(10), foreseen=foreseen)] for foreseen in (False, True)]
    assert paths[0] == paths[1]


@pytest.mark.parametrize(("graph", "accepted"), [(4, 0.1), (9, 0.05)])
def test_fresh_missions_fail_no_more_often_than_accepted(graph, accepted):
    given_ = problem(15, graph, budget=2.0, pf=accepted)
    policy = tune_price(Policy(given_, 0, risk_tolerance=0.9), given_, 1, 160)
    chances = np.array([m.chance for m in driven(given_, policy, range(60), foreseen=True)])
    assert 0.75 * accepted < chances.mean() < accepted + 2.0 * chances.std() / np.sqrt(60)


def test_where_no_programme_is_made_nothing_is_foreseen():
    xy = np.random.default_rng(3).random((150, 2))
    given_ = Problem(coordinates=xy, rewards=np.ones(150), start=0, end=0, limits=(Limit(budget=12.0),))
    policy = Policy(given_, 5)
    assert policy.success_after_leg() is None
    policy.next(State(vertex=0, left=(12.0,)))
    assert policy.success_after_leg() is None
