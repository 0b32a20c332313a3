"""The programme over what is left: what it predicts is what missions that follow it meet."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.orienteering.costs import Gamma, Lognormal
from fieldhand.orienteering.decision import DecisionSearch, SearchEffort
from fieldhand.orienteering.prepared_problem import prepare_problem
from fieldhand.orienteering.problem import Limit, Problem
from support.examples import examples
from support.graphs import euclidean, problem


def search(given_, here, left, state=1):
    free = np.ones(given_.size, dtype=bool)
    effort = SearchEffort(points=256)
    return DecisionSearch(prepare_problem(given_), here, left, free, effort, np.array([state], dtype=np.uint64))


def follow(given_, stops, bonus, rng):
    """A mission that only ever skips stops of one order: reward, and whether it kept to the budget."""
    here, left, got, ahead = given_.start, given_.limits[0].budget, 0.0, stops
    while True:
        order = search(given_, here, (left,)).order(ahead, bonus + got, 0)
        last = order.first == len(ahead)
        vertex = given_.end if last else int(ahead[order.first])
        left -= given_.length(here, vertex) * float(given_.model.draw(rng, 1)[0])
        if left < 0.0:
            return 0.0, False
        if last:
            return got, True
        got += float(given_.rewards[vertex])
        here, ahead = vertex, ahead[order.first + 1 :]


@pytest.mark.parametrize("costs", [None, Gamma(0.6), Lognormal(0.7)], ids=repr)
def test_missions_that_follow_the_programme_meet_what_it_predicts(costs):
    drawn = problem(12, 3, budget=1.6)
    given_ = Problem(
        distances=drawn.distances, rewards=drawn.rewards, start=0, end=11, limits=drawn.limits, costs=costs
    )
    found = search(given_, 0, (1.6,)).best(1.0, ())
    predicted = search(given_, 0, (1.6,)).order(found.stops, 1.0, 0)
    rng, missions = np.random.default_rng(5), examples(150, thorough=400)
    driven = [follow(given_, found.stops, 1.0, rng) for _ in range(missions)]
    kept = np.mean([ok for _, ok in driven])
    rewards = np.array([reward for reward, _ in driven])
    assert len(found.stops) >= 3
    assert kept == pytest.approx(predicted.success, abs=3 * np.sqrt(kept * (1 - kept) / missions) + 0.02)
    assert rewards.mean() == pytest.approx(predicted.worth, abs=3 * rewards.std() / np.sqrt(missions) + 0.05)


@given(seed=st.integers(0, 10_000), bonus=st.floats(-1.0, 10.0))
@settings(max_examples=15, deadline=None)
def test_an_order_is_never_worth_less_for_stops_that_it_gains(seed, bonus):
    given_ = problem(20, seed, budget=2.0)
    view = search(given_, 0, (2.0,))
    if not len(view.free):
        return
    before = view.order(view.free[:3], bonus, 0)
    after = view.order(view.free[:3], bonus, 5)
    assert after.value(bonus) >= before.value(bonus) - 0.02 * (1.0 + abs(before.value(bonus)))
    assert len(set(after.stops.tolist())) == len(after.stops)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=10, deadline=None)
def test_an_order_made_again_is_worth_no_less_and_visits_nothing_twice(seed):
    view = search(problem(20, seed, budget=2.0), 0, (2.0,))
    if not len(view.free):
        return
    before = view.best(1.0, ())
    after = view.remade(before, 1.0)
    assert after.value(1.0) >= before.value(1.0)
    assert len(set(after.stops.tolist())) == len(after.stops)


def test_success_costs_reward():
    given_ = problem(30, 1, budget=2.0)
    bold, careful = (search(given_, 0, (2.0,)).best(bonus, ()) for bonus in (0.0, 50.0))
    assert careful.success > bold.success
    assert careful.worth < bold.worth


def test_of_two_limits_the_one_that_binds_decides_whichever_comes_first():
    d = euclidean(20, 4)
    wide, tight = Limit(budget=2.5), Limit(budget=3.0, service=np.full(20, 0.25))
    rewards = np.random.default_rng(4).random(20)
    found = []
    for limits in ((wide, tight), (tight, wide)):
        given_ = Problem(distances=d, rewards=rewards, start=0, end=19, limits=limits)
        found.append(search(given_, 0, tuple(x.budget for x in limits)).best(3.0, ()))
    alone = Problem(distances=d, rewards=rewards, start=0, end=19, limits=(wide,))
    loose = search(alone, 0, (2.5,)).best(3.0, ())
    assert found[0].worth == pytest.approx(found[1].worth, rel=0.1)
    assert found[0].worth < loose.worth


def test_legs_after_the_end_leave_less_for_the_stops():
    given_ = problem(25, 2, budget=2.5)
    followed = Problem(
        distances=given_.distances, rewards=given_.rewards, start=0, end=24, limits=given_.limits, legs_after=(0.5,)
    )
    assert search(followed, 0, (2.5,)).best(3.0, ()).worth < search(given_, 0, (2.5,)).best(3.0, ()).worth
