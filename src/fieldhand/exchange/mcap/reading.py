"""Read the events of an MCAP file. It may come from anyone: file, records and what they unpack to are bounded."""

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
#: Bytes of a file, of one record or chunk, and of all chunks unpacked.
MAX_BYTES, MAX_RECORD, MAX_UNPACKED = 500_000_000, 64_000_000, 1_000_000_000


def is_mcap(path: Path) -> bool:
    """Whether a file begins as an MCAP file does; what cannot be read does not."""
    try:
        with path.open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except (OSError, ValueError):
        return False


def read_mcap(path: Path) -> tuple[Event, ...]:
    """The events of a file in the order in which they happened; other topics, and kinds not known, are left out.

    A file that was cut off gives what it holds up to there.

    Raises:
        InputError: It cannot be read, is no MCAP file, is damaged, or is too large.
        TaskError: A message of ours is no event; says which.
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
    """Each event with its number."""
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
    """The records of a file, those in chunks among them."""
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
        raise _unusable(path, f"is damaged, or no MCAP file ({error or type(error).__name__})") from None


class _Whole(io.BufferedIOBase):
    """A file of which no more is asked for than it has: a field that says a length may say any.

    Args:
        file: At its beginning.
        size: Of it, in bytes.
    """

    def __init__(self, file: IO[bytes], size: int) -> None:
        self._file, self._left = file, size

    def read(self, size: int | None = -1) -> bytes:
        """Up to so many bytes."""
        data = self._file.read(self._left if size is None or size < 0 else min(size, self._left))
        self._left -= len(data)
        return data


def _unpacked(chunk: Chunk) -> Chunk:
    """The chunk without compression. No more is unpacked than it says, whatever its contents claim.

    Raises:
        ValueError: It holds more, or less.
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
        raise ValueError("a chunk unpacks to another size than it says")
    return replace(chunk, data=data, compression="")


def _unusable(path: Path, what: str) -> InputError:
    return InputError(what, where=str(path), advice="give a log that --mcap or fieldhand export wrote")
