"""The journal of a mission: one SQLite file that survives a power cut at any instant.

Write-ahead log, ``synchronous=FULL``: what was committed is on the disk, what was not never happened. Answers and
events are committed together, so that they never contradict one another.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType

from fieldhand.errors import JournalError
from fieldhand.execution.journal.records import Record, diverged
from fieldhand.execution.log import EventLog

#: Of the file; a program that writes another one refuses this.
FORMAT = 1

#: SQLite waits for the disk at every commit. Less is for tests, which do not pull the plug of the machine.
SYNCHRONOUS = "FULL"

_TABLES = (
    "CREATE TABLE about (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE tape (n INTEGER PRIMARY KEY, kind TEXT NOT NULL, body TEXT NOT NULL)",
    "CREATE TABLE events (n INTEGER PRIMARY KEY, at TEXT NOT NULL, line TEXT NOT NULL)",
)
#: What SQLite says where the file is sound and cannot be written all the same, and what to do.
_CANNOT = {
    "full": "free some space, then fieldhand resume",
    "disk I/O": "see whether the disk is sound, then fieldhand resume",
    "readonly": "let the user who carries out the mission write there",
    "unable to open": "let the user who carries out the mission write there",
    "locked": "end the other program that has it open",
}
_ANEW = "carry the Task out as a new mission"


def create(path: Path, mission: str) -> None:
    """Make the empty journal of a mission.

    Args:
        path: A file that is not there yet.
        mission: SHA-256 of what the mission is.

    Raises:
        JournalError: It cannot be written.
    """
    with _said(path), closing(sqlite3.connect(path, isolation_level=None)) as db:
        db.execute("PRAGMA journal_mode=WAL")
        db.execute(f"PRAGMA synchronous={SYNCHRONOUS}")
        db.execute("BEGIN IMMEDIATE")
        for table in _TABLES:
            db.execute(table)
        db.executemany("INSERT INTO about VALUES (?, ?)", [("format", str(FORMAT)), ("mission", mission)])
        db.execute("COMMIT")


class Journal:
    """A :class:`~fieldhand.execution.journal.records.Tape` on the disk.

    Args:
        path: Of the journal.
        mission: SHA-256 of what the mission is.
        log: Of the mission; it is completed from the journal, and written on.
        tell: Takes the line of each new event once it is safe.

    Attributes:
        before: The lines of the events that it held when it was opened.

    Raises:
        JournalError: It is damaged, of another mission, or the log holds more than it does.
    """

    def __init__(self, path: Path, mission: str, log: Path, tell: Callable[[str], None]) -> None:
        self._path, self._tell = path, tell
        with _said(path):
            self._db = _open(path, mission)
            found = self._db.execute("PRAGMA quick_check(1)").fetchone()
            if found != ("ok",):
                raise JournalError(f"the journal is damaged: {found[0]}", where=str(path), advice=_ANEW)
            self._tape = [Record(kind=k, body=b) for k, b in self._db.execute("SELECT kind, body FROM tape ORDER BY n")]
            self.before = tuple(line for (line,) in self._db.execute("SELECT line FROM events ORDER BY n"))
        self._read = self._said = 0
        self._next = len(self._tape) + 1
        self._records: list[tuple[int, str, str]] = []
        self._events: list[tuple[int, str, str]] = []
        self._order = 0
        self._log = mended(log, self.before)

    def next(self) -> Record | None:
        if self._read >= len(self._tape):
            return None
        self._read += 1
        return self._tape[self._read - 1]

    def append(self, record: Record) -> None:
        self._records.append((self._next, record.kind, record.body))
        self._next += 1

    def event(self, line: str) -> None:
        self._said += 1
        if self._said > len(self.before):
            self._events.append((self._said, datetime.now(UTC).isoformat(timespec="milliseconds"), line))
        elif line != self.before[self._said - 1]:
            raise diverged(f"event {self._said} was {self.before[self._said - 1]}, now it would be {line}")

    @property
    def unsaid(self) -> bool:
        return bool(self._events)

    def commit(self, *, order: int = 0) -> None:
        with _said(self._path):
            self._db.execute("BEGIN IMMEDIATE")
            try:
                # A commit that Ctrl-C cut off may be done all the same: then these rows are there.
                self._db.executemany("INSERT OR IGNORE INTO tape VALUES (?, ?, ?)", self._records)
                self._db.executemany("INSERT OR IGNORE INTO events VALUES (?, ?, ?)", self._events)
                if order != self._order:
                    self._db.execute("INSERT OR REPLACE INTO about VALUES ('heard', ?)", [str(order)])
                self._db.execute("COMMIT")
            except BaseException:
                with suppress(sqlite3.Error):
                    self._db.execute("ROLLBACK")
                raise
        self._order = order
        events, self._records, self._events = self._events, [], []
        for _, _, line in events:
            self._log.line(line)
            self._tell(line)

    def close(self) -> None:
        """Let go of the files."""
        self._db.close()
        self._log.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def mended(path: Path, lines: Sequence[str]) -> EventLog:
    """The log of a mission, holding these lines and nothing else: what was cut off is completed.

    Raises:
        JournalError: It holds events that the journal does not: this is an older journal, and what it lacks was done.
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
        # A power cut leaves half a line, or zeros; a whole one was in the journal before it was in the log.
        more = held[size:].partition(b"\n")
        if more[1] and more[0].startswith(b'{"event"'):
            raise JournalError(
                "the journal lacks events that the log holds: it is older than the mission, and would do them again",
                where=str(path),
                advice="bring the journal back with its -wal file, or carry out what is left as a new mission",
            )
    kept = held[:size].count(b"\n")
    log = EventLog(path, begun=size)
    for line in lines[kept:]:
        log.line(line)
    return log


def heard(path: Path) -> tuple[int, tuple[tuple[str, str], ...], Record | None, Record | None]:
    """What a journal says to one who only looks: last order heard, (time, line) of its events, last sight, last record.

    Raises:
        JournalError: It cannot be read.
    """
    with _said(path), closing(_open(path, None)) as db:
        order = db.execute("SELECT value FROM about WHERE key = 'heard'").fetchone()
        events = tuple(db.execute("SELECT at, line FROM events ORDER BY n"))
        sight = db.execute("SELECT kind, body FROM tape WHERE kind = 'sight' ORDER BY n DESC LIMIT 1").fetchone()
        goal = db.execute("SELECT kind, body FROM tape WHERE kind = 'begun' ORDER BY n DESC LIMIT 1").fetchone()
    return (
        int(order[0]) if order else 0,
        events,
        Record(kind=sight[0], body=sight[1]) if sight else None,
        Record(kind=goal[0], body=goal[1]) if goal else None,
    )


def lines_after(path: Path, after: int, most: int) -> tuple[tuple[int, str, str], ...]:
    """(number, time, line) of the events behind number ``after``, in order, so many at most.

    Raises:
        JournalError: It cannot be read.
    """
    with _said(path), closing(_open(path, None)) as db:
        return tuple(db.execute("SELECT n, at, line FROM events WHERE n > ? ORDER BY n LIMIT ?", (after, most)))


def _open(path: Path, mission: str | None) -> sqlite3.Connection:
    if not path.is_file():
        raise JournalError("the mission has no journal", where=str(path), advice=_ANEW)
    db = sqlite3.connect(path, isolation_level=None, timeout=5.0)
    db.execute("PRAGMA journal_mode=WAL")
    db.execute(f"PRAGMA synchronous={SYNCHRONOUS}")
    about = dict(db.execute("SELECT key, value FROM about"))
    if about.get("format") != str(FORMAT):
        raise JournalError(
            f"the journal has format {about.get('format')}, this version reads {FORMAT}",
            where=str(path),
            advice="resume with the version of Fieldhand that began it",
        )
    if mission is not None and about.get("mission") != mission:
        raise JournalError(
            "this is the journal of another mission: Task, site, robot, world or approval are not those it began with",
            where=str(path),
            advice="bring back the folder as the mission left it",
        )
    return db


@contextmanager
def _said(path: Path) -> Iterator[None]:
    """What SQLite complains of, in words."""
    try:
        yield
    except sqlite3.DatabaseError as error:
        for sign, advice in _CANNOT.items():
            if sign in str(error):
                raise JournalError(f"the journal cannot be written: {error}", where=str(path), advice=advice) from None
        raise JournalError(f"the journal is damaged: {error}", where=str(path), advice=_ANEW) from None
