"""Orders to a mission under way, and the file in which other processes give them.

The file is not the journal, so that whoever gives an order cannot block the journal.
"""

from __future__ import annotations

import sqlite3
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

from fieldhand.errors import ExecutionError, JournalError

#: ``pause``: stand still until told otherwise. ``continue``: the pause is over. ``return``: come home now.
#: ``abort``: stop here, the mission is over.
#: ``end``: end as the Task says of an abort (Ctrl-C, a program that is told to end).
Wanted = Literal["pause", "continue", "return", "abort", "end"]

#: Orders that another process can give.
OrderWord = Literal["pause", "continue", "return", "abort"]

#: Orders that may follow each order.
_AFTER: dict[str, frozenset[str]] = {
    "": frozenset({"pause", "return", "abort"}),
    "pause": frozenset({"pause", "continue", "return", "abort"}),
    "continue": frozenset({"pause", "continue", "return", "abort"}),
    "return": frozenset({"return", "abort"}),
    "abort": frozenset({"abort"}),
}


@dataclass(frozen=True, kw_only=True)
class Order:
    """An order that holds until another replaces it.

    Attributes:
        reason: Who wants it, or why, in words.
        number: Number in the mission's folder, from 1; 0 if given otherwise.
    """

    wanted: Wanted
    reason: str
    number: int = 0


class OrderFile:
    """The orders of a mission, in a file that any process can append to.

    Args:
        path: The file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._db: sqlite3.Connection | None = None
        self._file: tuple[int, int] | None = None
        self._before: Order | None = None

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

    def give(self, said: OrderWord, reason: str) -> int:
        """Give an order.

        Returns:
            Its number.

        Raises:
            ExecutionError: The mission was told to stop, or to come home, before.
            JournalError: The file cannot be written.
        """
        try:
            with closing(self._connect()) as db:
                db.execute("BEGIN IMMEDIATE")
                number, last = self._last(db)
                if said not in _AFTER[last]:
                    raise ExecutionError(f"the mission was told to {last} already")
                db.execute("INSERT INTO orders VALUES (?, ?, ?)", [number + 1, said, reason])
                db.execute("COMMIT")
                return number + 1
        except sqlite3.Error as error:
            raise self._unusable(error) from None

    def current(self) -> Order | None:
        """Return the current order. A file that cannot be read is an order to stop: nobody could give another."""
        try:
            if self._db is None:
                self._db, self._file = self._connect(), self._identity()
            elif self._identity() != self._file:
                return Order(wanted="abort", reason="its orders cannot be read: their file was replaced")
            row = self._db.execute("SELECT n, said, reason FROM orders ORDER BY n DESC LIMIT 1").fetchone()
        except sqlite3.OperationalError as error:
            if "locked" in str(error) or "busy" in str(error):
                return self._before
            return Order(wanted="abort", reason=f"its orders cannot be read: {error}")
        except (sqlite3.Error, OSError) as error:
            return Order(wanted="abort", reason=f"its orders cannot be read: {error}")
        if row is not None:
            self._before = Order(wanted=cast("Wanted", row[1]), reason=row[2], number=row[0])
        return self._before

    def last(self) -> tuple[int, str]:
        """Return the number and word of the last order, or (0, "")."""
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
