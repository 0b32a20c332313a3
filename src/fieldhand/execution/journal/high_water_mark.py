"""High-water mark of a journal, in a file of its own, which reveals a journal that has lost rows.

SQLite keeps the latest rows in a second file (``-wal``). If that is deleted, or the journal is restored from a copy,
what is left is a valid journal of an earlier time, and the mission would repeat what it has done since. The mark holds
the number of rows and their checksums. It is written after each commit, so it is never ahead of the journal; it is
synced when the journal is opened and closed, so otherwise it survives the end of the program, but not a power cut.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from fieldhand.errors import JournalError
from fieldhand.execution.journal.hash_chain import ChainHead
from fieldhand.files import store_names, write_stored

#: Two copies, written in turn, each in its own sector: an interrupted write leaves the other intact.
_SLOT = 512
_EMPTY = b" " * (2 * _SLOT)


@dataclass(frozen=True, kw_only=True)
class HighWaterMark:
    """Last state that a journal had reached.

    Attributes:
        epoch: Number of the opening that wrote it.
        heads: Last row of each table, by the table's name.
    """

    epoch: int
    heads: Mapping[str, ChainHead]


class HighWaterMarkFile:
    """File of a mark, open for writing.

    Args:
        path: File created by :func:`create_mark`.

    Raises:
        OSError: It cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        self._descriptor = os.open(path, os.O_RDWR | getattr(os, "O_BINARY", 0))
        self._turn = _latest(os.read(self._descriptor, 2 * _SLOT))[0]

    def write(self, mark: HighWaterMark, *, stored: bool = False) -> None:
        """Overwrite the older of the two copies.

        Args:
            mark: Mark to write.
            stored: True to sync it.

        Raises:
            OSError: It cannot be written.
        """
        self._turn += 1
        data = _encoded(self._turn, mark)
        os.lseek(self._descriptor, _SLOT * (self._turn % 2), os.SEEK_SET)
        if os.write(self._descriptor, data) != len(data):
            raise OSError(None, "the mark was not written whole")
        if stored:
            os.fsync(self._descriptor)

    def close(self) -> None:
        """Sync the mark and close the file.

        Raises:
            OSError: The disk fails.
        """
        try:
            os.fsync(self._descriptor)
        finally:
            os.close(self._descriptor)


def mark_path(journal: Path) -> Path:
    """Return the path of a journal's mark."""
    return journal.with_suffix(".mark")


def create_mark(path: Path, mark: HighWaterMark) -> None:
    """Create the file of a mark.

    Raises:
        OSError: It cannot be written.
    """
    data = bytearray(_EMPTY)
    first = _encoded(0, mark)
    data[: len(first)] = first
    write_stored(path, bytes(data))
    store_names(path.parent)


def read_mark(path: Path) -> HighWaterMark:
    """Return the mark of a journal.

    Raises:
        JournalError: It is missing or damaged.
    """
    advice = "restore it with the rest of the folder, or run the Task as a new mission"
    try:
        found = _latest(path.read_bytes())[1]
    except OSError as error:
        raise JournalError(
            f"the high-water mark of the journal cannot be read: {error.strerror}", where=str(path), advice=advice
        ) from None
    if found is None:
        raise JournalError("the high-water mark of the journal is damaged", where=str(path), advice=advice)
    return found


def _encoded(turn: int, mark: HighWaterMark) -> bytes:
    heads = {table: [head.rows, head.sha256.hex()] for table, head in mark.heads.items()}
    body = json.dumps({"turn": turn, "epoch": mark.epoch, "heads": heads}).encode()
    return (hashlib.sha256(body).hexdigest().encode() + b" " + body).ljust(_SLOT)


def _latest(data: bytes) -> tuple[int, HighWaterMark | None]:
    """Return turn and mark of the later intact copy, or (0, None)."""
    found: tuple[int, HighWaterMark | None] = (0, None)
    for slot in (data[:_SLOT], data[_SLOT : 2 * _SLOT]):
        sha256, _, body = slot.strip().partition(b" ")
        if hashlib.sha256(body).hexdigest().encode() != sha256:
            continue
        document = json.loads(body)
        heads = {
            table: ChainHead(rows=rows, sha256=bytes.fromhex(sum_)) for table, (rows, sum_) in document["heads"].items()
        }
        if found[1] is None or document["turn"] > found[0]:
            found = document["turn"], HighWaterMark(epoch=document["epoch"], heads=heads)
    return found
