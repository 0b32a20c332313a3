"""``fieldhand order``: tell a mission on a robot elsewhere to start, pause, resume, return or abort."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldhand.cli.links import CaOption, InsecureOption, MissionOfRobot, PinOption, TokenFileOption, UrlArgument
from fieldhand.cli.options import JsonOption


def order(
    url: UrlArgument,
    said: Annotated[str, typer.Argument(metavar="ORDER", help="start, pause, resume, return or abort.")],
    mission: MissionOfRobot = None,
    because: Annotated[str, typer.Option("--because", help="Why, in words; the event log keeps it.")] = "",
    token_file: TokenFileOption = None,
    ca: CaOption = None,
    pin: PinOption = None,
    insecure: InsecureOption = False,
    json: JsonOption = False,
) -> None:
    """Tell a mission on a robot to start, pause, resume, return (come home) or abort (stop here).

    Exit status 1 if it has not heard it yet, or has ended.
    """
    from contextlib import closing

    from fieldhand.cli import show
    from fieldhand.cli.links import find_mission, open_robot_client, state_line, trust_of
    from fieldhand.execution.operator_commands import parse_agent_command

    word = parse_agent_command(said)
    with closing(open_robot_client(url, token_file, trust_of(ca, pin, insecure=insecure))) as link:
        # Without a mission nothing is looked up first: whoever wants the robot to stop shall not wait for a list.
        heard = link.order_now(word, because) if mission is None and word != "start" else None
        if heard is None:
            heard = link.order(find_mission(link, mission).bundle, word, because)
    if json:
        show.print_json(heard.model_dump())
    else:
        show.out.print(state_line(heard.mission))
        if not heard.heard:
            show.note("the mission has not answered yet; the order stands")
    raise SystemExit(0 if heard.heard else 1)
