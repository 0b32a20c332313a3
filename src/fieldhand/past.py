"""What is done with missions that are over: judge and report one from its log, keep what it cost, fit a robot to that.

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

#: Fields of events that must be finite numbers. Positions may be unknown.
_FIGURES = ("t", "leg_m", "travelled_m", "charge_percent")


def history_folder(environ: Mapping[str, str]) -> Path:
    """Where it is kept what missions cost each robot: in the user's state folder."""
    return state_folder(environ) / "history"


@dataclass(frozen=True, kw_only=True)
class Log:
    """An event log, whole or cut off.

    Attributes:
        where: What to call it in messages.
        sha256: Of its file; empty where it is none.
    """

    events: tuple[Event, ...]
    where: str
    sha256: str = ""


def read_log(path: Path) -> Log:
    """A log from a file, JSON lines or MCAP; a last line that was cut off in mid-write is left out.

    Raises:
        InputError: The file cannot be read, is damaged, or holds no event.
        TaskError: A line or a message is no event.
    """
    import hashlib

    from fieldhand.exchange.mcap import is_mcap, read_mcap
    from fieldhand.execution.event_log import read_events

    events = read_mcap(path) if is_mcap(path) else read_events(path, whole=False)
    if not events:
        raise InputError(
            message("holds no event"), where=str(path), advice=message("give a log that fieldhand run wrote")
        )
    return Log(events=events, where=str(path), sha256=hashlib.sha256(path.read_bytes()).hexdigest())


def report_log(
    folder: Path,
    log: Log,
    task: Task,
    document: bytes,
    site: Site,
    robot: RobotProfile,
    *,
    authorization: Authorization | None = None,
    signed: str = "",
    hashes: Sequence[tuple[str, str]] = (),
) -> tuple[ReportFiles, mission.Assessment]:
    """Judge and report a mission from its event log.

    Args:
        folder: Where to write the report.
        log: What happened.
        task, document: What was carried out.
        site, robot: Where and with what.
        authorization: Who approved it; None where that is not known.
        signed: Whose signature it has, in words; empty where there is none.
        hashes: SHA-256 of what else it rests on, each with its name.

    Raises:
        InputError: The log is of another Task, robot or site, or its figures are no numbers.
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
    )
    return files, assessment


def _require_log_of(task: Task, site: Site, robot: RobotProfile, log: Log) -> None:
    """Require that a log is one of this Task, on this site, by this robot.

    Raises:
        InputError: The log has no beginning, is of another mission, or has figures out of range; says which.
    """
    from fieldhand.evaluation.report.log_facts import start_of

    started = start_of(log.events)
    if started is None:
        raise InputError(
            "has no line that says of which mission it is",
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
                f"is of the {what} {found!r}, not {wanted!r}",
                where=log.where,
                advice=f"give the {what} that it was made with",
            )
    for number, event in enumerate(log.events, start=1):
        for name in _FIGURES:
            value = getattr(event, name, 0.0)
            if not math.isfinite(value) or abs(value) > 1e12:
                raise InputError(
                    f"{name} of event {number} ({event.event}) is {value}, which no mission has",
                    where=log.where,
                    advice="was the log edited?",
                )


@dataclass(frozen=True, kw_only=True)
class Conclusion:
    """What came of a mission.

    Attributes:
        not_kept: Why what it cost could not be kept; empty where it was, or was not to be.
    """

    assessment: mission.Assessment
    not_kept: str


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
) -> Conclusion:
    """Judge a mission that was carried out, report it, and keep what it cost.

    A mission is not lost because what it cost cannot be kept: that is said in what comes back.

    Args:
        authorized, site, robot: What was carried out, where and with what.
        events: What happened.
        estimate: What it was expected to take.
        folder: Where to write the report; None to write none.
        history: Where to keep what it cost, for :func:`calibrate`; None to keep nothing.
        at: When.
        bundle: The signed mission, if it was one.

    Raises:
        OutputError: The report cannot be written.
    """
    assessment = mission.assess(authorized.task, events, robot)
    not_kept = ""
    if history is not None:
        try:
            keep_history(history, robot, events, at)
        except OutputError as error:
            not_kept = str(error)
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
        )
    return Conclusion(assessment=assessment, not_kept=not_kept)


def keep_history(folder: Path, robot: RobotProfile, events: Sequence[Event], at: datetime) -> bool:
    """Keep what a mission cost the robot, for ``fieldhand robot calibrate``; returns whether it was not kept before.

    Raises:
        OutputError: It cannot be written.
    """
    from fieldhand.evaluation.calibration.history import save_mission
    from fieldhand.evaluation.calibration.measured_steps import measure_mission

    return save_mission(folder, robot, measure_mission(events), at)


def missions_of(
    robot: RobotProfile, logs: Sequence[Path], history: Path, *, simulated: bool = False
) -> tuple[MeasuredMission, ...]:
    """The missions of a robot: those of some event logs, or where there are none those that were kept.

    Args:
        robot: By its name.
        logs: Event logs.
        history: Folder of what was kept.
        simulated: Take of the latter the simulated missions, not the driven ones.

    Raises:
        InputError: A log is of another robot or cannot be read; or nothing was kept.
    """
    from fieldhand.evaluation.calibration.history import load_missions
    from fieldhand.evaluation.calibration.measured_steps import measure_mission

    read = {}
    for log in logs:
        driven = measure_mission(read_log(log).events, where=str(log))
        if driven.robot != robot.name:
            raise InputError(
                f"is of the robot {driven.robot!r}, not {robot.name!r}", where=str(log), advice="give logs of one robot"
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
            f"no {kind} missions of {robot.name} were kept{hint}",
            where=str(history),
            advice="drive some, or give their event logs",
        )
    return found


def calibrate(robot: RobotProfile, missions: Sequence[MeasuredMission], *, seed: int = 0) -> Calibration:
    """Fit the cost model of a robot to its missions.

    Raises:
        InputError: They hold too few legs.
    """
    from fieldhand.evaluation.calibration.calibrate import calibrate as fitted

    return fitted(robot, missions, seed=seed)


def calibrated_profile(robot: RobotProfile, found: Calibration, *, at: datetime) -> bytes:
    """The robot's profile as text with what was fitted; all else stands as before. Its hash is another.

    Raises:
        ProfileError: The profile cannot be read any more, or what comes out is none.
    """
    from fieldhand.robot.loader import profile_bytes
    from fieldhand.robot.rewrite import with_figures

    changed = found.fit.profile(robot)
    figures: dict[tuple[str, ...], float] = {
        ("leg_cost", "alpha"): changed.leg_cost.alpha,
        ("speed_m_s",): changed.speed_m_s,
        ("energy", "drive_j_per_m"): changed.energy.drive_j_per_m,
        ("energy", "idle_w"): changed.energy.idle_w,
    }
    for action in changed.actions:
        figures["actions", action.name, "duration_s"] = action.duration_s
        figures["actions", action.name, "energy_j"] = action.energy_j
    before = {("leg_cost", "alpha"): robot.leg_cost.alpha, ("speed_m_s",): robot.speed_m_s}
    before |= {("energy", key): getattr(robot.energy, key) for key in ("drive_j_per_m", "idle_w")}
    for action in robot.actions:
        before |= {("actions", action.name, key): getattr(action, key) for key in ("duration_s", "energy_j")}
    note = (
        f"Calibrated {at.date().isoformat()} from {found.legs} legs and {found.captures} captures of {found.missions}"
        f" missions; the profile before had SHA-256 {robot.sha256}."
    )
    new = {keys: value for keys, value in figures.items() if value != before[keys]}
    return with_figures(profile_bytes(robot.source)[0], new, note=note, source=robot.source)
