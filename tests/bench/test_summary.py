"""Failures are compared with what is accepted as chance would have it, and what must never happen is never averaged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom

from fieldhand_bench.fly import Forecast, Trial
from fieldhand_bench.referee import Judgement, LimitUse
from fieldhand_bench.summary import most_failures, summarize, worth_looking_at

KEPT = Judgement(
    status="completed",
    uses=(LimitUse(kind="distance_m", used=90.0, limit=100.0), LimitUse(kind="reserve", used=10.0, limit=80.0)),
    done=2,
    given_up=(),
    silent=(),
    faulted="",
    visits=8,
    left_out=3,
    caution=0.2,
    reward=8.0,
    doubled=(),
    misplaced="",
    odd=(),
)
OVER = replace(KEPT, uses=(LimitUse(kind="distance_m", used=101.0, limit=100.0), KEPT.uses[1]))


def trial(seed: int, ruling: Judgement = KEPT, **fields: object) -> Trial:
    made = Trial(
        seed=seed, family="optional", limited="distance", factor=1.0, failure_probability=0.1, trees=20, alpha=0.5,
        then="stay", refused=(), promise="within", ruling=ruling, forecast=Forecast(visits=9, reward=9.0),
        certain=Forecast(visits=10, reward=10.0), first_s=0.2, choices_s=(0.01, 0.02), admissions_s=(),
    )  # fmt: skip
    return replace(made, **fields)  # type: ignore[arg-type]


@given(st.integers(1, 200), st.sampled_from([0.05, 0.1, 0.2]))
def test_with_one_probability_the_bound_is_that_of_the_binomial_distribution(count: int, probability: float) -> None:
    assert most_failures([probability] * count) == binom.ppf(0.975, count, probability)


@given(st.lists(st.sampled_from([0.05, 0.1, 0.2]), min_size=1, max_size=60))
def test_the_bound_lies_above_what_is_expected_and_within_three_deviations(accepted: list[float]) -> None:
    p = np.array(accepted)
    assert p.sum() - 1 < most_failures(accepted) <= p.sum() + 3 * np.sqrt((p * (1 - p)).sum()) + 1


def test_failures_within_the_bound_pass_and_one_more_does_not() -> None:
    most = most_failures([0.1] * 50)
    for failures, passes in ((most, True), (most + 1, False)):
        trials = [trial(k, OVER if k < failures else KEPT) for k in range(50)]
        found = summarize(trials)
        assert found.passed is passes
        assert found.promises[0].failures == failures
        low, high = found.promises[0].interval
        assert low < failures / 50 < high


@pytest.mark.parametrize(
    "wrong",
    [{"silent": ("n1 at 7",)}, {"doubled": ("n1: 7",)}, {"misplaced": "it did not come to the end"}, {"odd": ("x",)}],
)
def test_what_must_never_happen_fails_with_a_single_mission(wrong: dict[str, object]) -> None:
    trials = [trial(k) for k in range(40)]
    assert summarize(trials).passed
    trials[7] = trial(7, replace(KEPT, **wrong))  # type: ignore[arg-type]
    found = summarize(trials)
    assert not found.passed
    assert worth_looking_at(trials, 1)[0][0].seed == 7
    assert any(told.startswith("7: ") for told in (*found.silent, *found.wrong))


def test_a_mission_that_no_guard_could_save_is_counted_apart() -> None:
    trials = [trial(k) for k in range(10)] + [trial(k, OVER, promise="hopeless") for k in range(10, 20)]
    found = summarize(trials)
    assert found.passed
    everything, possible, within, warned, bound, hopeless = found.promises
    assert [g.missions for g in (everything, possible, within, warned, bound, hopeless)] == [20, 10, 10, 0, 10, 10]
    assert (everything.failures, possible.failures, hopeless.failures) == (10, 0, 10)


def test_visits_and_reward_are_held_against_the_forecast_and_the_best_route() -> None:
    found = summarize([trial(k) for k in range(4)]).promises[0]
    assert (found.visits, found.beyond_forecast, found.reward_share) == (8.0, -1.0, pytest.approx(0.8))


def test_missions_worth_a_look_are_named_once_the_worst_first() -> None:
    unused = replace(KEPT, uses=(LimitUse(kind="distance_m", used=20.0, limit=100.0), KEPT.uses[1]))
    gave_up = replace(KEPT, given_up=("n2 at 4 (too little left)",))
    timid = replace(KEPT, caution=0.01)
    trials = [
        trial(0), trial(1, unused), trial(2, gave_up), trial(3, choices_s=(4.0,)), trial(4, OVER), trial(5, timid)
    ]  # fmt: skip
    looked = worth_looking_at(trials, 10)
    assert [t.seed for t, _ in looked] == [2, 4, 1, 5, 3]
    assert [t.seed for t, _ in worth_looking_at(trials, 2)] == [2, 4]
