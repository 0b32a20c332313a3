"""``fieldhand send``: a signed mission to a robot, now or when it is back."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.links import CaOption, InsecureOption, PinOption, RetrySeedOption, TokenFileOption
from fieldhand.cli.options import JsonOption

if TYPE_CHECKING:
    from fieldhand.delivery.outbox import OutboxEntry
    from fieldhand.delivery.outbox_sender import OutboxSender


def send(
    file: Annotated[Path | None, typer.Argument(help="A signed mission (.mission).")] = None,
    to: Annotated[str | None, typer.Option("--to", help="Address of the robot's agent: https://robot:8443.")] = None,
    start: Annotated[bool, typer.Option("--start", help="Start it once it has arrived.")] = False,
    pending: Annotated[bool, typer.Option("--pending", help="Send what is in the outbox, now.")] = False,
    watch: Annotated[
        bool, typer.Option("--watch", help="Send what is in the outbox as robots come back, until it is empty.")
    ] = False,
    token_file: TokenFileOption = None,
    ca: CaOption = None,
    pin: PinOption = None,
    insecure: InsecureOption = False,
    seed: RetrySeedOption = None,
    json: JsonOption = False,
) -> None:
    """Send a signed mission to a robot; what cannot be sent now waits in the outbox. Exit status 1 if any waits."""
    from fieldhand.cli import show
    from fieldhand.errors import InputError

    if (file is None) == (not pending and not watch) or (file is None) != (to is None):
        raise InputError("give a mission with --to, or --pending, or --watch", advice="fieldhand send --help says more")
    outbox_sender = _posting(seed)
    if file is not None and to is not None:
        posted = [_send(outbox_sender, file, to, start=start, token_file=token_file, ca=ca, pin=pin, insecure=insecure)]
        _tell(posted, quiet=json)
    else:
        posted = [] if watch else list(outbox_sender.post_due(all_of_them=True))
        _tell(posted, quiet=json)
    if watch:
        posted += _watch(outbox_sender, quiet=json)
    last = {entry.n: entry for entry in posted}
    if json:
        show.print_json([record(entry) for entry in last.values()])
    elif not posted:
        show.out.print("Nothing waits in the outbox.")
    raise SystemExit(0 if all(entry.state == "delivered" for entry in last.values()) else 1)


def record(entry: OutboxEntry) -> dict[str, Any]:
    """A mission of the outbox, as JSON."""
    from dataclasses import asdict

    return asdict(entry)


def line(entry: OutboxEntry) -> str:
    """A mission of the outbox, in a line."""
    return f"{entry.name} for {entry.url}: {entry.state}; {entry.said or 'not tried yet'}"


def _posting(seed: int | None) -> OutboxSender:
    import random
    import time

    from fieldhand.cli.links import client_for, sendable
    from fieldhand.delivery.outbox import Outbox, outbox_folder
    from fieldhand.delivery.outbox_sender import OutboxSender

    rng = random.Random(seed)  # noqa: S311
    outbox = Outbox(outbox_folder(os.environ))
    return OutboxSender(outbox=outbox, connect=client_for, check=sendable, clock=time.time, rng=rng)


def _send(
    outbox_sender: OutboxSender,
    file: Path,
    to: str,
    *,
    start: bool,
    token_file: Path | None,
    ca: Path | None,
    pin: str | None,
    insecure: bool,
) -> OutboxEntry:
    """Check all that can be checked here, put the mission into the outbox, and try to send it."""
    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.cli.links import sendable, trust_of
    from fieldhand.delivery.agent_token import read_token
    from fieldhand.delivery.outbox import OutboxEntry
    from fieldhand.delivery.robot_client import require_httpx
    from fieldhand.delivery.server_certificate import require_address

    require_httpx()
    data = read_bundle_file(file)
    found = sendable(data, str(file))
    trust = trust_of(ca, pin, insecure=insecure)
    url = require_address(to, trust)
    read_token(os.environ, token_file)
    now = outbox_sender.clock()
    entry = OutboxEntry(
        sha256=found.sha256,
        url=url,
        name=file.name,
        start=start,
        ca=trust.ca,
        pin=trust.pin,
        plain=trust.plain,
        token_file="" if token_file is None else str(token_file.absolute()),
        queued_at=now,
        next_at=now,
    )
    return outbox_sender.post(outbox_sender.outbox.put(entry, data))


def _watch(outbox_sender: OutboxSender, *, quiet: bool) -> list[OutboxEntry]:
    """Send what waits, each when its time has come, until nothing waits."""
    import time

    posted: list[OutboxEntry] = []
    while (wait := outbox_sender.next_s()) is not None:
        time.sleep(wait)
        tried = outbox_sender.post_due()
        _tell(tried, quiet=quiet)
        posted += tried
    return posted


def _tell(entries: list[OutboxEntry] | tuple[OutboxEntry, ...], *, quiet: bool) -> None:
    from fieldhand.cli import show

    for entry in () if quiet else entries:
        show.out.print(line(entry))
        if entry.state == "waiting":
            show.note("it waits in the outbox; fieldhand send --pending or --watch sends it")
