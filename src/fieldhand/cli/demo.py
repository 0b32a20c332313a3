"""``fieldhand demo``: plan, approve, carry out and judge a mission on the built-in orchard, without key or network."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.driver_options import DriverOptions
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import (
    ApprovalOptions,
    DisplayOptions,
    LangOption,
    OutputOptions,
    PlanningOptions,
    SeedOption,
)
from fieldhand.cli.outputs import to_folder

REQUEST = (
    "Take a thermal picture at the four corner trees, in any order, and where the canopy is hotter than 34 °C measure"
    " CO2 too. Then take pictures of as many Carmel trees in the northern half as you can without driving more than"
    " 450 meters."
)


@grouped("output seed lang on domain namespace sim_time driver_option")
def demo(
    driver: DriverOptions,
    output: Annotated[
        Path, typer.Option("-o", "--out", callback=to_folder, help="Folder for Task, map, events and report.")
    ] = Path("out"),
    seed: SeedOption = 7,
    lang: LangOption = None,
) -> None:
    """Plan, approve, drive and judge a mission on the built-in orchard."""
    import os
    import shutil

    from fieldhand.approval.production import require_unsigned_allowed
    from fieldhand.cli import show
    from fieldhand.cli.draft import OpenedInputs, draft_mission
    from fieldhand.cli.driver_options import connected, connection_of
    from fieldhand.cli.inputs import read_site_and_robot
    from fieldhand.cli.run_mission import RunSettings, run_mission
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.language import message

    display = DisplayOptions(lang=lang)
    language = display.language
    require_unsigned_allowed(os.environ)
    connection = connection_of(driver, os.environ)
    site_and_robot, files = read_site_and_robot("demo", "husky", language=language)
    draft = draft_mission(
        REQUEST, OpenedInputs(site_and_robot=site_and_robot, files=files), PlanningOptions(planner="english"), display
    )
    # Nobody reads the warning that the budget is tight; it is printed, and the report names it as confirmed.
    approval = ApprovalOptions(yes=True, confirm=True, by="demo")
    with connected(site_and_robot, draft.task, connection, display) as vehicle:
        settings = RunSettings(
            approval=approval,
            display=display,
            outputs=OutputOptions(output=output),
            world=World(),
            seed=seed,
            vehicle=vehicle,
        )
        status = run_mission(draft, settings)
    show.heading(language.say(message("Try next")))
    if shutil.which("fieldhand") is None:
        show.out.print("  . .venv/bin/activate")
    for line in (
        'fieldhand plan "Take pictures of the 5 trees with the highest yield." --site demo',
        'fieldhand run "Measure CO2 at the middle tree. If it is low, take 2 pictures of nearby trees." --site demo',
        "fieldhand site demo --picture orchard.png",
        "fieldhand robot husky",
        "fieldhand serve",
    ):
        show.out.print(f"  {line}")
    raise SystemExit(status)
