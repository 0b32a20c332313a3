"""A robot that leaves the way of a drive is stopped over ROS 2, too: by the fixes that it sends on the way."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from fieldhand.execution.drivers.simulation.world import RobotStrays, TreeRef, World
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import run
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.model import RobotProfile
from fieldhand.task.plan import Act
from fieldhand.task.results import Faulted, Strayed
from ros2.simulated_robot_rig import SITE
from ros2.test_simulated_robot_contract import OverSimulatedRobot
from support.missions.rig import authorized, captured, husky, of_type, task_for


class NarrowWay(OverSimulatedRobot):
    """A robot that must stay near the way of a drive."""

    robot: ClassVar[RobotProfile] = replace(husky(), corridor_m=2.0)


def test_a_drive_that_leaves_its_way_is_cancelled_and_tried_again() -> None:
    narrow = NarrowWay()
    driver, clock, _ = narrow.make_in(World(faults=(RobotStrays(by_m=4.0, at=TreeRef(id="r0c4"), times=1),)))
    events = run(
        authorized(task_for(Act(action="read_co2", at=TreeIs(tree="r0c4"))), SITE, narrow.robot),
        site=SITE,
        robot=narrow.robot,
        driver=driver,
        guard=NoGuard(),
        clock=clock,
        emit=lambda event: None,
    ).events
    (strayed,), (fault,) = of_type(events, Strayed), of_type(events, Faulted)
    assert 2.0 < strayed.away_m <= 4.0
    assert fault.handled
    assert f"left the approved way by {strayed.away_m:.1f} m" in fault.what
    assert captured(events) == [("read_co2", "r0c4")]
