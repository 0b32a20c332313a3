"""A bundle that is still arriving: a file that nothing else knows."""

from __future__ import annotations

import hashlib
import os
from contextlib import suppress
from pathlib import Path

from fieldhand.errors import StoreError


class IncomingFile:
    """What has come so far.

    Args:
        path: Where it is written to.
        descriptor: Of that file, open for writing.

    Attributes:
        size: Bytes so far.
    """

    def __init__(self, path: Path, descriptor: int) -> None:
        self.path = path
        self.size = 0
        self._file = os.fdopen(descriptor, "wb")
        self._sum = hashlib.sha256()

    def write(self, chunk: bytes) -> None:
        """Take what came.

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
        """Wait until all of it is on the disk.

        Returns:
            Its SHA-256.

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
        """Leave nothing of it."""
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):
            self.path.unlink(missing_ok=True)


def unwritable(path: Path, error: OSError) -> StoreError:
    """That the disk is full, or that nobody may write there."""
    return StoreError(f"cannot be written: {error.strerror or error}", where=str(path), advice="free some space")
