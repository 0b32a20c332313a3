"""Work at a place, on its longest branch."""

import pytest

from fieldhand.forecast.service import service_of
from fieldhand.places.selectors import Trees
from fieldhand.task.conditions import Level
from fieldhand.task.plan import Act, ForEach, GoTo, If, InOrder, Repeat, StopMission, Try
from fieldhand.testing.small_orchard import husky

ROBOT = husky()
PICTURE = ROBOT.action["take_thermal_picture"]
CO2 = ROBOT.action["read_co2"]
picture = Act(id="p", action="take_thermal_picture", reading="r")
co2 = Act(id="c", action="read_co2")


def of(action, times=1):
    return pytest.approx((times * action.duration_s, times * action.energy_j))


def test_captures_rounds_and_visits_multiply():
    twice = Act(id="p", action="take_thermal_picture", count=2)
    assert service_of(twice, ROBOT) == of(PICTURE, 2)
    assert service_of(Repeat(id="r", times=3, body=twice), ROBOT) == of(PICTURE, 6)
    assert service_of(ForEach(id="f", select=Trees(), body=picture, at_most=4), ROBOT) == of(PICTURE, 4)


def test_an_if_counts_its_longer_side():
    low = Level(reading="r", quantity="canopy_temperature", level="low")
    one = If(id="i", condition=low, then=picture, otherwise=Repeat(id="r", times=5, body=picture))
    assert service_of(one, ROBOT) == of(PICTURE, 5)
    assert service_of(If(id="i", condition=low, then=picture), ROBOT) == of(PICTURE)


def test_a_try_may_take_its_body_and_its_otherwise():
    assert service_of(Try(id="t", body=picture, otherwise=co2), ROBOT) == pytest.approx(
        (PICTURE.duration_s + CO2.duration_s, PICTURE.energy_j + CO2.energy_j)
    )


def test_what_stands_after_a_stop_is_never_done_and_driving_is_no_work():
    plan = InOrder(id="s", steps=(GoTo(id="g", place=Trees()), picture, StopMission(id="x"), co2))
    assert service_of(plan, ROBOT) == of(PICTURE)
