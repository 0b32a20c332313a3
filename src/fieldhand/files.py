"""Read files up to a maximum size, write files atomically, and locate the user's folders."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, Literal

from fieldhand.errors import InputError

#: Path that stands for standard input in reading and for standard output in writing.
STANDARD = Path("-")


class FileFault(Exception):
    """The reason why a file was not read; callers convert it to an error of their own.

    Attributes:
        what: Reason, as a phrase that follows the file's name.
        kind: Kind of reason; ``missing`` and ``no file`` occur only if a regular file was required.
        size: Minimum size of a file that is too large, in bytes.
    """

    def __init__(
        self, what: str, kind: Literal["missing", "no file", "too large", "unreadable"] = "unreadable", size: int = 0
    ) -> None:
        self.what, self.kind, self.size = what, kind, size
        super().__init__(what)


def read_file(
    path: Path, most: int, *, plain: bool = False, look: Callable[[os.stat_result], None] = lambda _: None
) -> bytes:
    """Read a file up to a maximum size; a device may have no end.

    Args:
        path: Path of the file; ``-`` for standard input.
        most: Maximum size in bytes.
        plain: Require a regular file, and check its size before reading.
        look: Called with the status (owner, permissions) of the opened file; raises to refuse it. The check applies to
            the file that is read, even if the path is replaced meanwhile.

    Raises:
        FileFault: The file is missing, not a regular file, too large, or unreadable.
    """
    size = 0
    try:
        if path == STANDARD:
            data = sys.stdin.buffer.read(most + 1)
            if len(data) > most:
                raise FileFault(f"is larger than {most:,} bytes", "too large", len(data))
            return data
        if plain and not path.is_file():
            raise FileFault(*(("is not a file", "no file") if path.exists() else ("there is no such file", "missing")))
        with path.open("rb") as file:
            status = os.fstat(file.fileno())
            look(status)
            size = status.st_size
            if size <= most or not plain:
                data = file.read(most + 1)
                size = len(data)
    except (OSError, ValueError) as error:
        raise FileFault(f"cannot be read: {_reason(error)}") from None
    if size > most:
        raise FileFault(f"is larger than {most:,} bytes", "too large", size)
    return data


def _reason(error: Exception) -> str:
    """Return the reason given by the system for refusing a file."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error) or type(error).__name__


def open_output(path: Path, mode: Literal["a", "w", "wb"]) -> IO[Any]:
    """Open a file to be written in pieces; ``-`` is standard output. Text is UTF-8 without line-end conversion.

    Raises:
        OSError, ValueError: The file cannot be written.
    """
    more: dict[str, Any] = {} if "b" in mode else {"encoding": "utf-8", "newline": "\n"}
    if path == STANDARD:
        return os.fdopen(os.dup(sys.stdout.fileno()), mode, **more)
    path.parent.mkdir(parents=True, exist_ok=True)
    return path.open(mode, **more)


def write_stored(path: Path, data: bytes, *, mode: int = 0o666, new: bool = False) -> None:
    """Write a file and wait until it is stored on the disk.

    Args:
        path: Path of the file, in an existing folder.
        data: Content.
        mode: Permissions of a new file, reduced by the user's umask.
        new: Refuse to overwrite an existing file.

    Raises:
        OSError: The file cannot be written; FileExistsError if it exists and ``new`` is set.
    """
    how = os.O_WRONLY | os.O_CREAT | getattr(os, "O_BINARY", 0) | (os.O_EXCL if new else os.O_TRUNC)
    with os.fdopen(os.open(path, how, mode), "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def write_whole(path: Path, data: bytes, *, mode: int = 0o666) -> None:
    """Write or replace a file atomically, even if the power fails meanwhile.

    Raises:
        OSError: The file cannot be written.
    """
    beside = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        write_stored(beside, data, mode=mode)
        move_whole(beside, path)
    except OSError:
        with suppress(OSError):
            beside.unlink(missing_ok=True)
        raise


def move_whole(written: Path, path: Path) -> None:
    """Rename a stored file durably, so that it has its new name after a power cut.

    Raises:
        OSError: The file cannot be moved.
    """
    written.replace(path)
    store_names(path.parent)


def store_names(folder: Path) -> None:
    """Wait until the directory entries of a folder are stored on the disk, if the system supports it.

    Raises:
        OSError: The disk fails.
    """
    if os.name == "posix":
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def state_folder(environ: Mapping[str, str]) -> Path:
    """Return the state folder, which contains missions, history and records of approvals.

    Raises:
        InputError: The environment names a file, or the user has no home folder.
    """
    return _user_folder(environ, "XDG_STATE_HOME", ".local/state")


def config_folder(environ: Mapping[str, str]) -> Path:
    """Return the folder of keys and trust: ``FIELDHAND_CONFIG``, or a folder in the user's configuration folder.

    Raises:
        InputError: The environment names a file, or the user has no home folder.
    """
    return named_folder(environ, "FIELDHAND_CONFIG") or _user_folder(environ, "XDG_CONFIG_HOME", ".config")


def named_folder(environ: Mapping[str, str], variable: str) -> Path | None:
    """Return the folder that an environment variable names, which may not exist yet; None if it is unset.

    Raises:
        InputError: The variable names something other than a folder.
    """
    named = environ.get(variable)
    if not named:
        return None
    path = Path(named)
    try:
        other = path.exists() and not path.is_dir()
    except OSError:
        other = False  # whoever opens it says what is wrong
    if other:
        raise InputError(f"{named} is a file, not a folder", where=variable, advice="give a folder")
    return path


def _user_folder(environ: Mapping[str, str], variable: str, else_in_home: str) -> Path:
    named = named_folder(environ, variable)
    if named is None:
        try:
            named = (named_folder(environ, "HOME") or Path.home()) / else_in_home
        except RuntimeError:
            raise InputError("you have no home folder", where="HOME", advice=f"set {variable} to a folder") from None
    return named / "fieldhand"
