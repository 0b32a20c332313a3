"""A path that comes back to where it ends is followed in parts, so that no goal checker ends it before."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Point
from shapely.ops import substring

from fieldhand.execution.drivers.ros2.path_parts import parts
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.task.nodes.work_along import WorkAlong
from fieldhand.task.results import Worked
from ros2.test_working import Field, robot_with
from support.examples import examples
from support.missions.rig import of_type
from support.missions.working import along

THROUGH = "nav2_msgs/action/NavigateThroughPoses"
SQUARE = ((0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0))
LATTICE = st.tuples(st.integers(0, 5), st.integers(0, 5)).map(lambda xy: (4.0 * xy[0], 4.0 * xy[1]))


def metres(path: list[tuple[float, float]]) -> float:
    return sum(math.dist(a, b) for a, b in itertools.pairwise(path))


@given(st.lists(LATTICE, min_size=2, max_size=12), st.floats(0.1, 1.0))
@settings(max_examples=examples(150, thorough=2000))
def test_parts_are_the_whole_path_and_none_comes_near_its_end_before(path, near_m: float) -> None:
    path = [path[0], *(b for a, b in itertools.pairwise(path) if a != b)]
    if len(path) < 2:
        return
    found = parts(path, near_m)
    assert (found[0][0], found[-1][1]) == (0, len(path) - 1)
    assert all(a[1] == b[0] for a, b in itertools.pairwise(found))
    assert all(first < last for first, last in found)
    for first, last in found:
        part = path[first : last + 1]
        length = metres(part)
        early = substring(LineString(part), 0.0, max(0.0, length - 4.0))  # its last leg has 4 m at least
        if len(part) > 2 and early.length > 0.0:
            assert early.distance(Point(part[-1])) > near_m


def test_a_path_that_goes_on_is_one_part() -> None:
    assert parts(SQUARE[:-1], 0.5) == [(0, 3)]
    assert parts(((0.0, 0.0), (9.0, 0.0)), 0.5) == [(0, 1)]
    assert parts(((0.0, 0.0), (0.0, 0.0)), 0.5) == [(0, 1)]


def test_a_circuit_is_divided_in_its_middle() -> None:
    assert parts(SQUARE, 0.5) == [(0, 2), (2, 4)]
    assert parts((*SQUARE, *SQUARE[1:]), 0.5) == [(0, 2), (2, 4), (4, 6), (6, 8)]
    assert parts(((0.0, 0.0), (9.0, 0.0), (0.0, 0.0)), 0.5) == [(0, 1), (1, 2)]


@pytest.mark.parametrize("navigation", [{}, {"working": THROUGH, "working_action": "drive_through"}])
def test_work_round_an_area_is_done_with_a_goal_checker_that_knows_only_the_distance(navigation) -> None:
    field = Field(robot_with(**navigation), World(goal_tolerance_m=0.25))
    result = field.fly(WorkAlong(action="spray", along=along("r1", "r2").along, mode="perimeter"))
    assert result.status == "completed", result.reason
    (worked,) = of_type(result.events, Worked)
    assert worked.status == "success"
    assert worked.leg_m == pytest.approx(worked.worked_m, abs=1.0)
    assert field.switched("spray") == ["on", "off"]
