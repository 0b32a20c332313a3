"""On what a mission is carried out: the options that say it, and the robot that is reached by them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, get_args

import typer

from fieldhand.errors import InputError
from fieldhand.execution.drivers.ros2.domain import MOST_DOMAIN
from fieldhand.language import ENGLISH, Language, Number, message

if TYPE_CHECKING:
    from fieldhand.cli.approving import Consent
    from fieldhand.cli.inputs import Ground
    from fieldhand.execution.vehicle import Connection, Vehicle
    from fieldhand.mission import Review
    from fieldhand.missions import Departure
    from fieldhand.task.frames import Task

SIMULATION = "simulation"

OnOption = Annotated[
    str | None,
    typer.Option(
        "--on",
        metavar="simulation|dds|rclpy",
        help="On what: the simulation (default), or the robot over ROS 2: dds needs no ROS here, rclpy does.",
    ),
]
DomainOption = Annotated[
    int | None,
    typer.Option("--domain", min=0, max=MOST_DOMAIN, help="ROS domain of the robot; else ROS_DOMAIN_ID, else 0."),
]
NamespaceOption = Annotated[
    str | None, typer.Option("--namespace", help="Of the robot's names in ROS, in place of the profile's; / for none.")
]
SimTimeOption = Annotated[
    bool, typer.Option("--sim-time", help="The robot is a simulation that publishes /clock: take its time.")
]


def connection_of(
    on: str | None, domain: int | None, namespace: str | None, *, sim_time: bool, environ: Mapping[str, str]
) -> Connection | None:
    """How the robot is reached by these options; None for the simulation.

    Raises:
        InputError: One of them cannot be used, or contradicts another.
    """
    from fieldhand.execution.drivers.ros2.domain import domain_of
    from fieldhand.execution.vehicle import Connection, TransportName

    if on is None or on == SIMULATION:
        for given, option in ((domain is not None, "--domain"), (namespace is not None, "--namespace"),
                              (sim_time, "--sim-time")):  # fmt: skip
            if given:
                raise InputError(
                    message("the simulation has no {option}", option=option[2:]),
                    where=option,
                    advice=message("give --on dds with it"),
                )
        return None
    transport = next((name for name in get_args(TransportName) if name == on), None)
    if transport is None:
        raise InputError(
            message("a mission cannot be carried out on '{on}'", on=on),
            where="--on",
            advice=message("choose one of {what}", what=", ".join((SIMULATION, *get_args(TransportName)))),
        )
    return Connection(
        transport=transport,
        domain=domain_of(domain, environ),
        namespace=None if namespace is None else namespace_of(namespace),
        sim_time=sim_time,
    )


def connection_again(
    name: str,
    begun: Departure | None,
    on: str | None,
    domain: int | None,
    namespace: str | None,
    *,
    sim_time: bool,
    environ: Mapping[str, str],
) -> Connection | None:
    """How the robot of a mission that goes on is reached: as it was, but for what these options say.

    Args:
        name: The mission's.
        begun: On which robot it was begun.
        on, domain, namespace, sim_time, environ: As for :func:`connection_of`.

    Raises:
        InputError: An option cannot be used.
        ExecutionError: It was begun in simulation and is to go on on a robot, or the other way round.
    """
    from fieldhand import missions

    if on is None and begun is not None:
        on = begun.by.transport
    given = connection_of(on, domain, namespace, sim_time=sim_time, environ=environ)
    missions.require_vehicle(name, begun, simulated=given is None)
    if begun is None or given is None:
        return None
    return replace(
        begun.by,
        transport=given.transport,
        domain=begun.by.domain if domain is None else given.domain,
        namespace=begun.by.namespace if namespace is None else given.namespace,
        sim_time=begun.by.sim_time or sim_time,
    )


def refuse_simulation_options(connection: Connection | None, *, world: Path | None, speed: str | None) -> None:
    """A robot has no world file, and time passes for it as it does.

    Raises:
        InputError: One is given for a robot.
    """
    if connection is None:
        return
    if world is not None:
        raise InputError(
            message("a world file is for the simulation; a robot reads its own sensors"),
            where="--world",
            advice=message("leave it out, or leave out --on {transport}", transport=connection.transport),
        )
    if speed is not None:
        raise InputError(
            message("a robot cannot be driven faster than time passes"),
            where="--speed",
            advice=message("leave it out; --sim-time follows a robot that is a simulation"),
        )


@contextmanager
def boarded(
    ground: Ground, task: Task, connection: Connection | None, *, quiet: bool, language: Language = ENGLISH
) -> Iterator[Vehicle | None]:
    """The robot as long as it is needed for a Task; None for the simulation.

    Raises:
        ProfileError: The profile does not say how the robot is reached.
        InputError: What reaches it is not installed.
        Ros2Error: It does not answer, or not as the profile says.
    """
    if connection is None:
        yield None
        return
    from fieldhand.cli.show import note
    from fieldhand.execution.drivers.ros2.robot_connection import connected_robot

    if not quiet:
        looking = message("looking for {robot} over ROS 2 ({way})", robot=ground.robot.name, way=str(connection))
        note(looking, language)
    with connected_robot(ground.site, ground.robot, task, connection) as vehicle:
        yield vehicle


def see_off(ground: Ground, review: Review, vehicle: Vehicle, consent: Consent) -> None:
    """See whether the robot may set out, before a wheel turns, and say where it stands and what charge it has.

    Raises:
        ExecutionError: It stands elsewhere, does not know where, or is stopped.
        NotApprovedError: Its charge does not last.
        NotConfirmedError: It may not last, and nobody has accepted that.
    """
    from fieldhand import missions
    from fieldhand.cli.show import note

    away_m = missions.require_in_place(ground.site, ground.robot, vehicle.driver)
    charge = vehicle.driver.charge_percent()
    if not consent.quiet:
        stands = message(
            "{robot} stands {metres} m from the start, battery at {charge} %",
            robot=ground.robot.name,
            metres=Number(f"{away_m:.1f}"),
            charge=f"{charge:.0f}",
        )
        note(stands, consent.language)
        if vehicle.remark:
            note(vehicle.remark, consent.language)
    missions.require_charged(review, ground.site, ground.robot, charge, confirm=consent.confirm)


def namespace_of(said: str) -> str:
    """A namespace as it was given.

    Raises:
        InputError: It is none.
    """
    from fieldhand.robot.bindings_document import as_namespace

    try:
        return as_namespace(said)
    except ValueError as error:
        what, _, advice = str(error).partition("; ")
        raise InputError(what, where="--namespace", advice=advice) from None
