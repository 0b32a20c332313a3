"""Uploads of signed missions: limits on their size, time and number."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import anyio
from starlette.requests import ClientDisconnect, Request

from fieldhand.api.problems import RefusedRequest
from fieldhand.approval.bundle.container import MAX_BYTES
from fieldhand.delivery.incoming_file import IncomingFile


@dataclass(frozen=True, kw_only=True)
class UploadLimits:
    """Limits on uploads.

    Attributes:
        most: Largest size of an upload, in bytes.
        at_once: Largest number of uploads at the same time.
        idle_s: Seconds without a byte until an upload is aborted.
        start_s: Seconds for any upload.
        bytes_s: Bytes for which an upload has one more second.
    """

    most: int = MAX_BYTES
    at_once: int = 2
    idle_s: float = 20.0
    start_s: float = 60.0
    bytes_s: float = 20_000.0


class UploadSlots:
    """Limits the number of uploads at the same time.

    Args:
        most: Largest number of uploads.
    """

    def __init__(self, most: int) -> None:
        self._most, self._inside = most, 0

    @contextmanager
    def entered(self) -> Iterator[None]:
        """Occupy a slot for the duration of the context.

        Raises:
            RefusedRequest: No slot is free (status 503).
        """
        if self._inside >= self._most:
            raise RefusedRequest(503, "other missions are arriving", "try again in a moment")
        self._inside += 1
        try:
            yield
        finally:
            self._inside -= 1


def size_of(request: Request, uploads: UploadLimits) -> int:
    """Return the declared size of an upload, before any of it is read.

    Raises:
        RefusedRequest: The size is missing or too large.
    """
    declared = request.headers.get("content-length")
    if declared is None or "transfer-encoding" in request.headers:
        raise RefusedRequest(411, "the upload does not state its size", "send it with a Content-Length")
    if not declared.isascii() or not declared.isdigit() or len(declared) > 15 or int(declared) > uploads.most:
        raise RefusedRequest(413, "the upload is too large", f"a mission has {uploads.most / 1e6:,.0f} MB at most")
    return int(declared)


async def receive(request: Request, incoming: IncomingFile, size: int, uploads: UploadLimits) -> None:
    """Write the complete body to the file.

    Raises:
        RefusedRequest: The body is incomplete, longer than declared, or too slow.
        StoreError: The disk is full.
    """
    stream = request.stream()
    try:
        with anyio.fail_after(uploads.start_s + size / uploads.bytes_s):
            while chunk := await _next(stream, uploads.idle_s):
                if incoming.size + len(chunk) > size:
                    raise RefusedRequest(400, "the upload is longer than it stated", "send it again")
                await anyio.to_thread.run_sync(incoming.write, chunk)
    except TimeoutError:
        raise RefusedRequest(
            408, f"the upload came too slowly ({incoming.size:,} of {size:,} bytes)", "send it again"
        ) from None
    except ClientDisconnect:
        raise _cut_off(incoming, size) from None
    if incoming.size != size:
        raise _cut_off(incoming, size)


async def _next(stream: AsyncIterator[bytes], idle_s: float) -> bytes:
    """Return the next bytes; empty at the end."""
    with anyio.fail_after(idle_s):
        async for chunk in stream:
            if chunk:
                return chunk
    return b""


def _cut_off(incoming: IncomingFile, size: int) -> RefusedRequest:
    return RefusedRequest(400, f"the upload was cut off ({incoming.size:,} of {size:,} bytes)", "send it again")
