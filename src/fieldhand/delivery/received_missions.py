"""The database of received missions: one SQLite file that one process at a time has open."""

from __future__ import annotations

import hashlib
import json
import sqlite3
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from fieldhand.compatibility import (
    SQLITE_BUSY,
    SQLITE_CANTOPEN,
    SQLITE_FULL,
    SQLITE_IOERR,
    SQLITE_LOCKED,
    SQLITE_READONLY,
    sqlite_code,
)
from fieldhand.errors import StoreError
from fieldhand.folders import FolderLock, FolderTaken

#: Format of the database; other versions refuse it.
FORMAT = 2
#: Result codes of SQLite for a disk that is full, broken or write-protected.
_UNWRITABLE = (SQLITE_FULL, SQLITE_IOERR, SQLITE_READONLY, SQLITE_CANTOPEN)

_TABLES = (
    "CREATE TABLE about (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE held (n INTEGER PRIMARY KEY, sha256 TEXT NOT NULL UNIQUE, task TEXT NOT NULL, request TEXT NOT NULL,"
    " signer TEXT NOT NULL, approved_at REAL NOT NULL, received_at TEXT NOT NULL, hashes TEXT NOT NULL,"
    " begun_at TEXT, turn INTEGER)",
)
#: Columns that format 2 added to ``held``, for missions that begin at a time of their own and for their runs.
_COLUMNS_OF_2 = (
    "bundle TEXT",
    "due REAL",
    "latest REAL",
    "done_by REAL",
    "missed TEXT",
    "kept_from REAL",
    "ended TEXT",
)
_COLUMNS = (
    "sha256, task, request, signer, approved_at, received_at, hashes, begun_at,"
    " bundle, due, latest, done_by, missed, kept_from, ended"
)


@dataclass(frozen=True, kw_only=True)
class RecordedRun:
    """A run of a mission with a timetable. Times are seconds since 1970.

    Attributes:
        of: SHA-256 of the signed mission.
        due: Time at which it is due.
        latest: Time until which it may begin.
        done_by: Time by which it has to be done; None for no such limit.
        missed: Reason for which it did not begin; empty if it has begun or still may.
    """

    of: str
    due: float
    latest: float
    done_by: float | None = None
    missed: str = ""


@dataclass(frozen=True, kw_only=True)
class ReceivedMission:
    """A mission that the robot has received.

    Attributes:
        sha256: SHA-256 of the signed mission.
        task: Id of its Task, which is the same for the same request, plan, site and robot, whenever it was approved.
        request: Request that it was planned from.
        signer: Name of the key that signed it, as this robot knows it.
        approved_at: Time of the approval, in seconds since 1970.
        received_at: Time at which it was received, ISO 8601.
        hashes: Verified SHA-256 of the file (``bundle``) and of each of its members.
        begun_at: Time at which it was begun, ISO 8601; None if it never was.
        run: The run of a mission with a timetable, for which ``sha256`` is an id of its own; None for a mission itself.
        kept_from: Time from which its timetable is kept, in seconds since 1970; None if it has none or was not started.
        ended: Reason for which its timetable is no longer kept; empty if it is kept.
    """

    sha256: str
    task: str
    request: str
    signer: str
    approved_at: float
    received_at: str
    hashes: Mapping[str, str]
    begun_at: str | None
    run: RecordedRun | None = None
    kept_from: float | None = None
    ended: str = ""

    @property
    def name(self) -> str:
        """Name of its folder."""
        return self.sha256[:16]

    @property
    def bundle(self) -> str:
        """SHA-256 of its signed mission."""
        return self.sha256 if self.run is None else self.run.of

    def with_run(self, run: RecordedRun) -> ReceivedMission:
        """Return a run of this mission, as a mission with an id of its own."""
        identity = hashlib.sha256(f"{self.sha256} {run.due:.0f}".encode()).hexdigest()
        return replace(self, sha256=identity, begun_at=None, run=run, kept_from=None, ended="")


class ReceivedMissions:
    """The database of a mission store. Thread-safe.

    Args:
        path: File of the database; made if it does not exist.

    Raises:
        StoreError: Another process has the database open, it is damaged, or it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._thread_lock = threading.RLock()
        with self._store_errors():
            # The folder is locked instead of the database, whose lock would vanish with it if it were deleted.
            self._lock = FolderLock(path.parent)
        try:
            self._db = self._open()
            found = path.stat()
        except BaseException:
            self._lock.close()
            raise
        self._file = found.st_dev, found.st_ino

    def close(self) -> None:
        """Close the database and release the lock."""
        with self._thread_lock:
            self._db.close()
            self._lock.close()

    def note(self, held: ReceivedMission) -> None:
        """Add a mission that was received."""
        row = [
            held.sha256,
            held.task,
            held.request,
            held.signer,
            held.approved_at,
            held.received_at,
            json.dumps(dict(held.hashes)),
            held.begun_at,
            *(() if held.run is None else (held.run.of, held.run.due, held.run.latest, held.run.done_by)),
        ]
        columns = ", ".join(_COLUMNS.split(", ")[: len(row)])
        with self._thread_lock, self._store_errors():
            self._require_in_place()
            self._db.execute(f"INSERT INTO held ({columns}) VALUES ({', '.join('?' * len(row))})", row)  # noqa: S608

    def note_begun(self, sha256: str, at: str) -> None:
        """Record that a mission was begun."""
        turn = "(SELECT coalesce(max(turn), 0) + 1 FROM held)"
        with self._thread_lock, self._store_errors():
            self._require_in_place()
            self._db.execute(
                f"UPDATE held SET begun_at = ?, turn = {turn} WHERE sha256 = ? AND begun_at IS NULL",  # noqa: S608
                [at, sha256],
            )

    def keep(self, sha256: str, since: float) -> None:
        """Record that the timetable of a mission is kept from now on; one that was ended stays ended."""
        self._set("kept_from = ? WHERE sha256 = ? AND kept_from IS NULL", since, sha256)

    def end(self, sha256: str, why: str) -> None:
        """Record that the timetable of a mission is no longer kept."""
        self._set("ended = ? WHERE sha256 = ? AND ended IS NULL", why, sha256)

    def miss(self, sha256: str, why: str) -> None:
        """Record that a run is left out; one that has begun is not."""
        self._set("missed = ? WHERE sha256 = ? AND missed IS NULL AND begun_at IS NULL", why, sha256)

    def _set(self, what: str, *values: object) -> None:
        with self._thread_lock, self._store_errors():
            self._require_in_place()
            self._db.execute(f"UPDATE held SET {what}", values)  # noqa: S608

    def kept(self) -> tuple[ReceivedMission, ...]:
        """Return the missions whose timetable is kept, in the order in which they arrived."""
        return self._rows("WHERE kept_from IS NOT NULL AND ended IS NULL ORDER BY n")

    def pending(self) -> tuple[ReceivedMission, ...]:
        """Return the runs that are due and have neither begun nor been left out, the one that is due first first."""
        return self._rows("WHERE due IS NOT NULL AND begun_at IS NULL AND missed IS NULL ORDER BY due, n")

    def runs(self, sha256: str, most: int) -> tuple[ReceivedMission, ...]:
        """Return the latest runs of a mission, in order."""
        return self._rows("WHERE bundle = ? ORDER BY due DESC LIMIT ?", sha256, most)[::-1]

    def find(self, sha256: str) -> ReceivedMission | None:
        """Return the mission of a SHA-256; None if it was not received."""
        found = self._rows("WHERE sha256 = ?", sha256)
        return found[0] if found else None

    def later(self, task: str, approved_at: float) -> ReceivedMission | None:
        """Return a received mission of the same Task with a later approval; None if there is none."""
        found = self._rows("WHERE task = ? AND approved_at > ? ORDER BY approved_at DESC LIMIT 1", task, approved_at)
        return found[0] if found else None

    def latest(self, most: int) -> tuple[ReceivedMission, ...]:
        """Return the missions and runs that were added last, in the order in which they arrived."""
        return self._rows("ORDER BY n DESC LIMIT ?", most)[::-1]

    def last_begun(self) -> ReceivedMission | None:
        """Return the mission that was begun last, independent of the clock."""
        found = self._rows("WHERE turn IS NOT NULL ORDER BY turn DESC LIMIT 1")
        return found[0] if found else None

    def all(self) -> tuple[ReceivedMission, ...]:
        """Return every mission that was received, and every run of one."""
        return self._rows("ORDER BY n")

    def _rows(self, where: str, *values: object) -> tuple[ReceivedMission, ...]:
        with self._thread_lock, self._store_errors():
            rows = self._db.execute(f"SELECT {_COLUMNS} FROM held {where}", values).fetchall()  # noqa: S608
            return tuple(_received_mission(row) for row in rows)

    def _require_in_place(self) -> None:
        """Require that the database was not deleted or replaced, since what is written to it would be lost.

        Raises:
            StoreError: It was.
        """
        try:
            found = self._path.lstat()
            in_place = (found.st_dev, found.st_ino) == self._file
        except FileNotFoundError:
            in_place = False
        if not in_place:
            raise StoreError(
                "the database of the store is no longer in its place",
                where=str(self._path),
                advice="restore the folder of the store as it was, and start the agent again",
            )

    def _open(self) -> sqlite3.Connection:
        path = self._path
        with self._store_errors():
            db = sqlite3.connect(path, isolation_level=None, timeout=0.5, check_same_thread=False)
            try:
                # The lock is kept until the database is closed, so that two agents never use one store.
                db.execute("PRAGMA locking_mode=EXCLUSIVE")
                db.execute("PRAGMA synchronous=EXTRA")  # the removal of the rollback journal is synced, too
                db.execute("BEGIN EXCLUSIVE")
                if not db.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
                    for table in _TABLES:
                        db.execute(table)
                    db.execute("INSERT INTO about VALUES ('format', '1')")
                if db.execute("SELECT value FROM about WHERE key = 'format'").fetchone() == ("1",):
                    for column in _COLUMNS_OF_2:
                        db.execute(f"ALTER TABLE held ADD COLUMN {column}")
                    db.execute("UPDATE about SET value = ? WHERE key = 'format'", [str(FORMAT)])
                db.execute("COMMIT")
                sound = db.execute("PRAGMA quick_check(1)").fetchone()
                found = db.execute("SELECT value FROM about WHERE key = 'format'").fetchone()
                if sound != ("ok",):
                    raise sqlite3.DatabaseError(str(sound[0]))
                if found != (str(FORMAT),):
                    raise StoreError(
                        f"the store has format {found[0] if found else 'none'}, this version reads {FORMAT}",
                        where=str(path),
                        advice="use the version of Fieldhand that made it, or give another --store",
                    )
            except BaseException:
                db.close()
                raise
        return db

    @contextmanager
    def _store_errors(self) -> Iterator[None]:
        """Turn errors of SQLite and of the file system into a StoreError."""
        try:
            yield
        except OSError as error:
            raise StoreError(
                f"the store cannot be used: {error.strerror or error}",
                where=str(self._path),
                advice="check its permissions",
            ) from None
        except (sqlite3.Error, ValueError, FolderTaken) as error:
            if isinstance(error, FolderTaken) or sqlite_code(error) in (SQLITE_BUSY, SQLITE_LOCKED):
                raise StoreError(
                    "another agent has this store open",
                    where=str(self._path),
                    advice="end that one first, or give another --store",
                ) from None
            if sqlite_code(error) in _UNWRITABLE:
                raise StoreError(
                    f"the store cannot be written: {error}", where=str(self._path), advice="free some space"
                ) from None
            raise StoreError(
                f"the store is damaged: {error}",
                where=str(self._path),
                advice="move the folder of the store away; nothing runs again by itself; send again what has not run",
            ) from None


def _received_mission(row: tuple[Any, ...]) -> ReceivedMission:
    sha256, task, request, signer, approved_at, received_at, hashes, begun_at, *rest = row
    bundle, due, latest, done_by, missed, kept_from, ended = rest
    run = None
    if bundle is not None:
        run = RecordedRun(of=bundle, due=due, latest=latest, done_by=done_by, missed=missed or "")
    return ReceivedMission(
        sha256=sha256,
        task=task,
        request=request,
        signer=signer,
        approved_at=approved_at,
        received_at=received_at,
        hashes=json.loads(hashes),
        begun_at=begun_at,
        run=run,
        kept_from=kept_from,
        ended=ended or "",
    )
