"""Earlier missions at the command line: added to a Task whose plan depends on them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import DisplayOptions, MissionsOption

if TYPE_CHECKING:
    from fieldhand.mission.documents import SiteAndRobot
    from fieldhand.task.frames import Task

CountSimulatedOption = Annotated[
    bool,
    typer.Option(
        "--count-simulated", help="Count simulated missions among the earlier ones, not only what a robot did."
    ),
]
RecountOption = Annotated[
    bool,
    typer.Option("--recount", help="Count the earlier missions anew, instead of those that the Task contains."),
]


@dataclass(frozen=True, kw_only=True)
class EarlierOptions:
    """Missions that a plan may refer to."""

    count_simulated: CountSimulatedOption = False
    recount: RecountOption = False


@dataclass(frozen=True, kw_only=True)
class StoredEarlierOptions(EarlierOptions):
    """Missions that a plan may refer to, with their folder."""

    missions: MissionsOption = None


def add_earlier(
    task: Task,
    document: bytes | None,
    site_and_robot: SiteAndRobot,
    earlier: EarlierOptions,
    folder: Path | None,
    display: DisplayOptions,
) -> tuple[Task, bytes | None]:
    """Return a Task with the earlier missions that it depends on, and its document; else both as they are.

    Args:
        task: The Task.
        document: Bytes of its document, if it was read.
        site_and_robot: Its site and robot.
        earlier: Missions that count.
        folder: Folder of all missions; None for the default.
        display: Language of notes.

    Raises:
        JournalError: The folder may not be read.
        TaskError: The Task depends on more earlier captures than it can contain.
    """
    from fieldhand.task.earlier import uses_records, with_earlier

    if not uses_records(task) or (task.earlier is not None and not earlier.recount):
        return task, document
    from fieldhand.cli.show import note
    from fieldhand.missions.earlier_missions import earlier_missions
    from fieldhand.task.codec import encode

    records = earlier_missions(
        site_and_robot.site,
        folder,
        simulated=earlier.count_simulated,
        notice=lambda text: note(text, display.language),
    )
    added = with_earlier(task, records)
    return added, None if document is None else encode(added)
