"""A simulated robot on ROS 2 in a world with a goal tolerance, a position that drifts, and fixes with noise."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.execution.drivers.ros2.simulated_robot.state_file import Identity, read_state, write_state
from fieldhand.execution.drivers.simulation.world import Localisation, World
from ros2.simulated_robot_rig import SITE, SimulatedRobotRig, pose, reached_by
from ros2.test_simulated_robot import GPS, START, THROUGH, TO_POSE, length
from support.examples import examples
from support.missions.rig import husky

FOLLOW = "nav2_msgs/action/FollowPath"
WAY = ((10.0, -3.0), (10.0, 2.5), (2.5, 2.5))
TOLERANCE_M = 0.25
IDENTITY = Identity(site="a", robot="b", world="c")


def rig_in(world: World, kind: str = TO_POSE, **more: object) -> SimulatedRobotRig:
    from_ll = "" if kind == GPS else "fromLL"
    robot = reached_by(husky(), distro="jazzy", type=kind, from_ll=from_ll)
    return SimulatedRobotRig(world=world, robot=robot, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", [THROUGH, GPS, TO_POSE])
def test_each_goal_ends_within_the_tolerance_and_the_next_begins_there(kind: str) -> None:
    rig = rig_in(World(goal_tolerance_m=TOLERANCE_M), kind)
    goals = [(corner,) for corner in WAY] if kind == TO_POSE else [WAY]
    for corners in goals:
        assert rig.drive(*corners).how == "succeeded"
        assert math.dist(rig.here(), corners[-1]) == pytest.approx(TOLERANCE_M, abs=1e-6)
        if kind == THROUGH:
            assert rig.navigation.feedback["distance_remaining"] == pytest.approx(TOLERANCE_M, abs=1e-6)
    metres = sum(said.metres for said in rig.said)
    exact = length(START, *WAY)
    assert exact - 2 * TOLERANCE_M * len(goals) < metres <= exact - TOLERANCE_M + 1e-6
    # Where it already is, it only turns.
    assert rig.drive(WAY[-1]).how == "succeeded"
    assert rig.said[-1].metres == pytest.approx(0.0, abs=1e-6)


def test_a_path_is_followed_from_where_it_is_nearest() -> None:
    rig = rig_in(World(goal_tolerance_m=TOLERANCE_M))
    follow = rig.action("follow_path", FOLLOW)
    there = [(-5.0 + 0.25 * k, -0.4) for k in range(-4, 41)]  # begins a metre behind it, and beside it
    points = [rig.in_map(*map(float, SITE.projection.degrees([point])[0])) for point in there]
    follow.start({"path": {"header": {"frame_id": "map"}, "poses": tuple(pose(*point) for point in points)}})
    assert rig.finish(follow).how == "succeeded"
    assert rig.said[-1].metres == pytest.approx(math.dist(START, there[4]) + 10.0 - TOLERANCE_M, abs=0.3)


@settings(max_examples=examples(6, thorough=60), deadline=None)
@given(drift=st.floats(0.0, 5.0), toward=st.floats(0.0, 359.0), noise=st.sampled_from([0.0, 0.05]), shown=st.booleans())
def test_goals_are_reached_as_it_believes_and_fixes_show_what_the_world_says(
    drift: float, toward: float, noise: float, shown: bool
) -> None:
    size = Localisation(drift_m_per_100_m=drift, toward_deg=toward, noise_m=noise, fix_drifts=shown)
    rig = rig_in(World(localisation=size))
    for corner in WAY:
        assert rig.drive(corner).how == "succeeded"
    driven = sum(said.metres for said in rig.said)
    off = drift * driven / 100.0
    assert rig.said[-1].off_m == pytest.approx(off, abs=1e-6)
    assert math.dist(rig.here(), WAY[-1]) <= (0.0 if shown else off) + 8 * noise + 1e-6
    if not shown and not noise:
        assert math.dist(rig.here(), WAY[-1]) == pytest.approx(off, abs=1e-6)
    fix = rig.heard("gps/fix", "sensor_msgs/msg/NavSatFix", seconds=0.3)[-1]
    assert math.sqrt(fix["position_covariance"][0]) == pytest.approx(max(0.01, noise))


def test_a_robot_that_is_switched_on_again_believes_what_it_did(tmp_path: Path) -> None:
    world = World(goal_tolerance_m=TOLERANCE_M, localisation=Localisation(drift_m_per_100_m=5.0))
    whole, first = rig_in(world), rig_in(world)
    for rig in (whole, first):
        rig.drive(WAY[0])
    write_state(tmp_path / "state.json", first.simulated.state(), IDENTITY)
    second = rig_in(world, seed=1, state=read_state(tmp_path / "state.json", IDENTITY))
    for rig in (whole, second):
        rig.drive(WAY[1])
    assert second.simulated.platform.position.xy == pytest.approx(whole.simulated.platform.position.xy, abs=1e-6)
    assert second.simulated.platform.true_position.xy == pytest.approx(
        whole.simulated.platform.true_position.xy, abs=1e-6
    )
    assert second.said[-1].off_m == pytest.approx(whole.said[-1].off_m, abs=1e-6)
    assert second.said[-1].off_m > 0.1
