"""Conditions: true, false or unknown, and a sentence that is true."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.forecast.conditions import ConditionInputs, evaluate
from fieldhand.task.conditions import AllOf, AnyOf, Between, Compare, Condition, Level, Not, TreeHas
from fieldhand.terms import Test, Value
from support.missions.rig import husky, orchard

SITE = orchard()
KERMAN = SITE.by_id["r0c1"].place
READINGS = {"r": {"co2": 390.0}}
TRUE = Compare(reading="r", quantity="co2", test="lt", value=400, unit="ppm")
FALSE = Compare(reading="r", quantity="co2", test="gt", value=400, unit="ppm")
UNKNOWN = Compare(reading="never", quantity="co2", test="gt", value=400, unit="ppm")


def finding(condition: Condition, **readings: float) -> tuple[bool | None, str]:
    given = {"r": readings} if readings else READINGS
    found = evaluate(condition, ConditionInputs(site=SITE, robot=husky(), here=KERMAN, readings=given))
    assert found.holds == (found.truth is True)
    return found.truth, found.why


@pytest.mark.parametrize(
    ("how", "at_399", "at_400", "at_401"),
    [
        ("lt", True, False, False),
        ("le", True, True, False),
        ("gt", False, False, True),
        ("ge", False, True, True),
        ("eq", False, True, False),
        ("ne", True, False, True),
    ],
)
def test_thresholds(how: Test, at_399: bool, at_400: bool, at_401: bool) -> None:
    condition = Compare(reading="r", quantity="co2", test=how, value=400, unit="ppm")
    assert [finding(condition, co2=v)[0] for v in (399, 400, 401)] == [at_399, at_400, at_401]


def test_between_includes_both_ends() -> None:
    condition = Between(reading="r", quantity="co2", low=390, high=410, unit="ppm")
    assert [finding(condition, co2=v)[0] for v in (389.9, 390, 400, 410, 410.1)] == [False, True, True, True, False]


def test_a_level_is_what_the_profile_says() -> None:
    low = Level(reading="r", quantity="co2", level="low")
    high = Level(reading="r", quantity="co2", level="high")
    assert [finding(low, co2=v)[0] for v in (399, 400)] == [True, False]
    assert [finding(high, co2=v)[0] for v in (500, 501)] == [False, True]
    assert finding(Level(reading="r", quantity="co2", level="purple"))[0] is None


def test_why_is_a_true_sentence() -> None:
    below = Compare(reading="r", quantity="canopy_temperature", test="lt", value=33, unit="degC")
    assert finding(below, canopy_temperature=31.2)[1] == "canopy temperature 31.2 °C is below 33 °C"
    assert finding(below, canopy_temperature=35)[1] == "canopy temperature 35 °C is not below 33 °C"
    assert finding(Level(reading="r", quantity="co2", level="low"))[1] == "CO₂ 390 ppm is low (below 400 ppm)"
    assert finding(UNKNOWN)[1] == "there is no reading of CO₂"


@pytest.mark.parametrize(
    ("attribute", "how", "value", "truth"),
    [
        ("variety", "eq", "kerman", True),
        ("variety", "eq", "Peters", False),
        ("variety", "ne", "Peters", True),
        ("Variety", "eq", "Kerman", True),
        ("reward", "ge", 1.0, True),
        ("reward", "gt", 1.0, False),
        ("variety", "lt", 3.0, None),
        ("reward", "gt", "abc", None),
        ("reward", "le", "1", True),
        ("variety", "eq", "no such variety", False),
        ("age", "lt", 3.0, None),
    ],
)
def test_what_the_site_says_of_the_tree(attribute: str, how: Test, value: Value, truth: bool | None) -> None:
    assert finding(TreeHas(attribute=attribute, test=how, value=value))[0] is truth


def test_the_opposite_of_a_comparison_that_cannot_be_made_does_not_hold() -> None:
    for one in (
        TreeHas(attribute="reward", test="gt", value="abc"),
        TreeHas(attribute="variety", test="lt", value=3.0),
    ):
        truth, why = finding(Not(condition=one))
        assert truth is None
        assert "cannot be compared with" in why


def test_a_marker_has_no_attributes() -> None:
    facts = ConditionInputs(site=SITE, robot=husky(), here=SITE.markers["end"])
    assert evaluate(TreeHas(attribute="variety", test="eq", value="Kerman"), facts).truth is None


conditions = st.recursive(
    st.sampled_from([(TRUE, True), (FALSE, False), (UNKNOWN, None)]),
    lambda inner: st.one_of(
        inner.map(lambda p: (Not(condition=p[0]), None if p[1] is None else not p[1])),
        st.lists(inner, min_size=1, max_size=3).map(
            lambda ps: (AllOf(conditions=tuple(p[0] for p in ps)), _least([p[1] for p in ps]))
        ),
        st.lists(inner, min_size=1, max_size=3).map(
            lambda ps: (AnyOf(conditions=tuple(p[0] for p in ps)), _most([p[1] for p in ps]))
        ),
    ),
    max_leaves=12,
)

_RANK = {False: 0, None: 1, True: 2}


def _least(truths: list[bool | None]) -> bool | None:
    return min(truths, key=_RANK.__getitem__)


def _most(truths: list[bool | None]) -> bool | None:
    return max(truths, key=_RANK.__getitem__)


@settings(max_examples=60, deadline=None)
@given(conditions)
def test_and_or_not_are_kleenes(pair: tuple[Condition, bool | None]) -> None:
    """False < unknown < true: all-of is the least, any-of the greatest, not turns it round."""
    condition, truth = pair
    found, why = finding(condition)
    assert found is truth
    assert why
