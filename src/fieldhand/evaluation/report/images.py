"""Images of a mission in its report: thumbnails on the page, and the files beside it."""

from __future__ import annotations

import base64
import hashlib
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.clock import clock_time
from fieldhand.evaluation.report.place_names import PlaceNames
from fieldhand.files import FileFault, read_file, write_whole
from fieldhand.language.words import capitalised, say_action, say_count
from fieldhand.task.results import IMAGE_PATH, Acted, Event, ImageFile

if TYPE_CHECKING:
    from PIL import Image

#: Most images on the page; the CSV names all.
MOST_IMAGES = 60
#: Longest side of a thumbnail in pixels, its JPEG quality, and the largest file that is read.
_SIDE, _QUALITY, _MOST_BYTES = 320, 70, 300_000_000
#: Percentiles between which a thumbnail of measured values is spread.
_DARK, _BRIGHT = 1.0, 99.0


@dataclass(frozen=True, kw_only=True)
class ReportImage:
    """An image on the page.

    Attributes:
        thumbnail: JPEG in base64; empty if the file cannot be shown.
        problem: Why the file is not the one that was saved; empty if it is.
    """

    title: str
    file: str
    size: str
    sha256: str
    thumbnail: str
    problem: str


@dataclass(frozen=True, kw_only=True)
class ReportImages:
    """The images on the page, and a sentence about the others; empty if there are none."""

    shown: tuple[ReportImage, ...] = ()
    more: str = ""


def report_images(events: Sequence[Event], source: Path | None, names: PlaceNames) -> ReportImages:
    """Return the images of a mission.

    Args:
        events: Event log of the mission.
        source: Folder of the mission; None if it is unknown, so that the files cannot be checked.
        names: Names of places.
    """
    every = [(event, image) for event in events if isinstance(event, Acted) for image in event.images]
    shown = tuple(_image(event, image, source, names) for event, image in every[:MOST_IMAGES])
    more = len(every) - len(shown)
    words = f"{say_count(more, 'more image')} in the folder images and in observations.csv."
    return ReportImages(shown=shown, more=words if more else "")


def copy_images(events: Sequence[Event], source: Path | None, folder: Path) -> None:
    """Copy the images of a mission beside its report, each that is still the one that was saved.

    Raises:
        OSError: The folder cannot be written.
    """
    if source is None or source.resolve() == folder.resolve():
        return
    for image in saved_images(events):
        data, problem = read_image(image, source)
        if problem:
            continue
        path = folder / image.file
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, data)


def saved_images(events: Sequence[Event]) -> Iterator[ImageFile]:
    """Yield the images of a log that were saved."""
    for event in events:
        if isinstance(event, Acted):
            yield from (image for image in event.images if image.file)


def read_image(image: ImageFile, source: Path) -> tuple[bytes, str]:
    """Return the bytes of an image, or why they are not those that were saved."""
    if not IMAGE_PATH.fullmatch(image.file):
        return b"", "its name is not one that a mission gives"
    try:
        data = read_file(source / image.file, _MOST_BYTES, plain=True)
    except FileFault as fault:
        return b"", "the file is missing" if fault.kind == "missing" else f"the file {fault.what}"
    if hashlib.sha256(data).hexdigest() != image.sha256:
        return b"", "the file was changed since it was saved"
    return data, ""


def _image(event: Acted, image: ImageFile, source: Path | None, names: PlaceNames) -> ReportImage:
    data, problem = b"", image.what
    if image.file and source is None:
        problem = "the folder of the mission is not known here"
    elif image.file and source is not None:
        data, problem = read_image(image, source)
    thumbnail = ""
    if data:
        try:
            thumbnail = base64.b64encode(_thumbnail(data)).decode("ascii")
        except Exception:  # noqa: BLE001  the library raises whatever it meets
            problem = "the file cannot be shown"
    return ReportImage(
        title=f"{clock_time(event.t)} {names.name(event.kind, event.place)}: {capitalised(say_action(event.action))}"
        f" ({image.name})",
        file=image.file,
        size=f"{image.width} x {image.height}, {image.encoding}" if image.width else "",
        sha256=image.sha256,
        thumbnail=thumbnail,
        problem=problem,
    )


def _thumbnail(data: bytes) -> bytes:
    """Return a small JPEG. Measured values are spread over the shades of grey."""
    from PIL import Image

    with Image.open(io.BytesIO(data), formats=("PNG", "JPEG", "TIFF")) as opened:
        picture: Image.Image = opened
        if opened.mode.startswith("I") or opened.mode == "F":
            picture = _spread(opened)
        small = picture.convert("RGB")
        small.thumbnail((_SIDE, _SIDE))
        out = io.BytesIO()
        small.save(out, format="JPEG", quality=_QUALITY)
        return out.getvalue()


def _spread(picture: Image.Image) -> Image.Image:
    from PIL import Image

    values = np.asarray(picture, dtype=np.float64)
    known = values[np.isfinite(values)]
    low, high = np.percentile(known, (_DARK, _BRIGHT)) if known.size else (0.0, 1.0)
    grey = np.clip((np.nan_to_num(values, nan=low) - low) / max(high - low, 1e-12), 0.0, 1.0)
    return Image.fromarray((255.0 * grey).round().astype(np.uint8))
