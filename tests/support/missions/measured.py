"""Event logs of missions that a robot with known figures drove: what a calibration has to find again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fieldhand.clock import SimulatedClock
from fieldhand.execution.drivers.protocol import ActionGoal, DriveGoal
from fieldhand.execution.drivers.simulation.driver import SimulatedDriver
from fieldhand.execution.drivers.simulation.world import World
from fieldhand.robot.model import LegCost
from fieldhand.task.results import Acted, Arrived, Driving, Ended, Started
from fieldhand.testing.small_orchard import husky, orchard

SITE, PROFILE = orchard(), husky()
#: As it really is: slower, hungrier, more even than its profile says.
TRUE = replace(
    PROFILE,
    speed_m_s=0.8,
    energy=replace(PROFILE.energy, drive_j_per_m=130.0, idle_w=75.0),
    leg_cost=LegCost(alpha=0.7),
    actions=tuple(replace(a, duration_s=11.0, energy_j=900.0) for a in PROFILE.actions),
)


def mission(seed, stops=30, speeds=(0.8,), robot=TRUE):
    """The log of a mission that the simulated robot drives: to a tree and a capture, again and again.

    It is told to drive at 1 m/s, or half of that; ``speeds`` are what it does then.
    """
    clock = SimulatedClock()
    driver = SimulatedDriver(SITE, robot, World(), clock, np.random.default_rng(seed))
    rng = np.random.default_rng(seed)
    travelled, position = 0.0, driver.position()
    events = [
        Started(
            t=0, task="t", robot=robot.name, site="o", lat=0, lon=0, charge_percent=driver.charge_percent(), seed=seed
        )
    ]
    for k in range(stops):
        place = SITE.trees[int(rng.integers(len(SITE.trees)))].place
        length, speed = float(rng.uniform(2, 40)), float(speeds[k % len(speeds)])
        path = ((position.x, position.y), (position.x + length, position.y))
        events.append(
            Driving(
                t=clock.now(),
                node="n",
                kind="tree",
                place=place.id,
                planned_m=length,
                path=(),
                speed_m_s=speed / robot.speed_m_s,
            )
        )
        driver.start_drive(DriveGoal(place=place, path_m=path, path_degrees=(), length_m=length, speed_m_s=speed))
        clock.advance(driver.next_event_in())
        metres = driver.poll().metres
        travelled += metres
        events.append(
            Arrived(
                t=clock.now(), node="n", kind="tree", place=place.id, lat=0, lon=0, leg_m=metres, travelled_m=travelled,
                charge_percent=driver.charge_percent(),
            )
        )  # fmt: skip
        driver.start_action(ActionGoal(action="take_thermal_picture", place=place, parameters={}))
        clock.advance(driver.next_event_in())
        driver.poll()
        events.append(
            Acted(
                t=clock.now(), node="n", action="take_thermal_picture", status="success", kind="tree", place=place.id,
                lat=0, lon=0, charge_percent=driver.charge_percent(),
            )
        )  # fmt: skip
    events.append(
        Ended(
            t=clock.now(),
            status="completed",
            lat=0,
            lon=0,
            travelled_m=travelled,
            charge_percent=driver.charge_percent(),
        )
    )
    return events
