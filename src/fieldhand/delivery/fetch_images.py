"""Fetch the images of a mission from its robot, each held against the hash in the event that names it."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from fieldhand.delivery.robot_client import RobotClient
from fieldhand.errors import DeliveryError, OutputError, TaskError, UnreachableError
from fieldhand.files import FileFault, read_file, write_whole
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import IMAGE_PATH, Acted, ImageFile

#: Largest image in bytes.
_MOST = 300_000_000


@dataclass(frozen=True, kw_only=True)
class FetchedImages:
    """The images that a folder has now: number of all, and what could not be fetched, with the reason."""

    count: int
    problems: tuple[str, ...]


def images_in(lines: Sequence[str]) -> tuple[ImageFile, ...]:
    """Return the images that lines of an event log name; lines of other versions are left out."""
    found: list[ImageFile] = []
    for line in lines:
        try:
            event = from_json(line)
        except TaskError:
            continue
        if isinstance(event, Acted):
            found += [image for image in event.images if IMAGE_PATH.fullmatch(image.file)]
    return tuple(found)


def fetch_images(link: RobotClient, sha256: str, images: Sequence[ImageFile], folder: Path) -> FetchedImages:
    """Fetch the images that a folder does not have yet.

    Args:
        link: Client of the robot's agent.
        sha256: SHA-256 of the signed mission, or id of the run.
        images: The images, from :func:`images_in`.
        folder: Folder that gets them below ``images``, as the mission's own has them.

    Raises:
        UnreachableError: The robot cannot be reached.
        OutputError: The folder cannot be written.
    """
    count, problems = 0, []
    for image in images:
        path = folder / image.file
        if _is_there(path, image):
            count += 1
            continue
        try:
            data = link.image(sha256, path.name)
        except UnreachableError:
            raise
        except DeliveryError as error:
            problems.append(f"{image.file}: {error.what}")
            continue
        if hashlib.sha256(data).hexdigest() != image.sha256:
            problems.append(f"{image.file}: the file was changed since it was saved")
            continue
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(path, data)
        except OSError as error:
            raise OutputError(
                f"the image cannot be written ({error.strerror or error})",
                where=str(path),
                advice="choose a folder that you may write to",
            ) from None
        count += 1
    return FetchedImages(count=count, problems=tuple(problems))


class ImageFetcher:
    """Fetches the images of a mission as its events arrive.

    An image that cannot be fetched then, because the connection is lost or the robot is busy, is fetched at the end.

    Args:
        link, sha256, folder: As for :func:`fetch_images`.
    """

    def __init__(self, link: RobotClient, sha256: str, folder: Path) -> None:
        self._link, self._sha256, self._folder = link, sha256, folder
        self._images: list[ImageFile] = []

    def take(self, line: str) -> None:
        """Fetch the images that a line of the event log names.

        Raises:
            OutputError: The folder cannot be written.
        """
        named = images_in([line])
        self._images += named
        with suppress(DeliveryError):
            fetch_images(self._link, self._sha256, named, self._folder)

    def finish(self) -> FetchedImages:
        """Fetch what is missing; raise what :func:`fetch_images` raises."""
        return fetch_images(self._link, self._sha256, self._images, self._folder)


def _is_there(path: Path, image: ImageFile) -> bool:
    try:
        return hashlib.sha256(read_file(path, _MOST, plain=True)).hexdigest() == image.sha256
    except FileFault:
        return False
