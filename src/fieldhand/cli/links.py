"""Connections from the command line to agents on robots: address, certificate and token."""

from __future__ import annotations

import os
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.compatibility import UTC

if TYPE_CHECKING:
    from fieldhand.delivery.bundle_checks import Sendable
    from fieldhand.delivery.json_models import MissionSummary
    from fieldhand.delivery.outbox import OutboxEntry
    from fieldhand.delivery.robot_client import RobotClient
    from fieldhand.delivery.server_certificate import ServerTrust

UrlArgument = Annotated[str, typer.Argument(help="Address of the robot's agent, like https://robot:8443.")]
MissionOfRobot = Annotated[
    str | None,
    typer.Argument(help="The .mission file, its SHA-256, or the mission's name there; else the running one."),
]
RetrySeedOption = Annotated[
    int | None, typer.Option("--seed", min=0, help="Seed of the waiting times between attempts; random by default.")
]


@dataclass(frozen=True, kw_only=True)
class LinkOptions:
    """Token of a robot's agent, and the certificate that it must have."""

    token_file: Annotated[
        Path | None, typer.Option("--token-file", help="File with the robot's token, mode 0600; else FIELDHAND_TOKEN.")
    ] = None
    ca: Annotated[
        Path | None, typer.Option("--ca", help="Certificate (PEM) of the authority that signed the robot's.")
    ] = None
    pin: Annotated[
        str | None, typer.Option("--pin", help="SHA-256 of the robot's certificate; no other one is accepted.")
    ] = None
    insecure: Annotated[
        bool, typer.Option("--insecure", help="Send without TLS, so that others can read the token.")
    ] = False

    def trust(self) -> ServerTrust:
        """Return the certificates that identify the robot.

        Raises:
            InputError: The pin is not a SHA-256.
        """
        from fieldhand.delivery.server_certificate import ServerTrust, parse_pin

        ca = "" if self.ca is None else str(self.ca.absolute())
        return ServerTrust(ca=ca, pin="" if self.pin is None else parse_pin(self.pin), plain=self.insecure)

    def open(self, url: str) -> RobotClient:
        """Return a client of the agent at an address.

        Raises:
            InputError, DeliveryError: As for :func:`open_robot_client`.
        """
        return open_robot_client(url, self.token_file, self.trust())


def open_robot_client(url: str, token_file: Path | None, trust: ServerTrust) -> RobotClient:
    """Return a client of a robot's agent.

    Raises:
        InputError: The address, the token or the authority's file cannot be used.
        DeliveryError: The robot's certificate is not the pinned one.
    """
    from fieldhand.delivery.agent_token import read_token
    from fieldhand.delivery.robot_client import RobotClient, open_client, require_httpx
    from fieldhand.delivery.server_certificate import context_for, require_address

    require_httpx()
    address = require_address(url, trust)
    token = read_token(os.environ, token_file)
    return RobotClient(open_client(address, token, context_for(address, trust)))


def client_for(entry: OutboxEntry) -> RobotClient:
    """Return a client of the robot to which a mission of the outbox is addressed."""
    from fieldhand.delivery.server_certificate import ServerTrust

    file = Path(entry.token_file) if entry.token_file else None
    return open_robot_client(entry.url, file, ServerTrust(ca=entry.ca, pin=entry.pin, plain=entry.plain))


def sendable(data: bytes, source: str) -> Sendable:
    """Check that a signed mission is complete, and not signed with a key that was revoked on this machine.

    Raises:
        BundleError: It is damaged or not signed.
        NotTrustedError: Its key was revoked.
    """
    from fieldhand.approval.memory import trust_store
    from fieldhand.delivery.bundle_checks import require_sendable

    known = trust_store(os.environ).known()
    return require_sendable(data, source=source, known=known, now=datetime.now(UTC))


def find_mission(client: RobotClient, name: str | None) -> MissionSummary:
    """Return a mission on the robot.

    Args:
        client: Client of the robot's agent.
        name: File of the mission, its SHA-256 or its name; None for the one that is running, else the one begun last.

    Raises:
        InputError: The robot has no such mission.
    """
    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.cli.bundles import is_bundle
    from fieldhand.delivery.bundle_checks import sha256_of
    from fieldhand.errors import InputError

    robot = client.robot()
    if name is not None:
        wanted = sha256_of(read_bundle_file(Path(name))) if is_bundle(name) else name.lower()
        found = [m for m in robot.missions if wanted in (m.bundle, m.mission)]
        if not found and len(wanted) == 64:
            receipt = client.mission(wanted)
            found = [] if receipt is None else [receipt.mission]
    else:
        begun = [m for m in robot.missions if m.begun_at is not None]
        found = [m for m in begun if m.bundle == robot.active] or begun[-1:] or robot.missions[-1:]
    if not found:
        there = ", ".join(m.mission for m in robot.missions[-5:])
        raise InputError(
            f"the robot has no mission '{name}'" if name else "the robot has no mission",
            advice=f"it has {there}" if there else "send it one",
        )
    return found[0]


def state_line(mission: MissionSummary) -> str:
    """Return the state of a mission as one line."""
    ended = f": {mission.status}{f' ({mission.reason})' if mission.reason else ''}" if mission.status else ""
    doing = f", {mission.doing}" if mission.doing and not ended else ""
    fault = f"; {mission.fault}" if mission.fault else ""
    report = f"; its report on the robot: {mission.report}" if mission.report else ""
    return f"mission {mission.mission} {mission.state}{ended}{doing}, {mission.events} events{fault}{report}"
