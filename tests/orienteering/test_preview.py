"""What a policy will come to, before it is driven."""

import itertools

import numpy as np
import pytest

from fieldhand.orienteering.policy import Policy, State
from fieldhand.orienteering.preview import preview
from fieldhand.orienteering.problem import Limit, Problem
from fieldhand.orienteering.simulated_mission import simulate_mission

MISSIONS = 400


def scattered(n, budget, seed=0, alpha=0.5, service=0.0, after=()):
    xy = np.random.default_rng(seed).uniform(0.0, 1.0, (n, 2))
    return Problem(
        distances=np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1)),
        rewards=np.ones(n),
        start=0,
        end=n - 1,
        limits=(Limit(budget=budget, service=np.full(n, service)),),
        alpha=alpha,
        legs_after=after,
    )


def looked_ahead(problem, used=None):
    state = State(vertex=problem.start, left=tuple(limit.budget for limit in problem.limits))
    policy = Policy(problem, 0, risk_tolerance=0.0)
    return preview(policy, state, np.random.default_rng(1), np.zeros(MISSIONS) if used is None else used)


@pytest.mark.parametrize(("n", "budget", "service"), [(14, 1.6, 0.0), (30, 2.2, 0.0), (30, 3.0, 0.05)])
def test_missions_make_about_as_many_visits_as_was_said_and_use_as_much(n, budget, service):
    problem = scattered(n, budget, service=service)
    found = looked_ahead(problem)
    policy = Policy(problem, 0, risk_tolerance=0.0)
    policy.next(State(vertex=0, left=(budget,)))
    driven = [
        simulate_mission(problem, policy.again(k, policy.price).next, np.random.default_rng(k)) for k in range(60)
    ]
    visits = np.array([len(m.path) - 2 for m in driven])
    assert found.visits.mean() == pytest.approx(visits.mean(), abs=0.8 + 3 * visits.std() / np.sqrt(60))
    cost = found.legs + found.last + service * (found.visits + 1)
    used = budget - np.array([m.left[0] for m in driven])
    assert cost.mean() == pytest.approx(used.mean(), rel=0.1)
    assert (cost > budget).mean() <= 0.1 + 3 * np.sqrt(0.09 / MISSIONS)


def test_certain_legs_give_one_mission():
    problem = scattered(20, 2.0, alpha=1.0)
    found = looked_ahead(problem)
    assert np.ptp(found.legs) < 1e-9
    assert (found.legs + found.last <= 2.0 + 1e-9).all()
    assert (found.visited == found.visited[0]).all()


def test_a_long_order_is_driven_as_planned_and_its_last_stops_by_luck():
    problem = scattered(220, 9.0, seed=3)
    found = looked_ahead(problem)
    assert found.visited.shape == (MISSIONS, len(found.vertices))
    assert len(set(found.vertices.tolist())) == len(found.vertices) > 80
    assert found.visited[:, 0].all()
    assert 0.0 < found.visited[:, -1].mean() < 1.0
    assert (found.legs + found.last > 9.0).mean() <= 0.1 + 3 * np.sqrt(0.09 / MISSIONS)


def test_missions_that_have_used_more_visit_less():
    problem = scattered(30, 2.2)
    used = np.repeat([0.0, 0.8], MISSIONS // 2)
    visits = looked_ahead(problem, used).visits
    assert visits[used > 0].mean() < visits[used == 0].mean() - 1.0


def test_the_legs_are_those_between_the_vertices_that_were_visited():
    problem = scattered(12, 1.8, alpha=1.0, after=(0.1,))
    found = looked_ahead(problem)
    way = [0, *found.vertices[found.visited[0]].tolist()]
    legs = sum(problem.distances[a, b] for a, b in itertools.pairwise(way))
    assert found.legs[0] == pytest.approx(legs)
    assert found.last[0] == pytest.approx(problem.distances[way[-1], problem.end])
