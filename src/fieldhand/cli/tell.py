"""``fieldhand pause``, ``abort`` and ``return``: send a command to a mission from another process."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import DisplayOptions, JsonOption, LangOption, MissionArgument, MissionsOption
from fieldhand.language import message

if TYPE_CHECKING:
    from fieldhand.execution.operator_commands import FileCommand

#: Seconds to wait for the mission, which reads its commands ten times a second.
ANSWER_WITHIN_S = 5.0

BecauseOption = Annotated[str, typer.Option("--because", help="Why, in words; the event log keeps it.")]


def pause(
    mission: MissionArgument = None,
    because: BecauseOption = "paused by the operator",
    lang: LangOption = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Pause a mission after the current capture; `fieldhand resume` continues it."""
    tell(mission, kept, "pause", because, message("paused"), DisplayOptions(lang=lang, json=json))


def abort(
    mission: MissionArgument = None,
    because: BecauseOption = "stopped by the operator",
    lang: LangOption = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Stop the robot at once and end the mission."""
    tell(mission, kept, "abort", because, message("stopped"), DisplayOptions(lang=lang, json=json))


def come_home(
    mission: MissionArgument = None,
    because: BecauseOption = "called home by the operator",
    lang: LangOption = None,
    kept: MissionsOption = None,
    json: JsonOption = False,
) -> None:
    """Skip the rest of a mission and drive home; the mission ends there."""
    tell(mission, kept, "return", because, message("returning"), DisplayOptions(lang=lang, json=json))


def tell(
    name: str | None, parent: Path | None, command: FileCommand, because: str, done: str, display: DisplayOptions
) -> None:
    """Send a command to a mission and print its answer; exit status 1 if it does not answer in time.

    Args:
        name: Name of the mission; None for the one begun last.
        parent: Folder of all missions; None for the default.
        command: Command of the operator.
        because: Reason, for the event log.
        done: Message that the mission has obeyed.
        display: Language, and JSON instead of text.

    Raises:
        ExecutionError: The mission has ended.
    """
    import time

    from fieldhand import missions
    from fieldhand.cli import show

    language = display.language
    folder = missions.find(parent or missions.missions_folder(os.environ), name)
    until = time.monotonic() + ANSWER_WITHIN_S

    def wait() -> bool:
        time.sleep(0.02)
        return time.monotonic() < until

    heard = missions.send_command(folder, command, because, wait=wait)
    if display.json:
        show.print_json({"mission": folder.name, "order": command, "heard": heard})
    elif heard:
        show.out.print(language.say(message("mission {id}: {done}", id=folder.name, done=done)))
    elif missions.is_running(folder):
        waits = message("mission {id} has not answered yet; the order remains in force", id=folder.name)
        show.out.print(language.say(waits))
    else:
        cut = message(
            "mission {id} was interrupted; the order remains in force and applies when it is resumed", id=folder.name
        )
        show.out.print(language.say(cut))
    raise SystemExit(0 if heard else 1)
