"""``fieldhand watch``: print the events of a mission on a robot as they happen."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.links import LinkOptions, MissionOfRobot, RetrySeedOption, UrlArgument
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption
from fieldhand.cli.outputs import to_file, to_folder

if TYPE_CHECKING:
    from fieldhand.delivery.json_models import EventLine
    from fieldhand.errors import UnreachableError


@grouped("url mission once events images token_file ca pin insecure seed json")
def watch(
    url: UrlArgument,
    link: LinkOptions,
    mission: MissionOfRobot = None,
    once: Annotated[bool, typer.Option("--once", help="Fetch the events so far, without waiting.")] = False,
    events: Annotated[
        Path | None, typer.Option("--events", callback=to_file, help="Write the event log (JSON lines) here, whole.")
    ] = None,
    images: Annotated[
        Path | None,
        typer.Option(
            "--images", callback=to_folder, help="Fetch the images of its captures into this folder, as they are made."
        ),
    ] = None,
    seed: RetrySeedOption = None,
    json: JsonOption = False,
) -> None:
    """Follow a mission on a robot to its end; no event is missed if the connection is lost.

    Exit status 1 if it has ended otherwise than completed.
    """
    import random
    import time
    from contextlib import ExitStack, closing

    from fieldhand.cli import show
    from fieldhand.cli.links import find_mission, state_line
    from fieldhand.delivery.fetch_images import ImageFetcher
    from fieldhand.delivery.follow_mission import follow
    from fieldhand.delivery.json_models import LONGEST_WAIT_S
    from fieldhand.execution.event_log import EventLog

    def lost(error: UnreachableError, wait_s: float) -> None:
        show.note(f"{error}; trying again in {wait_s:.0f} s")
        time.sleep(wait_s)

    with ExitStack() as stack:
        client = stack.enter_context(closing(link.open(url)))
        summary = find_mission(client, mission)
        log = None if events is None else stack.enter_context(EventLog(events))

        fetcher = None if images is None else ImageFetcher(client, summary.bundle, images)

        def take(event: EventLine) -> None:
            if log is not None:
                log.line(event.line)
            if not json:
                _show(event)
            if fetcher is not None:
                fetcher.take(event.line)

        if not json:
            show.out.print(state_line(summary))
        rng = random.Random(seed)  # noqa: S311
        last = follow(client, summary.bundle, take=take, once=once, wait_s=LONGEST_WAIT_S, lost=lost, rng=rng)
        if images is not None and fetcher is not None:
            fetched = fetcher.finish()
            for problem in fetched.problems:
                show.note(problem)
            if not json:
                show.out.print(f"{fetched.count} images in {images / 'images'}")
    if json:
        show.print_json(last.model_dump())
    else:
        show.out.print(state_line(last))
    raise SystemExit(1 if last.state == "ended" and last.status != "completed" else 0)


def _show(event: EventLine) -> None:
    """Print an event as one line: number, time, kind and short fields."""
    import json

    from fieldhand.cli import show

    try:
        fields = json.loads(event.line)
    except ValueError:
        fields = None
    if not isinstance(fields, dict):
        show.out.print(f"{event.n:>5}  {event.line[:200]}")
        return
    kind, t = fields.pop("event", "?"), fields.pop("t", 0.0)
    words = [f"{key} {value}" for key, value in fields.items() if isinstance(value, str | int | float) and value != ""]
    show.out.print(f"{event.n:>5}  {t:9.1f} s  {kind:<10} {', '.join(words)[:160]}")
