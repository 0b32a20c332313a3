"""``fieldhand sim-robot``: a simulated robot with a ROS 2 interface, which needs no ROS installation."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.driver_options import TransportOptions
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import SiteAndRobotOptions
from fieldhand.cli.outputs import refuse_standard_output, to_whole_file

if TYPE_CHECKING:
    from fieldhand.execution.drivers.ros2.simulated_robot.robot import GoalReport
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.robot.bindings import Distro, Ros2Bindings
    from fieldhand.robot.model import RobotProfile

#: Highest speed: above it, the robot would drive for minutes between two checks of its messages.
_FASTEST = 1000.0
#: Least distance in metres between the robot and where it believes to be that is printed.
_SEEN_M = 0.005


@grouped("site robot world seed speed distro on domain namespace state lenient json")
def sim_robot(
    place: SiteAndRobotOptions,
    transport: TransportOptions,
    world: Annotated[
        Path | None, typer.Option("--world", help="World file: sensor readings and faults of the simulation.")
    ] = None,
    seed: Annotated[
        int | None, typer.Option("--seed", min=0, help="Seed of readings and drives; else the world's, else 0.")
    ] = None,
    speed: Annotated[
        float, typer.Option("--speed", help="Simulated seconds per second; if it is not 1, the time is on /clock.")
    ] = 1.0,
    state: Annotated[
        Path | None,
        typer.Option(
            "--state", callback=to_whole_file, help="Continue from this file if it exists, and keep it up to date."
        ),
    ] = None,
    distro: Annotated[
        str | None,
        typer.Option(
            "--distro",
            metavar="humble|iron|jazzy|kilted",
            help="ROS 2 release of the robot; else the profile's, else humble.",
        ),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object a line instead of text.")] = False,
) -> None:
    """Simulate a robot on ROS 2 with the interface of its profile: Nav2's action, sensors, battery, fix."""
    from contextlib import closing
    from dataclasses import replace

    from fieldhand import mission
    from fieldhand.cli.inputs import open_site_and_robot
    from fieldhand.clock import ScaledClock
    from fieldhand.execution.drivers.ros2.interfaces import Interfaces
    from fieldhand.execution.drivers.ros2.open_transport import open_transport
    from fieldhand.execution.drivers.ros2.simulated_robot.main_loop import run_robot
    from fieldhand.execution.drivers.ros2.simulated_robot.robot import SimulatedRobot, bindings_of
    from fieldhand.execution.drivers.ros2.simulated_robot.state_file import Identity, read_state, write_state
    from fieldhand.execution.interrupts import ctrl_c_as_request

    clock = ScaledClock(_checked_speed(speed))
    release = _checked_release(distro)
    site_and_robot = open_site_and_robot(place.site, place.robot, lenient=place.lenient)
    simulated_world = mission.read_world(world, site_and_robot.site, site_and_robot.robot)
    bindings = transport.in_namespace(bindings_of(site_and_robot.robot))
    bindings = replace(bindings, distro=release or bindings.distro)
    profile = replace(site_and_robot.robot, ros2=bindings)
    identity = Identity(site=site_and_robot.site.content_sha256, robot=profile.sha256, world=_hash_of(simulated_world))
    refuse_standard_output(state, "--state")
    saved = None if state is None else read_state(state, identity)
    interfaces = Interfaces.of(bindings.release, bindings.interfaces)
    with closing(open_transport(transport.on, interfaces, transport.domain)) as node:
        sim_time = bindings.use_sim_time or speed != 1.0
        simulated = SimulatedRobot(
            site_and_robot.site,
            profile,
            simulated_world,
            node,
            interfaces,
            clock,
            seed=simulated_world.seed if seed is None else seed,
            sim_time=sim_time,
            speed=speed,
            report=_print_report_json if json else _print_report,
            state=saved,
        )
        _print_ready(
            profile, bindings, site_and_robot.site.name, sim_time=sim_time, goes_on=saved is not None, json=json
        )
        with ctrl_c_as_request() as ended:
            why = run_robot(
                simulated,
                clock,
                ended=ended,
                save=lambda kept: None if state is None else write_state(state, kept, identity),
            )
    _print_end(why, json=json)


def _checked_speed(speed: float) -> float:
    from fieldhand.errors import InputError

    if not 0 < speed <= _FASTEST:
        raise InputError(
            f"{speed:g} is not a valid speed", where="--speed", advice=f"give a number above 0, to {_FASTEST:g}"
        )
    return speed


def _checked_release(distro: str | None) -> Distro | None:
    from typing import get_args

    from fieldhand.errors import InputError
    from fieldhand.robot.bindings import Distro

    found = next((name for name in get_args(Distro) if name == distro), None)
    if distro is not None and found is None:
        raise InputError(
            f"there is no release '{distro[:40]}'",
            where="--distro",
            advice=f"choose one of {', '.join(get_args(Distro))}",
        )
    return found


def _hash_of(world: World) -> str:
    return "" if world.data is None else hashlib.sha256(world.data).hexdigest()


def _print_ready(
    profile: RobotProfile, bindings: Ros2Bindings, site: str, *, sim_time: bool, goes_on: bool, json: bool
) -> None:
    """Print that the robot is ready, and the names under which it is reached."""
    if json:
        _line(
            event="ready",
            robot=profile.name,
            site=site,
            namespace=bindings.namespace or "/",
            navigation=bindings.whole_name(bindings.navigation.action),
            distro=bindings.release,
            sim_time=sim_time,
            goes_on=goes_on,
        )
        return
    at = "where it was before" if goes_on else "at the start"
    _print(f"{site}: {profile.name} is {at} and answers over DDS, names below {bindings.namespace or '/'}")
    _print(f"  drives by {bindings.whole_name(bindings.navigation.action)} ({bindings.navigation.type})")
    if sim_time:
        _print("  its time is on /clock: take it from there (use_sim_time)")
    _print(f"  has the interfaces of ROS 2 {bindings.release}")
    _print("Ctrl-C ends it.")


def _print_report(report: GoalReport) -> None:
    """Print the report of a goal as one line."""
    facts = [f"{report.metres:.1f} m"] if report.metres else []
    if report.end != "rejected":
        facts += [f"{report.took_s:.1f} s", *(f"{name} {value:.4g}" for name, value in report.readings.items())]
    if report.off_m >= _SEEN_M:
        facts.append(f"{report.off_m:.2f} m from where it believes to be")
    why = f" ({report.why})" if report.why and report.why != report.end else ""
    done = f": {', '.join(facts)}" if facts else ""
    head = f"{report.seconds:8.1f} s  {report.name} at {report.place} {report.end}"
    _print(f"{head}{why}{done}; battery {report.charge_percent:.1f} %")


def _print_report_json(report: GoalReport) -> None:
    from dataclasses import asdict

    _line(event="goal", **asdict(report))


def _print_end(why: str, *, json: bool) -> None:
    if json:
        _line(event="ended", why=why)
    else:
        _print(f"Ended: {why}")


def _print(text: str) -> None:
    from fieldhand.cli import show

    show.out.print(text)


def _line(**values: Any) -> None:
    """Print a JSON object on one line, unbuffered, for programs that wait for it."""
    from fieldhand.hidden_characters import json_text

    typer.echo(json_text(values))
