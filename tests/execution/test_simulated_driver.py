"""The simulated robot keeps the driver's contract, and its costs are those of the profile."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fieldhand.clock import Clock, SimulatedClock
from fieldhand.execution.drivers.protocol import ActionGoal, Driver
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import (
    ActionFails,
    BatteryDrains,
    Blocked,
    LocalisationLost,
    RobotStops,
    TreeRef,
    World,
)
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.testing.driver_contract import DriverContract, drive_goal, finish
from support.missions.rig import husky, orchard

SITE = orchard()
FAR = SITE.trees[-1].place
LENGTH = math.dist(SITE.start.xy, FAR.xy)


def driver_of(
    world: World | None = None, robot: RobotProfile | None = None, seed: int = 0
) -> tuple[SimulatedDriver, SimulatedClock]:
    clock = SimulatedClock()
    rng = np.random.default_rng(seed)
    return SimulatedDriver(SITE, robot or husky(), world or World(), clock, rng), clock


class TestSimulatedDriver(DriverContract):
    def make(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(World())

    def make_blocked(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(World(faults=(Blocked(at=TreeRef(id=FAR.id), within_m=2.0),)))

    def make_lost(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(World(faults=(LocalisationLost(at_s=3.0, for_s=20.0),)))

    def make_broken(self) -> tuple[Driver, Clock, Site]:
        return self.make_in(World(faults=(ActionFails(action=self.action),)))

    def make_in(self, world: World) -> tuple[Driver, Clock, Site]:
        return (*driver_of(world, robot=husky(alpha=0.5)), SITE)


def test_a_drive_without_chance_takes_exactly_what_the_profile_says() -> None:
    driver, clock = driver_of(World(charge_percent=80))
    robot = husky()
    driver.start_drive(drive_goal(SITE.start, FAR, speed_m_s=0.5))
    progress = finish(driver, clock)
    assert progress.metres == pytest.approx(LENGTH)
    assert progress.seconds == clock.now() == pytest.approx(LENGTH / 0.5)
    assert 80 - driver.charge_percent() == pytest.approx(robot.percent(LENGTH, LENGTH / 0.5))


def test_an_action_takes_what_the_profile_says() -> None:
    driver, clock = driver_of()
    action = husky().action["read_co2"]
    driver.start_action(ActionGoal(action="read_co2", place=FAR))
    progress = finish(driver, clock)
    assert (progress.metres, progress.seconds) == (0.0, pytest.approx(action.duration_s))
    used = husky().percent(0.0, action.duration_s, action.energy_j)
    assert 100 - driver.charge_percent() == pytest.approx(used)


def test_leg_costs_follow_the_published_model() -> None:
    """d * (alpha + Exp(1 - alpha)): never below alpha * d, mean d, standard deviation (1 - alpha) * d."""
    costs = []
    for seed in range(600):
        driver, clock = driver_of(robot=husky(alpha=0.5), seed=seed)
        driver.start_drive(drive_goal(SITE.start, FAR))
        costs.append(finish(driver, clock).metres / LENGTH)
    assert min(costs) >= 0.5
    assert abs(np.mean(costs) - 1) < 5 * 0.5 / math.sqrt(600)
    assert 0.4 < np.std(costs) < 0.6


def test_the_same_seed_drives_the_same() -> None:
    def metres(seed: int) -> float:
        driver, clock = driver_of(robot=husky(alpha=0.2), seed=seed)
        driver.start_drive(drive_goal(SITE.start, FAR))
        return finish(driver, clock).metres

    assert metres(3) == metres(3) != metres(4)
    assert driver_of(seed=3)[0].seed == 3


def test_a_blocked_leg_fails_where_the_obstacle_is() -> None:
    driver, clock = driver_of(World(faults=(Blocked(at=TreeRef(id=FAR.id), within_m=2.0, times=1),)))
    driver.start_drive(drive_goal(SITE.start, FAR))
    progress = finish(driver, clock)
    assert progress.state == "failed"
    assert FAR.id in progress.what
    assert progress.metres == pytest.approx(LENGTH - 2.0)
    here = driver.position()
    assert math.dist((here.x, here.y), FAR.xy) == pytest.approx(2.0)
    driver.start_drive(drive_goal(SITE.start, FAR))
    assert finish(driver, clock).state == "succeeded"


def test_a_battery_that_drains_faster_drains_by_the_factor() -> None:
    fine, clock = driver_of()
    poor, later = driver_of(World(faults=(BatteryDrains(factor=3.0),)))
    for driver, time in ((fine, clock), (poor, later)):
        driver.start_drive(drive_goal(SITE.start, FAR))
        finish(driver, time)
    assert 100 - poor.charge_percent() == pytest.approx(3 * (100 - fine.charge_percent()))


def test_an_empty_battery_ends_the_drive_on_the_way_and_every_goal_after_it() -> None:
    needed = husky().percent(LENGTH, LENGTH)
    driver, clock = driver_of(World(charge_percent=needed / 4))
    driver.start_drive(drive_goal(SITE.start, FAR))
    progress = finish(driver, clock)
    assert (progress.state, progress.what) == ("failed", "the battery is empty")
    assert progress.metres == pytest.approx(LENGTH / 4)
    assert driver.charge_percent() == pytest.approx(0.0, abs=1e-9)
    driver.start_action(ActionGoal(action="read_co2", place=FAR))
    assert finish(driver, clock).state == "failed"


def test_a_power_cut_ends_the_goal_in_hand_at_its_second() -> None:
    driver, clock = driver_of(World(faults=(RobotStops(at_s=5.0, why="power cut"),)))
    driver.start_drive(drive_goal(SITE.start, FAR))
    progress = finish(driver, clock)
    assert (progress.state, progress.what) == ("cancelled", "power cut")
    assert clock.now() == pytest.approx(5.0)
    assert progress.metres == pytest.approx(5.0)
    assert driver.stopped() == "power cut"


def test_waiting_empties_the_battery_by_the_idle_power() -> None:
    driver, clock = driver_of()
    clock.advance(3600)
    assert 100 - driver.charge_percent() == pytest.approx(husky().percent(0.0, 3600))


def test_a_profile_with_other_costs_is_followed() -> None:
    robot = replace(husky(), energy=replace(husky().energy, idle_w=0.0, drive_j_per_m=1000.0))
    driver, clock = driver_of(robot=robot)
    driver.start_drive(drive_goal(SITE.start, FAR))
    finish(driver, clock)
    assert 100 - driver.charge_percent() == pytest.approx(100 * 1000 * LENGTH / robot.energy.capacity_j)
