"""The outbox: signed missions that wait until their robot can be reached, as files beside a database.

A mission is stored before the first attempt to send it, so that it survives the end of the sending program.
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

#: Format of the database; other versions refuse it.
FORMAT = 1

DeliveryState = Literal["waiting", "delivered", "refused"]

_TABLES = (
    "CREATE TABLE IF NOT EXISTS about (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE IF NOT EXISTS entries (n INTEGER PRIMARY KEY AUTOINCREMENT, sha256 TEXT NOT NULL, url TEXT NOT NULL,"
    " name TEXT NOT NULL, start INTEGER NOT NULL, ca TEXT NOT NULL, pin TEXT NOT NULL, plain INTEGER NOT NULL,"
    " token_file TEXT NOT NULL, queued_at REAL NOT NULL, tries INTEGER NOT NULL, next_at REAL NOT NULL,"
    " state TEXT NOT NULL, said TEXT NOT NULL, UNIQUE (sha256, url))",
)


@dataclass(frozen=True, kw_only=True)
class OutboxEntry:
    """A mission in the outbox.

    Attributes:
        n: Number of the entry; 0 for one that is not in the outbox yet.
        sha256: SHA-256 of the signed mission.
        url: Address of the robot.
        name: Name of the file.
        start: True to start the mission once it has arrived.
        ca, pin, plain: As for :class:`fieldhand.delivery.server_certificate.ServerTrust`.
        token_file: File with the token; empty for the environment. The token itself is not stored.
        queued_at: Time at which it was added, in seconds since 1970.
        tries: Number of attempts.
        next_at: Time of the next attempt, in seconds since 1970.
        state: ``waiting``, ``delivered`` or ``refused``.
        response: Response of the robot, or the reason why it could not be reached.
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
    state: DeliveryState = "waiting"
    response: str = ""


#: Fields of an entry, and their columns; that of ``response`` is called ``said`` since the first version.
_FIELDS = tuple(field.name for field in fields(OutboxEntry))
_COLUMNS = ", ".join("said" if name == "response" else name for name in _FIELDS)
_NEW = _COLUMNS.removeprefix("n, ")


def outbox_folder(environ: Mapping[str, str]) -> Path:
    """Return the default folder of the outbox: ``FIELDHAND_OUTBOX``, else one in the user's state folder.

    Raises:
        InputError: The environment variable names a file.
    """
    return named_folder(environ, "FIELDHAND_OUTBOX") or state_folder(environ) / "outbox"


class Outbox:
    """Missions that wait for their robot. Several processes may use it at the same time.

    Args:
        folder: Folder of the outbox; made if it does not exist.
    """

    def __init__(self, folder: Path) -> None:
        self._folder, self._path = folder, folder / "outbox.sqlite"

    def put(self, entry: OutboxEntry, data: bytes) -> OutboxEntry:
        """Store a mission until it is delivered; one that is stored already is sent again.

        If the mission is to be started, others that wait to be started on the same robot are only delivered.

        Raises:
            StoreError: The outbox cannot be written, or is damaged.
        """
        from fieldhand.approval.keys.rights import make_folder, replace

        make_folder(self._folder)
        values = [getattr(entry, name) for name in _FIELDS[1:]]
        with self._db() as db:
            replace(self._bundle(entry.sha256), data)
            if entry.start:
                db.execute("UPDATE entries SET start = 0 WHERE url = ? AND state = 'waiting'", [entry.url])
            db.execute("DELETE FROM entries WHERE sha256 = ? AND url = ?", [entry.sha256, entry.url])
            marks = ", ".join("?" * len(values))
            number = db.execute(f"INSERT INTO entries ({_NEW}) VALUES ({marks})", values).lastrowid  # noqa: S608
            return _entry(db.execute(f"SELECT {_COLUMNS} FROM entries WHERE n = ?", [number]).fetchone())  # noqa: S608

    def note(self, entry: OutboxEntry) -> None:
        """Record the result of an attempt. An entry that was replaced meanwhile stays unchanged.

        Raises:
            StoreError: The outbox cannot be written.
        """
        with self._db() as db:
            db.execute(
                "UPDATE entries SET tries = ?, next_at = ?, state = ?, said = ? WHERE n = ?",
                [entry.tries, entry.next_at, entry.state, entry.response, entry.n],
            )
        # Files are removed once that is on disk, so that each waiting entry has its file; and under the lock, as a
        # mission may be stored again meanwhile.
        with self._db() as db:
            waiting = db.execute("SELECT DISTINCT sha256 FROM entries WHERE state = 'waiting'")
            needed = {self._bundle(sha256) for (sha256,) in waiting}
            for path in self._folder.glob("*.mission"):
                if path not in needed:
                    path.unlink()

    def entries(self) -> tuple[OutboxEntry, ...]:
        """Return all entries in the order in which they were added.

        Raises:
            StoreError: The outbox is damaged.
        """
        if not self._path.exists():
            return ()
        with self._db() as db:
            rows = db.execute(f"SELECT {_COLUMNS} FROM entries ORDER BY n").fetchall()  # noqa: S608
            return tuple(_entry(row) for row in rows)

    def waiting(self) -> tuple[OutboxEntry, ...]:
        """Return the entries that are not delivered."""
        return tuple(entry for entry in self.entries() if entry.state == "waiting")

    def bundle(self, entry: OutboxEntry) -> bytes:
        """Return the bytes of a signed mission.

        Raises:
            StoreError: The file is missing or was changed.
        """
        path = self._bundle(entry.sha256)
        try:
            data = path.read_bytes()
        except OSError as error:
            raise StoreError(
                f"the mission cannot be read: {error.strerror}", where=str(path), advice="send the file again"
            ) from None
        if hashlib.sha256(data).hexdigest() != entry.sha256:
            raise StoreError("the mission differs from what was queued", where=str(path), advice="send the file again")
        return data

    def _bundle(self, sha256: str) -> Path:
        return self._folder / f"{sha256}.mission"

    @contextmanager
    def _db(self) -> Iterator[sqlite3.Connection]:
        """Open the database in a transaction."""
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
    values = dict(zip(_FIELDS, row, strict=True))
    return OutboxEntry(**{**values, "start": bool(values["start"]), "plain": bool(values["plain"])})  # type: ignore[arg-type]
