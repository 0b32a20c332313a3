"""Import of events from MCAP files, with size limits on file, records and unpacked data, as files are untrusted."""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from fieldhand.errors import InputError, TaskError
from fieldhand.exchange.mcap.schemas import EVENTS
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import Event

if TYPE_CHECKING:
    from mcap.records import Chunk

MAGIC = b"\x89MCAP0\r\n"
#: Maximum sizes in bytes: file, single record or chunk, all unpacked chunks.
MAX_BYTES, MAX_RECORD, MAX_UNPACKED = 500_000_000, 64_000_000, 1_000_000_000


def is_mcap(path: Path) -> bool:
    """Return True if a file starts with the MCAP signature; False if it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except (OSError, ValueError):
        return False


def read_mcap(path: Path) -> tuple[Event, ...]:
    """Return the events of a file in order of occurrence, skipping other topics and unknown events.

    A truncated file gives the events before the truncation.

    Raises:
        InputError: The file is unreadable, not MCAP, damaged, or too large.
        TaskError: A message is not a valid event; the message number is given.
    """
    try:
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise _unusable(path, f"has {size:,} bytes, more than {MAX_BYTES:,}")
        with path.open("rb") as file:
            found = sorted(_events(_Whole(file, size), path), key=lambda pair: pair[0])
    except OSError as error:
        raise _unusable(path, f"cannot be read: {error.strerror}") from None
    return tuple(event for _, event in found)


def _events(file: _Whole, path: Path) -> Iterator[tuple[int, Event]]:
    """Yield each event with its number."""
    from mcap.records import Channel, Message

    topics: dict[int, str] = {}
    for record in _records(file, path):
        if isinstance(record, Channel):
            topics[record.id] = record.topic
        elif isinstance(record, Message) and topics.get(record.channel_id, "").startswith(EVENTS):
            where = f"{path}, message {record.sequence} of {topics[record.channel_id]}"
            try:
                text = record.data.decode()
            except UnicodeDecodeError:
                raise TaskError("not an event: it is not UTF-8 text", where=where) from None
            event = from_json(text, where=where)
            if event is not None:
                yield record.sequence, event


def _records(file: _Whole, path: Path) -> Iterator[Any]:
    """Yield the records of a file, including those in chunks."""
    from mcap.exceptions import EndOfFile, McapError
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader, breakup_chunk
    from zstandard import ZstdError

    left = MAX_UNPACKED
    stream: Any = file  # it is only read from
    reader = StreamReader(stream, emit_chunks=True, record_size_limit=MAX_RECORD)
    try:
        for record in reader.records:
            if not isinstance(record, Chunk):
                yield record
                continue
            left -= record.uncompressed_size
            if record.uncompressed_size > MAX_RECORD or left < 0:
                raise _unusable(path, f"unpacks to more than {MAX_UNPACKED:,} bytes, or {MAX_RECORD:,} at once")
            yield from breakup_chunk(_unpacked(record), validate_crc=True)
    except EndOfFile:
        return
    except (McapError, ZstdError, ValueError, struct.error, RuntimeError) as error:
        raise _unusable(path, f"is damaged, or not an MCAP file ({error or type(error).__name__})") from None


class _Whole(io.BufferedIOBase):
    """A file that limits reads to its size, whatever a length field claims.

    Args:
        file: File positioned at its beginning.
        size: Size of the file in bytes.
    """

    def __init__(self, file: IO[bytes], size: int) -> None:
        self._file, self._left = file, size

    def read(self, size: int | None = -1) -> bytes:
        """Return up to the given number of bytes."""
        data = self._file.read(self._left if size is None or size < 0 else min(size, self._left))
        self._left -= len(data)
        return data


def _unpacked(chunk: Chunk) -> Chunk:
    """Return the chunk without compression, unpacking no more than its declared size.

    Raises:
        ValueError: The content is larger or smaller than declared.
    """
    import lz4.frame
    import zstandard

    if chunk.compression == "zstd":
        with zstandard.ZstdDecompressor(max_window_size=MAX_RECORD).stream_reader(io.BytesIO(chunk.data)) as stream:
            data = stream.read(chunk.uncompressed_size + 1)
    elif chunk.compression == "lz4":
        data = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=chunk.uncompressed_size + 1)
    else:
        return chunk
    if len(data) != chunk.uncompressed_size:
        raise ValueError("a chunk unpacks to a different size from the one it states")
    return replace(chunk, data=data, compression="")


def _unusable(path: Path, what: str) -> InputError:
    return InputError(what, where=str(path), advice="give a log that --mcap or fieldhand export wrote")
