"""Rounds along an edge: side by side with an implement that covers ground, on the same way otherwise."""

from __future__ import annotations

import itertools

import pytest
from shapely.geometry import LineString

import fieldhand as fh
from fieldhand.errors import PlaceError
from fieldhand.forecast.visit_order import drives_for
from fieldhand.forecast.working import stretches_of
from fieldhand.places.context import Context
from fieldhand.robot.loader import load_robot
from fieldhand.site.working.stretch import Stretch
from fieldhand.task.plan import walk
from support.sites.gardens import pasture

SITE, TRACTOR = pasture(), load_robot("tractor")
WIDTH_M = 1.2


def rounds(action: str, laps: int, zone: str = "cow paddock") -> tuple[Stretch, ...]:
    along = fh.selectors.InZone(zone=zone)
    node = fh.steps.WorkAlong(action=action, along=along, mode="perimeter", laps=laps)
    task = fh.build_task(node, SITE, TRACTOR, request="go around it")
    (planned,) = [step for step in walk(task.composition.plan) if isinstance(step, fh.steps.WorkAlong)]
    return stretches_of(planned, task, SITE, TRACTOR, drives_for(SITE, TRACTOR), Context(here=SITE.start))


@pytest.mark.parametrize("laps", [2, 3])
def test_mown_rounds_lie_side_by_side(laps: int) -> None:
    found = [LineString(stretch.points) for stretch in rounds("mow", laps)]
    assert len(found) == laps
    zone = next(zone.polygon for zone in SITE.zones if zone.name == "cow paddock")
    away = [zone.exterior.distance(one.interpolate(0.5, normalized=True)) for one in found]
    assert away == pytest.approx([away[0] + k * WIDTH_M for k in range(laps)], abs=0.05)
    for one, other in itertools.pairwise(found):
        overlap = one.buffer(WIDTH_M / 2, cap_style="flat").intersection(other.buffer(WIDTH_M / 2, cap_style="flat"))
        assert overlap.area < 0.02 * WIDTH_M * one.length


def test_rounds_without_ground_covered_are_driven_on_the_same_way() -> None:
    first, second = rounds("film", 2)
    assert first.points == second.points
    assert first.name != second.name


def test_more_rounds_than_fit_are_an_error() -> None:
    with pytest.raises(PlaceError, match="cannot drive along the edge"):
        rounds("mow", 100, zone="bank")


def test_a_mission_of_two_rounds_is_carried_out() -> None:
    plan = fh.plan("Mow two rounds along the edge of the cow paddock.", SITE, TRACTOR, planner="english")
    assert isinstance(plan, fh.Plan)
    review = fh.review(plan.task, SITE, TRACTOR)
    assert review.read_back is not None
    assert any("2 rounds side by side" in line.text for line in review.read_back.lines)
    run = fh.simulate(fh.authorize(review, by="Ada"), seed=1)
    assert run.success
