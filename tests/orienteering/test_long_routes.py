"""Orders of many stops with a long last leg: what a policy collects and risks, and what its preview says of that."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fieldhand.orienteering.policy import Policy, State
from fieldhand.orienteering.preview import preview
from fieldhand.orienteering.problem import Limit, Problem
from fieldhand.orienteering.simulated_mission import simulate_mission

BUDGET = 300.0
DRAWS = 2000
#: Metres to the block, how far its rows bend, and the accepted chance.
BLOCKS = [(60.0, 0.0, 0.1), (60.0, 0.1, 0.05), (75.0, 0.1, 0.2)]


def block(away: float, bend: float, accepted: float) -> Problem:
    """Return two rows of 120 stops a metre apart, so far from where the mission begins and ends."""
    along = np.tile(np.arange(120.0), 2)
    across = away + np.repeat([0.0, 2.0], 120) + bend * 120 * (1 - (along / 60 - 1) ** 2)
    xy = np.vstack([[0.0, 0.0], np.column_stack([across, along]), [0.0, 0.0]])
    return Problem(
        distances=np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1)),
        rewards=np.concatenate([[0.0], np.ones(240), [0.0]]),
        start=0,
        end=241,
        limits=(Limit(budget=BUDGET, failure_probability=accepted),),
    )


@cache
def driven(away: float, bend: float, accepted: float):
    problem = block(away, bend, accepted)
    return [
        simulate_mission(problem, Policy(problem, 0, risk_tolerance=0.0).next, np.random.default_rng(seed))
        for seed in range(4)
    ]


@cache
def foreseen(away: float, bend: float, accepted: float):
    policy = Policy(block(away, bend, accepted), 0, risk_tolerance=0.0)
    return preview(policy, State(vertex=0, left=(BUDGET,)), np.random.default_rng(1), np.zeros(DRAWS))


def chance_foreseen(case) -> float:
    found = foreseen(*case)
    return float((found.legs + found.last > BUDGET).mean())


def margin(accepted: float) -> float:
    """Return three standard errors of a chance that is counted in the preview's missions."""
    return 3 * float(np.sqrt(accepted * (1 - accepted) / DRAWS))


@pytest.mark.parametrize("case", BLOCKS)
def test_the_last_leg_is_begun_with_no_more_risk_than_is_accepted(case):
    chances = [mission.chance for mission in driven(*case)]
    assert np.mean(chances) <= case[2] * 1.05
    # No reward is thrown away either: where the way home is the whole risk, most of what is accepted is used.
    assert np.mean(chances) >= case[2] * 0.6


@pytest.mark.parametrize("case", BLOCKS)
def test_the_preview_gives_the_chance_with_which_missions_end(case):
    chances = [mission.chance for mission in driven(*case)]
    assert chance_foreseen(case) == pytest.approx(np.mean(chances), abs=margin(case[2]) + 0.1 * case[2])
    assert chance_foreseen(case) <= case[2] + margin(case[2])


@pytest.mark.parametrize("case", BLOCKS)
def test_missions_with_luck_and_without_are_planned_for_what_they_have_left(case):
    visits = np.array([len(mission.path) - 2 for mission in driven(*case)])
    found = foreseen(*case)
    assert found.visits.mean() == pytest.approx(visits.mean(), abs=3 * found.visits.std() / np.sqrt(len(visits)) + 3)
    # The first leg alone makes a difference of dozens of stops.
    assert found.visits.std() > 15


def test_each_mission_of_a_preview_names_its_stops_in_the_order_of_its_group():
    found = foreseen(*BLOCKS[0])
    for mission in range(0, DRAWS, 97):
        stops = found.stops(mission)
        assert len(stops) == len(set(stops)) == found.visits[mission]
        assert set(stops) == set(found.vertices[found.visited[mission]].tolist())


def test_what_was_given_up_was_not_collected():
    problem = block(*BLOCKS[0])
    gone = frozenset(range(100, 240))
    none = problem.rewards.copy()
    none[list(gone)] = 0.0
    without = Problem(
        distances=problem.distances, rewards=none, start=problem.start, end=problem.end, limits=problem.limits
    )
    state = State(vertex=90, left=(120.0,), visited=frozenset(range(60, 90)))
    one, other = Policy(problem, 0, risk_tolerance=0.0, price=0.0), Policy(without, 0, risk_tolerance=0.0, price=0.0)
    chosen = one.next(State(vertex=90, left=(120.0,), visited=state.visited, given_up=gone))
    assert chosen == other.next(state)
    assert one.expectation == other.expectation
    assert not set(one.expectation.vertices) & gone


def test_a_mission_sets_out_where_one_visit_is_safe_enough_although_the_way_takes_most_of_the_chance():
    # 240 m of 410 m are two long legs: there and back alone exceeds the limit in 6 %, and 10 % are accepted.
    problem = block(120.0, 0.0, 0.1)
    problem = replace(problem, limits=(replace(problem.limits[0], budget=410.0),))
    missions = [
        simulate_mission(problem, Policy(problem, 0, risk_tolerance=0.0).next, np.random.default_rng(seed))
        for seed in range(8)
    ]
    assert all(len(mission.path) > 2 for mission in missions)
    found = preview(
        Policy(problem, 0, risk_tolerance=0.0),
        State(vertex=0, left=(410.0,)),
        np.random.default_rng(1),
        np.zeros(DRAWS),
    )
    assert found.visited[:, 0].all()
    assert (found.legs + found.last > 410.0).mean() <= 0.15


def rows_with_headlands(away: float, budget: float) -> Problem:
    """Return six rows of 120 stops, 1.8 m apart, that are left at their ends alone."""
    row, along = np.repeat(np.arange(6), 120), 1.8 * np.tile(np.arange(120.0), 6)
    row = np.concatenate([[-1], row, [-1]])
    x = np.concatenate([[-away], 3.0 * row[1:-1], [-away]])
    y = np.concatenate([[0.0], along, [0.0]])
    ends = np.minimum(y[:, None] + y, 2 * 1.8 * 119 - y[:, None] - y)
    distances = np.where(row[:, None] == row, np.abs(y[:, None] - y), np.abs(x[:, None] - x) + ends)
    distances[0, -1] = distances[-1, 0] = 0.0
    return Problem(
        distances=distances,
        rewards=np.concatenate([[0.0], np.ones(720), [0.0]]),
        start=0,
        end=721,
        limits=(Limit(budget=budget),),
    )


@pytest.mark.parametrize("left", [360.0, 420.0])
def test_a_price_is_found_for_the_safe_route_where_the_order_worth_most_cannot_be_safe(left):
    # Along the row and home takes many short legs; straight home is one long leg, which is less certain.
    policy = Policy(rows_with_headlands(140.0, 800.0), 0, risk_tolerance=0.0, warm=range(21, 121))
    policy.next(State(vertex=20, left=(left,), visited=frozenset(range(1, 21))))
    assert policy.price is not None
    assert 1.0 - policy.expectation.success <= 0.1 * 1.05
