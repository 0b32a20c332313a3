"""``fieldhand resume``: go on with a mission that was cut off, or that is paused."""

from __future__ import annotations

import os

from fieldhand.cli.driver_options import DomainOption, DriverOption, NamespaceOption, OnOption, SimTimeOption
from fieldhand.cli.options import (
    EventsOption,
    JsonOption,
    LangOption,
    LeaveOption,
    McapOption,
    MissionArgument,
    MissionsOption,
    ProductionOption,
    SpeedOption,
)


def resume(
    mission: MissionArgument = None,
    events: EventsOption = None,
    output: LeaveOption = None,
    speed: SpeedOption = None,
    on: OnOption = None,
    domain: DomainOption = None,
    namespace: NamespaceOption = None,
    sim_time: SimTimeOption = False,
    driver_option: DriverOption = None,
    mcap: McapOption = None,
    production: ProductionOption = False,
    lang: LangOption = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Go on with a mission that a power cut has cut off, from where it was; or end the pause of one under way."""
    from dataclasses import replace

    from fieldhand import finished_missions, missions
    from fieldhand import mission as steps
    from fieldhand.approval.production import require_unsigned_allowed
    from fieldhand.cli import show
    from fieldhand.cli.bundles import tell_signer, verify
    from fieldhand.cli.driver_options import connected, connection_again, refuse_simulation_options
    from fieldhand.cli.flight import Orders, conclude, go_on, leave_plan, parse_speed
    from fieldhand.cli.tell import tell
    from fieldhand.language import message, spoken
    from fieldhand.mission.documents import SiteAndRobot

    language = spoken(lang, os.environ)
    pace = parse_speed(speed)
    folder = missions.find(kept or missions.missions_folder(os.environ), mission)
    if missions.is_running(folder):
        tell(str(folder), folder.parent, "continue", "the operator", message("goes on"), json=json, language=language)
        return
    contents = missions.read_folder(folder)
    connection = connection_again(
        folder.name,
        contents.departure,
        on,
        domain,
        namespace,
        sim_time=sim_time,
        environ=os.environ,
        options=driver_option,
    )
    refuse_simulation_options(connection, world=None, speed=speed)
    if contents.signed is None:
        require_unsigned_allowed(os.environ, asked=production)
    given = contents.mission(verify)
    if given.bundle is not None and not json:
        show.out.print(language.say(tell_signer(given.bundle)))
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
        history=finished_missions.history_folder(os.environ),
        quiet=json,
        language=language,
        bundle=given.bundle,
    )
    ground = SiteAndRobot(site=given.site, robot=given.robot)
    review = steps.review(given.authorized.task, given.site, given.robot)
    approved = steps.ApprovedMission(
        authorized=given.authorized, site=given.site, robot=given.robot, estimate=review.estimate
    )
    with connected(ground, given.authorized.task, connection, quiet=json, language=language) as vehicle:
        if vehicle is not None:
            missions.require_in_place(given.site, given.robot, vehicle.driver)
        leave_plan(ground, review, None, orders)
        done = go_on(given, replace(orders, vehicle=vehicle))
        raise SystemExit(conclude(approved, done, orders, given.planner, given.id))
