"""``fieldhand report``: judge and report a mission from its event log."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.options import JsonOption, LenientOption, RobotOption, SiteOption


def report(
    events: Annotated[Path, typer.Argument(help="An event log (JSON lines or MCAP), whole or cut off.")],
    task: Annotated[Path, typer.Option("--task", help="The Task document that was carried out.")],
    site: SiteOption,
    robot: RobotOption = "husky",
    output: Annotated[Path, typer.Option("-o", "--out", help="Folder for the report.")] = Path("report"),
    lenient: LenientOption = False,
    json: JsonOption = False,
) -> None:
    """Judge a mission from its event log and report it; exit status 1 unless it completed with every goal met."""
    from fieldhand import mission, past
    from fieldhand.cli import show
    from fieldhand.cli.inputs import open_ground
    from fieldhand.evaluation.report_facts import end_of
    from fieldhand.evaluation.telling import goal_names

    ground = open_ground(site, robot, lenient=lenient)
    read, document = mission.read_task(task, ground.robot)
    files, assessment, log = past.report_log(output, events, read, document, ground.site, ground.robot)
    ended = end_of(log)
    status = 0 if ended is not None and ended.status == "completed" and assessment.success else 1
    if json:
        show.print_json(show.mission_record(read, "", ended, assessment.outcomes, list(files.paths)))
        raise SystemExit(status)
    show.show_outcomes(assessment.outcomes, goal_names(read, ground.robot))
    show.out.print(f"\nMission {ended.status}." if ended else "\nThe log ends before the mission does.")
    show.heading("Where to look")
    for path in files.paths:
        show.out.print(f"  {path}")
    raise SystemExit(status)
