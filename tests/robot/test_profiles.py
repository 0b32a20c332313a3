"""The built-in robots can do what the product promises for them, and their figures hang together."""

from __future__ import annotations

import pytest

from fieldhand.robot.capabilities import capabilities_of, measures_of
from fieldhand.robot.loader import load_robot, robot_names
from fieldhand.robot.model import LevelThreshold
from fieldhand.task.capabilities import ChoiceParameter, NumberParameter


def test_husky_measures_what_the_design_says_and_knows_what_is_low():
    robot = load_robot("husky")
    assert measures_of(robot) == {
        "take_thermal_picture": (("canopy_temperature", "degC"),),
        "read_ambient_temperature": (("ambient_temperature", "degC"),),
        "read_co2": (("co2", "ppm"),),
    }
    low = {q.name: q.levels["low"] for q in robot.quantities}
    assert low == {
        "canopy_temperature": LevelThreshold(direction="below", value=33),
        "ambient_temperature": LevelThreshold(direction="below", value=30),
        "co2": LevelThreshold(direction="below", value=400),
    }


def test_amiga_measures_what_the_design_says():
    assert measures_of(load_robot("amiga")) == {
        "take_picture": (),
        "read_soil_moisture": (("soil_moisture", "percent"),),
        "read_soil_nitrate": (("soil_nitrate", "ppm"),),
        "sample_leaf": (),
    }


@pytest.mark.parametrize("name", robot_names())
def test_capabilities_say_the_same_as_the_profile(name):
    robot = load_robot(name)
    capabilities = capabilities_of(robot)
    assert list(capabilities.actions) == [a.name for a in robot.actions]
    for action in robot.actions:
        able = capabilities.actions[action.name]
        assert able.measures == action.measures
        for parameter in action.parameters:
            spec = able.parameters[parameter.name]
            if parameter.kind == "choice":
                assert spec == ChoiceParameter(choices=parameter.choices)
            else:
                bounds = NumberParameter(minimum=parameter.minimum, maximum=parameter.maximum, unit=parameter.unit)
                assert spec == bounds
    for quantity in robot.quantities:
        assert capabilities.quantities[quantity.name].unit == quantity.unit
        assert capabilities.quantities[quantity.name].levels == tuple(quantity.levels)


@pytest.mark.parametrize("name", robot_names())
def test_a_battery_lasts_hours_of_driving(name):
    robot = load_robot(name)
    hours = 100 / robot.percent(metres=3600 * robot.speed_m_s, seconds=3600)
    assert 2 < hours < 12


@pytest.mark.parametrize("name", robot_names())
def test_low_is_below_high_and_an_ordinary_reading_can_be_neither(name):
    for quantity in load_robot(name).quantities:
        if not quantity.levels:
            continue
        low, high = quantity.levels["low"].value, quantity.levels["high"].value
        assert low < high
        assert low <= quantity.typical + quantity.spread
        assert quantity.typical <= high


@pytest.mark.parametrize("name", robot_names())
def test_no_two_actions_share_a_word(name):
    words = [word for action in load_robot(name).actions for word in action.words]
    assert len(words) == len(set(words))
