"""Files of anyone, read within a bound; files of our own, written whole; the folders where a user keeps them."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, Literal

from fieldhand.errors import InputError

#: In place of a file: standard input where one is read, standard output where one is written.
STANDARD = Path("-")


class FileFault(Exception):
    """Why a file is not read; whoever asks for it makes a message of their own of it.

    Attributes:
        what: In words that can stand behind the file's name.
        kind: ``missing`` and ``no file`` only where a plain file was asked for.
        size: Bytes that it has at least, where it is too large.
    """

    def __init__(
        self, what: str, kind: Literal["missing", "no file", "too large", "unreadable"] = "unreadable", size: int = 0
    ) -> None:
        self.what, self.kind, self.size = what, kind, size
        super().__init__(what)


def read_file(
    path: Path, most: int, *, plain: bool = False, look: Callable[[os.stat_result], None] = lambda _: None
) -> bytes:
    """The bytes of a file; no more of it is read than it may have, for a device has no size and no end.

    Args:
        path: Of the file; ``-`` is standard input.
        most: Bytes that it may have.
        plain: Take no device and no pipe, and read nothing of a file that says itself that it is too large.
        look: Sees owner and rights of the file that is read, even if another is put in its place meanwhile; it raises
            if they will not do.

    Raises:
        FileFault: It is missing, no file, too large, or cannot be read.
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
    """Why the system refused a file, in words."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error) or type(error).__name__


def open_output(path: Path, mode: Literal["a", "w", "wb"]) -> IO[Any]:
    """Open a file that is written piece by piece; ``-`` is standard output. Text is UTF-8, line ends stay.

    Raises:
        OSError, ValueError: It cannot be written.
    """
    more: dict[str, Any] = {} if "b" in mode else {"encoding": "utf-8", "newline": "\n"}
    if path == STANDARD:
        return os.fdopen(os.dup(sys.stdout.fileno()), mode, **more)
    path.parent.mkdir(parents=True, exist_ok=True)
    return path.open(mode, **more)


def write_stored(path: Path, data: bytes, *, mode: int = 0o666, new: bool = False) -> None:
    """Write a file and wait until it is on the disk.

    Args:
        path: Of the file; its folder is there.
        data: What it shall hold.
        mode: Rights on it, where it is made, less what the user gives to nobody.
        new: Refuse to write over another one.

    Raises:
        OSError: It cannot be written; FileExistsError where there is one.
    """
    how = os.O_WRONLY | os.O_CREAT | getattr(os, "O_BINARY", 0) | (os.O_EXCL if new else os.O_TRUNC)
    with os.fdopen(os.open(path, how, mode), "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def write_whole(path: Path, data: bytes, *, mode: int = 0o666) -> None:
    """Write a file as a whole or not at all, also over another one and also where the power fails meanwhile.

    Raises:
        OSError: It cannot be written.
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
    """Give a file that is on the disk its name, which it has also after a power cut.

    Raises:
        OSError: It cannot be moved.
    """
    written.replace(path)
    store_names(path.parent)


def store_names(folder: Path) -> None:
    """Wait until the names in a folder are on the disk, where the system knows how.

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
    """Where Fieldhand keeps what it has done for its user.

    Raises:
        InputError: What the environment names is a file, or the user has no home.
    """
    return _user_folder(environ, "XDG_STATE_HOME", ".local/state")


def config_folder(environ: Mapping[str, str]) -> Path:
    """Where keys are kept and what is trusted: ``FIELDHAND_CONFIG``, else in the user's folder for configuration.

    Raises:
        InputError: What the environment names is a file, or the user has no home.
    """
    return named_folder(environ, "FIELDHAND_CONFIG") or _user_folder(environ, "XDG_CONFIG_HOME", ".config")


def named_folder(environ: Mapping[str, str], variable: str) -> Path | None:
    """The folder that a variable names; None where it names none. It may be one that is not there yet.

    Raises:
        InputError: It names something else.
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
        raise InputError(f"{named} is a file, not a folder", where=variable, advice="name a folder")
    return path


def _user_folder(environ: Mapping[str, str], variable: str, else_in_home: str) -> Path:
    named = named_folder(environ, variable)
    if named is None:
        try:
            named = (named_folder(environ, "HOME") or Path.home()) / else_in_home
        except RuntimeError:
            raise InputError("you have no home folder", where="HOME", advice=f"name a folder in {variable}") from None
    return named / "fieldhand"
