"""A drive that costs far more than its length is broken off for the charger while that is still safe."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.forecast.recharge_rules import STOP_CHANCE
from fieldhand.forecast.turning_back import MOST_TURNS, UNEXPECTED, TurningRule
from support.missions.rechargeable import rechargeable

ALPHAS = st.floats(0.2, 0.9).map(lambda alpha: round(alpha, 2))
METRES = st.floats(1.0, 400.0)


def rule_of(alpha: float) -> TurningRule:
    return TurningRule(rechargeable(alpha=alpha))


@given(ALPHAS, METRES, st.floats(0.0, 3000.0))
def test_the_chance_of_being_stopped_on_one_leg_is_exact(alpha: float, leg_m: float, left_m: float) -> None:
    exact = float(np.exp(-max(0.0, left_m / leg_m - alpha) / (1.0 - alpha)))
    assert float(rule_of(alpha).stop_chance(left_m, leg_m)) == pytest.approx(exact, rel=1e-6, abs=1e-12)


@given(ALPHAS, st.floats(0.0, 1500.0), METRES, st.floats(0.01, 1.0), METRES, METRES, st.integers(0, MOST_TURNS))
def test_a_drive_as_costly_as_usual_goes_on(
    alpha: float, left_m: float, leg_m: float, part: float, after_m: float, begin_m: float, before: int
) -> None:
    rule, done_m = rule_of(alpha), part * leg_m
    pace = float(rule.usual_pace(before)) if before < MOST_TURNS else 50.0
    on_m, driven_m = leg_m - done_m, max(1.0, 0.999 * pace) * done_m
    assert not rule.turns(left_m, driven_m, done_m, on_m, after_m, min(done_m + begin_m, on_m + after_m), before)


@given(ALPHAS, st.floats(0.0, 1500.0), METRES, st.floats(0.01, 1.0), st.floats(1.0, 10.0), METRES, METRES)
def test_it_turns_only_where_going_on_is_risky_and_turning_is_much_safer(
    alpha: float, left_m: float, leg_m: float, part: float, pace: float, after_m: float, begin_m: float
) -> None:
    rule, done_m = rule_of(alpha), part * leg_m
    on_m, driven_m = leg_m - done_m, pace * done_m
    back_m = min(done_m + begin_m, on_m + after_m)
    if not rule.turns(left_m, driven_m, done_m, on_m, after_m, back_m):
        return
    on = float(rule.stop_chance(left_m - float(rule.pace(driven_m, done_m)) * on_m, after_m))
    assert on > STOP_CHANCE
    assert float(rule.stop_chance(left_m, back_m)) < 0.5 * on


@given(ALPHAS, st.floats(50.0, 1500.0), METRES, st.floats(0.1, 12.0), st.floats(0.0, 400.0), METRES)
def test_sampled_missions_turn_where_the_robot_does(
    alpha: float, left_m: float, leg_m: float, cost: float, begin_m: float, after_m: float
) -> None:
    rule, leg, begin = rule_of(alpha), np.array([leg_m]), np.array([begin_m])
    (done_m,) = rule.turns_at(np.array([left_m]), leg, np.array([cost]), begin, after_m, 0).tolist()

    def turns(done: float) -> bool:
        on_m = leg_m - done
        back_m = min(done + begin_m, on_m + after_m)
        return bool(rule.turns(left_m - cost * done, cost * done, done, on_m, after_m, back_m))

    steps = leg_m * np.linspace(0.0, 1.0, 21)[1:-1]
    assert ([float(d) for d in steps if turns(d)] or [np.inf])[0] == pytest.approx(done_m)


def test_a_costly_leg_to_a_far_place_is_broken_off_early_and_only_a_few_times() -> None:
    rule = rule_of(0.5)
    left, leg, after = np.full(4000, 700.0), np.full(4000, 120.0), 120.0
    costs = 0.5 + np.random.default_rng(1).exponential(0.5, 4000)
    done_m = rule.turns_at(left, leg, costs, np.zeros(4000), after, 0)
    turned = np.isfinite(done_m)
    assert 0.0 < turned.mean() <= UNEXPECTED
    assert np.median(done_m[turned]) < 60.0
    # With those that turn, the chance of being stopped on the way back falls to less than half.
    before = rule.stop_chance(left - costs * leg, after).mean()
    after_turning = np.where(turned, 0.0, rule.stop_chance(left - costs * leg, after)).mean()
    assert after_turning < 0.5 * before
    assert np.isinf(rule.turns_at(left, leg, costs, np.zeros(4000), after, MOST_TURNS)).all()


def test_legs_that_cost_what_they_are_long_are_never_broken_off() -> None:
    assert not rule_of(1.0).turns(500.0, 60.0, 60.0, 60.0, 120.0, 60.0)
