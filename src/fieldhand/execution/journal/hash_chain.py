"""Checksums of journal rows: each row's SHA-256 covers the previous row, which reveals changed or missing rows.

They detect accidents (a failing disk, a file restored from a backup, two programs on one journal). Anyone who can write
the journal can recompute them: they are not a signature.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass

from fieldhand.errors import JournalError

_ANEW = "run the Task as a new mission"


@dataclass(frozen=True, kw_only=True)
class ChainHead:
    """End of a table: number of rows, and checksum of the last one."""

    rows: int
    sha256: bytes


def start(table: str) -> ChainHead:
    """Return the head of an empty table."""
    return ChainHead(rows=0, sha256=_sha256(b"", table))


def extended(head: ChainHead, *columns: str) -> ChainHead:
    """Return the head after one more row with these columns."""
    return ChainHead(rows=head.rows + 1, sha256=_sha256(head.sha256, *columns))


def require_chain(
    head: ChainHead, table: str, rows: Iterable[tuple[int, bytes, tuple[str, ...]]], where: str
) -> list[ChainHead]:
    """Verify every row of a table against its checksum.

    Args:
        head: Head before the first of these rows.
        table: Name of the table, for messages.
        rows: Number, checksum and columns of each row, in order.
        where: Path of the journal, for messages.

    Returns:
        The heads after each row, preceded by the given one.

    Raises:
        JournalError: A row is missing or was changed; the error names it.
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
