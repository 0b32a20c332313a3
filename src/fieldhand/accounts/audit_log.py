"""The audit log: who did what, about what, when and from where. Entries are added, never changed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import insert, select

from fieldhand.database.connection import Database
from fieldhand.database.tables import AUDIT
from fieldhand.hidden_characters import visible

#: Largest number of characters of each column of text.
_WHO, _WHAT, _ABOUT, _ADDRESS = 100, 50, 2_000, 100
#: Largest number of entries that are read at once.
MOST = 500


@dataclass(frozen=True, kw_only=True)
class AuditEntry:
    """An entry of the audit log.

    Attributes:
        id: Number; a later entry has a larger one.
        at: Time.
        who: Name of the account, ``local`` for the local administrator, or the name that failed to log in.
        what: What was done, in one word or two: ``login``, ``plan``, ``approve``.
        about: What it was done to: a mission, an account, a request.
        address: Address of the client; empty for the command line.
        details: More, by name.
    """

    id: int
    at: datetime
    who: str
    what: str
    about: str
    address: str
    details: Mapping[str, Any]


class AuditLog:
    """The audit log in a database.

    Args:
        database: The server's database.
        now: Returns the time.
    """

    def __init__(self, database: Database, now: Callable[[], datetime]) -> None:
        self._database, self._now = database, now

    def add(self, who: str, what: str, about: str = "", *, address: str = "", **details: Any) -> None:
        """Add an entry; long texts are cut, and hidden characters made visible."""
        with self._database.transaction() as connection:
            connection.execute(
                insert(AUDIT).values(
                    at=self._now(),
                    who=_cut(who, _WHO),
                    what=what[:_WHAT],
                    about=_cut(about, _ABOUT),
                    address=address[:_ADDRESS],
                    details={k: _cut(v, _ABOUT) if isinstance(v, str) else v for k, v in details.items()},
                )
            )

    def entries(
        self, *, before: int | None = None, who: str | None = None, what: str | None = None, most: int = 100
    ) -> tuple[AuditEntry, ...]:
        """Return the latest entries, the last first.

        Args:
            before: Only entries with a smaller number.
            who: Only entries of this name.
            what: Only entries of this kind.
            most: Largest number of entries, at most :data:`MOST`.
        """
        query = select(AUDIT).order_by(AUDIT.c.id.desc()).limit(min(most, MOST))
        if before is not None:
            query = query.where(AUDIT.c.id < before)
        if who is not None:
            query = query.where(AUDIT.c.who == _cut(who, _WHO))
        if what is not None:
            query = query.where(AUDIT.c.what == visible(what)[:_WHAT])
        with self._database.transaction(reading=True) as connection:
            return tuple(AuditEntry(**row) for row in connection.execute(query).mappings())


def _cut(text: str, longest: int) -> str:
    shown = visible(text)
    return shown if len(shown) <= longest else f"{shown[: longest - 3]}..."
