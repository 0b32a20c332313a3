"""A body that is a bundle, taken into a file: bounded before it begins, and given up when it stands still."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import anyio
from starlette.requests import ClientDisconnect, Request

from fieldhand.api.problems import Turned
from fieldhand.approval.bundle.container import MAX_BYTES
from fieldhand.delivery.incoming_file import IncomingFile


@dataclass(frozen=True, kw_only=True)
class UploadLimits:
    """What one upload may take.

    Attributes:
        most: Bytes.
        at_once: UploadLimits at the same time.
        idle_s: Seconds without a byte until it is given up.
        start_s, bytes_s: It has so many seconds, and one more for each so many bytes.
    """

    most: int = MAX_BYTES
    at_once: int = 2
    idle_s: float = 20.0
    start_s: float = 60.0
    bytes_s: float = 20_000.0


class UploadSlots:
    """Lets so many uploads in at once.

    Args:
        most: How many.
    """

    def __init__(self, most: int) -> None:
        self._most, self._inside = most, 0

    @contextmanager
    def entered(self) -> Iterator[None]:
        """While an upload is inside.

        Raises:
            Turned: So many are inside already (status 503).
        """
        if self._inside >= self._most:
            raise Turned(503, "other missions are arriving", "try again in a moment")
        self._inside += 1
        try:
            yield
        finally:
            self._inside -= 1


def size_of(request: Request, uploads: UploadLimits) -> int:
    """What the request says of its size, before anything of it is read.

    Raises:
        Turned: It says nothing, or too much.
    """
    told = request.headers.get("content-length")
    if told is None or "transfer-encoding" in request.headers:
        raise Turned(411, "the upload does not say how large it is", "send it with a Content-Length")
    if not told.isascii() or not told.isdigit() or len(told) > 15 or int(told) > uploads.most:
        raise Turned(413, "the upload is too large", f"a mission has {uploads.most / 1e6:,.0f} MB at most")
    return int(told)


async def receive(request: Request, incoming: IncomingFile, size: int, uploads: UploadLimits) -> None:
    """Write the body to the file, whole.

    Raises:
        Turned: It was cut off, is longer than it said, or came too slowly.
        StoreError: The disk is full.
    """
    stream = request.stream()
    try:
        with anyio.fail_after(uploads.start_s + size / uploads.bytes_s):
            while chunk := await _next(stream, uploads.idle_s):
                if incoming.size + len(chunk) > size:
                    raise Turned(400, "the upload is longer than it said", "send it again")
                await anyio.to_thread.run_sync(incoming.write, chunk)
    except TimeoutError:
        raise Turned(
            408, f"the upload came too slowly ({incoming.size:,} of {size:,} bytes)", "send it again"
        ) from None
    except ClientDisconnect:
        raise _cut_off(incoming, size) from None
    if incoming.size != size:
        raise _cut_off(incoming, size)


async def _next(stream: AsyncIterator[bytes], idle_s: float) -> bytes:
    """The next bytes; none at the end."""
    with anyio.fail_after(idle_s):
        async for chunk in stream:
            if chunk:
                return chunk
    return b""


def _cut_off(incoming: IncomingFile, size: int) -> Turned:
    return Turned(400, f"the upload was cut off ({incoming.size:,} of {size:,} bytes)", "send it again")
