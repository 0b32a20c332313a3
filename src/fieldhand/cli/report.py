"""``fieldhand report``: judge and report a mission from its event log."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.options import JsonOption, LangOption, LenientOption, MissionsOption, RecordedSiteOption
from fieldhand.cli.outputs import to_folder


def report(
    given: Annotated[
        str | None,
        typer.Argument(
            metavar="[MISSION|EVENTS]",
            help="Name or folder of a mission, else the one begun last; or an event log (JSON lines or MCAP).",
        ),
    ] = None,
    task: Annotated[
        Path | None, typer.Option("--task", help="Of a log: the Task document or signed mission that was carried out.")
    ] = None,
    site: RecordedSiteOption = None,
    robot: Annotated[str | None, typer.Option("--robot", help="Of a log: the robot; husky if none is given.")] = None,
    output: Annotated[Path, typer.Option("-o", "--out", callback=to_folder, help="Folder for the report.")] = Path(
        "report"
    ),
    lenient: LenientOption = False,
    lang: LangOption = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Judge a mission and report it; exit status 1 unless it completed with every goal met and no limit exceeded."""
    import os

    from fieldhand import finished_missions
    from fieldhand.cli import show
    from fieldhand.cli.recorded import folder_of, log_of_folder, plan_of_files, plan_of_folder, require_nothing_beside
    from fieldhand.errors import InputError
    from fieldhand.evaluation.event_text import goal_names
    from fieldhand.evaluation.report.log_facts import end_of
    from fieldhand.language import message, spoken
    from fieldhand.task.exceeded import say_status

    language = spoken(lang, os.environ)
    folder = folder_of(given, kept)
    if folder is not None:
        require_nothing_beside(folder, task=task, site=site, robot=robot)
        plan, log = plan_of_folder(folder), log_of_folder(folder)
    elif task is None:
        raise InputError(
            message("what was carried out is not given"),
            where="--task",
            advice=message("give the Task document or the signed mission; or the mission by its name"),
        )
    else:
        plan, log = (
            plan_of_files(task, site, robot, lenient=lenient, language=language),
            finished_missions.read_log(Path(given or "")),
        )
    files, assessment = finished_missions.report_log(
        output,
        log,
        plan.task,
        plan.document,
        plan.ground.site,
        plan.ground.robot,
        authorization=plan.authorization,
        signed=plan.signed,
        hashes=plan.hashes,
    )
    ended = end_of(log.events)
    status = 0 if assessment.success else 1
    if json:
        record = show.mission_record(plan.task, "", ended, assessment, list(files.paths))
        approved = None if plan.authorization is None else asdict(plan.authorization)
        show.print_json(record | {"authorization": approved, "signed": plan.signed})
        raise SystemExit(status)
    show.show_outcomes(assessment, goal_names(plan.task, plan.ground.robot), language)
    how = None if assessment.status is None else say_status(assessment.status)
    said = message("Mission {how}.", how=how) if how else message("The log ends before the mission does.")
    show.out.print_lines("", language.say(said))
    show.heading(language.say(message("Where to look")))
    for path in files.paths:
        show.out.print(f"  {path}")
    raise SystemExit(status)
