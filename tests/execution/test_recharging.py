"""A robot that may recharge does its whole plan, charges as its profile says, and is never stranded."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from fieldhand import mission
from fieldhand.approval.authorize import EveryWarning
from fieldhand.execution.drivers.simulation.world import ActionFails, BatteryDrains, World
from fieldhand.places.selectors import Rows, TreeIs
from fieldhand.site.model import Site
from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.task.frames import Budget
from fieldhand.task.plan import Act, ForEach, If, InOrder, Node, Recharge, Wait
from fieldhand.task.results import (
    Acted,
    Arrived,
    ChargeBegun,
    ChargeEnded,
    Driving,
    Ended,
    Exited,
    Faulted,
    LimitCrossed,
)
from support.examples import examples
from support.missions.rechargeable import rechargeable, simulated, task_of
from support.missions.rig import of_type

PICTURE = Act(action="take_thermal_picture")
ROWS = ForEach(select=Rows(first="2", last="7"), body=PICTURE)


@pytest.fixture(scope="module")
def site() -> Site:
    return Site.demo()


def run(plan: Node, site: Site, seed: int = 0, world: World | None = None, **constraints: object) -> mission.Run:
    robot = rechargeable()
    return simulated(task_of(plan, site, robot, **constraints), site, robot, seed, world)


@pytest.mark.parametrize("seed", range(4))
def test_charges_as_often_as_needed_and_does_everything(site: Site, seed: int) -> None:
    done = run(ROWS, site, seed, recharge=True)
    charges = of_type(done.events, ChargeEnded)
    assert done.status == "completed", done.reason
    assert len(charges) >= 2
    assert len(of_type(done.events, Acted)) == 98
    assert all(o.outcome == "success" for o in done.outcomes)
    assert not [e for e in of_type(done.events, LimitCrossed) if e.then == "stop"]


def test_what_is_charged_is_not_counted_as_used(site: Site) -> None:
    done = run(ROWS, site, recharge=True, budgets=(Budget(kind="energy_percent", limit=400.0),))
    (ended,) = of_type(done.events, Ended)
    gained = sum(e.gained_percent for e in of_type(done.events, ChargeEnded))
    assert done.result.spent.percent == pytest.approx(100.0 - ended.charge_percent + gained)
    assert done.result.spent.percent > 100.0
    assert done.status == "completed"


def test_an_energy_budget_is_not_extended_by_charging(site: Site) -> None:
    plan = ForEach(select=Rows(first="2", last="7"), body=PICTURE, optional=True)
    done = run(plan, site, recharge=True, budgets=(Budget(kind="energy_percent", limit=120.0),))
    assert of_type(done.events, ChargeEnded)
    assert done.result.spent.percent <= 120.0
    assert len(of_type(done.events, Acted)) < 98


def test_goes_on_at_the_visit_where_it_was(site: Site) -> None:
    done = run(ROWS, site, recharge=True)
    places = [e.place for e in of_type(done.events, Acted)]
    assert len(places) == len(set(places))
    first = next(e for e in done.events if isinstance(e, ChargeEnded))
    after = [e for e in done.events if isinstance(e, Driving) and e.t >= first.t]
    assert after[0].node == "n1"


def test_a_charge_of_the_plan_ends_where_it_says(site: Site) -> None:
    plan = InOrder(
        steps=(ForEach(select=Rows(first="2", last="2"), body=PICTURE), Recharge(until_percent=95.0), PICTURE)
    )
    done = run(plan, site)
    (charged,) = of_type(done.events, ChargeEnded)
    assert charged.charge_percent == pytest.approx(95.0, abs=0.6)
    assert charged.node == "n4"
    assert of_type(done.events, Acted)[-1].place == "charger"
    assert done.status == "completed"


def test_a_charge_by_time_lasts_that_long(site: Site) -> None:
    plan = InOrder(steps=(ForEach(select=Rows(first="2", last="2"), body=PICTURE), Recharge(duration_s=60.0)))
    (charged,) = of_type(run(plan, site).events, ChargeEnded)
    assert charged.seconds == pytest.approx(60.0, abs=0.1)


@settings(max_examples=examples(30, thorough=300), deadline=None)
@given(waited=st.floats(1.0, 60.0), seconds=st.floats(1.0, 60.0))
def test_charges_by_time_end_whatever_the_clock_shows(waited: float, seconds: float, site: Site) -> None:
    pictures = ForEach(select=Rows(first="2", last="2"), body=PICTURE)
    plan = InOrder(steps=(pictures, Wait(seconds=waited), Recharge(duration_s=seconds)))
    (charged,) = of_type(run(plan, site).events, ChargeEnded)
    assert charged.seconds == pytest.approx(seconds, abs=0.1)


def test_charges_below_the_charge_that_the_task_names(site: Site) -> None:
    plan = ForEach(select=Rows(first="2", last="3"), body=PICTURE)
    done = run(plan, site, recharge=True, recharge_below_percent=70.0, recharge_until_percent=85.0)
    (begun, *_) = of_type(done.events, ChargeBegun)
    assert "less than 70 %" in begun.why
    assert begun.charge_percent > 45.0
    assert of_type(done.events, ChargeEnded)[0].charge_percent == pytest.approx(85.0, abs=0.6)


def test_charges_no_more_often_than_allowed(site: Site) -> None:
    plan = ForEach(select=Rows(first="2", last="3"), body=PICTURE)
    done = run(plan, site, recharge=True, recharge_below_percent=70.0, recharge_at_most=1)
    assert len(of_type(done.events, ChargeEnded)) == 1


def test_docking_is_tried_again(site: Site) -> None:
    world = World(faults=(ActionFails(action="dock", times=1),))
    done = run(ROWS, site, recharge=True, world=world)
    assert done.status == "completed"
    (fault,) = of_type(done.events, Faulted)
    assert fault.handled
    assert "dock" in fault.what


def test_docking_that_fails_for_good_ends_the_mission_with_a_fault(site: Site) -> None:
    done = run(ROWS, site, recharge=True, world=World(faults=(ActionFails(action="dock"),)))
    assert done.status == "faulted"
    assert "dock failed" in done.reason
    (exited,) = of_type(done.events, Exited)
    assert exited.then == "return_to_end"
    assert of_type(done.events, Arrived)[-1].place == "end"


def test_a_battery_that_drains_faster_charges_more_often(site: Site) -> None:
    usual = run(ROWS, site, recharge=True)
    fast = run(ROWS, site, recharge=True, world=World(faults=(BatteryDrains(factor=1.5, from_s=0.0),)))
    assert len(of_type(fast.events, ChargeEnded)) > len(of_type(usual.events, ChargeEnded))
    assert not [e for e in of_type(fast.events, LimitCrossed) if e.then == "stop"]


def test_a_time_budget_holds_although_charging_takes_time(site: Site) -> None:
    plan = ForEach(select=Rows(first="2", last="7"), body=PICTURE, optional=True)
    done = run(plan, site, recharge=True, budgets=(Budget(kind="duration_s", limit=1500.0),))
    assert done.result.spent.seconds <= 1500.0
    assert of_type(done.events, ChargeEnded)
    whole = run(plan, site, budgets=(Budget(kind="duration_s", limit=1500.0),))
    assert len(of_type(done.events, Acted)) > len(of_type(whole.events, Acted))


def test_visits_end_at_a_charge(site: Site) -> None:
    done = run(ForEach(select=Rows(first="2", last="7"), body=PICTURE, until=BatteryBelow(percent=60.0)), site)
    charges = [e.charge_percent for e in of_type(done.events, Acted)]
    assert charges[-1] <= 60.0 < charges[-2]
    assert done.status == "completed"


def test_a_branch_depends_on_the_charge(site: Site) -> None:
    plan = InOrder(steps=(PICTURE, If(condition=BatteryBelow(percent=50.0), then=Recharge(), otherwise=PICTURE)))
    assert len(of_type(run(plan, site).events, Acted)) == 2


def test_it_turns_home_at_the_charge_that_the_task_names(site: Site) -> None:
    done = run(ForEach(select=Rows(first="2", last="3"), body=PICTURE), site, return_percent=60.0)
    assert done.status == "returned"
    crossed = next(e for e in of_type(done.events, LimitCrossed) if e.then == "return")
    assert crossed.threshold == 60.0


def home_after_work_beside_the_charger(site: Site, count: int, **constraints: object) -> mission.Run:
    """Return a mission whose way home is longer than that to the charger; its legs cost what they are long."""
    robot, plan = rechargeable(alpha=1.0), Act(action="take_thermal_picture", at=TreeIs(tree="1"), count=count)
    task = task_of(plan, site, robot, recharge=True, **constraints)
    composition = replace(task.composition, nominal="return_to_start")
    return simulated(replace(task, composition=composition), site, robot)


def test_charges_for_the_way_home_if_it_would_fall_below_the_reserve(site: Site) -> None:
    done = home_after_work_beside_the_charger(site, 92)
    last = [e.event for e in done.events if isinstance(e, Acted | ChargeEnded | Exited)][-3:]
    assert last == ["action", "charged", "exit"]
    (ended,) = of_type(done.events, Ended)
    assert done.status == "completed", done.reason
    assert ended.charge_percent >= 20.0


def test_a_charge_that_was_only_wished_for_is_not_made_before_the_way_home(site: Site) -> None:
    done = home_after_work_beside_the_charger(site, 84, recharge_below_percent=40.0)
    (ended,) = of_type(done.events, Ended)
    assert 20.0 <= ended.charge_percent < 40.0
    assert not of_type(done.events, ChargeEnded)


def test_work_at_one_place_is_continued_after_a_charge(site: Site) -> None:
    plan = InOrder(steps=tuple(Act(action="take_thermal_picture", at=TreeIs(tree="40"), count=12) for _ in range(12)))
    done = run(plan, site, recharge=True)
    assert done.status == "completed", done.reason
    assert len(of_type(done.events, Acted)) == 144
    assert of_type(done.events, ChargeEnded)
    assert all(o.outcome == "success" for o in done.outcomes)


@settings(max_examples=examples(8, thorough=60), deadline=None, suppress_health_check=list(HealthCheck))
@given(
    st.none() | st.integers(25, 70),
    st.none() | st.integers(80, 100),
    st.none() | st.integers(1, 3),
    st.integers(0, 99),
    st.booleans(),
)
def test_something_is_done_between_two_charges(
    below: int | None, until: int | None, most: int | None, seed: int, optional: bool
) -> None:
    site, robot = Site.demo(), rechargeable()
    plan = ForEach(select=Rows(first="2", last="4"), body=PICTURE, optional=optional)
    task = task_of(
        plan,
        site,
        robot,
        recharge=True,
        recharge_below_percent=None if below is None else float(below),
        recharge_until_percent=None if until is None else float(until),
        recharge_at_most=most,
    )
    review = mission.review(task, site, robot)
    assume(not review.errors)
    done = mission.simulate(mission.authorize(review, by="tests", confirmed=EveryWarning()), seed=seed)
    of_interest = [e for e in done.events if isinstance(e, ChargeEnded | Acted)]
    for one, other in pairwise(of_interest):
        assert not (isinstance(one, ChargeEnded) and isinstance(other, ChargeEnded))
    charges = of_type(done.events, ChargeEnded)
    assert {e.place for e in charges} <= {"charger"}
    assert most is None or len(charges) <= most
    assert not [e for e in of_type(done.events, LimitCrossed) if e.then == "stop"]
