"""``fieldhand run``: a request, a Task or a signed mission, carried out in simulation or by a robot, and judged."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.driver_options import DomainOption, DriverOption, NamespaceOption, OnOption, SimTimeOption
from fieldhand.cli.options import (
    AnswerOption,
    AssumeOption,
    ByOption,
    ConfirmOption,
    EventsOption,
    JsonOption,
    LangOption,
    LeaveOption,
    LenientOption,
    McapOption,
    MissionRobotOption,
    MissionSiteOption,
    MissionsOption,
    PlannerOption,
    ProductionOption,
    SpeedOption,
    TranscriptOption,
)


def run(
    request: Annotated[
        str,
        typer.Argument(help="What the robot should do, in plain words; a Task (.xml); a signed mission (.mission)."),
    ],
    site: MissionSiteOption = None,
    robot: MissionRobotOption = None,
    planner: PlannerOption = "auto",
    world: Annotated[Path | None, typer.Option("--world", help="What sensors read, and what goes wrong.")] = None,
    seed: Annotated[
        int | None, typer.Option("--seed", min=0, help="Same seed, same mission; else the world's, else 0.")
    ] = None,
    events: EventsOption = None,
    mcap: McapOption = None,
    output: LeaveOption = None,
    speed: SpeedOption = None,
    on: OnOption = None,
    domain: DomainOption = None,
    namespace: NamespaceOption = None,
    sim_time: SimTimeOption = False,
    driver_option: DriverOption = None,
    yes: Annotated[bool, typer.Option("--yes", "-y", help="Approve without asking.")] = False,
    confirm: ConfirmOption = False,
    by: ByOption = None,
    production: ProductionOption = False,
    no_history: Annotated[
        bool, typer.Option("--no-history", help="Do not keep what the mission cost, for fieldhand robot calibrate.")
    ] = False,
    answer: AnswerOption = None,
    assume: AssumeOption = False,
    transcript: TranscriptOption = None,
    lenient: LenientOption = False,
    lang: LangOption = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Carry a mission out and judge it: plan and approve it first, unless it is signed."""
    import os
    from dataclasses import replace

    from fieldhand import finished_missions, mission, missions
    from fieldhand.approval.production import require_unsigned_allowed
    from fieldhand.cli import show
    from fieldhand.cli.asking import Replies, plan_or_read, require_no_answer
    from fieldhand.cli.bundles import is_bundle, open_mission, require_site, tell_signer
    from fieldhand.cli.driver_options import connected, connection_of, refuse_simulation_options
    from fieldhand.cli.flight import Kept, Orders, fly, parse_speed
    from fieldhand.cli.inputs import InputFiles, read_ground
    from fieldhand.cli.outputs import require_folder
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.drivers.simulation.world_file import load_world
    from fieldhand.language import spoken
    from fieldhand.mission.documents import SiteAndRobot

    language = spoken(lang, os.environ)
    pace = parse_speed(speed)
    connection = connection_of(
        on, domain, namespace, sim_time=sim_time, environ=os.environ, options=driver_option or ()
    )
    refuse_simulation_options(connection, world=world, speed=speed)
    under = kept or missions.missions_folder(os.environ)
    require_folder(under, f"--missions {under}")
    bundle = open_mission(request, site, robot, lenient=lenient) if is_bundle(request) else None
    if bundle is None:
        require_unsigned_allowed(os.environ, asked=production)
        ground, files = read_ground(require_site(site), robot or "husky", lenient=lenient, language=language)
    else:
        ground = SiteAndRobot(site=bundle.site, robot=bundle.robot)
        files = InputFiles(site=bundle.files, profile=bundle.profile, lenient=bundle.manifest.site.lenient)
        if not json:
            show.out.print(language.say(tell_signer(bundle)))
    given = World() if world is None else load_world(world)
    mission.check_world(given, ground.site, ground.robot)
    authorized = None if bundle is None else bundle.authorized
    if bundle is None:
        replies = Replies(
            given=tuple(answer or ()),
            assume=assume,
            ask=not json,
            progress=None if json else language,
            language=language,
        )
        task, document, planned_by = plan_or_read(request, ground, planner, transcript, replies)
    else:
        require_no_answer(answer or (), request)
        task, document, planned_by = bundle.authorized.task, None, bundle.manifest.task.planner
    orders = Orders(
        ask=not yes,
        confirm=confirm,
        by=by,
        world=given,
        seed=given.seed if seed is None else seed,
        speed=pace,
        log=events,
        mcap=mcap,
        folder=output,
        history=None if no_history else finished_missions.history_folder(os.environ),
        quiet=json,
        language=language,
        kept=Kept(under=under, files=files),
        bundle=bundle,
    )
    with connected(ground, task, connection, quiet=json, language=language) as vehicle:
        given_to = replace(orders, vehicle=vehicle)
        raise SystemExit(fly(ground, task, document, given_to, planner=planned_by, authorized=authorized))
