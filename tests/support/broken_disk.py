"""A disk that fails at its n-th call: each write, sync, truncation, rename, removal and opening below one folder.

SQLite is broken in its own terms: a VFS is put before that of the library which Python's ``sqlite3`` uses, in this
process, so that the code that runs is the code that ships. Files that Python writes are broken below ``os`` and ``io``.

    EIO       the call fails once, and nothing of it is done
    ENOSPC    the disk is full from this call on
    short     half of the data is written, then the call fails
    dies      the process ends before the call: nothing behind it reaches the disk
    torn      half of the data is written, and the process ends
    power     the power is cut: every write that was not synced is lost
"""

from __future__ import annotations

import _sqlite3
import ctypes
import errno
import functools
import io
import os
import pathlib
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

KINDS = ("EIO", "ENOSPC", "short", "dies", "torn", "power")
_OK, _IOERR, _FULL, _CANTOPEN = 0, 10, 13, 14
_READING, _DELETE_ON_CLOSE = 0x1, 0x8
_P, _INT, _LONG = ctypes.c_void_p, ctypes.c_int, ctypes.c_int64
# Names stay the pointers that they are: SQLite keeps them, and reads what stands before them.
_OPEN = ctypes.CFUNCTYPE(_INT, _P, _P, _P, _INT, _P)
_REMOVE = ctypes.CFUNCTYPE(_INT, _P, _P, _INT)
_WRITE = ctypes.CFUNCTYPE(_INT, _P, _P, _INT, _LONG)
_TRUNCATE = ctypes.CFUNCTYPE(_INT, _P, _LONG)
_SYNC = ctypes.CFUNCTYPE(_INT, _P, _INT)


class _Methods(ctypes.Structure):
    """``sqlite3_io_methods``."""

    _fields_ = [
        ("version", _INT),
        *((name, _P) for name in ("close", "read", "write", "truncate", "sync")),
        *((f"method{k}", _P) for k in range(13)),
    ]


class _Vfs(ctypes.Structure):
    """``sqlite3_vfs``."""

    _fields_ = [
        ("version", _INT),
        ("file_size", _INT),
        ("longest_path", _INT),
        ("next", _P),
        ("name", ctypes.c_char_p),
        ("data", _P),
        *((name, _P) for name in ("open", "delete")),
        *((f"method{k}", _P) for k in range(14)),
    ]


class Disk:
    """A disk that fails at one call; see the module.

    Args:
        folder: What lies below it is on this disk.
        kind: How the call fails.
        at: Which call, from 1; 0 for none.

    Attributes:
        calls: What was done so far, in words.
    """

    def __init__(self, folder: Path, kind: str = "EIO", at: int = 0) -> None:
        self.folder, self.kind, self.at = folder, kind, at
        self.calls: list[str] = []
        self.dead = False
        self._full = False
        #: Of each file its bytes when it was last synced; the same of files whose removal was not synced.
        self._synced: dict[str, bytes] = {}
        self._removed: dict[str, bytes] = {}

    def holds(self, path: object) -> bool:
        """Return True if a path lies on this disk."""
        return isinstance(path, str | bytes | os.PathLike) and Path(os.fsdecode(path)).is_relative_to(self.folder)

    def fails(self, what: str, path: str) -> str | None:
        """Count a call, and return how it fails; None if it does not."""
        if self.dead:
            return "dies"
        self.calls.append(f"{what} {Path(path).name}")
        if len(self.calls) == self.at:
            self._full = self.kind == "ENOSPC"
            self.dead = self.kind in ("dies", "torn", "power")
            return self.kind
        return "ENOSPC" if self._full and what in ("write", "open") else None

    def seen(self, path: str) -> None:
        """Remember what a file held when it was opened first: that is on the disk."""
        self._removed.pop(path, None)
        if path not in self._synced:
            self._synced[path] = _content(path)

    def removed(self, path: str, *, synced: bool) -> None:
        """A file is gone; where its folder was not synced, a power cut brings it back."""
        held = self._synced.pop(path, b"")
        if not synced and not self.dead:
            self._removed[path] = held

    def synced(self, path: str) -> None:
        """Make the present content of a file survive a power cut."""
        self._synced[path] = _content(path)

    def folder_synced(self, folder: str) -> None:
        """Make the removal of files from a folder survive a power cut."""
        self._removed = {path: data for path, data in self._removed.items() if str(Path(path).parent) != folder}

    def moved(self, path: str, to: str) -> None:
        """A file has another name."""
        if path in self._synced:
            self._synced[to] = self._synced.pop(path)

    def lose_what_was_not_synced(self) -> None:
        """Do what a power cut does to the files."""
        for path, data in self._synced.items():
            if Path(path).exists():
                Path(path).write_bytes(data)
        for path, data in self._removed.items():
            if Path(path).parent.exists():
                Path(path).write_bytes(data)


def _content(path: str) -> bytes:
    return Path(path).read_bytes() if Path(path).exists() else b""


@functools.cache
def _library() -> ctypes.CDLL:
    """The library that Python's ``sqlite3`` uses."""
    library = ctypes.CDLL(_sqlite3.__file__)
    try:
        library.sqlite3_vfs_find.restype = _P
    except AttributeError:
        pytest.skip("this Python does not show its SQLite")
    return library


class _Sqlite:
    """SQLite's files on a disk: a VFS before the usual one."""

    def __init__(self, disk: Disk) -> None:
        self._disk = disk
        self._usual = _Vfs.from_address(_library().sqlite3_vfs_find(None))
        self._paths: dict[int, str] = {}
        self._methods: dict[int, _Methods] = {}
        self._made = {"open": _OPEN(self._open), "delete": _REMOVE(self._delete)}
        self._made |= {"write": _WRITE(self._write), "truncate": _TRUNCATE(self._truncate), "sync": _SYNC(self._sync)}
        self._real: dict[str, Any] = {
            "open": _OPEN(self._usual.open),
            "delete": _REMOVE(self._usual.delete),
        }
        self.vfs = _Vfs.from_buffer_copy(self._usual)
        self.vfs.name = b"broken disk"
        for name in ("open", "delete"):
            setattr(self.vfs, name, ctypes.cast(self._made[name], _P))

    def _open(self, vfs: int, name: int | None, file: int, flags: int, out: int) -> int:
        path = "" if name is None else os.fsdecode(ctypes.string_at(name))
        counts = bool(path) and self._disk.holds(path)
        if counts and not flags & _READING and not Path(path).exists():
            fault = self._disk.fails("open", path)
            if fault is not None:
                _P.from_address(file).value = None
                return _FULL if fault == "ENOSPC" else _CANTOPEN
        status = int(self._real["open"](vfs, name, file, flags, out))
        if status == _OK and counts:
            self._disk.seen(path)
            self._paths[file] = path
            self._watch(file)
        return status

    def _watch(self, file: int) -> None:
        """Let the writing calls of a file come here."""
        usual = _P.from_address(file).value
        assert usual is not None
        if usual not in self._methods:
            methods = _Methods.from_buffer_copy(_Methods.from_address(usual))
            for name, kind in (("write", _WRITE), ("truncate", _TRUNCATE), ("sync", _SYNC)):
                self._real[name] = kind(getattr(methods, name))
                setattr(methods, name, ctypes.cast(self._made[name], _P))
            self._methods[usual] = methods
        _P.from_address(file).value = ctypes.addressof(self._methods[usual])

    def _write(self, file: int, data: int, size: int, at: int) -> int:
        fault = self._disk.fails("write", self._paths[file])
        if fault in ("short", "torn"):
            self._real["write"](file, data, size // 2, at)
        if fault is not None:
            return _FULL if fault == "ENOSPC" else _IOERR
        return int(self._real["write"](file, data, size, at))

    def _truncate(self, file: int, size: int) -> int:
        if self._disk.fails("truncate", self._paths[file]) is not None:
            return _IOERR
        return int(self._real["truncate"](file, size))

    def _sync(self, file: int, _: int) -> int:
        """The file is taken for synced: what that is worth is known here, and the real disk need not be waited for."""
        if self._disk.fails("sync", self._paths[file]) is not None:
            return _IOERR
        self._disk.synced(self._paths[file])
        return _OK

    def _delete(self, vfs: int, name: int, sync: int) -> int:
        path = os.fsdecode(ctypes.string_at(name))
        if not self._disk.holds(path) or not Path(path).exists():
            return int(self._real["delete"](vfs, name, sync))
        if self._disk.fails("remove", path) is not None:
            return _IOERR
        self._disk.removed(path, synced=bool(sync))
        return int(self._real["delete"](vfs, name, sync))


class _Raw(io.FileIO):
    """A file that Python writes to the disk."""

    disk: Disk
    path: str

    def write(self, data: Any, /) -> int:
        return _written(self.disk, self.path, bytes(data), super().write)


def _written(disk: Disk, path: str, data: bytes, write: Callable[[bytes], int]) -> int:
    fault = disk.fails("write", path)
    if fault in ("short", "torn"):
        write(data[: len(data) // 2])
    _refuse(fault, path)
    return write(data)


def _refuse(fault: str | None, path: str) -> None:
    if fault is not None:
        code = errno.ENOSPC if fault == "ENOSPC" else errno.EIO
        raise OSError(code, os.strerror(code), path)


def _break_python(disk: Disk, patch: pytest.MonkeyPatch) -> None:
    """Let what Python writes below the folder come to the disk."""
    names: dict[int, str] = {}
    real = {name: getattr(os, name) for name in ("open", "write", "fsync", "replace", "unlink", "mkdir", "close")}
    real_open = io.open

    def opened(path: Any, flags: int, *more: Any, **named: Any) -> int:
        mine = disk.holds(path) and flags & (os.O_WRONLY | os.O_RDWR)
        if mine:
            _refuse(disk.fails("open", os.fsdecode(path)), str(path))
            disk.seen(os.fsdecode(path))
        descriptor = int(real["open"](path, flags, *more, **named))
        names.pop(descriptor, None)
        if mine or disk.holds(path):
            names[descriptor] = os.fsdecode(path)
        return descriptor

    def file_opened(file: Any, mode: str = "r", *more: Any, **named: Any) -> Any:
        path = names.get(file) if isinstance(file, int) else file
        if path is None or not disk.holds(path) or not set(mode) & set("wax+"):
            return real_open(file, mode, *more, **named)
        if not isinstance(file, int):
            _refuse(disk.fails("open", os.fsdecode(path)), str(path))
            disk.seen(os.fsdecode(path))
        raw = _Raw(file, mode.replace("b", ""))
        raw.disk, raw.path = disk, os.fsdecode(path)
        buffered = io.BufferedWriter(raw)
        return buffered if "b" in mode else io.TextIOWrapper(buffered, encoding="utf-8", newline="\n")

    def written(descriptor: int, data: bytes) -> int:
        path = names.get(descriptor)
        if path is None:
            return int(real["write"](descriptor, data))
        return _written(disk, path, data, lambda some: real["write"](descriptor, some))

    def synced(descriptor: int) -> None:
        path = names.get(descriptor)
        if path is None:
            real["fsync"](descriptor)
            return
        _refuse(disk.fails("sync", path), path)
        if Path(path).is_file():
            disk.synced(path)
        else:
            disk.folder_synced(path)

    def closed(descriptor: int) -> None:
        names.pop(descriptor, None)
        real["close"](descriptor)

    def replaced(path: Any, to: Any, **named: Any) -> None:
        if disk.holds(to):
            _refuse(disk.fails("rename", os.fsdecode(path)), str(path))
            disk.moved(os.fsdecode(path), os.fsdecode(to))
        real["replace"](path, to, **named)

    def checked(name: str, what: str) -> Callable[..., None]:
        def call(path: Any, *more: Any, **named: Any) -> None:
            if disk.holds(path) and (what != "remove" or Path(path).exists()):
                _refuse(disk.fails(what, os.fsdecode(path)), str(path))
            real[name](path, *more, **named)

        return call

    for name, mine in (
        ("open", opened),
        ("write", written),
        ("fsync", synced),
        ("close", closed),
        ("replace", replaced),
        ("unlink", checked("unlink", "remove")),
        ("mkdir", checked("mkdir", "make")),
    ):
        patch.setattr(os, name, mine)
    patch.setattr(io, "open", file_opened)
    accessor = getattr(pathlib, "_NormalAccessor", None)
    if accessor is not None:  # paths of Python 3.10 keep the functions that they were defined with
        patch.setattr(accessor, "open", staticmethod(file_opened))
        for name in ("replace", "unlink", "mkdir"):
            patch.setattr(accessor, name, staticmethod(getattr(os, name)))


@contextmanager
def broken(folder: Path, kind: str = "EIO", at: int = 0) -> Iterator[Disk]:
    """Let a folder lie on a disk that fails; with ``at`` 0 its calls are only counted."""
    disk = Disk(folder, kind, at)
    before = sqlite3.sqlite_version  # the library is loaded
    assert before
    sqlite, library = _Sqlite(disk), _library()
    library.sqlite3_vfs_register(ctypes.byref(sqlite.vfs), 1)
    try:
        with pytest.MonkeyPatch.context() as patch:
            _break_python(disk, patch)
            yield disk
    finally:
        library.sqlite3_vfs_unregister(ctypes.byref(sqlite.vfs))
    if disk.dead and kind == "power":
        disk.lose_what_was_not_synced()
