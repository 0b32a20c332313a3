"""A robot that stops within Nav2's goal tolerance, and whose position drifts, over real DDS in another process."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
import yaml

from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import Result, run
from fieldhand.robot.loader import load_robot, profile_bytes
from fieldhand.task.results import Acted, Arrived, Ended, Faulted, Strayed
from ros2.robot_in_process import connected_simulated_robot
from ros2.test_shared_navigation_over_dds import SITE, TICK_S, TREES, visited, visits
from support.missions.rig import authorized, of_type, task_for

pytest.importorskip("cyclonedds")


def profile(folder: Path) -> str:
    """Write the profile of the built-in robot that drives corner by corner, and must stay near its way."""
    values = yaml.safe_load(profile_bytes("husky")[0])
    values["corridor_m"] = 1.0
    values["leg_cost"]["alpha"] = 1.0  # so that metres can be compared
    values["ros2"]["actions"] = {name: values["ros2"]["actions"][name] for name in ("read_ambient_temperature",)}
    path = folder / "husky.yaml"
    path.write_text(yaml.safe_dump(values, sort_keys=False))
    return str(path)


def flown(folder: Path, **world: Any) -> tuple[Result, dict[str, Any]]:
    """A mission over DDS in a world; also return the robot's state at its end."""
    robot, task = profile(folder), task_for(visits(*TREES))
    with connected_simulated_robot("demo", robot, task, seed=0, tick_s=TICK_S, world=world) as (vehicle, far):
        known = load_robot(robot)
        result = run(
            authorized(task, SITE, known),
            site=SITE,
            robot=known,
            driver=vehicle.driver,
            guard=NoGuard(),
            clock=vehicle.clock,
            emit=lambda _: None,
        )
        return result, far.state


def metres(result: Result) -> float:
    (ended,) = of_type(result.events, Ended)
    return ended.travelled_m


def test_a_mission_completes_within_tolerance_and_with_drift(tmp_path: Path) -> None:
    exact, before = flown(tmp_path)
    size = {"drift_m_per_100_m": 1.0, "toward_deg": 90.0, "noise_m": 0.02}
    near, state = flown(tmp_path, goal_tolerance_m=0.25, localisation=size)
    assert (near.status, visited(near)) == ("completed", list(TREES)), near.reason
    assert not of_type(near.events, Strayed)
    assert math.dist(before["xy"], before["believes"]) < 1e-6
    # Each leg is shorter by at most the tolerance at its end; a stop is cut off, and the next begins there.
    assert 0.9 * metres(exact) < metres(near) < metres(exact)
    believed, true = state["believes"], state["xy"]
    assert believed[0] - true[0] == pytest.approx(state["driven_m"] / 100.0, rel=0.01)
    assert believed[1] - true[1] == pytest.approx(0.0, abs=1e-6)
    stands = {(e.kind, e.place): SITE.projection.metres(e.lat, e.lon)[0] for e in of_type(exact.events, Arrived)}
    for arrived in of_type(near.events, Arrived):
        at = SITE.projection.metres(arrived.lat, arrived.lon)[0]
        assert math.dist(at, stands[arrived.kind, arrived.place]) <= 0.25 + 0.1  # as it believes, with noise
    assert all(acted.status == "success" for acted in of_type(near.events, Acted))


def test_drift_beyond_the_corridor_is_an_event_then_a_stop(tmp_path: Path) -> None:
    size = {"drift_m_per_100_m": 10.0, "toward_deg": 0.0, "fix_drifts": False}
    result, state = flown(tmp_path, localisation=size)
    strayed, faults = of_type(result.events, Strayed), of_type(result.events, Faulted)
    assert result.status == "faulted"
    assert strayed
    assert all(1.0 < s.away_m < 3.0 for s in strayed)
    assert "left the approved way by" in faults[0].what
    assert state["ends"][-1][1] == "cancelled"
    assert math.dist(state["believes"], state["xy"]) == pytest.approx(state["driven_m"] / 10.0, rel=0.01)
