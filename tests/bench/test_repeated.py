"""One request flown many times: what is compared, and what counts as kept and as agreement."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fieldhand.errors import SiteError
from fieldhand.forecast.estimate import estimate
from fieldhand.places.selectors import Trees
from fieldhand.site.model import Site
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach
from fieldhand.testing.small_orchard import husky, orchard, task_for
from fieldhand_bench.repeated import Mission, compare, summarized
from fieldhand_bench.scenes import made_block

SITE, ROBOT = orchard(), husky()
MANY = ForEach(id="n1", select=Trees(), body=Act(id="", action="take_thermal_picture"), optional=True)


def task(limit: float):
    budgets = (Budget(kind="distance_m", limit=limit, failure_probability=0.1),)
    return task_for(SITE, MANY, constraints=Constraints(budgets=budgets))


def flown(failures: int, missions: int) -> list[Mission]:
    one = Mission(seed=0, exceeded=(), visits=9, metres=60.0, seconds=100.0, percent=1.0, cpu_s=0.1)
    return [replace(one, seed=k, exceeded=("distance_m",) if k < failures else ()) for k in range(missions)]


@pytest.mark.parametrize(("failures", "kept"), [(0, True), (6, True), (7, False), (11, False)])
def test_more_failures_than_chance_explains_are_not_kept(failures: int, kept: bool) -> None:
    worst = estimate(task(60.0), SITE, ROBOT).worst
    found = summarized(worst, flown(failures, 28), review_s=0.0, warnings=())
    assert found.is_kept is kept
    assert found.kept == pytest.approx(9 * (28 - failures) / 28)


@pytest.mark.parametrize(("failures", "agrees"), [(2, True), (12, False)])
def test_a_forecast_agrees_that_lies_within_the_interval_of_what_was_observed(failures: int, agrees: bool) -> None:
    worst = estimate(task(60.0), SITE, ROBOT).worst
    said = tuple(replace(c, chance=0.07 if c.kind == "distance_m" else 0.0) for c in worst.chances)
    found = summarized(replace(worst, chances=said), flown(failures, 28), review_s=0.0, warnings=())
    assert (found.forecast, found.accepted) == (0.07, 0.1)
    assert found.agrees is agrees


def test_a_mission_is_flown_with_each_seed_and_held_against_its_forecast() -> None:
    told: list[Mission] = []
    found = compare(task(60.0), SITE, ROBOT, range(3, 9), tell=told.append)
    assert [one.seed for one in told] == list(range(3, 9))
    assert len({one.metres for one in told}) == 6
    assert found.visits == np.mean([one.visits for one in told])
    assert found.visits == pytest.approx(found.visits_forecast, abs=2.0)
    assert found.is_kept
    assert found.agrees


@pytest.mark.parametrize("kind", ["straight", "curved"])
def test_a_made_block_has_about_so_many_trees_a_pond_and_where_to_begin(kind: str) -> None:
    site = made_block(kind, 300)
    assert 240 <= len(site.trees) <= 300
    assert {"start", "end"} <= site.markers.keys()
    assert any(zone.kind == "keep_out" for zone in site.zones)
    assert site.sha256 == made_block(kind, 300).sha256


def test_only_the_rows_of_a_curved_block_bend() -> None:
    straight, curved = (largest_bend(made_block(kind, 300)) for kind in ("straight", "curved"))
    assert straight < 0.5 < 1.5 < curved


def test_another_kind_of_block_is_refused() -> None:
    with pytest.raises(SiteError, match="no block is round"):
        made_block("round", 300)


def largest_bend(site: Site) -> float:
    """Return the metres by which the trees of a row lie away from a straight line, the median over the rows."""
    bends = []
    for row in site.planting.rows:
        xy = np.array([site.trees[k].place.xy for k in row.trees])
        bends.append(np.linalg.svd(xy - xy.mean(axis=0))[1][1] / np.sqrt(len(xy)) * 2)
    return float(np.median(bends))
