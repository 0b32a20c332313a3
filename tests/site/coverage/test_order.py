"""Test the order of swaths and the turns between them against independent computations."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.site.coverage.dubins import dubins_lengths, dubins_paths
from fieldhand.site.coverage.order import SwathOrder, shortest_swath_order


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 5), st.integers(0, 2**32 - 1), st.booleans())
def test_few_swaths_are_in_the_shortest_order(count: int, seed: int, started: bool) -> None:
    rng = np.random.default_rng(seed)
    ends = rng.uniform(0.0, 50.0, (2 * count, 2))
    metres = np.hypot(*(ends[:, None] - ends[None]).transpose(2, 0, 1))
    start = np.hypot(*ends.T) if started else None
    enters = shortest_swath_order(SwathOrder(metres, start), [[k] for k in range(count)], seed=0)
    assert sorted((enters // 2).tolist()) == list(range(count))

    def length(order: tuple[int, ...]) -> float:
        first = 0.0 if start is None else start[order[0]]
        return first + sum(metres[a ^ 1, b] for a, b in itertools.pairwise(order))

    best = min(
        length(tuple(2 * k + side for k, side in zip(order, sides, strict=True)))
        for order in itertools.permutations(range(count))
        for sides in itertools.product((0, 1), repeat=count)
    )
    assert length(tuple(enters.tolist())) <= 1.05 * best + 1e-6


def test_neighbouring_swaths_are_driven_one_beside_the_other() -> None:
    ends = np.array([(x, 10.0 * k) for k in range(12) for x in (0.0, 100.0)])
    metres = np.hypot(*(ends[:, None] - ends[None]).transpose(2, 0, 1))
    problem = SwathOrder(metres)
    enters = shortest_swath_order(problem, [list(range(12))], seed=0)
    assert problem.length(enters) == pytest.approx(110.0)


POSES = st.tuples(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0), st.floats(-3.1, 3.1)).map(np.array)


@settings(max_examples=100, deadline=None)
@given(POSES, POSES, st.floats(0.5, 5.0))
def test_a_turn_starts_and_ends_in_its_poses_with_its_radius(start, goal, radius: float) -> None:
    if np.hypot(*(goal - start)[:2]) < 0.1:
        return
    paths = dubins_paths(start, goal, radius)
    assert paths
    lengths = [float(np.hypot(*np.diff(path, axis=0).T).sum()) for path in paths]
    # Chords of up to 10 degrees are at most 0.2 % shorter than their arcs.
    assert min(lengths) == pytest.approx(float(dubins_lengths(start, goal, radius)), rel=2e-3, abs=1e-6)
    assert min(lengths) >= 0.998 * np.hypot(*(goal - start)[:2]) - 1e-6
    for path in paths:
        assert path[0] == pytest.approx(start[:2])
        assert path[-1] == pytest.approx(goal[:2])
        steps = np.diff(path, axis=0)
        # The part before the last point was computed from the start; that it meets the goal is the test.
        angles = np.arctan2(steps[:, 1], steps[:, 0])
        ahead = [angles[0] - start[2], goal[2] - angles[-1], *np.diff(angles)]
        assert np.abs((np.array(ahead) + np.pi) % (2.0 * np.pi) - np.pi).max() < np.radians(10.5)


def test_a_straight_turn_is_straight() -> None:
    one, two = np.array([0.0, 0.0, 0.5]), np.array([10.0 * np.cos(0.5), 10.0 * np.sin(0.5), 0.5])
    assert float(dubins_lengths(one, two, 3.0)) == pytest.approx(10.0)


def test_a_half_turn_between_swaths_as_far_apart_as_the_circle_is_wide_is_a_half_circle() -> None:
    one, two = np.array([0.0, 0.0, np.pi / 2.0]), np.array([6.0, 0.0, -np.pi / 2.0])
    assert float(dubins_lengths(one, two, 3.0)) == pytest.approx(3.0 * np.pi)
