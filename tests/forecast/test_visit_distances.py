"""Distances between optional visits, from drives and along the sparse graph."""

import numpy as np
import pytest

from fieldhand.forecast.mission_state import Spent, Visit
from fieldhand.forecast.orienteering_problem import policy_for, visits_problem
from fieldhand.forecast.remaining_work import RemainingWork
from fieldhand.forecast.resource_limits import resource_limits
from fieldhand.forecast.visit_distances import visit_distances
from fieldhand.forecast.visit_order import drives_for, start_place, with_stands
from fieldhand.orienteering.policy import State
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import parse_site
from fieldhand.task.frames import Budget, Constraints
from fieldhand.testing.small_orchard import orchard
from fieldhand_bench.site.orchard import benchmark_orchard
from support.arrays import assert_near

ROBOT = load_robot("husky")


@pytest.fixture(scope="module")
def planted():
    """A site with rows and a pond: its drives, where the mission begins, visits, and the way home."""
    site = parse_site(benchmark_orchard(260, 3), name="made")
    drives = drives_for(site, ROBOT)
    here = start_place(drives)
    places = [t.place for t in site.trees if not drives.problem(t.place)]
    visits = [Visit(place=p) for p in with_stands(drives, here, places)]
    (home,) = drives.stands((site.home("return_to_end", here),))
    return drives, here, visits, RemainingWork(stops=(home,))


def test_many_places_are_as_far_from_each_other_in_the_graph_as_in_the_table(planted):
    drives, here, visits, rest = planted
    table = visit_distances(here, visits, rest, drives).distances
    along = visit_distances(here, visits, rest, drives, table=10).table
    pairs = np.random.default_rng(0).integers(0, len(table), (400, 2))
    straight = np.array([table[i, j] for i, j in pairs])
    looked_up = np.array([along.distances[i, j] for i, j in pairs])
    assert (looked_up >= straight * (1 - 1e-6) - 1e-6).all()
    assert np.median(looked_up - straight) < 0.5
    assert (looked_up <= 1.1 * straight + 3.0).all()


def test_a_policy_over_the_graph_visits_about_as_much(planted):
    drives, here, visits, rest = planted
    resources = resource_limits(Constraints(budgets=(Budget(kind="distance_m", limit=400.0),)), ROBOT)
    found = []
    for table in (1000, 10):
        problem = visits_problem(
            legs=visit_distances(here, visits, rest, drives, table=table),
            rewards=[1.0] * len(visits),
            service=[v.work for v in visits],
            rest=rest,
            resources=resources,
            robot=ROBOT,
            spent=Spent(),
            accepted=0.1,
            max_visits=None,
        )
        policy = policy_for(problem)
        assert 1 <= policy.next(State(vertex=0, left=tuple(x.budget for x in problem.limits))) < problem.end
        found.append(policy.expectation.reward)
    assert found[1] == pytest.approx(found[0], rel=0.08)


def test_where_drives_are_straight_lines_coordinates_do():
    site = orchard(zones=[])
    drives = drives_for(site, ROBOT)
    here = start_place(drives)
    visits = [Visit(place=p) for p in with_stands(drives, here, [t.place for t in site.trees])]
    rest = RemainingWork(stops=(site.home("return_to_end", here),))
    legs = visit_distances(here, visits, rest, drives, table=3)
    lengths = visit_distances(here, visits, rest, drives).distances
    if legs.coordinates is not None:
        between = np.hypot(*(legs.coordinates[:, None] - legs.plane[None]).transpose(2, 0, 1))
        assert_near(between, lengths, within=1e-6)
    else:
        assert legs.table is not None


def test_an_open_end_and_visits_that_end_elsewhere_have_a_table(planted):
    drives, here, visits, rest = planted
    open_end = visit_distances(here, visits[:20], RemainingWork(), drives, table=3).distances
    assert open_end.shape == (22, 22)
    assert (open_end[-1] == 0.0).all()
    moved = [Visit(place=visits[0].place, leaves=visits[1].place), *visits[2:20]]
    lengths = visit_distances(here, moved, rest, drives, table=3).distances
    assert lengths[1, 2] == pytest.approx(drives.between(visits[1].place, visits[2].place).length_m)
    assert lengths[2, 1] == pytest.approx(drives.between(visits[2].place, visits[0].place).length_m)
