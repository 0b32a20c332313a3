"""The levels of a battery follow from the reserve unless the profile says them, and always lie one above the other."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.errors import ProfileError
from fieldhand.mission import review
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.loader import load_robot, parse_profile, profile_bytes
from fieldhand.site.loader import open_site
from fieldhand.task.build import make_task
from fieldhand.task.frames import Constraints
from fieldhand.task.plan import Act

PERCENT = st.floats(0.0, 99.0)


def profile(**keys: float) -> str:
    text = profile_bytes("husky")[0].decode()
    lines = "".join(f"  {key}: {value}\n" for key, value in keys.items())
    return text.replace("  reserve_percent: 20", f"{lines}  reserve_percent: 20")


@settings(deadline=None)
@given(reserve=PERCENT, warn=st.none() | PERCENT, home=st.none() | PERCENT)
def test_a_mission_warns_before_it_turns_home_and_turns_home_before_it_stops(reserve, warn, home):
    energy = replace(load_robot("husky").energy, warn_percent=warn, return_percent=home)
    levels = energy.levels(reserve)
    assert 0.0 <= levels.stop <= levels.home <= levels.warn <= 100.0
    assert levels.home >= reserve
    assert levels.stop < levels.home or reserve == 0.0


def test_what_a_profile_leaves_out_follows_from_the_reserve():
    levels = load_robot("husky").energy.levels(20.0)
    assert (levels.warn, levels.home, levels.stop) == (30.0, 20.0, 10.0)


def test_what_a_profile_says_counts():
    robot = parse_profile(profile(warn_percent=45, return_percent=25, stop_percent=8).encode())
    assert robot.energy.levels(20.0) == robot.energy.levels(10.0)
    levels = robot.energy.levels(30.0)  # a Task that keeps more
    assert (levels.warn, levels.home, levels.stop) == (45.0, 30.0, 8.0)


@pytest.mark.parametrize(("reserve", "refused"), [(5.0, True), (8.0, True), (9.0, False), (None, False)])
def test_a_task_that_leaves_less_than_the_robot_stops_at_is_not_approved(reserve, refused):
    robot, site = parse_profile(profile(stop_percent=8).encode()), open_site("demo")
    plan = Act(id="", action="read_co2", at=TreeIs(tree="12"))
    constraints = Constraints(reserve_percent=reserve)
    found = review(make_task(request="", plan=plan, measures={}, constraints=constraints), site, robot)
    said = [p.what for p in found.errors if "stops on the spot at 8 %" in p.what]
    assert bool(said) == refused


@pytest.mark.parametrize(
    ("keys", "what"),
    [
        ({"return_percent": 15}, "return_percent 15 is below reserve_percent 20"),
        ({"warn_percent": 19}, "warn_percent 19 is below the charge at which the robot turns home (20)"),
        ({"warn_percent": 24, "return_percent": 25}, "warn_percent 24 is below"),
        ({"stop_percent": 20}, "stop_percent 20 is not below reserve_percent 20"),
        ({"stop_percent": -1}, "must be greater than or equal to 0"),
        ({"warn_percent": 101}, "must be less than or equal to 100"),
    ],
)
def test_levels_that_cannot_be_kept_are_refused(keys, what):
    with pytest.raises(ProfileError) as refused:
        parse_profile(profile(**keys).encode())
    assert what in str(refused.value)
