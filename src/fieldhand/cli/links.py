"""Robots elsewhere, as the commands that talk to them have them: their address, whom to believe, the token."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from fieldhand.delivery.bundle_checks import Sendable
    from fieldhand.delivery.json_models import MissionSummary
    from fieldhand.delivery.outbox import OutboxEntry
    from fieldhand.delivery.robot_client import RobotClient
    from fieldhand.delivery.server_certificate import ServerTrust

UrlArgument = Annotated[str, typer.Argument(help="Address of the robot's agent, like https://robot:8443.")]
MissionOfRobot = Annotated[
    str | None,
    typer.Argument(help="The .mission file, its SHA-256, or the mission's name there; else the one under way."),
]
TokenFileOption = Annotated[
    Path | None, typer.Option("--token-file", help="File with the robot's token, mode 0600; else FIELDHAND_TOKEN.")
]
CaOption = Annotated[
    Path | None, typer.Option("--ca", help="Certificate (PEM) of the authority that signed the robot's.")
]
PinOption = Annotated[
    str | None, typer.Option("--pin", help="SHA-256 of the robot's certificate; no other one is believed.")
]
InsecureOption = Annotated[
    bool, typer.Option("--insecure", help="Send without TLS: whoever listens can read the token.")
]
RetrySeedOption = Annotated[
    int | None, typer.Option("--seed", min=0, help="Of the waits between tries; else drawn anew each time.")
]


def trust_of(ca: Path | None, pin: str | None, *, insecure: bool) -> ServerTrust:
    """Whom to believe that it is the robot.

    Raises:
        InputError: The pin is none.
    """
    from fieldhand.delivery.server_certificate import ServerTrust, parse_pin

    return ServerTrust(
        ca="" if ca is None else str(ca.absolute()), pin="" if pin is None else parse_pin(pin), plain=insecure
    )


def open_robot_client(url: str, token_file: Path | None, trust: ServerTrust) -> RobotClient:
    """The link to a robot.

    Raises:
        InputError: The address, the token or the authority's file cannot be used.
        DeliveryError: It shows another certificate than the pinned one.
    """
    from fieldhand.delivery.agent_token import read_token
    from fieldhand.delivery.robot_client import RobotClient, open_client, require_httpx
    from fieldhand.delivery.server_certificate import context_for, require_address

    require_httpx()
    address = require_address(url, trust)
    token = read_token(os.environ, token_file)
    return RobotClient(open_client(address, token, context_for(address, trust)))


def client_for(entry: OutboxEntry) -> RobotClient:
    """The link to the robot for which a mission waits."""
    from fieldhand.delivery.server_certificate import ServerTrust

    file = Path(entry.token_file) if entry.token_file else None
    return open_robot_client(entry.url, file, ServerTrust(ca=entry.ca, pin=entry.pin, plain=entry.plain))


def sendable(data: bytes, source: str) -> Sendable:
    """See whether a bundle is whole and signed, and not with a key that was revoked here.

    Raises:
        BundleError, NotTrustedError: It is not.
    """
    from fieldhand.approval.memory import trust_store
    from fieldhand.delivery.bundle_checks import require_sendable

    known = trust_store(os.environ).known()
    return require_sendable(data, source=source, known=known, now=datetime.now(UTC))


def find_mission(link: RobotClient, given: str | None) -> MissionSummary:
    """A mission on the robot: by its file, its SHA-256 or its name; without any, that under way or begun last.

    Raises:
        InputError: There is none.
    """
    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.cli.bundles import is_bundle
    from fieldhand.delivery.bundle_checks import sha256_of
    from fieldhand.errors import InputError

    robot = link.robot()
    if given is not None:
        wanted = sha256_of(read_bundle_file(Path(given))) if is_bundle(given) else given.lower()
        found = [m for m in robot.missions if wanted in (m.bundle, m.mission)]
        if not found and len(wanted) == 64:
            receipt = link.mission(wanted)
            found = [] if receipt is None else [receipt.mission]
    else:
        begun = [m for m in robot.missions if m.begun_at is not None]
        found = [m for m in begun if m.bundle == robot.active] or begun[-1:] or robot.missions[-1:]
    if not found:
        there = ", ".join(m.mission for m in robot.missions[-5:])
        raise InputError(
            f"the robot has no mission '{given}'" if given else "the robot has no mission",
            advice=f"it has {there}" if there else "send it one",
        )
    return found[0]


def state_line(mission: MissionSummary) -> str:
    """How a mission stands, in a line."""
    ended = f": {mission.status}{f' ({mission.reason})' if mission.reason else ''}" if mission.status else ""
    doing = f", {mission.doing}" if mission.doing and not ended else ""
    fault = f"; {mission.fault}" if mission.fault else ""
    report = f"; its report on the robot: {mission.report}" if mission.report else ""
    return f"mission {mission.mission} {mission.state}{ended}{doing}, {mission.events} events{fault}{report}"
