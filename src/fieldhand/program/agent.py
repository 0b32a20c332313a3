"""``fieldhand agent``: a server on the robot that receives signed missions and carries them out on command."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.driver_options import DriverOptions
from fieldhand.cli.option_groups import grouped
from fieldhand.errors import InputError
from fieldhand.hidden_characters import print_error

if TYPE_CHECKING:
    from fastapi import FastAPI

    from fieldhand.program.robot_agent import RobotAgent


@dataclass(frozen=True, kw_only=True)
class ListenOptions:
    """Address of the agent, its certificate and its token."""

    host: Annotated[str, typer.Option("--host", help="Address to listen on; this machine alone by default.")] = (
        "127.0.0.1"
    )
    port: Annotated[int, typer.Option("--port", min=1, max=65535, help="Port to listen on.")] = 8443
    cert: Annotated[Path | None, typer.Option("--cert", help="Certificate for TLS (PEM).")] = None
    key: Annotated[Path | None, typer.Option("--key", help="Its private key (PEM), mode 0600.")] = None
    token_file: Annotated[
        Path | None, typer.Option("--token-file", help="File with the token, mode 0600; else FIELDHAND_TOKEN.")
    ] = None
    insecure: Annotated[bool, typer.Option("--insecure", help="Allow access by others without token or TLS.")] = False


@dataclass(frozen=True, kw_only=True)
class MissionOptions:
    """Robot, sites and store of the agent's missions."""

    robot: Annotated[str, typer.Option("--robot", help="Profile of this robot: a built-in one or a YAML file.")]
    site: Annotated[
        list[str] | None, typer.Option("--site", help="A site where it may work; repeat it. Else any that was signed.")
    ] = None
    lenient: Annotated[bool, typer.Option("--lenient", help="Read --site leniently.")] = False
    store: Annotated[
        Path | None, typer.Option("--store", help="Folder of its missions; else in the user's state folder.")
    ] = None
    timezone: Annotated[
        str,
        typer.Option("--timezone", help="Time zone of missions that state none, such as Europe/Rome."),
    ] = ""
    resume: Annotated[bool, typer.Option("--resume", help="Resume an interrupted mission after a power cut.")] = False


@dataclass(frozen=True, kw_only=True)
class AgentSimulationOptions:
    """World, seed and speed of simulated missions."""

    world: Annotated[
        Path | None, typer.Option("--world", help="World file: sensor readings and faults of the simulation.")
    ] = None
    seed: Annotated[int, typer.Option("--seed", min=0, help="Seed of the simulation.")] = 0
    speed: Annotated[
        str | None,
        typer.Option("--speed", help="Simulated seconds per second, or max; 1, real time, by default."),
    ] = None


@grouped(
    "robot site store host port cert key token_file insecure resume timezone world seed speed"
    " on domain namespace sim_time driver_option lenient"
)
def agent(
    missions: MissionOptions, listen: ListenOptions, simulation: AgentSimulationOptions, driver: DriverOptions
) -> None:
    """Receive signed missions and carry out those that are started, one at a time: in simulation, or on a robot."""
    from fieldhand.api.serving import require_extra, require_free
    from fieldhand.cli.driver_options import connection_of, parse_speed, refuse_simulation_options
    from fieldhand.delivery.agent_token import read_token
    from fieldhand.program.robot_agent import compose_robot_agent
    from fieldhand.program.tls_files import tls_files

    require_extra()
    speed = parse_speed(simulation.speed or "1")
    connection = connection_of(driver, os.environ)
    refuse_simulation_options(connection, world=simulation.world, speed=simulation.speed)
    token = read_token(os.environ, listen.token_file)
    tls = tls_files(listen.cert, listen.key, ("--cert", "--key"))
    _require_protected(listen.host, token=token is not None, tls=tls is not None, insecure=listen.insecure)
    require_free(listen.host, listen.port)
    robot_agent = compose_robot_agent(
        os.environ,
        robot=missions.robot,
        sites=tuple(missions.site or ()),
        store=missions.store,
        world=simulation.world,
        seed=simulation.seed,
        speed=speed,
        lenient=missions.lenient,
        connection=connection,
        zone=missions.timezone,
        warn=_warn,
    )
    try:
        app = create_app(robot_agent, token=token, host=listen.host)
        robot_agent.supervisor.write_missing_report()
        if missions.resume and (interrupted := robot_agent.supervisor.continue_interrupted()):
            print_error(f"going on with mission {interrupted[:16]}")
        robot_agent.supervisor.timetables.begin_watch()
        _serve(app, listen.host, listen.port, tls, token)
    finally:
        robot_agent.close()


def create_app(robot_agent: RobotAgent, *, token: str | None, host: str) -> FastAPI:
    """Create the HTTP application of a robot agent."""
    from fieldhand.agent.app import create_agent
    from fieldhand.agent.routes import RobotIdentity
    from fieldhand.api.serving import hosts_for

    who = RobotIdentity(
        robot=robot_agent.robot.name,
        robot_sha256=robot_agent.robot.sha256,
        sites=tuple(place.name for place in robot_agent.sites),
        on=robot_agent.on,
        missing=robot_agent.missing,
    )
    return create_agent(robot_agent.mission_store, robot_agent.supervisor, who, token=token, hosts=hosts_for(host))


def _warn(line: str) -> None:
    print_error(f"warning: {line}")


def _require_protected(host: str, *, token: bool, tls: bool, insecure: bool) -> None:
    """Require token and TLS if other machines can reach the address.

    Raises:
        InputError: One is missing, and the address is not a loopback address.
    """
    from fieldhand.api.serving import is_loopback

    if insecure or is_loopback(host) or (token and tls):
        return
    missing = " and ".join([*([] if token else ["a token"]), *([] if tls else ["TLS"])])
    raise InputError(
        f"others can reach this address, but there is no {missing}".replace("no a ", "no "),
        where="--host",
        advice="give --token-file, --cert and --key; or --insecure to accept that",
    )


def _serve(app: FastAPI, host: str, port: int, tls: tuple[Path, Path] | None, token: str | None) -> None:
    from contextlib import suppress

    from fieldhand.api.serving import log_visibly, make_server

    log_visibly()
    shown = f"[{host}]" if ":" in host else host
    print_error(f"The agent is at http{'s' if tls else ''}://{shown}:{port} (Ctrl-C to stop)")
    if token is None:
        print_error("warning: there is no token; anyone who reaches this address can start missions on the robot")
    with suppress(KeyboardInterrupt):
        make_server(app, host, port, tls=tls).run()
