"""Carry an approved mission out: in simulation, or on a robot."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.errors import NotApprovedError
from fieldhand.mission.approve import ApprovedMission
from fieldhand.mission.run import Run
from fieldhand.mission.seeds import checked_seed
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.earlier import site_of_run

if TYPE_CHECKING:
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.guard import Guard
    from fieldhand.execution.journal.records import InputLog
    from fieldhand.execution.operator_commands import OperatorCommand
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.task.results import Event


def _ignore(_: Event) -> None:
    """Do nothing with an event; the run contains it."""


def check_world(world: World, site: Site, robot: RobotProfile) -> None:
    """Require that a simulated world fits the site and the robot.

    Raises:
        WorldError: It names a tree, a quantity or an action that does not exist.
    """
    from fieldhand.execution.drivers.simulation.ground_truth import GroundTruth

    GroundTruth(world, site, robot, seed=0)


def read_world(path: Path | None, site: Site, robot: RobotProfile) -> World:
    """Read the world of a simulation, and check that it fits the site and the robot.

    Args:
        path: World file (YAML); None for a world in which nothing fails.
        site: Site of the mission.
        robot: Robot of the mission.

    Raises:
        WorldError: The file cannot be read, or names a tree, a quantity or an action that does not exist.
    """
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.drivers.simulation.world_file import load_world

    world = World() if path is None else load_world(path)
    check_world(world, site, robot)
    return world


def carry_out(
    mission: ApprovedMission,
    *,
    vehicle: Vehicle,
    seed: int = 0,
    emit: Callable[[Event], None] = _ignore,
    interrupted: Callable[[], str | None] = lambda: None,
    watched: Callable[[Guard], Guard] = lambda guard: guard,
    orders: Callable[[], OperatorCommand | None] = lambda: None,
    log: InputLog | None = None,
    images: Path | None = None,
) -> Run:
    """Carry a mission out on a vehicle, and return what happened.

    :mod:`fieldhand.missions` does the same with a journal on disk, so that the mission survives a power cut.

    Args:
        mission: The approved mission.
        vehicle: Connection to the robot, or a simulation.
        seed: Seed of the budget guard's random draws.
        emit: Called with each event as it happens.
        interrupted: Called at every tick; returns a reason to end the mission, or None.
        watched: Wraps the budget guard, for example to time its decisions.
        orders: Returns an operator command that has not been carried out yet, or None.
        log: Records every external input, so that the mission can be resumed.
        images: Folder in which the images of captures are saved; None to save none.

    Raises:
        NotApprovedError: The Task was approved for another site or robot than that of the vehicle.
        InputError: The seed is negative, or not a whole number.
    """
    from fieldhand.evaluation.budget_guard import BudgetGuard
    from fieldhand.evaluation.failsafe import BudgetFailsafe
    from fieldhand.execution.images.folder import ImageFolder
    from fieldhand.execution.mission_runner import run
    from fieldhand.forecast.visit_order import drives_for

    seed = checked_seed(seed)
    robot, task = mission.robot, mission.task
    site = site_of_run(task, mission.site)
    if vehicle.robot is not None and vehicle.robot.sha256 != robot.sha256:
        raise NotApprovedError(
            f"the mission was approved for {robot.name}, the vehicle is {vehicle.robot.name} or has another profile",
            advice="connect with the profile that the mission was approved for",
        )
    guard = BudgetGuard(
        task, site, robot, drives_for(site, robot, task.constraints), seed, charge_percent=vehicle.charge_percent
    )
    result = run(
        mission.authorized,
        site=site,
        robot=robot,
        driver=vehicle.driver,
        guard=watched(guard),
        failsafe=BudgetFailsafe(task, robot, guard.drain),
        clock=vehicle.clock,
        emit=vehicle.disk(emit),
        interrupted=interrupted,
        wall=vehicle.wall,
        orders=orders,
        log=log,
        simulated=vehicle.simulated,
        images=None if images is None else ImageFolder.of(images, task.id, robot),
    )
    return Run(mission=mission, result=result, images=images)


def simulate(
    mission: ApprovedMission,
    *,
    world: World | None = None,
    seed: int = 0,
    speed: float | None = None,
    emit: Callable[[Event], None] = _ignore,
    interrupted: Callable[[], str | None] = lambda: None,
    watched: Callable[[Guard], Guard] = lambda guard: guard,
) -> Run:
    """Carry a mission out in simulation. The same seed gives the same events.

    Args:
        mission: The approved mission.
        world: Readings of the sensors, faults, and charge at the start; by default nothing fails.
        seed: Seed of everything random: drives, readings, decisions of the budget guard.
        speed: Simulated seconds per second; None for as fast as possible.
        emit: As for :func:`carry_out`.
        interrupted: As for :func:`carry_out`.
        watched: As for :func:`carry_out`.

    Raises:
        WorldError: The world does not fit the site or the robot.
        InputError: The seed is negative, or not a whole number.
    """
    from fieldhand.execution.drivers.simulation.vehicle import simulation
    from fieldhand.execution.drivers.simulation.world import World

    seed = checked_seed(seed)
    vehicle = simulation(mission.site, mission.robot, world or World(), seed=seed, speed=speed)
    return carry_out(mission, vehicle=vehicle, seed=seed, emit=emit, interrupted=interrupted, watched=watched)
