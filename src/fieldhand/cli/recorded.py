"""What belongs to a mission that was approved or carried out: its folder, a signed bundle, or single files."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.cli.bundles import is_bundle, read_unverified, require_site
from fieldhand.cli.inputs import open_ground
from fieldhand.errors import InputError
from fieldhand.language import ENGLISH, Language, message
from fieldhand.mission.documents import SiteAndRobot

if TYPE_CHECKING:
    from fieldhand.finished_missions import MissionLog
    from fieldhand.task.authorization import Authorization
    from fieldhand.task.frames import Task


@dataclass(frozen=True, kw_only=True)
class RecordedPlan:
    """What was to be done, where and with what.

    Attributes:
        document: The bytes of the Task.
        authorization: Who approved it; None where that is not known.
        signed: Whose signature it has, in words; empty where there is none.
        hashes: SHA-256 of what else it rests on, each with its name.
    """

    task: Task
    document: bytes
    ground: SiteAndRobot
    authorization: Authorization | None = None
    signed: str = ""
    hashes: Sequence[tuple[str, str]] = ()


def folder_of(given: str | None, under: Path | None) -> Path | None:
    """The folder of a mission, where none is given that of the one begun last; None where a file is given.

    Raises:
        JournalError: There is no mission of that name.
        InputError: What is given is the name of a file, and there is none.
    """
    from fieldhand import missions

    path = Path(given or "")
    if given is not None and path.suffix and not path.exists():
        advice = message("give the event log of a mission, or the name or folder of a mission")
        raise InputError(message("there is no such file"), where=given, advice=advice)
    if given is not None and (path.is_file() or (path.suffix and not path.is_dir())):
        return None
    return missions.find(under or missions.missions_folder(os.environ), given)


def plan_of_folder(folder: Path) -> RecordedPlan:
    """What a mission's folder holds; every byte has to be the one that it began with.

    Raises:
        JournalError, NotApprovedError, BundleError: It does not.
    """
    from fieldhand import missions

    contents = missions.read_folder(folder)
    given = contents.mission()
    bundle = None if contents.signed is None else read_unverified(contents.signed, str(folder))
    return RecordedPlan(
        task=given.authorized.task,
        document=contents.files["task.xml"],
        ground=SiteAndRobot(site=given.site, robot=given.robot),
        authorization=given.authorized.authorization,
        signed="" if bundle is None else bundle.signed,
        hashes=() if bundle is None else (("signed mission", bundle.sha256),),
    )


def log_of_folder(folder: Path) -> MissionLog:
    """The log of a mission, as far as it is safe on the disk.

    Raises:
        InputError: It has not begun.
    """
    from fieldhand import missions
    from fieldhand.finished_missions import MissionLog

    events = missions.events_of(folder)
    if not events:
        raise InputError(
            message("the mission has done nothing yet"), where=str(folder), advice=message("give one that has begun")
        )
    return MissionLog(events=events, where=str(folder))


def plan_of_files(
    task: Path, site: str | None, robot: str | None, *, lenient: bool, language: Language = ENGLISH
) -> RecordedPlan:
    """A Task document with site and robot, or a signed mission, which has its own.

    Raises:
        InputError: One of them is missing, cannot be used, or is given beside a signed mission.
    """
    from fieldhand import mission

    if is_bundle(str(task)):
        require_nothing_beside(task, site=site, robot=robot)
        return plan_of_bundle(task)
    ground = ground_of(require_site(site), robot, lenient=lenient, language=language)
    read, document = mission.read_task(task, ground.robot)
    return RecordedPlan(task=read, document=document, ground=ground)


def plan_of_bundle(file: Path) -> RecordedPlan:
    """What a signed mission holds, whoever signed it.

    Raises:
        BundleError: It is broken.
    """
    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.approval.bundle.opening import authorization_of

    found = read_unverified(read_bundle_file(file), str(file))
    return RecordedPlan(
        task=found.content.task,
        document=found.document,
        ground=SiteAndRobot(site=found.content.site, robot=found.content.robot),
        authorization=authorization_of(found.content.manifest),
        signed=found.signed,
        hashes=(("signed mission", found.sha256),),
    )


def ground_of(site: str, robot: str | None, *, lenient: bool, language: Language = ENGLISH) -> SiteAndRobot:
    """Site and robot; those of a signed mission, where one is given for the site.

    Raises:
        SiteError, ProfileError, BundleError: One of them cannot be used.
    """
    if is_bundle(site):
        require_nothing_beside(Path(site), robot=robot)
        return plan_of_bundle(Path(site)).ground
    return open_ground(site, robot or "husky", lenient=lenient, language=language)


def require_nothing_beside(brings: Path, **given: object) -> None:
    """Refuse options that say again what a signed mission or a mission's folder says.

    Raises:
        InputError: One was given.
    """
    for option, value in given.items():
        if value is not None:
            raise InputError(
                message("{name} brings its own", name=brings.name), where=f"--{option}", advice=message("leave it out")
            )
