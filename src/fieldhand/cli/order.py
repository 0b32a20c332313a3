"""``fieldhand order``: start, pause, resume or abort a mission on a robot, or call the robot back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.links import LinkOptions, MissionOfRobot, UrlArgument
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption
from fieldhand.compatibility import datetime_from_iso

if TYPE_CHECKING:
    from datetime import datetime


@grouped("url command mission because run token_file ca pin insecure json")
def order(
    url: UrlArgument,
    command: Annotated[str, typer.Argument(metavar="ORDER", help="start, pause, resume, return, abort or cancel.")],
    link: LinkOptions,
    mission: MissionOfRobot = None,
    because: Annotated[str, typer.Option("--because", help="Why, in words; the event log keeps it.")] = "",
    run: Annotated[
        str | None,
        typer.Option("--run", help="With cancel: the time of the one run to leave out, as fieldhand runs prints it."),
    ] = None,
    json: JsonOption = False,
) -> None:
    """Tell a mission on a robot to start, pause, resume, return (come home) or abort (stop here).

    ``cancel`` ends the timetable of a mission, or with ``--run`` leaves out one run.

    Exit status 1 if the mission has not received it yet, or has ended.
    """
    from contextlib import closing

    from fieldhand.cli import show
    from fieldhand.cli.links import find_mission, state_line
    from fieldhand.execution.operator_commands import parse_agent_command

    word = parse_agent_command(command)
    due = None if run is None else parse_run(run)
    with closing(link.open(url)) as client:
        # Without the name of a mission, the order is sent at once: a stop must not wait for a list of missions.
        heard = client.order_now(word, because) if mission is None and word not in ("start", "cancel") else None
        if heard is None:
            heard = client.order(find_mission(client, mission).bundle, word, because, due=due)
    if json:
        show.print_json(heard.model_dump())
    else:
        show.out.print(state_line(heard.mission))
        if not heard.heard:
            show.note("the mission has not answered yet; the order remains in force")
    raise SystemExit(0 if heard.heard else 1)


def parse_run(text: str) -> datetime:
    """Return the time of a run.

    Raises:
        InputError: The text is not a date and time with its offset from UTC.
    """

    from fieldhand.errors import InputError

    try:
        found = datetime_from_iso(text)
    except ValueError:
        found = None
    if found is None or found.tzinfo is None:
        raise InputError(
            f"'{text[:40]}' is not the time of a run",
            where="--run",
            advice="copy it from fieldhand runs, such as 2027-03-02T06:30:00+00:00",
        )
    return found
