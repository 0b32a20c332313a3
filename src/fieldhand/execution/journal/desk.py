"""Orders from another process, and the lock that lets one process at a time carry a mission out.

Orders have a file of their own, so that no one who gives one can hold up the journal.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
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
        self._before: Order | None = None

    def create(self) -> None:
        """Make it, empty.

        Raises:
            JournalError: It cannot be written.
        """
        try:
            with closing(self._connect()) as db:
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
        """The order that stands. A file that cannot be read is an order to stop: nobody could give another."""
        try:
            self._db = self._db or self._connect()
            row = self._db.execute("SELECT n, said, reason FROM orders ORDER BY n DESC LIMIT 1").fetchone()
        except sqlite3.OperationalError as error:
            if "locked" in str(error) or "busy" in str(error):
                return self._before
            return Order(wanted="abort", reason=f"its orders cannot be read: {error}")
        except sqlite3.Error as error:
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

    def _connect(self) -> sqlite3.Connection:
        return sqlite3.connect(self._path, isolation_level=None, timeout=2.0)

    def _unusable(self, error: sqlite3.Error) -> JournalError:
        return JournalError(f"the orders of the mission cannot be used: {error}", where=str(self._path))


@contextmanager
def alone(path: Path) -> Iterator[None]:
    """Within this no other process carries the mission out. The lock dies with the process that holds it.

    Raises:
        JournalError: Another one does.
    """
    lock = sqlite3.connect(path, isolation_level=None, timeout=0.5)
    try:
        try:
            lock.execute("BEGIN EXCLUSIVE")
        except sqlite3.Error as error:
            raise JournalError(
                "another process is carrying this mission out"
                if "locked" in str(error)
                else f"the lock of the mission cannot be used: {error}",
                where=str(path.parent),
                advice="fieldhand status says what it does",
            ) from None
        yield
    finally:
        lock.close()


def taken(path: Path) -> bool:
    """Whether a process is carrying the mission out."""
    if not path.exists():
        return False
    with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True, timeout=0.0)) as lock:
        try:
            lock.execute("SELECT count(*) FROM sqlite_master").fetchone()
        except sqlite3.OperationalError as error:
            return "locked" in str(error)
        except sqlite3.Error:
            return False
    return False
