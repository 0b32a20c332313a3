"""``fieldhand run``: plan and approve a request, or verify a signed mission; carry it out, and judge it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.driver_options import DriverOptions
from fieldhand.cli.earlier import EarlierOptions
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import (
    ApprovalOptions,
    DisplayOptions,
    MissionInputOptions,
    OutputOptions,
    PlanningOptions,
    SpeedOption,
    StoreOptions,
)


@dataclass(frozen=True, kw_only=True)
class SimulationOptions:
    """World, seed and speed of a simulation."""

    world: Annotated[
        Path | None, typer.Option("--world", help="World file: sensor readings and faults of the simulation.")
    ] = None
    seed: Annotated[
        int | None, typer.Option("--seed", min=0, help="Seed of the simulation; else the world's, else 0.")
    ] = None
    speed: SpeedOption = None


@grouped(
    "request site robot planner world seed events mcap output speed on domain namespace sim_time driver_option"
    " yes confirm by production no_history answer assume transcript lenient lang missions count_simulated recount json"
)
def run(
    request: Annotated[
        str,
        typer.Argument(help="What the robot should do, in plain words; a Task (.xml); a signed mission (.mission)."),
    ],
    inputs: MissionInputOptions,
    planning: PlanningOptions,
    simulation: SimulationOptions,
    outputs: OutputOptions,
    driver: DriverOptions,
    approval: ApprovalOptions,
    store: StoreOptions,
    earlier: EarlierOptions,
    display: DisplayOptions,
    no_history: Annotated[
        bool, typer.Option("--no-history", help="Do not record the cost of the mission for fieldhand robot calibrate.")
    ] = False,
) -> None:
    """Carry a mission out and judge it: plan and approve it first, unless it is signed."""
    import os
    from dataclasses import replace

    from fieldhand import finished_missions, mission, missions
    from fieldhand.cli.draft import draft_mission, open_inputs
    from fieldhand.cli.driver_options import connected, connection_of, parse_speed, refuse_simulation_options
    from fieldhand.cli.outputs import require_folder
    from fieldhand.cli.run_mission import MissionFolder, RunSettings, run_mission

    speed = parse_speed(simulation.speed)
    connection = connection_of(driver, os.environ)
    refuse_simulation_options(connection, world=simulation.world, speed=simulation.speed)
    parent = store.missions or missions.missions_folder(os.environ)
    require_folder(parent, f"--missions {parent}")
    opened = open_inputs(request, inputs, display, production=store.production)
    world = mission.read_world(simulation.world, opened.site_and_robot.site, opened.site_and_robot.robot)
    draft = draft_mission(request, opened, planning, display, earlier, parent)
    settings = RunSettings(
        approval=approval,
        display=display,
        outputs=outputs,
        world=world,
        seed=world.seed if simulation.seed is None else simulation.seed,
        speed=speed,
        history=None if no_history else finished_missions.history_folder(os.environ),
        folder=MissionFolder(parent=parent, files=opened.files),
    )
    with connected(draft.site_and_robot, draft.task, connection, display) as vehicle:
        raise SystemExit(run_mission(draft, replace(settings, vehicle=vehicle)))
