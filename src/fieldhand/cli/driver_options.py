"""The options that choose a driver, and the connection to the robot that they name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.errors import InputError
from fieldhand.execution.drivers.ros2.domain import MOST_DOMAIN
from fieldhand.language import ENGLISH, Language, Number, message

if TYPE_CHECKING:
    from fieldhand.cli.approving import Consent
    from fieldhand.execution.vehicle import Connection, Vehicle
    from fieldhand.mission import Review
    from fieldhand.mission.documents import SiteAndRobot
    from fieldhand.missions import Departure
    from fieldhand.task.frames import Task

SIMULATION = "simulation"
#: Seconds within which the whole robot must respond.
READY_WITHIN_S = 20.0

OnOption = Annotated[
    str | None,
    typer.Option(
        "--on",
        metavar="simulation|dds|rclpy|...",
        help="On what: the simulation (default); the robot over ROS 2 (dds needs no ROS here, rclpy does); or the"
        " driver of a plugin (fieldhand plugins).",
    ),
]
DriverOption = Annotated[
    list[str] | None,
    typer.Option("--driver-option", metavar="NAME=VALUE", help="Option of a plugin's driver; may be repeated."),
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
    on: str | None,
    domain: int | None,
    namespace: str | None,
    *,
    sim_time: bool,
    environ: Mapping[str, str],
    options: Sequence[str] | None = None,
) -> Connection | None:
    """Return the connection to the robot that the options name; None for the simulation.

    Args:
        on: Name of the driver; None for the simulation.
        domain, namespace, sim_time: Options of drivers for ROS 2.
        environ: Environment variables, of which ``ROS_DOMAIN_ID`` is used.
        options: Options of other drivers, as ``name=value``.

    Raises:
        InputError: An option cannot be used, or contradicts another.
        PluginError: The driver cannot be imported.
    """
    from fieldhand.execution.drivers.registry import driver_kind
    from fieldhand.execution.drivers.ros2.domain import domain_of
    from fieldhand.execution.vehicle import Connection

    simulated = on is None or on == SIMULATION
    kind = None if on is None or simulated else driver_kind(on)
    if kind is None or not kind.ros2:
        for given, option in (
            (domain is not None, "--domain"),
            (namespace is not None, "--namespace"),
            (sim_time, "--sim-time"),
        ):
            if given:
                raise InputError(
                    message("the simulation has no {option}", option=option[2:])
                    if simulated
                    else message("the driver {name} has no {option}", name=str(on), option=option[2:]),
                    where=option,
                    advice=message("give --on dds with it"),
                )
    if options and (kind is None or kind.ros2):
        raise InputError(
            message("{on} has no such options", on=on or SIMULATION),
            where="--driver-option",
            advice=message("leave it out; it is for drivers of plugins"),
        )
    if on is None or kind is None:
        return None
    return Connection(
        transport=on,
        domain=domain_of(domain, environ) if kind.ros2 else 0,
        namespace=None if namespace is None else namespace_of(namespace),
        sim_time=sim_time,
        options=_named_values(options or ()),
    )


def _named_values(options: Sequence[str]) -> dict[str, str]:
    """Return options given as ``name=value``.

    Raises:
        InputError: One has no name, or no equals sign, or is given twice.
    """
    found: dict[str, str] = {}
    for option in options:
        name, equals, value = option.partition("=")
        if not name or not equals or name in found:
            what = message("'{option}' is given twice", option=name) if name in found else None
            raise InputError(
                what or message("'{option}' has not the form name=value", option=option[:80]),
                where="--driver-option",
                advice=message("give each option once, as name=value"),
            )
        found[name] = value
    return found


def connection_again(
    name: str,
    begun: Departure | None,
    on: str | None,
    domain: int | None,
    namespace: str | None,
    *,
    sim_time: bool,
    environ: Mapping[str, str],
    options: Sequence[str] | None = None,
) -> Connection | None:
    """Return the connection for resuming a mission: the one it was begun with, with these options in place of its own.

    Args:
        name: Name of the mission.
        begun: Robot on which it was begun; None for the simulation.
        on, domain, namespace, sim_time, environ, options: As for :func:`connection_of`.

    Raises:
        InputError: An option cannot be used.
        ExecutionError: It was begun in simulation and is to go on on a robot, or the other way round.
    """
    from fieldhand import missions

    if on is None and begun is not None:
        on = begun.by.transport
    given = connection_of(on, domain, namespace, sim_time=sim_time, environ=environ, options=options)
    missions.require_vehicle(name, begun, simulated=given is None)
    if begun is None or given is None:
        return None
    return replace(
        begun.by,
        transport=given.transport,
        domain=begun.by.domain if domain is None else given.domain,
        namespace=begun.by.namespace if namespace is None else given.namespace,
        sim_time=begun.by.sim_time or sim_time,
        options={**begun.by.options, **given.options},
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
def connected(
    ground: SiteAndRobot, task: Task, connection: Connection | None, *, quiet: bool, language: Language = ENGLISH
) -> Iterator[Vehicle | None]:
    """Connect to the robot for the duration of the context; None for the simulation.

    Raises:
        ProfileError: The profile does not say how the robot is reached.
        InputError: A required package is not installed.
        ExecutionError: The robot does not respond, or not as the profile says.
    """
    if connection is None:
        yield None
        return
    from fieldhand.cli.show import note
    from fieldhand.execution.drivers.registry import driver_kind

    kind = driver_kind(connection.transport)
    if not quiet:
        fills = {"robot": ground.robot.name, "way": str(connection)}
        if kind.ros2:
            note(message("looking for {robot} over ROS 2 ({way})", **fills), language)
        else:
            note(message("looking for {robot} ({way})", **fills), language)
    with kind.connect(ground.site, ground.robot, task, connection, READY_WITHIN_S) as vehicle:
        yield vehicle


def see_off(ground: SiteAndRobot, review: Review, vehicle: Vehicle, consent: Consent) -> None:
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
