"""Conditions on all readings of a series: what they compute, when they are unknown, and which branches they leave."""

from __future__ import annotations

import math
import statistics

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.forecast.branches import branches
from fieldhand.forecast.conditions import ConditionInputs, evaluate
from fieldhand.forecast.estimate import estimate
from fieldhand.places.reading_series import ReadingSeries, TakenReading
from fieldhand.places.selectors import TreeIs, Trees, UnionOf
from fieldhand.places.series_statistics import Statistic, half_width
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown
from fieldhand.task.conditions import Between, Compare, Condition, Level, Not
from fieldhand.task.plan import Act, ForEach, If, InOrder, Node, Repeat
from fieldhand.terms import Test
from support.missions.rig import husky, orchard, task_for

SITE, ROBOT = orchard(), husky()
HERE = SITE.by_id["r0c1"].place
VALUES = st.lists(st.floats(300, 600, allow_nan=False), min_size=1, max_size=12)


def co2(test: Test, value: float, reading: str = "r") -> Compare:
    return Compare(reading=reading, quantity="co2", test=test, value=value, unit="ppm")


def series(*values: float, quantity: str = "co2") -> ReadingSeries:
    return ReadingSeries([TakenReading(place=HERE, values={quantity: value}) for value in values])


def truth(condition: Condition, **named: ReadingSeries) -> bool | None:
    found = evaluate(condition, ConditionInputs(site=SITE, robot=ROBOT, here=HERE, series=named))
    assert found.why
    return found.truth


@given(VALUES, st.floats(300, 600), st.sampled_from(["mean", "median", "minimum", "maximum", "range"]))
def test_a_statistic_is_compared_as_one_reading_is(values: list[float], limit: float, of: Statistic) -> None:
    value = {
        "mean": math.fsum(values) / len(values),
        "median": statistics.median(values),
        "minimum": min(values),
        "maximum": max(values),
        "range": max(values) - min(values),
    }[of]
    whole = Aggregate(of=of, condition=co2("gt", limit))
    assert truth(whole, r=series(*values)) == (value > limit)
    assert truth(Not(condition=whole), r=series(*values)) == (value <= limit)


@given(VALUES, st.floats(300, 600), st.integers(0, 12), st.booleans())
def test_readings_that_pass_are_counted(values: list[float], limit: float, number: int, percent: bool) -> None:
    passing = sum(value < limit for value in values)
    found = 100 * passing / len(values) if percent else passing
    condition = CountReadings(test="ge", number=float(number), percent=percent, condition=co2("lt", limit))
    assert truth(condition, r=series(*values)) == (found >= number)


@given(VALUES, VALUES, st.floats(-50, 50))
def test_one_series_is_compared_with_another_by_a_difference(one: list[float], two: list[float], by: float) -> None:
    condition = CompareSeries(of="maximum", reading="a", than="b", quantity="co2", test="gt", value=by, unit="ppm")
    assert truth(condition, a=series(*one), b=series(*two)) == (max(one) > max(two) + by)


@pytest.mark.parametrize(
    "condition",
    [
        Aggregate(of="mean", condition=co2("gt", 0)),
        CountReadings(test="eq", number=0.0, condition=co2("gt", 1000)),
        MeanKnown(reading="r", quantity="co2", percent=50.0, at_least=2),
        CompareSeries(of="mean", reading="r", than="other", quantity="co2", test="ne"),
    ],
)
def test_without_a_reading_neither_a_condition_nor_its_opposite_holds(condition: Condition) -> None:
    filled = series(400.0, 401.0, 402.0)
    for taken in ({}, {"r": series()}, {"r": series(30.0, quantity="canopy_temperature")}, {"other": filled}):
        assert truth(condition, **taken) is None
        assert truth(Not(condition=condition), **taken) is None
    assert truth(condition, r=filled, other=series(1.0)) is True


@given(st.lists(st.floats(350, 450), min_size=2, max_size=20), st.floats(0.1, 60))
def test_a_mean_is_known_once_its_confidence_interval_is_narrow(values: list[float], limit: float) -> None:
    known = MeanKnown(reading="r", quantity="co2", value=limit, unit="ppm", at_least=3)
    wanted = len(values) >= 3 and half_width(values) <= limit
    assert truth(known, r=series(*values)) == wanted


def test_the_interval_is_that_of_students_t() -> None:
    """Values of tables: t(0.975) of 4 degrees of freedom is 2.776."""
    assert half_width([1.0, 2.0, 3.0, 4.0, 5.0]) == pytest.approx(2.776 * math.sqrt(2.5 / 5), rel=1e-3)
    assert half_width([7.0]) == math.inf


def test_the_interval_holds_the_mean_as_often_as_it_says() -> None:
    rng = np.random.default_rng(3)
    samples = rng.normal(400.0, 25.0, size=(2000, 6))
    inside = [abs(sample.mean() - 400.0) <= half_width(sample.tolist()) for sample in samples]
    assert 0.93 < np.mean(inside) < 0.97


@pytest.mark.parametrize(
    ("condition", "why"),
    [
        (Aggregate(of="mean", condition=co2("gt", 430)), "mean CO₂ (of 3), 440 ppm, is above 430 ppm"),
        (
            Aggregate(of="median", condition=Level(reading="r", quantity="co2", level="high")),
            "median CO₂ (of 3), 430 ppm, is not high (above 500 ppm)",
        ),
        (
            CountReadings(test="gt", number=1.0, condition=co2("lt", 450)),
            "readings of CO₂: 2 of 3 below 450 ppm, which is above 1",
        ),
        (
            CountReadings(
                test="eq",
                number=100.0,
                percent=True,
                condition=Between(reading="r", quantity="co2", low=400, high=450, unit="ppm"),
            ),
            "readings of CO₂: 2 of 3 between 400 and 450 ppm, which is not exactly 100 %",
        ),
        (
            MeanKnown(reading="r", quantity="co2", percent=1.0),
            "readings of CO₂: 3 so far, and the mean needs at least 5",
        ),
    ],
)
def test_the_reason_has_the_values(condition: Condition, why: str) -> None:
    facts = ConditionInputs(site=SITE, robot=ROBOT, here=HERE, series={"r": series(430, 420, 470)})
    assert evaluate(condition, facts).why == why


# --- branches ---------------------------------------------------------------------------------------------------------


def read(**more: object) -> Act:
    return Act(id="", action="read_co2", reading="r", **more)


def decisions(plan: Node) -> set[tuple[bool, ...]]:
    """The decisions that are not certain, on each branch."""
    found = branches(task_for(plan), SITE, ROBOT)
    assert found.coverage != "sampled"
    return {tuple(d.answer for d in walk.decisions if not d.sure) for walk in found.walks}


def made(plan: Node) -> list[int]:
    """Captures on each branch, ascending."""
    walks = branches(task_for(plan), SITE, ROBOT).walks
    return sorted(sum(step.captures for step in walk.steps) for walk in walks)


def test_a_count_needs_as_many_readings() -> None:
    until = CountReadings(test="ge", number=3.0, condition=co2("gt", 450))
    six = UnionOf(parts=tuple(TreeIs(tree=tree.place.id) for tree in SITE.trees[:6]))
    assert made(ForEach(id="", select=six, body=read(), until=until)) == [3, 4, 5, 6, 6]


def test_a_mean_is_not_known_before_the_least_number_of_readings() -> None:
    until = MeanKnown(reading="r", quantity="co2", percent=5.0, at_least=4)
    assert made(ForEach(id="", select=Trees(), body=read(), until=until))[0] == 4
    assert made(Repeat(id="", times=9, body=read(), until=until)) == [4, 5, 6, 7, 8, 9, 9]
    assert made(Repeat(id="", times=30, body=read(), until=until)) == [4, 30]


def test_two_tests_of_one_mean_agree_and_those_of_another_need_not() -> None:
    above = Aggregate(of="mean", condition=co2("gt", 450))
    higher = Aggregate(of="mean", condition=co2("gt", 500))

    def tested(condition: Condition) -> If:
        return If(id="", condition=condition, then=read())

    both = InOrder(id="", steps=(read(count=3), tested(above), tested(above)))
    # The first test, if it holds, is followed by another reading, which changes the mean.
    assert decisions(both) == {(True, True), (True, False), (False,)}
    quiet = If(id="", condition=above, then=Act(id="", action="take_thermal_picture"))
    assert decisions(InOrder(id="", steps=(read(count=3), quiet, quiet))) == {(True,), (False,)}
    ordered = InOrder(
        id="", steps=(read(count=3), quiet, If(id="", condition=higher, then=Act(id="", action="take_thermal_picture")))
    )
    assert decisions(ordered) == {(True, True), (True, False), (False,)}


def test_a_series_that_begins_anew_is_empty() -> None:
    fresh = ForEach(id="", select=TreeIs(tree="r0c0"), body=Act(id="", action="take_thermal_picture"), collects="r")
    test = If(id="", condition=Aggregate(of="mean", condition=co2("gt", 450)), then=read())
    walks = branches(task_for(InOrder(id="", steps=(read(), fresh, test))), SITE, ROBOT).walks
    assert [[d.answer for d in walk.decisions] for walk in walks] == [[False]]
    assert walks[0].unread == ((walks[0].decisions[0].node, "r"),)


# --- how many readings a mean takes -----------------------------------------------------------------------------------


@pytest.mark.parametrize("percent", [1.0, 3.0, 8.0])
def test_the_number_of_readings_is_that_of_simulated_missions(percent: float) -> None:
    """The mean is known from n on, as the loop of a mission with the profile's readings finds it."""
    until = MeanKnown(reading="r", quantity="co2", percent=percent, at_least=4)
    task = task_for(Repeat(id="", times=40, body=read(), until=until))
    (forecast,) = estimate(task, SITE, ROBOT).sampling
    quantity, rng = ROBOT.quantity["co2"], np.random.default_rng(11)
    counts = []
    for _ in range(300):
        values: list[float] = []
        while len(values) < 40 and (not values or truth(until, r=series(*values)) is not True):
            values.append(float(rng.normal(quantity.typical, quantity.spread)))
        counts.append(len(values))
    assert forecast.at_most == 40
    assert forecast.mean == pytest.approx(np.mean(counts), rel=0.08)
    assert 4 <= forecast.p50 <= forecast.p90 <= 40
    assert forecast.p50 == pytest.approx(np.median(counts), abs=1.5)


def test_a_loop_without_a_mean_to_know_has_no_forecast_of_readings() -> None:
    until = CountReadings(test="ge", number=3.0, condition=co2("gt", 450))
    assert estimate(task_for(Repeat(id="", times=9, body=read(), until=until)), SITE, ROBOT).sampling == ()
