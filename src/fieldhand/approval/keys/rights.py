"""Access to key files: private keys readable, and trusted keys writable, only by their owner."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from fieldhand.errors import KeyFileError, OutputError
from fieldhand.files import FileFault, read_file, write_stored, write_whole
from fieldhand.folders import Unguarded, require_guarded

#: Maximum size of a key file in bytes; a key takes a few lines.
MAX_BYTES = 64_000


def read_guarded(path: Path, *, private: bool, most: int = MAX_BYTES) -> bytes:
    """Read a small file of the current user after checking its permissions.

    Args:
        path: File to read.
        private: Refuse a file that others can read; otherwise, only one that others can write.
        most: Maximum size in bytes.

    Raises:
        KeyFileError: The file is missing, not regular, too large, owned by another user, or accessible to others.
    """
    try:
        return read_file(path, most, look=lambda status: require_own(status, path, private=private))
    except FileFault as fault:
        raise not_a_key(path, fault) from None


def not_a_key(path: Path, fault: FileFault) -> KeyFileError:
    """Return the error for a file that cannot be read or is too large for a key."""
    what = "is not a key: it is too large" if fault.kind == "too large" else fault.what
    return KeyFileError(what, where=str(path), advice="check the path")


def require_own(status: os.stat_result, path: Path, *, private: bool) -> None:
    """Refuse a private key that others can read, or any file that others can write.

    Raises:
        KeyFileError: The owner is another user, or the permissions are too wide.
    """
    if os.name != "posix":
        return  # permissions are access control lists there, inherited from the user's folder
    if status.st_uid not in (0, os.geteuid()):
        raise KeyFileError("belongs to another user", where=str(path), advice="use only keys that belong to you")
    wide = stat.S_IRWXG | stat.S_IRWXO if private else stat.S_IWGRP | stat.S_IWOTH
    if status.st_mode & wide:
        what = "can be read by others" if private else "can be written by others"
        mode = "600" if private else "go-w"
        raise KeyFileError(
            what, where=str(path), advice=f"chmod {mode} {path}; if others use this machine, do not trust it"
        )


def require_own_folder(path: Path) -> None:
    """Refuse a key folder that others can change or replace.

    Raises:
        KeyFileError: Others can change or replace the folder.
        OSError: The folder cannot be accessed.
    """
    for folder in (path.parent, path):
        require_own(folder.stat(), folder, private=False)
    try:
        require_guarded(path)
    except Unguarded as fault:
        raise KeyFileError(
            fault.what, where=str(fault.path), advice=f"{fault.advice}; if others use this machine, do not trust it"
        ) from None


def make_folder(path: Path) -> None:
    """Create a folder that only the user can access.

    Raises:
        OutputError: The folder cannot be created.
    """
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        path.mkdir(mode=0o700, exist_ok=True)
    except OSError as error:
        raise _unwritable(path, error) from None


def write_new(path: Path, data: bytes) -> None:
    """Write a new file that only its owner can read; never overwrite one.

    Raises:
        KeyFileError: A file of that name exists.
        OutputError: The file cannot be written.
    """
    try:
        write_stored(path, data, mode=0o600, new=True)
    except FileExistsError:
        raise KeyFileError(
            "there is already a key with this name", where=str(path), advice="choose another --name"
        ) from None
    except OSError as error:
        raise _unwritable(path, error) from None


def replace(path: Path, data: bytes) -> None:
    """Replace a file atomically, so that a power failure leaves either the old or the new content.

    Raises:
        OutputError: The file cannot be written.
    """
    try:
        write_whole(path, data, mode=0o600)
    except OSError as error:
        raise _unwritable(path, error) from None


def _unwritable(path: Path, error: OSError) -> OutputError:
    return OutputError(
        f"cannot write: {error.strerror}", where=str(path), advice="give another folder in FIELDHAND_CONFIG"
    )
