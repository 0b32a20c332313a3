"""Send the commands of an operator to a stored mission, through its folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.errors import ExecutionError
from fieldhand.folders import is_locked
from fieldhand.language import message
from fieldhand.missions.folder import JOURNAL, ORDERS
from fieldhand.missions.mission_status import events_of

if TYPE_CHECKING:
    from fieldhand.execution.operator_commands import FileCommand


def send_command(folder: Path, command: FileCommand, reason: str, *, wait: Callable[[], bool] = lambda: False) -> bool:
    """Command a mission to pause, to continue, to return to the start or to stop at once (``abort``).

    Args:
        folder: Folder of the mission.
        command: The command.
        reason: Reason, or name of the operator, for the event log.
        wait: Waits a moment, and returns True to wait longer for the mission.

    Returns:
        True if the mission has received the command. An interrupted mission receives it when it is resumed.

    Raises:
        ExecutionError: The mission has ended, or was stopped before.
        JournalError: The folder is not that of a mission.
    """
    from fieldhand.execution.journal.store import read_summary
    from fieldhand.execution.operator_commands import CommandFile
    from fieldhand.task.results import Ended

    if any(isinstance(event, Ended) for event in events_of(folder)):
        raise ExecutionError(message("the mission has ended"), where=folder.name)
    number = CommandFile(folder / ORDERS).give(command, reason)
    while is_locked(folder):
        if read_summary(folder / JOURNAL)[0] >= number:
            return True
        if not wait():
            break
    return read_summary(folder / JOURNAL)[0] >= number


def has_received_all(folder: Path) -> bool:
    """Return True if a mission has received the last command.

    Raises:
        JournalError: The folder is not that of a mission.
    """
    from fieldhand.execution.journal.store import read_summary
    from fieldhand.execution.operator_commands import CommandFile

    return read_summary(folder / JOURNAL)[0] >= CommandFile(folder / ORDERS).last()[0]


def last_command(folder: Path) -> str:
    """Return the last command to a mission; empty if there was none.

    Raises:
        JournalError: The folder is not that of a mission.
    """
    from fieldhand.execution.operator_commands import CommandFile

    return CommandFile(folder / ORDERS).last()[1]
