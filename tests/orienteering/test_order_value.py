"""The expectation over one leg: exact for functions that are linear between the points of the grid."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.orienteering.kernels.order_value import drive, gather
from support.arrays import assert_near

SIZE, STEP = 17, 0.25
NONE = np.zeros(0)
legs = st.floats(0.0, 5.0)
certain = st.floats(0.0, 1.0)
works = st.sampled_from([0.0, 0.1, 0.25, 1.0])


def over_a_leg(function, leg, alpha, work):
    after, unused = np.empty(SIZE), np.empty(SIZE)
    drive(function, function, after, unused, leg, work, STEP, np.array([alpha, 1.0 - alpha]), NONE)
    return after


@given(leg=legs, alpha=certain, work=works, seed=st.integers(0, 100))
@settings(max_examples=25, deadline=None)
def test_a_leg_is_integrated_exactly(leg, alpha, work, seed):
    function = np.random.default_rng(seed).random(SIZE)
    grid = STEP * np.arange(SIZE)
    chances = (np.arange(20_000) + 0.5) / 20_000
    costs = work + leg * (alpha - (1.0 - alpha) * np.log1p(-chances))
    expected = [np.interp(left - costs, grid, function, left=0.0).mean() for left in grid]
    found = over_a_leg(function, leg, alpha, work)
    # Where exactly the least cost is left, the function jumps to 0, and rounding says on which side that is.
    clear = np.abs(grid - (work + leg * alpha)) > 1e-9
    # The sum over costs is off by what one of them weighs at the jump.
    assert_near(found[clear], np.array(expected)[clear], within=1e-3)


@given(leg=legs, alpha=certain, work=works, seed=st.integers(0, 100))
@settings(max_examples=25, deadline=None)
def test_going_forward_is_the_transpose_of_going_backward(leg, alpha, work, seed):
    rng = np.random.default_rng(seed)
    function, mass, into = rng.random(SIZE), rng.random(SIZE), np.zeros(SIZE)
    choice = rng.integers(0, 2, SIZE)
    points = np.array([alpha, 1.0 - alpha])
    gather(mass, choice, 1, into, leg, work, STEP, points, NONE, np.empty(SIZE))
    assert_near(
        into @ function, (mass * (choice == 1)) @ over_a_leg(function, leg, alpha, work), rel=1e-6, within=1e-12
    )
