"""``fieldhand report``: judge a mission by its event log, and write its report."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import DisplayOptions, RecordedArgument, RecordedOptions
from fieldhand.cli.outputs import to_folder


@grouped("source task site robot output lenient lang missions json")
def report(
    recorded: RecordedOptions,
    display: DisplayOptions,
    source: RecordedArgument = None,
    task: Annotated[
        Path | None, typer.Option("--task", help="Task document or signed mission of an event log.")
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--out", callback=to_folder, help="Folder for the report.")] = Path(
        "report"
    ),
) -> None:
    """Judge a mission and report it; exit status 1 unless it completed with every goal met and no limit exceeded."""
    from fieldhand import finished_missions
    from fieldhand.cli import show
    from fieldhand.cli.recorded import recorded_mission
    from fieldhand.evaluation.report.log_facts import end_of
    from fieldhand.evaluation.report.reading_statistics import statistics_record
    from fieldhand.language import message
    from fieldhand.task.exceeded import say_status
    from fieldhand.wording.events import goal_names

    language = display.language
    plan, log = recorded_mission(source, task, recorded, language)
    files, assessment = finished_missions.report_log(
        output,
        log,
        plan.task,
        plan.document,
        plan.site_and_robot.site,
        plan.site_and_robot.robot,
        authorization=plan.authorization,
        signed=plan.signed,
        hashes=plan.hashes,
    )
    ended = end_of(log.events)
    status = 0 if assessment.success else 1
    if display.json:
        record = show.mission_record(plan.task, "", ended, assessment, list(files.paths))
        approved = None if plan.authorization is None else asdict(plan.authorization)
        read = statistics_record(plan.site_and_robot.site, log.events)
        show.print_json(record | {"readings": read, "authorization": approved, "signed": plan.signed})
        raise SystemExit(status)
    show.show_outcomes(assessment, goal_names(plan.task, plan.site_and_robot.robot), language)
    how = None if assessment.status is None else say_status(assessment.status)
    end = message("Mission {how}.", how=how) if how else message("The log ends before the mission does.")
    show.out.print_lines("", language.say(end))
    show.heading(language.say(message("Files")))
    for path in files.paths:
        show.out.print(f"  {path}")
    raise SystemExit(status)
