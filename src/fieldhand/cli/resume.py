"""``fieldhand resume``: continue a mission that was interrupted or is paused."""

from __future__ import annotations

import os

from fieldhand.cli.driver_options import DriverOptions
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import DisplayOptions, MissionArgument, OutputOptions, SpeedOption, StoreOptions


@grouped("mission events output speed on domain namespace sim_time driver_option mcap production lang missions json")
def resume(
    outputs: OutputOptions,
    driver: DriverOptions,
    store: StoreOptions,
    display: DisplayOptions,
    mission: MissionArgument = None,
    speed: SpeedOption = None,
) -> None:
    """Resume an interrupted mission from where it stopped, or end the pause of a running one."""
    from dataclasses import replace

    from fieldhand import finished_missions
    from fieldhand import mission as steps
    from fieldhand import missions as stored_missions
    from fieldhand.approval.production import require_unsigned_allowed
    from fieldhand.cli import show
    from fieldhand.cli.bundles import approval_line, verify
    from fieldhand.cli.driver_options import connected, connection_again, parse_speed, refuse_simulation_options
    from fieldhand.cli.options import ApprovalOptions
    from fieldhand.cli.run_mission import RunSettings, conclude, resume_mission, write_plan
    from fieldhand.cli.tell import tell
    from fieldhand.language import message
    from fieldhand.mission.documents import SiteAndRobot

    language = display.language
    simulation_speed = parse_speed(speed)
    folder = stored_missions.find(store.missions or stored_missions.missions_folder(os.environ), mission)
    if stored_missions.is_running(folder):
        tell(str(folder), folder.parent, "continue", "the operator", message("continues"), display)
        return
    contents = stored_missions.read_folder(folder)
    connection = connection_again(folder.name, contents.started_on, driver, os.environ)
    refuse_simulation_options(connection, world=None, speed=speed)
    if contents.signed is None:
        require_unsigned_allowed(os.environ, asked=store.production)
    stored = contents.mission(verify)
    if stored.bundle is not None and not display.json:
        show.out.print(language.say(approval_line(stored.bundle)))
    if stored_missions.last_command(folder) == "pause":
        stored_missions.send_command(folder, "continue", "resumed by the operator")
    settings = RunSettings(
        approval=ApprovalOptions(yes=True),
        display=display,
        outputs=outputs,
        world=stored.world,
        seed=stored.seed,
        speed=simulation_speed,
        history=finished_missions.history_folder(os.environ),
    )
    site_and_robot, task = SiteAndRobot(site=stored.site, robot=stored.robot), stored.authorized.task
    review = steps.review(task, stored.site, stored.robot)
    approved = steps.approved_earlier(stored.authorized, review)
    with connected(site_and_robot, task, connection, display) as vehicle:
        if vehicle is not None:
            stored_missions.require_in_place(stored.site, stored.robot, vehicle.driver)
        write_plan(review, None, settings)
        events = resume_mission(stored, replace(settings, vehicle=vehicle))
        raise SystemExit(
            conclude(
                approved,
                events,
                settings,
                planner=stored.planner,
                name=stored.id,
                bundle=stored.bundle,
                images=stored.folder,
            )
        )
