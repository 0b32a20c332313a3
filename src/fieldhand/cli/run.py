"""``fieldhand run``: a request or a Task, planned, approved, carried out in simulation, judged."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.options import (
    AnswerOption,
    AssumeOption,
    JsonOption,
    LangOption,
    LenientOption,
    PlannerOption,
    RobotOption,
    SiteOption,
    TranscriptOption,
)


def run(
    request: Annotated[str, typer.Argument(help="What the robot should do, in plain words, or a Task (.xml).")],
    site: SiteOption,
    robot: RobotOption = "husky",
    planner: PlannerOption = "auto",
    world: Annotated[Path | None, typer.Option("--world", help="What sensors read, and what goes wrong.")] = None,
    seed: Annotated[
        int | None, typer.Option("--seed", min=0, help="Same seed, same mission; else the world's, else 0.")
    ] = None,
    events: Annotated[Path | None, typer.Option("--events", help="Write the event log (JSON lines) here.")] = None,
    output: Annotated[Path | None, typer.Option("-o", "--out", help="Folder for Task, map, events and report.")] = None,
    speed: Annotated[
        str, typer.Option("--speed", help="max, or simulated seconds in a second (1 is real time).")
    ] = "max",
    yes: Annotated[bool, typer.Option("--yes", "-y", help="Approve without asking.")] = False,
    confirm: Annotated[
        bool, typer.Option("--confirm", help="Confirm every warning without asking; --yes alone does not.")
    ] = False,
    by: Annotated[str | None, typer.Option("--by", help="Who approves; else the user who is logged in.")] = None,
    no_history: Annotated[
        bool, typer.Option("--no-history", help="Do not keep what the mission cost, for fieldhand robot calibrate.")
    ] = False,
    answer: AnswerOption = None,
    assume: AssumeOption = False,
    transcript: TranscriptOption = None,
    lenient: LenientOption = False,
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Plan, approve and carry out a mission in simulation, then judge it."""
    import os

    from fieldhand import mission, past
    from fieldhand.cli.asking import Replies, plan_or_read
    from fieldhand.cli.flight import Orders, fly, parse_speed
    from fieldhand.cli.inputs import open_ground
    from fieldhand.execution.world import World, load_world
    from fieldhand.language import spoken

    language = spoken(lang, os.environ)
    pace = parse_speed(speed)
    ground = open_ground(site, robot, lenient=lenient)
    given = World() if world is None else load_world(world)
    mission.check_world(given, ground.site, ground.robot)
    replies = Replies(given=tuple(answer or ()), assume=assume, ask=not json)
    task, document, planned_by = plan_or_read(request, ground, planner, transcript, replies)
    orders = Orders(
        ask=not yes,
        confirm=confirm,
        by=by,
        world=given,
        seed=given.seed if seed is None else seed,
        speed=pace,
        log=events,
        folder=output,
        history=None if no_history else past.history_folder(os.environ),
        quiet=json,
        language=language,
    )
    raise SystemExit(fly(ground, task, document, orders, planner=planned_by))
