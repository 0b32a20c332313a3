"""One mission at the command line, from its review to its report, as ``run``, ``demo`` and ``resume`` need it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand import finished_missions, mission, missions
from fieldhand.cli import show
from fieldhand.cli.approving import approve_plan, review_plan
from fieldhand.cli.bundles import signer_record
from fieldhand.cli.draft import MissionDraft
from fieldhand.cli.driver_options import check_start
from fieldhand.cli.inputs import write_file
from fieldhand.cli.options import ApprovalOptions, DisplayOptions, OutputOptions
from fieldhand.cli.outputs import mission_files
from fieldhand.compatibility import UTC
from fieldhand.language import kept_in_log, message
from fieldhand.mission.documents import InputFiles
from fieldhand.task.results import Ended, Event, MissionStatus

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class MissionFolder:
    """Folder in which a mission is stored, and the files that are copied to it.

    Attributes:
        parent: Folder of all missions.
        files: Files of the site and the robot.
    """

    parent: Path
    files: InputFiles


@dataclass(frozen=True, kw_only=True)
class RunSettings:
    """Settings of a run at the command line.

    Attributes:
        approval: Approval without questions, and name of the operator.
        display: Language, and JSON instead of text.
        outputs: Event logs, and folder for Task, map, events and report.
        world: World of the simulation.
        seed: Seed of the simulation and of the budget guard.
        speed: Simulated seconds per second; None for as fast as possible.
        history: Folder in which the cost of missions is recorded for calibration; None to record nothing.
        folder: Folder in which the mission is stored, so that it survives a power cut; None to store nothing.
        vehicle: Robot; None for the simulation.
    """

    approval: ApprovalOptions
    display: DisplayOptions
    outputs: OutputOptions = field(default_factory=OutputOptions)
    world: World
    seed: int
    speed: float | None = None
    history: Path | None = None
    folder: MissionFolder | None = None
    vehicle: Vehicle | None = None


def run_mission(draft: MissionDraft, settings: RunSettings) -> int:
    """Review, approve, carry out, judge and report one mission.

    Returns:
        Exit status: 0 if the mission completed and met every goal, else 1.

    Raises:
        NotConfirmedError: There are warnings, and the operator may not be asked about them.
        NotApprovedError: A check failed, or the operator declined.
        ExecutionError: The robot cannot start from its position.
        OutputError: A file cannot be written.
    """
    site_and_robot, display = draft.site_and_robot, settings.display
    review = review_plan(site_and_robot, draft.task, draft.document, display)
    if draft.bundle is None:
        approved = approve_plan(review, settings.approval, display, message("Approve and carry out?"))
    else:
        approved = mission.approved_earlier(draft.bundle.authorized, review)
    write_plan(review, draft.document, settings)
    if settings.vehicle is not None:
        check_start(site_and_robot, review, settings.vehicle, confirm=settings.approval.confirm, display=display)
    events, name = _carry_out(approved, draft, settings)
    stored = settings.folder.parent / name if settings.folder is not None and name else None
    return conclude(approved, events, settings, planner=draft.planner, name=name, bundle=draft.bundle, images=stored)


def write_plan(review: mission.Review, document: bytes | None, settings: RunSettings) -> None:
    """Write Task and map to the output folder before the robot moves, so that an unwritable folder costs no mission."""
    folder = settings.outputs.output
    if folder is None:
        return
    from fieldhand.task.codec import encode

    write_file(folder / "task.xml", document or encode(review.task))
    review.save_map(folder / "map.png", language=settings.display.language.code)


def _carry_out(
    approved: mission.ApprovedMission, draft: MissionDraft, settings: RunSettings
) -> tuple[tuple[Event, ...], str]:
    """Return the events of a mission, and the name under which it is stored; it begins once every log is open."""
    from fieldhand.execution.drivers.simulation.vehicle import simulation

    site, robot, seed = approved.site, approved.robot, settings.seed
    with _open_logs(site, robot, settings, ()) as (emit, images_in):
        if settings.folder is not None:
            stored = _begin(approved, draft, settings, settings.folder)
            images_in(stored.folder)
            result = missions.carry_out(stored, speed=settings.speed, vehicle=settings.vehicle, emit=emit)
            return result.events, stored.id
        vehicle = settings.vehicle or simulation(site, robot, settings.world, seed=seed, speed=settings.speed)
        folder = settings.outputs.output
        images_in(folder)
        return mission.carry_out(approved, vehicle=vehicle, seed=seed, emit=emit, images=folder).events, ""


def _begin(
    approved: mission.ApprovedMission, draft: MissionDraft, settings: RunSettings, folder: MissionFolder
) -> missions.StoredMission:
    inputs = missions.Inputs(
        authorized=approved.authorized,
        site=approved.site,
        robot=approved.robot,
        files=folder.files.site,
        profile=folder.files.profile,
        lenient=folder.files.lenient,
        world=settings.world,
        seed=settings.seed,
        planner=draft.planner,
        bundle=draft.bundle,
        started_on=missions.robot_at_start(settings.vehicle),
    )
    stored = missions.begin(folder.parent, missions.new_id(datetime.now(UTC)), inputs)
    if not settings.display.json:
        named = message(
            "mission {id}; use this name with fieldhand status, pause, resume, abort and return", id=stored.id
        )
        show.note(named, settings.display.language)
    return stored


def resume_mission(stored: missions.StoredMission, settings: RunSettings) -> tuple[Event, ...]:
    """Carry out the rest of a stored mission, as after a power cut, and return all its events."""
    before = missions.events_of(stored.folder)
    with _open_logs(stored.site, stored.robot, settings, before, stored.folder) as (emit, _):
        return missions.carry_out(stored, speed=settings.speed, vehicle=settings.vehicle, emit=emit).events


@contextmanager
def _open_logs(
    site: Site, robot: RobotProfile, settings: RunSettings, before: Sequence[Event], images: Path | None = None
) -> Iterator[tuple[Callable[[Event], None], Callable[[Path | None], None]]]:
    """Open the event logs and write the earlier events to them.

    Args:
        images: Folder of the mission with its images, if it is known already.

    Yields:
        A function that logs and prints each event, and one that sets the folder of the images.
    """
    from fieldhand.execution.event_log import EventLog
    from fieldhand.wording.events import EventText

    display, outputs, event_text = settings.display, settings.outputs, EventText(robot)
    if not display.json:
        _print_beginning(before, display)
    with ExitStack() as stack:
        paths = [outputs.events, None if outputs.output is None else outputs.output / "events.jsonl"]
        logs: list[Callable[[Event], None]] = [
            stack.enter_context(EventLog(path)) for path in paths if path is not None
        ]
        logs_with_images: list[McapLog] = []
        if outputs.mcap is not None:
            from fieldhand.exchange.mcap import McapLog

            logs_with_images.append(McapLog(outputs.mcap, tell=event_text.line, site=site, images=images))
            logs += [stack.enter_context(recording) for recording in logs_with_images]

        def emit(event: Event) -> None:
            for log in logs:
                log(event)
            line = display.language.say(event_text.line(event) or "")
            if line and not display.json:
                show.out.print(line)

        def images_in(folder: Path | None) -> None:
            for recording in logs_with_images:
                recording.images = folder

        for event in before:
            for log in logs:
                log(event)
        yield emit, images_in


def _print_beginning(before: Sequence[Event], display: DisplayOptions) -> None:
    """Print the heading of the event list and, for a resumed mission, the number of earlier events."""
    show.heading(display.language.say(message("The mission")))
    if not before:
        return
    if isinstance(before[-1], Ended):
        summary = message("{count} events so far; nothing is left to do", count=len(before))
    else:
        summary = message("{count} events so far; it continues from there", count=len(before))
    show.out.print(f"          {display.language.say(summary)}")


def conclude(
    approved: mission.ApprovedMission,
    events: Sequence[Event],
    settings: RunSettings,
    *,
    planner: str,
    name: str = "",
    bundle: Bundle | None = None,
    images: Path | None = None,
) -> int:
    """Judge a mission that was carried out, write its report, and print the result.

    Args:
        approved: The mission.
        events: All its events.
        settings: Settings of the run.
        planner: Name of the planner of the Task.
        name: Name under which the mission is stored; empty if it is not.
        bundle: Signed mission; None if it was approved at the command line.
        images: Folder of the mission with its images; None for the output folder.

    Returns:
        Exit status, as for :func:`run_mission`.
    """
    display, folder = settings.display, settings.outputs.output
    conclusion = finished_missions.conclude(
        approved.authorized,
        approved.site,
        approved.robot,
        events,
        estimate=approved.estimate,
        folder=folder,
        history=settings.history,
        at=datetime.now(UTC),
        bundle=bundle,
        images=images,
    )
    if conclusion.history_error:
        show.note(conclusion.history_error, display.language)
    assessment = conclusion.assessment
    ended = next((e for e in reversed(events) if isinstance(e, Ended)), None)
    written = [] if folder is None else list(mission_files(folder))
    if display.json:
        record = show.mission_record(approved.task, planner, ended, assessment, written)
        signed = None if bundle is None else signer_record(bundle)
        show.print_json({"mission": name} | record | {"signed": signed})
    else:
        _print_result(approved, assessment, ended, written, display)
    return 0 if assessment.success else 1


def _print_result(
    approved: mission.ApprovedMission,
    assessment: mission.Assessment,
    ended: Ended | None,
    written: Sequence[Path],
    display: DisplayOptions,
) -> None:
    from fieldhand.wording.events import goal_names

    language = display.language
    show.show_outcomes(assessment, goal_names(approved.task, approved.robot), language)
    if ended is not None and assessment.status is not None:
        show.out.print()
        show.out.print(language.say(_end_text(assessment.status, assessment.reason, ended)))
    if written:
        show.heading(language.say(message("Files")))
        for path in written:
            show.out.print(f"  {path}")


def _end_text(status: MissionStatus, reason: str, ended: Ended) -> str:
    """Return a sentence with the status of a mission, its distance, time and battery, and the reason."""
    from fieldhand.task.exceeded import say_status

    text = message(
        "Mission {status}: {metres} m driven in {minutes} min, battery at {charge} %",
        status=say_status(status),
        metres=f"{ended.travelled_m:.0f}",
        minutes=f"{ended.t / 60:.0f}",
        charge=f"{ended.charge_percent:.0f}",
    )
    return message("{what} ({why})", what=text, why=kept_in_log(reason)) if reason else text
