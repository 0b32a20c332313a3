"""Compilation: kept on disk where that can be, done without where it cannot; the same answers from plain Python."""

import numba
import numpy as np

from fieldhand.orienteering.costs import Gamma
from fieldhand.orienteering.kernels import anneal, insertion, legs, order_value
from fieldhand.orienteering.kernels.compiled import compiled
from fieldhand.orienteering.kernels.legs import sort_by, uniform
from fieldhand.orienteering.policy import Policy, State, StoppingCriterion, compile_ahead, solve
from fieldhand.orienteering.problem import Limit, Problem


def twice(x):
    return 2.0 * x


def test_where_no_folder_can_be_written_it_is_compiled_for_this_process(monkeypatch):
    real, asked = numba.njit, []

    def njit(*function, **options):
        if "error_model" not in options:
            # numba itself, which compiles parts of its own when they are first needed.
            return real(*function, **options)
        asked.append(options.get("cache", False))
        if options.get("cache"):
            raise RuntimeError("cannot cache function: no locator available")
        return real(**options)

    monkeypatch.setattr(numba, "njit", njit)
    assert compiled(twice)(3.0) == 6.0
    assert asked == [True, False]


def test_random_numbers_are_those_of_splitmix64():
    # The first output for state 0 is published: 16294208416658607535.
    state = np.array([0], dtype=np.uint64)
    assert uniform(state) == (16294208416658607535 >> 11) / 2**53
    drawn = np.array([uniform(state) for _ in range(2000)])
    assert abs(drawn.mean() - 0.5) < 0.03
    assert (drawn >= 0.0).all()
    assert (drawn < 1.0).all()


def test_sorting_is_that_of_numpy():
    rng = np.random.default_rng(0)
    for count in (0, 1, 2, 7, 100):
        key, values = rng.random(count + 3), np.arange(count + 3)
        expected = np.argsort(key[:count])
        sort_by(key, values, count)
        assert values[:count].tolist() == expected.tolist()
        assert (np.diff(key[:count]) >= 0).all()


def entered():
    """Return how often each loop that Python calls has been compiled or loaded in this process."""
    loops = [loop for module in (anneal, insertion, legs, order_value) for loop in vars(module).values()]
    return {loop.__name__: len(loop.signatures) for loop in loops if hasattr(loop, "signatures")}


def test_what_is_compiled_ahead_serves_every_kind_of_problem():
    compile_ahead()
    before = entered()
    x = np.linspace(0.0, 1.0, 12)
    limits = (Limit(budget=4.0), Limit(budget=5.0, service=np.full(12, 0.1)))
    kinds = (
        {"distances": np.abs(x[:, None] - x)},
        {"coordinates": np.stack([x, x], axis=1), "legs_after": (0.1,), "max_visits": 3},
    )
    for kind, costs in zip(kinds, (Gamma(0.5), None), strict=True):
        problem = Problem(rewards=np.ones(12), start=0, end=11, limits=limits, costs=costs, **kind)
        solve(problem, 0, StoppingCriterion(rounds=10))
        policy = Policy(problem, 0)
        policy.next(State(vertex=0, left=(4.0, 5.0)), seconds=0.02)
        policy.chances()
    assert entered() == before
