"""A battery that goes bad in the middle of a drive is seen over ROS 2, too: by what its topic says on the way."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from fieldhand.evaluation.battery_drain import BatteryDrain
from fieldhand.evaluation.failsafe import BudgetFailsafe
from fieldhand.execution.drivers.simulation.world import BatteryDrains, World
from fieldhand.execution.guard import NoGuard
from fieldhand.execution.mission_runner import run
from fieldhand.places.selectors import TreeIs
from fieldhand.robot.model import RobotProfile
from fieldhand.task.plan import Act
from fieldhand.task.results import Acted, Ended, LimitCrossed
from ros2.simulated_robot_rig import SITE
from ros2.test_simulated_robot_contract import OverSimulatedRobot
from support.missions.rig import authorized, husky, of_type, task_for


def small_battery() -> RobotProfile:
    robot = husky()
    return replace(robot, energy=replace(robot.energy, capacity_j=0.12 * robot.energy.capacity_j))


class SmallBattery(OverSimulatedRobot):
    """A robot of which a short drive empties much."""

    robot: ClassVar[RobotProfile] = small_battery()


def test_a_drive_is_broken_off_by_what_the_battery_topic_says_on_the_way() -> None:
    small = SmallBattery()
    robot = small.robot
    world = World(charge_percent=36.0, meter_step_percent=1.0, faults=(BatteryDrains(factor=6.0, from_s=10.0),))
    driver, clock, _ = small.make_in(world)
    task = task_for(Act(id="", action="read_co2", at=TreeIs(tree="r3c4")))
    events = run(
        authorized(task, SITE, robot),
        site=SITE,
        robot=robot,
        driver=driver,
        guard=NoGuard(),
        clock=clock,
        emit=lambda event: None,
        failsafe=BudgetFailsafe(task, robot, BatteryDrain(robot)),
    ).events
    levels = [e.level for e in of_type(events, LimitCrossed)]
    assert levels[0] == "warn"
    assert len(levels) == len(set(levels))
    turned = next(e for e in of_type(events, LimitCrossed) if e.then != "go_on")
    assert turned.travelled_m > 0.0
    assert not of_type(events, Acted)
    end = events[-1]
    assert isinstance(end, Ended)
    assert end.status != "completed"
    assert end.reason
