"""Find the folder of a stored mission by its name or its path."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from pathlib import Path

from fieldhand.compatibility import UTC
from fieldhand.errors import JournalError
from fieldhand.files import named_folder, state_folder
from fieldhand.language import message, named
from fieldhand.missions.folder import ABOUT


def missions_folder(environ: Mapping[str, str]) -> Path:
    """Return the default folder of all missions: ``FIELDHAND_MISSIONS``, else one in the user's state folder.

    Raises:
        InputError: The environment variable names a file.
    """
    return named_folder(environ, "FIELDHAND_MISSIONS") or state_folder(environ) / "missions"


def find(under: Path, name: str | None) -> Path:
    """Return the folder of a mission.

    Args:
        under: Folder of all missions.
        name: Name or path of the mission; None for the one begun last.

    Raises:
        JournalError: There is no such mission.
    """
    if name is not None:
        for folder in (under / name, Path(name)):
            if exists(folder):
                return folder
        raise JournalError(message("no mission '{name}'", name=name), where=str(under), advice=_known(under))
    folders = all_missions(under)
    if not folders:
        raise JournalError(
            message("no mission has been started"), where=str(under), advice=message("start one with fieldhand run")
        )
    return folders[-1]


def exists(folder: Path) -> bool:
    """Return True if this is the folder of a mission that was begun.

    Raises:
        JournalError: The folder may not be read.
    """
    try:
        return (folder / ABOUT).is_file()
    except OSError as error:
        raise _closed(folder, error) from None


def all_missions(under: Path) -> tuple[Path, ...]:
    """Return the folders of all missions below a folder, in the order in which they were begun.

    Raises:
        JournalError: The folder may not be read, or is a file.
    """
    try:
        found = [folder for folder in under.iterdir() if exists(folder)]
        return tuple(sorted(found, key=lambda folder: ((folder / ABOUT).stat().st_mtime_ns, folder.name)))
    except FileNotFoundError:
        return ()
    except OSError as error:
        raise _closed(under, error) from None


def begun_at(folder: Path) -> datetime:
    """Return the time at which a mission was begun."""
    return datetime.fromtimestamp((folder / ABOUT).stat().st_mtime, UTC)


def _closed(folder: Path, error: OSError) -> JournalError:
    return JournalError(
        message("cannot be read: {why}", why=named(error.strerror or str(error), "reason")),
        where=str(folder),
        advice=message("check its permissions, or give another folder with --missions"),
    )


def _known(under: Path) -> str:
    names = [folder.name for folder in all_missions(under)]
    return (
        message("there are {names}", names=", ".join(names[-5:]))
        if names
        else message("no mission was started in this folder")
    )
