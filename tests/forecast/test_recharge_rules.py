"""A robot goes to its charger before a bad leg could stop it on the way there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.forecast.recharge_rules import STOP_CHANCE, STOP_SHARE, RechargeRules, recharge_rules
from fieldhand.forecast.route_cost import route_cost
from fieldhand.site.model import Site
from fieldhand.task.plan import Act
from support.missions.rechargeable import rechargeable, task_of


def rules_of(alpha: float = 0.5, capacity_j: float = 150_000) -> RechargeRules:
    site, robot = Site.demo(), rechargeable(capacity_j, alpha)
    found = recharge_rules(task_of(Act(action="take_thermal_picture"), site, robot, recharge=True), site, robot)
    assert found is not None
    return found


def sums(*legs: float) -> list[float]:
    return [sum(leg**n for leg in legs) for n in (1, 2, 3)]


def chance_to_stop(rules: RechargeRules, leg_m: float, percent: float) -> float:
    """Return the exact probability that one leg empties the battery down to the stop level."""
    alpha = rules.robot.leg_cost.alpha
    metres = (percent - rules.stop_percent) / rules.per_metre
    return float(np.exp(-max(0.0, metres - alpha * leg_m) / ((1.0 - alpha) * leg_m)))


@given(st.floats(0.05, 0.95), st.floats(1.0, 1000.0))
def test_one_leg_almost_never_reaches_the_stop_level(alpha: float, leg_m: float) -> None:
    rules = rules_of(round(alpha, 2), 1_500_000)
    needed = float(rules.needed(sums(leg_m), 0.0))
    reserve_only = float(rules.needed(sums(leg_m), 0.0, ends=True))
    most = reserve_only + STOP_SHARE * max(0.0, rules.most_percent - reserve_only)
    assert chance_to_stop(rules, leg_m, needed) <= STOP_CHANCE * 1.02 or needed == pytest.approx(most)


@given(st.lists(st.floats(0.0, 500.0), min_size=1, max_size=4), st.floats(0.0, 40.0))
def test_the_stop_level_only_adds_to_the_reserve_and_leaves_room_for_visits(legs: list[float], work: float) -> None:
    rules = rules_of()
    reserve_only = float(rules.needed(sums(*legs), work, ends=True))
    needed = float(rules.needed(sums(*legs), work))
    assert needed >= reserve_only
    assert needed <= max(reserve_only, rules.most_percent)
    assert float(rules.needed(sums(*legs), work, charged=True)) <= reserve_only


def test_far_from_the_charger_it_leaves_earlier_than_for_the_reserve_alone() -> None:
    rules = rules_of(capacity_j=368_040)
    far, near = sums(6.0, 270.0), sums(6.0, 20.0)
    assert float(rules.needed(far, 0.0)) > float(rules.needed(far, 0.0, ends=True)) + 10.0
    assert float(rules.needed(near, 0.0)) == float(rules.needed(near, 0.0, ends=True))


def test_certain_legs_need_no_more_than_the_reserve() -> None:
    rules = rules_of(alpha=1.0)
    assert float(rules.needed(sums(200.0), 3.0)) == pytest.approx(rules.reserve_percent + 3.0 + 200 * rules.per_metre)


@given(st.floats(11.0, 100.0), st.floats(0.0, 600.0), st.lists(st.floats(0.0, 500.0), min_size=1, max_size=5))
def test_a_risky_way_to_the_charger_is_not_taken_where_finishing_is_safer(
    charge: float, away_m: float, legs: list[float]
) -> None:
    rules = rules_of()
    there = float(rules.stop_chance(charge, sums(away_m)))
    rest = float(rules.stop_chance(charge, sums(*legs), 2.0))
    worse = bool(rules.is_way_to_charger_worse(charge, away_m, sums(*legs), 2.0))
    assert worse == (there > STOP_CHANCE and rest < there)


def test_near_the_charger_the_robot_charges_whatever_is_left() -> None:
    rules = rules_of()
    assert not rules.is_way_to_charger_worse(60.0, 20.0, sums(5.0), 0.0)
    assert rules.is_way_to_charger_worse(45.0, 250.0, sums(5.0, 30.0), 1.0)
    assert not rules.is_way_to_charger_worse(45.0, 250.0, sums(250.0, 30.0), 1.0)


def test_where_no_way_leads_nothing_suffices() -> None:
    assert np.isinf(rules_of().needed(sums(10.0), np.inf))


def test_the_charge_for_a_route_is_that_for_its_sums() -> None:
    rules = replace(rules_of(), dock_percent=2.5)
    way = route_cost([120.0, 80.0])
    assert rules.needed_for(way, docks=True) == pytest.approx(float(rules.needed(sums(120.0, 80.0), 2.5)))
