"""Before far places a robot charges further; what would still be likely to strand it is refused or left out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.errors import FieldhandError
from fieldhand.forecast.charging_missions import ChargingMissions
from fieldhand.forecast.recharge_rules import RechargeRules, recharge_rules
from fieldhand.places.selectors import Rows
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Budget
from fieldhand.task.plan import Act, ForEach, InOrder, Recharge
from fieldhand.task.results import Acted, ChargeBegun
from support.missions.rechargeable import rechargeable, task_of
from support.missions.rig import of_type

PICTURE = Act(action="take_thermal_picture")
FAR = ForEach(select=Rows(first="6", last="8"), body=PICTURE)


def reviewed(robot: RobotProfile, plan: Any = FAR, **constraints: Any) -> mission.Review:
    site = Site.demo()
    return mission.review(task_of(plan, site, robot, **{"recharge": True, **constraints}), site, robot)


def rules_of(robot: RobotProfile, **constraints: Any) -> RechargeRules:
    site = Site.demo()
    found = recharge_rules(task_of(PICTURE, site, robot, recharge=True, **constraints), site, robot)
    assert found is not None
    return found


def stranding(review: mission.Review) -> float:
    assert review.estimate is not None
    return review.estimate.worst.stranding


PERCENTS = st.floats(0.0, 300.0)


@given(PERCENTS, st.floats(10.0, 95.0), PERCENTS, PERCENTS)
def test_an_open_target_rises_for_far_places_up_to_the_highest(
    rest: float, charge: float, there: float, everything: float
) -> None:
    rules = rules_of(rechargeable(most_percent=97))
    far = rules.far(there, everything)
    target = float(rules.target(rest, charge, far))
    assert min(97.0, charge) <= target <= 97.0
    assert target >= min(97.0, there, everything)
    assert target >= float(rules.target(rest, charge, 0.0))


@given(PERCENTS, st.floats(10.0, 95.0), PERCENTS)
def test_the_target_of_a_task_is_kept(rest: float, charge: float, far: float) -> None:
    assert float(rules_of(rechargeable(), recharge_until_percent=80.0).target(rest, charge, far)) == 80.0


@given(st.floats(1.0, 400.0), st.floats(1.0, 400.0), st.floats(0.0, 30.0), st.booleans())
def test_a_charged_battery_suffices_to_leave_for_the_visit(there: float, back: float, work: float, open_: bool) -> None:
    # Otherwise one charge would follow another.
    rules = rules_of(rechargeable(), **({} if open_ else {"recharge_until_percent": 90.0}))
    sums = [there**n + back**n for n in (1, 2, 3)]
    if float(rules.needed(sums, work, charged=True)) > rules.most_percent:
        return
    target = float(rules.target(np.inf, 30.0, rules.far(float(rules.certain(sums, work)))))
    assert not rules.must_charge(target, rules.needed(sums, work)) or target >= rules.most_percent


def test_charging_further_lowers_the_probability_and_saves_charges() -> None:
    further, usual = reviewed(rechargeable()), reviewed(rechargeable(most_percent=90))
    assert stranding(further) < 0.4 * stranding(usual)
    assert further.estimate is not None
    assert usual.estimate is not None
    assert further.estimate.worst.charged_to == pytest.approx(100.0)
    assert usual.estimate.worst.charged_to == pytest.approx(90.0)
    assert further.estimate.worst.charges is not None
    assert usual.estimate.worst.charges is not None
    assert further.estimate.worst.charges.mean < usual.estimate.worst.charges.mean
    assert "up to 100 %, further than the usual 90 %" in further.words
    assert "further than the usual" not in usual.words


def test_the_robot_charges_as_far_as_the_forecast() -> None:
    approved = mission.authorize(reviewed(rechargeable()), by="tests", confirmed=EveryWarning())
    begun = [e for seed in range(3) for e in of_type(mission.simulate(approved, seed=seed).events, ChargeBegun)]
    assert max(e.until_percent for e in begun) == pytest.approx(100.0)


def test_near_places_are_charged_for_as_usual() -> None:
    near = ForEach(select=Rows(first="1", last="2"), body=Act(action="take_thermal_picture", count=40))
    review = reviewed(rechargeable(600_000), near)
    approved = mission.authorize(review, by="tests", confirmed=EveryWarning())
    begun = of_type(mission.simulate(approved, seed=0).events, ChargeBegun)
    assert begun
    assert review.estimate is not None
    assert max(e.until_percent for e in begun) <= 90.0
    assert review.estimate.worst.charged_to <= 90.0


def test_a_mission_likely_to_be_stranded_is_refused_unless_the_profile_accepts_it() -> None:
    refused = reviewed(rechargeable(), recharge_until_percent=80.0)
    (error,) = refused.errors
    assert "would be stopped by its battery" in error.what
    assert "charged to 80 %" in error.what
    assert stranding(refused) > 0.001
    accepts = reviewed(rechargeable(stranding_probability=0.05), recharge_until_percent=80.0)
    assert not accepts.errors
    assert stranding(accepts) == pytest.approx(stranding(refused))


def test_a_plan_that_says_when_to_charge_is_only_warned() -> None:
    plan = InOrder(steps=(FAR, Recharge()))
    review = reviewed(rechargeable(300_000, stranding_probability=1e-12), plan, recharge=False)
    assert not review.errors
    assert any("would be stopped by its battery" in warning for warning in review.warnings)


def test_the_probability_is_exact_for_one_way_and_counts_a_stopped_mission_once() -> None:
    robot = rechargeable()
    rules, task = rules_of(robot), task_of(PICTURE, Site.demo(), robot, recharge=True)
    missions = ChargingMissions(rules, task, 3, 60.0)
    missions.drive(np.array([0.0, 20.0 / rules.per_metre, 55.0 / rules.per_metre]))
    way = np.full(3, 100.0)
    left_m = (np.array([60.0, 40.0]) - rules.stop_percent) / rules.per_metre
    exact = np.exp(-(left_m / 100.0 - 0.5) / 0.5)
    missions.set_out(way)
    assert missions.used.charging is not None
    assert missions.used.charging.stranding == pytest.approx([*exact, 0.0])


def test_optional_places_too_far_are_left_out_by_forecast_and_robot() -> None:
    budgets = (Budget(kind="duration_s", limit=4000.0),)
    plan = ForEach(select=Rows(first="4", last="8"), body=PICTURE, optional=True)
    review = reviewed(rechargeable(120_000), plan, budgets=budgets)
    assert review.estimate is not None
    (list_,) = (s for s in review.estimate.worst.walk.steps if s.visit_forecast is not None)
    assert list_.visit_forecast is not None
    never = {tree for tree, chance in list_.visit_forecast.chances.items() if chance == 0.0}
    approved = mission.authorize(review, by="tests", confirmed=EveryWarning())
    visited = {e.place for seed in range(2) for e in of_type(mission.simulate(approved, seed=seed).events, Acted)}
    too_far = {tree for tree in never if float(tree) > 100}
    assert too_far
    assert visited
    assert not visited & too_far


def test_a_highest_target_below_the_usual_one_is_refused() -> None:
    with pytest.raises(FieldhandError, match="most_percent 85 is below until_percent 90"):
        rechargeable(most_percent=85)
