"""Orders from another process. They have a file of their own, so that no one who gives one can hold up the journal."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Literal, cast

from fieldhand.errors import ExecutionError, JournalError
from fieldhand.execution.orders import Order, Wanted

#: What can be ordered.
Said = Literal["pause", "continue", "return", "abort"]

#: What an order may be followed by.
_AFTER: dict[str, frozenset[str]] = {
    "": frozenset({"pause", "return", "abort"}),
    "pause": frozenset({"pause", "continue", "return", "abort"}),
    "continue": frozenset({"pause", "continue", "return", "abort"}),
    "return": frozenset({"return", "abort"}),
    "abort": frozenset({"abort"}),
}


class Desk:
    """Where the orders of a mission lie.

    Args:
        path: The file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._db: sqlite3.Connection | None = None
        self._file: tuple[int, int] | None = None
        self._before: Order | None = None

    def create(self) -> None:
        """Make it, empty.

        Raises:
            JournalError: It cannot be written.
        """
        try:
            with closing(self._connect("rwc")) as db:
                db.execute("PRAGMA journal_mode=WAL")
                db.execute("CREATE TABLE orders (n INTEGER PRIMARY KEY, said TEXT NOT NULL, reason TEXT NOT NULL)")
        except sqlite3.Error as error:
            raise self._unusable(error) from None

    def say(self, said: Said, reason: str) -> int:
        """Give an order.

        Returns:
            Its number.

        Raises:
            ExecutionError: It comes too late: the mission was told to stop, or to come home.
            JournalError: It cannot be written.
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

    def standing(self) -> Order | None:
        """Return the order that stands. A file that cannot be read is an order to stop: nobody could give another."""
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
        """Number and word of the last order; (0, "") where there is none."""
        try:
            with closing(self._connect()) as db:
                return self._last(db)
        except sqlite3.Error as error:
            raise self._unusable(error) from None

    def close(self) -> None:
        """Let go of the file."""
        if self._db is not None:
            self._db.close()
            self._db = None

    def _last(self, db: sqlite3.Connection) -> tuple[int, str]:
        row = db.execute("SELECT n, said FROM orders ORDER BY n DESC LIMIT 1").fetchone()
        return (0, "") if row is None else (row[0], row[1])

    def _connect(self, mode: str = "rw") -> sqlite3.Connection:
        """Open the file; only ``rwc`` makes one that is not there."""
        uri = f"{self._path.absolute().as_uri()}?mode={mode}"
        db = sqlite3.connect(uri, uri=True, isolation_level=None, timeout=2.0)
        db.execute("PRAGMA synchronous=FULL")
        return db

    def _identity(self) -> tuple[int, int]:
        found = self._path.lstat()
        return found.st_dev, found.st_ino

    def _unusable(self, error: sqlite3.Error) -> JournalError:
        return JournalError(f"the orders of the mission cannot be used: {error}", where=str(self._path))
