"""Check that only the user can change a folder, and lock a folder for one process."""

from __future__ import annotations

import errno
import os
import shlex
import stat
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType

if sys.platform != "win32":
    import fcntl
    import grp
    import pwd

#: Maximum wait for a lock in seconds, because :func:`is_locked` holds it for an instant.
_WITHIN_S = 0.5


#: Maximum number of links in a path, as in Linux.
_MOST_LINKS = 40


class Unguarded(Exception):
    """A file or folder can be changed or replaced by another user.

    Attributes:
        what: Reason, as a phrase that follows the name.
        path: The file or folder.
        advice: Command that repairs it.
    """

    def __init__(self, what: str, path: Path, advice: str) -> None:
        self.what, self.path, self.advice = what, path, advice
        super().__init__(what)


def require_guarded(folder: Path) -> None:
    """Check that no other user can put files into a folder or replace it.

    The folder and every folder and link on its path must belong to this user or to root, and nobody else may write in
    them; on the path, sticky folders such as ``/tmp`` are accepted. A group without other members counts as the user.
    Windows is not checked: its permissions are access control lists, which a user's folder has by default.

    Args:
        folder: Existing folder.

    Raises:
        Unguarded: Another user can; names the folder and the command that repairs it.
        OSError: The folder cannot be accessed.
    """
    if sys.platform == "win32":
        return
    way = list(_way_to(folder.absolute()))
    for path, status in way:
        _require_owner(path, status)
        shared = status.st_mode & stat.S_ISVTX and path != way[-1][0]
        if not stat.S_ISLNK(status.st_mode) and not shared:
            _require_mode(path, status)


def require_own_file(path: Path, status: os.stat_result) -> None:
    """Check that no other user can write a file.

    Raises:
        Unguarded: Another user can.
    """
    if sys.platform != "win32":
        _require_owner(path, status)
        _require_mode(path, status)


def _require_owner(path: Path, status: os.stat_result) -> None:
    if sys.platform != "win32" and status.st_uid not in (0, os.geteuid()):
        raise Unguarded(
            "belongs to another user", path, f"sudo chown -h {_user(os.geteuid())} {shlex.quote(str(path))}"
        )


def _require_mode(path: Path, status: os.stat_result) -> None:
    if status.st_mode & stat.S_IWOTH or (status.st_mode & stat.S_IWGRP and not _is_private(status.st_gid)):
        raise Unguarded("can be written by others", path, f"chmod go-w {shlex.quote(str(path))}")


def _way_to(path: Path) -> Iterator[tuple[Path, os.stat_result]]:
    """Yield every folder and link on an absolute path with its status, starting at the root."""
    at, left, links = Path(path.anchor), list(path.parts[1:]), 0
    yield at, at.lstat()
    while left:
        part = left.pop(0)
        if part == "..":
            at = at.parent
            continue
        one = at / part
        status = one.lstat()
        yield one, status
        if not stat.S_ISLNK(status.st_mode):
            at = one
            continue
        links += 1
        if links > _MOST_LINKS:
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), str(path))
        target = one.readlink()
        at = Path(target.anchor) if target.is_absolute() else at
        left = [*(target.parts[1:] if target.is_absolute() else target.parts), *left]


def _is_private(gid: int) -> bool:
    """Return True if a group has no members except this user and root."""
    if sys.platform == "win32":
        return False
    own = {_user(0), _user(os.geteuid())}
    try:
        named = set(grp.getgrgid(gid).gr_mem)
    except KeyError:
        return False
    return named <= own and all(user.pw_name in own for user in pwd.getpwall() if user.pw_gid == gid)


def _user(uid: int) -> str:
    if sys.platform == "win32":
        return str(uid)
    try:
        return pwd.getpwuid(uid).pw_name
    except KeyError:
        return str(uid)


class FolderTaken(Exception):
    """The folder is locked by another process or another part of this one."""


class FolderLock:
    """An exclusive lock on a folder itself, without a lock file that could be deleted.

    It persists if the folder is renamed, and ends with the process. Windows has no such lock.

    Args:
        folder: Folder to lock.

    Raises:
        FolderTaken: The folder is locked already.
        OSError: The folder cannot be opened, or its file system does not support locks.
    """

    def __init__(self, folder: Path) -> None:
        self._descriptor: int | None = None
        if sys.platform == "win32":
            return
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        until = time.monotonic() + _WITHIN_S
        try:
            while True:
                try:
                    fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    break
                except BlockingIOError:
                    if time.monotonic() >= until:
                        raise FolderTaken from None
                    time.sleep(0.02)
        except BaseException:
            os.close(descriptor)
            raise
        self._descriptor = descriptor

    @property
    def descriptor(self) -> int | None:
        """Descriptor to be inherited by another process, which then keeps the lock as well; None on Windows."""
        return self._descriptor

    def close(self) -> None:
        """Release the folder."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

    def __enter__(self) -> FolderLock:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def is_locked(folder: Path) -> bool:
    """Return True if a process has locked the folder; False if the folder does not exist."""
    if sys.platform == "win32":
        return False
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return False
