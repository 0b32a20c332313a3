"""``fieldhand demo``: plan, approve, carry out and judge a mission on a built-in site, without key or network."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

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
from fieldhand.compatibility import StrEnum

if TYPE_CHECKING:
    from fieldhand.execution.drivers.simulation.world import ScriptedEvent


class DemoName(StrEnum):
    """A mission of the demo."""

    PICTURES = "pictures"
    MOWING = "mowing"


@dataclass(frozen=True, kw_only=True)
class DemoMission:
    """A mission that the demo shows.

    Attributes:
        request: Request in English.
        site, robot: Names of the built-in site and robot.
        commands: Commands to try next.
        someone_near: Seconds of the mission from which and until which somebody is near the robot.
    """

    request: str
    site: str
    robot: str
    commands: tuple[str, ...]
    someone_near: tuple[float, float] | None = None

    def events(self) -> tuple[ScriptedEvent, ...]:
        """Return what happens around the robot."""
        from fieldhand.execution.drivers.simulation.world import ScriptedEvent

        if self.someone_near is None:
            return ()
        from_s, until_s = self.someone_near
        return (ScriptedEvent(event="person_near", from_s=from_s, until_s=until_s),)


MISSIONS = {
    DemoName.PICTURES: DemoMission(
        request=(
            "Take a thermal picture at the four corner trees, in any order, and where the canopy is hotter than 34 °C"
            " measure CO2 too. Then take pictures of as many Carmel trees in the northern half as you can without"
            " driving more than 450 meters."
        ),
        site="demo",
        robot="husky",
        commands=(
            'fieldhand plan "Take pictures of the 5 trees with the highest yield." --site demo',
            'fieldhand run "Measure CO2 at tree 4. If it is low, take 2 pictures of nearby trees." --site demo',
            "fieldhand site demo --picture orchard.png",
            "fieldhand demo mowing",
            "fieldhand serve",
        ),
    ),
    DemoName.MOWING: DemoMission(
        request=(
            "Mow the aisles between rows 1 and 5 of the south block, then spray these rows with 250 l/ha. If someone is"
            " near, wait until they are gone. Then measure the soil moisture at the 4 vines with the lowest vigor in"
            " these rows. Recharge when the battery is below 40 %."
        ),
        site="vineyard",
        robot="tractor",
        someone_near=(200.0, 245.0),
        commands=(
            'fieldhand plan "Spray every second row of the north block." --site vineyard --robot tractor',
            'fieldhand run "Film row 3 of the north block from both sides." --site vineyard --robot tractor',
            'fieldhand plan "Mow the meadow every Monday at 7 am." --site vineyard --robot tractor',
            "fieldhand site vineyard --picture vineyard.png",
            "fieldhand robot tractor",
        ),
    ),
}


@grouped("name output seed lang on domain namespace sim_time driver_option")
def demo(
    driver: DriverOptions,
    name: Annotated[DemoName, typer.Argument(help="The mission to show.")] = DemoName.PICTURES,
    output: Annotated[
        Path, typer.Option("-o", "--out", callback=to_folder, help="Folder for Task, map, events and report.")
    ] = Path("out"),
    seed: SeedOption = 7,
    lang: LangOption = None,
) -> None:
    """Plan, approve, drive and judge a mission on the built-in orchard, or on the vineyard with a tractor."""
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

    mission, display = MISSIONS[name], DisplayOptions(lang=lang)
    language = display.language
    require_unsigned_allowed(os.environ)
    connection = connection_of(driver, os.environ)
    site_and_robot, files = read_site_and_robot(mission.site, mission.robot, language=language)
    draft = draft_mission(
        mission.request,
        OpenedInputs(site_and_robot=site_and_robot, files=files),
        PlanningOptions(planner="english"),
        display,
    )
    # Nobody reads the warning that the budget is tight; it is printed, and the report names it as confirmed.
    approval = ApprovalOptions(yes=True, confirm=True, by="demo")
    with connected(site_and_robot, draft.task, connection, display) as vehicle:
        settings = RunSettings(
            approval=approval,
            display=display,
            outputs=OutputOptions(output=output),
            world=World(events=mission.events()),
            seed=seed,
            vehicle=vehicle,
        )
        status = run_mission(draft, settings)
    show.heading(language.say(message("Try next")))
    if shutil.which("fieldhand") is None:
        show.out.print("  . .venv/bin/activate")
    for line in mission.commands:
        show.out.print(f"  {line}")
    raise SystemExit(status)
