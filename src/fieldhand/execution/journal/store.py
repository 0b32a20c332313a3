"""Journal of a mission: one SQLite file that survives a power cut at any instant.

Write-ahead log with ``synchronous=FULL``: a commit is on the disk or did not happen. Answers and events are committed
together, so that they never contradict each other.
"""

from __future__ import annotations

import sqlite3
import stat
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from types import TracebackType

from fieldhand.compatibility import UTC
from fieldhand.errors import JournalError
from fieldhand.execution.event_log import EventLog
from fieldhand.execution.journal.hash_chain import ChainHead, extended, require_chain, start
from fieldhand.execution.journal.high_water_mark import (
    HighWaterMark,
    HighWaterMarkFile,
    create_mark,
    mark_path,
    read_mark,
)
from fieldhand.execution.journal.records import Record, divergence
from fieldhand.folders import FolderLock, FolderTaken, Unguarded, require_own_file
from fieldhand.task.event_lines import is_same

#: Format of the file; a program with another format rejects it. Rows of format 1 have no checksums: a journal of that
#: format can be read, and gets checksums when it is continued.
FORMAT, WITHOUT_CHECKSUMS = 2, 1

#: SQLite syncs at every commit. Tests, which do not cut the power, use less.
SYNCHRONOUS = "FULL"

#: The table of records is called ``tape``.
_TABLES = (
    "CREATE TABLE about (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE tape (n INTEGER PRIMARY KEY, kind TEXT NOT NULL, body TEXT NOT NULL, sha256 BLOB NOT NULL)",
    "CREATE TABLE events (n INTEGER PRIMARY KEY, at TEXT NOT NULL, line TEXT NOT NULL, sha256 BLOB NOT NULL)",
)
_COLUMNS = {"tape": "CAST(kind AS TEXT), CAST(body AS TEXT)", "events": "CAST(at AS TEXT), CAST(line AS TEXT)"}
#: Signs in SQLite's messages of a sound file that cannot be written, and advice.
_CANNOT = {
    "full": "free some space, then run fieldhand resume",
    "disk I/O": "check whether the disk is sound, then run fieldhand resume",
    "readonly": "let the user who runs the mission write there",
    "unable to open": "let the user who runs the mission write there",
    "locked": "end the other program that has it open",
}
_ANEW = "run the Task as a new mission"
_RESUME = "check whether the disk is sound and has space, then run fieldhand resume"
_OLDER = "restore the journal with its -wal file, or run what is left as a new mission"


def create(path: Path, mission: str) -> None:
    """Create the empty journal of a mission, and its mark beside it.

    Args:
        path: File that does not exist yet.
        mission: SHA-256 of the mission's content.

    Raises:
        JournalError: It cannot be written.
    """
    heads = {table: start(table) for table in ("tape", "events")}
    with _as_journal_error(path):
        create_mark(mark_path(path), HighWaterMark(epoch=0, heads=heads))
        with closing(_connect(path)) as db:
            db.execute("BEGIN IMMEDIATE")
            for table in _TABLES:
                db.execute(table)
            about = {"format": str(FORMAT), "mission": mission, "epoch": "0", "rows": _rows(heads)}
            db.executemany("INSERT INTO about VALUES (?, ?)", list(about.items()))
            db.execute("COMMIT")


class Journal:
    """An :class:`~fieldhand.execution.journal.records.InputLog` on the disk, open for writing.

    The folder is locked while it is open. Each opening has a number, its epoch, and each commit checks in the same
    transaction that no later opening has written another: if the lock failed to separate two writers, the earlier one
    stops.

    Args:
        path: Path of the journal.
        mission: SHA-256 of the mission's content.
        log: Path of the mission's event log, which is completed from the journal and extended.
        tell: Receives the line of each new event once it is committed.

    Attributes:
        before: Lines of the events that it held when it was opened.

    Raises:
        JournalError: It is in use, damaged, of another mission, or older than its mark or the event log.
    """

    def __init__(self, path: Path, mission: str, log: Path, on_event: Callable[[str], None]) -> None:
        self._path, self._on_event = path, on_event
        with _as_journal_error(path), ExitStack() as stack:
            stack.enter_context(_locked(path.parent))
            self._db = stack.enter_context(closing(_open(path, mission)))
            opened = _take_over(self._db, path)
            self._recorded, self.before, self._epoch = opened.records, opened.lines, opened.epoch
            self._heads: dict[str, ChainHead] = opened.heads
            self._log = stack.enter_context(closing(repaired_log(log, self.before)))
            self._mark = stack.enter_context(closing(HighWaterMarkFile(mark_path(path))))
            self._mark.write(HighWaterMark(epoch=self._epoch, heads=self._heads), stored=True)
            self._files = _identity(path)
            self._open = stack.pop_all()
        self._read = self._event_count = 0
        self._records: list[tuple[str, str]] = []
        self._events: list[tuple[str, str]] = []
        self._unannounced: deque[str] = deque()
        self._order = 0
        self._failed = False

    def next(self) -> Record | None:
        if self._read >= len(self._recorded):
            return None
        self._read += 1
        return self._recorded[self._read - 1]

    def append(self, record: Record) -> None:
        self._records.append((record.kind, record.body))

    def event(self, line: str) -> None:
        self._event_count += 1
        if self._event_count > len(self.before):
            self._events.append((datetime.now(UTC).isoformat(timespec="milliseconds"), line))
        elif not is_same(line, self.before[self._event_count - 1]):
            raise divergence(
                f"event {self._event_count} was {self.before[self._event_count - 1]}, now it would be {line}"
            )

    @property
    def has_new_events(self) -> bool:
        return bool(self._events)

    def commit(self, *, order: int = 0) -> None:
        if self._failed:
            # The disk's content after a failed write is unknown until the journal is read again.
            raise JournalError("the journal could not be written before", where=str(self._path), advice=_RESUME)
        with _as_journal_error(self._path):
            # Checked before, so that a resulting stop is not recorded, and after, since the commit counts then.
            self._require_in_place()
            self._write(order)
            self._require_in_place()
            self._mark.write(HighWaterMark(epoch=self._epoch, heads=self._heads))
        while self._unannounced:
            self._log.line(self._unannounced[0])
            self._on_event(self._unannounced[0])
            self._unannounced.popleft()

    def _write(self, order: int) -> None:
        """Write new rows in one transaction."""
        db, heads, committing = self._db, dict(self._heads), False
        try:
            db.execute("BEGIN IMMEDIATE")
            self._require_own_epoch()
            records, heads["tape"] = _numbered(heads["tape"], self._records)
            events, heads["events"] = _numbered(heads["events"], self._events)
            db.executemany("INSERT INTO tape VALUES (?, ?, ?, ?)", records)
            db.executemany("INSERT INTO events VALUES (?, ?, ?, ?)", events)
            about = {"rows": _rows(heads)} | ({"heard": str(order)} if order != self._order else {})
            db.executemany("INSERT OR REPLACE INTO about VALUES (?, ?)", list(about.items()))
            committing = True
            db.execute("COMMIT")
        except BaseException as error:
            # Ctrl-C after a completed commit; after any other error nothing was written.
            done = committing and not db.in_transaction and not isinstance(error, sqlite3.Error)
            if done:
                self._settle(heads, order)
            else:
                self._failed = isinstance(error, Exception)
                with suppress(sqlite3.Error):
                    db.execute("ROLLBACK")
            raise
        self._settle(heads, order)

    def _settle(self, heads: dict[str, ChainHead], order: int) -> None:
        """Mark the pending rows as stored."""
        self._unannounced.extend(line for _, line in self._events)
        self._heads, self._order, self._records, self._events = heads, order, [], []

    def _require_in_place(self) -> None:
        """Refuse to write to files that were deleted or moved.

        Raises:
            JournalError: They were.
        """
        if _identity(self._path) != self._files:
            self._failed = True
            raise JournalError(
                "the journal of this mission is no longer in its place",
                where=str(self._path),
                advice="restore the mission's folder as it was, then run fieldhand resume",
            )

    def _require_own_epoch(self) -> None:
        found = self._db.execute("SELECT value FROM about WHERE key = 'epoch'").fetchone()
        if found != (str(self._epoch),):
            raise JournalError(
                "another process has taken over this mission, so this one stops",
                where=str(self._path),
                advice="fieldhand status shows what the other one does",
            )

    def close(self) -> None:
        """Close the files and release the folder.

        Raises:
            JournalError: The disk fails.
        """
        with _as_journal_error(self._path):
            self._open.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


@dataclass(frozen=True, kw_only=True)
class _Opened:
    """Contents of a journal when it was opened for writing."""

    records: list[Record]
    lines: tuple[str, ...]
    heads: dict[str, ChainHead]
    epoch: int


def _take_over(db: sqlite3.Connection, path: Path) -> _Opened:
    """Read and verify a journal, and begin its next epoch, in one transaction.

    Raises:
        JournalError: It is damaged, or older than its mark.
    """
    db.execute("BEGIN IMMEDIATE")
    try:
        found = db.execute("PRAGMA quick_check(1)").fetchone()
        if found != ("ok",):
            raise JournalError(f"the journal is damaged: {found[0]}", where=str(path), advice=_ANEW)
        about = dict(db.execute("SELECT key, value FROM about"))
        if about.get("format") == str(WITHOUT_CHECKSUMS):
            _add_checksums(db, path)
            about = dict(db.execute("SELECT key, value FROM about"))
        records, record_heads = _checked(db, "tape", path)
        events, event_heads = _checked(db, "events", path)
        heads = {"tape": record_heads[-1], "events": event_heads[-1]}
        if about.get("rows") != _rows(heads):
            raise JournalError("rows are missing at its end", where=str(path), advice=_ANEW)
        epoch = int(about.get("epoch", ""))
        _require_mark(read_mark(mark_path(path)), epoch, {"tape": record_heads, "events": event_heads}, path)
        db.execute("UPDATE about SET value = ? WHERE key = 'epoch'", [str(epoch + 1)])
        db.execute("COMMIT")
    except BaseException:
        with suppress(sqlite3.Error):
            db.execute("ROLLBACK")
        raise
    return _Opened(
        records=[Record(kind=kind, body=body) for kind, body in records],
        lines=tuple(line for _, line in events),
        heads=heads,
        epoch=epoch + 1,
    )


def _checked(
    db: sqlite3.Connection, table: str, path: Path, *, after: int = 0, most: int = -1
) -> tuple[list[tuple[str, str]], list[ChainHead]]:
    """Return verified rows without numbers and checksums, and the heads before and after each.

    Args:
        db: The journal.
        table: Name of the table.
        path: Path of the journal.
        after: Number of the row after which to begin.
        most: Largest number of rows; -1 for all.

    Raises:
        JournalError: A row is missing or was changed.
    """
    head = start(table)
    if after:
        found = db.execute(f"SELECT sha256 FROM {table} WHERE n = ?", [after]).fetchone()  # noqa: S608
        if found is None:
            return [], [head]
        head = ChainHead(rows=after, sha256=found[0])
    rows = db.execute(
        f"SELECT n, {_COLUMNS[table]}, sha256 FROM {table} WHERE n > ? ORDER BY n LIMIT ?",  # noqa: S608
        [after, most],
    ).fetchall()
    heads = require_chain(head, table, ((n, sum_, (one, two)) for n, one, two, sum_ in rows), str(path))
    return [(one, two) for _, one, two, _ in rows], heads


def _require_mark(mark: HighWaterMark, epoch: int, heads: Mapping[str, Sequence[ChainHead]], path: Path) -> None:
    """Reject a journal that has fewer rows than its mark."""
    for table, reached in mark.heads.items():
        there = heads[table]
        if mark.epoch > epoch or reached.rows >= len(there) or there[reached.rows] != reached:
            raise JournalError(
                f"the journal is older than the mission: {len(there) - 1} rows of its {table} are there, and"
                f" {reached.rows} were written; it would do again what was done since",
                where=str(path),
                advice=_OLDER,
            )


def _add_checksums(db: sqlite3.Connection, path: Path) -> None:
    """Upgrade a journal of the first format, and its mark."""
    heads = {table: start(table) for table in ("tape", "events")}
    for table in heads:
        rows = db.execute(f"SELECT {_COLUMNS[table]} FROM {table} ORDER BY n").fetchall()  # noqa: S608
        numbered, heads[table] = _numbered(heads[table], rows)
        db.execute(f"ALTER TABLE {table} RENAME TO old_{table}")
        db.execute(next(made for made in _TABLES if made.startswith(f"CREATE TABLE {table} ")))
        db.executemany(f"INSERT INTO {table} VALUES (?, ?, ?, ?)", numbered)  # noqa: S608
        db.execute(f"DROP TABLE old_{table}")
    about = {"format": str(FORMAT), "epoch": "0", "rows": _rows(heads)}
    db.executemany("INSERT OR REPLACE INTO about VALUES (?, ?)", list(about.items()))
    create_mark(mark_path(path), HighWaterMark(epoch=0, heads=heads))


def _numbered(head: ChainHead, rows: Sequence[tuple[str, str]]) -> tuple[list[tuple[int, str, str, bytes]], ChainHead]:
    """Return rows in the form in which they are appended after a head, and the head after them."""
    found = []
    for one, two in rows:
        head = extended(head, one, two)
        found.append((head.rows, one, two, head.sha256))
    return found, head


def _rows(heads: Mapping[str, ChainHead]) -> str:
    return " ".join(f"{table}={head.rows}" for table, head in sorted(heads.items()))


def _locked(folder: Path) -> FolderLock:
    """Lock the folder of a journal.

    Raises:
        JournalError: Another process carries the mission out.
    """
    try:
        return FolderLock(folder)
    except FolderTaken:
        raise JournalError(
            "another process is running this mission",
            where=str(folder),
            advice="fieldhand status shows what it does",
        ) from None


def _identity(path: Path) -> tuple[tuple[int, int] | None, ...]:
    """Return the inodes at the paths of a journal and its write-ahead log."""
    return tuple(_inode(one) for one in (path, path.with_name(f"{path.name}-wal")))


def _inode(path: Path) -> tuple[int, int] | None:
    try:
        found = path.lstat()
    except FileNotFoundError:
        return None
    return found.st_dev, found.st_ino


def repaired_log(path: Path, lines: Sequence[str]) -> EventLog:
    """Return the event log of a mission, completed to hold exactly these lines.

    Raises:
        JournalError: It holds events that the journal lacks: the journal is older than the mission.
        OutputError: It cannot be written.
    """
    try:
        held = path.read_bytes() if path.exists() else b""
    except OSError as error:
        raise JournalError(f"the event log cannot be read: {error.strerror}", where=str(path)) from None
    size = 0
    for line in lines:
        whole = line.encode() + b"\n"
        if held[size : size + len(whole)] != whole:
            break
        size += len(whole)
    else:
        # A power cut leaves half a line, or zeros; a complete line was in the journal before.
        more = held[size:].partition(b"\n")
        if more[1] and more[0].startswith(b'{"event"'):
            raise JournalError(
                "the journal lacks events that the log contains: it is older than the mission, which would repeat them",
                where=str(path),
                advice="restore the journal with its -wal file, or run what is left as a new mission",
            )
    kept = held[:size].count(b"\n")
    log = EventLog(path, begun=size)
    for line in lines[kept:]:
        log.line(line)
    return log


def read_summary(path: Path) -> tuple[int, tuple[tuple[str, str], ...], Record | None, Record | None]:
    """Read a journal without taking it over: last command read, (time, line) of its events, last observation, last
    goal.

    Raises:
        JournalError: It cannot be read, or an event was changed.
    """
    with _as_journal_error(path), closing(_open(path, None)) as db:
        db.execute("BEGIN")
        about = dict(db.execute("SELECT key, value FROM about"))
        if about.get("format") == str(WITHOUT_CHECKSUMS):
            events = db.execute(f"SELECT {_COLUMNS['events']} FROM events ORDER BY n").fetchall()  # noqa: S608
        else:
            events = _checked(db, "events", path)[0]
        sight = db.execute("SELECT kind, body FROM tape WHERE kind = 'sight' ORDER BY n DESC LIMIT 1").fetchone()
        goal = db.execute("SELECT kind, body FROM tape WHERE kind = 'begun' ORDER BY n DESC LIMIT 1").fetchone()
        db.execute("COMMIT")
    return (
        int(about.get("heard", 0)),
        tuple(events),
        Record(kind=sight[0], body=sight[1]) if sight else None,
        Record(kind=goal[0], body=goal[1]) if goal else None,
    )


def mission_of(path: Path) -> str:
    """Return the SHA-256 of the mission's content with which a journal was created; empty if it has none.

    Raises:
        JournalError: It cannot be read.
    """
    with _as_journal_error(path), closing(_open(path, None)) as db:
        found = db.execute("SELECT value FROM about WHERE key = 'mission'").fetchone()
    return "" if found is None else str(found[0])


def lines_after(path: Path, after: int, most: int) -> tuple[tuple[int, str, str], ...]:
    """Return (number, time, line) of the events after number ``after``, in order, at most ``most``.

    Raises:
        JournalError: The journal cannot be read, or an event was changed.
    """
    with _as_journal_error(path), closing(_open(path, None)) as db:
        db.execute("BEGIN")
        about = dict(db.execute("SELECT key, value FROM about"))
        if about.get("format") == str(WITHOUT_CHECKSUMS):
            return tuple(db.execute("SELECT n, at, line FROM events WHERE n > ? ORDER BY n LIMIT ?", (after, most)))
        events = _checked(db, "events", path, after=after, most=most)[0]
    return tuple((n, at, line) for n, (at, line) in enumerate(events, start=after + 1))


def _connect(path: Path) -> sqlite3.Connection:
    db = sqlite3.connect(path, isolation_level=None, timeout=5.0)
    try:
        db.execute("PRAGMA journal_mode=WAL")
        db.execute(f"PRAGMA synchronous={SYNCHRONOUS}")
        # On macOS, fsync leaves data in the drive's cache.
        db.execute("PRAGMA fullfsync=ON")
        db.execute("PRAGMA checkpoint_fullfsync=ON")
    except BaseException:
        db.close()
        raise
    return db


def _open(path: Path, mission: str | None) -> sqlite3.Connection:
    _require_plain(path)
    db = _connect(path)
    try:
        _require_about(dict(db.execute("SELECT key, value FROM about")), mission, path)
    except BaseException:
        db.close()
        raise
    return db


def _require_plain(path: Path) -> None:
    """Reject anything but a regular file of the user: under two names, SQLite would keep two logs of one journal."""
    try:
        found = path.lstat()
    except FileNotFoundError:
        raise JournalError("the mission has no journal", where=str(path), advice=_ANEW) from None
    if not stat.S_ISREG(found.st_mode) or found.st_nlink != 1:
        raise JournalError(
            "the journal is a link, or has a second name", where=str(path), advice="restore the file itself"
        )
    try:
        require_own_file(path, found)
    except Unguarded as fault:
        raise JournalError(f"the journal {fault.what}", where=str(path), advice=fault.advice) from None


def _require_about(about: Mapping[str, str], mission: str | None, path: Path) -> None:
    if about.get("format") not in (str(FORMAT), str(WITHOUT_CHECKSUMS)):
        raise JournalError(
            f"the journal has format {about.get('format')}, this version reads {WITHOUT_CHECKSUMS} and {FORMAT}",
            where=str(path),
            advice="resume with the version of Fieldhand that started it",
        )
    if mission is not None and about.get("mission") != mission:
        raise JournalError(
            "this is the journal of another mission: its Task, site, robot, world or approval are different",
            where=str(path),
            advice="restore the folder as the mission left it",
        )


@contextmanager
def _as_journal_error(path: Path) -> Iterator[None]:
    """Convert errors of SQLite and the system to JournalError."""
    try:
        yield
    except sqlite3.IntegrityError as error:
        raise JournalError(
            f"the journal contains rows that another process has written ({error})", where=str(path), advice=_ANEW
        ) from None
    except (sqlite3.DatabaseError, ValueError) as error:
        for sign, advice in _CANNOT.items():
            if sign in str(error):
                raise JournalError(f"the journal cannot be written: {error}", where=str(path), advice=advice) from None
        raise JournalError(f"the journal is damaged: {error}", where=str(path), advice=_ANEW) from None
    except OSError as error:
        raise JournalError(
            f"the journal cannot be written: {error.strerror or error}", where=str(path), advice=_RESUME
        ) from None
