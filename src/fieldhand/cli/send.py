"""``fieldhand send``: send a signed mission to a robot; one that cannot be reached gets it later from the outbox."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.links import LinkOptions, RetrySeedOption
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption

if TYPE_CHECKING:
    from fieldhand.delivery.outbox import OutboxEntry
    from fieldhand.delivery.outbox_sender import OutboxSender


@grouped("file to start pending watch token_file ca pin insecure seed json")
def send(
    link: LinkOptions,
    file: Annotated[Path | None, typer.Argument(help="A signed mission (.mission).")] = None,
    to: Annotated[str | None, typer.Option("--to", help="Address of the robot's agent: https://robot:8443.")] = None,
    start: Annotated[bool, typer.Option("--start", help="Start it once it has arrived.")] = False,
    pending: Annotated[bool, typer.Option("--pending", help="Send all waiting missions now.")] = False,
    watch: Annotated[
        bool, typer.Option("--watch", help="Send waiting missions as their robots can be reached, until none waits.")
    ] = False,
    seed: RetrySeedOption = None,
    json: JsonOption = False,
) -> None:
    """Send a signed mission to a robot; what cannot be sent now waits in the outbox. Exit status 1 if any waits."""
    from fieldhand.cli import show
    from fieldhand.errors import InputError

    if (file is None) == (not pending and not watch) or (file is None) != (to is None):
        raise InputError("give a mission with --to, or --pending, or --watch", advice="fieldhand send --help says more")
    outbox_sender = _make_sender(seed)
    if file is not None and to is not None:
        sent = [_send(outbox_sender, file, to, link, start=start)]
        _print(sent, quiet=json)
    else:
        sent = [] if watch else list(outbox_sender.post_due(all_of_them=True))
        _print(sent, quiet=json)
    if watch:
        sent += _watch(outbox_sender, quiet=json)
    last = {entry.n: entry for entry in sent}
    if json:
        show.print_json([record(entry) for entry in last.values()])
    elif not sent:
        show.out.print("Nothing waits in the outbox.")
    raise SystemExit(0 if all(entry.state == "delivered" for entry in last.values()) else 1)


def record(entry: OutboxEntry) -> dict[str, Any]:
    """Return an entry of the outbox as JSON."""
    from dataclasses import asdict

    return asdict(entry)


def line(entry: OutboxEntry) -> str:
    """Return an entry of the outbox as one line."""
    return f"{entry.name} for {entry.url}: {entry.state}; {entry.response or 'not tried yet'}"


def _make_sender(seed: int | None) -> OutboxSender:
    import random
    import time

    from fieldhand.cli.links import client_for, sendable
    from fieldhand.delivery.outbox import Outbox, outbox_folder
    from fieldhand.delivery.outbox_sender import OutboxSender

    rng = random.Random(seed)  # noqa: S311
    outbox = Outbox(outbox_folder(os.environ))
    return OutboxSender(outbox=outbox, connect=client_for, check=sendable, clock=time.time, rng=rng)


def _send(outbox_sender: OutboxSender, file: Path, to: str, link: LinkOptions, *, start: bool) -> OutboxEntry:
    """Check a mission and the options as far as possible, put it into the outbox, and try to send it."""
    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.cli.links import sendable
    from fieldhand.delivery.agent_token import read_token
    from fieldhand.delivery.outbox import OutboxEntry
    from fieldhand.delivery.robot_client import require_httpx
    from fieldhand.delivery.server_certificate import require_address

    require_httpx()
    data = read_bundle_file(file)
    mission = sendable(data, str(file))
    trust = link.trust()
    url = require_address(to, trust)
    read_token(os.environ, link.token_file)
    now = outbox_sender.clock()
    entry = OutboxEntry(
        sha256=mission.sha256,
        url=url,
        name=file.name,
        start=start,
        ca=trust.ca,
        pin=trust.pin,
        plain=trust.plain,
        token_file="" if link.token_file is None else str(link.token_file.absolute()),
        queued_at=now,
        next_at=now,
    )
    return outbox_sender.post(outbox_sender.outbox.put(entry, data))


def _watch(outbox_sender: OutboxSender, *, quiet: bool) -> list[OutboxEntry]:
    """Send each waiting mission when it is due, until none waits."""
    import time

    sent: list[OutboxEntry] = []
    while (wait := outbox_sender.next_s()) is not None:
        time.sleep(wait)
        tried = outbox_sender.post_due()
        _print(tried, quiet=quiet)
        sent += tried
    return sent


def _print(entries: list[OutboxEntry] | tuple[OutboxEntry, ...], *, quiet: bool) -> None:
    from fieldhand.cli import show

    for entry in () if quiet else entries:
        show.out.print(line(entry))
        if entry.state == "waiting":
            show.note("it waits in the outbox; fieldhand send --pending or --watch sends it")
