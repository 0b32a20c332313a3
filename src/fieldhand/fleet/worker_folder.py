"""The folder ``worker`` of a mission: settings, lock, position and fault of the process that carries it out."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from fieldhand.errors import JournalError
from fieldhand.files import FileFault, read_file, write_whole
from fieldhand.folders import FolderLock, is_locked
from fieldhand.hidden_characters import json_text
from fieldhand.language import message, named

WORKER = "worker"
#: Largest of the small files in bytes, and size of the position file.
_MOST_BYTES, _POSITION_BYTES = 20_000, 256


@dataclass(frozen=True, kw_only=True)
class WorkerSettings:
    """The settings with which a mission is carried out, beside those in mission.json.

    Attributes:
        speed: Simulated seconds per second; None for as fast as possible.
        by: Name of the person who began the mission.
    """

    speed: float | None
    by: str


@dataclass(frozen=True, kw_only=True)
class SeenPosition:
    """A position of a robot under way.

    Attributes:
        t: Seconds since the mission began.
        lat, lon: Degrees, WGS 84.
        heading_deg: Degrees clockwise from north; None if unknown.
        charge_percent: Charge of the battery.
        at: Time at which it was seen, ISO 8601.
    """

    t: float
    lat: float
    lon: float
    heading_deg: float | None
    charge_percent: float
    at: str


class WorkerFolder:
    """The folder of a mission's worker.

    Args:
        mission: Folder of the mission.
    """

    def __init__(self, mission: Path) -> None:
        self.path = mission / WORKER
        self.log = self.path / "worker.log"

    def create(self, settings: WorkerSettings) -> None:
        """Create the folder.

        Raises:
            JournalError: It cannot be written.
        """
        try:
            self.path.mkdir(mode=0o755, parents=True, exist_ok=True)
            write_whole(self._settings, json_text(asdict(settings)).encode())
        except OSError as error:
            raise _unwritable(self.path, error) from None

    def exists(self) -> bool:
        """Return True if the mission has a worker, whether it runs or not."""
        try:
            return self._settings.is_file()
        except OSError:
            return False

    def settings(self) -> WorkerSettings:
        """Return the settings.

        Raises:
            JournalError: They are missing or malformed.
        """
        try:
            record = json.loads(read_file(self._settings, _MOST_BYTES, plain=True))
            speed = record["speed"]
            speed = None if speed is None else float(speed)
            if speed is not None and not 0 < speed < math.inf:
                raise ValueError(f"the speed is {speed}")
            return WorkerSettings(speed=speed, by=str(record["by"]))
        except (FileFault, ValueError, KeyError, TypeError, RecursionError) as error:
            raise JournalError(
                message("the settings of the mission's worker cannot be read"),
                where=str(self._settings),
                advice=message("continue it with fieldhand resume"),
            ) from error

    def lock(self) -> FolderLock:
        """Lock the folder; the lock is kept by the process that inherits its descriptor.

        Raises:
            FolderTaken: A worker is alive.
            OSError: The folder cannot be opened.
        """
        return FolderLock(self.path)

    def is_alive(self) -> bool:
        """Return True while a worker is alive: it starts, carries the mission out, or writes its report."""
        return is_locked(self.path)

    # --- position -------------------------------------------------------------------------------------------------

    @property
    def position_file(self) -> Path:
        """File of the last position."""
        return self.path / "position"

    def position(self) -> SeenPosition | None:
        """Return the last position that was seen; None before the first."""
        try:
            return SeenPosition(**json.loads(read_file(self.position_file, _POSITION_BYTES)))
        except (FileFault, ValueError, TypeError):
            return None  # there is none yet, or it is being written

    # --- fault ----------------------------------------------------------------------------------------------------

    def fault(self) -> str:
        """Return the reason why the worker ended before the mission did; empty if it did not."""
        try:
            return read_file(self._fault, _MOST_BYTES, plain=True).decode(errors="replace")
        except FileFault:
            return ""

    def set_fault(self, why: str) -> None:
        """Record the reason why the worker ends; an empty one removes it.

        Raises:
            OSError: It cannot be written.
        """
        if why:
            write_whole(self._fault, why.encode(errors="replace")[:_MOST_BYTES])
        else:
            self._fault.unlink(missing_ok=True)

    @property
    def _settings(self) -> Path:
        return self.path / "settings.json"

    @property
    def _fault(self) -> Path:
        return self.path / "fault.txt"


class PositionFile:
    """The file in which a worker notes the robot's position; it is overwritten in place and not synced.

    Args:
        path: The file.
    """

    def __init__(self, path: Path) -> None:
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT, 0o644)

    def write(self, position: SeenPosition) -> None:
        """Overwrite the position. The size is constant, so that one write replaces it."""
        text = json_text(_rounded(position), allow_nan=False).encode()
        if len(text) <= _POSITION_BYTES:
            os.pwrite(self._descriptor, text.ljust(_POSITION_BYTES), 0)

    def close(self) -> None:
        """Close the file."""
        os.close(self._descriptor)


def _rounded(position: SeenPosition) -> dict[str, Any]:
    """Return the fields of a position, to a centimetre."""
    record = asdict(position)
    digits: dict[str, int] = {"t": 2, "lat": 7, "lon": 7, "heading_deg": 1, "charge_percent": 2}
    return record | {
        name: round(record[name], decimals) for name, decimals in digits.items() if record[name] is not None
    }


def at_most_every(seconds: float, now: Callable[[], float]) -> Callable[[], bool]:
    """Return a function that returns True at most once in a number of seconds."""
    due = -math.inf

    def is_due() -> bool:
        nonlocal due
        at = now()
        if at < due:
            return False
        due = at + seconds
        return True

    return is_due


def _unwritable(path: Path, error: OSError) -> JournalError:
    return JournalError(
        message("the mission's folder cannot be written: {why}", why=named(error.strerror or str(error), "reason")),
        where=str(path),
        advice=message("free some space, or give another folder with --missions"),
    )
