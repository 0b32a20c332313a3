"""Work at a place, on its longest branch."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.forecast.service import rewards_of, service_of
from fieldhand.places.selectors import Trees
from fieldhand.task.conditions import Level
from fieldhand.task.plan import Act, ForEach, GoTo, If, InOrder, Repeat, StopMission, Try
from fieldhand.testing.small_orchard import husky, orchard

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


@given(values=st.lists(st.one_of(st.none(), st.integers(-50, 50)), min_size=20, max_size=20))
def test_by_rank_the_lowest_or_highest_value_is_worth_most(values):
    site = orchard()
    trees = [
        replace(tree, properties={} if value is None else {"vigor": float(value)})
        for tree, value in zip(site.trees, values, strict=True)
    ]
    site = replace(site, trees=tuple(trees))
    places = [tree.place for tree in site.trees]
    for first, sign in (("lowest", 1), ("highest", -1)):
        node = ForEach(id="f", select=Trees(), body=picture, optional=True, reward="vigor", reward_by=first)
        rewards = rewards_of(node, places, site)
        known = [(sign * value, reward) for value, reward in zip(values, rewards, strict=True) if value is not None]
        assert [reward for value, reward in zip(values, rewards, strict=True) if value is None] == [0.0] * (
            20 - len(known)
        )
        for one, worth in known:
            assert 0.0 < worth <= 1.0
            assert all((worth > other_worth) == (one < other) for other, other_worth in known if other != one)
            assert all(worth == other_worth for other, other_worth in known if other == one)
        assert not known or max(reward for _, reward in known) == 1.0


def test_the_value_of_an_attribute_is_the_worth_of_a_visit_unless_it_is_by_rank():
    site = orchard()
    site = replace(site, trees=tuple(replace(t, properties={"yield": 3.0 + k}) for k, t in enumerate(site.trees)))
    places = [tree.place for tree in site.trees]
    plain = ForEach(id="f", select=Trees(), body=picture, optional=True)
    assert rewards_of(plain, places, site) == [1.0] * len(places)
    assert rewards_of(replace(plain, reward="yield"), places, site) == [3.0 + k for k in range(len(places))]
    low = rewards_of(replace(plain, reward="yield", reward_by="lowest"), places, site)
    assert low[0] == 1.0
    assert low[len(places) // 20] == pytest.approx(0.5)
