"""What every command does first: open the site and the robot, and plan or read the Task."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path

from fieldhand.cli.show import fail_outcome, note
from fieldhand.errors import OutputError
from fieldhand.planning.planner import Planned
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.frames import Task


@dataclass(frozen=True, kw_only=True)
class Ground:
    """The site and the robot that a command works on."""

    site: Site
    robot: RobotProfile


def open_ground(site: str, robot: str, *, lenient: bool = False) -> Ground:
    """Open both; of a leniently read site say what was left out.

    Raises:
        SiteError, ProfileError: One of them cannot be used.
    """
    from fieldhand.robot.loader import load_robot
    from fieldhand.site.geojson import open_site

    opened = open_site(site, lenient=lenient)
    if lenient:
        for said in opened.notes:
            note(said)
    return Ground(site=opened, robot=load_robot(robot))


def plan_or_read(words: str, ground: Ground, planner: str, transcript: Path | None) -> tuple[Task, bytes | None, str]:
    """The Task of a request, or of a Task document if ``words`` is a file that ends in ``.xml``; and who planned it.

    Ends the program with status 2 where the planner has a question or refuses.
    """
    from fieldhand import mission

    if words.lower().endswith(".xml") and "\n" not in words:
        task, document = mission.read_task(Path(words), ground.robot)
        return task, document, "file"
    outcome = mission.plan(words, ground.site, ground.robot, mission.make_planner(planner, os.environ, transcript))
    if not isinstance(outcome, Planned):
        fail_outcome(words, outcome)
    for warning in outcome.warnings:
        note(warning)
    return outcome.task, None, outcome.planner


def write_file(path: Path, data: bytes) -> None:
    """Write a file, making its folder.

    Raises:
        OutputError: It cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    except OSError as error:
        raise OutputError(
            f"cannot write: {error.strerror}", where=str(path), advice="choose a folder that you may write to"
        ) from None


def may_ask() -> bool:
    """Whether there is a person to ask."""
    return sys.stdin is not None and sys.stdin.isatty()
