"""The temporary file of a bundle that is being received."""

from __future__ import annotations

import hashlib
import os
from contextlib import suppress
from pathlib import Path

from fieldhand.errors import StoreError


class IncomingFile:
    """The part of an upload that has been received so far.

    Args:
        path: Path of the file.
        descriptor: File descriptor, open for writing.

    Attributes:
        size: Bytes written so far.
    """

    def __init__(self, path: Path, descriptor: int) -> None:
        self.path = path
        self.size = 0
        self._file = os.fdopen(descriptor, "wb")
        self._sum = hashlib.sha256()

    def write(self, chunk: bytes) -> None:
        """Append the bytes to the file.

        Raises:
            StoreError: The disk is full, or fails.
        """
        try:
            self._file.write(chunk)
        except OSError as error:
            raise unwritable(self.path, error) from None
        self._sum.update(chunk)
        self.size += len(chunk)

    def settle(self) -> str:
        """Close the file once all of it is on the disk.

        Returns:
            SHA-256 of the file.

        Raises:
            StoreError: The disk is full, or fails.
        """
        try:
            self._file.flush()
            os.fsync(self._file.fileno())
            self._file.close()
        except OSError as error:
            raise unwritable(self.path, error) from None
        return self._sum.hexdigest()

    def drop(self) -> None:
        """Close and remove the file."""
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):
            self.path.unlink(missing_ok=True)


def unwritable(path: Path, error: OSError) -> StoreError:
    """Return the error for a path that cannot be written."""
    return StoreError(f"cannot be written: {error.strerror or error}", where=str(path), advice="free some space")
