"""What could not be sent yet, kept until the robot is back: a database, and the bundles beside it.

A mission is in here before the first try to send it, so that it is not lost with the program that sends it.
"""

from __future__ import annotations

import hashlib
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Literal

from fieldhand.errors import StoreError
from fieldhand.files import named_folder, state_folder

#: Of the database; a program that writes another one refuses this.
FORMAT = 1

State = Literal["waiting", "delivered", "refused"]

_TABLES = (
    "CREATE TABLE IF NOT EXISTS about (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE IF NOT EXISTS entries (n INTEGER PRIMARY KEY AUTOINCREMENT, sha256 TEXT NOT NULL, url TEXT NOT NULL,"
    " name TEXT NOT NULL, start INTEGER NOT NULL, ca TEXT NOT NULL, pin TEXT NOT NULL, plain INTEGER NOT NULL,"
    " token_file TEXT NOT NULL, queued_at REAL NOT NULL, tries INTEGER NOT NULL, next_at REAL NOT NULL,"
    " state TEXT NOT NULL, said TEXT NOT NULL, UNIQUE (sha256, url))",
)


@dataclass(frozen=True, kw_only=True)
class OutboxEntry:
    """A mission for a robot.

    Attributes:
        n: Its number; 0 for one that is not in the outbox yet.
        sha256: Of the bundle.
        url: Of the robot.
        name: Of the file that was sent.
        start: Start it once it has arrived.
        ca, pin, plain: As :class:`fieldhand.delivery.server_certificate.ServerTrust`.
        token_file: Where the token is; empty for the environment. The token itself is not kept.
        queued_at, next_at: When it was given, and when to try next; seconds since 1970.
        tries: So far.
        said: What the robot said, or why it could not be asked.
    """

    n: int = 0
    sha256: str
    url: str
    name: str
    start: bool
    ca: str = ""
    pin: str = ""
    plain: bool = False
    token_file: str = ""
    queued_at: float
    tries: int = 0
    next_at: float
    state: State = "waiting"
    said: str = ""


_COLUMNS = ", ".join(field.name for field in fields(OutboxEntry))
_NEW = _COLUMNS.removeprefix("n, ")


def outbox_folder(environ: Mapping[str, str]) -> Path:
    """Where it is unless the user says otherwise: ``FIELDHAND_OUTBOX``, else in the user's state folder.

    Raises:
        InputError: What is named there is a file.
    """
    return named_folder(environ, "FIELDHAND_OUTBOX") or state_folder(environ) / "outbox"


class Outbox:
    """Missions that wait for their robot. Several processes may use it at once.

    Args:
        folder: It is made if it is not there.
    """

    def __init__(self, folder: Path) -> None:
        self._folder, self._path = folder, folder / "outbox.sqlite"

    def put(self, entry: OutboxEntry, data: bytes) -> OutboxEntry:
        """Keep a mission until it is delivered; one that was here before is sent anew.

        A mission that is to be started takes the place of those that wait to be started on the same robot: these are
        delivered, and no more.

        Raises:
            StoreError: It cannot be written, or is damaged.
        """
        from fieldhand.approval.keys.rights import make_folder, replace

        make_folder(self._folder)
        values = [getattr(entry, name) for name in _NEW.split(", ")]
        with self._db() as db:
            replace(self._bundle(entry.sha256), data)
            if entry.start:
                db.execute("UPDATE entries SET start = 0 WHERE url = ? AND state = 'waiting'", [entry.url])
            db.execute("DELETE FROM entries WHERE sha256 = ? AND url = ?", [entry.sha256, entry.url])
            marks = ", ".join("?" * len(values))
            number = db.execute(f"INSERT INTO entries ({_NEW}) VALUES ({marks})", values).lastrowid  # noqa: S608
            return _entry(db.execute(f"SELECT {_COLUMNS} FROM entries WHERE n = ?", [number]).fetchone())  # noqa: S608

    def note(self, entry: OutboxEntry) -> None:
        """Keep what became of a try. What was put in anew meanwhile stays as it is.

        Raises:
            StoreError: It cannot be written.
        """
        with self._db() as db:
            db.execute(
                "UPDATE entries SET tries = ?, next_at = ?, state = ?, said = ? WHERE n = ?",
                [entry.tries, entry.next_at, entry.state, entry.said, entry.n],
            )
        # Only once that is on the disk: what waits has its bundle. Under the lock again, for it may be put in anew.
        with self._db() as db:
            waiting = db.execute("SELECT DISTINCT sha256 FROM entries WHERE state = 'waiting'")
            needed = {self._bundle(sha256) for (sha256,) in waiting}
            for path in self._folder.glob("*.mission"):
                if path not in needed:
                    path.unlink()

    def entries(self) -> tuple[OutboxEntry, ...]:
        """All, in the order in which they were given.

        Raises:
            StoreError: It is damaged.
        """
        if not self._path.exists():
            return ()
        with self._db() as db:
            rows = db.execute(f"SELECT {_COLUMNS} FROM entries ORDER BY n").fetchall()  # noqa: S608
            return tuple(_entry(row) for row in rows)

    def waiting(self) -> tuple[OutboxEntry, ...]:
        """Those that are not delivered."""
        return tuple(entry for entry in self.entries() if entry.state == "waiting")

    def bundle(self, entry: OutboxEntry) -> bytes:
        """What is to be sent.

        Raises:
            StoreError: It is gone, or not what was put in.
        """
        path = self._bundle(entry.sha256)
        try:
            data = path.read_bytes()
        except OSError as error:
            raise StoreError(
                f"the mission cannot be read: {error.strerror}", where=str(path), advice="send the file again"
            ) from None
        if hashlib.sha256(data).hexdigest() != entry.sha256:
            raise StoreError("the mission is not what was put in", where=str(path), advice="send the file again")
        return data

    def _bundle(self, sha256: str) -> Path:
        return self._folder / f"{sha256}.mission"

    @contextmanager
    def _db(self) -> Iterator[sqlite3.Connection]:
        """The database in a transaction."""
        try:
            with closing(sqlite3.connect(self._path, isolation_level=None, timeout=5.0)) as db:
                db.execute("PRAGMA synchronous=EXTRA")  # the removal of the rollback journal is synced, too
                db.execute("BEGIN IMMEDIATE")
                for table in _TABLES:
                    db.execute(table)
                db.execute("INSERT OR IGNORE INTO about VALUES ('format', ?)", [str(FORMAT)])
                found = db.execute("SELECT value FROM about WHERE key = 'format'").fetchone()
                if found != (str(FORMAT),):
                    raise sqlite3.DatabaseError(f"it has format {found[0]}, this version reads {FORMAT}")
                yield db
                db.execute("COMMIT")
        except (sqlite3.Error, OSError) as error:
            raise StoreError(
                f"the outbox cannot be used: {error}",
                where=str(self._path),
                advice="free some space, or move the file away and send the missions again",
            ) from None


def _entry(row: tuple[object, ...]) -> OutboxEntry:
    values = dict(zip(_COLUMNS.split(", "), row, strict=True))
    return OutboxEntry(**{**values, "start": bool(values["start"]), "plain": bool(values["plain"])})  # type: ignore[arg-type]
