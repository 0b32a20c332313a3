"""Tail probabilities against sampling."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.orienteering.tail import chance_over, leg_costs

legs_lists = st.lists(st.floats(0.1, 20.0), min_size=1, max_size=25)


def figures(legs):
    d = np.array(legs)
    return d.sum(), (d**2).sum()


@given(legs=legs_lists, alpha=st.sampled_from([0.0, 0.3, 0.5, 0.9]), quantile=st.floats(0.5, 0.99))
@settings(max_examples=30, deadline=None)
def test_the_chance_is_within_three_percent_points_of_what_sampling_gives(legs, alpha, quantile):
    costs = np.random.default_rng(7).exponential(1 - alpha, size=(40_000, len(legs))) @ np.array(legs)
    costs += alpha * sum(legs)
    left = float(np.quantile(costs, quantile))
    total, squares = figures(legs)
    assert float(chance_over(total, squares, left, alpha)) == pytest.approx(1 - quantile, abs=0.03)


@given(leg=st.floats(0.1, 100.0), alpha=st.floats(0.0, 0.95), more=st.floats(0.0, 5.0))
@settings(max_examples=50, deadline=None)
def test_a_single_leg_has_the_exponential_tail(leg, alpha, more):
    left = leg * (alpha + more * (1 - alpha))
    assert float(chance_over(leg, leg**2, left, alpha)) == pytest.approx(np.exp(-more), rel=1e-6)


@given(legs=legs_lists, alpha=st.floats(0.0, 1.0))
@settings(max_examples=50, deadline=None)
def test_the_chance_falls_as_more_is_left_and_is_one_below_the_certain_part(legs, alpha):
    total, squares = figures(legs)
    left = np.linspace(-1.0, 3.0, 50) * total
    chances = chance_over(total, squares, left, alpha)
    assert (np.diff(chances) <= 1e-12).all()
    assert (chances[left < alpha * total * 0.999 - 1e-6] == 1.0).all()
    assert ((chances >= 0.0) & (chances <= 1.0)).all()


def test_certain_legs_exceed_what_is_left_or_do_not():
    assert chance_over([10.0, 10.0, 0.0], [100.0, 100.0, 0.0], [10.0, 9.99, 0.0], 1.0).tolist() == [0.0, 1.0, 0.0]


def test_no_way_is_certain_to_cost_too_much():
    assert float(chance_over(np.inf, np.inf, 100.0, 0.5)) == 1.0


@given(leg=st.floats(0.1, 100.0), alpha=st.floats(0.0, 1.0))
@settings(max_examples=30, deadline=None)
def test_slices_of_a_leg_have_its_mean(leg, alpha):
    costs = leg_costs(leg, alpha, 2000)
    assert costs.mean() == pytest.approx(leg, rel=0.01)
    assert (np.diff(costs) >= 0).all()
