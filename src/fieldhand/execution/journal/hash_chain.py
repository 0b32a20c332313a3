"""Checksums of journal rows: each row's SHA-256 covers the row before it, which reveals rows changed or dropped.

They detect accidents (a failing disk, a file put back from a backup, two programs on one journal). Whoever can write
the journal can compute them anew: they are not a signature.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass

from fieldhand.errors import JournalError

_ANEW = "carry the Task out as a new mission"


@dataclass(frozen=True, kw_only=True)
class Head:
    """The end of a table: how many rows it has, and the checksum of the last one."""

    rows: int
    sha256: bytes


def start(table: str) -> Head:
    """Return the head of an empty table of that name."""
    return Head(rows=0, sha256=_sha256(b"", table))


def extended(head: Head, *columns: str) -> Head:
    """Return the head behind one more row with these columns."""
    return Head(rows=head.rows + 1, sha256=_sha256(head.sha256, *columns))


def require_chain(head: Head, table: str, rows: Iterable[tuple[int, bytes, tuple[str, ...]]], where: str) -> list[Head]:
    """Check every row of a table against its checksum.

    Args:
        head: Behind the row before the first of these.
        table: Its name in messages.
        rows: Number, checksum and columns of each, in the order of numbers.
        where: The journal.

    Returns:
        The heads behind each row, the given one first.

    Raises:
        JournalError: A row is missing, or is not the one that was written; says which.
    """
    heads = [head]
    for number, sha256, columns in rows:
        if number != head.rows + 1:
            raise JournalError(f"row {head.rows + 1} of its {table} is missing", where=where, advice=_ANEW)
        head = extended(head, *columns)
        if head.sha256 != sha256:
            raise JournalError(
                f"row {number} of its {table} is not the one that was written", where=where, advice=_ANEW
            )
        heads.append(head)
    return heads


def _sha256(before: bytes, *columns: str) -> bytes:
    found = hashlib.sha256(before)
    for column in columns:
        data = column.encode()
        found.update(len(data).to_bytes(8, "big"))
        found.update(data)
    return found.digest()
