"""The last charge is for the longest branch of each visit, on the robot and in its forecast."""

from __future__ import annotations

import numpy as np
import pytest

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.forecast.charge_simulation import stretches
from fieldhand.forecast.recharge_rules import recharge_rules
from fieldhand.forecast.service import work_of
from fieldhand.forecast.visit_order import drives_for
from fieldhand.places.selectors import Rows
from fieldhand.site.model import Site
from fieldhand.task.conditions import TreeHas
from fieldhand.task.plan import Act, ForEach, If, InOrder
from fieldhand.task.results import ChargeEnded
from support.missions.rechargeable import rechargeable, task_of
from support.missions.rig import of_type

PICTURE = Act(action="take_thermal_picture")
#: No tree is that old: the work inside is never done.
TESTED = If(condition=TreeHas(attribute="age_years", test="gt", value=500.0), then=Act(action="read_co2", count=2))
BODY = InOrder(steps=(PICTURE, TESTED))
FLIGHTS = 8


@pytest.fixture(scope="module")
def approved() -> mission.ApprovedMission:
    site, robot = Site.demo(), rechargeable()
    task = task_of(ForEach(select=Rows(first="2", last="6"), body=BODY), site, robot, recharge=True)
    return mission.authorize(mission.review(task, site, robot), by="tests", confirmed=EveryWarning())


def test_a_visit_counts_with_its_longest_branch_once(approved: mission.ApprovedMission) -> None:
    site, robot = Site.demo(), rechargeable()
    assert approved.estimate is not None
    rules = recharge_rules(approved.task, site, robot)
    assert rules is not None
    some = stretches(approved.estimate.worst.walk.steps, rules, drives_for(site, robot))
    body = work_of(approved.task.composition.plan.children[0], robot)
    visits = sum(s.step is not None and s.step.kind == "drive" for s in some)
    assert visits > 50
    assert sum(s.expected.seconds for s in some) == pytest.approx(visits * body.seconds)
    assert sum(s.work.seconds for s in some) < 0.5 * visits * body.seconds


def test_time_at_the_charger_is_that_of_flights(approved: mission.ApprovedMission) -> None:
    assert approved.estimate is not None
    used = approved.estimate.worst.walk.used
    assert used is not None
    assert used.charging is not None
    forecast = used.charging.docked_s
    runs = [mission.simulate(approved, seed=seed) for seed in range(FLIGHTS)]
    assert any(of_type(run.events, ChargeEnded) for run in runs)
    flown = [run.result.spent.docked_s for run in runs]
    spread = max(float(np.std(flown)), float(np.std(forecast)))
    assert np.mean(flown) == pytest.approx(
        float(np.mean(forecast)), abs=3.0 * spread / np.sqrt(FLIGHTS) + 0.2 * float(np.mean(forecast))
    )
