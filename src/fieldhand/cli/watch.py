"""``fieldhand watch``: a mission on a robot elsewhere, followed as it happens or fetched when it is over."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.links import (
    CaOption,
    InsecureOption,
    MissionOfRobot,
    PinOption,
    RetrySeedOption,
    TokenFileOption,
    UrlArgument,
)
from fieldhand.cli.options import JsonOption
from fieldhand.cli.outputs import to_file

if TYPE_CHECKING:
    from fieldhand.delivery.json_models import EventLine
    from fieldhand.errors import UnreachableError


def watch(
    url: UrlArgument,
    mission: MissionOfRobot = None,
    once: Annotated[bool, typer.Option("--once", help="Fetch what is there, and wait for nothing.")] = False,
    events: Annotated[
        Path | None, typer.Option("--events", callback=to_file, help="Write the event log (JSON lines) here, whole.")
    ] = None,
    token_file: TokenFileOption = None,
    ca: CaOption = None,
    pin: PinOption = None,
    insecure: InsecureOption = False,
    seed: RetrySeedOption = None,
    json: JsonOption = False,
) -> None:
    """Follow a mission on a robot until nobody carries it out; events are complete, however often the link is lost.

    Exit status 1 if it has ended otherwise than completed.
    """
    import random
    import time
    from contextlib import ExitStack, closing

    from fieldhand.cli import show
    from fieldhand.cli.links import find_mission, open_robot_client, state_line, trust_of
    from fieldhand.delivery.follow_mission import follow
    from fieldhand.delivery.json_models import LONGEST_WAIT_S
    from fieldhand.execution.event_log import EventLog

    def lost(error: UnreachableError, wait_s: float) -> None:
        show.note(f"{error}; trying again in {wait_s:.0f} s")
        time.sleep(wait_s)

    with ExitStack() as stack:
        link = stack.enter_context(closing(open_robot_client(url, token_file, trust_of(ca, pin, insecure=insecure))))
        found = find_mission(link, mission)
        log = None if events is None else stack.enter_context(EventLog(events))

        def take(event: EventLine) -> None:
            if log is not None:
                log.line(event.line)
            if not json:
                _show(event)

        if not json:
            show.out.print(state_line(found))
        rng = random.Random(seed)  # noqa: S311
        last = follow(link, found.bundle, take=take, once=once, wait_s=LONGEST_WAIT_S, lost=lost, rng=rng)
    if json:
        show.print_json(last.model_dump())
    else:
        show.out.print(state_line(last))
    raise SystemExit(1 if last.state == "ended" and last.status != "completed" else 0)


def _show(event: EventLine) -> None:
    """An event in a line: its kind, and what it says in short."""
    import json

    from fieldhand.cli import show

    try:
        said = json.loads(event.line)
    except ValueError:
        said = None
    if not isinstance(said, dict):
        show.out.print(f"{event.n:>5}  {event.line[:200]}")
        return
    kind, t = said.pop("event", "?"), said.pop("t", 0.0)
    words = [f"{key} {value}" for key, value in said.items() if isinstance(value, str | int | float) and value != ""]
    show.out.print(f"{event.n:>5}  {t:9.1f} s  {kind:<10} {', '.join(words)[:160]}")
