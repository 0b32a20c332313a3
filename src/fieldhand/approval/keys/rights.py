"""Files that hold keys: only their owner reads a private one, only their owner writes what is trusted."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from fieldhand.errors import KeyFileError, OutputError
from fieldhand.files import FileFault, read_file, write_stored, write_whole
from fieldhand.folders import Unguarded, require_guarded

#: A key is a few lines.
MAX_BYTES = 64_000


def read_guarded(path: Path, *, private: bool, most: int = MAX_BYTES) -> bytes:
    """The bytes of a small file of the user's own.

    Args:
        path: Of the file.
        private: Nobody else may read it either; else nobody else may write it.
        most: Bytes that it may have.

    Raises:
        KeyFileError: It is missing, no file, too large, not the user's own, or others have rights on it.
    """
    try:
        return read_file(path, most, look=lambda status: require_own(status, path, private=private))
    except FileFault as fault:
        raise not_a_key(path, fault) from None


def not_a_key(path: Path, fault: FileFault) -> KeyFileError:
    """That a file cannot be read, or is too large to hold a key."""
    what = "is no key: it is too large" if fault.kind == "too large" else fault.what
    return KeyFileError(what, where=str(path), advice="check the path")


def require_own(status: os.stat_result, path: Path, *, private: bool) -> None:
    """Refuse what others could have read (a private key) or written.

    Raises:
        KeyFileError: Its owner is another user, or the rights on it are too wide.
    """
    if os.name != "posix":
        return  # rights are lists there, which the folder of the user has already
    if status.st_uid not in (0, os.geteuid()):
        raise KeyFileError("belongs to another user", where=str(path), advice="take only what is your own")
    wide = stat.S_IRWXG | stat.S_IRWXO if private else stat.S_IWGRP | stat.S_IWOTH
    if status.st_mode & wide:
        what = "can be read by others" if private else "can be written by others"
        mode = "600" if private else "go-w"
        raise KeyFileError(what, where=str(path), advice=f"chmod {mode} {path}; if others use this machine, doubt it")


def require_own_folder(path: Path) -> None:
    """Refuse a folder of keys that others can change, or put another in the place of.

    Raises:
        KeyFileError: They can.
        OSError: It may not be looked into.
    """
    for folder in (path.parent, path):
        require_own(folder.stat(), folder, private=False)
    try:
        require_guarded(path)
    except Unguarded as fault:
        raise KeyFileError(
            fault.what, where=str(fault.path), advice=f"{fault.advice}; if others use this machine, doubt it"
        ) from None


def make_folder(path: Path) -> None:
    """A folder of the user alone.

    Raises:
        OutputError: It cannot be made.
    """
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        path.mkdir(mode=0o700, exist_ok=True)
    except OSError as error:
        raise _unwritable(path, error) from None


def write_new(path: Path, data: bytes) -> None:
    """Write a file that only its owner may read; never over another one.

    Raises:
        KeyFileError: There is a file of that name.
        OutputError: It cannot be written.
    """
    try:
        write_stored(path, data, mode=0o600, new=True)
    except FileExistsError:
        raise KeyFileError("there is such a key already", where=str(path), advice="choose another --name") from None
    except OSError as error:
        raise _unwritable(path, error) from None


def replace(path: Path, data: bytes) -> None:
    """Write a file as a whole or not at all, also where the power fails meanwhile.

    Raises:
        OutputError: It cannot be written.
    """
    try:
        write_whole(path, data, mode=0o600)
    except OSError as error:
        raise _unwritable(path, error) from None


def _unwritable(path: Path, error: OSError) -> OutputError:
    return OutputError(
        f"cannot write: {error.strerror}", where=str(path), advice="give another folder in FIELDHAND_CONFIG"
    )
