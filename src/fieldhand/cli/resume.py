"""``fieldhand resume``: go on with a mission that was cut off, or that is paused."""

from __future__ import annotations

import os
from typing import Annotated

import typer

from fieldhand.cli.options import (
    EventsOption,
    JsonOption,
    LangOption,
    LeaveOption,
    McapOption,
    MissionArgument,
    MissionsOption,
    ProductionOption,
)


def resume(
    mission: MissionArgument = None,
    events: EventsOption = None,
    output: LeaveOption = None,
    speed: Annotated[
        str, typer.Option("--speed", help="max, or simulated seconds in a second (1 is real time).")
    ] = "max",
    mcap: McapOption = None,
    production: ProductionOption = False,
    lang: LangOption = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Go on with a mission that a power cut has cut off, from where it was; or end the pause of one under way."""
    from fieldhand import mission as steps
    from fieldhand import missions, past
    from fieldhand.approval.production import require_unsigned_allowed
    from fieldhand.cli import show
    from fieldhand.cli.bundles import tell_signer, verify
    from fieldhand.cli.flight import Orders, conclude, go_on, leave_plan, parse_speed
    from fieldhand.cli.inputs import Ground
    from fieldhand.cli.tell import tell
    from fieldhand.language import spoken

    pace = parse_speed(speed)
    folder = missions.find(kept or missions.missions_folder(os.environ), mission)
    if missions.is_running(folder):
        tell(str(folder), folder.parent, "continue", "the operator", "goes on", json=json)
        return
    if not missions.is_signed(folder):
        require_unsigned_allowed(os.environ, asked=production)
    given = missions.open_mission(folder, verify)
    if given.bundle is not None and not json:
        show.out.print(tell_signer(given.bundle))
    if missions.last_order(folder) == "pause":
        missions.order(folder, "continue", "resumed by the operator")
    orders = Orders(
        ask=False,
        by=None,
        world=given.world,
        seed=given.seed,
        speed=pace,
        log=events,
        mcap=mcap,
        folder=output,
        history=past.history_folder(os.environ),
        quiet=json,
        language=spoken(lang, os.environ),
        bundle=given.bundle,
    )
    ground = Ground(site=given.site, robot=given.robot)
    review = steps.review(given.authorized.task, given.site, given.robot)
    leave_plan(ground, review, None, orders)
    done = go_on(given, orders)
    raise SystemExit(conclude(ground, review, given.authorized, done, orders, given.planner, given.id))
