"""Names of newer Python releases than the oldest supported one (3.10), for every module that uses them.

With Python 3.11 and newer these are the standard library's own names. The package, its tests and its benchmarks import
them from here; `make check` finds any other use of what Python 3.10 lacks.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from datetime import date, datetime

#: Primary result codes of SQLite.
SQLITE_BUSY, SQLITE_LOCKED, SQLITE_READONLY, SQLITE_IOERR, SQLITE_FULL, SQLITE_CANTOPEN = 5, 6, 8, 10, 13, 14

_SQLITE_MESSAGES = {
    "database is locked": SQLITE_BUSY,
    "database table is locked": SQLITE_LOCKED,
    "attempt to write a readonly database": SQLITE_READONLY,
    "disk I/O error": SQLITE_IOERR,
    "database or disk is full": SQLITE_FULL,
    "unable to open database file": SQLITE_CANTOPEN,
}

date_from_iso: Callable[[str], date]

if sys.version_info >= (3, 11):
    from datetime import UTC  # novm
    from enum import StrEnum  # novm
    from importlib.resources.abc import Traversable  # novm
    from typing import Self, assert_never  # novm

    import tomllib

    date_from_iso = date.fromisoformat
    datetime_from_iso = datetime.fromisoformat
else:
    from datetime import timezone
    from enum import Enum
    from importlib.abc import Traversable

    import tomli as tomllib
    from backports.datetime_fromisoformat import date_fromisoformat, datetime_fromisoformat
    from typing_extensions import Self, assert_never

    UTC = timezone.utc
    date_from_iso = date_fromisoformat

    def datetime_from_iso(text: str) -> datetime:
        """Return the time of a text in ISO 8601; its zone is a :class:`datetime.timezone`, as in Python 3.11."""
        found: datetime = datetime_fromisoformat(text)
        offset = found.utcoffset()
        return found if offset is None else found.replace(tzinfo=timezone(offset) if offset else UTC)

    class StrEnum(str, Enum):
        """An enumeration whose members are strings, printed as their values."""

        def __str__(self) -> str:
            return str(self.value)

        def __format__(self, spec: str) -> str:
            return format(str(self.value), spec)


def sqlite_code(error: Exception) -> int:
    """Return the primary result code of an SQLite error; 0 for any other error."""
    code = getattr(error, "sqlite_errorcode", None)  # from Python 3.11 on
    if code is not None:
        return int(code) & 0xFF
    import sqlite3

    return _SQLITE_MESSAGES.get(str(error).partition(":")[0], 0) if isinstance(error, sqlite3.Error) else 0


__all__ = [
    "SQLITE_BUSY",
    "SQLITE_CANTOPEN",
    "SQLITE_FULL",
    "SQLITE_IOERR",
    "SQLITE_LOCKED",
    "SQLITE_READONLY",
    "UTC",
    "Self",
    "StrEnum",
    "Traversable",
    "assert_never",
    "date_from_iso",
    "datetime_from_iso",
    "sqlite_code",
    "tomllib",
]
