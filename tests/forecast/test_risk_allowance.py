"""One chance of running short for a whole mission."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.forecast.risk_allowance import RiskAllowance

chances = st.floats(0.0, 1.0)
accepted = st.floats(0.01, 0.5)


@given(st.lists(st.tuples(accepted, chances), min_size=1, max_size=3), st.lists(st.integers(1, 5), max_size=6))
def test_what_must_be_done_and_all_that_is_added_stay_within_what_is_accepted(limits, runs):
    bound, mandatory = (np.array(x) for x in zip(*limits, strict=True))
    allowance = RiskAllowance.at_start(bound.tolist(), mandatory)
    added = 0.0
    for left in runs:
        share = allowance.share(left)
        assert share >= 0.0
        added += share
        allowance = allowance.reduced_by(share)
    if allowance.mandatory_fits:
        assert (mandatory + added <= bound * (1 + 1e-6)).all()
    else:
        assert (added <= 0.1 * bound + 1e-12).all()


@given(accepted, chances)
def test_work_lasts_where_its_chance_is_accepted(bound, chance):
    assert RiskAllowance.at_start([bound], np.array([chance])).mandatory_fits == (chance <= bound * (1 + 1e-9))


def test_the_last_of_several_runs_may_have_all_that_the_others_left():
    allowance = RiskAllowance.at_start([0.1], np.array([0.02]))
    assert np.isclose(allowance.share(2), 0.04)
    assert np.isclose(allowance.reduced_by(0.01).share(1), 0.07)
    assert allowance.reduced_by(-0.5) == allowance
