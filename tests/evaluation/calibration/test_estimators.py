"""What is fitted comes back, within the stated interval as often as stated, and more closely from more data."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.evaluation.calibration.estimators import apart, fit_legs, fit_mean, fit_ratio, fit_shares, plausible


def legs(alpha, scale, count, seed):
    rng = np.random.default_rng(seed)
    return scale * (alpha + (1 - alpha) * rng.standard_exponential(count))


@pytest.mark.parametrize(("alpha", "scale"), [(0.5, 1.0), (0.85, 1.1), (0.2, 0.9)])
def test_alpha_and_scale_lie_in_their_intervals_as_often_as_stated(alpha, scale):
    fits = [fit_legs(legs(alpha, scale, 30, seed), np.random.default_rng(seed)) for seed in range(120)]
    for name, true in (("alpha", alpha), ("scale", scale)):
        inside = sum(getattr(fit, name).contains(true) for fit in fits)
        # 95 % of 120 are 114; fewer than 107 come once in a thousand times.
        assert inside >= 107, name
        mean = np.mean([getattr(fit, name).value for fit in fits])
        assert mean == pytest.approx(true, abs=0.02)


@settings(max_examples=15)
@given(alpha=st.floats(0.05, 0.95), seed=st.integers(0, 10**6))
def test_more_legs_give_narrower_intervals(alpha, seed):
    few = fit_legs(legs(alpha, 1.0, 25, seed), np.random.default_rng(0))
    many = fit_legs(legs(alpha, 1.0, 2500, seed), np.random.default_rng(0))
    for name in ("alpha", "scale"):
        wide, narrow = getattr(few, name), getattr(many, name)
        assert narrow.high - narrow.low < wide.high - wide.low
        assert narrow.low <= narrow.value <= narrow.high


def test_legs_without_chance_have_alpha_one():
    fit = fit_legs(np.full(30, 1.25), np.random.default_rng(0))
    assert (fit.alpha.value, fit.scale.value) == (1.0, 1.25)


def test_legs_that_do_not_follow_the_model_are_told():
    rng = np.random.default_rng(1)
    assert fit_legs(rng.normal(1.0, 0.1, 300).clip(0.1), rng).likely < 0.01
    assert fit_legs(legs(0.5, 1.0, 300, 3), rng).likely > 0.01


def test_shares_lie_in_their_intervals_as_often_as_stated():
    true = np.array([100.0, 640.0, 60.0])
    inside = np.zeros(3)
    for seed in range(120):
        rng = np.random.default_rng(seed)
        metres, made = rng.uniform(0, 30, 150), rng.integers(0, 2, 150).astype(float)
        columns = np.column_stack([metres, made, metres / rng.uniform(0.4, 1.0, 150) + 8 * made])
        read = rng.normal(0.0, 40.0, 151)  # the charge is read with an error, which stands on both sides of each step
        found = fit_shares(columns, columns @ true + np.diff(read))
        inside += [f.contains(t) for f, t in zip(found, true, strict=True)]
    assert (inside >= 105).all(), inside


def test_causes_that_always_come_together_are_not_apart():
    rng = np.random.default_rng(0)
    metres, made = rng.uniform(1, 30, 50), rng.integers(0, 2, 50).astype(float)
    assert not apart(np.column_stack([metres, made, metres / 0.8 + 8 * made]))
    assert apart(np.column_stack([metres, made, metres / rng.uniform(0.4, 1.0, 50)]))
    assert not apart(np.column_stack([metres, np.zeros(50)]))


@settings(max_examples=30)
@given(rate=st.floats(0.1, 10), seed=st.integers(0, 10**6))
def test_a_rate_comes_back(rate, seed):
    rng = np.random.default_rng(seed)
    sizes = rng.uniform(1, 50, 200)
    found = fit_ratio(rate * sizes + rng.normal(0, 0.1, 200) * np.sqrt(sizes), sizes)
    assert found.value == pytest.approx(rate, abs=0.02)
    assert fit_mean(sizes).value == pytest.approx(sizes.mean())


def test_waits_are_told_from_work():
    assert plausible([8.0, 8.1, 7.9, 400.0]).tolist() == [True, True, True, False]
