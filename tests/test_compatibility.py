"""What Python 3.10 lacks behaves the same on every supported release."""

import os
import sqlite3
from contextlib import closing
from datetime import date, datetime, timedelta, timezone
from pathlib import Path

import pytest

from fieldhand.compatibility import (
    SQLITE_BUSY,
    SQLITE_CANTOPEN,
    SQLITE_FULL,
    SQLITE_READONLY,
    UTC,
    StrEnum,
    date_from_iso,
    datetime_from_iso,
    sqlite_code,
    tomllib,
)

TWO_HOURS = timezone(timedelta(hours=2))


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("2026-11-27T10:00:00+00:00", datetime(2026, 11, 27, 10, tzinfo=UTC)),
        ("2026-11-27T10:00:00Z", datetime(2026, 11, 27, 10, tzinfo=UTC)),
        ("2026-11-27T10:00Z", datetime(2026, 11, 27, 10, tzinfo=UTC)),
        ("20261127T100000+0200", datetime(2026, 11, 27, 10, tzinfo=TWO_HOURS)),
        ("2026-11-27 10:00:00.5", datetime(2026, 11, 27, 10, 0, 0, 500_000)),
        ("2026-11-27T10", datetime(2026, 11, 27, 10)),
        ("2026-11-27", datetime(2026, 11, 27)),
        ("2026-11-27T10:00:00.123456789+02:00", datetime(2026, 11, 27, 10, 0, 0, 123_456, tzinfo=TWO_HOURS)),
    ],
)
def test_times_that_are_read(text: str, read: datetime) -> None:
    assert datetime_from_iso(text) == read
    assert datetime_from_iso(text).tzinfo == read.tzinfo


@pytest.mark.parametrize("text", ["", "soon", "2026-11-31", "2026-11-27T25:00", "2026-11-27T10:00:00+", "27.11.2026"])
def test_times_that_are_not(text: str) -> None:
    with pytest.raises(ValueError, match=r"^Invalid isoformat|out of range|must be in"):
        datetime_from_iso(text)


@pytest.mark.parametrize("text", ["2026-11-27", "20261127", "2026-W48-5"])
def test_days_that_are_read(text: str) -> None:
    assert date_from_iso(text) == date(2026, 11, 27)


@pytest.mark.parametrize("text", ["", "2026-11", "2026-11-31", "2026-11-27T10:00", "5"])
def test_days_that_are_not(text: str) -> None:
    with pytest.raises(ValueError, match=r"^Invalid isoformat|out of range|must be in"):
        date_from_iso(text)


class Colour(StrEnum):
    RED = "red"


def test_members_of_an_enumeration_are_printed_as_their_values() -> None:
    assert [str(Colour.RED), f"{Colour.RED:>5}", f"{Colour.RED}", "%s" % Colour.RED] == ["red", "  red", "red", "red"]  # noqa: UP031
    assert Colour.RED == "red"
    assert Colour("red") is Colour.RED


def test_toml_is_read() -> None:
    assert tomllib.loads('a = [1, 2.5, "x"]') == {"a": [1, 2.5, "x"]}
    with pytest.raises(tomllib.TOMLDecodeError):
        tomllib.loads("a = ")


def failure(database: sqlite3.Connection, order: str) -> Exception:
    with pytest.raises(sqlite3.Error) as raised:
        database.execute(order)
    return raised.value


def test_failures_of_a_database_are_told_apart(tmp_path: Path) -> None:
    path = tmp_path / "a.sqlite"
    with closing(sqlite3.connect(path, isolation_level=None)) as one:
        one.execute("CREATE TABLE t (x)")
        with closing(sqlite3.connect(path, isolation_level=None, timeout=0)) as two:
            one.execute("BEGIN EXCLUSIVE")
            assert sqlite_code(failure(two, "INSERT INTO t VALUES (1)")) == SQLITE_BUSY
            one.execute("ROLLBACK")
        one.execute("PRAGMA max_page_count = 2")
        assert sqlite_code(failure(one, "INSERT INTO t VALUES (zeroblob(90000))")) == SQLITE_FULL
        assert sqlite_code(failure(one, "SELECT nothing")) not in (SQLITE_BUSY, SQLITE_FULL, SQLITE_READONLY)
    with closing(sqlite3.connect(f"{path.as_uri()}?mode=ro", uri=True)) as readonly:
        assert sqlite_code(failure(readonly, "INSERT INTO t VALUES (1)")) == SQLITE_READONLY
    with pytest.raises(sqlite3.Error) as raised:
        sqlite3.connect(tmp_path / "missing" / "a.sqlite")
    assert sqlite_code(raised.value) == SQLITE_CANTOPEN
    assert sqlite_code(OSError(os.strerror(5))) == 0
