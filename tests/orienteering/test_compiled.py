"""Compilation: kept on disk where that can be, done without where it cannot; the same answers from plain Python."""

import numba
import numpy as np

from fieldhand.orienteering.kernels.compiled import compiled
from fieldhand.orienteering.kernels.legs import sort_by, uniform
from fieldhand.orienteering.policy import compile_ahead


def twice(x):
    return 2.0 * x


def test_where_no_folder_can_be_written_it_is_compiled_for_this_process(monkeypatch):
    real, asked = numba.njit, []

    def njit(**options):
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


def test_everything_can_be_compiled_ahead():
    compile_ahead()
