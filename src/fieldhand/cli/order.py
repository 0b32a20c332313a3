"""``fieldhand order``: start, pause, resume or abort a mission on a robot, or call the robot back."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldhand.cli.links import LinkOptions, MissionOfRobot, UrlArgument
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption


@grouped("url command mission because token_file ca pin insecure json")
def order(
    url: UrlArgument,
    command: Annotated[str, typer.Argument(metavar="ORDER", help="start, pause, resume, return or abort.")],
    link: LinkOptions,
    mission: MissionOfRobot = None,
    because: Annotated[str, typer.Option("--because", help="Why, in words; the event log keeps it.")] = "",
    json: JsonOption = False,
) -> None:
    """Tell a mission on a robot to start, pause, resume, return (come home) or abort (stop here).

    Exit status 1 if the mission has not received it yet, or has ended.
    """
    from contextlib import closing

    from fieldhand.cli import show
    from fieldhand.cli.links import find_mission, state_line
    from fieldhand.execution.operator_commands import parse_agent_command

    word = parse_agent_command(command)
    with closing(link.open(url)) as client:
        # Without the name of a mission, the order is sent at once: a stop must not wait for a list of missions.
        heard = client.order_now(word, because) if mission is None and word != "start" else None
        if heard is None:
            heard = client.order(find_mission(client, mission).bundle, word, because)
    if json:
        show.print_json(heard.model_dump())
    else:
        show.out.print(state_line(heard.mission))
        if not heard.heard:
            show.note("the mission has not answered yet; the order remains in force")
    raise SystemExit(0 if heard.heard else 1)
