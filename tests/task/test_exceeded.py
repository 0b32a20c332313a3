"""A limit counts as exceeded by the figures of the log alone, by more than rounding, and by nothing less."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.language import open_language
from fieldhand.mission import assess
from fieldhand.robot.loader import load_robot
from fieldhand.task.build import make_task
from fieldhand.task.exceeded import exceeded_limits, say_status
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act
from fieldhand.task.results import Arrived, Driving, Ended, Started

METRES = st.floats(0.0, 5000.0)


def started(charge=100.0, reserve=20.0):
    return Started(
        t=0.0, task="a", robot="husky", site="demo", lat=0, lon=0, charge_percent=charge, reserve_percent=reserve
    )


def driving(t, place="end", kind="marker"):
    return Driving(t=t, node="", kind=kind, place=place, planned_m=1.0, path=())


def arrived(t, metres, charge=50.0, place="end", kind="marker"):
    here = {"lat": 0, "lon": 0, "leg_m": 1.0, "travelled_m": metres, "charge_percent": charge}
    return Arrived(t=t, node="", kind=kind, place=place, **here)


def ended(t, metres, charge=50.0, status="completed"):
    return Ended(t=t, status=status, lat=0, lon=0, travelled_m=metres, charge_percent=charge)


def limits(**of):
    return Constraints(budgets=tuple(Budget(kind=kind, limit=limit) for kind, limit in of.items()))


@given(used=METRES, limit=st.floats(1.0, 5000.0))
def test_a_distance_is_exceeded_exactly_where_the_odometer_shows_more(used, limit):
    found = exceeded_limits(limits(distance_m=limit), [started(), arrived(9.0, used), ended(9.0, used)])
    assert bool(found) == (used > limit + 1e-6 * max(1.0, limit))


@given(left=st.floats(0.0, 100.0), reserve=st.floats(0.0, 99.0))
def test_a_reserve_is_broken_exactly_where_less_is_left(left, reserve):
    found = exceeded_limits(limits(), [started(reserve=reserve), ended(9.0, 5.0, charge=left)])
    assert bool(found) == (left < reserve - 1e-6 * max(1.0, reserve))


@given(limit=st.floats(1.0, 5000.0), ulps=st.integers(0, 4))
def test_sums_that_differ_in_their_last_digits_do_not_exceed(limit, ulps):
    used = limit
    for _ in range(ulps):
        used = math.nextafter(used, math.inf)
    assert exceeded_limits(limits(distance_m=limit), [started(), ended(9.0, used)]) == ()


def test_each_kind_of_limit_is_said_with_when_and_where():
    log = [
        started(charge=60.0),
        driving(0.0, "7", "tree"),
        arrived(500.0, 700.0, charge=30.0, place="7", kind="tree"),
        driving(500.0),
        arrived(852.0, 904.5, charge=14.0),
        ended(852.0, 904.5, charge=14.0),
    ]
    found = exceeded_limits(limits(distance_m=900.0, duration_s=600.0, energy_percent=30.0), log)
    assert [one.kind for one in found] == ["distance_m", "duration_s", "energy_percent", "reserve"]
    assert [one.t for one in found] == [852.0, 852.0, 852.0, 852.0]
    assert {one.near for one in found} == {"on the way to the end"}
    assert found[0].why == "904.5 m of 900 m driven: limit exceeded at 14:12, on the way to the end"
    assert found[1].why == "852 s of 600 s taken: limit exceeded at 14:12, on the way to the end"
    assert found[2].why.startswith("46 % of the battery used where 30 % were allowed:")
    assert found[3].why.startswith("14 % charge left where 20 % must be left:")
    assert open_language("es").say(found[0].why).startswith("904,5 m recorridos de 900 m: límite excedido en 14:12")


def test_an_excess_of_millimetres_is_not_rounded_away_in_words():
    (found,) = exceeded_limits(limits(distance_m=900.0), [started(), ended(9.0, 900.004)])
    assert found.why.startswith("900.004 m of 900 m driven")


@pytest.mark.parametrize("status", ["completed", "returned", "exceeded", "faulted", "aborted"])
def test_what_a_log_calls_completed_is_judged_by_its_figures(status):
    task = make_task(request="", plan=Act(id="", action="read_co2"), measures={}, constraints=limits(distance_m=900.0))
    kept = assess(task, [started(), ended(9.0, 899.0, status=status)])
    assert (kept.status, kept.exceeded) == (status, ())
    broken = assess(task, [started(), ended(9.0, 904.5, status=status)])
    assert not broken.success
    assert broken.status == (status if status in ("faulted", "aborted") else "exceeded")
    assert [one.kind for one in broken.exceeded] == ["distance_m"]
    assert say_status(broken.status)


def test_a_log_of_an_earlier_version_is_judged_by_the_reserve_of_the_profile():
    task = make_task(request="", plan=Act(id="", action="read_co2"), measures={})
    log = [started(reserve=None), ended(9.0, 100.0, charge=14.0)]
    assert [one.kind for one in assess(task, log, load_robot("husky")).exceeded] == ["reserve"]
    assert assess(task, log).exceeded == ()  # nobody says what must be left
