"""Missions that were approved or carried out, read from a mission's folder, a signed mission, or single files."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.cli.bundles import is_bundle, require_site
from fieldhand.cli.inputs import open_site_and_robot
from fieldhand.cli.options import RecordedOptions
from fieldhand.compatibility import UTC
from fieldhand.errors import InputError
from fieldhand.language import ENGLISH, Language, message
from fieldhand.mission.documents import SiteAndRobot

if TYPE_CHECKING:
    from fieldhand.finished_missions import MissionLog
    from fieldhand.mission import UnverifiedBundle
    from fieldhand.task.authorization import Authorization
    from fieldhand.task.frames import Task


@dataclass(frozen=True, kw_only=True)
class RecordedPlan:
    """Task, site and robot of a recorded mission.

    Attributes:
        task, document: The Task, and the bytes of its document.
        site_and_robot: Site and robot.
        authorization: Approval of the Task; None if it is unknown.
        signed: Name of the signer in words; empty for an unsigned mission.
        hashes: Name and SHA-256 of further files that the mission depends on.
    """

    task: Task
    document: bytes
    site_and_robot: SiteAndRobot
    authorization: Authorization | None = None
    signed: str = ""
    hashes: Sequence[tuple[str, str]] = ()


def recorded_mission(
    source: str | None, task: Path | None, options: RecordedOptions, language: Language
) -> tuple[RecordedPlan, MissionLog]:
    """Return the plan and the event log of a recorded mission.

    Args:
        source: Name or folder of a stored mission, or an event log; None for the mission begun last.
        task: Task document or signed mission of an event log.
        options: Site and robot of an event log, and folder of all missions.
        language: Language of notes about the site.

    Raises:
        InputError: The log comes without its Task or site, or a stored mission with options that it brings itself.
        JournalError: There is no such mission, or its folder is damaged.
    """
    from fieldhand.finished_missions import read_log

    folder = folder_of(source, options.missions)
    if folder is not None:
        require_nothing_beside(folder, task=task, site=options.site, robot=options.robot)
        return plan_of_folder(folder), log_of_folder(folder)
    if task is None:
        raise InputError(
            message("the Task that was run is not given"),
            where="--task",
            advice=message("give the Task document or the signed mission; or the mission by its name"),
        )
    plan = plan_of_files(task, options.site, options.robot, lenient=options.lenient, language=language)
    return plan, read_log(Path(source or ""))


def folder_of(source: str | None, parent: Path | None) -> Path | None:
    """Return the folder of a stored mission, by default of the one begun last; None if ``source`` is a file.

    Args:
        source: Name or folder of a mission, or name of a file.
        parent: Folder of all missions; None for the default.

    Raises:
        JournalError: There is no mission of that name.
        InputError: ``source`` looks like the name of a file, and there is no such file.
    """
    from fieldhand import missions

    path = Path(source or "")
    if source is not None and path.suffix and not path.exists():
        advice = message("give the event log of a mission, or the name or folder of a mission")
        raise InputError(message("there is no such file"), where=source, advice=advice)
    if source is not None and (path.is_file() or (path.suffix and not path.is_dir())):
        return None
    return missions.find(parent or missions.missions_folder(os.environ), source)


def plan_of_folder(folder: Path) -> RecordedPlan:
    """Return the plan in a mission's folder, and check that no file was changed since the mission began.

    Raises:
        JournalError: A file was changed or cannot be read.
        NotApprovedError, BundleError: The Task is not the approved one, or the signed mission is damaged.
    """
    from fieldhand import missions

    contents = missions.read_folder(folder)
    stored = contents.mission()
    bundle = None if contents.signed is None else _unverified(contents.signed, str(folder))
    return RecordedPlan(
        task=stored.authorized.task,
        document=contents.files["task.xml"],
        site_and_robot=SiteAndRobot(site=stored.site, robot=stored.robot),
        authorization=stored.authorized.authorization,
        signed="" if bundle is None else bundle.signed,
        hashes=() if bundle is None else (("signed mission", bundle.sha256),),
    )


def log_of_folder(folder: Path) -> MissionLog:
    """Return the events of a stored mission that are written to disk.

    Raises:
        InputError: There is no event yet.
    """
    from fieldhand import missions
    from fieldhand.finished_missions import MissionLog

    events = missions.events_of(folder)
    if not events:
        raise InputError(
            message("the mission has done nothing yet"), where=str(folder), advice=message("give one that has started")
        )
    return MissionLog(events=events, where=str(folder), images=folder)


def plan_of_files(
    task: Path, site: str | None, robot: str | None, *, lenient: bool, language: Language = ENGLISH
) -> RecordedPlan:
    """Return the plan of a Task document with its site and robot, or of a signed mission, which contains them.

    Raises:
        InputError: A file is missing or cannot be read, or site or robot is given for a signed mission.
    """
    from fieldhand import mission

    if is_bundle(str(task)):
        require_nothing_beside(task, site=site, robot=robot)
        return plan_of_bundle(task)
    site_and_robot = site_and_robot_of(require_site(site), robot, lenient=lenient, language=language)
    read, document = mission.read_task(task, site_and_robot.robot)
    return RecordedPlan(task=read, document=document, site_and_robot=site_and_robot)


def plan_of_bundle(file: Path) -> RecordedPlan:
    """Return the plan in a signed mission, without requiring that its key is trusted.

    Raises:
        BundleError: The file is damaged.
    """
    from fieldhand.approval.bundle.container import read_bundle_file

    unverified = _unverified(read_bundle_file(file), str(file))
    return RecordedPlan(
        task=unverified.content.task,
        document=unverified.document,
        site_and_robot=SiteAndRobot(site=unverified.content.site, robot=unverified.content.robot),
        authorization=unverified.authorization,
        signed=unverified.signed,
        hashes=(("signed mission", unverified.sha256),),
    )


def _unverified(data: bytes, source: str) -> UnverifiedBundle:
    from fieldhand import mission

    return mission.read_unverified(data, source=source, environ=os.environ, now=datetime.now(UTC))


def site_and_robot_of(site: str, robot: str | None, *, lenient: bool, language: Language = ENGLISH) -> SiteAndRobot:
    """Return site and robot; if ``site`` is a signed mission, those that it contains.

    Raises:
        SiteError, ProfileError, BundleError: A file cannot be used.
    """
    if is_bundle(site):
        require_nothing_beside(Path(site), robot=robot)
        return plan_of_bundle(Path(site)).site_and_robot
    return open_site_and_robot(site, robot or "husky", lenient=lenient, language=language)


def require_nothing_beside(brings: Path, **given: object) -> None:
    """Require that options are not given whose values come from a signed mission or a mission's folder.

    Raises:
        InputError: One is given.
    """
    for option, value in given.items():
        if value is not None:
            raise InputError(
                message("{name} already contains it", name=brings.name),
                where=f"--{option}",
                advice=message("leave it out"),
            )
