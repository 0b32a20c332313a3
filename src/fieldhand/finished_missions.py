"""Process finished missions: assess and report them, record their costs, and calibrate a robot from those records.

log ──report_log──▶ report  events ──conclude──▶ report, history ──calibrate──▶ Calibration ──calibrated_profile──▶ YAML
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand import mission
from fieldhand.errors import InputError, OutputError
from fieldhand.files import state_folder
from fieldhand.language import message
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.evaluation.calibration.calibrate import Calibration
    from fieldhand.evaluation.calibration.measured_steps import MeasuredMission
    from fieldhand.evaluation.report.writing import ReportFiles
    from fieldhand.forecast.estimate import Estimate
    from fieldhand.task.authorization import Authorization, AuthorizedTask

#: Fields of events that must be finite numbers; a position may be unknown (NaN).
_FIGURES = ("t", "leg_m", "travelled_m", "charge_percent")


def history_folder(environ: Mapping[str, str]) -> Path:
    """Return the folder of mission costs by robot, in the user's state folder."""
    return state_folder(environ) / "history"


@dataclass(frozen=True, kw_only=True)
class MissionLog:
    """An event log of one mission, complete or truncated.

    Attributes:
        events: Events in the order in which they were logged, at least one.
        where: Name of the log in messages: the path of its file or folder.
        sha256: SHA-256 of the log file in hexadecimal; empty if the log is not a single file.
        images: Folder in which the images of the mission lie, if it has any; None if it is unknown.
    """

    events: tuple[Event, ...]
    where: str
    sha256: str = ""
    images: Path | None = None


def read_log(path: Path) -> MissionLog:
    """Read an event log from a file of JSON lines or an MCAP file; a truncated last line is ignored.

    Raises:
        InputError: The file cannot be read, is damaged, or contains no event.
        TaskError: A line or a message is not an event.
    """
    import hashlib

    from fieldhand.exchange.mcap import is_mcap, read_mcap
    from fieldhand.execution.event_log import read_events

    events = read_mcap(path) if is_mcap(path) else read_events(path, whole=False)
    if not events:
        raise InputError(
            message("contains no events"), where=str(path), advice=message("give a log that fieldhand run wrote")
        )
    sha256 = hashlib.sha256(path.read_bytes()).hexdigest()
    return MissionLog(events=events, where=str(path), sha256=sha256, images=path.parent)


def report_log(
    folder: Path,
    log: MissionLog,
    task: Task,
    document: bytes,
    site: Site,
    robot: RobotProfile,
    *,
    authorization: Authorization | None = None,
    signed: str = "",
    hashes: Sequence[tuple[str, str]] = (),
) -> tuple[ReportFiles, mission.Assessment]:
    """Assess a mission from its event log and write its report.

    Args:
        folder: Folder for the report.
        log: Event log of the mission.
        task: Task that was executed.
        document: XML document of the Task.
        site: Site of the mission.
        robot: Profile of the robot.
        authorization: Approval of the Task; None if unknown.
        signed: Description of the signature in words; empty for an unsigned mission.
        hashes: Names and SHA-256 hashes of further inputs, listed in the report.

    Raises:
        InputError: The log belongs to another Task, robot or site, or contains figures that are not finite.
        OutputError: The folder cannot be written.
    """
    import hashlib

    from fieldhand.evaluation.report.writing import write_report

    _require_log_of(task, site, robot, log)
    assessment = mission.assess(task, log.events, robot)
    rests = [*hashes, *([("event log", log.sha256)] if log.sha256 else [])]
    if authorization is None:
        rests = [("Task document", hashlib.sha256(document).hexdigest()), *rests]
        rests += [("site", site.sha256), ("robot", robot.sha256)]
    files = write_report(
        folder,
        task=task,
        site=site,
        robot=robot,
        events=log.events,
        outcomes=assessment.outcomes,
        authorization=authorization,
        estimate=mission.review(task, site, robot, document=document).estimate,
        signed=signed,
        hashes=rests,
        images=log.images,
    )
    return files, assessment


def _require_log_of(task: Task, site: Site, robot: RobotProfile, log: MissionLog) -> None:
    """Check that a log belongs to this Task, site and robot and that its figures are in range.

    Raises:
        InputError: The log has no start event, belongs to another mission, or has a figure out of range.
    """
    from fieldhand.evaluation.report.log_facts import start_of

    started = start_of(log.events)
    if started is None:
        raise InputError(
            "has no line that identifies its mission",
            where=log.where,
            advice="give the whole log, from its first line",
        )
    for what, wanted, found in (
        ("Task", task.id, started.task),
        ("robot", robot.name, started.robot),
        ("site", site.name, started.site),
    ):
        if wanted != found:
            raise InputError(
                f"was recorded with the {what} {found!r}, not {wanted!r}",
                where=log.where,
                advice=f"give the {what} that was used for the mission",
            )
    for number, event in enumerate(log.events, start=1):
        for name in _FIGURES:
            value = getattr(event, name, 0.0)
            if not math.isfinite(value) or abs(value) > 1e12:
                raise InputError(
                    f"{name} of event {number} ({event.event}) is {value}, which is not plausible",
                    where=log.where,
                    advice="use the original log; this one may have been edited",
                )


@dataclass(frozen=True, kw_only=True)
class Conclusion:
    """The assessment of a finished mission, and the error if its costs could not be recorded.

    Attributes:
        assessment: Outcome of each goal and of the mission.
        history_error: Reason why the costs could not be recorded; empty if they were, or were not to be.
    """

    assessment: mission.Assessment
    history_error: str


def conclude(
    authorized: AuthorizedTask,
    site: Site,
    robot: RobotProfile,
    events: Sequence[Event],
    *,
    estimate: Estimate | None,
    folder: Path | None,
    history: Path | None,
    at: datetime,
    bundle: Bundle | None = None,
    images: Path | None = None,
) -> Conclusion:
    """Assess an executed mission, write its report, and record its costs for calibration.

    If the costs cannot be recorded, the mission is assessed and reported all the same, and
    :attr:`Conclusion.history_error` gives the reason.

    Args:
        authorized: Approved Task that was executed.
        site: Site of the mission.
        robot: Profile of the robot.
        events: Events of the mission.
        estimate: Forecast of time and energy made before the mission; None if there is none.
        folder: Folder for the report; None to write none.
        history: Folder for the costs, read by :func:`measured_missions`; None to record none.
        at: Time of the mission.
        bundle: Signed mission that was executed; None for an unsigned one.
        images: Folder of the mission with its images; None if it is unknown.

    Raises:
        OutputError: The report cannot be written.
    """
    assessment = mission.assess(authorized.task, events, robot)
    history_error = ""
    if history is not None:
        try:
            save_history(history, robot, events, at)
        except OutputError as error:
            history_error = str(error)
    if folder is not None:
        mission.report(
            folder,
            authorized,
            site,
            robot,
            events,
            assessment,
            estimate,
            signed="" if bundle is None else bundle.signer.in_words,
            hashes=() if bundle is None else (("signed mission", bundle.hashes["bundle"]),),
            images=images,
        )
    return Conclusion(assessment=assessment, history_error=history_error)


def save_history(folder: Path, robot: RobotProfile, events: Sequence[Event], at: datetime) -> bool:
    """Record the costs of a mission for ``fieldhand robot calibrate``; return False if they were recorded before.

    Raises:
        OutputError: The folder cannot be written.
    """
    from fieldhand.evaluation.calibration.history import save_mission
    from fieldhand.evaluation.calibration.measured_steps import measure_mission

    return save_mission(folder, robot, measure_mission(events), at)


def measured_missions(
    robot: RobotProfile, logs: Sequence[Path], history: Path, *, simulated: bool = False
) -> tuple[MeasuredMission, ...]:
    """Return the measured missions of a robot: those of the given event logs, or else those recorded in the history.

    Args:
        robot: Robot whose name the logs must carry.
        logs: Paths of event logs; empty to read the history.
        history: Folder of recorded costs.
        simulated: True to take the simulated missions of the history instead of the driven ones.

    Raises:
        InputError: A log cannot be read or belongs to another robot, or the history has no such mission.
    """
    from fieldhand.evaluation.calibration.history import load_missions
    from fieldhand.evaluation.calibration.measured_steps import measure_mission

    read = {}
    for log in logs:
        driven = measure_mission(read_log(log).events, where=str(log))
        if driven.robot != robot.name:
            raise InputError(
                f"was recorded by the robot {driven.robot!r}, not {robot.name!r}",
                where=str(log),
                advice="give only logs of that robot",
            )
        read[driven.key] = driven
    if read:
        return tuple(read.values())
    every = load_missions(history, robot.name)
    found = tuple(m for m in every if m.simulated == simulated)
    if not found:
        others = len(every) - len(found)
        kind, other = ("simulated", "driven") if simulated else ("driven", "simulated")
        hint = f" ({others} {other} ones are{'' if simulated else ': --simulated takes them'})" if others else ""
        raise InputError(
            f"no {kind} missions of {robot.name} are stored{hint}",
            where=str(history),
            advice="run some missions, or give their event logs",
        )
    return found


def calibrate(robot: RobotProfile, missions: Sequence[MeasuredMission], *, seed: int = 0) -> Calibration:
    """Fit the cost model of a robot (speed, energy, durations, spread of leg costs) to its missions.

    Raises:
        InputError: The missions contain too few legs.
    """
    from fieldhand.evaluation.calibration.calibrate import calibrate as fitted

    return fitted(robot, missions, seed=seed)


def calibrated_profile(robot: RobotProfile, calibration: Calibration, *, at: datetime) -> bytes:
    """Return the robot's profile as YAML with the fitted figures; everything else in the text stays as it is.

    The SHA-256 of the result differs from that of the profile.

    Args:
        robot: Profile that was calibrated.
        calibration: Result of :func:`calibrate`.
        at: Time for the comment in the first line.

    Raises:
        ProfileError: The profile cannot be read again, or the changed text is not a valid profile.
    """
    from fieldhand.robot.loader import profile_bytes
    from fieldhand.robot.rewrite import with_figures

    changed = calibration.fit.profile(robot)
    figures: dict[tuple[str, ...], float] = {
        ("leg_cost", "alpha"): changed.leg_cost.alpha,
        ("speed_m_s",): changed.speed_m_s,
        ("energy", "drive_j_per_m"): changed.energy.drive_j_per_m,
        ("energy", "idle_w"): changed.energy.idle_w,
    }
    at_places = [action for action in changed.actions if action.implement is None]
    for action in at_places:
        figures["actions", action.name, "duration_s"] = action.duration_s
        figures["actions", action.name, "energy_j"] = action.energy_j
    before = {("leg_cost", "alpha"): robot.leg_cost.alpha, ("speed_m_s",): robot.speed_m_s}
    before |= {("energy", key): getattr(robot.energy, key) for key in ("drive_j_per_m", "idle_w")}
    for action in (action for action in robot.actions if action.implement is None):
        before |= {("actions", action.name, key): getattr(action, key) for key in ("duration_s", "energy_j")}
    note = (
        f"Calibrated {at.date().isoformat()} from {calibration.legs} legs and {calibration.captures} captures of"
        f" {calibration.missions} missions; the profile before had SHA-256 {robot.sha256}."
    )
    new = {keys: value for keys, value in figures.items() if value != before[keys]}
    return with_figures(profile_bytes(robot.source)[0], new, note=note, source=robot.source)
