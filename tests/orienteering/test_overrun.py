"""The chance that legs cost more than is left: what must hold of any of them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.orienteering.costs import ShiftedExponential
from fieldhand.orienteering.overrun import overrun_probability, quantile_table, standardised_quantile

legs_lists = st.lists(st.floats(0.1, 20.0), min_size=1, max_size=25)


def sums(legs, alpha):
    d, (second, third) = np.array(legs), ShiftedExponential(alpha).cumulants()
    return d.sum(), second * (d**2).sum(), third * (d**3).sum()


@given(legs=legs_lists, alpha=st.sampled_from([0.0, 0.3, 0.5, 0.9]), quantile=st.floats(0.5, 0.99))
@settings(max_examples=30, deadline=None)
def test_the_chance_is_within_two_percent_points_of_what_sampling_gives(legs, alpha, quantile):
    costs = np.random.default_rng(7).exponential(1 - alpha, size=(40_000, len(legs))) @ np.array(legs)
    costs += alpha * sum(legs)
    left = float(np.quantile(costs, quantile))
    assert float(overrun_probability(*sums(legs, alpha), left)) == pytest.approx(1 - quantile, abs=0.02)


@given(leg=st.floats(0.1, 100.0), alpha=st.floats(0.0, 0.95), more=st.floats(0.0, 5.0))
@settings(max_examples=50, deadline=None)
def test_a_single_leg_has_the_exponential_tail(leg, alpha, more):
    left = leg * (alpha + more * (1 - alpha))
    assert float(overrun_probability(*sums([leg], alpha), left)) == pytest.approx(np.exp(-more), rel=1e-6)


@given(legs=legs_lists, alpha=st.floats(0.0, 1.0))
@settings(max_examples=50, deadline=None)
def test_the_chance_falls_as_more_is_left_and_is_a_chance(legs, alpha):
    mean, variance, third = sums(legs, alpha)
    chances = overrun_probability(mean, variance, third, np.linspace(-1.0, 3.0, 50) * mean)
    assert (np.diff(chances) <= 1e-12).all()
    assert ((chances >= 0.0) & (chances <= 1.0)).all()
    assert chances[0] == 1.0


@given(legs=legs_lists, alpha=st.floats(0.0, 0.95), chance=st.floats(0.005, 0.6))
@settings(max_examples=50, deadline=None)
def test_what_is_exceeded_with_a_chance_is_the_inverse(legs, alpha, chance):
    mean, variance, third = sums(legs, alpha)
    left = mean + np.sqrt(variance) * standardised_quantile(quantile_table(chance), variance, third)
    if left > 0.0:
        assert float(overrun_probability(mean, variance, third, left)) == pytest.approx(chance, abs=2e-3)


def test_certain_legs_and_no_way_at_all():
    assert standardised_quantile(quantile_table(0.1), 0.0, 0.0) == 0.0
    assert overrun_probability([10.0, 10.0, 0.0], 0.0, 0.0, [10.0, 9.99, 0.0]).tolist() == [0.0, 1.0, 0.0]
