"""Images of stored missions."""

from __future__ import annotations

from pathlib import Path

from fieldhand.files import FileFault, read_file
from fieldhand.task.results import IMAGE_PATH

#: Largest image in bytes.
MOST_IMAGE = 300_000_000


def image_of(folder: Path, name: str) -> bytes | None:
    """Return the bytes of an image in a mission's folder; None if there is none of that name.

    Args:
        folder: Folder of the mission.
        name: Name of the file, as an event has it behind ``images/``.
    """
    path = f"images/{name}"
    if not IMAGE_PATH.fullmatch(path):
        return None
    try:
        return read_file(folder / path, MOST_IMAGE, plain=True)
    except FileFault:
        return None
