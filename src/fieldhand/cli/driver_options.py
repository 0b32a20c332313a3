"""Options that choose the driver of a mission, and the connection to the robot that they describe."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.errors import InputError
from fieldhand.execution.drivers.ros2.domain import MOST_DOMAIN
from fieldhand.language import Number, message

if TYPE_CHECKING:
    from fieldhand.cli.options import DisplayOptions
    from fieldhand.execution.vehicle import Connection, Vehicle
    from fieldhand.mission import Review
    from fieldhand.mission.documents import SiteAndRobot
    from fieldhand.missions import RobotAtStart
    from fieldhand.robot.bindings import Ros2Bindings
    from fieldhand.task.frames import Task

SIMULATION = "simulation"
#: Seconds within which the whole robot must respond.
READY_WITHIN_S = 20.0

NamespaceOption = Annotated[
    str | None,
    typer.Option("--namespace", help="Namespace of the robot's ROS names, instead of the profile's; / for none."),
]


@dataclass(frozen=True, kw_only=True)
class DriverOptions:
    """Driver of a mission, and the address of the robot; the simulation by default."""

    on: Annotated[
        str | None,
        typer.Option(
            "--on",
            metavar="simulation|dds|rclpy|...",
            help="On what: the simulation (default); the robot over ROS 2 (dds needs no ROS here, rclpy does); or the"
            " driver of a plugin (fieldhand plugins).",
        ),
    ] = None
    domain: Annotated[
        int | None,
        typer.Option("--domain", min=0, max=MOST_DOMAIN, help="ROS domain of the robot; else ROS_DOMAIN_ID, else 0."),
    ] = None
    namespace: NamespaceOption = None
    sim_time: Annotated[
        bool, typer.Option("--sim-time", help="Use the time on /clock, which a simulated robot publishes.")
    ] = False
    driver_option: Annotated[
        list[str] | None,
        typer.Option("--driver-option", metavar="NAME=VALUE", help="Option of a plugin's driver; may be repeated."),
    ] = None


@dataclass(frozen=True, kw_only=True)
class TransportOptions:
    """ROS 2 transport, and the domain and namespace in which the robot's names are."""

    on: Annotated[
        str,
        typer.Option("--on", metavar="dds|rclpy", help="dds needs no ROS here, rclpy uses the one that is sourced."),
    ] = "dds"
    domain: Annotated[
        int | None, typer.Option("--domain", min=0, max=MOST_DOMAIN, help="ROS domain; else ROS_DOMAIN_ID, else 0.")
    ] = None
    namespace: NamespaceOption = None

    def in_namespace(self, bindings: Ros2Bindings) -> Ros2Bindings:
        """Return the bindings of a profile in the namespace of the option, if it is given.

        Raises:
            InputError: The namespace is not a valid ROS name.
        """
        return bindings if self.namespace is None else replace(bindings, namespace=namespace_of(self.namespace))


def connection_of(options: DriverOptions, environ: Mapping[str, str]) -> Connection | None:
    """Return the connection to the robot that the options name; None for the simulation.

    Args:
        options: Options of the command line.
        environ: Environment variables, of which ``ROS_DOMAIN_ID`` is used.

    Raises:
        InputError: An option cannot be used, or contradicts another.
        PluginError: The driver cannot be imported.
    """
    from fieldhand.execution.drivers.registry import driver_kind
    from fieldhand.execution.drivers.ros2.domain import domain_of
    from fieldhand.execution.vehicle import Connection

    on = options.on
    kind = None if on is None or on == SIMULATION else driver_kind(on)
    if kind is None or not kind.ros2:
        _refuse_ros2_options(options)
    if options.driver_option and (kind is None or kind.ros2):
        raise InputError(
            message("{on} does not support such options", on=on or SIMULATION),
            where="--driver-option",
            advice=message("leave it out; it is for drivers of plugins"),
        )
    if on is None or kind is None:
        return None
    return Connection(
        transport=on,
        domain=domain_of(options.domain, environ) if kind.ros2 else 0,
        namespace=None if options.namespace is None else namespace_of(options.namespace),
        sim_time=options.sim_time,
        options=_named_values(options.driver_option or ()),
    )


def _refuse_ros2_options(options: DriverOptions) -> None:
    """Require that no option of ROS 2 is given.

    Raises:
        InputError: One is.
    """
    for is_given, option in (
        (options.domain is not None, "--domain"),
        (options.namespace is not None, "--namespace"),
        (options.sim_time, "--sim-time"),
    ):
        if is_given:
            raise InputError(
                message("the simulation does not support {option}", option=option[2:])
                if options.on in (None, SIMULATION)
                else message("the driver {name} does not support {option}", name=str(options.on), option=option[2:]),
                where=option,
                advice=message("use it together with --on dds"),
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
                what or message("'{option}' is not of the form name=value", option=option[:80]),
                where="--driver-option",
                advice=message("give each option once, as name=value"),
            )
        found[name] = value
    return found


def connection_again(
    name: str, begun: RobotAtStart | None, options: DriverOptions, environ: Mapping[str, str]
) -> Connection | None:
    """Return the connection for resuming a mission: the one it was begun with, overridden by the given options.

    Args:
        name: Name of the mission.
        begun: Robot on which it was begun; None for the simulation.
        options, environ: As for :func:`connection_of`.

    Raises:
        InputError: An option cannot be used.
        ExecutionError: The mission was begun in simulation and shall be resumed on a robot, or the other way round.
    """
    from fieldhand import missions

    if options.on is None and begun is not None:
        options = replace(options, on=begun.by.transport)
    given = connection_of(options, environ)
    missions.require_vehicle(name, begun, simulated=given is None)
    if begun is None or given is None:
        return None
    return replace(
        begun.by,
        transport=given.transport,
        domain=begun.by.domain if options.domain is None else given.domain,
        namespace=begun.by.namespace if options.namespace is None else given.namespace,
        sim_time=begun.by.sim_time or options.sim_time,
        options={**begun.by.options, **given.options},
    )


def parse_speed(text: str | None) -> float | None:
    """Return the speed of a simulation, in simulated seconds per second; None for ``max`` and by default.

    Raises:
        InputError: The text is neither ``max`` nor a positive number.
    """
    if text is None or text == "max":
        return None
    try:
        speed = float(text)
    except ValueError:
        speed = math.nan
    if not 0 < speed < math.inf:
        raise InputError(
            message("'{text}' is not a valid speed", text=text),
            where="--speed",
            advice=message("give max, or a number above 0 (1 is real time)"),
        )
    return speed


def refuse_simulation_options(connection: Connection | None, *, world: Path | None, speed: str | None) -> None:
    """Require that no option of the simulation is given for a robot.

    Raises:
        InputError: ``--world`` or ``--speed`` is given for a robot.
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
            message("a robot runs only in real time"),
            where="--speed",
            advice=message("leave it out; use --sim-time for a robot that is itself a simulation"),
        )


@contextmanager
def connected(
    site_and_robot: SiteAndRobot, task: Task, connection: Connection | None, display: DisplayOptions
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
    if not display.json:
        fills = {"robot": site_and_robot.robot.name, "way": str(connection)}
        if kind.ros2:
            note(message("looking for {robot} over ROS 2 ({way})", **fills), display.language)
        else:
            note(message("looking for {robot} ({way})", **fills), display.language)
    with kind.connect(site_and_robot.site, site_and_robot.robot, task, connection, READY_WITHIN_S) as vehicle:
        yield vehicle


def check_start(
    site_and_robot: SiteAndRobot, review: Review, vehicle: Vehicle, *, confirm: bool, display: DisplayOptions
) -> None:
    """Check position and battery of the robot before it moves, and print them.

    Raises:
        ExecutionError: The robot is not on the site, has no position, or is stopped.
        NotApprovedError: The charge is not enough for the mission.
        NotConfirmedError: The charge may not be enough, and that was not confirmed.
    """
    from fieldhand import missions
    from fieldhand.cli.show import note

    away_m = missions.require_in_place(site_and_robot.site, site_and_robot.robot, vehicle.driver)
    charge = vehicle.driver.charge_percent()
    if not display.json:
        position = message(
            "{robot} is {metres} m from the start, battery at {charge} %",
            robot=site_and_robot.robot.name,
            metres=Number(f"{away_m:.1f}"),
            charge=f"{charge:.0f}",
        )
        note(position, display.language)
        if vehicle.remark:
            note(vehicle.remark, display.language)
    missions.require_charged(review, site_and_robot.site, site_and_robot.robot, charge, confirm=confirm)


def namespace_of(text: str) -> str:
    """Return the namespace that an option names: empty, or ``/`` and a name.

    Raises:
        InputError: It is not a valid name in ROS.
    """
    from fieldhand.robot.bindings_document import as_namespace

    try:
        return as_namespace(text)
    except ValueError as error:
        what, _, advice = str(error).partition("; ")
        raise InputError(what, where="--namespace", advice=advice) from None
