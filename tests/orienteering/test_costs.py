"""Cost models against their own samples, and the tail of sums of legs against sampling."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import Deterministic, Empirical, Gamma, Lognormal, ShiftedExponential, slices
from fieldhand.orienteering.kernels.legs import cost_quantile
from fieldhand.orienteering.overrun import overrun_probability, quantile_table

MEASURED = tuple(np.random.default_rng(1).weibull(1.5, 200))
#: Largest error of the chance of exceeding, for chances up to 10 % and up to 50 %; docs/orienteering.md has the same.
MODELS = [
    (ShiftedExponential(0.5), 0.005, 0.012),
    (ShiftedExponential(0.0), 0.005, 0.012),
    (Gamma(0.5), 0.005, 0.012),
    (Gamma(1.0), 0.005, 0.012),
    (Lognormal(0.3), 0.005, 0.012),
    (Lognormal(0.5), 0.008, 0.025),
    (Lognormal(1.0), 0.012, 0.12),
]
EVERY = [*(model for model, _, _ in MODELS), Deterministic(), Empirical(MEASURED)]


@pytest.mark.parametrize("model", EVERY, ids=repr)
def test_factors_have_mean_one_and_the_cumulants_that_the_model_says(model):
    drawn = model.draw(np.random.default_rng(0), 400_000)
    second, third = model.cumulants()
    assert drawn.mean() == pytest.approx(1.0, abs=0.01)
    assert drawn.var() == pytest.approx(second, rel=0.05, abs=1e-9)
    assert ((drawn - drawn.mean()) ** 3).mean() == pytest.approx(third, rel=0.35, abs=1e-3)


@pytest.mark.parametrize("model", EVERY, ids=repr)
def test_quantiles_are_those_of_the_drawn_factors(model):
    drawn = np.sort(model.draw(np.random.default_rng(0), 100_000))
    for p in (0.1, 0.5, 0.9, 0.99):
        assert float(model.quantile(np.array([p]))[0]) == pytest.approx(drawn[int(p * 100_000)], rel=0.05)


@pytest.mark.parametrize("model", EVERY, ids=repr)
def test_slices_keep_the_mean(model):
    points, weights = slices(model)
    mean = points.sum() if not len(weights) else float(points @ weights)
    assert mean == pytest.approx(1.0, abs=0.01)
    assert not len(weights) or weights.sum() == pytest.approx(1.0)


@pytest.mark.parametrize(("model", "tail", "body"), MODELS, ids=lambda x: repr(x))
@pytest.mark.parametrize("count", [1, 2, 5, 20])
def test_the_chance_of_exceeding_is_as_near_to_sampling_as_the_documentation_says(model, tail, body, count):
    rng = np.random.default_rng(count)
    legs = rng.uniform(0.1, 20.0, count)
    costs = np.zeros(100_000)
    for leg in legs:
        costs += leg * model.draw(rng, len(costs))
    costs.sort()
    second, third = model.cumulants()
    for wanted in (0.5, 0.3, 0.1, 0.05, 0.02):
        left = costs[int((1 - wanted) * len(costs))]
        found = float(overrun_probability(legs.sum(), second * (legs**2).sum(), third * (legs**3).sum(), left))
        noise = 3.0 * np.sqrt(wanted * (1 - wanted) / len(costs))
        assert abs(found - wanted) <= (tail if wanted <= 0.1 else body) + noise


@given(
    mean=st.floats(0.1, 100.0),
    deviation=st.floats(0.01, 30.0),
    skewness=st.floats(-1.5, 1.5),
    chance=st.floats(0.01, 0.9),
)
@settings(max_examples=60, deadline=None)
def test_the_table_of_quantiles_is_the_inverse_of_the_chance(mean, deviation, skewness, chance):
    # ``cost_quantile`` takes legs' sums; these are those of one leg with such cumulants.
    cumulants = np.array([deviation**2, skewness * deviation**3])
    at = cost_quantile(1.0, 1.0, 1.0, cumulants, quantile_table(chance)) - 1.0 + mean
    found = float(overrun_probability(mean, deviation**2, skewness * deviation**3, at))
    # Between its entries the table is linear. Below 0 no cost is.
    assert at < 0.0 or found == pytest.approx(chance, abs=0.02)


def test_the_chance_falls_with_what_is_left_for_any_skewness():
    left = np.linspace(0.0, 12.0, 200)
    for third in (-20.0, -1.0, -1e-6, 0.0, 1e-6, 1.0, 20.0):
        chances = overrun_probability(5.0, 4.0, third, left)
        assert (np.diff(chances) <= 1e-9).all()
        assert ((chances >= 0.0) & (chances <= 1.0)).all()


def test_certain_costs_exceed_what_is_left_or_do_not():
    assert overrun_probability([3.0, 3.0, np.inf], 0.0, 0.0, [3.0, 2.9, 9.0]).tolist() == [0.0, 1.0, 1.0]


@pytest.mark.parametrize(
    "make",
    [
        lambda: ShiftedExponential(-0.1),
        lambda: ShiftedExponential(float("nan")),
        lambda: Gamma(0.0),
        lambda: Gamma(float("nan")),
        lambda: Lognormal(-1.0),
        lambda: Lognormal(9.0),
        lambda: Empirical([1.0]),
        lambda: Empirical([1.0, float("nan")]),
        lambda: Empirical([1.0, -0.5]),
        lambda: Empirical([0.0, 0.0]),
    ],
)
def test_what_is_no_cost_model_is_refused(make):
    with pytest.raises(ProblemError):
        make()
