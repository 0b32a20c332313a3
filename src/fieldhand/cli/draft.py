"""Drafts of missions: the Task of a request, of a document or of a signed mission, with its site and robot."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.cli import show
from fieldhand.cli.asking import Replies, plan_or_read, require_no_answer
from fieldhand.cli.bundles import approval_line, is_bundle, open_mission, require_site
from fieldhand.cli.earlier import EarlierOptions, add_earlier
from fieldhand.cli.inputs import read_site_and_robot
from fieldhand.cli.options import DisplayOptions, MissionInputOptions, PlanningOptions
from fieldhand.mission.documents import InputFiles, SiteAndRobot
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle


@dataclass(frozen=True, kw_only=True)
class OpenedInputs:
    """Site and robot of a mission, and the files that they were read from.

    Attributes:
        site_and_robot: Site and robot.
        files: Their files.
        bundle: Signed mission that contains them; None if they were given as options.
    """

    site_and_robot: SiteAndRobot
    files: InputFiles
    bundle: Bundle | None = None


@dataclass(frozen=True, kw_only=True)
class MissionDraft:
    """A mission before its review.

    Attributes:
        site_and_robot: Site and robot.
        task: Task that was planned, read or signed.
        document: Bytes of the Task document, if the Task was read from one.
        planner: Name of the planner of the Task.
        bundle: Signed mission that contains the Task; None if the Task has yet to be approved.
    """

    site_and_robot: SiteAndRobot
    task: Task
    document: bytes | None = None
    planner: str
    bundle: Bundle | None = None


def open_inputs(
    request: str, inputs: MissionInputOptions, display: DisplayOptions, *, production: bool
) -> OpenedInputs:
    """Open site and robot of a mission; for a signed mission, verify it and print who approved it.

    Args:
        request: First argument of the command: a request, or the name of a Task document or of a signed mission.
        inputs: Options that name site and robot.
        display: Language, and JSON instead of text.
        production: Refuse everything but signed missions.

    Raises:
        InputError: Site or robot is missing or cannot be read.
        BundleError, NotTrustedError, NotApprovedError: The signed mission cannot be used.
        NotApprovedError: Only signed missions may run here.
    """
    from fieldhand.approval.production import require_unsigned_allowed

    if not is_bundle(request):
        require_unsigned_allowed(os.environ, asked=production)
        site, robot = require_site(inputs.site), inputs.robot or "husky"
        site_and_robot, files = read_site_and_robot(site, robot, lenient=inputs.lenient, language=display.language)
        return OpenedInputs(site_and_robot=site_and_robot, files=files)
    bundle = open_mission(request, inputs.site, inputs.robot, lenient=inputs.lenient)
    if not display.json:
        show.out.print(display.language.say(approval_line(bundle)))
    return OpenedInputs(
        site_and_robot=SiteAndRobot(site=bundle.site, robot=bundle.robot),
        files=InputFiles(site=bundle.files, profile=bundle.profile, lenient=bundle.manifest.site.lenient),
        bundle=bundle,
    )


def draft_mission(
    request: str,
    opened: OpenedInputs,
    planning: PlanningOptions,
    display: DisplayOptions,
    earlier: EarlierOptions | None = None,
    folder: Path | None = None,
) -> MissionDraft:
    """Plan a request or read a Task document; of a signed mission, take its Task.

    Args:
        request: As for :func:`open_inputs`.
        opened: Site and robot.
        planning: Planner and answers.
        display: Language, and JSON instead of text.
        earlier: Earlier missions that the plan may refer to.
        folder: Their folder.

    Raises:
        InputError: An answer is given for a mission that is planned already.
        RequestError, TaskError, ModelError: The request cannot be planned, or the document cannot be read.
    """
    site_and_robot, bundle = opened.site_and_robot, opened.bundle
    if bundle is not None:
        require_no_answer(planning.answer or (), request)
        planner = bundle.manifest.task.planner
        return MissionDraft(site_and_robot=site_and_robot, task=bundle.authorized.task, planner=planner, bundle=bundle)
    replies = Replies.of(planning, display)
    task, document, planner = plan_or_read(request, site_and_robot, planning.planner, planning.transcript, replies)
    task, document = add_earlier(task, document, site_and_robot, earlier or EarlierOptions(), folder, display)
    return MissionDraft(site_and_robot=site_and_robot, task=task, document=document, planner=planner)
