"""Images of captures that an MCAP file includes."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

from fieldhand.files import FileFault, read_file
from fieldhand.task.results import IMAGE_PATH, ImageFile

#: Largest image in bytes that a file includes: a record is bounded when it is read.
_MOST_BYTES = 40_000_000
_NAME = re.compile(r"[a-z][a-z0-9_]{0,59}")


def image_data(folder: Path | None, image: ImageFile) -> bytes | None:
    """Return the bytes of an image; None if they are not those that were saved, or too many."""
    if folder is None or not IMAGE_PATH.fullmatch(image.file) or not _NAME.fullmatch(image.name):
        return None
    try:
        data = read_file(folder / image.file, _MOST_BYTES, plain=True)
    except FileFault:
        return None
    return data if hashlib.sha256(data).hexdigest() == image.sha256 else None
