"""Operator commands to a mission under way, and the file in which other processes give them.

The file is separate from the journal, so that a process that gives a command cannot block the journal.
"""

from __future__ import annotations

import sqlite3
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast, get_args

from fieldhand.compatibility import SQLITE_BUSY, SQLITE_LOCKED, sqlite_code
from fieldhand.errors import ExecutionError, InputError, JournalError

#: All commands. ``pause``: stand still. ``continue``: end the pause. ``return``: drive home now. ``abort``: stop here;
#: the mission is over. ``end``: take the Task's exit for an abort (Ctrl-C, a terminated program).
CommandKind = Literal["pause", "continue", "return", "abort", "end"]

#: Commands that another process can give.
FileCommand = Literal["pause", "continue", "return", "abort"]

#: Commands that can be given in memory: they stop the robot or bring it home.
StoppingCommand = Literal["pause", "return", "abort"]

#: Commands that a robot's agent accepts over the network; its ``resume`` is ``continue`` in the file. ``cancel``: keep
#: the timetable of a mission no longer, or leave out a run that has not begun.
MissionCommand = Literal["start", "pause", "resume", "return", "abort"]
AgentCommand = MissionCommand | Literal["cancel"]
AGENT_COMMANDS: tuple[AgentCommand, ...] = (*get_args(MissionCommand), "cancel")

#: Commands that may follow each command.
_AFTER: dict[str, frozenset[str]] = {
    # The mission may pause by itself, while another client drives the robot.
    "": frozenset({"pause", "continue", "return", "abort"}),
    "pause": frozenset({"pause", "continue", "return", "abort"}),
    "continue": frozenset({"pause", "continue", "return", "abort"}),
    "return": frozenset({"return", "abort"}),
    "abort": frozenset({"abort"}),
}


@dataclass(frozen=True, kw_only=True)
class OperatorCommand:
    """A command, in force until the next one.

    Attributes:
        reason: Who gave it, or why, in words.
        number: Number in the mission's folder, from 1; 0 if given otherwise.
    """

    wanted: CommandKind
    reason: str
    number: int = 0


def parse_agent_command(word: str) -> AgentCommand:
    """Return the agent command of this name.

    Raises:
        InputError: There is none.
    """
    for command in AGENT_COMMANDS:
        if command == word:
            return command
    raise InputError(
        f"there is no order '{word[:40]}'", where="order", advice=f"give one of {', '.join(AGENT_COMMANDS)}"
    )


class CommandFile:
    """The commands to a mission, in a file that any process can append to.

    Args:
        path: The file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._db: sqlite3.Connection | None = None
        self._file: tuple[int, int] | None = None
        self._before: OperatorCommand | None = None

    def create(self) -> None:
        """Create the file, empty.

        Raises:
            JournalError: The file cannot be written.
        """
        try:
            with closing(self._connect("rwc")) as db:
                db.execute("PRAGMA journal_mode=WAL")
                db.execute("CREATE TABLE orders (n INTEGER PRIMARY KEY, said TEXT NOT NULL, reason TEXT NOT NULL)")
        except sqlite3.Error as error:
            raise self._unusable(error) from None

    def give(self, command: FileCommand, reason: str) -> int:
        """Append a command.

        Returns:
            Its number.

        Raises:
            ExecutionError: An earlier command, to return or to abort, excludes it.
            JournalError: The file cannot be written.
        """
        try:
            with closing(self._connect()) as db:
                db.execute("BEGIN IMMEDIATE")
                number, last = self._last(db)
                if command not in _AFTER[last]:
                    raise ExecutionError(f"the mission was already told to {last}")
                db.execute("INSERT INTO orders VALUES (?, ?, ?)", [number + 1, command, reason])
                db.execute("COMMIT")
                return number + 1
        except sqlite3.Error as error:
            raise self._unusable(error) from None

    def current(self) -> OperatorCommand | None:
        """Return the current command. An unreadable file counts as an abort, since no other command could arrive."""
        try:
            if self._db is None:
                self._db, self._file = self._connect(), self._identity()
            elif self._identity() != self._file:
                return OperatorCommand(wanted="abort", reason="its orders cannot be read: their file was replaced")
            row = self._db.execute("SELECT n, said, reason FROM orders ORDER BY n DESC LIMIT 1").fetchone()
        except sqlite3.OperationalError as error:
            if sqlite_code(error) in (SQLITE_BUSY, SQLITE_LOCKED):
                return self._before
            return OperatorCommand(wanted="abort", reason=f"its orders cannot be read: {error}")
        except (sqlite3.Error, OSError) as error:
            return OperatorCommand(wanted="abort", reason=f"its orders cannot be read: {error}")
        if row is not None:
            self._before = OperatorCommand(wanted=cast("CommandKind", row[1]), reason=row[2], number=row[0])
        return self._before

    def last(self) -> tuple[int, str]:
        """Return the number and word of the last command, or (0, "")."""
        try:
            with closing(self._connect()) as db:
                return self._last(db)
        except sqlite3.Error as error:
            raise self._unusable(error) from None

    def close(self) -> None:
        """Close the file."""
        if self._db is not None:
            self._db.close()
            self._db = None

    def _last(self, db: sqlite3.Connection) -> tuple[int, str]:
        row = db.execute("SELECT n, said FROM orders ORDER BY n DESC LIMIT 1").fetchone()
        return (0, "") if row is None else (row[0], row[1])

    def _connect(self, mode: str = "rw") -> sqlite3.Connection:
        """Open the file; only ``rwc`` creates it."""
        uri = f"{self._path.absolute().as_uri()}?mode={mode}"
        db = sqlite3.connect(uri, uri=True, isolation_level=None, timeout=2.0)
        db.execute("PRAGMA synchronous=FULL")
        return db

    def _identity(self) -> tuple[int, int]:
        found = self._path.lstat()
        return found.st_dev, found.st_ino

    def _unusable(self, error: sqlite3.Error) -> JournalError:
        return JournalError(f"the orders of the mission cannot be used: {error}", where=str(self._path))
